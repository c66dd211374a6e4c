//! Why a line of a table of tests has no numbers: codes with values; their words in both languages.

use mimique_locale::Language;
use mimique_stats::{Outcome, Refusal, Undefined};
use serde::{Serialize, Serializer};

use crate::hypothesis::not_tested::NotTested;
use crate::hypothesis::test_line::TestLine;

/// A line of a table of tests, or why it has no numbers.
pub(crate) type TestOutcome = Outcome<TestLine, Why>;

/// Why a line has no numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Why {
    /// The statistic does not exist for these data.
    Statistic(Undefined),
    /// The hypothesis cannot be tested.
    NotTested(NotTested),
    /// No trials of one person differ in the factor alone.
    NoMatchedTrials,
    /// Every participant has one rating: nothing tells how participants differ.
    OneRatingPerPerson,
    /// No test is there for columns of these kinds.
    NoTest,
}

impl Why {
    /// In the middle of a sentence.
    pub(crate) fn words(&self, language: Language) -> String {
        match self {
            Self::Statistic(undefined) => undefined.words(language),
            Self::NotTested(why) => why.words(language),
            Self::NoMatchedTrials => language
                .pick(
                    "no trials of one person differ in this factor only",
                    "aucun essai d’une même personne ne diffère par ce seul facteur",
                )
                .to_owned(),
            Self::OneRatingPerPerson => language
                .pick(
                    "every participant has one rating, which does not show how participants differ",
                    "chaque personne n’a qu’une note, ce qui ne montre pas comment les personnes diffèrent",
                )
                .to_owned(),
            Self::NoTest => {
                language.pick("no test is defined", "aucun test n’est défini").to_owned()
            }
        }
    }
}

impl From<Undefined> for Why {
    fn from(undefined: Undefined) -> Self {
        Self::Statistic(undefined)
    }
}

impl From<Refusal> for Why {
    fn from(refusal: Refusal) -> Self {
        Self::Statistic(refusal.into())
    }
}

impl From<NotTested> for Why {
    fn from(why: NotTested) -> Self {
        Self::NotTested(why)
    }
}

/// In English, as `results.json` has it in every language of the report.
impl Serialize for Why {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.words(Language::English))
    }
}
