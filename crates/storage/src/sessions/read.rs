//! Sessions and their events, read.

use std::collections::BTreeMap;
use std::ops::Range;

use futures_util::stream::{BoxStream, StreamExt as _};
use mimique_session::Record;
use mimique_session::wire::Event;
use sqlx::AssertSqlSafe;

use super::row::{
    COUNTED_EVENTS, COUNTED_WITHOUT_PLAYS, SESSION_COLUMNS, check_json, counted_event, event,
    record_of, session_record,
};
use crate::database::{Row, query, signed};
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::{CountedEvent, RecruitmentEntry, SessionRecord, StoredEvent};

impl Storage {
    /// The session with this token's hash.
    pub async fn session(&self, token_hash: &str) -> Result<SessionRecord, StorageError> {
        let row = query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE token_hash = $1"
        )))
        .bind(token_hash)
        .fetch_optional(&self.readers)
        .await?;
        session_record(&row.ok_or(StorageError::UnknownSession)?)
    }

    /// Every session of a study, by participant number.
    pub async fn sessions(&self, study_id: &str) -> Result<Vec<SessionRecord>, StorageError> {
        let rows = query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE study_id = $1 ORDER BY participant"
        )))
        .bind(study_id)
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(session_record).collect()
    }

    /// How many sessions there are, by study, stage and stored standing.
    pub async fn session_counts(&self) -> Result<Vec<([String; 3], u64)>, StorageError> {
        let rows = query(
            "SELECT study_id, stage, status, COUNT(*) AS number FROM sessions \
             GROUP BY study_id, stage, status ORDER BY study_id, stage, status",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                let kind = [row.get("study_id")?, row.get("stage")?, row.get("status")?];
                Ok((kind, row.unsigned("sessions", "number")?))
            })
            .collect()
    }

    /// Every stored event of a session, by sequence.
    pub async fn events(&self, session_key: i64) -> Result<Vec<Event>, StorageError> {
        let rows = query(
            "SELECT sequence, at_ms, body FROM events WHERE session_key = $1 ORDER BY sequence",
        )
        .bind(session_key)
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(|row| event(session_key, row)).collect()
    }

    /// The stored events of a session with sequences in a range, one after the other: neither how many there
    /// are nor how large they are matters. While they are read a connection is held.
    pub fn stored_events(
        &self,
        session_key: i64,
        sequences: Range<u64>,
    ) -> BoxStream<'_, Result<StoredEvent, StorageError>> {
        let stored = move |row: Row| -> Result<StoredEvent, StorageError> {
            let body: String = row.get("body")?;
            check_json(session_key, &body)?;
            let (sequence, at_ms) = (row.unsigned("events", "sequence")?, row.get("at_ms")?);
            Ok(StoredEvent { sequence, at_ms, body, misfit: row.get("misfit")? })
        };
        let rows = query(
            "SELECT sequence, at_ms, body, misfit FROM events WHERE session_key = $1 \
             AND sequence >= $2 AND sequence < $3 ORDER BY sequence",
        )
        .bind(session_key)
        .bind(signed(sequences.start))
        .bind(signed(sequences.end))
        .stream_from(&self.readers);
        rows.map(move |row| row.and_then(stored)).boxed()
    }

    /// The events of a session that count, those with sequences below `end`, one after the other: what tables,
    /// dashboard and standing are made of.
    pub fn counted_events(
        &self,
        session_key: i64,
        end: u64,
    ) -> BoxStream<'_, Result<CountedEvent, StorageError>> {
        let rows = query(COUNTED_EVENTS).bind(session_key).bind(signed(end));
        let rows = rows.stream_from(&self.readers);
        rows.map(move |row| counted_event(session_key, &row?)).boxed()
    }

    /// What they make of the session, without a plan.
    pub async fn record(&self, session_key: i64, end: u64) -> Result<Record, StorageError> {
        record_of(self.counted_events(session_key, end)).await
    }

    /// The same without what was measured of plays: what was answered, in a part of the time.
    pub async fn record_without_plays(
        &self,
        session_key: i64,
        end: u64,
    ) -> Result<Record, StorageError> {
        let rows = query(COUNTED_WITHOUT_PLAYS).bind(session_key).bind(signed(end));
        let rows = rows.stream_from(&self.readers);
        record_of(rows.map(move |row| counted_event(session_key, &row?))).await
    }

    /// How many differing bodies were sent for stored sequences, by session key.
    pub async fn conflict_counts(&self, study_id: &str) -> Result<Vec<(i64, u64)>, StorageError> {
        let rows = query(
            "SELECT c.session_key AS session_key, COUNT(*) AS conflicts FROM event_conflicts c \
             JOIN sessions s ON s.session_key = c.session_key WHERE s.study_id = $1 \
             GROUP BY c.session_key ORDER BY c.session_key",
        )
        .bind(study_id)
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                let conflicts = row.unsigned("event_conflicts", "conflicts")?;
                Ok((row.get("session_key")?, conflicts))
            })
            .collect()
    }

    /// How many differing bodies were sent for stored sequences of one session.
    pub async fn conflict_count(&self, session_key: i64) -> Result<u64, StorageError> {
        let row = query("SELECT COUNT(*) AS conflicts FROM event_conflicts WHERE session_key = $1")
            .bind(session_key)
            .fetch_one(&self.readers)
            .await?;
        row.unsigned("event_conflicts", "conflicts")
    }

    /// The recruitment identifiers of one session, by name.
    pub async fn session_recruitment(
        &self,
        session_key: i64,
    ) -> Result<BTreeMap<String, String>, StorageError> {
        let rows = query("SELECT name, value FROM recruitment WHERE session_key = $1")
            .bind(session_key)
            .fetch_all(&self.readers)
            .await?;
        rows.iter().map(|row| Ok((row.get("name")?, row.get("value")?))).collect()
    }

    /// The names of the recruitment identifiers that a study's participants have, in alphabetical order.
    pub async fn recruitment_names(&self, study_id: &str) -> Result<Vec<String>, StorageError> {
        let rows = query(
            "SELECT DISTINCT r.name AS name FROM recruitment r \
             JOIN sessions s ON s.session_key = r.session_key WHERE s.study_id = $1",
        )
        .bind(study_id)
        .fetch_all(&self.readers)
        .await?;
        let mut names: Vec<String> =
            rows.iter().map(|row| row.get("name")).collect::<Result<_, _>>()?;
        // By bytes, whatever order the database sorts by.
        names.sort();
        Ok(names)
    }

    /// The recruitment identifiers of a study's participants, by participant and name.
    pub async fn recruitment(&self, study_id: &str) -> Result<Vec<RecruitmentEntry>, StorageError> {
        let rows = query(
            "SELECT s.participant AS participant, r.name AS name, r.value AS value \
             FROM recruitment r JOIN sessions s ON s.session_key = r.session_key \
             WHERE s.study_id = $1 ORDER BY s.participant, r.name",
        )
        .bind(study_id)
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(RecruitmentEntry {
                    participant: row.unsigned("sessions", "participant")?,
                    name: row.get("name")?,
                    value: row.get("value")?,
                })
            })
            .collect()
    }

    /// A text for each study with sessions that differs after every change of them.
    pub async fn pulse(&self) -> Result<Vec<(String, String)>, StorageError> {
        let rows = query(
            "SELECT s.study_id, COUNT(*) AS sessions, \
             CAST(COALESCE(SUM(s.event_count), 0) AS BIGINT) AS events, \
             COUNT(s.ended_ms) AS ended, COALESCE(MAX(s.ended_ms), 0) AS last_ended, \
             COALESCE(MAX(e.last), 0) AS last_exclusion FROM sessions s LEFT JOIN \
             (SELECT session_key, MAX(exclusion_key) AS last FROM exclusions GROUP BY session_key) \
             e ON e.session_key = s.session_key GROUP BY s.study_id",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                let mut pulse = String::new();
                for name in ["sessions", "events", "ended", "last_ended", "last_exclusion"] {
                    pulse.push_str(&format!("{}.", row.get::<i64>(name)?));
                }
                Ok((row.get("study_id")?, pulse))
            })
            .collect()
    }
}
