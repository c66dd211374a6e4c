//! Text in one language or in several.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A string for every language, or one string a language.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum LocalText {
    /// The same in every language (a name, a number, a study in one language).
    Plain(String),
    /// By language code: `{"en": "joy", "fr": "joie"}`.
    Languages(BTreeMap<String, String>),
}

impl LocalText {
    /// The text in `language`; where that is missing, in English, else in any language there is.
    pub fn in_language(&self, language: &str) -> &str {
        match self {
            Self::Plain(text) => text,
            Self::Languages(texts) => texts
                .get(language)
                .or_else(|| texts.get("en"))
                .or_else(|| texts.values().next())
                .map_or("", String::as_str),
        }
    }

    /// The text in `language` and no other.
    pub fn exactly(&self, language: &str) -> Option<&str> {
        match self {
            Self::Plain(text) => Some(text),
            Self::Languages(texts) => texts.get(language).map(String::as_str),
        }
    }
}

impl Default for LocalText {
    fn default() -> Self {
        Self::Plain(String::new())
    }
}

impl From<&str> for LocalText {
    fn from(text: &str) -> Self {
        Self::Plain(text.to_owned())
    }
}
