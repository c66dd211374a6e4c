//! Layouts beside scikit-learn and NumPy: one measurement a line of standard input.
//!
//! `peers FOLDER` writes there what `tests/peers/layouts.py` reads, then answers the names of measurements with a
//! line of JSON: `{"seconds": 0.13, "answer": 0.97}`. `answer` is a number by which both sides can be seen to have
//! computed the same. Seconds are processor time; one thread is set by `RAYON_NUM_THREADS`. Without arguments (as
//! `cargo bench` calls it) it does nothing.
#![allow(missing_docs, clippy::print_stdout)]

use std::hint::black_box;
use std::io::BufRead as _;
use std::path::Path;

use mimique_actor::{HeadSpec, build_head, range_of_motion};
use mimique_layout::{
    Candidates, Choice, Conditions, Effort, Excluded, ExpectedCurve, Face, FaceMotion, Method,
    Rehearsal, Silent, Spacing, Take, TakeContent, Task, Units, Where, unseen_shapes,
};
use mimique_solver::{
    Criterion, Greedy, KMeans, MarkerUnit, Method as Solver, MethodSpec, TrajectoryRows,
    spread_centres,
};
use mimique_stimulus::AvatarSkin;
use mimique_test_support::{Clock, Random};

const MARKERS: usize = 40;
const STARTS: usize = 10;
const NOISE_M: f64 = 1e-4;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match args.as_slice() {
        [folder] => serve(Path::new(folder)),
        _ => println!("figures of layouts: cargo xtask bench --layout"),
    }
}

struct Problem<'a> {
    face: &'a Face<'a>,
    /// The usual places, and the motion without what they do not tell.
    usual: Candidates,
    motion: FaceMotion,
    /// Rows of every vertex of the face, as in the thesis.
    rows: TrajectoryRows,
    starts: Vec<Vec<f64>>,
    /// A marker each, with noise alone.
    units: Vec<MarkerUnit>,
}

impl<'a> Problem<'a> {
    fn new(face: &'a Face<'a>) -> Self {
        let played = range_of_motion(&face.skin.shape_names, 1, 30.0);
        let content = TakeContent::Weights(played.weights);
        let take = Take { name: "range".to_owned(), rate_hz: Some(30.0), content };
        let usual = Candidates::of(face, &Where::default());
        let unseen = unseen_shapes(face, &usual.vertices);
        let motion = FaceMotion::of(face, &[take], &unseen).expect("a motion");
        let exclude = vec![Excluded::Ears, Excluded::Neck, Excluded::Hair];
        let every = Candidates::of(face, &Where { exclude, ..Where::default() }).vertices;
        let rows = motion.rows(&every);
        let mut random = Random::new(2019);
        let mut start = || spread_centres(&rows, MARKERS, &mut || random.uniform());
        let starts = (0..STARTS).map(|_| start()).collect();
        let noise = NOISE_M * NOISE_M;
        let plain = [[noise, 0.0, 0.0], [0.0, noise, 0.0], [0.0, 0.0, noise]];
        let unit = |&v: &usize| MarkerUnit {
            deltas: motion.basis.of(v).to_vec(),
            covariances: vec![plain],
        };
        let units = every.iter().map(unit).collect();
        Self { face, usual, motion, rows, starts, units }
    }

    /// What the peers read: little-endian doubles.
    fn write(&self, folder: &Path) {
        let put = |name: &str, values: &[f64]| {
            let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
            std::fs::write(folder.join(name), bytes).expect("the bench folder is writable");
        };
        put("rows.f64", &self.rows.values);
        put("starts.f64", &self.starts.concat());
        let deltas: Vec<f64> = self.units.iter().flat_map(|u| u.deltas.iter().copied()).collect();
        put("deltas.f64", &deltas);
        put("prior.f64", &self.motion.prior());
        put("gram.f64", &self.motion.basis.gram);
        let sizes = [self.units.len(), self.motion.basis.width, self.rows.width];
        put("sizes.f64", &sizes.map(|size| size as f64));
    }

    /// Seconds of a measurement, and a number that both sides find.
    fn measured(&self, what: &str) -> (f64, f64) {
        let start = Clock::start();
        match what {
            "k-means" => {
                let runs = self.starts.iter().map(|start| KMeans::from_centres(&self.rows, start));
                let least = runs.map(|run| run.inertia).fold(f64::INFINITY, f64::min);
                (start.seconds(), least)
            }
            "greedy" => {
                let criterion = Criterion::ExpectedError(self.motion.basis.gram.clone());
                let mut greedy = Greedy::new(&self.units, &self.motion.prior(), criterion);
                for _ in 0..MARKERS {
                    let best = greedy.best(&|_| true).expect("a place");
                    greedy.take(best.0);
                }
                let square = greedy.expected_square().unwrap_or_default();
                (start.seconds(), 1e3 * square.sqrt())
            }
            "rehearse" => {
                let error = self.rehearsed();
                (start.seconds(), error)
            }
            _ => self.dragged(),
        }
    }

    /// The error of 40 rehearsed markers, millimetres.
    fn rehearsed(&self) -> f64 {
        let conditions = Conditions { noise: NOISE_M, slip: 1.5e-3, others: true };
        let mut spec = MethodSpec::new(Solver::Lsts);
        spec.rbf_smoothing = Some(0.1);
        let rehearsal =
            Rehearsal::new(self.face, &self.motion, None, &spec, conditions, Effort::SEARCH, 1);
        let spacing = Spacing::of(self.face, &self.motion, &self.usual.vertices, 8e-3);
        let units = Units::of(self.face, &self.usual, spacing, true, &[]).expect("pairs");
        let task = Task {
            units: &units,
            motion: &self.motion,
            rehearsal: &rehearsal,
            noise: conditions.noise,
            slip: conditions.slip,
            seed: 1,
            progress: &Silent,
        };
        let chosen = Method::Rehearse.choose(&task, MARKERS, &Choice::default()).expect("room");
        let square = rehearsal.mean_square(&chosen.vertices()).expect("a solution");
        1e3 * square.sqrt()
    }

    /// Seconds of the curve of 40 markers after the first of them is dragged, the most that a drag costs.
    fn dragged(&self) -> (f64, f64) {
        let spread = self.usual.vertices.iter().copied();
        let step = self.usual.vertices.len() / (MARKERS + 1);
        let mut markers: Vec<usize> = spread.step_by(step).take(MARKERS).collect();
        let mut curve = ExpectedCurve::new(&self.motion, NOISE_M, 1.5e-3);
        curve.of(&self.face.gradients, &self.motion, &markers);
        markers[0] = self.usual.vertices[step / 2];
        let start = Clock::start();
        let found = curve.of(&self.face.gradients, &self.motion, &markers);
        (start.seconds(), 1e3 * found[found.len() - 1])
    }
}

fn serve(folder: &Path) {
    let skin = AvatarSkin::of(&build_head(&HeadSpec::default())).expect("a skin");
    let face = Face::of(&skin).expect("a face");
    let problem = Problem::new(&face);
    problem.write(folder);
    println!("{{\"ready\": true, \"places\": {}}}", problem.units.len());
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        let (seconds, answer) = black_box(problem.measured(line.trim()));
        println!("{{\"seconds\": {seconds}, \"answer\": {answer}}}");
    }
}
