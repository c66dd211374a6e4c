//! `/api/panics`: panics of the modules that run in browsers, for this server's log. Nothing is stored.

use std::time::Instant;

use axum::extract::{DefaultBodyLimit, State};
use axum::handler::Handler as _;
use axum::http::HeaderMap;
use axum::routing::{MethodRouter, post};
use axum::{Extension, Json};
use mimique_session::wire::PanicReport;

use crate::error::Error;
use crate::http::extract::Body;
use crate::http::rate_limit::caller_of;
use crate::state::App;
use crate::state::panic_reports::Verdict;
use crate::state::rate_limit::Peer;

/// Longest report, bytes: a message and a place, cut by the page.
const LONGEST_REPORT: usize = 4096;

pub(crate) fn route() -> MethodRouter<App> {
    post(report.layer(DefaultBodyLimit::max(LONGEST_REPORT)))
}

/// What comes from outside is written with its control characters escaped: one report is one line. A few are taken
/// from one address in a minute; the same report is written once a minute, with the number of its repeats.
async fn report(
    State(app): State<App>,
    peer: Option<Extension<Peer>>,
    headers: HeaderMap,
    Body(report): Body<PanicReport>,
) -> Result<Json<()>, Error> {
    let PanicReport { module, backend, message, place, study } = report;
    let caller = caller_of(&app, &headers, peer.map(|Extension(peer)| peer));
    let report = (&module, &backend, &message, &place, &study);
    match app.panic_reports.verdict(caller, &report, Instant::now()) {
        Verdict::TooMany => return Err(Error::RateLimited),
        Verdict::Counted => {}
        Verdict::Write { repeats } => {
            tracing::warn!(?module, ?backend, panic = ?message, ?place, ?study, repeats, "a module panicked in a browser");
        }
    }
    Ok(Json(()))
}
