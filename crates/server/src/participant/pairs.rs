//! What all others answered to the pairs of an active schedule: a page draws its next pairs under it.

use axum::Json;
use axum::extract::{Path, State};
use mimique_storage::StorageError;
use mimique_study::{PairCount, PairCounts, PairsComponent};

use super::sessions::token_hash;
use crate::error::Error;
use crate::state::App;

/// Choices of everybody else, in the same version and stage of the study, between the levels of a block of pairs; none
/// of a block that does not draw its pairs by them, and of a version that is not hosted any more. Whoever is deleted is
/// not among them. They are as new as the sums of the dashboard.
pub(crate) async fn counts(
    State(app): State<App>,
    Path((token, component)): Path<(String, String)>,
) -> Result<Json<Vec<PairCount>>, Error> {
    let own = app.storage.session(&token_hash(&token)?).await?;
    if own.is_deleted() {
        return Err(StorageError::Withdrawn.into());
    }
    let is_active =
        |(name, block): (&str, PairsComponent)| name == component && block.schedule.active() > 0;
    let is_told = app.study(&own.study_id).is_ok_and(|study| {
        study.config_hash() == own.config_hash && study.study().pair_blocks().any(is_active)
    });
    if !is_told {
        return Ok(Json(Vec::new()));
    }
    let all = app.sums.of_study(&app.storage, &own.study_id).await?;
    let mut counts = PairCounts::default();
    for (session, sums) in &all.sessions {
        let counts_here = session.config_hash == own.config_hash && session.stage == own.stage;
        if session.key == own.key || !counts_here {
            continue;
        }
        let pairs = sums.as_ref().and_then(|sums| sums.pairs.get(&component));
        pairs.into_iter().for_each(|pairs| counts.add_all(pairs));
    }
    Ok(Json(counts.0))
}
