//! Adaptive blocks from the page to the export: levels follow the answers, a reload goes on at the same level, and
//! what was recorded is replayed from seed and answers alone.

use std::collections::BTreeMap;

use mimique_session::flow::{Input, State};
use mimique_session::rows::{SessionRecord, tidy};
use mimique_session::wire::{Event, SessionStarted};
use mimique_session::{Client, EventKind, PlayLog};
use mimique_study::Study;
use serde_json::{Value, json};

use crate::support::stepped::{self, Page};

const SEED: u64 = 20_261_125;

fn study(change: impl FnOnce(&mut Value)) -> Study {
    stepped::study("jnd-alpha.json", change)
}

fn started() -> SessionStarted {
    stepped::started(SEED, 3, "abc")
}

impl Page {
    /// Plays the clips and answers a trial; goes on from a break.
    fn trial(&mut self, sees_from: f64) {
        let Some(level) = self.state.record.attempt.level.clone() else {
            self.send(Input::Next);
            return;
        };
        self.send(Input::Play);
        self.send(Input::Played(PlayLog { backend: "webgpu".to_owned(), ..PlayLog::default() }));
        let right = level.level >= sees_from;
        let side = if right == level.left { "right" } else { "left" };
        self.send(Input::Answer { question: "smoother".to_owned(), value: side.into() });
        self.send(Input::Next);
    }

    fn levels(&self) -> Vec<f64> {
        let of = |event: &Event| match EventKind::from_body(&event.body)? {
            EventKind::LevelChosen { level, .. } => Some(level),
            _ => None,
        };
        self.events.iter().filter_map(of).collect()
    }
}

fn run(study: &Study, sees_from: f64) -> Page {
    let mut page = Page::open(study, started());
    for _ in 0..60 {
        if page.step().is_none() {
            break;
        }
        page.trial(sees_from);
    }
    assert_eq!(page.step(), None, "the study comes to its end");
    page
}

fn rows(study: &Study, events: &[Event]) -> Vec<BTreeMap<String, Value>> {
    let started = started();
    let record = SessionRecord { started: &started, events };
    let table = tidy(study, &BTreeMap::new(), [record]);
    let names: Vec<String> = table.columns.iter().map(|column| column.name.clone()).collect();
    let rows = table.rows.into_iter();
    rows.map(|row| names.iter().cloned().zip(row).collect::<BTreeMap<_, _>>())
        .filter(|row: &BTreeMap<String, Value>| row["trial_type"] == "trial")
        .collect()
}

#[test]
fn levels_follow_the_answers_and_the_export_replays_them() {
    let study = study(|_| {});
    let (keen, dull) = (run(&study, 0.22), run(&study, 0.78));
    let last = |page: &Page| page.levels()[26..].iter().sum::<f64>() / 7.0;
    assert_eq!(keen.levels().len(), 33, "30 trials and 3 catch trials");
    assert!(last(&keen) + 0.3 < last(&dull), "{} {}", last(&keen), last(&dull));
    let rows = rows(&study, &keen.events);
    assert_eq!(rows.len(), 33);
    assert!(rows.iter().all(|row| row["level_replayed"] == true), "the same seed and answers");
    let right = |row: &BTreeMap<String, Value>| row["level"].as_f64().unwrap() >= 0.22;
    assert!(rows.iter().all(|row| row["correct"] == right(row)));
    let catches: Vec<_> = rows.iter().filter(|row| row["level_catch"] == true).collect();
    assert!(catches.len() == 3 && catches.iter().all(|row| row["level"] == 1));
    let end = &rows[32];
    let mean = end["posterior_mean"].as_f64().unwrap();
    assert!(mean < 0.4 && end["posterior_sd"].as_f64().unwrap() < 0.2, "{mean}");
    let clip = |row: &BTreeMap<String, Value>| {
        format!("joy3.lsts@alpha={}", row["level"].as_f64().unwrap())
    };
    assert!(rows.iter().all(|row| row["stimulus"] == clip(row)));
    assert!(rows.iter().all(|row| row["beside"] == "joy3.reference"));
    let left = rows.iter().filter(|row| row["beside_side"] == "left").count();
    assert_eq!(left, 17, "each side in half of the trials");
}

#[test]
fn a_level_that_answers_do_not_give_is_told() {
    let study = study(|_| {});
    let page = run(&study, 0.4);
    let mut events = page.events.clone();
    let at = events.iter().position(|event| event.body["step"] == "limit/9").unwrap();
    let chosen = &mut events[at];
    assert_eq!(chosen.body["type"], "level_chosen");
    chosen.body["level"] = 0.05.into();
    let wrong: Vec<Value> = rows(&study, &events)
        .into_iter()
        .filter(|row| row["level_replayed"] == false)
        .map(|row| row["trial_id"].clone())
        .collect();
    assert_eq!(wrong, ["limit/9"]);
    // Another seed draws other sides and catch trials.
    let mut other = started();
    other.seed += 1;
    let record = SessionRecord { started: &other, events: &page.events };
    let table = tidy(&study, &BTreeMap::new(), [record]);
    let place = table.columns.iter().position(|column| column.name == "level_replayed").unwrap();
    assert!(table.rows.iter().any(|row| row[place] == false));
}

#[test]
fn both_clips_that_may_come_next_are_made_ready_while_one_is_shown() {
    let study = study(|_| {});
    let mut page = Page::open(&study, started());
    for _ in 0..8 {
        page.prepared.clear();
        let sees_from = if page.events.len().is_multiple_of(2) { 0.0 } else { 2.0 };
        page.state.live.prepared.clear();
        page.send(Input::Online);
        page.send(Input::Begun);
        let ready = page.prepared.clone();
        page.trial(sees_from);
        if let Some(level) = &page.state.record.attempt.level {
            assert!(ready.contains(&level.clip), "{} of {ready:?}", level.clip);
        }
    }
}

#[test]
fn levels_are_made_ready_before_their_block_is_reached() {
    let study = study(|_| {});
    let page = run(&study, 0.5);
    // On the page before the block, and in each of its two breaks.
    let steps: Vec<&Value> = page.readied.iter().map(|request| &request["step"]).collect();
    assert_eq!(steps, ["limit/1", "limit/12", "limit/23"]);
    for request in &page.readied {
        assert!(page.asked_for.contains(request), "what the level is chosen by: {request}");
    }
}

#[test]
fn a_reload_goes_on_at_the_same_level_of_the_same_track() {
    let study = study(|_| {});
    let whole = run(&study, 0.5);
    let mut page = Page::open(&study, started());
    for _ in 0..7 {
        page.trial(0.5);
    }
    page.send(Input::Play);
    let before = page.state.record.attempt.level.clone().expect("a level");
    // The page is opened anew from what is stored.
    page.state = State::replay(&page.plan, &page.events);
    page.send(Input::Resumed(Client::default()));
    assert_eq!(page.state.record.attempt.level.as_ref(), Some(&before));
    while page.step().is_some() {
        page.trial(0.5);
    }
    assert_eq!(page.levels(), whole.levels(), "each level is chosen once");
    assert!(rows(&study, &page.events).iter().all(|row| row["level_replayed"] == true));
}

#[test]
fn a_block_that_is_sure_ends_before_its_last_trial() {
    let study = study(|study| {
        study["components"]["limit"]["stopSd"] = 0.2.into();
        study["components"]["limit"]["catch"] = 0.into();
    });
    let page = run(&study, 0.5);
    assert_eq!(page.levels().len(), 20, "not before 20");
    let over = page.events.iter().filter(|event| event.body["type"] == "levels_over").count();
    assert_eq!(over, 1);
    assert_eq!(rows(&study, &page.events).len(), 20);
    let admission = mimique_session::Admission::of(&page.plan);
    assert!(admission.is_done(&page.state.record), "who was sure early has finished");
    assert!(page.events.iter().all(|event| admission.misfit(&event.body).is_none()));
}

#[test]
fn two_tracks_by_a_staircase_each_go_their_own_way() {
    let study = study(|study| {
        let block = &mut study["components"]["limit"];
        block["rule"] = json!({ "staircase": { "down": 2, "steps": [0.2, 0.1], "start": 0.8 } });
        block["tracks"] = 2.into();
        block["trials"] = 15.into();
    });
    let page = run(&study, 0.45);
    let rows = rows(&study, &page.events);
    assert_eq!(rows.len(), 33);
    for track in [1, 2] {
        let own = rows.iter().filter(|row| row["track"] == track && row["level_catch"] == false);
        let levels: Vec<f64> = own.map(|row| row["level"].as_f64().unwrap()).collect();
        assert_eq!(levels.len(), 15);
        // Two right answers down by 0.2 from 0.8, until the first that is not seen turns it.
        assert_eq!(levels[..7], [0.8, 0.8, 0.6, 0.6, 0.4, 0.5, 0.5]);
        assert!(levels[7..].iter().all(|level| (0.35..=0.55).contains(level)), "{levels:?}");
    }
    assert!(rows.iter().all(|row| row["posterior_mean"].is_null()));
}
