//! The export of a simulated study, as the server writes it.

use std::collections::BTreeMap;

use mimique_analysis::Simulation;
use mimique_session::rows::{self, SessionRecord};
use mimique_study::Study;
use serde_json::Value;

/// The export of people who are simulated from the first page to the last.
pub fn simulated_export(simulation: &Simulation<'_>, study: &Study, people: u64) -> String {
    let sessions = simulation.sessions(people, |session| session).unwrap();
    let records = sessions
        .iter()
        .map(|session| SessionRecord { started: &session.started, events: &session.events });
    let table = rows::tidy(study, &BTreeMap::new(), records);
    let text = |value: &Value| match value {
        Value::Null => String::new(),
        Value::String(text) => format!("\"{}\"", text.replace('"', "\"\"")),
        other => other.to_string(),
    };
    let names: Vec<String> = table.columns.iter().map(|column| column.name.clone()).collect();
    let mut csv = names.join(",") + "\n";
    for row in &table.rows {
        csv += &row.iter().map(text).collect::<Vec<_>>().join(",");
        csv.push('\n');
    }
    csv
}
