//! The words of the pages that no study file writes: buttons, messages. English and French are complete
//! here; a study file brings others (`translations`).

mod mimicry;
mod sentences;
mod sound;
mod table;
mod translation;
mod typography;

use std::collections::BTreeMap;

use std::borrow::Cow;

use mimique_locale::primary_language;

pub use mimicry::mimicry_words;
pub use sound::sound_words;
use table::{COUNT, ENGLISH, FRENCH, NAMES, Place};
pub use translation::{Fault, OptionalTexts, faults, names, template};
pub use typography::typeset;

/// Every fixed text of the pages in one language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Words {
    language: Cow<'static, str>,
    /// What a study file has brought, by name; the rest is built in.
    own: BTreeMap<String, String>,
    built_in: &'static [&'static str; COUNT],
}

/// Languages whose fixed texts are complete.
pub const LANGUAGES: [&str; 2] = ["en", "fr"];

/// The built-in texts of a language; English where there are none.
pub fn words(language: &str) -> &'static Words {
    static ENGLISH_WORDS: Words =
        Words { language: Cow::Borrowed("en"), own: BTreeMap::new(), built_in: &ENGLISH };
    static FRENCH_WORDS: Words =
        Words { language: Cow::Borrowed("fr"), own: BTreeMap::new(), built_in: &FRENCH };
    if primary_language(language) == "fr" { &FRENCH_WORDS } else { &ENGLISH_WORDS }
}

impl Words {
    /// The texts that a study file brings for a language, by name; what it leaves out is in English
    /// (or French, where it corrects those).
    pub fn translated(language: &str, own: &BTreeMap<String, String>) -> Words {
        let built_in = words(language).built_in;
        Words { language: Cow::Owned(language.to_owned()), own: own.clone(), built_in }
    }

    /// Its language code.
    pub fn language(&self) -> &str {
        &self.language
    }

    fn at(&self, place: Place) -> &str {
        let built_in = self.built_in[place as usize];
        if self.own.is_empty() {
            return built_in;
        }
        self.own.get(NAMES[place as usize]).map_or(built_in, String::as_str)
    }

    /// The text with its words in braces filled in.
    fn fill(&self, place: Place, values: &[(&str, &dyn Shown)]) -> String {
        let mut text = self.at(place).to_owned();
        for (name, value) in values {
            text = text.replace(&format!("{{{name}}}"), &value.shown());
        }
        text
    }
}

/// What can stand for a word in braces.
trait Shown {
    fn shown(&self) -> String;
}

impl Shown for f64 {
    fn shown(&self) -> String {
        self.to_string()
    }
}

macro_rules! shown_as_displayed {
    ($($kind:ty),*) => {$(
        impl Shown for $kind {
            fn shown(&self) -> String {
                self.to_string()
            }
        }
    )*};
}

shown_as_displayed!(u32, u64, usize, &str, String);
