//! A model that has learnt: what it tells apart, by what, and from whom; kept as JSON.

mod apply;
mod classifier;
mod joined;
mod json;
mod learn;
mod method;

use serde::{Deserialize, Serialize};

pub use apply::{Answer, Decode, Decoding, Suggested};
pub use classifier::Classifier;
pub use joined::LearntLabel;
pub use json::{LARGEST, VERSION};
pub use learn::{AnnotatedTake, Lesson};
pub use method::{HmmOptions, Isolation, Method};

use crate::{AnnotateError, Temperature};
use mimique_avatar::map_shapes;

/// A model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Model {
    /// What the labels are of: the name of the annotators' tier.
    pub channel: String,
    /// Names of the labels, by index.
    pub labels: Vec<String>,
    /// Names of the shapes, by column.
    pub shapes: Vec<String>,
    /// Frames per second of the takes it learnt from.
    pub rate_hz: f64,
    /// The method and its settings.
    pub settings: Method,
    /// Training frames a second, of methods that learn frames; all where none is given.
    pub thinned_to_hz: Option<f64>,
    /// How its labels of frames become segments where nothing else is asked for.
    pub decoding: Decoding,
    /// What scores are divided by.
    pub temperature: Temperature,
    /// Whether it holds frames of people as they were: its file is then their data.
    holds_frames: bool,
    /// What it learnt from.
    pub learnt_from: LearntFrom,
    /// What it has learnt.
    classifier: Classifier,
}

/// What a model learnt from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct LearntFrom {
    /// The takes.
    pub takes: Vec<LearntTake>,
    /// Seconds of each label, by index.
    pub seconds: Vec<f64>,
    /// How many of the takes were held out in turn for the temperature; 0 where none could be.
    pub held_out: usize,
    /// How each hidden Markov model was learnt; empty for other methods.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hmm: Vec<LearntLabel>,
}

/// A take that a model learnt from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct LearntTake {
    /// Its name.
    pub name: String,
    /// Whose face it is.
    pub person: String,
    /// What was performed.
    pub kind: String,
    /// SHA-256 of its weights, by which it is known again under another name.
    pub weights: String,
}

impl Model {
    /// What it has learnt.
    pub fn classifier(&self) -> &Classifier {
        &self.classifier
    }

    /// The columns of a take that are the model's shapes, in the model's order.
    ///
    /// # Errors
    /// [`AnnotateError::Shapes`] with the first that the take lacks.
    pub fn columns(&self, shapes: &[impl AsRef<str>]) -> Result<Vec<usize>, AnnotateError> {
        columns(&self.shapes, shapes)
    }
}

/// The columns of a take that are these shapes, in this order, matched by name: the very same, else one
/// that means the same in another rig's spelling (`EyeBlinkLeft`, `eyeBlink_L`).
///
/// # Errors
/// [`AnnotateError::Shapes`] with the first that the take lacks.
pub fn columns(wanted: &[String], shapes: &[impl AsRef<str>]) -> Result<Vec<usize>, AnnotateError> {
    let place = |own: &String| shapes.iter().position(|shape| shape.as_ref() == own);
    let exact: Vec<Option<usize>> = wanted.iter().map(place).collect();
    let meant = match exact.contains(&None) {
        true => map_shapes(wanted, shapes).terms,
        false => Vec::new(),
    };
    let of = |(k, column): (usize, Option<usize>)| match (column, meant.get(k).map(Vec::as_slice)) {
        (Some(column), _) => Ok(column),
        (None, Some(&[(column, 1.0)])) => Ok(column),
        _ => Err(AnnotateError::Shapes { shape: wanted[k].clone() }),
    };
    exact.into_iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        BaumWelch, ForestOptions, LabelPath, LogisticOptions, Mark, Marked, SvmOptions, Take,
        Topology,
    };
    use mimique_test_support::Random;

    /// Ten seconds at 30 Hz: neutral, smile, frown, neutral, with noise; a transition unmarked.
    fn annotated(seed: u64) -> AnnotatedTake {
        let mut random = Random::new(seed);
        let faces = [[0.0, 0.0, 0.0], [0.8, 0.1, 0.0], [0.0, 0.1, 0.7], [0.0, 0.0, 0.0]];
        let values = (0..300).flat_map(|f| {
            let place = f as f64 / 75.0;
            let (now, next) = (faces[f / 75], faces[(f / 75 + 1).min(3)]);
            let way = ((place.fract() - 0.9) / 0.1).max(0.0);
            [0, 1, 2].map(|c| now[c] + way * (next[c] - now[c]) + 0.03 * random.normal())
        });
        let take = Take::new(values.collect(), 3, 30.0).unwrap();
        let labels = [0, 1, 2, 0].into_iter().enumerate();
        let marked = labels.map(|(i, label)| Marked {
            frames: 75 * i..75 * i + if i == 3 { 75 } else { 67 },
            mark: Mark::Stable(label),
        });
        AnnotatedTake {
            name: format!("take {seed}"),
            person: "a".to_owned(),
            kind: String::new(),
            take,
            marked: marked.collect(),
        }
    }

    fn methods() -> Vec<Method> {
        let learning = BaumWelch { steps: 5, ..BaumWelch::default() };
        let hmm = HmmOptions { states: 2, components: 2, learning, ..HmmOptions::default() };
        vec![
            Method::Knn { k: 3 },
            Method::Svm(SvmOptions::default()),
            Method::Logistic(LogisticOptions::default()),
            Method::Forest(ForestOptions { trees: 30, ..ForestOptions::default() }),
            Method::Hmm(hmm),
            Method::Hmm(HmmOptions { topology: Topology::LeftRight, ..hmm }),
        ]
    }

    fn lesson(method: Method) -> Lesson {
        Lesson {
            channel: "affect".to_owned(),
            labels: ["neutral", "joy", "sadness"].map(str::to_owned).to_vec(),
            shapes: ["smile", "open", "frown"].map(str::to_owned).to_vec(),
            method,
            thinned_to_hz: Some(10.0),
            decoding: Decoding::default(),
        }
    }

    #[test]
    fn every_method_finds_planted_segments_and_its_json_is_read_as_it_was() {
        let takes = [annotated(1), annotated(2), annotated(3)];
        for method in methods() {
            let lesson = lesson(method);
            let model = lesson.learn_calibrated(&takes[..2]).unwrap();
            assert_eq!(model.learnt_from.held_out, 2);
            let text = model.to_json().unwrap();
            let read = Model::from_json(&text).unwrap();
            assert_eq!(read, model, "{method:?}");
            let path = Decode::Path(LabelPath { mean_stay_s: 1.0, temper: 1.0 });
            let answer = read.label(&takes[2].take, &path).unwrap();
            let labels: Vec<usize> = answer.segments.iter().map(|s| s.label).collect();
            assert_eq!(labels, [0, 1, 2, 0], "{method:?}");
            for (segment, marked) in answer.segments.iter().zip(&takes[2].marked) {
                assert!(segment.frames.start.abs_diff(marked.frames.start) <= 9, "{method:?}");
                let (second, share) = segment.second.unwrap();
                assert!(second != segment.label && share <= segment.probability, "{method:?}");
            }
            for row in answer.probabilities.iter() {
                assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            }
            let given: Vec<_> = takes[2].marked.iter().map(|m| m.frames.clone()).collect();
            let answer = read.label(&takes[2].take, &Decode::Segments(given)).unwrap();
            assert_eq!(answer.segments.iter().map(|s| s.label).collect::<Vec<_>>(), [0, 1, 2, 0]);
            let frames = read.label(&takes[2].take, &Decode::Frames).unwrap();
            assert!(frames.segments.len() >= 4);
            assert!((model.learnt_from.seconds[1] - 2.0 * 67.0 / 30.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_order_of_shapes_and_takes_does_not_matter_nor_do_threads() {
        let takes = [annotated(4), annotated(5), annotated(6)];
        let turned = |annotated: &AnnotatedTake| AnnotatedTake {
            take: annotated.take.columns(&[2, 0, 1]).unwrap(),
            ..annotated.clone()
        };
        for method in methods() {
            let lesson = lesson(method);
            let found = |train: &[AnnotatedTake], test: &AnnotatedTake| {
                lesson.learn(train).unwrap().label(&test.take, &Decode::default()).unwrap()
            };
            let on = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| found(&takes[..2], &takes[2]))
            };
            assert_eq!(on(1), on(3), "{method:?}");
            let (one, other) =
                (on(1), found(&[turned(&takes[1]), turned(&takes[0])], &turned(&takes[2])));
            let labels = |a: &Answer| a.segments.iter().map(|s| s.label).collect::<Vec<_>>();
            assert_eq!(labels(&one), labels(&other), "{method:?}");
        }
    }

    #[test]
    fn what_is_no_model_is_refused_with_its_place() {
        let model = lesson(Method::Knn { k: 1 }).learn(&[annotated(1)]).unwrap();
        let text = model.to_json().unwrap();
        let refused = |text: &str| Model::from_json(text).unwrap_err();
        assert_eq!(
            refused(&text.replacen("\"version\":1", "\"version\":2", 1)),
            AnnotateError::Version { version: 2, known: 1 }
        );
        assert_eq!(refused("{"), AnnotateError::Json { line: 1, column: 1 });
        let fewer = text.replacen("[\"neutral\",", "[", 1);
        assert_eq!(refused(&fewer), AnnotateError::Unfit { part: "parameters" });
        let wider = text.replacen("[\"smile\",", "[\"smile\",\"blink\",", 1);
        assert_eq!(refused(&wider), AnnotateError::Unfit { part: "columns" });
        assert!(matches!(
            refused(&text.replacen("\"width\":3", "\"width\":0", 1)),
            AnnotateError::Json { .. }
        ));
        assert!(model.classifier().holds_frames());
    }

    #[test]
    fn other_shapes_and_rates_are_refused() {
        let takes = [annotated(1), annotated(2)];
        let lesson = lesson(methods()[4]);
        let model = lesson.learn(&takes).unwrap();
        let slower = Take { rate_hz: 25.0, ..takes[0].take.clone() };
        let error = model.label(&slower, &Decode::default()).unwrap_err();
        assert_eq!(error, AnnotateError::Rate { found: 25.0, expected: 30.0 });
        assert_eq!(model.columns(&["frown", "x", "open", "smile"]).unwrap(), [3, 2, 0]);
        let arkit = ["jawOpen", "eyeBlinkLeft", "smile"].map(str::to_owned);
        let other = ["smile", "HeadYaw", "EyeBlink_L", "JawOpen"];
        assert_eq!(columns(&arkit, &other).unwrap(), [3, 2, 0]);
        // Half of it is not it.
        assert!(columns(&["browInnerUp".to_owned()], &["browInnerUp_L", "browInnerUp_R"]).is_err());
        let missing = AnnotateError::Shapes { shape: "open".to_owned() };
        assert_eq!(model.columns(&["frown", "smile"]).unwrap_err(), missing);
        assert_eq!(lesson.check_takes(&takes), Ok(()));
        let few = AnnotateError::FewTakes { label: 0, takes: 1 };
        assert_eq!(lesson.check_takes(&takes[..1]), Err(few));
        let report = &model.learnt_from.hmm;
        assert!(report.len() == 3 && report.iter().all(|l| l.log_likelihood.len() >= 2));
        let mixed = [takes[0].clone(), AnnotatedTake { take: slower, ..takes[1].clone() }];
        assert!(matches!(lesson.learn(&mixed), Err(AnnotateError::Rate { .. })));
    }
}
