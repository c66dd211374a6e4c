//! Who may see the researcher's pages: those who opened the printed address, by a cookie.

use axum::http::{HeaderMap, HeaderValue, header};

use crate::app::App;
use crate::clock::now_ms;
use crate::error::Error;
use crate::secret;
use crate::storage::Access;

const COOKIE: &str = "mimique_researcher";
/// A browser that opened the address stays a researcher's for this long.
const COOKIE_LIFETIME_S: i64 = 30 * 24 * 3600;

/// Refuses whoever has no valid cookie.
pub(crate) async fn require(app: &App, headers: &HeaderMap) -> Result<(), Error> {
    let Some(secret) = cookie(headers) else { return Err(Error::AccessDenied) };
    if app.storage.has_access(Access::Browser, &secret::hash(secret), now_ms()).await? {
        Ok(())
    } else {
        Err(Error::AccessDenied)
    }
}

/// Exchanges the key of the printed address for a cookie.
pub(crate) async fn admit(app: &App, key: &str) -> Result<HeaderValue, Error> {
    let now = now_ms();
    if !app.storage.has_access(Access::Link, &secret::hash(key), now).await? {
        return Err(Error::AccessDenied);
    }
    let no_randomness = |error: getrandom::Error| Error::Internal(error.to_string());
    let secret = secret::random::<16>().map_err(no_randomness)?;
    let expires = now + COOKIE_LIFETIME_S * 1000;
    app.storage.grant_access(Access::Browser, &secret::hash(&secret), now, expires).await?;
    let cookie = format!(
        "{COOKIE}={secret}; Path=/researcher; Max-Age={COOKIE_LIFETIME_S}; HttpOnly; SameSite=Strict"
    );
    HeaderValue::from_str(&cookie).map_err(|error| Error::Internal(error.to_string()))
}

fn cookie(headers: &HeaderMap) -> Option<&str> {
    headers
        .get_all(header::COOKIE)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(';'))
        .find_map(|pair| pair.trim().strip_prefix(COOKIE)?.strip_prefix('='))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cookie_is_found_among_others() {
        let headers = HeaderMap::from_iter([(
            header::COOKIE,
            HeaderValue::from_static("a=b; mimique_researcher=00ff; mimique_researcher2=11"),
        )]);
        assert_eq!(cookie(&headers), Some("00ff"));
        assert_eq!(cookie(&HeaderMap::new()), None);
    }
}
