//! What the dashboard counts of each session, kept beside its events so that they are read once.
//!
//! Sums are kept by whoever makes them, some time after the events came, and are current as long as the
//! session is what they were made of. Storage does not know what is in them; they are deleted with the
//! answers.

use futures_util::stream::{BoxStream, StreamExt as _};
use sqlx::AssertSqlSafe;

use super::row::{SESSION_COLUMNS, session_record};
use crate::database::{Builder, Row, Value, query, signed};
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::{CountedSo, KeptSums, SessionRecord};

/// Sums that are written, or asked for, by one statement.
const AT_ONCE: usize = 64;

impl Storage {
    /// The sums of a form that are kept of a study's sessions, one after the other.
    pub fn kept_sums(
        &self,
        study_id: &str,
        form: i64,
    ) -> BoxStream<'_, Result<KeptSums, StorageError>> {
        let rows = query(
            "SELECT v.session_key, v.event_count, v.receipt_events, v.sums FROM session_sums v \
             JOIN sessions s ON s.session_key = v.session_key WHERE s.study_id = $1 AND v.form = $2",
        );
        let rows = rows.bind(study_id).bind(form).stream_from(&self.readers);
        rows.map(|row| kept(&row?)).boxed()
    }

    /// The sums of a form that are kept of some sessions.
    pub async fn kept_sums_of(
        &self,
        session_keys: &[i64],
        form: i64,
    ) -> Result<Vec<KeptSums>, StorageError> {
        let mut found = Vec::with_capacity(session_keys.len());
        for keys in session_keys.chunks(AT_ONCE) {
            let mut select = Builder::new(
                "SELECT session_key, event_count, receipt_events, sums FROM session_sums \
                 WHERE session_key IN (",
            );
            select.push_list("CAST({} AS BIGINT)", keys.iter().map(|key| Value::from(*key)));
            select.push(") AND form = ");
            select.push_list("CAST({} AS BIGINT)", [Value::from(form)]);
            select.push(" ORDER BY session_key");
            for row in select.finish().once().fetch_all(&self.readers).await? {
                found.push(kept(&row)?);
            }
        }
        Ok(found)
    }

    /// Sessions of a study behind one, by their keys, whose sums of a form are not current and that rest: they
    /// have ended, or their last sign of life came before `before_ms`. So many at most.
    pub async fn sessions_to_sum(
        &self,
        study_id: &str,
        form: i64,
        before_ms: i64,
        after_key: i64,
        most: u32,
    ) -> Result<Vec<SessionRecord>, StorageError> {
        let columns = SESSION_COLUMNS.split(", ").map(|name| format!("s.{}", name.trim()));
        let columns: Vec<String> = columns.collect();
        let rows = query(AssertSqlSafe(format!(
            "SELECT {} FROM sessions s LEFT JOIN session_sums v \
             ON v.session_key = s.session_key AND v.form = $2 \
             WHERE s.study_id = $1 AND s.deleted_ms IS NULL AND (v.session_key IS NULL \
             OR v.event_count <> s.event_count \
             OR v.receipt_events <> COALESCE(s.receipt_events, -1)) \
             AND (s.status <> 'active' OR COALESCE(s.last_event_ms, s.started_ms) < $3) \
             AND s.session_key > $4 ORDER BY s.session_key LIMIT $5",
            columns.join(", ")
        )))
        .bind(study_id)
        .bind(form)
        .bind(before_ms)
        .bind(after_key)
        .bind(i64::from(most))
        .fetch_all(&self.readers)
        .await?;
        rows.iter().map(session_record).collect()
    }

    /// Keeps sums of a form. Those of a session that is another one by now, or is deleted, are not kept: the
    /// session's row is locked meanwhile, so that nothing of deleted answers is left behind.
    pub async fn keep_sums(&self, form: i64, sums: &[KeptSums]) -> Result<(), StorageError> {
        for sums in sums.chunks(AT_ONCE) {
            let mut transaction = self.writers.begin_write().await?;
            let mut select = Builder::new(
                "SELECT session_key, event_count, receipt_events FROM sessions \
                 WHERE deleted_ms IS NULL AND session_key IN (",
            );
            select
                .push_list("CAST({} AS BIGINT)", sums.iter().map(|it| Value::from(it.session_key)));
            select.push(") ORDER BY session_key");
            select.push(transaction.dialect().row_lock);
            let rows = select.finish().once().fetch_all(&mut transaction).await?;
            let mut current = Vec::with_capacity(rows.len());
            for row in &rows {
                let receipt_events: Option<i64> = row.get("receipt_events")?;
                let counted = CountedSo {
                    event_count: row.unsigned("sessions", "event_count")?,
                    receipt_events: receipt_events.and_then(|count| u64::try_from(count).ok()),
                };
                current.push((row.get::<i64>("session_key")?, counted));
            }
            for kept in sums {
                if current.contains(&(kept.session_key, kept.counted)) {
                    put(&mut transaction, form, kept).await?;
                }
            }
            transaction.commit().await?;
        }
        Ok(())
    }
}

async fn put(
    transaction: &mut crate::database::Transaction,
    form: i64,
    kept: &KeptSums,
) -> Result<(), StorageError> {
    query(
        "INSERT INTO session_sums (session_key, form, event_count, receipt_events, sums) \
         VALUES ($1, $2, $3, $4, $5) ON CONFLICT (session_key) DO UPDATE SET \
         form = excluded.form, event_count = excluded.event_count, \
         receipt_events = excluded.receipt_events, sums = excluded.sums",
    )
    .bind(kept.session_key)
    .bind(form)
    .bind(signed(kept.counted.event_count))
    .bind(kept.counted.receipt_events.map_or(-1, signed))
    .bind(&kept.sums)
    .execute(transaction)
    .await?;
    Ok(())
}

fn kept(row: &Row) -> Result<KeptSums, StorageError> {
    let receipt_events: i64 = row.get("receipt_events")?;
    Ok(KeptSums {
        session_key: row.get("session_key")?,
        counted: CountedSo {
            event_count: row.unsigned("session_sums", "event_count")?,
            receipt_events: u64::try_from(receipt_events).ok(),
        },
        sums: row.get("sums")?,
    })
}
