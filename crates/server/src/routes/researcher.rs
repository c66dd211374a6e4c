//! `/researcher`: who takes part, what was answered, what can be exported.

use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{Html, IntoResponse, Response};
use serde::Deserialize;

use crate::app::App;
use crate::error::Error;
use crate::export::{Format, export as make_export};
use crate::researcher::{self, Overview};
use crate::static_file::content_type;

/// The page's own query.
#[derive(Deserialize)]
pub(super) struct Key {
    key: Option<String>,
}

/// The export's own query.
#[derive(Deserialize)]
pub(super) struct ExportQuery {
    #[serde(default)]
    with_identifiers: bool,
}

pub(super) async fn page(
    State(app): State<App>,
    Query(query): Query<Key>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    if let Some(key) = query.key {
        return Ok(match researcher::admit(&app, &key).await {
            Ok(cookie) => {
                let to = HeaderValue::from_static("/researcher");
                let headers = [(header::SET_COOKIE, cookie), (header::LOCATION, to)];
                (StatusCode::SEE_OTHER, headers).into_response()
            }
            Err(Error::AccessDenied) => denied(&app),
            Err(error) => return Err(error),
        });
    }
    match researcher::require(&app, &headers).await {
        Ok(()) => {}
        Err(Error::AccessDenied) => return Ok(denied(&app)),
        Err(error) => return Err(error),
    }
    let mut studies = Vec::new();
    for study in app.catalogue.studies() {
        let overview = Overview::load(&app.storage, &study, &app.session_views).await?;
        studies.push((study, overview));
    }
    Ok(Html(researcher::dashboard(&app.assets.prefix(), &studies)).into_response())
}

pub(super) async fn export(
    State(app): State<App>,
    Path((study, format)): Path<(String, String)>,
    Query(query): Query<ExportQuery>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    researcher::require(&app, &headers).await?;
    let format = Format::from_word(&format).ok_or(Error::NotFound)?;
    let exported = make_export(&app.storage, Some(&study), format, query.with_identifiers).await?;
    let (name, bytes) = if format == Format::PsychDs {
        (format!("{study}_psych-ds.zip"), exported.into_zip()?)
    } else {
        exported.files.into_iter().next().ok_or(Error::NotFound)?
    };
    let disposition = format!("attachment; filename=\"{name}\"");
    let disposition =
        HeaderValue::from_str(&disposition).map_err(|error| Error::Internal(error.to_string()))?;
    let kind = HeaderValue::from_static(content_type(&name));
    let headers = [(header::CONTENT_TYPE, kind), (header::CONTENT_DISPOSITION, disposition)];
    Ok((headers, bytes).into_response())
}

fn denied(app: &App) -> Response {
    (StatusCode::FORBIDDEN, Html(researcher::denied(&app.assets.prefix()))).into_response()
}
