//! That a form is the sender's own: a token bound to the session (or, before there is one, to a
//! cookie of its own), and a page of this server as its origin.

use std::collections::BTreeMap;

use axum::extract::{Form, FromRequest, FromRequestParts, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, HeaderValue, header};
use serde::de::DeserializeOwned;

use super::identity::{Researcher, Visitor};
use crate::error::Error;
use crate::http::cookies;
use crate::secret;
use crate::state::App;

/// Name of the field in every form.
const FIELD: &str = "csrf";
const FORM_COOKIE: &str = "mimique_form";
/// A page with a form may stay open so long before it is sent.
const FORM_LIFETIME_S: i64 = 24 * 3600;

/// The token that a page writes into its forms.
#[derive(Debug, Clone)]
pub(crate) struct FormToken {
    pub value: String,
    /// The cookie to set with the page, where a new one had to be made.
    pub cookie: Option<HeaderValue>,
}

impl FormToken {
    /// The token of a session's forms; a script needs none.
    pub fn of(app: &App, who: &Researcher) -> Self {
        let value = who.session().map(|session| session_token(app, session)).unwrap_or_default();
        Self { value, cookie: None }
    }

    /// The token of forms before there is a session.
    pub fn of_nobody(app: &App, headers: &HeaderMap) -> Result<Self, Error> {
        let secure = app.is_encrypted();
        let name = cookies::name(FORM_COOKIE, secure);
        if let Some(known) = cookies::find(headers, &name) {
            return Ok(Self { value: form_token(app, known), cookie: None });
        }
        let fresh = secret::random::<16>().map_err(Error::internal)?;
        let cookie = cookies::set(&name, &fresh, FORM_LIFETIME_S, secure)?;
        Ok(Self { value: form_token(app, &fresh), cookie: Some(cookie) })
    }

    /// Whether this is what was sent.
    pub fn is(&self, sent: &str) -> bool {
        !self.value.is_empty() && secret::same(&self.value, sent)
    }
}

/// Before there is a session.
impl FromRequestParts<App> for FormToken {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Error> {
        Self::of_nobody(app, &parts.headers)
    }
}

/// A form of one who is logged in, or of a script with its token.
pub(crate) struct Guarded<T> {
    pub who: Researcher,
    pub form: T,
}

impl<T: DeserializeOwned> FromRequest<App> for Guarded<T> {
    type Rejection = Error;

    async fn from_request(request: Request, app: &App) -> Result<Self, Error> {
        let who = Researcher::of(app, request.headers()).await?;
        // Browsers send no token of a script by themselves.
        let token = who.session().is_some().then(|| FormToken::of(app, &who));
        if token.is_some() {
            check_origin(app, request.headers())?;
        }
        let mut fields = fields(request, app).await?;
        let sent = fields.remove(FIELD).unwrap_or_default();
        if token.is_some_and(|token| !token.is(&sent)) {
            return Err(Error::ForeignForm);
        }
        Ok(Self { who, form: read(fields)? })
    }
}

/// A form of somebody unknown.
pub(crate) struct Anonymous<T> {
    pub visitor: Visitor,
    pub headers: HeaderMap,
    pub form: T,
}

impl<T: DeserializeOwned> FromRequest<App> for Anonymous<T> {
    type Rejection = Error;

    async fn from_request(request: Request, app: &App) -> Result<Self, Error> {
        let (mut parts, body) = request.into_parts();
        check_origin(app, &parts.headers)?;
        let visitor = Visitor::from_request_parts(&mut parts, app).await?;
        let name = cookies::name(FORM_COOKIE, visitor.secure);
        let headers = parts.headers.clone();
        let cookie = cookies::find(&headers, &name).ok_or(Error::ForeignForm)?;
        let token = form_token(app, cookie);
        let mut fields = fields(Request::from_parts(parts, body), app).await?;
        let sent = fields.remove(FIELD).unwrap_or_default();
        if !secret::same(&token, &sent) {
            return Err(Error::ForeignForm);
        }
        let form = read(fields)?;
        Ok(Self { visitor, headers, form })
    }
}

/// Refuses what a page of another site sends. Browsers say where a form comes from.
pub(crate) fn check_origin(app: &App, headers: &HeaderMap) -> Result<(), Error> {
    let text = |name: header::HeaderName| headers.get(name).and_then(|value| value.to_str().ok());
    let Some(origin) = text(header::ORIGIN) else {
        let site = headers.get("sec-fetch-site");
        let own = site.is_some_and(|site| site == "same-origin");
        return if own { Ok(()) } else { Err(Error::ForeignForm) };
    };
    let public = app.access.public_url.as_deref();
    let is_public = public.is_some_and(|url| origin == url.trim_end_matches('/'));
    let host = origin.split_once("://").map(|(_, host)| host);
    let is_host = host.is_some() && host == text(header::HOST);
    if is_public || is_host { Ok(()) } else { Err(Error::ForeignForm) }
}

async fn fields(request: Request, app: &App) -> Result<BTreeMap<String, String>, Error> {
    let form = Form::<BTreeMap<String, String>>::from_request(request, app).await;
    let not_a_form = |_| Error::NotAForm;
    let fields = form.map_err(not_a_form)?.0;
    if fields.iter().any(|(name, text)| name.contains('\0') || text.contains('\0')) {
        return Err(Error::NulInText);
    }
    Ok(fields)
}

fn read<T: DeserializeOwned>(fields: BTreeMap<String, String>) -> Result<T, Error> {
    let object = fields.into_iter().map(|(name, text)| (name, text.into())).collect();
    serde_json::from_value(serde_json::Value::Object(object))
        .map_err(|error| Error::IncompleteForm { problem: error.to_string() })
}

fn session_token(app: &App, session: &str) -> String {
    hex::encode(&secret::derive(&app.token_key, &["form of a session", session])[..16])
}

fn form_token(app: &App, cookie: &str) -> String {
    hex::encode(&secret::derive(&app.token_key, &["form of nobody", cookie])[..16])
}
