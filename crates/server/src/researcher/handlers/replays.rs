//! `/researcher/studies/{study}/participants/{number}/replay`: a session gone through again.

use axum::Json;
use axum::extract::{Path, State};
use axum::response::{IntoResponse as _, Response};
use mimique_session::flow::KeptFrames;
use mimique_storage::Role;

use super::studies::{session, visible};
use crate::accounts::audit::audit;
use crate::accounts::identity::Researcher;
use crate::error::Error;
use crate::researcher::pages::frame::Frame;
use crate::researcher::pages::replay::replay_page;
use crate::researcher::replay::Replay;
use crate::state::App;

/// Every page that the participant saw, for those who may read answers.
pub(crate) async fn page(
    State(app): State<App>,
    Path((id, number)): Path<(String, u64)>,
    who: Researcher,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Analyst)?;
    let session = session(&app, study.id(), number).await?;
    let replay = Replay::load(&app.storage, study.id(), &session, KeptFrames::None).await?;
    let subject = mimique_storage::participant_id(number);
    audit(&app, &who, "replay a session", study.id(), &subject).await?;
    let frame = Frame::in_study(&app, &who, study.id());
    let packs = app.settings.packs_address.as_deref().unwrap_or("/packs");
    Ok(replay_page(&frame, study.id(), packs, &session, &replay))
}

/// The plays of one of these pages, by its place from 1, with their frames.
pub(crate) async fn plays(
    State(app): State<App>,
    Path((id, number, page)): Path<(String, u64, usize)>,
    who: Researcher,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Analyst)?;
    let session = session(&app, study.id(), number).await?;
    let place = page.checked_sub(1).ok_or(Error::NotFound)?;
    let replay =
        Replay::load(&app.storage, study.id(), &session, KeptFrames::OfPage(place)).await?;
    let plays = replay.plays(place).ok_or(Error::NotFound)?;
    Ok(Json(plays).into_response())
}
