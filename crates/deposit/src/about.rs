//! What every file of a deposit says of it, each fact once.

use mimique_study::{Multilingual as _, Study};

use crate::author::Author;
use crate::licence::Licence;

/// The version of Mimique that makes the deposit.
pub const SOFTWARE_VERSION: &str = env!("CARGO_PKG_VERSION");
/// Where the software is developed.
pub const SOFTWARE_REPOSITORY: &str = env!("CARGO_PKG_REPOSITORY");
/// The licence of the software, an SPDX expression.
pub const SOFTWARE_LICENCE: &str = env!("CARGO_PKG_LICENSE");

/// What is said of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct About {
    /// Identifier of the study.
    pub study: String,
    /// Title.
    pub title: String,
    /// One or two sentences.
    pub description: String,
    /// Version of the study file, for people.
    pub version: String,
    /// The day of the deposit, `YYYY-MM-DD`.
    pub date: String,
    /// Code of the language of title and description.
    pub language: String,
    /// Who made it; at least one.
    pub authors: Vec<Author>,
    /// Where it was made.
    pub organizations: Vec<String>,
    /// Words that it is found by.
    pub keywords: Vec<String>,
    /// Licence of data, stimuli and report.
    pub data_licence: &'static Licence,
    /// Licence of the study file and of the report's scripts.
    pub code_licence: &'static Licence,
    /// How many people have rows.
    pub participants: usize,
    /// How many rows there are.
    pub rows: usize,
}

impl About {
    /// What a study says of itself; `title` and `description` go before the study's own.
    pub fn of_study(
        study: &Study,
        given: (Option<String>, Option<String>),
        authors: Vec<Author>,
        date: &str,
        licences: (&'static Licence, &'static Licence),
    ) -> Self {
        let language = study.default_language();
        let metadata = &study.study_metadata;
        let own = |text: &mimique_study::LocalText| text.in_language(language).to_owned();
        let keywords = ["perceptual study", "facial animation", "avatar", "psychology"];
        Self {
            study: study.id.clone(),
            title: given.0.unwrap_or_else(|| own(&metadata.title)),
            description: given.1.unwrap_or_else(|| own(&metadata.description)),
            version: metadata.version.clone(),
            date: date.to_owned(),
            language: language.to_owned(),
            authors,
            organizations: metadata.organizations.clone(),
            keywords: keywords.map(str::to_owned).to_vec(),
            data_licence: licences.0,
            code_licence: licences.1,
            participants: 0,
            rows: 0,
        }
    }
}

/// Whether a text is a day of the calendar, `YYYY-MM-DD`.
pub fn is_day(text: &str) -> bool {
    let is_form = text.len() == 10
        && text.bytes().enumerate().all(|(at, byte)| match at {
            4 | 7 => byte == b'-',
            _ => byte.is_ascii_digit(),
        });
    is_form && mimique_study::instant_ms(&format!("{text}T00:00:00Z")).is_some()
}
