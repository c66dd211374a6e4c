//! Answers whose time is over are deleted: `consent.retentionDays` of the version they were given
//! under, counted from the end of the session, or from its last sign of life.

use std::time::{Duration, Instant, SystemTime};

use mimique_storage::{Storage, StorageError};
use serde_json::Value;

use crate::clock;
use crate::state::App;

const DAY_MS: i64 = 24 * 3600 * 1000;
/// How often the server looks.
const INTERVAL: Duration = Duration::from_secs(3600);
/// How far the clock may have drifted from the machine's steady one before it is not believed.
const LARGEST_JUMP: Duration = Duration::from_secs(3600);

/// Deletes what is overdue; gives each study's sessions that were emptied.
pub async fn erase_overdue(
    storage: &Storage,
    now_ms: i64,
) -> Result<Vec<(String, u64)>, StorageError> {
    let mut erased: Vec<(String, u64)> = Vec::new();
    for version in storage.study_versions().await? {
        let file: Value = serde_json::from_str(&version.file).unwrap_or_default();
        let Some(days) = file["consent"]["retentionDays"].as_i64().filter(|days| *days > 0) else {
            continue;
        };
        let before = now_ms.saturating_sub(days.saturating_mul(DAY_MS));
        let sessions = storage
            .erase_ended_before(&version.study_id, &version.config_hash, before, now_ms)
            .await?;
        match erased.last_mut().filter(|(study, _)| *study == version.study_id) {
            Some((_, sum)) => *sum += sessions,
            None => erased.push((version.study_id, sessions)),
        }
    }
    Ok(erased)
}

/// Looks every hour until the server stops. A clock that has jumped since the start deletes nothing.
pub(crate) async fn watch(app: App) {
    let (steady, wall) = (Instant::now(), SystemTime::now());
    loop {
        let gone = SystemTime::now().duration_since(wall).unwrap_or_default();
        if gone.abs_diff(steady.elapsed()) > LARGEST_JUMP {
            tracing::warn!(
                "the clock has jumped: nothing is deleted for its age until the next start"
            );
        } else {
            match erase_overdue(&app.storage, clock::now_ms()).await {
                Ok(erased) => {
                    for (study, sessions) in erased.iter().filter(|(_, sessions)| *sessions > 0) {
                        tracing::info!(
                            "study {study}: the answers of {sessions} sessions were deleted, their \
                             time being over"
                        );
                    }
                }
                Err(error) => tracing::warn!("looking for overdue answers: {error}"),
            }
        }
        tokio::time::sleep(INTERVAL).await;
    }
}
