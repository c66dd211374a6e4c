//! Whatever is changed in a good study, what its check lets pass can be run.

use mimique_session::flow::Plan;
use mimique_session::wire::SessionStarted;
use mimique_study::{Study, check, parse};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::support;

/// Pointers of every value of a file.
fn pointers(value: &Value, here: &str, all: &mut Vec<String>) {
    all.push(here.to_owned());
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                let key = key.replace('~', "~0").replace('/', "~1");
                pointers(value, &format!("{here}/{key}"), all);
            }
        }
        Value::Array(items) => {
            for (index, value) in items.iter().enumerate() {
                pointers(value, &format!("{here}/{index}"), all);
            }
        }
        _ => {}
    }
}

fn replacement(choice: u8) -> Value {
    match choice % 12 {
        0 => Value::Null,
        1 => json!(-1),
        2 => json!(0),
        3 => json!(1e300),
        4 => json!(4_294_967_295_u64),
        5 => json!(""),
        6 => json!("faces"),
        7 => json!([]),
        8 => json!({}),
        9 => json!([[["deep"]]]),
        10 => json!({ "en": "x", "fr": "y" }),
        _ => json!(true),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn never_panic_and_run_if_they_pass(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..4),
    ) {
        let mut value = parse(&support::study_text("template.json")).unwrap();
        for (index, choice, remove) in changes {
            let mut all = Vec::new();
            pointers(&value, "", &mut all);
            let pointer = index.get(&all).clone();
            let (parent, key) = pointer.rsplit_once('/').unwrap_or(("", ""));
            if remove && let Some(Value::Object(map)) = value.pointer_mut(parent) {
                map.remove(key);
            } else if let Some(place) = value.pointer_mut(&pointer) {
                *place = replacement(choice);
            }
        }
        let report = check(&value.to_string(), &|_| Ok(()));
        let Some(checked) = report.study else {
            prop_assert!(report.issues.iter().all(|issue| !issue.message().is_empty() && !issue.remedy().is_empty()));
            return Ok(());
        };
        let study: Study = checked.study().clone();
        let started = SessionStarted {
            session: "s".into(),
            participant_id: "p1".into(),
            participant: 1,
            slot: 1,
            condition: None,
            seed: study.seed,
            stage: "live".into(),
            config_hash: checked.config_hash().to_owned(),
            withdrawal_code: "w".into(),
        };
        let plan = Plan::new(study.projection(), started);
        prop_assert!(plan.is_ok(), "{:?}", plan.err());
        prop_assert!(plan.unwrap().trial_count(false) > 0);
    }
}
