//! `/researcher`: who takes part, what was answered, what can be exported.

use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{Html, IntoResponse, Response};
use serde::Deserialize;

use crate::app::App;
use crate::error::Error;
use crate::researcher;

#[derive(Deserialize)]
pub(super) struct Key {
    key: Option<String>,
}

pub(super) async fn page(
    State(app): State<App>,
    Query(query): Query<Key>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    if let Some(key) = query.key {
        let cookie = researcher::admit(&app, &key).await?;
        let headers = [
            (header::SET_COOKIE, cookie),
            (header::LOCATION, "/researcher".parse().expect("ASCII")),
        ];
        return Ok((StatusCode::SEE_OTHER, headers).into_response());
    }
    researcher::require(&app, &headers).await?;
    Ok(Html(String::new()).into_response())
}

pub(super) async fn export(
    State(app): State<App>,
    Path((study, _format)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    researcher::require(&app, &headers).await?;
    app.study(&study)?;
    Err(Error::NotFound)
}
