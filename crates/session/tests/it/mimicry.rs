//! A study that measures faces: the consent of its own, plays with tracks, the rows.

use std::collections::BTreeMap;

use mimique_session::flow::{Input, View};
use mimique_session::rows::{SessionRecord, tidy};
use mimique_session::{Admission, Record};
use mimique_study::{Answers, TRACKED_SHAPES};
use serde_json::{Value, json};

use crate::support::{self, Page, small};

fn text() -> String {
    let sequence = json!({ "order": "fixed", "components": ["faces"] });
    let mut file = small::small_file(1, &[("joy", 2), ("fear", 2)], 1, sequence);
    file["mimicry"] = json!({
        "consent": { "version": "2", "heading": { "en": "Your face", "fr": "Votre visage" },
            "text": { "en": "We ask why.\n\nFor a year.", "fr": "Pourquoi.\n\nUn an." } },
        "model": "face_landmarker.task", "runtime": "tasks-vision",
    });
    file.to_string()
}

fn said(consent: &str, camera: &str) -> Input {
    let answers =
        [("mimicry_consent", consent), ("mimicry_version", "2"), ("mimicry_camera", camera)];
    let answers: Answers = answers.map(|(name, word)| (name.to_owned(), json!(word))).into();
    Input::PageScripted(answers)
}

fn at_consent() -> Page {
    let mut page = Page::open(&text(), 1);
    while !matches!(page.view(), View::Scripted(_)) {
        assert!(page.act(&mut |_, _| Value::Null), "{:?}", page.view());
    }
    page
}

/// A track of four pictures, the third without a face.
fn track() -> Value {
    let scores = |jaw: u32| -> Vec<u32> {
        TRACKED_SHAPES.iter().map(|name| if *name == "jawOpen" { jaw } else { 0 }).collect()
    };
    let frame = |at_ms: f64, jaw: u32| -> Value {
        json!([vec![json!(at_ms)], scores(jaw).into_iter().map(Value::from).collect()].concat())
    };
    json!({ "status": "tracked", "clock": "capture", "model": "ab",
        "frames": [frame(2.5, 10), frame(36.0, 900), [69.5], frame(103.0, 30)] })
}

fn rows(page: &Page) -> Vec<BTreeMap<String, Value>> {
    let record = SessionRecord { started: &page.plan.started, events: &page.stored };
    let table = tidy(&page.study, &BTreeMap::new(), [record]);
    let names: Vec<String> = table.columns.iter().map(|column| column.name.clone()).collect();
    table.rows.into_iter().map(|row| names.iter().cloned().zip(row).collect()).collect()
}

#[test]
fn the_consent_has_a_page_of_its_own_and_is_passed_by_its_answer_alone() {
    let mut page = at_consent();
    let View::Scripted(shown) = page.view() else { panic!() };
    assert_eq!((shown.step.as_str(), shown.heading.as_str()), ("mimicry", "Your face"));
    assert_eq!(shown.text, ["We ask why.", "For a year."]);
    let pages: Value = serde_json::from_str(&shown.pages).unwrap();
    assert_eq!(
        (&pages["version"], &pages["rateHz"], &pages["needsFace"]),
        (&json!("2"), &json!(30.0), &json!(false))
    );
    assert_eq!(pages["shapes"].as_array().unwrap().len(), 52);
    assert_eq!(pages["words"]["fr"]["mimicry_heading"], "Votre visage");
    assert!(
        !shown.pages.contains("face_landmarker"),
        "where the researcher's files are is not sent"
    );
    page.send(Input::Next);
    assert!(matches!(page.view(), View::Scripted(_)), "the button of other pages leads nowhere");
    page.reload();
    assert!(matches!(page.view(), View::Scripted(_)));
    page.send(said("declined", "off"));
    assert!(matches!(page.view(), View::Trial(_)), "who declines goes on");
    // Its events are ones that the server takes, and others are not.
    let admission = Admission::of(&page.plan);
    assert!(page.stored.iter().all(|event| admission.misfit(&event.body).is_none()));
    for answers in [json!({}), json!({ "mimicry_consent": "agreed", "picture": "data:" })] {
        let forged = json!({ "type": "page_finished", "step": "mimicry", "answers": answers });
        assert!(admission.misfit(&forged).is_some(), "{forged}");
    }
    // Without that page nobody comes to the end.
    assert!(!admission.is_done(&Record::default()));
    while page.act(&mut |_, _| json!(3)) {}
    for row in rows(&page).iter().filter(|row| row["trial_type"] == "trial") {
        assert_eq!(
            (&row["mimicry_consent"], &row["mimicry_camera"]),
            (&json!("declined"), &json!("off"))
        );
        assert_eq!(
            (&row["mimicry_status"], &row["mimicry_pictures"]),
            (&Value::Null, &Value::Null)
        );
    }
}

#[test]
fn tracks_stay_in_the_events_and_rows_count_their_pictures() {
    let mut page = at_consent();
    page.send(said("agreed", "seen"));
    page.mimicry = track();
    page.send(Input::Play);
    page.mimicry = json!({ "status": "stopped", "clock": "", "model": "ab", "frames": [] });
    while page.act(&mut |_, _| json!(3)) {}
    let played: Vec<&Value> = page
        .stored
        .iter()
        .map(|event| &event.body)
        .filter(|body| body["type"] == "trial_played")
        .collect();
    assert_eq!(played[0]["log"]["mimicry"], track(), "the event has all of it");
    let own: Vec<_> = rows(&page).into_iter().filter(|row| row["trial_type"] == "trial").collect();
    let [first, second] = own.as_slice() else { panic!("{} trials", own.len()) };
    assert_eq!((&first["mimicry_pictures"], &first["mimicry_faces"]), (&json!(4), &json!(3)));
    assert_eq!(
        (&first["mimicry_status"], &first["mimicry_clock"]),
        (&json!("tracked"), &json!("capture"))
    );
    assert_eq!(
        (&second["mimicry_status"], &second["mimicry_pictures"]),
        (&json!("stopped"), &json!(0))
    );
    let consent =
        rows(&page).into_iter().find(|row| row["response_id"] == "mimicry_consent").unwrap();
    assert_eq!(consent["answer"], "agreed");
    // The record, which servers hold of many sessions, has no pictures.
    let record = Record::of(None, &page.stored);
    let play = record.finished.iter().find_map(|step| step.attempt.play.as_ref()).unwrap();
    assert_eq!((&play.mimicry["frames"], &play.mimicry["faces"]), (&json!(4), &json!(3)));
}

#[test]
fn a_study_without_has_neither_page_nor_columns() {
    let page = Page::open(&support::study_text("demo.json"), 1);
    assert!(page.plan.steps.iter().all(|step| step.id != "mimicry"));
    assert!(page.plan.study.mimicry.is_null());
    assert_eq!(tidy(&page.study, &BTreeMap::new(), []).column("mimicry_status"), None);
    assert!(!serde_json::to_string(&page.plan.study).unwrap().contains("mimicry"));
}
