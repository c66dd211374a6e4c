//! Translations of the fixed texts: what a study file brings for a language.

use std::collections::BTreeMap;

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

/// Everything that is wrong with a translation, texts by name. English and French may be changed in
/// part: nothing is missing there.
pub fn faults(language: &str, texts: &BTreeMap<String, String>) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (name, text) in texts {
        match NAMES.iter().position(|known| known == name) {
            None => faults.push(Fault::Unknown { name: name.clone() }),
            Some(place) if placeholders(text) != placeholders(ENGLISH[place]) => {
                faults.push(Fault::Placeholders { name: name.clone(), english: ENGLISH[place] });
            }
            Some(_) => {}
        }
    }
    let missing = NAMES.iter().copied().filter(|name| !texts.contains_key(*name));
    let missing: Vec<&str> = missing.collect();
    let complete = words(language).language() == primary_language(language);
    if !missing.is_empty() && !complete {
        faults.push(Fault::Missing(missing));
    }
    faults
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
    NAMES.iter().copied().zip(words(language).built_in.iter().copied()).collect()
}

/// The names of the texts.
pub fn names() -> &'static [&'static str] {
    &NAMES
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

    #[test]
    fn faults_name_what_is_unknown_what_is_missing_and_braces_that_differ() {
        let texts = |pairs: &[(&str, &str)]| -> BTreeMap<String, String> {
            pairs.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
        };
        let whole: BTreeMap<String, String> = template("de")
            .into_iter()
            .map(|(name, text)| (name.to_owned(), text.to_owned()))
            .collect();
        assert_eq!(faults("de", &whole), []);
        let found =
            faults("de", &texts(&[("trial_of", "Clip {nummer} von {of}"), ("nxt", "Weiter")]));
        let [Fault::Unknown { name }, Fault::Placeholders { name: other, english }, rest] =
            found.as_slice()
        else {
            panic!("{found:?}")
        };
        assert_eq!((name.as_str(), other.as_str()), ("nxt", "trial_of"));
        assert_eq!(*english, "Clip {number} of {of}");
        let Fault::Missing(missing) = rest else { panic!("{rest:?}") };
        assert_eq!(missing.len(), NAMES.len() - 1);
        // A word of English or French may be changed alone.
        assert_eq!(faults("fr-CA", &texts(&[("play", "Jouer l’extrait")])), []);
    }
}
