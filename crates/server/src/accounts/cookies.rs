//! Cookies: found among others, and written with what keeps them safe.

use axum::http::{HeaderMap, HeaderValue, header};

use crate::error::Error;

/// The value of a cookie.
pub(super) fn find<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    headers
        .get_all(header::COOKIE)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(';'))
        .find_map(|pair| pair.trim().strip_prefix(name)?.strip_prefix('='))
}

/// A name that browsers give back over encrypted connections only to the host that set it.
pub(super) fn name(base: &str, secure: bool) -> String {
    if secure { format!("__Host-{base}") } else { base.to_owned() }
}

/// A cookie that scripts cannot read and other sites cannot send with a form.
pub(super) fn set(
    name: &str,
    value: &str,
    seconds: i64,
    secure: bool,
) -> Result<HeaderValue, Error> {
    let secure = if secure { "; Secure" } else { "" };
    let text = format!("{name}={value}; Path=/; Max-Age={seconds}; HttpOnly; SameSite=Lax{secure}");
    HeaderValue::from_str(&text).map_err(|error| Error::Internal(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cookie_is_found_among_others() {
        let headers = HeaderMap::from_iter([(
            header::COOKIE,
            HeaderValue::from_static("a=b; mimique_session=00ff; mimique_session2=11"),
        )]);
        assert_eq!(find(&headers, "mimique_session"), Some("00ff"));
        assert_eq!(find(&HeaderMap::new(), "a"), None);
    }

    #[test]
    fn encrypted_connections_get_their_own_cookie() {
        let cookie = set(&name("mimique_session", true), "x", 60, true).unwrap();
        let expected =
            "__Host-mimique_session=x; Path=/; Max-Age=60; HttpOnly; SameSite=Lax; Secure";
        assert_eq!(cookie, expected);
        assert!(!set("a", "x", 60, false).unwrap().to_str().unwrap().contains("Secure"));
    }
}
