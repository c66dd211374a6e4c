//! The assigned condition as a factor: that there are conditions, that the test or table is one of
//! independent groups, since everybody is in one condition, and that everybody compared is asked.

use super::hypotheses::factor_names;
use super::issue::{Issues, below};
use super::nearest::suggestion;
use super::{Subject, responses};
use crate::responses::ASSIGNED_CONDITION;
use crate::study_file::{Hypothesis, Layout, Study, TableLayout, TestName};

/// A factor that a hypothesis or a table names at `place`: that there is such a factor.
pub(super) fn factor(subject: &Subject<'_>, factor: &str, place: String, issues: &mut Issues) {
    let names = factor_names(subject);
    if names.contains(factor) {
        return;
    }
    if factor == ASSIGNED_CONDITION {
        let message = format!("\"{factor}\" of a study that assigns no condition");
        let hint = "write nested sequences with \"conditional\": true, one for each condition; or name \
                    another factor";
        issues.error(place, "no-conditions", message, hint);
        return;
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let message = format!("there is no factor \"{factor}\"");
    issues.error(place, "unknown-reference", message, suggestion(factor, &names));
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
    let of_groups = match compared.len() {
        2 => "take \"mann-whitney\"",
        _ => "take \"kruskal-wallis\"",
    };
    let (test, hint) = match hypothesis.test {
        TestName::Wilcoxon => ("wilcoxon", of_groups),
        TestName::Friedman => ("friedman", of_groups),
        TestName::AlignedRankTransform => (
            "aligned-rank-transform",
            "take \"scheirer-ray-hare\": its interaction with a factor of the clips is tested on each \
             person's differences",
        ),
        TestName::Spearman => {
            let message = "\"spearman\" of conditions: their names have no order";
            issues.error(below(pointer, "test"), "no-order", message, of_groups);
            return;
        }
        TestName::KruskalWallis
        | TestName::MannWhitney
        | TestName::ScheirerRayHare
        | TestName::ChiSquare => return,
    };
    let message = format!(
        "\"{test}\" compares answers of one person at several levels; everybody is in one condition"
    );
    issues.error(below(pointer, "test"), "dependent-samples", message, hint);
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
            let message = format!(
                "nobody in the condition \"{condition}\" is asked \"{response}\" in a trial"
            );
            let hint = "ask it in trials of every condition that is compared, or compare others by \"levels\"";
            issues.error(below(pointer, "response"), "not-asked", message, hint);
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
    let message = "the layout \"pairs\" compares answers of one person at two levels; everybody is in \
                   one condition";
    let hint = "take \"influences\" or \"means\"; a pair of conditions is a hypothesis of \"mann-whitney\"";
    issues.error(below(pointer, "layout"), "dependent-samples", message, hint);
}
