//! Answers of more than one group of addresses.

use axum::body::Body;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::error::Error;
use crate::files::static_file::content_type;
use crate::state::App;

/// Leads the browser to another page after a form.
pub(crate) fn see(address: &str) -> Response {
    (StatusCode::SEE_OTHER, [(header::LOCATION, address)]).into_response()
}

/// The address as people open it.
pub(crate) fn whole_address(app: &App, headers: &HeaderMap, path: &str) -> String {
    if let Some(url) = &app.access.public_url {
        return format!("{}{path}", url.trim_end_matches('/'));
    }
    let host = headers.get(header::HOST).and_then(|host| host.to_str().ok()).unwrap_or_default();
    let scheme = if app.is_encrypted() { "https" } else { "http" };
    format!("{scheme}://{host}{path}")
}

/// The same answer with cookies.
pub(crate) fn with_cookies(
    mut response: Response,
    cookies: impl IntoIterator<Item = HeaderValue>,
) -> Response {
    for cookie in cookies {
        response.headers_mut().append(header::SET_COOKIE, cookie);
    }
    response
}

/// A file to be saved under its name.
pub(crate) fn attachment(name: &str, content: impl Into<Body>) -> Result<Response, Error> {
    let disposition = format!("attachment; filename=\"{name}\"");
    let disposition = HeaderValue::from_str(&disposition).map_err(Error::internal)?;
    let kind = HeaderValue::from_static(content_type(name));
    let headers = [(header::CONTENT_TYPE, kind), (header::CONTENT_DISPOSITION, disposition)];
    Ok((headers, content.into()).into_response())
}
