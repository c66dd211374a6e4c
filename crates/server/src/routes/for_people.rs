//! Refusals as people see them: who is not logged in is asked to be, others read a page; scripts get
//! the JSON that every refusal is.

use axum::body::to_bytes;
use axum::extract::{Request, State};
use axum::http::{Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::Response;
use mimique_study::wire::Refusal;

use super::accounts::see;
use crate::accounts::Tongue;
use crate::app::App;
use crate::researcher;

/// A refusal's text is short.
const LONGEST_REFUSAL: usize = 64 * 1024;

pub(super) async fn refusals_as_pages(
    State(app): State<App>,
    request: Request,
    next: Next,
) -> Response {
    let accepts = request.headers().get(header::ACCEPT).and_then(|value| value.to_str().ok());
    let is_person = accepts.is_some_and(|accepts| accepts.contains("text/html"));
    let tongue = Tongue::of(request.headers());
    let is_reading = request.method() == Method::GET;
    let address = request.uri().path_and_query().map(ToString::to_string).unwrap_or_default();
    let response = next.run(request).await;
    let status = response.status();
    let kind = response.headers().get(header::CONTENT_TYPE);
    let is_refusal = kind.is_some_and(|kind| kind == "application/json");
    if !is_person || !is_refusal || !(status.is_client_error() || status.is_server_error()) {
        return response;
    }
    if status == StatusCode::UNAUTHORIZED {
        let next = if is_reading { address.as_str() } else { "/researcher" };
        return see(&format!("/researcher/login?next={}", researcher::escaped(next)));
    }
    let (parts, body) = response.into_parts();
    let bytes = to_bytes(body, LONGEST_REFUSAL).await.unwrap_or_default();
    let Ok(refusal) = serde_json::from_slice::<Refusal>(&bytes) else {
        return Response::from_parts(parts, bytes.into());
    };
    let mut page = researcher::refusal_page(&app.assets.prefix(), tongue, &refusal);
    *page.status_mut() = status;
    page
}
