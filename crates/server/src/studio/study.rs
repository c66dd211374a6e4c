//! A study that the studio has made: taken in as an upload, hosted as a pilot, so that its preview can be looked at.

use axum::Json;
use axum::body::Body;
use axum::extract::{Path, State};
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use mimique_storage::Role;
use serde_json::json;
use tokio_stream::StreamExt as _;

use crate::accounts::csrf::{FormToken, check_origin};
use crate::accounts::identity::Researcher;
use crate::error::Error;
use crate::state::App;
use crate::state::preparations::{Noted, Preparation};
use crate::uploads::{self, Incoming, Taken};

/// Where studies are sent to.
pub(crate) const STUDY: &str = "/studio/study";
/// Name of the header with the page's token.
const TOKEN: &str = "x-mimique-form";
/// What the page's token is where nobody has an account.
const ALONE: &str = "alone";

/// What the page sends along with a study; empty for those who may not have one hosted.
pub(super) async fn token(app: &App, headers: &HeaderMap) -> String {
    if app.access.studio_alone {
        return ALONE.to_owned();
    }
    match Researcher::of(app, headers).await {
        Ok(who) if who.most() >= Role::Owner => FormToken::of(app, &who).value,
        _ => String::new(),
    }
}

/// Who sends a study: an owner, or nobody known where the studio stands alone.
async fn sender(app: &App, headers: &HeaderMap) -> Result<Option<Researcher>, Error> {
    if app.access.studio_alone {
        return Ok(None);
    }
    let who = Researcher::of(app, headers).await?;
    if who.most() < Role::Owner {
        return Err(Error::NotAllowed);
    }
    Ok(Some(who))
}

/// Takes a ZIP archive of a study: `{"study": ID}`, or what is wrong with it, `{"issues": [...]}`.
pub(crate) async fn study(
    State(app): State<App>,
    headers: HeaderMap,
    body: Body,
) -> Result<Response, Error> {
    let who = sender(&app, &headers).await?;
    check_origin(&app, &headers)?;
    // A page of another site can send no header of its own.
    let sent = headers.get(TOKEN).and_then(|value| value.to_str().ok()).unwrap_or_default();
    let is_own = match &who {
        Some(who) => FormToken::of(&app, who).is(sent),
        None => sent == ALONE,
    };
    if !is_own {
        return Err(Error::ForeignForm);
    }
    let mut incoming = Incoming::open(&app).await?;
    let mut chunks = body.into_data_stream();
    while let Some(chunk) = chunks.next().await {
        incoming.add(&chunk.map_err(|_| Error::BrokenUpload)?).await?;
    }
    let arrived = incoming.finish().await?;
    Ok(match uploads::take(&app, who.as_ref(), arrived).await? {
        Taken::Accepted { study_id } => {
            (StatusCode::ACCEPTED, Json(json!({ "study": study_id }))).into_response()
        }
        Taken::Refused(issues) => {
            let issues: Vec<Noted> = issues.iter().map(Noted::from).collect();
            (StatusCode::UNPROCESSABLE_ENTITY, Json(json!({ "issues": issues }))).into_response()
        }
    })
}

/// How far a study is: [`Preparation`].
pub(crate) async fn preparing(
    State(app): State<App>,
    Path(id): Path<String>,
    headers: HeaderMap,
) -> Result<Json<Preparation>, Error> {
    if let Some(who) = sender(&app, &headers).await? {
        who.needs_in(&id, Role::Owner)?;
    }
    Preparation::of(&app.storage, &id).await?.map(Json).ok_or(Error::NotFound)
}
