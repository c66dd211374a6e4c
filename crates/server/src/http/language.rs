//! Language of the researchers' pages.

use axum::http::{HeaderMap, header};
use mimique_analysis::Language;

use super::cookies;

/// The cookie of one who has chosen a language.
pub(crate) const LANGUAGE_COOKIE: &str = "mimique_language";

/// The language chosen, else the first that the browser asks for and the pages are written in.
pub(crate) fn language_of(headers: &HeaderMap) -> Language {
    if let Some(chosen) = cookies::find(headers, LANGUAGE_COOKIE).and_then(Language::from_code) {
        return chosen;
    }
    let wanted = headers.get(header::ACCEPT_LANGUAGE).and_then(|value| value.to_str().ok());
    let codes = wanted.unwrap_or_default().split(',').filter_map(|part| part.split(';').next());
    codes.filter_map(|code| Language::from_code(code.trim())).next().unwrap_or_default()
}
