//! The options of a procedure as a table, and what was given for them.

use std::collections::BTreeMap;

use crate::distributions::tail::Alternative;
use crate::refusal::Refusal;
use crate::table::factor::Factor;
use crate::table::{Numbers, Table};

/// An option of a procedure: `--response COLUMN`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProcedureOption {
    /// Its name, without dashes.
    pub name: &'static str,
    /// What it is, for the help text.
    pub help: &'static str,
    /// What stands behind it.
    pub takes: Takes,
    /// Whether it must be given.
    pub required: Required,
    /// Options that must be given with it.
    pub requires: &'static [&'static str],
    /// Options that must not be given with it.
    pub excludes: &'static [&'static str],
}

/// What stands behind an option.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// One text, such as the name of a column.
    Text,
    /// Several texts with commas between.
    List,
    /// One of some words.
    OneOf {
        /// The words.
        choices: &'static [Choice],
        /// What is taken where none is given.
        default: Option<&'static str>,
    },
    /// Nothing: it is there or not.
    Nothing,
}

/// Whether an option must be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Required {
    /// It may be left out.
    No,
    /// Always.
    Yes,
    /// Unless this other option is given.
    Unless(&'static str),
}

/// One of the words that an option takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// The word.
    pub name: &'static str,
    /// What it means, for the help text.
    pub meaning: &'static str,
    /// Other words for the same.
    pub aliases: &'static [&'static str],
}

impl Choice {
    /// A word without aliases.
    pub const fn new(name: &'static str, meaning: &'static str) -> Self {
        Self { name, meaning, aliases: &[] }
    }

    /// With other words for the same.
    pub const fn or(self, aliases: &'static [&'static str]) -> Self {
        Self { aliases, ..self }
    }
}

impl ProcedureOption {
    /// An option that takes one text and may be left out.
    pub const fn text(name: &'static str, help: &'static str) -> Self {
        Self {
            name,
            help,
            takes: Takes::Text,
            required: Required::No,
            requires: &[],
            excludes: &[],
        }
    }

    /// An option that takes several texts with commas between.
    pub const fn list(name: &'static str, help: &'static str) -> Self {
        Self { takes: Takes::List, ..Self::text(name, help) }
    }

    /// An option that takes one of some words.
    pub const fn one_of(
        name: &'static str,
        help: &'static str,
        choices: &'static [Choice],
        default: Option<&'static str>,
    ) -> Self {
        Self { takes: Takes::OneOf { choices, default }, ..Self::text(name, help) }
    }

    /// An option without a value.
    pub const fn flag(name: &'static str, help: &'static str) -> Self {
        Self { takes: Takes::Nothing, ..Self::text(name, help) }
    }

    /// It must be given.
    pub const fn required(self) -> Self {
        Self { required: Required::Yes, ..self }
    }

    /// It must be given unless another one is.
    pub const fn required_unless(self, other: &'static str) -> Self {
        Self { required: Required::Unless(other), ..self }
    }

    /// Others must be given with it.
    pub const fn requires(self, others: &'static [&'static str]) -> Self {
        Self { requires: others, ..self }
    }

    /// Others must not be given with it.
    pub const fn excludes(self, others: &'static [&'static str]) -> Self {
        Self { excludes: others, ..self }
    }
}

/// What was given for the options of a procedure.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Arguments {
    given: BTreeMap<String, Vec<String>>,
}

impl Arguments {
    /// From names of options and their values; an option without a value has an empty list.
    pub fn new(given: impl IntoIterator<Item = (String, Vec<String>)>) -> Self {
        Self { given: given.into_iter().collect() }
    }

    /// Whether an option was given.
    pub fn has(&self, option: &str) -> bool {
        self.given.contains_key(option)
    }

    /// The value of an option; none where it was not given.
    pub fn text(&self, option: &str) -> Option<&str> {
        self.list(option).first().map(String::as_str)
    }

    /// The values of an option; none where it was not given.
    pub fn list(&self, option: &str) -> &[String] {
        self.given.get(option).map_or(&[], Vec::as_slice)
    }

    /// The value of an option that must be given.
    pub(crate) fn needed(&self, option: &str) -> Result<&str, Refusal> {
        self.text(option).ok_or_else(|| Refusal::MissingOption { option: option.to_owned() })
    }

    /// The word that was chosen, or the default, by its first name.
    pub(crate) fn chosen(&self, option: &ProcedureOption) -> Result<Option<&'static str>, Refusal> {
        let Takes::OneOf { choices, default } = option.takes else { return Ok(None) };
        let Some(word) = self.text(option.name) else { return Ok(default) };
        let found =
            choices.iter().find(|choice| choice.name == word || choice.aliases.contains(&word));
        found.map(|choice| Some(choice.name)).ok_or_else(|| Refusal::NotAChoice {
            option: option.name,
            word: word.to_owned(),
            choices: choices.iter().map(|choice| choice.name).collect(),
        })
    }

    /// The whole number of an option, `default` where it was not given.
    pub(crate) fn whole(&self, option: &'static str, default: u64) -> Result<u64, Refusal> {
        let Some(word) = self.text(option) else { return Ok(default) };
        word.parse().map_err(|_| Refusal::OptionNotWhole { option, word: word.to_owned() })
    }

    /// The number of an option within bounds; none where it was not given.
    pub(crate) fn real(
        &self,
        option: &'static str,
        [least, most]: [f64; 2],
    ) -> Result<Option<f64>, Refusal> {
        let Some(word) = self.text(option) else { return Ok(None) };
        let number = word.parse().ok().filter(|value| (least..=most).contains(value));
        let refusal = || Refusal::OptionNotWithin { option, word: word.to_owned(), least, most };
        number.map(Some).ok_or_else(refusal)
    }

    /// The direction that `--alternative` names.
    pub(crate) fn alternative(&self) -> Result<Alternative, Refusal> {
        Ok(match self.chosen(&ALTERNATIVE)? {
            Some("greater") => Alternative::Greater,
            Some("less") => Alternative::Less,
            _ => Alternative::TwoSided,
        })
    }

    /// The column of numbers that an option names.
    pub(crate) fn numbers(&self, table: &Table, option: &str) -> Result<Numbers, Refusal> {
        table.numbers(self.needed(option)?)
    }

    /// The factor that an option names.
    pub(crate) fn factor(&self, table: &Table, option: &str) -> Result<Factor, Refusal> {
        table.factor(self.needed(option)?)
    }

    /// The factor that `--group` names, with the levels that `--levels` chooses, in that order.
    pub(crate) fn groups(&self, table: &Table) -> Result<Factor, Refusal> {
        let factor = self.factor(table, "group")?;
        match self.list("levels") {
            [] => Ok(factor),
            levels => factor.restricted(levels),
        }
    }

    /// The factors that `--factors A,B` names.
    pub(crate) fn factors(&self, table: &Table) -> Result<Vec<Factor>, Refusal> {
        self.list("factors").iter().map(|name| table.factor(name)).collect()
    }
}

/// `--response`: the column that a test is about.
pub(crate) const RESPONSE: ProcedureOption =
    ProcedureOption::text("response", "Column of numbers").required();

/// `--group`: the column that tells independent groups apart.
pub(crate) const GROUP: ProcedureOption =
    ProcedureOption::text("group", "Column that tells the groups apart").required();

/// `--alternative`: the direction of a test.
pub(crate) const ALTERNATIVE: ProcedureOption = ProcedureOption::one_of(
    "alternative",
    "Direction",
    &[
        Choice::new("two-sided", "Either"),
        Choice::new("greater", "The first is larger"),
        Choice::new("less", "The first is smaller"),
    ],
    Some("two-sided"),
);

/// `--rounds`: how often is drawn again for an interval.
pub(crate) const ROUNDS: ProcedureOption =
    ProcedureOption::text("rounds", "Draws for the intervals; 0 for none [default: 2000]");

/// `--seed`: of everything that is drawn.
pub(crate) const SEED: ProcedureOption = ProcedureOption::text(
    "seed",
    "Seed of the draws: the same seed, the same intervals [default: 1]",
);

/// What is drawn where no number of draws was given.
pub(crate) const DEFAULT_ROUNDS: u64 = 2000;
