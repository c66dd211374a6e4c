//! The assigned condition as a factor: that there are conditions, and that the test or table is one of
//! independent groups, since everybody is in one condition.

use super::Subject;
use super::hypotheses::factor_names;
use super::issue::{Issues, below};
use super::nearest::suggestion;
use crate::responses::ASSIGNED_CONDITION;
use crate::study_file::{Hypothesis, Layout, TableLayout, TestName};

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
    let conditions = subject.study.conditions().len();
    let is_factor = hypothesis.factors.iter().any(|factor| factor == ASSIGNED_CONDITION);
    if !is_factor || conditions == 0 {
        return;
    }
    let compared = if hypothesis.levels.is_empty() { conditions } else { hypothesis.levels.len() };
    let of_groups = match compared {
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
