//! The studio: its page, the files that it opens by itself, and the studies that it makes, hosted to be looked at.

mod page;
mod study;

use axum::extract::{Path, State};
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
pub use page::{StudioFile, StudioFiles, StudioRole};
pub(crate) use study::{STUDY, preparing, study};

use self::page::studio_page;
use self::study::token;
use crate::error::Error;
use crate::participant::pages::may_look;
use crate::state::App;

/// The page: everything in it happens in the browser.
pub(crate) async fn show(State(app): State<App>, headers: HeaderMap) -> Result<Response, Error> {
    may_look(&app, &headers).await?;
    studio_page(&app, &token(&app, &headers).await, &headers)
}

/// A file that the studio opens by itself.
pub(crate) async fn file(
    State(app): State<App>,
    Path(role): Path<String>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    may_look(&app, &headers).await?;
    let found = app.studio_files.iter().find(|(known, _)| known.word() == role);
    let (_, file) = found.ok_or(Error::NotFound)?;
    Ok(([(header::CONTENT_TYPE, "application/octet-stream")], file.bytes.clone()).into_response())
}
