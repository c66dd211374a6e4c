//! `/api/panics`: panics of the modules that run in browsers, for this server's log. Nothing is stored.

use axum::Json;
use axum::extract::DefaultBodyLimit;
use axum::handler::Handler as _;
use axum::routing::{MethodRouter, post};
use mimique_session::wire::PanicReport;

use crate::http::extract::Body;
use crate::state::App;

/// Longest report, bytes: a message and a place, cut by the page.
const LONGEST_REPORT: usize = 4096;

pub(crate) fn route() -> MethodRouter<App> {
    post(report.layer(DefaultBodyLimit::max(LONGEST_REPORT)))
}

/// What comes from outside is written with its control characters escaped: one report is one line.
async fn report(Body(report): Body<PanicReport>) -> Json<()> {
    let PanicReport { module, backend, message, place, study } = report;
    tracing::warn!(?module, ?backend, panic = ?message, ?place, ?study, "a module panicked in a browser");
    Json(())
}
