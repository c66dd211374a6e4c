//! Which events a session's plan admits: all that a page sends, and nothing that no page could send.

use mimique_session::{Admission, Misfit, Record, Standing};
use serde_json::{Value, json};

use crate::support::{Page, first_answer, study_text};

const STUDIES: [&str; 5] =
    ["demo.json", "template.json", "study1.json", "study2b.json", "animface.json"];

#[test]
fn whatever_a_page_sends_is_admitted() {
    let mut seen = std::collections::BTreeSet::new();
    for name in STUDIES {
        for participant in [1, 2, 7] {
            let mut page = Page::open(&study_text(name), participant);
            page.finish();
            let admission = Admission::of(&page.plan);
            let record = Record::of(None, &page.stored);
            assert_eq!(record.standing, Standing::Completed);
            assert!(admission.is_done(&record), "{name}");
            let limits = admission.limits();
            let bytes: usize = page.stored.iter().map(|event| event.body.to_string().len()).sum();
            assert!(10 * page.stored.len() as u64 <= limits.events, "{name}: {limits:?}");
            assert!(10 * bytes as u64 <= limits.bytes, "{name}: {bytes} of {limits:?}");
            // Without any one of its trials and pages of questions nobody is at the end.
            let last = page.stored.iter().rposition(|event| event.body["type"] == "trial_finished");
            let mut lacking = page.stored.clone();
            lacking.remove(last.expect("a trial"));
            assert!(!admission.is_done(&Record::of(None, &lacking)), "{name}");
            assert!(page.stored.len() > 20, "{name}: {}", page.stored.len());
            for event in &page.stored {
                assert_eq!(admission.misfit(&event.body), None, "{name}: {}", event.body);
                seen.extend(event.body["type"].as_str().map(str::to_owned));
            }
        }
    }
    for kind in ["page_finished", "trial_started", "trial_played", "trial_finished", "answered"] {
        assert!(seen.contains(kind), "{kind} in {seen:?}");
    }
}

#[test]
fn a_session_has_room_by_its_steps_and_questions() {
    let limits = |change: &dyn Fn(&mut Value)| {
        let mut file = mimique_study::parse(&study_text("demo.json")).unwrap();
        change(&mut file);
        Admission::of(&Page::open(&file.to_string(), 1).plan).limits()
    };
    let plain = limits(&|_| {});
    let shared = limits(&|file| {
        let more = json!({"id": "more", "prompt": "Why?", "type": "longText"});
        file["questions"].as_array_mut().unwrap().push(more);
        let trials = &mut file["components"]["faces"]["questions"];
        trials.as_array_mut().unwrap().push(json!("more"));
    });
    // One question more in each of twelve trials, at a hundred events and 64 KiB each.
    assert_eq!(shared.events, plain.events + 12 * 100);
    assert_eq!(shared.bytes, plain.bytes + 12 * 64 * 1024);
    let page = limits(&|file| {
        file["components"]["after"] = json!({"type": "questionnaire", "questions": [
            {"id": "age2", "prompt": "Age?", "type": "number", "min": 1, "max": 120}]});
        file["sequence"]["components"].as_array_mut().unwrap().push(json!("after"));
    });
    assert_eq!(page.events, plain.events + 200 + 100);
}

#[test]
fn what_no_page_of_the_plan_could_send_is_no_event_of_the_session() {
    let mut page = Page::open(&study_text("demo.json"), 1);
    while !page.stored.iter().any(|event| event.body["type"] == "trial_finished") {
        assert!(page.act(&mut first_answer));
    }
    let admission = Admission::of(&page.plan);
    let finished = page.stored.iter().find(|event| event.body["type"] == "trial_finished");
    let trial = finished.unwrap().body.clone();
    let pages = page.stored.iter().find(|event| event.body["type"] == "page_finished");
    let read = pages.unwrap().body.clone();
    let with = |body: &Value, key: &str, value: Value| {
        let mut body = body.clone();
        body[key] = value;
        body
    };
    let question = trial["answers"].as_object().unwrap().keys().next().unwrap().clone();
    for (body, misfit) in [
        (with(&trial, "step", json!("")), Misfit::NoSuchStep),
        (with(&trial, "step", json!("faces/other")), Misfit::NoSuchStep),
        (with(&trial, "clip", json!("other")), Misfit::OtherClip),
        (with(&trial, "step", read["step"].clone()), Misfit::OtherKind),
        (with(&trial, "answers", json!({"other": 1})), Misfit::NoSuchQuestion),
        (with(&trial, "answers", json!({question: {"a": [1]}})), Misfit::NoSuchAnswer),
        (with(&trial, "timed_out", json!(true)), Misfit::NoTimeLimit),
        (with(&trial, "rt_ms", json!("soon")), Misfit::Unreadable),
        (with(&read, "step", trial["step"].clone()), Misfit::OtherKind),
        (with(&read, "step", json!("=cmd()")), Misfit::NoSuchStep),
        (json!({"type": "answered", "step": "", "question": "x", "value": 1}), Misfit::NoSuchStep),
        (json!({"type": "page_shown", "step": "nowhere"}), Misfit::NoSuchStep),
        (json!({"type": "unheard_of"}), Misfit::Unreadable),
        (json!({}), Misfit::Unreadable),
    ] {
        assert_eq!(admission.misfit(&body), Some(misfit), "{body}");
    }
    assert_eq!(admission.misfit(&trial), None);
}
