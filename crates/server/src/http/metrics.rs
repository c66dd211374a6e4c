//! `/metrics`: for Prometheus, from this machine itself or with the operator's token.

use axum::extract::{Extension, State};
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};

use super::rate_limit::is_local;
use crate::accounts::identity::bearer;
use crate::error::Error;
use crate::secret;
use crate::state::App;
use crate::state::metrics::MEDIA_TYPE;
use crate::state::rate_limit::Peer;

pub(super) async fn metrics(
    State(app): State<App>,
    peer: Option<Extension<Peer>>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let given = bearer(&headers);
    let token = app.settings.metrics_token.as_deref();
    let known = given.zip(token).is_some_and(|(given, token)| secret::same(given, token));
    // To anybody else there is nothing here.
    if !known && !is_local(&headers, peer.map(|Extension(peer)| peer)) {
        return Err(Error::NotFound);
    }
    let sessions = app.storage.session_counts().await?;
    let text = app.metrics.text(&sessions).map_err(Error::internal)?;
    Ok(([(header::CONTENT_TYPE, MEDIA_TYPE)], text).into_response())
}
