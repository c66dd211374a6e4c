//! Two clips in step: who stands beside whom, on which side, and what the export says of it.

use std::collections::BTreeMap;

use mimique_session::flow::{
    BESIDE_CANVAS, Effect, Input, OWN_CANVAS, Phase, PlacedClip, TrialStep, View, update, view,
};
use mimique_session::rows::{SessionRecord, Table, tidy, wide};
use mimique_study::Study;
use serde_json::{Value, json};

use crate::support::{Page, failure, first_answer, study_text};

/// Study 2b with the companion's side drawn, and a comparison after each pair.
fn compared() -> String {
    let mut study = mimique_study::parse(&study_text("study2b.json")).unwrap();
    study["components"]["pairs"]["beside"]["side"] = json!("random");
    study["components"]["pairs"]["questions"] = json!(["fidelity", "nearer"]);
    study["questions"].as_array_mut().unwrap().push(json!({
        "id": "nearer",
        "type": "comparison",
        "prompt": {"en": "Which moves more naturally?", "fr": "Lequel bouge plus naturellement ?"},
        "allowSame": true,
    }));
    study.to_string()
}

fn trials(page: &Page) -> Vec<&TrialStep> {
    page.plan.steps.iter().filter_map(|step| step.trial()).collect()
}

fn at_first_trial(text: &str, participant: u64) -> Page {
    let mut page = Page::open(text, participant);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    page
}

#[test]
fn every_clip_stands_beside_the_same_performance() {
    let page = Page::open(&study_text("study2b.json"), 3);
    let trials = trials(&page);
    assert_eq!(trials.len(), 36);
    for trial in trials {
        let beside = trial.beside.as_ref().unwrap();
        let segment = trial.clip.split('.').next().unwrap();
        assert_eq!(beside.clip, format!("{segment}.real.actor"));
        assert!(!beside.left, "on the right, as the study says");
    }
}

#[test]
fn a_drawn_side_is_left_in_half_of_the_trials_and_differs_between_people() {
    let text = compared();
    let sides = |participant| -> Vec<bool> {
        let page = Page::open(&text, participant);
        trials(&page).iter().map(|trial| trial.beside.as_ref().unwrap().left).collect()
    };
    let first = sides(1);
    assert_eq!(first.iter().filter(|left| **left).count(), 18);
    assert_eq!(first, sides(1));
    assert_ne!(first, sides(2));
    assert_ne!(first, first.iter().rev().copied().collect::<Vec<_>>(), "not an alternation");
}

#[test]
fn a_pair_is_played_when_both_are_ready_and_fails_with_either() {
    let mut page = at_first_trial(&study_text("study2b.json"), 4);
    let (clip, beside) = {
        let View::Trial(trial) = page.view() else { panic!() };
        (trial.clip, trial.beside.unwrap().clip)
    };
    let (state, effects) = update(&page.plan, page.state.clone(), Input::Play, page.now_ms);
    let placed =
        |canvas: &str, clip: &String| PlacedClip { canvas: canvas.to_owned(), clip: clip.clone() };
    let clips = vec![placed(OWN_CANVAS, &clip), placed(BESIDE_CANVAS, &beside)];
    let play = Effect::PlayClips { clips, in_turn: false };
    assert!(effects.contains(&play), "{effects:?}");
    drop(state);

    // After a reload neither is there; one alone does not make the trial ready.
    page.state.live.prepared.clear();
    page.send(Input::ClipPrepared { clip: clip.clone() });
    let View::Trial(trial) = page.view() else { panic!() };
    assert_eq!(trial.phase, Phase::Loading { fraction: 0.5 });
    assert!(!trial.can_play);
    page.send(Input::ClipFailed { clip: beside.clone(), failure: failure("video") });
    let View::Trial(trial) = page.view() else { panic!() };
    assert!(
        matches!(&trial.phase, Phase::Failed { reason, .. } if reason.contains("play the video"))
    );
    // The support's page prepares at once what a retry asks for.
    page.send(Input::Retry);
    let View::Trial(trial) = view(&page.plan, &page.state) else { panic!() };
    assert!(trial.can_play, "{:?}", trial.phase);
}

#[test]
fn the_export_names_the_companion_its_side_and_what_was_chosen() {
    let text = compared();
    let mut page = Page::open(&text, 5);
    let mut turn = 0;
    let mut choose = |id: &str, kind: &_| match id {
        "nearer" => {
            turn += 1;
            json!(["left", "right", "same"][turn % 3])
        }
        _ => first_answer(id, kind),
    };
    while page.act(&mut choose) {}
    let study = Study::from_value(&mimique_study::parse(&text).unwrap()).unwrap();
    let record = SessionRecord { started: &page.plan.started, events: &page.stored };
    let table = tidy(&study, &BTreeMap::new(), [record]);
    let rows: Vec<BTreeMap<&str, &Value>> =
        named(&table).into_iter().filter(|row| row["response_id"] == "nearer").collect();
    assert_eq!(rows.len(), 36);
    for row in rows {
        let (clip, beside) = (row["stimulus"], row["beside"]);
        assert!(beside.as_str().unwrap().ends_with(".real.actor"), "{beside}");
        let expected = match row["answer"].as_str().unwrap() {
            "same" => &Value::Null,
            side if *row["beside_side"] == *side => beside,
            _ => clip,
        };
        assert_eq!(row["chosen"], expected);
    }
    // A row a participant: the clips of both sides and the one chosen stand behind each choice.
    let people = wide(&study, &BTreeMap::new(), [record]);
    let row = &named(&people)[0];
    let choices: Vec<&&str> = row.keys().filter(|name| name.ends_with(".nearer")).collect();
    assert_eq!(choices.len(), 36);
    for name in choices {
        let of = |part: &str| row[format!("{name}.{part}").as_str()];
        let expected = match row[*name].as_str().unwrap() {
            "same" => &Value::Null,
            side => of(side),
        };
        assert_eq!(of("chosen"), expected, "{name}");
        assert_ne!(of("left"), of("right"), "{name}");
        assert!(of("left").is_string() && of("right").is_string(), "{name}");
    }
    assert!(!row.keys().any(|name| name.ends_with(".fidelity.left")), "a rating has no sides");
}

fn named(table: &Table) -> Vec<BTreeMap<&str, &Value>> {
    let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    table.rows.iter().map(|row| names.iter().copied().zip(row).collect()).collect()
}
