//! Blocks of reverse correlation from the page to the export: every trial shows a face of its own, which seed and
//! participant give again.

use std::collections::BTreeMap;

use mimique_session::flow::Input;
use mimique_session::rows::{SessionRecord, Table, tidy};
use mimique_session::wire::{Event, SessionStarted};
use mimique_session::{Admission, PlayLog};
use mimique_study::{
    ClipSource, Draw, ReverseCorrelationComponent, ShownCourse, Study, UnitShapes,
};
use serde_json::{Value, json};

use crate::support::stepped::{self, Page};

const SEED: u64 = 20_261_126;
const TRIALS: usize = 5;

fn study() -> Study {
    stepped::study("reverse-correlation.json", |study| {
        study["components"]["faces"]["trials"] = TRIALS.into();
        study["sequence"]["interruptions"][0]["spacing"] = 2.into();
    })
}

fn block(study: &Study) -> ReverseCorrelationComponent {
    study.reverse_correlations().next().unwrap().1
}

fn started(participant: u64, config_hash: &str) -> SessionStarted {
    stepped::started(SEED, participant, config_hash)
}

/// An avatar with a shape for each unit.
fn at_rest(study: &Study) -> BTreeMap<String, ClipSource> {
    let block = block(study);
    let shapes = block.units.len();
    let units = UnitShapes { shapes, units: (0..shapes).map(|k| vec![(k, 1.0)]).collect() };
    let source = json!({
        "avatar": "a", "operators": "", "take": "", "method": { "method": "recorded" },
        "duration_ms": 1250, "bytes": 1, "provenance": "p", "weights_hash": "", "units": units,
    });
    BTreeMap::from([(block.clip, serde_json::from_value(source).expect("a clip"))])
}

/// The weights that a browser shows in the trial of a step.
fn shown_hash(study: &Study, step: &str, started: &SessionStarted) -> String {
    let block = block(study);
    let draw = Draw {
        seed: started.seed,
        config_hash: &started.config_hash,
        participant: started.slot(),
        condition: None,
    };
    let shown = block.trajectories(step, draw).unwrap();
    let units = at_rest(study)[&block.clip].units.clone().unwrap();
    block.face(&shown, &units).weights_hash
}

impl Page {
    /// Goes through the study; `hash` gives the weights that a trial's face has on this device.
    fn go(&mut self, hash: impl Fn(&str) -> String) -> Vec<String> {
        let mut played = Vec::new();
        while let Some(step) = self.step() {
            self.send(Input::Shown { step: step.clone() });
            if step.starts_with("faces/") {
                self.send(Input::Play);
                let weights_hash = hash(&step);
                self.send(Input::Played(PlayLog { weights_hash, ..PlayLog::default() }));
                let answer = |question: &str, value: Value| Input::Answer {
                    question: question.to_owned(),
                    value,
                };
                self.send(answer("emotion", "joy".into()));
                self.send(answer("strength", 3.into()));
                played.push(step.clone());
            }
            self.send(Input::Next);
            assert_ne!(self.step(), Some(step), "the step is left");
        }
        played
    }
}

fn rows(study: &Study, started: &SessionStarted, events: &[Event]) -> Table {
    tidy(study, &at_rest(study), [SessionRecord { started, events }])
}

#[test]
fn every_trial_has_a_face_of_its_own_which_the_export_draws_again() {
    let study = study();
    let own = started(3, "abc");
    let mut page = Page::open(&study, own.clone());
    let steps = page.go(|step| shown_hash(&study, step, &own));
    assert_eq!(steps.len(), TRIALS);
    for step in &steps {
        assert!(page.prepared.contains(step), "{step} is drawn before it is played");
        let (at_rest, drawn_from) = page.plan.face(step).unwrap();
        assert_eq!(at_rest, "faces@drawn");
        assert_eq!((&drawn_from["step"], &drawn_from["slot"]), (&json!(step), &json!(3)));
        assert_eq!((&drawn_from["seed"], &drawn_from["configHash"]), (&json!(SEED), &json!("abc")));
        assert_eq!(drawn_from["block"]["units"], json!(block(&study).units));
    }
    assert_eq!(page.plan.face("rest"), None);
    let admission = Admission::of(&page.plan);
    for event in &page.events {
        assert_eq!(admission.misfit(&event.body), None, "{}", event.body);
    }
    let table = rows(&study, &own, &page.events);
    let mut faces: Vec<Vec<ShownCourse>> = Vec::new();
    for row in 0..table.rows.len() {
        if table.cell(row, "response_id") != "emotion" {
            continue;
        }
        let cell = |name: &str| table.cell(row, name);
        assert_eq!(
            (cell("stimulus"), cell("weights_expected")),
            (&json!("faces@drawn"), &json!(true))
        );
        assert_eq!(cell("trial_type"), "trial");
        faces.push(serde_json::from_str(cell("trajectories").as_str().unwrap()).unwrap());
    }
    assert_eq!(faces.len(), TRIALS);
    faces.dedup();
    assert_eq!(faces.len(), TRIALS, "no two are alike");
}

#[test]
fn weights_that_the_seed_does_not_give_are_told() {
    let study = study();
    let own = started(3, "abc");
    let mut page = Page::open(&study, own.clone());
    // Somebody else's faces in the second trial, none known in the third.
    page.go(|step| match step {
        "faces/2" => shown_hash(&study, step, &started(4, "abc")),
        "faces/3" => String::new(),
        _ => shown_hash(&study, step, &own),
    });
    let table = rows(&study, &own, &page.events);
    let expected: Vec<&Value> = (0..table.rows.len())
        .filter(|row| table.cell(*row, "response_id") == "emotion")
        .map(|row| table.cell(row, "weights_expected"))
        .collect();
    assert_eq!(expected, [&json!(true), &json!(false), &Value::Null, &json!(true), &json!(true)]);
}

#[test]
fn before_the_session_no_face_is_asked_for() {
    let page = Page::open(&study(), started(0, ""));
    assert!(page.prepared.iter().all(|name| !name.starts_with("faces")), "{:?}", page.prepared);
}
