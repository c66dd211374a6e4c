//! Who asks: a person by the cookie of a session, a script by a token, or somebody unknown.

use std::collections::BTreeMap;

use axum::extract::FromRequestParts;
use axum::http::request::Parts;
use axum::http::{HeaderMap, header};
use mimique_locale::Language;
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
    /// What they may do now in every study and on the server: a token may do less than its owner.
    pub role: Role,
    /// What they may do in single studies, where that is more.
    studies: BTreeMap<String, Role>,
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
            let (account, most) = found.ok_or(Error::LogInFirst)?;
            let mut studies = app.storage.study_roles_of(account.key).await?;
            studies.values_mut().for_each(|role| *role = most.min(*role));
            let role = most.min(account.role);
            return Ok(Self { account, role, studies, language, session: None });
        }
        let name = cookies::name(SESSION_COOKIE, app.is_encrypted());
        let secret = cookies::find(headers, &name).ok_or(Error::LogInFirst)?;
        let session = secret::hash(secret);
        let account = app.storage.logged_in(&session, now_ms(), LONGEST_IDLE_MS).await?;
        let account = account.ok_or(Error::LogInFirst)?;
        let studies = app.storage.study_roles_of(account.key).await?;
        Ok(Self { role: account.role, studies, account, language, session: Some(session) })
    }

    /// One who has just come in, for the log: the session is not known yet.
    pub fn entered(account: Account, language: Language) -> Self {
        let (role, studies, session) = (account.role, BTreeMap::new(), Some(String::new()));
        Self { role, studies, account, language, session }
    }

    /// Refuses those who may do less in every study and on the server.
    pub fn needs(&self, role: Role) -> Result<(), Error> {
        if self.role >= role { Ok(()) } else { Err(Error::NotAllowed) }
    }

    /// What they may do in a study.
    pub fn role_in(&self, study: &str) -> Role {
        self.studies.get(study).copied().map_or(self.role, |own| own.max(self.role))
    }

    /// Refuses those who may do less in a study. Whoever may do nothing in it is not told that it is there.
    pub fn needs_in(&self, study: &str, role: Role) -> Result<(), Error> {
        match self.role_in(study) {
            own if own >= role => Ok(()),
            Role::Nothing => Err(Error::NotFound),
            _ => Err(Error::NotAllowed),
        }
    }

    /// The most that they may do in any study.
    pub fn most(&self) -> Role {
        self.studies.values().copied().fold(self.role, Role::max)
    }

    /// Their roles in single studies.
    pub fn studies(&self) -> &BTreeMap<String, Role> {
        &self.studies
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

/// The token of `Authorization: Bearer TOKEN`; the name of the scheme is written in any case (RFC 9110).
pub(crate) fn bearer(headers: &HeaderMap) -> Option<&str> {
    let (scheme, token) = headers.get(header::AUTHORIZATION)?.to_str().ok()?.split_once(' ')?;
    scheme.eq_ignore_ascii_case("bearer").then(|| token.trim_start_matches(' '))
}
