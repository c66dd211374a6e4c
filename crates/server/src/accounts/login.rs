//! Logging in and out. Wrong address and wrong password are one answer that takes one time; too many
//! attempts at one account, known or not, have to wait, and so do too many from one address.
//!
//! Whoever tries passwords must not lock the account's person out: a browser that has logged in before
//! holds a mark for that account, and its attempts are counted by the mark, apart from everybody else's.

use std::time::{Duration, Instant};

use axum::http::{HeaderMap, HeaderValue};
use mimique_storage::Account;

use super::email::normal_email;
use super::identity::{LONGEST_SESSION_S, SESSION_COOKIE};
use super::password;
use crate::clock::now_ms;
use crate::error::Error;
use crate::http::cookies;
use crate::http::rate_limit::caller_of;
use crate::secret;
use crate::state::App;
use crate::state::rate_limit::Peer;

/// Attempts at one account within the window, of all browsers without a mark; as many of each with one.
const MOST_ATTEMPTS: u64 = 8;
/// An attempt from one address in so long a time, in the long run, at whatever accounts; how many there
/// may be at once is a setting.
const ONE_ATTEMPT_IN: Duration = Duration::from_secs(20);
/// The cookie of a browser that has logged in before.
const MARK_COOKIE: &str = "mimique_known";
/// A year.
const MARK_LIFETIME_S: i64 = 365 * 24 * 3600;
/// Fifteen minutes.
const WINDOW_MS: i64 = 15 * 60 * 1000;

/// One who has just logged in.
pub(crate) struct LoggedIn {
    pub account: Account,
    /// The session's, and the mark by which this browser is known.
    pub cookies: [HeaderValue; 2],
}

/// Checks address and password and begins a session.
pub(crate) async fn log_in(
    app: &App,
    headers: &HeaderMap,
    peer: Option<Peer>,
    email: &str,
    given: &str,
) -> Result<LoggedIn, Error> {
    let email = normal_email(email).unwrap_or_else(|| email.trim().to_lowercase());
    if let Some(address) = caller_of(app, headers, peer)
        && !app.login_limits.allow_every(
            address,
            ONE_ATTEMPT_IN,
            app.settings.logins_per_address,
            Instant::now(),
        )
    {
        return Err(Error::TooManyAttempts);
    }
    let subject = subject(app, &email, mark(app, headers, &email));
    throttle(app, &subject).await?;
    let account = app.storage.account_by_email(&email).await?;
    let account = account.filter(|account| account.disabled_ms.is_none());
    let hash = account.as_ref().map(|account| account.password_hash.as_str());
    if !password::verify(given, hash).await? {
        return Err(Error::WrongPassword);
    }
    let account = account.ok_or(Error::WrongPassword)?;
    app.storage.forget_attempts(&subject).await?;
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
    let session = cookies::set(&name, &fresh, LONGEST_SESSION_S, secure)?;
    let known = new_mark(app, &account.email)?;
    let name = cookies::name(MARK_COOKIE, secure);
    let known = cookies::set(&name, &known, MARK_LIFETIME_S, secure)?;
    Ok(LoggedIn { account, cookies: [session, known] })
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
async fn throttle(app: &App, subject: &str) -> Result<(), Error> {
    let attempts = app.storage.count_attempt(subject, now_ms(), WINDOW_MS, MOST_ATTEMPTS).await?;
    if attempts > MOST_ATTEMPTS { Err(Error::TooManyAttempts) } else { Ok(()) }
}

/// Counts an attempt of one who is logged in and types the password once more.
pub(super) async fn throttle_session(app: &App, session: &str) -> Result<(), Error> {
    throttle(app, &keyed(app, &["attempts of a session", session])).await
}

/// What attempts are counted by: the account, or the browser that is known at it.
fn subject(app: &App, email: &str, mark: Option<&str>) -> String {
    match mark {
        Some(mark) => keyed(app, &["attempts of a browser", email, mark]),
        None => keyed(app, &["attempts", email]),
    }
}

fn keyed(app: &App, parts: &[&str]) -> String {
    hex::encode(&secret::derive(&app.token_key, parts)[..16])
}

/// A mark for this account: random, and signed for it.
fn new_mark(app: &App, email: &str) -> Result<String, Error> {
    let random = secret::random::<16>().map_err(Error::internal)?;
    let signature = keyed(app, &["known browser", email, &random]);
    Ok(format!("{random}{signature}"))
}

/// The mark that this browser holds, if it is one for this account.
fn mark<'h>(app: &App, headers: &'h HeaderMap, email: &str) -> Option<&'h str> {
    let held = cookies::find(headers, &cookies::name(MARK_COOKIE, app.is_encrypted()))?;
    let (random, signature) = held.split_at_checked(32)?;
    secret::same(signature, &keyed(app, &["known browser", email, random])).then_some(random)
}
