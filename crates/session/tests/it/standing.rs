//! How a session stands follows from its events alone: with a plan or without, whatever comes.

use mimique_session::flow::{Plan, State};
use mimique_session::wire::Event;
use mimique_session::{Record, Standing};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::support::{Page, started, study_text};

/// Every event of somebody who completes the study, and events that need not fit anywhere.
fn bodies() -> Vec<Value> {
    let mut page = Page::open(&study_text("demo.json"), 1);
    page.finish();
    let mut bodies: Vec<Value> = page.stored.into_iter().map(|event| event.body).collect();
    bodies.extend([
        json!({ "type": "declined" }),
        json!({ "type": "withdrawn" }),
        json!({ "type": "finished" }),
        json!({ "type": "checks_failed", "failed": 2 }),
        json!({ "type": "screened_out", "step": "x", "reason": "device", "details": ["kind"] }),
        json!({ "type": "screened_out", "step": "x", "reason": "screening", "details": ["age"] }),
        json!({ "type": "screened_out", "step": "x", "reason": "training", "details": [] }),
        json!({ "type": "resumed", "client": {} }),
        json!({ "type": "focus_lost" }),
        json!({ "type": "time_extended", "step": "demographics" }),
        json!({ "type": "page_finished", "step": "nowhere", "timed_out": true }),
        json!({ "type": "of_a_later_version" }),
    ]);
    bodies
}

fn is_end(body: &Value) -> bool {
    let ends = ["declined", "finished", "checks_failed", "screened_out", "withdrawn"];
    body["type"].as_str().is_some_and(|kind| ends.contains(&kind))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn everybody_makes_the_same_of_any_log(
        mostly in 0_usize..80,
        picks in proptest::collection::vec(any::<prop::sample::Index>(), 0..25),
        places in proptest::collection::vec(any::<prop::sample::Index>(), 25),
    ) {
        let all = bodies();
        let mut chosen: Vec<Value> = all.iter().take(mostly).cloned().collect();
        for (pick, place) in picks.iter().zip(&places) {
            let place = place.index(chosen.len() + 1);
            chosen.insert(place, pick.get(&all).clone());
        }
        let events: Vec<Event> = (0..)
            .zip(&chosen)
            .map(|(sequence, body)| Event { sequence, at_ms: sequence as f64, body: body.clone() })
            .collect();
        let (study, session) = started(&study_text("demo.json"), 1);
        let plan = Plan::new(study.projection(), session).unwrap();
        let (with, without) = (Record::of(Some(&plan), &events), Record::of(None, &events));
        prop_assert_eq!(with.standing, without.standing);
        prop_assert_eq!(&with.early_end, &without.early_end);
        prop_assert_eq!(State::replay(&plan, &events).record.standing, with.standing);
        let steps = |record: &Record| -> Vec<_> {
            record.finished.iter().map(|step| (step.id.clone(), step.answers.clone())).collect()
        };
        prop_assert_eq!(steps(&with), steps(&without));
        // An event that does not fit is counted, and a later one changes no end but by a withdrawal.
        for end in 0..events.len() {
            let before = Record::of(Some(&plan), &events[..end]).standing;
            let after = Record::of(Some(&plan), &events[..=end]).standing;
            if !is_end(&chosen[end]) || (!before.is_open() && after != Standing::Withdrawn) {
                prop_assert_eq!(before, after, "{}", chosen[end]);
            }
        }
        let withdrawn = chosen.iter().any(|body| body["type"] == "withdrawn");
        prop_assert_eq!(with.standing == Standing::Withdrawn, withdrawn);
        if !chosen.iter().any(is_end) {
            prop_assert_eq!(with.standing, Standing::InProgress);
        }
    }
}
