//! The annotation beside scikit-learn and hmmlearn: one measurement a line of standard input.
//!
//! `peers FOLDER` writes there what `tests/peers/annotation.py` and `tests/wasm/label_speed.mjs` read, then
//! answers the names of measurements with a line of JSON: `{"seconds": 0.13, "answer": 0.97}`. `answer` is a number by which
//! both sides can be seen to have computed the same. Seconds are processor time; one thread is set by
//! `RAYON_NUM_THREADS`. Without arguments (as `cargo bench` calls it) it does nothing.
#![allow(missing_docs, clippy::print_stdout)]

use std::hint::black_box;
use std::io::BufRead as _;
use std::path::Path;

use mimique_annotate::{
    AnnotatedTake, BaumWelch, Decode, Decoding, Examples, Forest, ForestOptions, Hmm, Kernel,
    Lesson, Mark, Marked, Method, Mixture, Model, Neighbours, Rows, Svm, SvmOptions, Take,
};
use mimique_test_support::{Clock, Random};

const SHAPES: usize = 51;
const LABELS: usize = 7;
/// Rows that are learnt from, frames that are asked, frames of a Baum-Welch step.
const TRAIN: usize = 5000;
const FRAMES: usize = 6000;
const LEARNT: usize = 3000;
/// States and components of the joined model, and of one label's.
const JOINED: usize = 60;
const ONE: usize = 5;
const COMPONENTS: usize = 20;
/// Ten minutes at 60 Hz.
const TEN_MINUTES: usize = 36_000;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match args.as_slice() {
        [folder] => serve(Path::new(folder)),
        _ => println!("figures of the annotation: cargo xtask bench --annotate"),
    }
}

/// A frame of a label: its shapes, noise, and never below 0, as weights are.
fn frame(random: &mut Random, label: usize) -> [f64; SHAPES] {
    std::array::from_fn(|shape| {
        let belongs = shape % LABELS == label || (shape * shape) % 11 == label;
        let height = if belongs { 0.15 + 0.25 * ((shape * 7 % 5) as f64 / 5.0) } else { 0.02 };
        (height + 0.22 * random.normal()).max(0.0)
    })
}

struct Problem {
    examples: Examples,
    asked: Rows,
    joined: Hmm,
    one: Hmm,
    learnt: Rows,
    model: Model,
    ten_minutes: Take,
}

fn rows(values: Vec<f64>) -> Rows {
    Rows::new(values, SHAPES).expect("whole rows")
}

/// A model of some states with mixtures about the faces of the labels.
fn hmm(random: &mut Random, states: usize) -> Hmm {
    let shares = |random: &mut Random, n: usize| {
        let raw: Vec<f64> = (0..n).map(|_| 0.2 + random.uniform()).collect();
        let sum: f64 = raw.iter().sum();
        raw.into_iter().map(|share| share / sum).collect::<Vec<f64>>()
    };
    let mixtures = (0..states).map(|state| {
        let means = (0..COMPONENTS).flat_map(|_| frame(random, state % LABELS)).collect();
        let variances = (0..COMPONENTS * SHAPES).map(|_| 0.01 + 0.02 * random.uniform()).collect();
        let weights = shares(random, COMPONENTS);
        Mixture::new(weights, rows(means), rows(variances)).expect("a mixture")
    });
    let mixtures = mixtures.collect();
    let start = shares(random, states);
    let transition: Vec<f64> = (0..states)
        .flat_map(|state| {
            let mut row = shares(random, states);
            row.iter_mut().for_each(|a| *a *= 0.05);
            row[state] += 0.95;
            row
        })
        .collect();
    Hmm::new(start, Rows::new(transition, states).expect("whole rows"), mixtures).expect("a model")
}

impl Problem {
    fn new() -> Self {
        let mut random = Random::new(2019);
        let labels: Vec<usize> = (0..TRAIN).map(|row| row * 31 % LABELS).collect();
        let values = labels.iter().flat_map(|&label| frame(&mut random, label)).collect();
        let examples = Examples::new(rows(values), labels, LABELS).expect("examples");
        let held = |frames: usize, random: &mut Random| {
            rows((0..frames).flat_map(|f| frame(random, f / 60 % LABELS)).collect())
        };
        let (asked, learnt) = (held(FRAMES, &mut random), held(LEARNT, &mut random));
        let ten_minutes = held(TEN_MINUTES, &mut random);
        let ten_minutes = Take::new(ten_minutes.values().to_vec(), SHAPES, 60.0).expect("a take");
        let (joined, one) = (hmm(&mut random, JOINED), hmm(&mut random, ONE));
        let model = forest_model(&asked);
        Self { examples, asked, joined, one, learnt, model, ten_minutes }
    }

    /// What the peers read: little-endian doubles.
    fn write(&self, folder: &Path) {
        let put = |name: &str, values: &[f64]| {
            let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
            std::fs::write(folder.join(name), bytes).expect("the bench folder is writable");
        };
        let shapes = self.model.shapes.join(",");
        let mut csv = format!("frame,time,{shapes}\n");
        for (f, row) in self.ten_minutes.weights.iter().enumerate() {
            let cells: Vec<String> = row.iter().map(|w| format!("{w:.4}")).collect();
            csv += &format!("{f},{},{}\n", f as f64 / 60.0, cells.join(","));
        }
        std::fs::write(folder.join("ten-minutes.csv"), csv).expect("the bench folder is writable");
        let model = self.model.to_json().expect("a model");
        std::fs::write(folder.join("model.json"), model).expect("the bench folder is writable");
        put("train.f64", self.examples.rows().values());
        let labels: Vec<f64> = self.examples.labels().iter().map(|&label| label as f64).collect();
        put("labels.f64", &labels);
        put("asked.f64", self.asked.values());
        put("learnt.f64", self.learnt.values());
        for (name, model) in [("joined", &self.joined), ("one", &self.one)] {
            let of = |part: fn(&Mixture) -> &[f64]| -> Vec<f64> {
                model.states().iter().flat_map(part).copied().collect()
            };
            put(&format!("{name}-start.f64"), model.start());
            put(&format!("{name}-transition.f64"), model.transition().values());
            put(&format!("{name}-weight.f64"), &of(Mixture::weight));
            put(&format!("{name}-mean.f64"), &of(|mixture| mixture.mean().values()));
            put(&format!("{name}-variance.f64"), &of(|mixture| mixture.variance().values()));
        }
    }

    fn svm(&self, tolerance: f64) -> Svm {
        let options =
            SvmOptions { kernel: Kernel::Rbf { gamma: 0.2 }, tolerance, ..SvmOptions::default() };
        Svm::fit(&self.examples, &options).expect("a machine")
    }

    fn forest(&self) -> Forest {
        Forest::fit(&self.examples, &ForestOptions::default()).expect("a forest")
    }

    /// Seconds of a measurement, and a number that both sides find.
    fn measured(&self, what: &str) -> (f64, f64) {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let start = Clock::start();
        match what {
            "viterbi" => {
                let path = self.joined.best_path(&self.asked).expect("a path");
                (start.seconds(), path.log_probability)
            }
            "posteriors" => {
                let found = self.joined.posterior(&self.asked).expect("posteriors");
                (start.seconds(), found.log_likelihood)
            }
            "baum-welch" => {
                let options = BaumWelch {
                    steps: 1,
                    variance_floor: 1e-3,
                    tolerance: 0.0,
                    ..BaumWelch::default()
                };
                let learnt = options.learn(&self.one, std::slice::from_ref(&self.learnt));
                (start.seconds(), learnt.expect("a model").log_likelihood[0])
            }
            "neighbours" => {
                let found = Neighbours::new(&self.examples, 15).expect("neighbours");
                let votes = found.votes(&self.asked).expect("votes");
                let votes: Vec<f64> = votes.iter().map(|vote| vote.label as f64).collect();
                (start.seconds(), mean(&votes))
            }
            "rbf fit" => {
                let svm = self.svm(1e-3);
                let seconds = start.seconds();
                (seconds, svm.pairs().iter().map(|pair| pair.objective).sum())
            }
            "rbf decisions" => {
                let svm = self.svm(1e-3);
                let start = Clock::start();
                let decisions = self.asked.iter().map(|row| svm.decisions(row).expect("decisions"));
                let decisions: Vec<f64> = decisions.flatten().collect();
                (start.seconds(), mean(&decisions))
            }
            "forest fit" => {
                let forest = self.forest();
                (start.seconds(), forest.out_of_bag().unwrap_or(0.0))
            }
            "forest answers" => {
                let forest = self.forest();
                let start = Clock::start();
                let shares = forest.probabilities_of(&self.asked).expect("shares");
                let shares: Vec<f64> = shares.into_iter().step_by(LABELS).collect();
                (start.seconds(), mean(&shares))
            }
            _ => {
                let answer = self.model.label(&self.ten_minutes, &Decode::default());
                (start.seconds(), answer.expect("an answer").segments.len() as f64)
            }
        }
    }
}

/// A forest that has learnt the asked frames, for the ten minutes.
fn forest_model(asked: &Rows) -> Model {
    let marked = (0..FRAMES / 60)
        .map(|i| Marked { frames: 60 * i..60 * (i + 1), mark: Mark::Stable(i % LABELS) });
    let annotated = AnnotatedTake {
        name: "asked".to_owned(),
        person: String::new(),
        kind: String::new(),
        take: Take::new(asked.values().to_vec(), SHAPES, 60.0).expect("a take"),
        marked: marked.collect(),
    };
    let lesson = Lesson {
        channel: "affect".to_owned(),
        labels: (0..LABELS).map(|label| format!("label {label}")).collect(),
        shapes: (0..SHAPES).map(|shape| format!("shape {shape}")).collect(),
        method: Method::Forest(ForestOptions::default()),
        thinned_to_hz: Some(10.0),
        decoding: Decoding::default(),
    };
    lesson.learn(&[annotated]).expect("a model")
}

fn serve(folder: &Path) {
    let problem = Problem::new();
    problem.write(folder);
    println!("{{\"ready\": true}}");
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        let (seconds, answer) = black_box(problem.measured(line.trim()));
        println!("{{\"seconds\": {seconds}, \"answer\": {answer}}}");
    }
}
