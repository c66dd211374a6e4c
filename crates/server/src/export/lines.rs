//! JSON lines: tidy rows, or stored events.

use mimique_session::rows::Column;
use mimique_session::wire::{Event, SessionStarted};
use mimique_storage::{SessionRecord, Storage};
use mimique_study::iso_time;
use serde_json::{Map, Value, json};

use super::error::ExportError;
use super::merged::Merged;
use super::sources::as_started;

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

/// One object an event of a session; also how many events there are.
pub(super) async fn events(
    storage: &Storage,
    session: &SessionRecord,
) -> Result<(Vec<u8>, usize), ExportError> {
    let mut bytes = Vec::new();
    let events = storage.stored_events(session.key).await?;
    let started = as_started(session);
    for stored in &events {
        add_event(&mut bytes, &started, &stored.event, stored.misfit.as_deref())?;
    }
    Ok((bytes, events.len()))
}

/// Adds one event, and why it cannot be one of the session's, if it cannot.
pub(super) fn add_event(
    bytes: &mut Vec<u8>,
    started: &SessionStarted,
    event: &Event,
    misfit: Option<&str>,
) -> Result<(), ExportError> {
    let mut line = json!({
        "participant_id": started.participant_id,
        "stage": started.stage,
        "config_hash": started.config_hash,
        "sequence": event.sequence,
        "at_ms": event.at_ms,
        "at": iso_time(event.at_ms),
        "body": event.body,
    });
    if let Some(word) = misfit {
        line["misfit"] = word.into();
    }
    add_line(bytes, &line)
}

fn add_line(bytes: &mut Vec<u8>, value: &Value) -> Result<(), ExportError> {
    serde_json::to_writer(&mut *bytes, value).map_err(|e| ExportError::Form(e.to_string()))?;
    bytes.push(b'\n');
    Ok(())
}
