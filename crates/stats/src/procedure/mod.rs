//! What `mimique test` runs: each test and each description as one value that holds everything about it.
//!
//! A [`Procedure`] stands in the file of its computation, with its name, its options, its words and the
//! R and Python functions that compute the same. Adding one is that file and a line in [`PROCEDURES`];
//! the command line, the golden cases, the agreement with R and SciPy and the scripts of a report follow.

pub(crate) mod arguments;
pub(crate) mod lines;
pub(crate) mod row;

use serde::Serialize;

use crate::outcome::Outcome;
use crate::refusal::Refusal;
use crate::table::Table;
use crate::test::{
    aligned_rank_transform, bradley_terry, chi_square, cluster_permutation, consistency, cronbach,
    detection, difference_scaling, equivalence, friedman, intraclass_correlation, krippendorff,
    kruskal_wallis, mann_whitney, min_f, mixed_model, panel, psychometric, reverse_correlation,
    roc, scheirer_ray_hare, sign, spearman, thurstone, wilcoxon,
};
use crate::{adjust, summary};
use arguments::{Arguments, ProcedureOption};
use row::{TestNames, TestResult, TestRow};

/// A statistical test or description: everything that the command line and the scripts know of it.
pub struct Procedure {
    /// Name on the command line, such as `kruskal-wallis`.
    pub name: &'static str,
    /// The question that it answers, for the help text.
    pub question: &'static str,
    /// What it takes, in the order of the help text; groups that procedures share stand by themselves.
    pub options: &'static [&'static [ProcedureOption]],
    /// Runs it on columns of a table. Refuses columns that cannot be tested, naming them.
    pub run: fn(&Table, &Arguments) -> Result<Answer, Refusal>,
    /// What its functions of R and Python take.
    pub sample: Sample,
    /// Functions of R that compute the same of vectors; empty where no report calls them.
    pub r: &'static str,
    /// Functions of Python (NumPy, SciPy) that compute the same of arrays.
    pub python: &'static str,
    /// What the file of golden values calls its cases; empty where that file has none.
    pub golden_cases: &'static str,
}

/// What the R and Python functions of a procedure take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sample {
    /// Values in independent groups.
    Groups,
    /// Answers, which are counted, in independent groups.
    Counts,
    /// Two columns of numbers.
    Columns,
    /// Differences of pairs.
    Differences,
    /// A matrix: one row per block, one column per group.
    Blocks,
    /// Values, two factors, and the number of the effect from 1.
    TwoFactors,
    /// Values, two factors, their blocks, and the number of the effect from 1.
    TwoFactorsInBlocks,
    /// Participants, left items, right items, answers.
    Comparisons,
    /// The same, each participant having chosen once of each pair.
    Tournaments,
    /// Ratings, methods, participants, segments.
    PeopleAndSegments,
    /// The same, of a model that peers fit by a search.
    MixedModel,
    /// The same with any numbers in the place of ratings.
    LinearMixedModel,
    /// Differences of pairs, lower and upper bound.
    Equivalence,
    /// A matrix of ratings: one row per clip, one column per rater.
    Ratings,
    /// Participants, segments, conditions, ratings, the reference, the anchor.
    Panel,
    /// Participants, what was shown, what was answered, the category.
    Answers,
    /// What a coefficient without a test is of: its functions stand in the procedure's own tests.
    Coefficient,
    /// Something else: no test.
    Other,
}

/// Every procedure, in the order of the help text.
pub static PROCEDURES: [&Procedure; 29] = [
    &kruskal_wallis::PROCEDURE,
    &wilcoxon::PROCEDURE,
    &sign::PROCEDURE,
    &mann_whitney::PROCEDURE,
    &scheirer_ray_hare::PROCEDURE,
    &chi_square::PROCEDURE,
    &spearman::PROCEDURE,
    &friedman::PROCEDURE,
    &aligned_rank_transform::PROCEDURE,
    &min_f::PROCEDURE,
    &mixed_model::PROCEDURE,
    &mixed_model::linear::PROCEDURE,
    &equivalence::PROCEDURE,
    &bradley_terry::PROCEDURE,
    &thurstone::PROCEDURE,
    &consistency::PROCEDURE,
    &panel::PROCEDURE,
    &psychometric::PROCEDURE,
    &difference_scaling::PROCEDURE,
    &detection::PROCEDURE,
    &roc::PROCEDURE,
    &reverse_correlation::PROCEDURE,
    &cluster_permutation::PROCEDURE,
    &intraclass_correlation::PROCEDURE,
    &krippendorff::PROCEDURE,
    &cronbach::PROCEDURE,
    &summary::describe::PROCEDURE,
    &summary::confusion::PROCEDURE,
    &adjust::PROCEDURE,
];

/// The result of a procedure.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The result's own fields, with `status` `ok` or `undefined`, as indented JSON.
    pub json: String,
    /// Lines for people, in English.
    pub text: String,
    /// Of a test: its names and its rows in a table of tests.
    pub test: Option<(TestNames, Vec<Outcome<TestRow>>)>,
}

impl Answer {
    /// From what was computed and the words for it; what is undefined says so with its reason.
    pub(crate) fn of<T: Serialize>(outcome: &Outcome<T>, words: impl FnOnce(&T) -> String) -> Self {
        let text = match outcome {
            Outcome::Ok(result) => words(result),
            Outcome::Undefined { reason } => format!("undefined: {reason}\n"),
        };
        // Results are structs of numbers and texts, which JSON always has a form for.
        let json = serde_json::to_string_pretty(outcome).unwrap_or_else(|error| error.to_string());
        Self { json, text, test: None }
    }

    /// Of a result that says itself whether it is defined.
    pub(crate) fn of_result<T: Serialize>(
        result: &T,
        text: String,
        test: Option<(TestNames, Vec<Outcome<TestRow>>)>,
    ) -> Self {
        let json = serde_json::to_string_pretty(result).unwrap_or_else(|error| error.to_string());
        Self { json, text, test }
    }

    /// The same of a test, which has rows in a table of tests.
    pub(crate) fn of_test<T: Serialize + TestResult>(
        outcome: &Outcome<T>,
        words: impl FnOnce(&T) -> String,
    ) -> Self {
        let rows = match outcome {
            Outcome::Ok(result) => result.rows(),
            Outcome::Undefined { reason } => vec![Outcome::undefined(reason.clone())],
        };
        Self { test: Some((T::NAMES, rows)), ..Self::of(outcome, words) }
    }
}
