//! What a table of tests prints of any test.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::outcome::Outcome;

/// What a row of a test's result is about.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Term {
    /// All that was compared: the test has one row.
    #[default]
    Whole,
    /// Two groups, in the order of the effect's sign.
    Pair([String; 2]),
    /// Differences, by the name of their column.
    Differences(String),
    /// A column against another one.
    Relation([String; 2]),
    /// The effect of a factor, or the interaction of several, by their names.
    Effect(Vec<String>),
}

impl Term {
    /// The effect of one factor.
    pub fn factor(name: &str) -> Self {
        Self::Effect(vec![name.to_owned()])
    }

    /// The interaction of two factors.
    pub fn interaction(first: &str, second: &str) -> Self {
        Self::Effect([first, second].map(str::to_owned).into())
    }

    /// Whether the row is the test's only one.
    pub fn is_whole(&self) -> bool {
        *self == Self::Whole
    }
}

/// As tables and files name it: `a | b`, `y ~ x`, `method:emotion`.
impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Pair(groups) => f.write_str(&groups.join(" | ")),
            Self::Differences(column) => f.write_str(column),
            Self::Relation(columns) => f.write_str(&columns.join(" ~ ")),
            Self::Effect(factors) => f.write_str(&factors.join(":")),
        }
    }
}

impl Serialize for Term {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// What a test, its statistic and its effect size are called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TestNames {
    /// The test: `Kruskal-Wallis`.
    pub test: &'static str,
    /// The test where there is little room; empty where the statistic tells it.
    pub short: &'static str,
    /// The test in a sentence, in English and French: `Kruskal-Wallis test`.
    pub in_words: [&'static str; 2],
    /// The statistic: `chi-square`.
    pub statistic: &'static str,
    /// Its letter: `χ²`.
    pub statistic_symbol: &'static str,
    /// The effect size: `epsilon squared`.
    pub effect: &'static str,
    /// Its letter: `ε²`.
    pub effect_symbol: &'static str,
    /// The function of the test's R and Python code.
    pub function: &'static str,
}

/// The numbers of one test, or of one effect of a test of several factors.
#[derive(Debug, Clone, PartialEq)]
pub struct TestRow {
    /// Which variant of the test, where it has several; else empty.
    pub variant: String,
    /// The effect, where a test has several rows, or the pair compared.
    pub term: Term,
    /// The statistic.
    pub statistic: f64,
    /// Its degrees of freedom: none, one, or two.
    pub degrees_of_freedom: Vec<usize>,
    /// p.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// The effect size.
    pub effect: Option<f64>,
    /// Observations, pairs or blocks.
    pub n: usize,
}

/// The result of a test, which can say its rows in a table of tests.
pub trait TestResult {
    /// What it is called.
    const NAMES: TestNames;

    /// One row of most tests, one per effect of tests of several factors; what is undefined says why.
    fn rows(&self) -> Vec<Outcome<TestRow>>;
}
