//! Hidden Markov models and label paths against enumeration, hmmlearn and 80-bit arithmetic.

use mimique_annotate::{BaumWelch, Composite, Hmm, LabelPath, Mixture, Rows, runs};
use serde_json::Value;

use crate::cases::{indices, json, list, near, number, numbers, relative, words};

fn rows(value: &Value) -> Rows {
    Rows::new(numbers(value), list(&value[0]).len()).unwrap()
}

fn model(value: &Value) -> Hmm {
    let states = list(&value["start"]).len();
    let mixture = |s: usize| {
        let (mean, variance) = (rows(&value["mean"][s]), rows(&value["variance"][s]));
        Mixture::new(numbers(&value["weight"][s]), mean, variance).unwrap()
    };
    let mixtures = (0..states).map(mixture).collect();
    Hmm::new(numbers(&value["start"]), rows(&value["transition"]), mixtures).unwrap()
}

#[test]
fn given_models() {
    let Some(cases) = json("given_models", "hmm/given.json") else { return };
    for case in list(&cases) {
        let what = case["name"].as_str().unwrap();
        let (hmm, sequence) = (model(&case["model"]), rows(&case["sequence"]));
        let states = hmm.start().len();
        let found = hmm.posterior(&sequence).unwrap();
        relative(&[found.log_likelihood], &numbers(&case["log_likelihood"]), 1e-9, 1.0, what);
        let path = hmm.best_path(&sequence).unwrap();
        assert_eq!(path.states, indices(&case["path"]), "{what}");
        let expected = numbers(&case["path_log_probability"]);
        relative(&[path.log_probability], &expected, 1e-9, 1.0, what);
        let emissions = hmm.emissions(&sequence).unwrap();
        for (i, frame) in indices(&case["frames"]).into_iter().enumerate() {
            let own = &emissions[frame * states..(frame + 1) * states];
            relative(own, &numbers(&case["emission"][i]), 1e-9, 1.0, what);
            near(found.states.row(frame), &numbers(&case["posterior"][i]), 1e-9, what);
        }
    }
}

#[test]
fn learnt_models() {
    let Some(cases) = json("learnt_models", "hmm/baum_welch.json") else { return };
    for case in list(&cases) {
        let begin = model(&case["start"]);
        let sequences: Vec<Rows> = list(&case["sequences"]).iter().map(rows).collect();
        for after in list(&case["after"]) {
            let steps = after["iterations"].as_u64().unwrap() as usize;
            let options = BaumWelch {
                steps,
                variance_floor: number(&case["variance_floor"]),
                least_frames: number(&case["least_frames"]),
                tolerance: 0.0,
            };
            let learnt = options.learn(&begin, &sequences).unwrap();
            let what = format!("{}, {steps}", case["name"]);
            let expected = model(&after["model"]);
            near(learnt.hmm.start(), expected.start(), 1e-6, &what);
            near(learnt.hmm.transition().values(), expected.transition().values(), 1e-6, &what);
            for (found, expected) in learnt.hmm.states().iter().zip(expected.states()) {
                near(found.weight(), expected.weight(), 1e-6, &what);
                near(found.mean().values(), expected.mean().values(), 1e-6, &what);
                near(found.variance().values(), expected.variance().values(), 1e-6, &what);
            }
            near(&learnt.log_likelihood, &numbers(&after["log_likelihood"]), 1e-6, &what);
        }
    }
}

#[test]
fn joined_models() {
    let Some(cases) = json("joined_models", "hmm/composite.json") else { return };
    for case in list(&cases) {
        let models: Vec<Hmm> = list(&case["models"]).iter().map(model).collect();
        let joined = Composite::join(&models, number(&case["p_out"])).unwrap();
        near(joined.hmm().start(), &numbers(&case["start"]), 1e-12, "start");
        let transition = joined.hmm().transition().values();
        near(transition, &numbers(&case["transition"]), 1e-12, "transition");
        assert_eq!(joined.class_of_state(), indices(&case["class_of_state"]));
        let sequence = rows(&case["sequence"]);
        let path = joined.hmm().best_path(&sequence).unwrap();
        assert_eq!(path.states, indices(&case["path"]));
        let expected = numbers(&case["path_log_probability"]);
        relative(&[path.log_probability], &expected, 1e-9, 1.0, "path");
        let likelihood = joined.hmm().log_likelihood(&sequence).unwrap();
        relative(&[likelihood], &numbers(&case["log_likelihood"]), 1e-9, 1.0, "likelihood");
        let names = words(&case["labels"]);
        let labels = joined.labels(&sequence).unwrap();
        let labels: Vec<&str> = labels.into_iter().map(|label| names[label]).collect();
        assert_eq!(labels, words(&case["path_labels"]));
        let posterior = joined.posterior(&sequence).unwrap();
        for (i, frame) in indices(&case["frames"]).into_iter().enumerate() {
            let expected = numbers(&case["class_posterior"][i]);
            near(posterior.row(frame), &expected, 1e-9, "posterior");
        }
    }
}

#[test]
fn label_paths() {
    let Some(file) = json("label_paths", "hmm/label_path.json") else { return };
    let names = words(&file["labels"]);
    let scores = numbers(&file["log_scores"]);
    for case in list(&file["cases"]) {
        let path = LabelPath {
            mean_stay_s: number(&case["mean_stay_s"]),
            temper: number(&case["temper"]),
        };
        let rate_hz = number(&case["rate_hz"]);
        near(&[path.stay(rate_hz)], &numbers(&case["stay"]), 1e-12, "stay");
        let found = path.labels(&scores, names.len(), rate_hz).unwrap();
        assert_eq!(found, indices(&case["path"]));
        let expected = list(&case["runs"]);
        let found = runs(&found);
        assert_eq!(found.len(), expected.len());
        for (run, expected) in found.iter().zip(expected) {
            let bounds = [&expected[0], &expected[1]].map(|v| v.as_u64().unwrap() as usize);
            assert_eq!([run.frames.start, run.frames.end], bounds);
            assert_eq!(names[run.label], expected[2].as_str().unwrap());
        }
    }
}
