//! Refusals as people see them: who is not logged in is asked to be, others read a page; scripts get
//! the JSON that every refusal is.

use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::{Method, header};
use axum::middleware::Next;
use axum::response::Response;

use crate::error::Error;
use crate::http::language::language_of;
use crate::http::responses::see;
use crate::researcher::pages::entry::refusal_page;
use crate::researcher::pages::frame::escaped;
use crate::state::App;

pub(super) async fn refusals_as_pages(
    State(app): State<App>,
    request: Request,
    next: Next,
) -> Response {
    let accepts = request.headers().get(header::ACCEPT).and_then(|value| value.to_str().ok());
    let is_person = accepts.is_some_and(|accepts| accepts.contains("text/html"));
    let language = language_of(request.headers());
    let is_reading = request.method() == Method::GET;
    let address = request.uri().path_and_query().map(ToString::to_string).unwrap_or_default();
    let response = next.run(request).await;
    let error = response.extensions().get::<Arc<Error>>().filter(|_| is_person).cloned();
    let Some(error) = error else { return response };
    if matches!(*error, Error::LogInFirst) {
        let next = if is_reading { address.as_str() } else { "/researcher" };
        return see(&format!("/researcher/login?next={}", escaped(next)));
    }
    let mut page = refusal_page(&app.assets.prefix(), language, &error);
    *page.status_mut() = error.status();
    page
}
