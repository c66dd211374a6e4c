//! JSON lines: tidy rows, or stored events.

use mimique_session::wire::SessionStarted;
use mimique_study::iso_time;
use serde::Serialize;
use serde_json::Value;

use super::error::ExportError;

/// One object a row, its keys in alphabetical order: places in the row, and how their names stand in JSON.
pub(super) fn rows(keys: &[(usize, String)], rows: &[Vec<Value>]) -> Result<Vec<u8>, ExportError> {
    let mut bytes = Vec::new();
    for row in rows {
        for (index, (place, key)) in keys.iter().enumerate() {
            bytes.push(if index == 0 { b'{' } else { b',' });
            bytes.extend_from_slice(key.as_bytes());
            bytes.push(b':');
            add(&mut bytes, &row[*place])?;
        }
        bytes.extend_from_slice(b"}\n");
    }
    Ok(bytes)
}

/// An event of a session as it is stored.
pub(super) struct EventLine<'e> {
    pub started: &'e SessionStarted,
    pub sequence: u64,
    pub at_ms: f64,
    /// JSON.
    pub body: &'e str,
    /// Why it cannot be one of the session's, if it cannot.
    pub misfit: Option<&'e str>,
}

/// Adds one event, its keys in alphabetical order.
pub(super) fn add_event(bytes: &mut Vec<u8>, event: &EventLine<'_>) -> Result<(), ExportError> {
    let EventLine { started, sequence, at_ms, body, misfit } = event;
    bytes.extend_from_slice(b"{\"at\":");
    add(bytes, &iso_time(*at_ms))?;
    bytes.extend_from_slice(b",\"at_ms\":");
    add(bytes, at_ms)?;
    bytes.extend_from_slice(b",\"body\":");
    bytes.extend_from_slice(body.as_bytes());
    bytes.extend_from_slice(b",\"config_hash\":");
    add(bytes, &started.config_hash)?;
    if let Some(word) = misfit {
        bytes.extend_from_slice(b",\"misfit\":");
        add(bytes, word)?;
    }
    bytes.extend_from_slice(b",\"participant_id\":");
    add(bytes, &started.participant_id)?;
    bytes.extend_from_slice(b",\"sequence\":");
    add(bytes, sequence)?;
    bytes.extend_from_slice(b",\"stage\":");
    add(bytes, &started.stage)?;
    bytes.extend_from_slice(b"}\n");
    Ok(())
}

fn add<T: Serialize + ?Sized>(bytes: &mut Vec<u8>, value: &T) -> Result<(), ExportError> {
    serde_json::to_writer(bytes, value).map_err(|error| ExportError::Form(error.to_string()))
}
