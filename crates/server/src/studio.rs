//! The studio on its own: its page, and the files that it opens by itself. No study, no answers, no
//! database.

use std::collections::BTreeMap;
use std::future::Future;
use std::sync::Arc;

use axum::Router;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::{HeaderMap, header};
use axum::middleware;
use axum::response::{Html, IntoResponse, Redirect, Response};
use axum::routing::get;
use tokio::net::TcpListener;

use crate::assets::Assets;
use crate::error::Error;
use crate::routes::security_headers;
use crate::serve::ServeError;

/// What a file is to the studio.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StudioRole {
    /// The avatar.
    Avatar,
    /// The JSON beside it.
    Settings,
    /// The capture, or recorded weights.
    Take,
    /// The marker map.
    Map,
}

impl StudioRole {
    fn word(self) -> &'static str {
        match self {
            Self::Avatar => "avatar",
            Self::Settings => "settings",
            Self::Take => "take",
            Self::Map => "map",
        }
    }
}

/// A file that the studio opens when its page is loaded.
#[derive(Debug, Clone)]
pub struct StudioFile {
    /// Its name, for the page.
    pub name: String,
    /// What it holds.
    pub bytes: Bytes,
}

/// The files by what they are.
pub type StudioFiles = BTreeMap<StudioRole, StudioFile>;

#[derive(Clone)]
struct Desk {
    assets: Arc<Assets>,
    files: Arc<StudioFiles>,
}

/// The studio's addresses.
pub fn studio_router(assets: Assets, files: StudioFiles) -> Router {
    Router::new()
        .route("/", get(|| async { Redirect::temporary("/studio") }))
        .route("/studio", get(page))
        .route("/studio/files/{role}", get(file))
        .route("/assets/{hash}/{*name}", get(asset))
        .fallback(|| async { Error::NotFound })
        .layer(middleware::from_fn(security_headers))
        .with_state(Desk { assets: Arc::new(assets), files: Arc::new(files) })
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

/// The studio's page; `files` are what it opens by itself.
pub(crate) fn studio_page(assets: &Assets, files: &StudioFiles) -> Result<Response, Error> {
    let names: BTreeMap<&str, &str> =
        files.iter().map(|(role, file)| (role.word(), file.name.as_str())).collect();
    let names = serde_json::to_string(&names).unwrap_or_default();
    let prefix = assets.prefix();
    let page = assets
        .page("studio.html", &[("assets", prefix.as_str()), ("files", names.as_str())])
        .ok_or(Error::NotFound)?;
    Ok(([(header::CACHE_CONTROL, "no-cache")], Html(page)).into_response())
}

async fn page(State(desk): State<Desk>) -> Result<Response, Error> {
    studio_page(&desk.assets, &desk.files)
}

async fn file(State(desk): State<Desk>, Path(role): Path<String>) -> Result<Response, Error> {
    let found = desk.files.iter().find(|(known, _)| known.word() == role);
    let (_, file) = found.ok_or(Error::NotFound)?;
    Ok(([(header::CONTENT_TYPE, "application/octet-stream")], file.bytes.clone()).into_response())
}

async fn asset(
    State(desk): State<Desk>,
    Path((hash, name)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    desk.assets.get(&hash, &name).ok_or(Error::NotFound)?.respond(&headers)
}
