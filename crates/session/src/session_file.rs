//! A session as one file of JSON lines, for studies that are hosted without the server: the page
//! writes it, `mimique import` reads it.
//!
//! ```text
//! {"mimique_session": 1, "study": "demo", "started": {...}}     the head
//! {"sequence": 0, "at_ms": ..., "body": {...}}                  an event a line
//! {"events": 61, "sha256": "..."}                               the end: nothing is cut off
//! ```

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use crate::wire::{Event, SessionStarted};

/// The version of the format that this reads and writes.
const VERSION: u64 = 1;

/// One session of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionFile {
    /// Identifier of the study.
    pub study: String,
    /// The session.
    pub started: SessionStarted,
    /// Its events, in ascending order of sequence.
    pub events: Vec<Event>,
}

/// A file that is not a whole session.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SessionFileError {
    /// A line is not what it should be.
    #[error("line {line}: {why}; take the file as the page wrote it")]
    Line {
        /// From 1.
        line: usize,
        /// What is wrong.
        why: WrongLine,
    },
    /// The end is missing: the file was cut off.
    #[error("line {line}: the end is missing; download or copy the file again, whole")]
    CutOff {
        /// The last line there is, from 1.
        line: usize,
    },
    /// The text was changed after it was written.
    #[error(
        "the text was changed (SHA-256 {found}, written was {written}); take the file as the page wrote it"
    )]
    Changed {
        /// Of the text as it is.
        found: String,
        /// As the file says.
        written: String,
    },
}

/// Why a line is not what it should be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WrongLine {
    /// It cannot be read as what stands there.
    #[error("{0}")]
    Unreadable(String),
    /// The file is of another version, or of another kind.
    #[error("no session of version {VERSION}")]
    Version,
    /// Another event is due.
    #[error("event {found} where {due} is due")]
    Sequence {
        /// The event's number.
        found: u64,
        /// The number that follows the event before.
        due: u64,
    },
}

/// The first line.
#[derive(Serialize, Deserialize)]
struct Head {
    mimique_session: u64,
    study: String,
    started: SessionStarted,
}

/// The last line.
#[derive(Serialize, Deserialize)]
struct End {
    events: usize,
    sha256: String,
}

impl SessionFile {
    /// The file, and the SHA-256 of all its lines but the last, which serves as the receipt.
    pub fn write(&self) -> (String, String) {
        let head = Head {
            mimique_session: VERSION,
            study: self.study.clone(),
            started: self.started.clone(),
        };
        let mut text = format!("{}\n", json!(head));
        for event in &self.events {
            text.push_str(&format!("{}\n", json!(event)));
        }
        let hash = sha256(&text);
        let end = End { events: self.events.len(), sha256: hash.clone() };
        text.push_str(&format!("{}\n", json!(end)));
        (text, hash)
    }

    /// Reads a file.
    pub fn read(text: &str) -> Result<Self, SessionFileError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let wrong = |line: usize, why: WrongLine| SessionFileError::Line { line, why };
        let unreadable = |line: usize| {
            move |error: serde_json::Error| wrong(line, WrongLine::Unreadable(error.to_string()))
        };
        let mut lines = (1..).zip(text.split_inclusive('\n'));
        let (_, first) = lines.next().ok_or(SessionFileError::CutOff { line: 1 })?;
        let head: Value = serde_json::from_str(first).map_err(unreadable(1))?;
        if head["mimique_session"] != VERSION {
            return Err(wrong(1, WrongLine::Version));
        }
        let Head { study, started, .. } = Head::deserialize(head).map_err(unreadable(1))?;
        let mut file = Self { study, started, events: Vec::new() };
        let mut length = first.len();
        for (line, part) in lines {
            let value: Value = serde_json::from_str(part).map_err(unreadable(line))?;
            if let Ok(End { sha256: written, .. }) = End::deserialize(&value) {
                let found = sha256(&text[..length]);
                if found != written {
                    return Err(SessionFileError::Changed { found, written });
                }
                return Ok(file);
            }
            let event = Event::deserialize(value).map_err(unreadable(line))?;
            let due = file.events.len() as u64;
            if event.sequence != due {
                return Err(wrong(line, WrongLine::Sequence { found: event.sequence, due }));
            }
            file.events.push(event);
            length += part.len();
        }
        Err(SessionFileError::CutOff { line: 1 + file.events.len() })
    }
}

fn sha256(text: &str) -> String {
    hex::encode(Sha256::digest(text))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn file() -> SessionFile {
        let started = json!({
            "session": "s", "participant_id": "s1", "participant": 9, "seed": 5, "stage": "live",
            "config_hash": "h", "withdrawal_code": "w",
        });
        let event = |sequence| Event {
            sequence,
            at_ms: 0.5 + sequence as f64,
            body: json!({ "type": "answered", "value": "line\nbreak \u{2028} é" }),
        };
        SessionFile {
            study: "demo".into(),
            started: serde_json::from_value(started).unwrap(),
            events: (0..5).map(event).collect(),
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let (text, receipt) = file().write();
        assert_eq!(SessionFile::read(&text).unwrap(), file());
        assert_eq!(text.lines().count(), 7);
        assert!(text.ends_with(&format!("\"sha256\":\"{receipt}\"}}\n")));
    }

    #[test]
    fn what_is_cut_off_changed_or_foreign_is_refused_with_its_line() {
        let (text, _) = file().write();
        for end in 0..text.len() {
            if text.is_char_boundary(end) && end + 1 < text.len() {
                assert!(SessionFile::read(&text[..end]).is_err(), "{end} bytes");
            }
        }
        let changed = text.replacen("break", "broke", 1);
        assert!(matches!(SessionFile::read(&changed), Err(SessionFileError::Changed { .. })));
        let lines: Vec<&str> = text.split_inclusive('\n').collect();
        let missing = [&lines[..2], &lines[3..]].concat().concat();
        let error = SessionFile::read(&missing).unwrap_err().to_string();
        assert!(error.starts_with("line 3: event 2 where 1 is due"), "{error}");
        let foreign = SessionFile::read("{\"a\": 1}\n").unwrap_err().to_string();
        assert!(foreign.starts_with("line 1: no session of version 1"), "{foreign}");
        let cut = SessionFile::read(&lines[..3].concat()).unwrap_err();
        assert_eq!(cut, SessionFileError::CutOff { line: 3 });
    }
}
