//! A study with sound: the sound check, a play whose sound was not played, the rows.

use std::collections::BTreeMap;

use mimique_session::flow::{Input, Phase, View};
use mimique_session::rows::{SessionRecord, tidy};
use mimique_session::wire::SessionStarted;
use mimique_session::{Admission, SOUND_HEARD, Standing};
use mimique_study::Answers;
use serde_json::{Value, json};

use crate::support::{self, Page, small};

/// Two performances with sound, one played later than the face; one clip a performance.
fn text(hearing: &str) -> String {
    let sequence = json!({ "order": "fixed", "components": ["faces"] });
    let mut file = small::small_file(1, &[("joy", 2), ("fear", 2)], 1, sequence);
    file["sound"] = json!({ "captions": "offered", "check": { "hearing": hearing } });
    for segment in file["stimuli"]["segments"].as_array_mut().unwrap() {
        segment["sound"] = json!({ "file": "voice.wav" });
    }
    file.to_string()
}

fn checked(outcome: &str) -> Input {
    let answers = [("sound_check", json!(outcome)), ("sound_check_attempts", json!(2))];
    let answers: Answers = answers.map(|(name, value)| (name.to_owned(), value)).into();
    Input::PageScripted(answers)
}

/// The page stands at the sound check.
fn at_check(hearing: &str) -> Page {
    let mut page = Page::open(&text(hearing), 1);
    while !matches!(page.view(), View::Scripted(_)) {
        assert!(page.act(&mut |_, _| Value::Null), "{:?}", page.view());
    }
    page
}

#[test]
fn the_check_says_what_it_is_in_both_languages_and_is_passed_by_its_result_alone() {
    let mut page = at_check("noted");
    let View::Scripted(shown) = page.view() else { panic!() };
    assert_eq!(shown.heading, "Sound");
    let pages: Value = serde_json::from_str(&shown.pages).unwrap();
    assert_eq!(pages["check"]["mostTones"], 4);
    assert_eq!(pages["words"]["fr"]["sound_heading"], "Le son");
    page.send(Input::Next);
    assert!(matches!(page.view(), View::Scripted(_)), "the button of other pages leads nowhere");
    page.reload();
    assert!(matches!(page.view(), View::Scripted(_)));
    page.send(checked("not_heard"));
    let View::Trial(trial) = page.view() else { panic!("{:?}", page.view()) };
    assert_eq!(trial.captions, Some(["offered", "Captions"].map(str::to_owned)));
    // Its events are ones that the server takes, and others are not.
    let admission = Admission::of(&page.plan);
    assert!(
        page.stored.iter().filter(|event| admission.misfit(&event.body).is_some()).count() == 0
    );
    let forged = json!({ "type": "page_finished", "step": "sound", "answers": { "age": 1 } });
    assert!(admission.misfit(&forged).is_some());
}

#[test]
fn who_does_not_hear_is_screened_out_where_hearing_is_required() {
    let mut page = at_check("required");
    page.send(checked("miscounted"));
    assert_eq!(page.state.record.standing, Standing::ScreenedOut);
    let View::End(end) = page.view() else { panic!("{:?}", page.view()) };
    assert!(end.text[0].contains("can hear its sound"), "{:?}", end.text);
    let mut page = at_check("required");
    page.send(checked(SOUND_HEARD));
    assert!(page.state.record.standing.is_open());
}

fn rows(page: &Page) -> Vec<BTreeMap<String, Value>> {
    let started: &SessionStarted = &page.plan.started;
    let record = SessionRecord { started, events: &page.stored };
    let table = tidy(&page.study, &BTreeMap::new(), [record]);
    let names: Vec<String> = table.columns.iter().map(|column| column.name.clone()).collect();
    table.rows.into_iter().map(|row| names.iter().cloned().zip(row).collect()).collect()
}

#[test]
fn a_clip_whose_sound_was_not_played_is_offered_once_more_then_the_rows_say_so() {
    let mut page = at_check("noted");
    page.send(checked(SOUND_HEARD));
    page.sound = json!({ "status": "suspended", "delay_ms": 0.0, "file": "ab" });
    page.send(Input::Play);
    let View::Trial(trial) = page.view() else { panic!() };
    assert_eq!(trial.phase, Phase::Ready);
    assert!(trial.message.starts_with("The sound of this clip could not be played"));
    page.send(Input::Play);
    let View::Trial(trial) = page.view() else { panic!() };
    assert_eq!(trial.phase, Phase::Answering, "a browser without sound keeps nobody from going on");
    assert!(trial.message.starts_with("The sound of this clip could not be played"));
    while matches!(page.view(), View::Trial(trial) if !trial.heading.contains("2 of")) {
        let mut choose = |_: &str, _: &mimique_session::flow::QuestionKindView| json!(3);
        page.act(&mut choose);
    }
    page.sound = json!({ "status": "played", "offset_ms": 2.5, "delay_ms": 0.0, "drift_ms": -0.25,
        "latency_ms": 41.0, "latency_source": "timestamp", "captions": true, "file": "ab" });
    while page.act(&mut |_, _| json!(3)) {}
    let rows = rows(&page);
    let check = rows.iter().find(|row| row["response_id"] == "sound_check").unwrap();
    assert_eq!((&check["answer"], &check["trial_id"]), (&json!("heard"), &json!("sound")));
    let trials: Vec<_> = rows.iter().filter(|row| row["trial_type"] == "trial").collect();
    let [first, second] = trials.as_slice() else { panic!("{} trials", trials.len()) };
    assert_eq!(first["sound_status"], "suspended");
    assert_eq!(first["sound_offset_ms"], Value::Null);
    assert_eq!(first["interruptions"], 1);
    assert_eq!(second["sound_status"], "played");
    assert_eq!(
        (&second["sound_offset_ms"], &second["sound_drift_ms"]),
        (&json!(2.5), &json!(-0.25))
    );
    assert_eq!(second["captions_shown"], true);
    assert_eq!(
        (&second["sound_check"], &second["sound_check_attempts"]),
        (&json!("heard"), &json!(2))
    );
}

#[test]
fn a_study_without_sound_has_neither_page_nor_columns() {
    let page = Page::open(&support::study_text("demo.json"), 1);
    assert!(page.plan.steps.iter().all(|step| step.id != "sound"));
    assert!(page.plan.study.sound.is_null());
    let table = tidy(&page.study, &BTreeMap::new(), []);
    assert_eq!(table.column("sound_status"), None);
    let projection = serde_json::to_string(&page.plan.study).unwrap();
    assert!(!projection.contains("\"sound"), "nothing is sent of it");
}
