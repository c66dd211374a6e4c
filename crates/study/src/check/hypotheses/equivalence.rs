//! The smallest difference that matters, which a hypothesis of equivalence must name before there are answers.

use crate::check::issue::{Issues, below};
use crate::check::problem::Problem;
use crate::check::{Subject, responses};
use crate::question::KindOfQuestion as _;
use crate::study_file::{Hypothesis, Measure, TestName};

/// That a hypothesis of equivalence, and no other, has a smallest difference, which answers can exceed.
pub(super) fn examine(
    subject: &Subject<'_>,
    hypothesis: &Hypothesis,
    pointer: &str,
    issues: &mut Issues,
) {
    let (place, reason) =
        (below(pointer, "smallestEffect"), below(pointer, "smallestEffectReason"));
    if hypothesis.test != TestName::Equivalence {
        let problem = || Problem::SmallestEffectOfOtherTest { test: hypothesis.test.as_str() };
        if hypothesis.smallest_effect.is_some() {
            issues.error(place, problem());
        }
        if hypothesis.smallest_effect_reason.is_some() {
            issues.error(reason, problem());
        }
        return;
    }
    let id = || hypothesis.id.clone();
    match hypothesis.smallest_effect {
        None => issues.error(place, Problem::NoSmallestEffect { hypothesis: id() }),
        Some(value) if !(value.is_finite() && value > 0.0) => {
            issues.error(place, Problem::NotASmallestEffect { value });
        }
        Some(value) => {
            if let Some(widest) = widest(subject, hypothesis).filter(|widest| value >= *widest) {
                issues.error(place, Problem::SmallestEffectAsWide { value, widest });
            }
        }
    }
    if hypothesis.smallest_effect_reason.is_none() {
        issues.warning(reason, Problem::NoReasonOfSmallestEffect { hypothesis: id() });
    }
}

/// The largest difference that two answers can have; none where nothing bounds it.
fn widest(subject: &Subject<'_>, hypothesis: &Hypothesis) -> Option<f64> {
    if hypothesis.measure == Measure::Rt {
        return None;
    }
    let question = responses::question(subject.study, &hypothesis.response)?;
    if question.kind.truth().is_some() {
        return Some(1.0);
    }
    let points = || question.kind.points().map(|points| (points.end() - points.start()) as f64);
    match question.kind.bounds() {
        Some([Some(low), Some(high)]) => Some(high - low),
        _ => points(),
    }
}
