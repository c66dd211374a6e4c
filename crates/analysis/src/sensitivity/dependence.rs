//! The choices on which a verdict depends: the smallest sets of choices that change it.

use serde::Serialize;

use super::{Specification, TestChoice};

/// A choice other than that of the study file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Change {
    /// A rule is not applied: its place in [`super::Sensitivity::rules`].
    WithoutRule(usize),
    /// Another test decides.
    Test(TestChoice),
}

/// Choices that change the verdict together, while no part of them does.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Dependence {
    pub changes: Vec<Change>,
    /// The specification that makes these choices and no others: its place among the specifications.
    pub specification: usize,
}

/// The choices of a specification that differ from those of another one.
fn changes(own: &Specification, study_file: &Specification) -> Vec<Change> {
    let rules = own.applied.iter().zip(&study_file.applied).enumerate();
    let rules = rules.filter(|(_, (own, study_file))| own != study_file);
    let test = (own.test != study_file.test).then_some(Change::Test(own.test));
    rules.map(|(rule, _)| Change::WithoutRule(rule)).chain(test).collect()
}

/// The smallest sets of choices that change the verdict of the first specification, fewest choices first. Specifications
/// that cannot be computed change nothing. Empty if the first cannot be computed.
pub(super) fn of(specifications: &[Specification]) -> Vec<Dependence> {
    let Some(study_file) = specifications.first() else { return Vec::new() };
    let Some(verdict) = &study_file.finding.verdict else { return Vec::new() };
    let mut all: Vec<Dependence> = (specifications.iter().enumerate())
        .filter(|(_, own)| own.finding.verdict.as_ref().is_some_and(|own| own != verdict))
        .map(|(place, own)| Dependence { changes: changes(own, study_file), specification: place })
        .collect();
    all.sort_by_key(|own| (own.changes.len(), own.specification));
    let mut smallest: Vec<Dependence> = Vec::new();
    for own in all {
        let contains = |part: &Dependence| part.changes.iter().all(|it| own.changes.contains(it));
        if !smallest.iter().any(contains) {
            smallest.push(own);
        }
    }
    smallest
}

#[cfg(test)]
mod tests {
    use super::super::Finding;
    use super::super::finding::Verdict;
    use super::*;
    use crate::hypothesis::decision::{Decision, Sought};

    fn specification(applied: [bool; 2], test: TestChoice, shown: Option<bool>) -> Specification {
        let verdict = shown.map(|shown| Verdict {
            decision: match shown {
                true => Decision::Shown(Sought::Difference),
                false => Decision::NotShown(Sought::Difference),
            },
            direction: None,
        });
        let finding = Finding { p: None, estimate: None, verdict };
        Specification { applied: applied.to_vec(), test, people: 0, trials: 0, finding }
    }

    #[test]
    fn only_the_smallest_sets_of_choices_are_named() {
        use TestChoice::{LinearModel, MinF};
        let all = [
            specification([true, true], LinearModel, Some(true)),
            specification([true, true], MinF, None),
            specification([false, true], LinearModel, Some(false)),
            specification([false, true], MinF, Some(false)),
            specification([true, false], LinearModel, Some(true)),
            specification([true, false], MinF, Some(false)),
        ];
        let found = of(&all);
        let changes: Vec<&[Change]> = found.iter().map(|own| own.changes.as_slice()).collect();
        let together = [Change::WithoutRule(1), Change::Test(MinF)];
        assert_eq!(changes, [&[Change::WithoutRule(0)][..], &together]);
        assert_eq!(found[1].specification, 5);
        assert_eq!(of(&all[..1]), []);
    }
}
