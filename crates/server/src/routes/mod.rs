//! The HTTP interface: a file a group of addresses.

mod accounts;
mod for_people;
mod inline_styles;
mod interface;
mod metrics;
mod pages;
mod researcher;
mod sessions;
mod statics;
mod studies;
mod uploads;

use std::any::Any;
use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, FromRequest, FromRequestParts, Query, Request, State};
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use tower_http::catch_panic::CatchPanicLayer;

use crate::app::App;
use crate::error::Error;
use crate::limits;
use crate::settings::Settings;

/// A request's body in bytes at most: some twenty trials with their frame logs.
const LARGEST_BODY: usize = 2 * 1024 * 1024;
/// A request and its answer must have passed within this time.
const LONGEST_REQUEST: Duration = Duration::from_secs(60);

/// Where studies are uploaded, over slow lines too.
const UPLOAD: &str = "/researcher/upload";
const LONGEST_UPLOAD: Duration = Duration::from_secs(3600);

/// Scripts and styles only from here; nothing inline, nothing from elsewhere but packs, where they
/// are named.
fn content_security_policy(packs: Option<&str>) -> String {
    let packs = packs.map(|packs| format!(" {}", origin(packs))).unwrap_or_default();
    format!(
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; \
         img-src 'self' data: blob:; connect-src 'self'{packs}; worker-src 'self'; \
         media-src 'self' blob:{packs}; form-action 'self'; frame-ancestors 'none'; \
         base-uri 'none'; object-src 'none'"
    )
}

/// Scheme, host and port of an address.
fn origin(address: &str) -> &str {
    let host = address.find("://").map_or(0, |at| at + 3);
    let end =
        address[host..].find(['/', '?', '#', ';', ',', ' ']).map_or(address.len(), |at| host + at);
    &address[..end]
}

/// Every address of the server.
pub fn router(app: App) -> Router {
    interface::router()
        .route("/", get(pages::index))
        .route("/s/{study}", get(pages::participant_without_slash))
        .route("/s/{study}/", get(pages::participant))
        .route("/assets/{hash}/{*name}", get(statics::asset))
        .merge(researchers(&app))
        .route("/healthz", get(|| async { "ok\n" }))
        .route("/readyz", get(pages::ready))
        .route("/metrics", get(metrics::metrics))
        .fallback(|| async { Error::NotFound })
        .method_not_allowed_fallback(|| async { Error::MethodNotAllowed })
        .layer(DefaultBodyLimit::max(LARGEST_BODY))
        .layer(middleware::from_fn(time_limit))
        .layer(CatchPanicLayer::custom(panicked))
        .layer(middleware::from_fn_with_state(app.clone(), limits::limit_rate))
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
        .route("/studio", get(pages::studio))
        .route("/researcher", get(researcher::home))
        .route(STUDY, get(researcher::study))
        .route(&format!("{STUDY}/live"), get(researcher::live))
        .route(PERSON, get(researcher::participant))
        .route(&format!("{PERSON}/exclude"), post(researcher::exclude))
        .route(&format!("{PERSON}/include"), post(researcher::include))
        .route(&format!("{PERSON}/erase"), post(researcher::erase))
        .route("/researcher/login", get(accounts::login_page).post(accounts::login))
        .route("/researcher/logout", post(accounts::logout))
        .route("/researcher/logout-everywhere", post(accounts::logout_everywhere))
        .route("/researcher/link/{secret}", get(accounts::link_page).post(accounts::use_link))
        .route("/researcher/account", get(accounts::account))
        .route("/researcher/account/password", post(accounts::password))
        .route("/researcher/tokens", post(accounts::new_token))
        .route("/researcher/tokens/{key}/revoke", post(accounts::revoke_token))
        .route("/researcher/people", get(accounts::people))
        .route("/researcher/people/invite", post(accounts::invite))
        .route("/researcher/people/{key}", post(accounts::person))
        .route("/researcher/log", get(accounts::log))
        .route(&format!("{STUDY}/stage"), post(uploads::stage))
        .route(&format!("{STUDY}/remove"), post(uploads::remove))
        .route("/researcher/upload/{study}", get(uploads::preparing))
        .route(UPLOAD, get(uploads::page).merge(upload))
        .route("/researcher/language/{code}", get(accounts::language))
        .layer(middleware::from_fn_with_state(app.clone(), for_people::refusals_as_pages))
}

/// A JSON body; what is wrong with it is a refusal like any other.
pub(crate) struct Body<T>(pub T);

impl<S: Send + Sync, T: serde::de::DeserializeOwned> FromRequest<S> for Body<T> {
    type Rejection = Error;

    async fn from_request(request: Request, state: &S) -> Result<Self, Error> {
        if !is_json(request.headers()) {
            return Err(Error::NotJson);
        }
        let bytes = Bytes::from_request(request, state).await?;
        match serde_json::from_slice(&bytes) {
            Ok(value) => Ok(Self(value)),
            // Read once more, with an eye on the place: that takes longer.
            Err(_) => Ok(Self(Json::<T>::from_bytes(&bytes)?.0)),
        }
    }
}

fn is_json(headers: &HeaderMap) -> bool {
    let kind = headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok());
    let kind = kind.and_then(|kind| kind.split(';').next()).unwrap_or_default().trim();
    kind.eq_ignore_ascii_case("application/json")
        || (kind.starts_with("application/") && kind.ends_with("+json"))
}

/// A query; what is wrong with it is a refusal like any other.
pub(crate) struct Asked<T>(pub T);

impl<S: Send + Sync, T: serde::de::DeserializeOwned> FromRequestParts<S> for Asked<T> {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Error> {
        let query = Query::<T>::try_from_uri(&parts.uri).map_err(|error| {
            Error::bad_request(format!("the query: {error}"), "see the interface's description")
        })?;
        Ok(Self(query.0))
    }
}

async fn time_limit(request: Request, next: Next) -> Response {
    let longest = if request.uri().path() == UPLOAD { LONGEST_UPLOAD } else { LONGEST_REQUEST };
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

/// What every answer says to browsers.
#[derive(Clone)]
struct Headers(Arc<[(HeaderName, HeaderValue)]>);

impl Headers {
    fn of(settings: &Settings, encrypted: bool) -> Self {
        let policy = content_security_policy(settings.packs_address.as_deref());
        let fixed = HeaderValue::from_static;
        let mut headers = vec![
            // An address with characters that no header takes is left out by falling back.
            (
                header::CONTENT_SECURITY_POLICY,
                HeaderValue::from_str(&policy).unwrap_or(fixed("default-src 'none'")),
            ),
            (header::X_CONTENT_TYPE_OPTIONS, fixed("nosniff")),
            (header::REFERRER_POLICY, fixed("no-referrer")),
            (header::X_FRAME_OPTIONS, fixed("DENY")),
            (HeaderName::from_static("cross-origin-opener-policy"), fixed("same-origin")),
            (
                HeaderName::from_static("permissions-policy"),
                fixed("camera=(), microphone=(), geolocation=(), payment=(), usb=()"),
            ),
        ];
        if encrypted {
            let year = fixed("max-age=31536000; includeSubDomains");
            headers.push((header::STRICT_TRANSPORT_SECURITY, year));
        }
        Self(headers.into())
    }
}

/// The headers of a server with default settings.
pub(crate) async fn security_headers(request: Request, next: Next) -> Response {
    settled_headers(State(Headers::of(&Settings::default(), false)), request, next).await
}

async fn settled_headers(
    State(Headers(fixed)): State<Headers>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    for (name, value) in fixed.iter() {
        // A page that needs another policy has said so.
        headers.entry(name.clone()).or_insert(value.clone());
    }
    // What is not said to be kept is not kept.
    headers.entry(header::CACHE_CONTROL).or_insert(HeaderValue::from_static("no-store"));
    response
}

/// A panic is our mistake: its text may hold an answer, so that only its happening is logged.
fn panicked(_: Box<dyn Any + Send>) -> Response {
    let mut response = Error::Internal("a request panicked".into()).into_response();
    *response.status_mut() = StatusCode::INTERNAL_SERVER_ERROR;
    response
}
