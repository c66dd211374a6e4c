//! What previews show beside a clip, and participants never get.

use axum::Json;
use axum::extract::{Path, Query, State};
use axum::http::HeaderMap;
use mimique_comparison::StudyComparison;
use mimique_stimulus::{ExertionDrawing, exertion_drawing};
use serde::Deserialize;

use super::pages::may_preview;
use crate::comparison::comparison_of;
use crate::error::Error;
use crate::state::App;

/// Which clip is asked for.
#[derive(Deserialize)]
pub(crate) struct OfClip {
    clip: String,
}

/// How the clips of each segment differ, and in what they should not.
pub(crate) async fn comparison(
    State(app): State<App>,
    Path(study): Path<String>,
    headers: HeaderMap,
) -> Result<Json<StudyComparison>, Error> {
    may_preview(&app, &study, &headers).await?;
    let hosted = app.study(&study)?;
    let compute = move || {
        let places = hosted.places().ok_or(Error::NotFound)?;
        comparison_of(hosted.study(), hosted.clips(), &places.packs)
            .map_err(|problem| Error::NoComparison { problem })
    };
    let computed = tokio::task::spawn_blocking(compute).await.map_err(Error::internal)?;
    computed.map(Json)
}

/// The body, the courses and the breath of a clip whose capture is an exertion; null for other clips.
pub(crate) async fn exertion(
    State(app): State<App>,
    Path(study): Path<String>,
    Query(asked): Query<OfClip>,
    headers: HeaderMap,
) -> Result<Json<Option<ExertionDrawing>>, Error> {
    may_preview(&app, &study, &headers).await?;
    let hosted = app.study(&study)?;
    let compute = move || {
        let clip = hosted.study().clips().into_iter().find(|clip| clip.id == asked.clip);
        let clip = clip.ok_or(Error::NotFound)?;
        exertion_drawing(hosted.study(), &clip, hosted.places())
            .map_err(|error| Error::NoExertion { problem: error.to_string() })
    };
    let computed = tokio::task::spawn_blocking(compute).await.map_err(Error::internal)?;
    computed.map(Json)
}
