//! The database's readers and its writer; compiled once for each database (see `storage/mod.rs`).

#[path = "accounts.rs"]
mod accounts;
#[path = "appends.rs"]
mod appends;
#[path = "changes.rs"]
mod changes;
#[path = "dump.rs"]
mod dump;
#[path = "enrol.rs"]
mod enrol;
#[path = "erase.rs"]
mod erase;
#[path = "writer.rs"]
mod writer;

use std::collections::BTreeMap;

use mimique_study::wire::Event;
use sqlx::{AssertSqlSafe, Pool, Row};

use super::super::StorageError;
use super::super::migrations::{LATEST, MIGRATIONS, Migration};
use super::super::records::{
    Appended, Completed, NewSession, RecruitmentEntry, Registered, SessionRecord, Status,
    StudyVersion, WrittenEvent,
};
use super::{BEGIN_WRITE, Connection, Db, FOR_UPDATE, LANES, LOCK_SCHEMA, migration_text};
use appends::Append;
use changes::{Change, Outcome};
pub(in crate::storage) use dump::restore;
use writer::Writer;

/// Columns of a session, in the order in which [`session_record`] names them.
const SESSION_COLUMNS: &str = "session_key, study_id, participant, config_hash, seed, stage, \
     language, client, withdrawal_hash, status, started_ms, last_event_ms, ended_ms, \
     event_count, next_sequence, receipt, receipt_events, slot, slot_expires_ms, slot_lasts_ms, \
     finished, assigned_condition";

/// Readers and writer of one database.
#[derive(Clone)]
pub(in crate::storage) struct Store {
    readers: Pool<Db>,
    writers: Pool<Db>,
    writer: Writer,
}

impl Store {
    pub async fn open(writers: Pool<Db>, readers: Pool<Db>) -> Result<Self, StorageError> {
        migrate(&writers).await?;
        let writer = Writer::spawn(&writers);
        Ok(Self { readers, writers, writer })
    }

    pub async fn close(&self) {
        self.writer.finish().await;
        self.readers.close().await;
        self.writers.close().await;
    }

    /// Makes a statement that would write, and writes nothing: where SQLite has opened a file for
    /// reading only, even `BEGIN IMMEDIATE` succeeds.
    pub async fn ensure_writable(&self) -> Result<(), StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        sqlx::query("DELETE FROM schema_migrations WHERE version < 0")
            .execute(&mut *transaction)
            .await?;
        transaction.rollback().await?;
        Ok(())
    }

    pub async fn ping(&self) -> Result<(), StorageError> {
        sqlx::query("SELECT 1").execute(&self.readers).await?;
        Ok(())
    }

    pub async fn is_current(&self) -> Result<bool, StorageError> {
        let row = sqlx::query("SELECT MAX(version) AS version FROM schema_migrations")
            .fetch_one(&self.readers)
            .await?;
        Ok(row.try_get::<Option<i64>, _>("version")? == Some(LATEST))
    }

    pub async fn session_counts(&self) -> Result<Vec<([String; 3], u64)>, StorageError> {
        let rows = sqlx::query(
            "SELECT study_id, stage, status, COUNT(*) AS number FROM sessions \
             GROUP BY study_id, stage, status ORDER BY study_id, stage, status",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                let kind =
                    [row.try_get("study_id")?, row.try_get("stage")?, row.try_get("status")?];
                Ok((kind, unsigned("sessions", row.try_get("number")?)?))
            })
            .collect()
    }

    pub async fn server_key(&self, name: &str, fresh: &str) -> Result<String, StorageError> {
        sqlx::query(
            "INSERT INTO server_keys (name, secret) VALUES ($1, $2) ON CONFLICT DO NOTHING",
        )
        .bind(name)
        .bind(fresh)
        .execute(&self.writers)
        .await?;
        let row = sqlx::query("SELECT secret FROM server_keys WHERE name = $1")
            .bind(name)
            .fetch_one(&self.writers)
            .await?;
        Ok(row.try_get("secret")?)
    }

    pub async fn register_study(
        &self,
        version: &StudyVersion,
        now_ms: i64,
    ) -> Result<Registered, StorageError> {
        let mut transaction = self.writers.begin_with(BEGIN_WRITE).await?;
        let before = sqlx::query(AssertSqlSafe(format!(
            "SELECT config_hash FROM studies WHERE study_id = $1{FOR_UPDATE}"
        )))
        .bind(&version.study_id)
        .fetch_optional(&mut *transaction)
        .await?;
        let before: Option<String> = before.map(|row| row.try_get("config_hash")).transpose()?;
        sqlx::query(
            "INSERT INTO studies (study_id, config_hash, next_participant) VALUES ($1, $2, 1) \
             ON CONFLICT (study_id) DO UPDATE SET config_hash = excluded.config_hash",
        )
        .bind(&version.study_id)
        .bind(&version.config_hash)
        .execute(&mut *transaction)
        .await?;
        let known = sqlx::query(
            "SELECT clips FROM study_versions WHERE study_id = $1 AND config_hash = $2",
        )
        .bind(&version.study_id)
        .bind(&version.config_hash)
        .fetch_optional(&mut *transaction)
        .await?;
        let known: Option<String> = known.map(|row| row.try_get("clips")).transpose()?;
        sqlx::query(
            "INSERT INTO study_versions (study_id, config_hash, file, clips, first_served_ms) \
             VALUES ($1, $2, $3, $4, $5) \
             ON CONFLICT (study_id, config_hash) DO UPDATE SET clips = excluded.clips",
        )
        .bind(&version.study_id)
        .bind(&version.config_hash)
        .bind(&version.file)
        .bind(&version.clips)
        .bind(now_ms)
        .execute(&mut *transaction)
        .await?;
        let number = sqlx::query(
            "SELECT COUNT(*) AS number FROM study_versions v JOIN study_versions mine \
             ON mine.study_id = v.study_id AND mine.config_hash = $2 WHERE v.study_id = $1 \
             AND (v.first_served_ms < mine.first_served_ms OR (v.first_served_ms = \
             mine.first_served_ms AND v.config_hash <= mine.config_hash))",
        )
        .bind(&version.study_id)
        .bind(&version.config_hash)
        .fetch_one(&mut *transaction)
        .await?;
        let running = sqlx::query(
            "SELECT COUNT(*) AS number FROM sessions WHERE study_id = $1 AND config_hash <> $2 \
             AND stage = 'live' AND status = 'started'",
        )
        .bind(&version.study_id)
        .bind(&version.config_hash)
        .fetch_one(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(Registered {
            version: unsigned("study_versions", number.try_get("number")?)?,
            replaces: before.filter(|hash| *hash != version.config_hash),
            running_elsewhere: unsigned("sessions", running.try_get("number")?)?,
            stimuli_changed: known.is_some_and(|clips| clips != version.clips),
        })
    }

    pub async fn study_versions(&self) -> Result<Vec<StudyVersion>, StorageError> {
        let rows = sqlx::query(
            "SELECT study_id, config_hash, file, clips FROM study_versions \
             ORDER BY study_id, first_served_ms, config_hash",
        )
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                Ok(StudyVersion {
                    study_id: row.try_get("study_id")?,
                    config_hash: row.try_get("config_hash")?,
                    file: row.try_get("file")?,
                    clips: row.try_get("clips")?,
                })
            })
            .collect()
    }

    pub async fn session(&self, token_hash: &str) -> Result<SessionRecord, StorageError> {
        let row = sqlx::query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE token_hash = $1"
        )))
        .bind(token_hash)
        .fetch_optional(&self.readers)
        .await?;
        session_record(&row.ok_or(StorageError::UnknownSession)?)
    }

    pub async fn sessions(&self, study_id: &str) -> Result<Vec<SessionRecord>, StorageError> {
        let rows = sqlx::query(AssertSqlSafe(format!(
            "SELECT {SESSION_COLUMNS} FROM sessions WHERE study_id = $1 ORDER BY participant"
        )))
        .bind(study_id)
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(session_record).collect()
    }

    pub async fn events(&self, session_key: i64) -> Result<Vec<Event>, StorageError> {
        let rows = sqlx::query(
            "SELECT sequence, at_ms, body FROM events WHERE session_key = $1 ORDER BY sequence",
        )
        .bind(session_key)
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                let body: String = row.try_get("body")?;
                Ok(Event {
                    sequence: unsigned("events", row.try_get("sequence")?)?,
                    at_ms: row.try_get("at_ms")?,
                    body: serde_json::from_str(&body).map_err(|problem| StorageError::Damaged {
                        table: "events",
                        problem: format!("session key {session_key}: {problem}"),
                    })?,
                })
            })
            .collect()
    }

    pub async fn conflict_counts(&self, study_id: &str) -> Result<Vec<(i64, u64)>, StorageError> {
        let rows = sqlx::query(
            "SELECT c.session_key AS session_key, COUNT(*) AS conflicts FROM event_conflicts c \
             JOIN sessions s ON s.session_key = c.session_key WHERE s.study_id = $1 \
             GROUP BY c.session_key ORDER BY c.session_key",
        )
        .bind(study_id)
        .fetch_all(&self.readers)
        .await?;
        rows.iter()
            .map(|row| {
                let conflicts = unsigned("event_conflicts", row.try_get("conflicts")?)?;
                Ok((row.try_get("session_key")?, conflicts))
            })
            .collect()
    }

    pub async fn session_recruitment(
        &self,
        session_key: i64,
    ) -> Result<BTreeMap<String, String>, StorageError> {
        let rows = sqlx::query("SELECT name, value FROM recruitment WHERE session_key = $1")
            .bind(session_key)
            .fetch_all(&self.readers)
            .await?;
        rows.iter().map(|row| Ok((row.try_get("name")?, row.try_get("value")?))).collect()
    }

    pub async fn recruitment(&self, study_id: &str) -> Result<Vec<RecruitmentEntry>, StorageError> {
        let rows = sqlx::query(
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
                    participant: unsigned("sessions", row.try_get("participant")?)?,
                    name: row.try_get("name")?,
                    value: row.try_get("value")?,
                })
            })
            .collect()
    }

    pub async fn start(&self, session: NewSession) -> Result<SessionRecord, StorageError> {
        let route = session.token_hash.clone();
        match self.writer.commit(&route, Change::Start(Box::new(session))).await? {
            Outcome::Started(record) => Ok(*record),
            _ => Err(StorageError::Stopping),
        }
    }

    pub async fn append(
        &self,
        token_hash: &str,
        events: Vec<WrittenEvent>,
        now_ms: i64,
    ) -> Result<Appended, StorageError> {
        let change = Change::Append(Append { token_hash: token_hash.to_owned(), events, now_ms });
        match self.writer.commit(token_hash, change).await? {
            Outcome::Appended(appended) => Ok(appended),
            _ => Err(StorageError::Stopping),
        }
    }

    pub async fn complete(
        &self,
        token_hash: &str,
        events: u64,
        receipt_key: &[u8],
        now_ms: i64,
    ) -> Result<Completed, StorageError> {
        let change = Change::Complete {
            token_hash: token_hash.to_owned(),
            events,
            receipt_key: receipt_key.to_owned(),
            now_ms,
        };
        match self.writer.commit(token_hash, change).await? {
            Outcome::Completed(completed) => Ok(completed),
            _ => Err(StorageError::Stopping),
        }
    }

    pub async fn withdraw(
        &self,
        token_hash: &str,
        withdrawal_hash: &str,
        now_ms: i64,
    ) -> Result<u64, StorageError> {
        let change = Change::Withdraw {
            token_hash: token_hash.to_owned(),
            withdrawal_hash: withdrawal_hash.to_owned(),
            now_ms,
        };
        match self.writer.commit(token_hash, change).await? {
            Outcome::Withdrawn { deleted } => Ok(deleted),
            _ => Err(StorageError::Stopping),
        }
    }
}

/// Runs every step that the database has not seen, in one transaction.
async fn migrate(pool: &Pool<Db>) -> Result<(), StorageError> {
    const VERSION: &str = "SELECT COALESCE(MAX(version), 0) AS version FROM schema_migrations";
    // A database that is up to date is not locked. Without the table there is nothing in it.
    if let Ok(row) = sqlx::query(VERSION).fetch_one(pool).await
        && row.try_get::<i64, _>("version")? == LATEST
    {
        return Ok(());
    }
    let mut transaction = pool.begin_with(BEGIN_WRITE).await?;
    if let Some(lock) = LOCK_SCHEMA {
        sqlx::query(lock).execute(&mut *transaction).await?;
    }
    sqlx::query("CREATE TABLE IF NOT EXISTS schema_migrations (version BIGINT PRIMARY KEY)")
        .execute(&mut *transaction)
        .await?;
    let row = sqlx::query(VERSION).fetch_one(&mut *transaction).await?;
    let found: i64 = row.try_get("version")?;
    if found > LATEST {
        return Err(StorageError::SchemaTooNew { found, known: LATEST });
    }
    for step in MIGRATIONS.iter().filter(|step| step.version > found) {
        migrate_step(&mut transaction, step).await?;
    }
    transaction.commit().await?;
    Ok(())
}

async fn migrate_step(connection: &mut Connection, step: &Migration) -> Result<(), StorageError> {
    sqlx::raw_sql(migration_text(step)).execute(&mut *connection).await?;
    sqlx::query("INSERT INTO schema_migrations (version) VALUES ($1)")
        .bind(step.version)
        .execute(connection)
        .await?;
    Ok(())
}

fn session_record(row: &<Db as sqlx::Database>::Row) -> Result<SessionRecord, StorageError> {
    const TABLE: &str = "sessions";
    let status: String = row.try_get("status")?;
    let receipt: Option<String> = row.try_get("receipt")?;
    let receipt_events: Option<i64> = row.try_get("receipt_events")?;
    Ok(SessionRecord {
        key: row.try_get("session_key")?,
        study_id: row.try_get("study_id")?,
        participant: unsigned(TABLE, row.try_get("participant")?)?,
        slot: unsigned(TABLE, row.try_get("slot")?)?,
        condition: Some(row.try_get("assigned_condition")?)
            .filter(|name: &String| !name.is_empty()),
        slot_expires_ms: row.try_get("slot_expires_ms")?,
        slot_lasts_ms: row.try_get("slot_lasts_ms")?,
        finished: row.try_get::<i64, _>("finished")? != 0,
        config_hash: row.try_get("config_hash")?,
        // The 64 bits of the seed, kept in a signed column.
        seed: row.try_get::<i64, _>("seed")?.cast_unsigned(),
        stage: row.try_get("stage")?,
        language: row.try_get("language")?,
        client: row.try_get("client")?,
        withdrawal_hash: row.try_get("withdrawal_hash")?,
        status: Status::from_word(&status).ok_or_else(|| StorageError::Damaged {
            table: TABLE,
            problem: format!("status {status}"),
        })?,
        started_ms: row.try_get("started_ms")?,
        last_event_ms: row.try_get("last_event_ms")?,
        ended_ms: row.try_get("ended_ms")?,
        event_count: unsigned(TABLE, row.try_get("event_count")?)?,
        next_sequence: unsigned(TABLE, row.try_get("next_sequence")?)?,
        receipt: match (receipt, receipt_events) {
            (Some(receipt), Some(events)) => Some((receipt, unsigned(TABLE, events)?)),
            _ => None,
        },
    })
}

fn unsigned(table: &'static str, value: i64) -> Result<u64, StorageError> {
    u64::try_from(value)
        .map_err(|_| StorageError::Damaged { table, problem: format!("negative number {value}") })
}

/// A number of ours as the databases keep it; ours never reach the sign.
fn signed(value: u64) -> i64 {
    i64::try_from(value).unwrap_or(i64::MAX)
}
