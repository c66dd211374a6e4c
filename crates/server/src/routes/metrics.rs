//! `/metrics`: for Prometheus, from this machine itself or with the operator's token.

use axum::extract::{Extension, State};
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};

use crate::app::App;
use crate::error::Error;
use crate::limits::{Peer, is_local};
use crate::secret;

pub(super) async fn metrics(
    State(app): State<App>,
    peer: Option<Extension<Peer>>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let given = headers
        .get(header::AUTHORIZATION)
        .and_then(|value| value.to_str().ok()?.strip_prefix("Bearer "));
    let token = app.settings.metrics_token.as_deref();
    let known = given.zip(token).is_some_and(|(given, token)| secret::same(given, token));
    // To anybody else there is nothing here.
    if !known && !is_local(&headers, peer.map(|Extension(peer)| peer)) {
        return Err(Error::NotFound);
    }
    let sessions = app.storage.session_counts().await?;
    let kind = "text/plain; version=0.0.4; charset=utf-8";
    Ok(([(header::CONTENT_TYPE, kind)], app.metrics.text(&sessions)).into_response())
}
