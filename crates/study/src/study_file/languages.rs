//! The languages of a study, and the texts of its pages in them.

use std::collections::BTreeMap;

use mimique_locale::primary_language;

use super::Study;
use crate::text::{Words, words};

/// Buttons and messages of the study's own, by language and by name.
pub type Translations = BTreeMap<String, BTreeMap<String, String>>;

/// What is said in several languages: a study and its projection.
pub trait Multilingual {
    /// The languages, the first being the default.
    fn languages(&self) -> &[String];

    /// Buttons and messages of the study's own.
    fn translations(&self) -> &Translations;

    /// The default language: the first one, `en` if none is given.
    fn default_language(&self) -> &str {
        self.languages().first().map_or("en", String::as_str)
    }

    /// The fixed texts in a language: the study's own, those that are built in, or in English.
    fn words(&self, language: &str) -> Words {
        match self.translations().get(language) {
            Some(own) => Words::translated(language, own),
            None => words(language).clone(),
        }
    }

    /// The language that a participant gets who asks for `wanted` (`fr-CA` gets `fr`).
    fn language_for(&self, wanted: &str) -> &str {
        let short = primary_language(wanted);
        let languages = self.languages();
        languages
            .iter()
            .find(|known| known.eq_ignore_ascii_case(wanted))
            .or_else(|| languages.iter().find(|known| known.eq_ignore_ascii_case(short)))
            .map_or_else(|| self.default_language(), String::as_str)
    }

    /// The language of the pages: the first of those asked for that the study has, else its default.
    fn language_among<'a>(&self, mut wanted: impl Iterator<Item = &'a str>) -> &str {
        let is_spoken =
            |each: &&str| primary_language(self.language_for(each)) == primary_language(each);
        wanted
            .find(is_spoken)
            .map_or_else(|| self.default_language(), |each| self.language_for(each))
    }
}

impl Multilingual for Study {
    fn languages(&self) -> &[String] {
        &self.languages
    }

    fn translations(&self) -> &Translations {
        &self.translations
    }
}
