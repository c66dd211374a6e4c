//! The HTTP interface: every address, and what every answer goes through.

pub(crate) mod cookies;
pub(crate) mod extract;
pub(crate) mod headers;
mod interface;
pub(crate) mod language;
mod metrics;
pub(crate) mod rate_limit;
mod refusal_pages;
pub(crate) mod responses;
pub(crate) mod statics;

use std::any::Any;
use std::time::{Duration, Instant};

use axum::Router;
use axum::extract::{DefaultBodyLimit, Request, State};
use axum::http::{StatusCode, Version, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use headers::{Headers, settled_headers};
use tower_http::catch_panic::CatchPanicLayer;

use crate::error::Error;
use crate::participant::{pages, previews, withdrawal};
use crate::researcher::handlers::{accounts, people, replays, streams, studies};
use crate::state::App;
use crate::state::rate_limit::Peer;
use crate::studio;
use crate::uploads::handlers as uploads;

/// A request's body in bytes at most: some twenty trials with their frame logs.
const LARGEST_BODY: usize = 2 * 1024 * 1024;
/// A request and its answer must have passed within this time.
const LONGEST_REQUEST: Duration = Duration::from_secs(60);

/// Where studies are uploaded, over slow lines too.
const UPLOAD: &str = "/researcher/upload";
const LONGEST_UPLOAD: Duration = Duration::from_secs(3600);

/// Every address of the server.
pub fn router(app: App) -> Router {
    interface::router()
        .route("/", get(pages::index))
        .route("/s/{study}", get(pages::participant_without_slash))
        .route("/s/{study}/", get(pages::participant))
        .route("/s/{study}/withdraw", get(withdrawal::page).post(withdrawal::redeem))
        .route("/assets/{hash}/{*name}", get(statics::asset))
        .route("/studio/files/{role}", get(studio::file))
        // A study counts its own bytes while it is written.
        .route(studio::STUDY, post(studio::study).layer(DefaultBodyLimit::disable()))
        .route(&format!("{}/{{study}}", studio::STUDY), get(studio::preparing))
        .merge(researchers(&app))
        .route("/healthz", get(|| async { "ok\n" }))
        .route("/readyz", get(pages::ready))
        .route("/metrics", get(metrics::metrics))
        .fallback(|| async { Error::NotFound })
        .method_not_allowed_fallback(|| async { Error::MethodNotAllowed })
        .layer(DefaultBodyLimit::max(LARGEST_BODY))
        .layer(middleware::from_fn(refuse_nul))
        .layer(middleware::from_fn(one_host))
        .layer(middleware::from_fn(time_limit))
        .layer(CatchPanicLayer::custom(panicked))
        .layer(middleware::from_fn_with_state(app.clone(), rate_limit::limit_rate))
        .layer(middleware::from_fn_with_state(
            Headers::of(&app.settings, app.is_encrypted()),
            settled_headers,
        ))
        .layer(middleware::from_fn_with_state(app.clone(), measure))
        .with_state(app)
}

/// What stands behind an account.
fn researchers(app: &App) -> Router<App> {
    const STUDY: &str = "/researcher/studies/{study}";
    const PERSON: &str = "/researcher/studies/{study}/participants/{number}";
    // The upload counts its own bytes while it writes them.
    let upload = post(uploads::upload).layer(DefaultBodyLimit::disable());
    interface::downloads()
        .route("/preview/{study}", get(pages::preview))
        .route("/preview/{study}/comparison", get(previews::comparison))
        .route("/preview/{study}/exertion", get(previews::exertion))
        .route("/studio", get(studio::show))
        .route("/researcher", get(studies::home))
        .route(STUDY, get(studies::study))
        .route(&format!("{STUDY}/live"), get(streams::live))
        .route(&format!("{STUDY}/withdraw"), post(studies::withdraw))
        .route(&format!("{STUDY}/keep"), post(studies::keep_overdue))
        .route("/researcher/clock", post(studies::confirm_clock))
        .route(PERSON, get(studies::participant))
        .route(&format!("{PERSON}/replay"), get(replays::page))
        .route(&format!("{PERSON}/replay/{{page}}"), get(replays::plays))
        .route(&format!("{PERSON}/exclude"), post(studies::exclude))
        .route(&format!("{PERSON}/include"), post(studies::include))
        .route(&format!("{PERSON}/erase"), post(studies::erase))
        .route("/researcher/login", get(accounts::login_page).post(accounts::login))
        .route("/researcher/logout", post(accounts::logout))
        .route("/researcher/logout-everywhere", post(accounts::logout_everywhere))
        .route("/researcher/link/{secret}", get(accounts::link_page).post(accounts::use_link))
        .route("/researcher/account", get(accounts::account))
        .route("/researcher/account/password", post(accounts::password))
        .route("/researcher/tokens", post(accounts::new_token))
        .route("/researcher/tokens/{key}/revoke", post(accounts::revoke_token))
        .route("/researcher/people", get(people::people))
        .route("/researcher/people/invite", post(people::invite))
        .route("/researcher/people/{key}", post(people::person))
        .route("/researcher/log", get(accounts::log))
        .route(&format!("{STUDY}/stage"), post(uploads::stage))
        .route(&format!("{STUDY}/remove"), post(uploads::remove))
        .route("/researcher/upload/{study}", get(uploads::preparing))
        .route(UPLOAD, get(uploads::page).merge(upload))
        .route("/researcher/language/{code}", get(accounts::language))
        .layer(middleware::from_fn_with_state(app.clone(), refusal_pages::refusals_as_pages))
}

/// No address of ours has a NUL in it, and PostgreSQL takes none.
async fn refuse_nul(request: Request, next: Next) -> Response {
    let uri = request.uri();
    let query = uri.query().unwrap_or_default();
    if uri.path().contains("%00") || query.contains("%00") {
        return Error::NulInText.into_response();
    }
    next.run(request).await
}

/// Links and the origins of forms are compared with the host. A request with two is refused: a proxy could read one of
/// them and this server the other. Over a connection of HTTP/1.1 there has to be one (RFC 9112, section 3.2).
async fn one_host(request: Request, next: Next) -> Response {
    let hosts = request.headers().get_all(header::HOST).iter().count();
    let is_over_connection = request.extensions().get::<Peer>().is_some();
    let needs_one = is_over_connection && request.version() >= Version::HTTP_11;
    if hosts > 1 || (hosts == 0 && needs_one) {
        return Error::NotOneHost.into_response();
    }
    next.run(request).await
}

async fn time_limit(request: Request, next: Next) -> Response {
    let longest = if [UPLOAD, studio::STUDY].contains(&request.uri().path()) {
        LONGEST_UPLOAD
    } else {
        LONGEST_REQUEST
    };
    match tokio::time::timeout(longest, next.run(request)).await {
        Ok(response) => response,
        Err(_) => Error::Timeout.into_response(),
    }
}

async fn measure(State(app): State<App>, request: Request, next: Next) -> Response {
    let began = Instant::now();
    let response = next.run(request).await;
    app.metrics.answered(response.status().as_u16(), began.elapsed());
    response
}

/// A panic is our mistake: its text may hold an answer, so that only its happening is logged.
fn panicked(_: Box<dyn Any + Send>) -> Response {
    let mut response = Error::internal("a request panicked").into_response();
    *response.status_mut() = StatusCode::INTERNAL_SERVER_ERROR;
    response
}
