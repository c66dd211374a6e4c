//! A measure against a factor: as in the thesis (trial by trial) and as recommended (one value a
//! person), side by side.

use mimique_stats::{Description, Factor, Labelled, Outcome, describe};
use serde::Serialize;

use crate::hypothesis::person_level::{self, PersonLevel};
use crate::hypothesis::trial_level::{self, TrialLevel};
use crate::trials::answer_distribution::AnswerDistribution;
use crate::trials::export::Export;
use crate::trials::matching::Matching;
use crate::trials::measure::{Measure, MeasureKind};

/// A measure against a factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Comparison {
    pub measure: String,
    pub kind: MeasureKind,
    pub factor: String,
    pub levels: Vec<String>,
    /// Trials without a value of the factor, such as those of a method without that parameter: not used.
    pub trials_without_level: usize,
    /// Compared trials of each level.
    pub descriptions: Labelled<Outcome<Description>>,
    /// Mean over people of their means, a level.
    pub person_means: Labelled<Option<f64>>,
    pub as_in_the_thesis: TrialLevel,
    pub recommended: PersonLevel,
    /// How answers are distributed at each level.
    pub answer_distribution: AnswerDistribution,
    /// Which answers are compared within people, and how many remain.
    pub matching: Matching,
}

/// Compares the levels of a within-person factor.
pub(crate) fn within(export: &Export, measure: &Measure, factor: &Factor) -> Comparison {
    let matching = measure.matching(export, factor);
    let blocks = measure.person_means(export, factor, &matching);
    let (matched, matched_factor) = measure.at(factor, &matching.rows());
    let mut tests = vec![trial_level::overall(measure, factor)];
    if factor.levels.len() == 2 && measure.kind != MeasureKind::Recognition {
        tests.push(trial_level::wilcoxon(export, measure, factor));
    }
    let k = factor.levels.len();
    let n = blocks.responses.len() as f64;
    Comparison {
        measure: measure.id.clone(),
        kind: measure.kind,
        factor: factor.name.clone(),
        levels: factor.levels.clone(),
        trials_without_level: without_level(factor),
        descriptions: describe_levels(&matched, &matched_factor),
        person_means: Labelled::zip(
            &factor.levels,
            (0..k).map(|j| {
                (n > 0.0).then(|| blocks.responses.iter().map(|row| row[j]).sum::<f64>() / n)
            }),
        ),
        as_in_the_thesis: TrialLevel::new(tests),
        recommended: person_level::within_matched(export, measure, factor, &matching),
        answer_distribution: AnswerDistribution::of(measure, factor),
        matching,
    }
}

/// Describes the trials of each level.
pub(crate) fn describe_levels(
    measure: &Measure,
    factor: &Factor,
) -> Labelled<Outcome<Description>> {
    let of = |level: u32| -> Vec<f64> {
        (0..measure.values.len())
            .filter(|&i| factor.codes[i] == level)
            .map(|i| measure.values[i])
            .collect()
    };
    Labelled::zip(&factor.levels, (0..factor.levels.len() as u32).map(|level| describe(&of(level))))
}

/// Values whose trial has none of the factor's levels.
pub(crate) fn without_level(factor: &Factor) -> usize {
    factor.codes.iter().filter(|&&code| code == Factor::MISSING).count()
}
