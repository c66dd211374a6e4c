//! Language of the researcher's pages.

use axum::http::{HeaderMap, header};

use super::cookies;

/// The cookie of one who has chosen a language.
pub(crate) const LANGUAGE_COOKIE: &str = "mimique_language";

/// Language of the researcher's pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Tongue {
    /// English.
    #[default]
    English,
    /// French.
    French,
}

impl Tongue {
    /// The one chosen, else the one that the browser asks for.
    pub fn of(headers: &HeaderMap) -> Self {
        if let Some(chosen) = cookies::find(headers, LANGUAGE_COOKIE).and_then(Self::from_code) {
            return chosen;
        }
        let wanted = headers.get(header::ACCEPT_LANGUAGE).and_then(|value| value.to_str().ok());
        let codes = wanted.unwrap_or_default().split(',').filter_map(|part| part.trim().get(..2));
        codes.filter_map(Self::from_code).next().unwrap_or_default()
    }

    pub fn from_code(code: &str) -> Option<Self> {
        match code {
            "en" => Some(Self::English),
            "fr" => Some(Self::French),
            _ => None,
        }
    }

    pub fn code(self) -> &'static str {
        self.pick("en", "fr")
    }

    /// The text in this language.
    pub fn pick<T>(self, english: T, french: T) -> T {
        match self {
            Self::English => english,
            Self::French => french,
        }
    }
}
