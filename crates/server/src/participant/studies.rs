//! `/api/studies`: which studies there are, and all that a page needs of one.

use axum::Json;
use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use mimique_session::wire::StudySummary;
use mimique_storage::Role;
use serde::Deserialize;

use super::pages::may_look;
use crate::error::Error;
use crate::state::App;

pub(crate) async fn list(
    State(app): State<App>,
    headers: HeaderMap,
) -> Result<Json<Vec<StudySummary>>, Error> {
    let who = may_look(&app, &headers).await?;
    let may_see = |id: &str| who.as_ref().is_none_or(|who| who.role_in(id) > Role::Nothing);
    let studies = app.catalogue.studies();
    let seen = studies.iter().filter(|study| may_see(study.id()));
    Ok(Json(seen.map(|study| study.summary()).collect()))
}

#[derive(Deserialize)]
pub(crate) struct Version {
    config_hash: Option<String>,
}

/// A session that began under an earlier version of the study goes on with that version.
pub(crate) async fn bundle(
    State(app): State<App>,
    Path(study): Path<String>,
    Query(version): Query<Version>,
) -> Result<Response, Error> {
    let text = app.catalogue.bundle(&study, version.config_hash.as_deref())?.to_string();
    Ok(([(header::CONTENT_TYPE, "application/json")], text).into_response())
}
