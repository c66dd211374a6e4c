//! The studio on its own: its page, and the files that it opens by itself. No study, no answers, no
//! database.

pub(crate) mod page;

use std::future::Future;
use std::sync::Arc;

use axum::Router;
use axum::extract::{Path, State};
use axum::http::{HeaderMap, header};
use axum::middleware;
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::get;
use page::studio_page;
pub use page::{StudioFile, StudioFiles, StudioRole};
use tokio::net::TcpListener;

use crate::error::Error;
use crate::files::assets::Assets;
use crate::http::headers::security_headers;
use crate::serve::ServeError;

#[derive(Clone)]
struct StudioState {
    assets: Arc<Assets>,
    files: Arc<StudioFiles>,
}

/// The studio's addresses.
pub fn studio_router(assets: Assets, files: StudioFiles) -> Router {
    Router::new()
        .route("/", get(|| async { Redirect::temporary("/studio") }))
        .route("/studio", get(show))
        .route("/studio/files/{role}", get(file))
        .route("/assets/{hash}/{*name}", get(asset))
        .fallback(|| async { Error::NotFound })
        .layer(middleware::from_fn(security_headers))
        .with_state(StudioState { assets: Arc::new(assets), files: Arc::new(files) })
}

/// Serves the studio until `stop` resolves.
///
/// # Errors
/// [`ServeError`]: the listening socket failed.
pub async fn serve_studio(
    router: Router,
    listener: TcpListener,
    stop: impl Future<Output = ()> + Send + 'static,
) -> Result<(), ServeError> {
    Ok(axum::serve(listener, router).with_graceful_shutdown(stop).await?)
}

async fn show(State(studio): State<StudioState>, headers: HeaderMap) -> Result<Response, Error> {
    studio_page(&studio.assets, &studio.files, &headers)
}

async fn file(
    State(studio): State<StudioState>,
    Path(role): Path<String>,
) -> Result<Response, Error> {
    let found = studio.files.iter().find(|(known, _)| known.word() == role);
    let (_, file) = found.ok_or(Error::NotFound)?;
    Ok(([(header::CONTENT_TYPE, "application/octet-stream")], file.bytes.clone()).into_response())
}

async fn asset(
    State(studio): State<StudioState>,
    Path((hash, name)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    studio.assets.get(&hash, &name).ok_or(Error::NotFound)?.respond(&headers)
}
