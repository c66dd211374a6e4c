//! The languages that a browser asks for; language of the researchers' pages.

use axum::http::{HeaderMap, header};
use mimique_locale::Language;

use super::cookies;

/// The cookie of one who has chosen a language.
pub(crate) const LANGUAGE_COOKIE: &str = "mimique_language";

/// The language chosen, else the first that the browser asks for and the pages are written in.
pub(crate) fn language_of(headers: &HeaderMap) -> Language {
    if let Some(chosen) = cookies::find(headers, LANGUAGE_COOKIE).and_then(Language::from_code) {
        return chosen;
    }
    accepted(headers).filter_map(Language::from_code).next().unwrap_or_default()
}

/// The languages that a browser asks for, in its order.
pub(crate) fn accepted(headers: &HeaderMap) -> impl Iterator<Item = &str> {
    let wanted = headers.get(header::ACCEPT_LANGUAGE).and_then(|value| value.to_str().ok());
    let parts = wanted.unwrap_or_default().split(',');
    parts.filter_map(|part| part.split(';').next()).map(str::trim).filter(|code| !code.is_empty())
}
