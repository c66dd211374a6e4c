//! Addresses that an operator gives: parsed as browsers parse them, and refused where no browser would open them.

use url::{Host, Url};

/// The origin of a page, `https://HOST` or `https://HOST:PORT`, as browsers write it; nothing may follow it.
///
/// # Errors
/// What the text is instead, with what to write.
pub fn origin(text: &str) -> Result<String, String> {
    let remedy = "write https://HOST, or https://HOST:PORT, and nothing behind it";
    let url = web_url(text).map_err(|problem| format!("{problem}; {remedy}"))?;
    let has_end =
        text.split_once("://").is_none_or(|(_, rest)| rest.contains(['/', '?', '#', '\\']));
    if has_end {
        return Err(format!("something follows the host; {remedy}"));
    }
    Ok(url.origin().ascii_serialization())
}

/// The address of a server, `https://HOST` or `https://HOST:PORT`, without the slash at its end.
///
/// # Errors
/// What the text is instead, with what to write.
pub fn server_address(text: &str) -> Result<String, String> {
    origin(text.strip_suffix('/').unwrap_or(text))
}

/// The address of a folder on a server, without the slash at its end.
///
/// # Errors
/// What the text is instead, with what to write.
pub fn folder_address(text: &str) -> Result<String, String> {
    let remedy = "write https://HOST/FOLDER";
    let url = web_url(text).map_err(|problem| format!("{problem}; {remedy}"))?;
    if url.query().is_some() || url.fragment().is_some() {
        return Err(format!("an address of a folder has no query and no fragment; {remedy}"));
    }
    // The policy of pages, in which the address is written, ends at these.
    if url.path().contains([';', ',', '\'']) {
        return Err(format!("the folder's name has one of ; , ' in it; {remedy}"));
    }
    Ok(url.as_str().trim_end_matches('/').to_owned())
}

/// An address of http or https with a host that names can have.
fn web_url(text: &str) -> Result<Url, String> {
    // Parsers take such characters away without a word.
    if text.chars().any(|c| c.is_whitespace() || c.is_control()) {
        return Err("an address has no spaces and no line breaks".to_owned());
    }
    if !text.contains("://") {
        return Err("an address begins with https:// or http://".to_owned());
    }
    let url = Url::parse(text).map_err(|error| format!("no address ({error})"))?;
    if !matches!(url.scheme(), "https" | "http") {
        return Err("an address begins with https:// or http://".to_owned());
    }
    if !url.username().is_empty() || url.password().is_some() {
        return Err("an address has no user name and no password".to_owned());
    }
    match url.host() {
        Some(Host::Domain(name)) if !is_host_name(name) => {
            Err(format!("{name:?} is no name of a host"))
        }
        Some(_) => Ok(url),
        None => Err("an address names a host".to_owned()),
    }
}

/// Whether a name is one that hosts have (RFC 1123): labels of letters, digits and hyphens between dots.
fn is_host_name(name: &str) -> bool {
    let is_label = |label: &str| {
        let is_plain = label.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-');
        let is_edged = label.starts_with('-') || label.ends_with('-');
        !label.is_empty() && label.len() <= 63 && is_plain && !is_edged
    };
    name.len() <= 253 && name.split('.').all(is_label)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origins_are_written_as_browsers_write_them() {
        for (given, written) in [
            ("https://survey.example", "https://survey.example"),
            ("https://Survey.Example:443", "https://survey.example"),
            ("http://localhost:8080", "http://localhost:8080"),
            ("http://127.0.0.1:65535", "http://127.0.0.1:65535"),
            ("https://[::1]:8443", "https://[::1]:8443"),
            ("https://umfrage-bücher.example", "https://xn--umfrage-bcher-4ob.example"),
        ] {
            assert_eq!(origin(given).as_deref(), Ok(written), "{given}");
            assert_eq!(server_address(&format!("{given}/")).as_deref(), Ok(written), "{given}");
        }
    }

    #[test]
    fn what_is_no_address_is_refused() {
        for wrong in [
            "",
            "survey.example",
            "https://",
            "https:survey.example",
            "ftp://survey.example",
            "https://a.example:99999",
            "https://a..example",
            "https://.example",
            "https://a.example.",
            "https://-a.example",
            "https://*.example",
            "https://[::1",
            "https://a.example:x",
            "https://\"><script>",
            "https://a.example\"",
            "https://a example",
            "https://a.example\n",
            "https://a.example;script-src",
            "https://user:word@a.example",
            "https://a_b.example",
        ] {
            for read in [origin, server_address, folder_address] {
                let problem = read(wrong).expect_err(wrong);
                assert!(problem.contains("; write https://"), "{wrong}: {problem}");
            }
        }
        for wrong in ["https://a.example/study", "https://a.example?", "https://a.example#top"] {
            assert!(origin(wrong).is_err() && server_address(wrong).is_err(), "{wrong}");
        }
        assert!(origin("https://a.example/").is_err());
        for wrong in ["https://a.example/a?b", "https://a.example/#b", "https://a.example/a;b"] {
            assert!(folder_address(wrong).is_err(), "{wrong}");
        }
        let folder = folder_address("https://cdn.example/packs/");
        assert_eq!(folder.as_deref(), Ok("https://cdn.example/packs"));
        assert_eq!(folder_address("http://cdn.example/").as_deref(), Ok("http://cdn.example"));
    }
}
