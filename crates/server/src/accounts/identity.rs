//! Who asks: a person by the cookie of a session, a script by a token, or somebody unknown.

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};
use mimique_analysis::Language;
use mimique_storage::{Account, Role};

use crate::clock::now_ms;
use crate::error::Error;
use crate::http::cookies;
use crate::http::language::language_of;
use crate::secret;
use crate::state::App;

/// Name of a session's cookie.
pub(super) const SESSION_COOKIE: &str = "mimique_session";
/// A session without a request for so long is at its end.
const LONGEST_IDLE_MS: i64 = 12 * 3600 * 1000;
/// A session's end, whatever happens.
pub(super) const LONGEST_SESSION_S: i64 = 7 * 24 * 3600;

/// One who is known.
#[derive(Debug, Clone)]
pub(crate) struct Researcher {
    pub account: Account,
    /// What they may do now: a token may do less than its owner.
    pub role: Role,
    pub language: Language,
    /// Hash of the session's secret; none for a script.
    session: Option<String>,
}

impl Researcher {
    /// Who sends this request.
    pub async fn of(app: &App, headers: &HeaderMap) -> Result<Self, Error> {
        let language = language_of(headers);
        if let Some(token) = bearer(headers) {
            let found = app.storage.token_bearer(&secret::hash(token), now_ms()).await?;
            let (account, role) = found.ok_or(Error::LogInFirst)?;
            return Ok(Self { account, role, language, session: None });
        }
        let name = cookies::name(SESSION_COOKIE, app.is_encrypted());
        let secret = cookies::find(headers, &name).ok_or(Error::LogInFirst)?;
        let session = secret::hash(secret);
        let account = app.storage.logged_in(&session, now_ms(), LONGEST_IDLE_MS).await?;
        let account = account.ok_or(Error::LogInFirst)?;
        Ok(Self { role: account.role, account, language, session: Some(session) })
    }

    /// One who has just come in, for the log: the session is not known yet.
    pub fn entered(account: Account, language: Language) -> Self {
        Self { role: account.role, account, language, session: Some(String::new()) }
    }

    /// Refuses those who may do less.
    pub fn needs(&self, role: Role) -> Result<(), Error> {
        if self.role >= role { Ok(()) } else { Err(Error::NotAllowed) }
    }

    /// Hash of the session's secret; none for a script.
    pub fn session(&self) -> Option<&str> {
        self.session.as_deref()
    }
}

impl FromRequestParts<App> for Researcher {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Error> {
        Self::of(app, &parts.headers).await
    }
}

/// One who need not be known: language, and whether the connection is encrypted.
#[derive(Debug, Clone)]
pub(crate) struct Visitor {
    pub language: Language,
    pub secure: bool,
}

impl FromRequestParts<App> for Visitor {
    type Rejection = Error;

    async fn from_request_parts(parts: &mut Parts, app: &App) -> Result<Self, Error> {
        let headers = &parts.headers;
        Ok(Self { language: language_of(headers), secure: app.is_encrypted() })
    }
}

fn bearer(headers: &HeaderMap) -> Option<&str> {
    headers.get(header::AUTHORIZATION)?.to_str().ok()?.strip_prefix("Bearer ")
}
