//! Cookies: found among others, and written with what keeps them safe. The crate `cookie` would do the same
//! with `time` and its five crates behind it, for two functions.

use axum::http::{HeaderMap, HeaderValue, header};

use crate::error::Error;

/// The value of a cookie.
pub(crate) fn find<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    headers
        .get_all(header::COOKIE)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(';'))
        .find_map(|pair| pair.trim().strip_prefix(name)?.strip_prefix('='))
}

/// A name that browsers give back over encrypted connections only to the host that set it.
pub(crate) fn name(base: &str, secure: bool) -> String {
    if secure { format!("__Host-{base}") } else { base.to_owned() }
}

/// A cookie that scripts cannot read and other sites cannot send with a form.
pub(crate) fn set(
    name: &str,
    value: &str,
    seconds: i64,
    secure: bool,
) -> Result<HeaderValue, Error> {
    written(&format!("{name}={value}; Path=/; Max-Age={seconds}; HttpOnly; SameSite=Lax"), secure)
}

/// From which pages a browser sends a cookie back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pages {
    /// Pages of this site.
    OwnSite,
    /// Also from a frame in a page of another site, to which the cookie then belongs (CHIPS). Browsers take such
    /// cookies over encrypted connections only; over others it is [`Self::OwnSite`].
    Frames,
}

/// A cookie that goes back to addresses below `path` alone, from these pages, for a year.
pub(crate) fn set_below(
    path: &str,
    name: &str,
    value: &str,
    secure: bool,
    pages: Pages,
) -> Result<HeaderValue, Error> {
    const YEAR: u32 = 365 * 24 * 3600;
    let cookie = format!("{name}={value}; Path={path}; Max-Age={YEAR}; HttpOnly");
    match pages {
        Pages::Frames if secure => {
            let cookie = format!("{cookie}; SameSite=None; Secure; Partitioned");
            HeaderValue::from_str(&cookie).map_err(Error::internal)
        }
        _ => written(&format!("{cookie}; SameSite=Strict"), secure),
    }
}

fn written(cookie: &str, secure: bool) -> Result<HeaderValue, Error> {
    let secure = if secure { "; Secure" } else { "" };
    HeaderValue::from_str(&format!("{cookie}{secure}")).map_err(Error::internal)
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
        let below = set_below("/api/studies/faces/", "mimique-faces", "x", true, Pages::OwnSite);
        let below = below.unwrap();
        let expected = "mimique-faces=x; Path=/api/studies/faces/; Max-Age=31536000; HttpOnly; SameSite=Strict; Secure";
        assert_eq!(below, expected);
        let framed = |secure| {
            set_below("/", "mimique-faces", "x", secure, Pages::Frames)
                .map(|cookie| cookie.to_str().unwrap().to_owned())
                .unwrap()
        };
        assert!(framed(true).ends_with("; HttpOnly; SameSite=None; Secure; Partitioned"));
        // Browsers refuse `SameSite=None` without `Secure`.
        assert!(framed(false).ends_with("; HttpOnly; SameSite=Strict"));
    }
}
