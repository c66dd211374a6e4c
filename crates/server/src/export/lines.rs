//! JSON lines: tidy rows, or stored events.

use mimique_session::rows::Column;
use mimique_session::wire::{Event, SessionStarted};
use mimique_storage::Storage;
use mimique_study::iso_time;
use serde_json::{Map, Value, json};

use super::error::ExportError;
use super::merged::Merged;
use super::sources::{Sources, as_started};

/// One object a row, its keys in alphabetical order.
pub(super) fn rows(table: &Merged) -> Result<Vec<u8>, ExportError> {
    let mut bytes = Vec::new();
    for row in &table.rows {
        add_row(&mut bytes, &table.columns, row)?;
    }
    Ok(bytes)
}

/// Adds one row.
pub(super) fn add_row(
    bytes: &mut Vec<u8>,
    columns: &[Column],
    row: &[Value],
) -> Result<(), ExportError> {
    let names = columns.iter().map(|column| column.name.clone());
    let object: Map<String, Value> = names.zip(row.iter().cloned()).collect();
    add_line(bytes, &Value::Object(object))
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
        let started = as_started(session);
        for event in &events {
            add_event(&mut bytes, &started, event)?;
        }
    }
    Ok((bytes, participants, rows))
}

/// Adds one event.
pub(super) fn add_event(
    bytes: &mut Vec<u8>,
    started: &SessionStarted,
    event: &Event,
) -> Result<(), ExportError> {
    let line = json!({
        "participant_id": started.participant_id,
        "stage": started.stage,
        "config_hash": started.config_hash,
        "sequence": event.sequence,
        "at_ms": event.at_ms,
        "at": iso_time(event.at_ms),
        "body": event.body,
    });
    add_line(bytes, &line)
}

fn add_line(bytes: &mut Vec<u8>, value: &Value) -> Result<(), ExportError> {
    serde_json::to_writer(&mut *bytes, value).map_err(|e| ExportError::Form(e.to_string()))?;
    bytes.push(b'\n');
    Ok(())
}
