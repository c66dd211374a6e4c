//! A session as one file of JSON lines, for studies that are hosted without the server: the page
//! writes it, `mimique import` reads it.
//!
//! It holds a session, or the part of one that was posted since the last (`staticHosting.postProgress`): its events
//! may begin later than at 0. Several may stand one after the other in a text ([`SessionFile::read_all`]).
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

/// One session of a study, or a part of one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SessionFile {
    /// Identifier of the study.
    pub study: String,
    /// The session.
    pub started: SessionStarted,
    /// Its events, each the one after the event before.
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

    /// Reads a text: what stands in it, one after the other; empty lines between them are left out.
    pub fn read_all(text: &str) -> Result<Vec<Self>, SessionFileError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = (1..).zip(text.split_inclusive('\n'));
        let mut files = Vec::new();
        while let Some((line, first)) = lines.next() {
            if !first.trim().is_empty() {
                files.push(Self::read_one(line, first, &mut lines)?);
            }
        }
        match files.is_empty() {
            true => Err(SessionFileError::CutOff { line: 1 }),
            false => Ok(files),
        }
    }

    /// Reads what begins with the line `first`, and no further.
    fn read_one<'a>(
        line: usize,
        first: &'a str,
        lines: &mut impl Iterator<Item = (usize, &'a str)>,
    ) -> Result<Self, SessionFileError> {
        let wrong = |line: usize, why: WrongLine| SessionFileError::Line { line, why };
        let unreadable = |line: usize| {
            move |error: serde_json::Error| wrong(line, WrongLine::Unreadable(error.to_string()))
        };
        let head: Value = serde_json::from_str(first).map_err(unreadable(line))?;
        if head["mimique_session"] != VERSION {
            return Err(wrong(line, WrongLine::Version));
        }
        let Head { study, started, .. } = Head::deserialize(head).map_err(unreadable(line))?;
        let mut file = Self { study, started, events: Vec::new() };
        let mut hashed = Sha256::new_with_prefix(first);
        let mut last = line;
        for (line, part) in lines {
            last = line;
            let value: Value = serde_json::from_str(part).map_err(unreadable(line))?;
            if let Ok(End { sha256: written, .. }) = End::deserialize(&value) {
                let found = hex::encode(hashed.finalize());
                if found != written {
                    return Err(SessionFileError::Changed { found, written });
                }
                return Ok(file);
            }
            let event = Event::deserialize(value).map_err(unreadable(line))?;
            let due = file.events.last().map(|before| before.sequence + 1);
            if let Some(due) = due.filter(|due| *due != event.sequence) {
                return Err(wrong(line, WrongLine::Sequence { found: event.sequence, due }));
            }
            file.events.push(event);
            hashed.update(part);
        }
        Err(SessionFileError::CutOff { line: last })
    }

    /// Joins what another file holds of the same session. Where both hold an event, it must be the same one: the
    /// number of an event that is not is the error.
    pub fn join(&mut self, other: Self) -> Result<(), u64> {
        for event in other.events {
            match self.events.binary_search_by_key(&event.sequence, |each| each.sequence) {
                Ok(at) if self.events[at] == event => {}
                Ok(_) => return Err(event.sequence),
                Err(at) => self.events.insert(at, event),
            }
        }
        Ok(())
    }

    /// The number of the first event that is missing before the last one there is.
    pub fn first_missing(&self) -> Option<u64> {
        let missing = (0..).zip(&self.events).find(|(due, event)| *due != event.sequence);
        missing.map(|(due, _)| due)
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

    fn read(text: &str) -> Result<SessionFile, SessionFileError> {
        let mut files = SessionFile::read_all(text)?;
        assert_eq!(files.len(), 1);
        Ok(files.remove(0))
    }

    #[test]
    fn parts_one_after_the_other_are_joined_and_gaps_are_found() {
        let part = |events: std::ops::Range<usize>| SessionFile {
            events: file().events[events].to_vec(),
            ..file()
        };
        // The middle was posted twice, as it is where an answer was not heard.
        let parts = [part(0..2), part(1..4), part(1..4), part(4..5)];
        let text: Vec<String> = parts.iter().map(|part| part.write().0).collect();
        let read = SessionFile::read_all(&text.join("\n")).unwrap();
        assert_eq!(read, parts);
        let mut whole = read[3].clone();
        for part in &read[..3] {
            whole.join(part.clone()).unwrap();
        }
        assert_eq!((&whole, whole.first_missing()), (&file(), None));

        let mut gap = part(0..2);
        gap.join(part(4..5)).unwrap();
        assert_eq!(gap.first_missing(), Some(2));
        let mut other = part(1..3);
        other.events[1].at_ms += 1.0;
        assert_eq!(gap.join(other), Ok(()));
        assert_eq!(gap.join(part(2..3)), Err(2));
    }

    #[test]
    fn what_is_written_is_read() {
        let (text, receipt) = file().write();
        assert_eq!(read(&text).unwrap(), file());
        assert_eq!(text.lines().count(), 7);
        assert!(text.ends_with(&format!("\"sha256\":\"{receipt}\"}}\n")));
    }

    #[test]
    fn what_is_cut_off_changed_or_foreign_is_refused_with_its_line() {
        let (text, _) = file().write();
        for end in 0..text.len() {
            if text.is_char_boundary(end) && end + 1 < text.len() {
                assert!(read(&text[..end]).is_err(), "{end} bytes");
            }
        }
        let changed = text.replacen("break", "broke", 1);
        assert!(matches!(read(&changed), Err(SessionFileError::Changed { .. })));
        let lines: Vec<&str> = text.split_inclusive('\n').collect();
        let missing = [&lines[..2], &lines[3..]].concat().concat();
        let error = read(&missing).unwrap_err().to_string();
        assert!(error.starts_with("line 3: event 2 where 1 is due"), "{error}");
        let foreign = read("{\"a\": 1}\n").unwrap_err().to_string();
        assert!(foreign.starts_with("line 1: no session of version 1"), "{foreign}");
        let cut = read(&lines[..3].concat()).unwrap_err();
        assert_eq!(cut, SessionFileError::CutOff { line: 3 });
    }
}
