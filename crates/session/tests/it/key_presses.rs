//! Questions that keys answer while the clip plays: the first press counts, on the clock of the frames.

use std::collections::BTreeMap;

use mimique_session::flow::{Input, Phase, TrialView, View, update};
use mimique_session::rows::{SessionRecord, tidy};
use mimique_session::{PlayLog, flow::State};
use mimique_study::Study;
use serde_json::{Value, json};

use crate::support::{Page, first_answer, study_text, whole_play};

/// The speeded example, with what a test changes of its question.
fn text(change: impl FnOnce(&mut Value)) -> String {
    let mut study = mimique_study::parse(&study_text("speeded.json")).unwrap();
    change(&mut study["questions"][0]);
    study.to_string()
}

fn at_first_trial(text: &str) -> Page {
    let mut page = Page::open(text, 3);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    page
}

fn trial(page: &Page) -> TrialView {
    match page.view() {
        View::Trial(trial) => *trial,
        other => panic!("{other:?}"),
    }
}

/// Takes an input without what the support's page does of its effects: a play stays in progress.
fn step(page: &mut Page, input: Input) {
    let state: State = std::mem::take(&mut page.state);
    let (state, effects) = update(&page.plan, state, input, page.now_ms);
    page.state = state;
    for effect in effects {
        if let mimique_session::flow::Effect::Store(event) = effect {
            page.stored.push(event);
        }
    }
}

fn press(value: &str, at_ms: f64) -> Input {
    Input::Press { question: "felt".to_owned(), value: value.to_owned(), at_ms }
}

#[test]
fn the_first_press_of_a_play_is_the_answer_and_its_time_is_that_of_the_press() {
    let mut page = at_first_trial(&text(|_| ()));
    assert_eq!(trial(&page).keys.len(), 1);
    assert!(trial(&page).questions.is_empty() && !trial(&page).can_press);
    let input = press("joy", page.now_ms);
    step(&mut page, input);
    assert_eq!(trial(&page).keys[0].value, None, "nothing plays yet");
    let onset_ms = page.now_ms;
    step(&mut page, Input::Play);
    page.now_ms += 700.0;
    step(&mut page, press("anger", onset_ms + 612.5));
    page.now_ms += 300.0;
    step(&mut page, press("joy", onset_ms + 950.0));
    assert_eq!(trial(&page).keys[0].value, Some(json!("anger")), "the first one");
    let before = page.state.record.step;
    page.now_ms = onset_ms + 4000.0;
    step(&mut page, Input::Played(whole_play(onset_ms)));
    assert_eq!(page.state.record.step, before + 1, "nothing else is asked");
    let study = Study::from_value(&mimique_study::parse(&text(|_| ())).unwrap()).unwrap();
    let record = SessionRecord { started: &page.plan.started, events: &page.stored };
    let table = tidy(&study, &BTreeMap::new(), [record]);
    let place = |name: &str| table.columns.iter().position(|column| column.name == name).unwrap();
    let row = table.rows.iter().find(|row| row[place("response_id")] == "felt").unwrap();
    assert_eq!(row[place("answer")], "anger");
    assert_eq!(row[place("rt")].as_f64(), Some(612.5), "from the first frame to the press");
    assert_eq!(
        row[place("rt_open")].as_f64(),
        Some(612.5),
        "keys are open from the first frame on"
    );
    let right = row[place("truth")] == "anger";
    assert_eq!(row[place("correct")], right);
}

#[test]
fn a_press_in_a_play_that_does_not_count_is_taken_back() {
    let mut page = at_first_trial(&text(|_| ()));
    let onset_ms = page.now_ms;
    step(&mut page, Input::Play);
    page.now_ms += 500.0;
    step(&mut page, press("joy", onset_ms + 400.0));
    let log = PlayLog { aborted: Some("page hidden".to_owned()), ..whole_play(onset_ms) };
    step(&mut page, Input::Played(log));
    let view = trial(&page);
    assert_eq!((view.phase, view.keys[0].value.clone()), (Phase::Ready, None));
    step(&mut page, Input::Play);
    page.now_ms += 500.0;
    let input = press("anger", page.now_ms - 10.0);
    step(&mut page, input);
    let input = Input::Played(whole_play(page.now_ms - 500.0));
    step(&mut page, input);
    let answers = &page.state.record.finished.last().unwrap().answers;
    assert_eq!(answers["felt"], "anger");
}

#[test]
fn whoever_is_too_slow_answers_after_the_clip() {
    let mut page = at_first_trial(&text(|_| ()));
    step(&mut page, Input::Play);
    page.now_ms += 4000.0;
    let input = Input::Played(whole_play(page.now_ms - 4000.0));
    step(&mut page, input);
    let view = trial(&page);
    assert_eq!(
        (view.phase, view.can_press, view.button.can_submit),
        (Phase::Answering, true, false)
    );
    let before = page.state.record.step;
    page.now_ms += 300.0;
    let input = press("nothing", page.now_ms);
    step(&mut page, input);
    assert_eq!(page.state.record.step, before, "no such option");
    let input = press("joy", page.now_ms);
    step(&mut page, input);
    assert_eq!(page.state.record.step, before + 1);
}

#[test]
fn an_option_without_a_key_stands_for_no_press() {
    let text = text(|question| question["keys"] = json!({"joy": "Space"}));
    let mut page = at_first_trial(&text);
    for pressed in [true, false] {
        // Nobody stores here: a trial waits some seconds for the answers before it.
        page.now_ms += 5_000.0;
        let onset_ms = page.now_ms;
        step(&mut page, Input::Play);
        page.now_ms += 1000.0;
        if pressed {
            step(&mut page, press("joy", onset_ms + 800.0));
        }
        let input = press("anger", page.now_ms);
        step(&mut page, input);
        page.now_ms = onset_ms + 4000.0;
        step(&mut page, Input::Played(whole_play(onset_ms)));
        let answer = &page.state.record.finished.last().unwrap().answers["felt"];
        assert_eq!(*answer, if pressed { "joy" } else { "anger" }, "it has no key to press");
        let View::Trial(_) = page.view() else { panic!("the next trial stands there") };
    }
}

/// The speeded example with a line that follows the clip in the question's place.
fn followed() -> String {
    text(|question| {
        *question = json!({
            "id": "strength", "type": "slider", "whilePlaying": true, "minimum": 0, "maximum": 100,
            "prompt": {"en": "How intense?", "fr": "Quelle intensité ?"},
            "leftLabel": {"en": "not", "fr": "pas"}, "rightLabel": {"en": "very", "fr": "très"},
        });
    })
    .replace("[\"felt\"]", "[\"strength\"]")
    .replace("\"response\":\"felt\",\"measure\":\"rt\"", "\"response\":\"strength\"")
}

#[test]
fn the_course_of_the_first_whole_play_is_the_answer_and_its_mean_is_in_the_export() {
    let mut page = at_first_trial(&followed());
    assert_eq!((trial(&page).keys.len(), trial(&page).questions.len()), (1, 0));
    let played = |page: &Page, course: Value, aborted: Option<&str>| {
        let traces = json!({"strength": course, "other": [1]});
        let aborted = aborted.map(str::to_owned);
        Input::Played(PlayLog { traces, aborted, ..whole_play(page.now_ms) })
    };
    step(&mut page, Input::Play);
    let cut = played(&page, json!([0, 0]), Some("page hidden"));
    step(&mut page, cut);
    assert_eq!(trial(&page).phase, Phase::Ready, "a play that was cut short is no answer");
    step(&mut page, Input::Play);
    let wrong = played(&page, json!([50, 101]), None);
    step(&mut page, wrong);
    assert!(!trial(&page).button.can_submit, "the line ends at 100");
    let mut page = at_first_trial(&followed());
    let before = page.state.record.step;
    step(&mut page, Input::Play);
    let whole = played(&page, json!([50, 60, 70, 80]), None);
    step(&mut page, whole);
    assert_eq!(page.state.record.step, before + 1, "nothing else is asked");
    let study = Study::from_value(&mimique_study::parse(&followed()).unwrap()).unwrap();
    let record = SessionRecord { started: &page.plan.started, events: &page.stored };
    let table = tidy(&study, &BTreeMap::new(), [record]);
    let place = |name: &str| table.columns.iter().position(|column| column.name == name).unwrap();
    let row = table.rows.iter().find(|row| row[place("response_id")] == "strength").unwrap();
    assert_eq!(
        (row[place("answer")].as_f64(), &row[place("trace")]),
        (Some(65.0), &json!("[50,60,70,80]"))
    );
    let bodies: Vec<String> = page.stored.iter().map(|event| event.body.to_string()).collect();
    assert!(bodies.iter().all(|body| !body.contains("\"traces\"")), "kept once, as the answer");
}
