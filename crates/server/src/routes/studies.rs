//! `/api/studies`: which studies there are, and all that a page needs of one.

use axum::Json;
use axum::extract::{Path, State};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use mimique_study::wire::StudySummary;

use crate::app::App;
use crate::error::Error;

pub(super) async fn list(State(app): State<App>) -> Json<Vec<StudySummary>> {
    Json(app.studies.values().map(|study| study.summary()).collect())
}

pub(super) async fn bundle(
    State(app): State<App>,
    Path(study): Path<String>,
) -> Result<Response, Error> {
    let text = app.study(&study)?.bundle_text().to_owned();
    Ok(([(header::CONTENT_TYPE, "application/json")], text).into_response())
}
