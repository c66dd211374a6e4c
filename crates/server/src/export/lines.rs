//! JSON lines: tidy rows, or stored events.

use mimique_study::responses::iso_time;
use serde_json::{Map, Value, json};

use super::ExportError;
use super::table::{Merged, Sources};
use crate::storage::Storage;

/// One object a row, its keys in alphabetical order.
pub(super) fn rows(table: &Merged) -> Result<Vec<u8>, ExportError> {
    let mut bytes = Vec::new();
    for row in &table.rows {
        let names = table.columns.iter().map(|column| column.name.clone());
        let object: Map<String, Value> = names.zip(row.iter().cloned()).collect();
        add_line(&mut bytes, &Value::Object(object))?;
    }
    Ok(bytes)
}

/// One object an event; also how many participants and events there are.
pub(super) async fn events(
    storage: &Storage,
    sources: &Sources,
) -> Result<(Vec<u8>, usize, usize), ExportError> {
    let mut bytes = Vec::new();
    let (mut participants, mut rows) = (0, 0);
    for session in &sources.sessions {
        let events = storage.events(session.key).await?;
        participants += usize::from(!events.is_empty());
        rows += events.len();
        for event in events {
            let line = json!({
                "participant_id": crate::participant_id(session.participant),
                "stage": session.stage,
                "config_hash": session.config_hash,
                "sequence": event.sequence,
                "at_ms": event.at_ms,
                "at": iso_time(event.at_ms),
                "body": event.body,
            });
            add_line(&mut bytes, &line)?;
        }
    }
    Ok((bytes, participants, rows))
}

fn add_line(bytes: &mut Vec<u8>, value: &Value) -> Result<(), ExportError> {
    serde_json::to_writer(&mut *bytes, value).map_err(|e| ExportError::Form(e.to_string()))?;
    bytes.push(b'\n');
    Ok(())
}
