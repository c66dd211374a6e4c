//! The library: designs of studies and instruments, each a JSON file of `study-config`. To add one is a file and its
//! line in a table here.
//!
//! A design has what makes it one (`questions`, `components`, `sequence`, `methods`, `hypotheses`); the rest of the
//! study is `designs/base.json`. An instrument has its questions as a study file has them, where they are asked, its
//! citation, licence and scoring. What may not be reproduced is named in `instruments/elsewhere.json`.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// What every study has besides its design.
const BASE: &str = include_str!("../../../study-config/designs/base.json");

/// The designs by their names.
const DESIGNS: [(&str, &str); 4] = [
    ("rate-one", include_str!("../../../study-config/designs/rate-one.json")),
    ("compare-two", include_str!("../../../study-config/designs/compare-two.json")),
    ("all-pairs", include_str!("../../../study-config/designs/all-pairs.json")),
    ("identify-emotion", include_str!("../../../study-config/designs/identify-emotion.json")),
];

/// Studies of the thesis (Reverdy 2019, chapter 6), whole as they stand: name, file, what they are.
const THESIS: [(&str, &str, &str); 3] = [
    (
        "study1",
        include_str!("../../../study-config/study1.json"),
        "the thesis's study 1: 18 performances by alpha 0.3, 0.5 and 0.7",
    ),
    (
        "study2a",
        include_str!("../../../study-config/study2a.json"),
        "the thesis's study 2a: LSTS against a baseline, then the performances themselves",
    ),
    (
        "study2b",
        include_str!("../../../study-config/study2b.json"),
        "the thesis's study 2b: each clip in step beside its performance",
    ),
];

/// The instruments by their names.
const INSTRUMENTS: [(&str, &str); 4] = [
    ("sus", include_str!("../../../study-config/instruments/sus.json")),
    ("nasa-tlx", include_str!("../../../study-config/instruments/nasa-tlx.json")),
    ("affect-grid", include_str!("../../../study-config/instruments/affect-grid.json")),
    ("closeness", include_str!("../../../study-config/instruments/closeness.json")),
];

/// Instruments whose text is not here.
const ELSEWHERE: &str = include_str!("../../../study-config/instruments/elsewhere.json");

/// What a study is made from.
#[derive(Debug)]
pub enum Design {
    /// Parts that are put together with base, stimuli and instruments.
    Parts(Box<Parts>),
    /// A study as it stands.
    Whole(Value),
}

/// The parts of a design.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parts {
    /// What it is, in a line.
    pub about: String,
    /// What the study is called.
    pub title: Value,
    /// What is compared.
    pub methods: Map<String, Value>,
    /// What trials ask.
    pub questions: Vec<Value>,
    /// What the sequence is made of.
    pub components: Map<String, Value>,
    /// The order.
    pub sequence: Value,
    /// What is tested.
    pub hypotheses: Vec<Value>,
    /// What stands above its parts in the file, by JSON pointers.
    #[serde(default)]
    pub comments: Map<String, Value>,
}

/// When an instrument is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Asked {
    /// Of each clip.
    Clip,
    /// On a page of its own, after the clips.
    After,
}

/// An instrument.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Instrument {
    /// Its name in the study: of the page, and of its file.
    #[serde(skip)]
    pub id: String,
    /// Its whole name.
    pub name: String,
    /// When it is asked.
    pub asked: Asked,
    /// Whom to cite.
    pub citation: String,
    /// Why it may be passed on.
    pub licence: String,
    /// Where the words of other languages than the original's are from, by language.
    #[serde(default)]
    pub translations: Map<String, Value>,
    /// How its answers become a number.
    pub scoring: String,
    /// The heading of its page.
    #[serde(default)]
    pub title: Option<Value>,
    /// Its questions, as a study file has them.
    pub questions: Vec<Value>,
    /// What is computed of its questions, as a study file has it.
    #[serde(default)]
    pub scales: Map<String, Value>,
    /// Pictures that its questions show, by the names of their files.
    #[serde(default)]
    pub pictures: Map<String, Value>,
}

/// An instrument that is not in the library.
#[derive(Debug, Deserialize)]
pub struct Elsewhere {
    /// The name that somebody would ask for.
    pub id: String,
    /// Its whole name.
    pub name: String,
    /// Whom to cite.
    pub citation: String,
    /// Where it is to be had.
    #[serde(rename = "where")]
    pub place: String,
    /// Why it is not here.
    pub why: String,
}

/// What the library cannot give.
#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    /// A file of the library is not as it should be: a mistake of this version.
    #[error("study-config/{file}: {problem}")]
    Unreadable {
        /// Its path in `study-config`.
        file: String,
        /// What is wrong.
        problem: String,
    },
    /// No design has that name.
    #[error("there is no design {name:?}; take one of {}", known.join(", "))]
    NoDesign {
        /// The name.
        name: String,
        /// The names that there are.
        known: Vec<&'static str>,
    },
    /// No instrument has that name.
    #[error("there is no instrument {name:?}; take one of {}, or a file of your own (my.json)", known.join(", "))]
    NoInstrument {
        /// The name.
        name: String,
        /// The names that there are.
        known: Vec<&'static str>,
    },
    /// The instrument's text may not be passed on.
    #[error(
        "{id}: the text of the {} is not in the library: {}; get it from {}, write it into a file as \
         study-config/instruments/sus.json is written, and give that file: --instrument {id}.json",
        instrument.name, instrument.why, instrument.place, id = instrument.id
    )]
    Elsewhere {
        /// Where it is to be had.
        instrument: Box<Elsewhere>,
    },
    /// Text that is no instrument.
    #[error("{id}: {problem}; write it as study-config/instruments/sus.json is written")]
    NotAnInstrument {
        /// Its name.
        id: String,
        /// What is wrong.
        problem: String,
    },
}

fn read<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, LibraryError> {
    serde_json::from_str(text)
        .map_err(|e| LibraryError::Unreadable { file: file.to_owned(), problem: e.to_string() })
}

/// What every study has.
pub(crate) fn base() -> Result<Map<String, Value>, LibraryError> {
    read("designs/base.json", BASE)
}

/// Names of the designs, and what they are.
///
/// # Errors
/// A file of the library is not as it should be.
pub fn designs() -> Result<Vec<(&'static str, String)>, LibraryError> {
    let mut all = Vec::new();
    for (name, text) in DESIGNS {
        all.push((name, parts(name, text)?.about));
    }
    all.extend(THESIS.map(|(name, _, about)| (name, about.to_owned())));
    Ok(all)
}

fn parts(name: &str, text: &str) -> Result<Parts, LibraryError> {
    read(&format!("designs/{name}.json"), text)
}

impl Design {
    /// The design of that name.
    ///
    /// # Errors
    /// [`LibraryError::NoDesign`].
    pub fn named(name: &str) -> Result<Self, LibraryError> {
        if let Some((_, text)) = DESIGNS.iter().find(|(own, _)| *own == name) {
            return Ok(Self::Parts(Box::new(parts(name, text)?)));
        }
        if let Some((_, text, _)) = THESIS.iter().find(|(own, ..)| *own == name) {
            let study = mimique_study::parse(text).map_err(|e| LibraryError::Unreadable {
                file: format!("{name}.json"),
                problem: e.to_string(),
            })?;
            return Ok(Self::Whole(study));
        }
        let known = DESIGNS.iter().map(|(own, _)| *own).chain(THESIS.map(|(own, ..)| own));
        Err(LibraryError::NoDesign { name: name.to_owned(), known: known.collect() })
    }
}

/// The instruments of the library.
///
/// # Errors
/// A file of the library is not as it should be.
pub fn instruments() -> Result<Vec<Instrument>, LibraryError> {
    INSTRUMENTS.iter().map(|(name, text)| Instrument::read(name, text)).collect()
}

/// What the library does not have.
///
/// # Errors
/// A file of the library is not as it should be.
pub fn elsewhere() -> Result<Vec<Elsewhere>, LibraryError> {
    read("instruments/elsewhere.json", ELSEWHERE)
}

impl Instrument {
    /// The instrument of that name.
    ///
    /// # Errors
    /// [`LibraryError::Elsewhere`] and [`LibraryError::NoInstrument`].
    pub fn named(name: &str) -> Result<Self, LibraryError> {
        if let Some((_, text)) = INSTRUMENTS.iter().find(|(own, _)| *own == name) {
            return Self::read(name, text);
        }
        if let Some(other) = elsewhere()?.into_iter().find(|other| other.id == name) {
            return Err(LibraryError::Elsewhere { instrument: Box::new(other) });
        }
        let known = INSTRUMENTS.iter().map(|(own, _)| *own).collect();
        Err(LibraryError::NoInstrument { name: name.to_owned(), known })
    }

    /// An instrument of one's own, from the text of a JSON file.
    ///
    /// # Errors
    /// [`LibraryError::NotAnInstrument`].
    pub fn read(id: &str, text: &str) -> Result<Self, LibraryError> {
        let own: Self = serde_json::from_str(text).map_err(|e| LibraryError::NotAnInstrument {
            id: id.to_owned(),
            problem: e.to_string(),
        })?;
        Ok(Self { id: id.to_owned(), ..own })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_in_the_library_can_be_read_and_is_named_once() {
        assert_eq!(designs().unwrap().len(), DESIGNS.len() + THESIS.len());
        for instrument in instruments().unwrap() {
            let Instrument { id, citation, licence, scoring, questions, .. } = instrument;
            let texts = [citation, licence, scoring];
            assert!(!questions.is_empty() && texts.iter().all(|text| text.len() > 20), "{id}");
            for question in questions {
                let prompt = &question["prompt"];
                assert!(prompt["en"].is_string() && prompt["fr"].is_string(), "{id}: {prompt}");
            }
        }
        for other in elsewhere().unwrap() {
            let error = Instrument::named(&other.id).unwrap_err().to_string();
            assert!(error.contains(&other.place) && error.contains(&other.why), "{error}");
        }
    }
}
