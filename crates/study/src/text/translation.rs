//! Translations of the fixed texts: what a study file brings for a language.

use std::collections::BTreeMap;

use super::mimicry::MIMICRY;
use super::sound::SOUND;
use super::table::{ENGLISH, NAMES};
use super::{primary_language, words};

/// What is wrong with a translation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Fault {
    /// No text has this name.
    Unknown {
        /// The name.
        name: String,
    },
    /// The words in braces are not those of the English text.
    Placeholders {
        /// The text's name.
        name: String,
        /// The English text.
        english: &'static str,
    },
    /// These texts are not there; they will be in English.
    Missing(Vec<&'static str>),
}

/// Which texts a study needs beside those that every study has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct OptionalTexts {
    /// Those on sound.
    pub sound: bool,
    /// Those on the measuring of the participant's face.
    pub mimicry: bool,
}

/// Everything that is wrong with a translation, texts by name. English and French may be changed in
/// part: nothing is missing there; nor are texts that the study does not need.
pub fn faults(
    language: &str,
    texts: &BTreeMap<String, String>,
    optional: OptionalTexts,
) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (name, text) in texts {
        match built_in().find(|(known, _)| known == name) {
            None => faults.push(Fault::Unknown { name: name.clone() }),
            Some((_, english)) if placeholders(text) != placeholders(english) => {
                faults.push(Fault::Placeholders { name: name.clone(), english });
            }
            Some(_) => {}
        }
    }
    let sound = SOUND.iter().map(|row| row[0]).filter(|_| optional.sound);
    let mimicry = MIMICRY.iter().map(|row| row[0]).filter(|_| optional.mimicry);
    let needed = NAMES.iter().copied().chain(sound).chain(mimicry);
    let missing = needed.filter(|name| !texts.contains_key(*name));
    let missing: Vec<&str> = missing.collect();
    let complete = words(language).language() == primary_language(language);
    if !missing.is_empty() && !complete {
        faults.push(Fault::Missing(missing));
    }
    faults
}

/// Every text's name and what it is in English, those that not every study needs at the end.
fn built_in() -> impl Iterator<Item = (&'static str, &'static str)> {
    let optional = SOUND.iter().chain(&MIMICRY).map(|[name, english, _]| (*name, *english));
    NAMES.iter().copied().zip(ENGLISH.iter().copied()).chain(optional)
}

/// The words in braces, in alphabetical order, each once.
fn placeholders(text: &str) -> Vec<&str> {
    let mut found: Vec<&str> = text
        .split('{')
        .skip(1)
        .filter_map(|rest| rest.split_once('}').map(|(name, _)| name))
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Every text by its name, in the order of the pages, as a beginning for a translation: in the built-in
/// language nearest to it.
pub fn template(language: &str) -> Vec<(&'static str, &'static str)> {
    let place = if primary_language(language) == "fr" { 2 } else { 1 };
    let optional = SOUND.iter().chain(&MIMICRY).map(|row| (row[0], row[place]));
    NAMES.iter().copied().zip(words(language).built_in.iter().copied()).chain(optional).collect()
}

/// The names of the texts.
pub fn names() -> impl Iterator<Item = &'static str> {
    built_in().map(|(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::super::table::FRENCH;
    use super::*;

    #[test]
    fn every_text_has_a_name_of_its_own_and_the_same_words_in_braces_in_both_languages() {
        for (place, name) in NAMES.iter().enumerate() {
            assert_eq!(NAMES.iter().position(|other| other == name), Some(place), "{name}");
            assert_eq!(placeholders(ENGLISH[place]), placeholders(FRENCH[place]), "{name}");
            assert!(!ENGLISH[place].trim().is_empty() && !FRENCH[place].trim().is_empty());
        }
    }

    const ALL: OptionalTexts = OptionalTexts { sound: true, mimicry: true };

    #[test]
    fn faults_name_what_is_unknown_what_is_missing_and_braces_that_differ() {
        let texts = |pairs: &[(&str, &str)]| -> BTreeMap<String, String> {
            pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
        };
        for [name, english, french] in SOUND.into_iter().chain(MIMICRY) {
            assert_eq!(placeholders(english), placeholders(french), "{name}");
            assert!(!NAMES.contains(&name), "{name}");
        }
        let whole: BTreeMap<String, String> = template("de")
            .into_iter()
            .map(|(name, text)| (name.to_owned(), text.to_owned()))
            .collect();
        assert_eq!(faults("de", &whole, ALL), []);
        let texts_of = texts(&[("trial_of", "Clip {nummer} von {of}"), ("nxt", "Weiter")]);
        let found = faults("de", &texts_of, OptionalTexts::default());
        let [Fault::Unknown { name }, Fault::Placeholders { name: other, english }, rest] =
            found.as_slice()
        else {
            panic!("{found:?}")
        };
        assert_eq!((name.as_str(), other.as_str()), ("nxt", "trial_of"));
        assert_eq!(*english, "Clip {number} of {of}");
        let Fault::Missing(missing) = rest else { panic!("{rest:?}") };
        assert_eq!(missing.len(), NAMES.len() - 1);
        // What is said of sound, and of faces, is needed where there is sound, or faces are measured.
        let found = faults("de", &texts_of, ALL);
        let Some(Fault::Missing(with_all)) = found.last() else { panic!("{found:?}") };
        assert_eq!(with_all.len(), missing.len() + SOUND.len() + MIMICRY.len());
        // A word of English or French may be changed alone.
        assert_eq!(faults("fr-CA", &texts(&[("play", "Jouer l’extrait")]), ALL), []);
    }
}
