//! The assigned condition as a factor: that there are conditions, that the test or table is one of
//! independent groups, since everybody is in one condition, and that everybody compared is asked.

use super::hypotheses::factor_names;
use super::issue::{Issues, below};
use super::problem::Problem;
use super::{Subject, responses};
use crate::columns::ASSIGNED_CONDITION;
use crate::study_file::{Hypothesis, Layout, Study, TableLayout, TestName};

/// A factor that a hypothesis or a table names at `place`: that there is such a factor.
pub(super) fn factor(subject: &Subject<'_>, factor: &str, place: String, issues: &mut Issues) {
    let names = factor_names(subject);
    if names.contains(factor) {
        return;
    }
    if factor == ASSIGNED_CONDITION {
        issues.error(place, Problem::NoConditions { factor: factor.to_owned() });
        return;
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    issues.error(place, Problem::unknown("factor", factor, &names));
}

/// A test that takes answers of one person at several levels, or levels in an order, is none of
/// conditions.
pub(super) fn hypothesis(
    subject: &Subject<'_>,
    hypothesis: &Hypothesis,
    pointer: &str,
    issues: &mut Issues,
) {
    let conditions = subject.study.conditions();
    let is_factor = hypothesis.factors.iter().any(|factor| factor == ASSIGNED_CONDITION);
    if !is_factor || conditions.is_empty() {
        return;
    }
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    let first = hypothesis.factors.first().is_some_and(|factor| factor == ASSIGNED_CONDITION);
    let named = |name: &&str| !first || levels.is_empty() || levels.iter().any(|it| it == name);
    let compared: Vec<&str> = conditions.into_iter().filter(named).collect();
    asked(subject.study, hypothesis, &compared, pointer, issues);
    let instead = match compared.len() {
        2 => "mann-whitney",
        _ => "kruskal-wallis",
    };
    let problem = match hypothesis.test {
        TestName::Wilcoxon => Problem::DependentSamples { test: "wilcoxon", instead },
        TestName::Friedman => Problem::DependentSamples { test: "friedman", instead },
        TestName::AlignedRankTransform => {
            Problem::DependentTwoWay { test: "aligned-rank-transform" }
        }
        TestName::Spearman => Problem::ConditionsUnordered { instead },
        TestName::KruskalWallis
        | TestName::MannWhitney
        | TestName::ScheirerRayHare
        | TestName::ChiSquare
        | TestName::Equivalence
        // What chooses between clips says itself that no two of them differ in the condition.
        | TestName::Sign
        | TestName::BradleyTerry => return,
    };
    issues.error(below(pointer, "test"), problem);
}

/// Everybody who is compared is asked in some trial.
fn asked(
    study: &Study,
    hypothesis: &Hypothesis,
    compared: &[&str],
    pointer: &str,
    issues: &mut Issues,
) {
    let response = hypothesis.response.as_str();
    let Some(question) = responses::question(study, response) else { return };
    for condition in compared {
        if !responses::is_asked(study, condition, &question.id) {
            issues.error(
                below(pointer, "response"),
                Problem::ConditionNotAsked {
                    condition: (*condition).to_owned(),
                    response: response.to_owned(),
                },
            );
        }
    }
}

/// A table of pairs compares levels within people.
pub(super) fn table(
    subject: &Subject<'_>,
    table: &TableLayout,
    pointer: &str,
    issues: &mut Issues,
) {
    let is_factor = table.factors.iter().any(|factor| factor == ASSIGNED_CONDITION);
    if !is_factor || table.layout != Layout::Pairs || subject.study.conditions().is_empty() {
        return;
    }
    issues.error(below(pointer, "layout"), Problem::DependentPairs);
}
