//! Conditions between participants: what every row says of them.

use std::collections::BTreeMap;

use mimique_session::rows::{SessionRecord, tidy, wide};
use mimique_study::Study;
use mimique_study::columns::is_reserved_column;
use serde_json::{Value, json};

use crate::support::small::small_file;
use crate::support::{Page, first_answer};

const CLIPS: [(&str, u8); 6] =
    [("joy", 1), ("joy", 2), ("fear", 1), ("fear", 2), ("anger", 1), ("anger", 2)];

/// A condition that shows a block in a drawn order, no expression three times in a row.
fn condition(id: &str, block: &str) -> Value {
    json!({ "id": id, "conditional": true, "order": "random", "components": [block],
        "constraints": [{ "factor": "expression", "atMostAlike": 2 }] })
}

/// Two conditions that show one block, and a page of one of them alone.
fn two_arms() -> Value {
    let mut named = condition("named", "faces");
    named["components"] =
        json!(["rest", { "id": "part", "order": "random", "components": ["faces"] }]);
    named.as_object_mut().unwrap().remove("constraints");
    let parts = json!({ "order": "fixed", "components": [condition("plain", "faces"), named] });
    small_file(1, &CLIPS, 1, parts)
}

fn finished(participant: u64, condition: &str) -> Page {
    let mut page = Page::open_in(&two_arms().to_string(), participant, Some(condition));
    page.reload();
    page.act(&mut first_answer);
    page.reload();
    page.finish();
    page
}

#[test]
fn the_condition_is_in_every_row_and_stays_after_a_reload() {
    let (plain, named) = (finished(1, "plain"), finished(2, "named"));
    let study = &plain.study;
    let records = [&plain, &named]
        .map(|page| SessionRecord { started: &page.plan.started, events: &page.stored });
    let table = tidy(study, &BTreeMap::new(), records);
    let place = table.column("assigned_condition").unwrap();
    assert_eq!(table.columns[place - 1].name, "condition");
    assert_eq!(table.columns[place].levels.len(), 2);
    let mut seen: BTreeMap<(String, String, String), usize> = BTreeMap::new();
    for row in 0..table.rows.len() {
        let text = |name: &str| table.cell(row, name).as_str().unwrap_or("").to_owned();
        let kind = text("trial_type");
        *seen.entry((text("assigned_condition"), kind, text("condition"))).or_default() += 1;
    }
    let trial = |assigned: &str, condition: &str| {
        seen.get(&(assigned.into(), "trial".into(), condition.into())).copied()
    };
    // The nearest sequence with a name, as ever; the condition beside it.
    assert_eq!(trial("plain", "plain"), Some(6), "{seen:?}");
    assert_eq!(trial("named", "part"), Some(6), "{seen:?}");
    assert!(seen.keys().all(|(assigned, ..)| !assigned.is_empty()), "{seen:?}");
    let people = wide(study, &BTreeMap::new(), records);
    let assigned = [0, 1].map(|row| people.cell(row, "assigned_condition").clone());
    assert_eq!(assigned, [json!("plain"), json!("named")]);
    assert!(is_reserved_column("assigned_condition"));
    // A study without conditions has no such column.
    let file = small_file(1, &CLIPS, 1, json!({ "order": "fixed", "components": ["faces"] }));
    let without = Study::from_value(&file).unwrap();
    assert_eq!(tidy(&without, &BTreeMap::new(), []).column("assigned_condition"), None);
}
