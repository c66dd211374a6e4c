//! Logging in and out. Wrong address and wrong password are one answer that takes one time; too many
//! attempts at one address, known or not, have to wait.

use axum::http::{HeaderMap, HeaderValue};
use mimique_storage::Account;

use super::email::normal_email;
use super::identity::{LONGEST_SESSION_S, SESSION_COOKIE};
use super::password;
use crate::clock::now_ms;
use crate::error::Error;
use crate::http::cookies;
use crate::secret;
use crate::state::App;

/// Attempts at one address within the window.
const MOST_ATTEMPTS: u64 = 8;
/// Fifteen minutes.
const WINDOW_MS: i64 = 15 * 60 * 1000;

/// One who has just logged in.
pub(crate) struct LoggedIn {
    pub account: Account,
    pub cookie: HeaderValue,
}

/// Checks address and password and begins a session.
pub(crate) async fn log_in(
    app: &App,
    headers: &HeaderMap,
    email: &str,
    given: &str,
) -> Result<LoggedIn, Error> {
    let email = normal_email(email).unwrap_or_else(|| email.trim().to_lowercase());
    throttle(app, &email).await?;
    let account = app.storage.account_by_email(&email).await?;
    let account = account.filter(|account| account.disabled_ms.is_none());
    let hash = account.as_ref().map(|account| account.password_hash.as_str());
    if !password::verify(given, hash).await? {
        return Err(Error::WrongPassword);
    }
    let account = account.ok_or(Error::WrongPassword)?;
    forgive(app, &email).await?;
    log_in_as(app, headers, account).await
}

/// Begins a session under a new secret, whatever cookie came: nobody can know it beforehand.
pub(crate) async fn log_in_as(
    app: &App,
    headers: &HeaderMap,
    account: Account,
) -> Result<LoggedIn, Error> {
    let secure = app.is_encrypted();
    let name = cookies::name(SESSION_COOKIE, secure);
    if let Some(before) = cookies::find(headers, &name) {
        app.storage.log_out(&secret::hash(before)).await?;
    }
    let fresh = secret::random::<16>().map_err(Error::internal)?;
    let now = now_ms();
    let expires = now + LONGEST_SESSION_S * 1000;
    app.storage.log_in(&secret::hash(&fresh), account.key, now, expires).await?;
    let cookie = cookies::set(&name, &fresh, LONGEST_SESSION_S, secure)?;
    Ok(LoggedIn { account, cookie })
}

/// Ends the session of this browser; gives the cookie that takes its own away.
pub(crate) async fn log_out(app: &App, headers: &HeaderMap) -> Result<HeaderValue, Error> {
    let secure = app.is_encrypted();
    let name = cookies::name(SESSION_COOKIE, secure);
    if let Some(known) = cookies::find(headers, &name) {
        app.storage.log_out(&secret::hash(known)).await?;
    }
    cookies::set(&name, "", 0, secure)
}

/// Counts an attempt before it is made, so that many at once are no way round.
pub(super) async fn throttle(app: &App, email: &str) -> Result<(), Error> {
    let subject = subject(app, email);
    let attempts = app.storage.count_attempt(&subject, now_ms(), WINDOW_MS).await?;
    if attempts > MOST_ATTEMPTS { Err(Error::TooManyAttempts) } else { Ok(()) }
}

/// Forgets the attempts of one who knew the password.
pub(super) async fn forgive(app: &App, email: &str) -> Result<(), Error> {
    Ok(app.storage.forget_attempts(&subject(app, email)).await?)
}

fn subject(app: &App, email: &str) -> String {
    hex::encode(&secret::derive(&app.token_key, &["attempts", email])[..16])
}
