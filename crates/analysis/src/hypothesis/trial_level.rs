//! Tests as in the thesis: every trial counts as an independent observation.

use mimique_stats::{Factor, WilcoxonOptions, WilcoxonVariant};
use serde::Serialize;

use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::test_line::{TestLine, Unit};
use crate::hypothesis::undefined::{TestOutcome, Why};
use crate::trials::export::Export;
use crate::trials::measure::{Measure, MeasureKind};

/// Tests that treat trials as independent observations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct TrialLevel {
    /// Always `independent observations`, which trials of one person are not.
    pub assumes: &'static str,
    /// The tests.
    pub tests: Vec<TestOutcome>,
}

impl TrialLevel {
    pub(crate) fn new(tests: Vec<TestOutcome>) -> Self {
        Self { assumes: "independent observations", tests }
    }
}

/// Kruskal-Wallis of trials; for right and wrong answers the chi-square test.
pub(crate) fn overall(measure: &Measure, factor: &Factor) -> TestOutcome {
    if measure.kind == MeasureKind::Recognition {
        let answers = Factor::from_cells(
            &measure.id,
            measure.values.iter().map(|&value| Some(if value > 0.5 { "right" } else { "wrong" })),
            |_| None,
        );
        return TestLine::chi_square(factor, &answers);
    }
    TestLine::kruskal_wallis(&measure.numbers(), factor, &Unit::Trials)
}

/// Chi-square of every answer against the factor.
pub(crate) fn chi_square(measure: &Measure, factor: &Factor) -> TestOutcome {
    if measure.kind == MeasureKind::Recognition {
        return overall(measure, factor);
    }
    let answers: Vec<String> = measure.values.iter().map(ToString::to_string).collect();
    let answers = Factor::from_cells(
        &measure.id,
        answers.iter().map(|answer| Some(answer.as_str())),
        |answer| answer.parse().ok(),
    );
    TestLine::chi_square(factor, &answers)
}

/// Wilcoxon as R of 2019 on matched trials of two levels.
pub(crate) fn wilcoxon(export: &Export, measure: &Measure, factor: &Factor) -> TestOutcome {
    let blocks = measure.matched_trials(export, factor);
    if blocks.responses.is_empty() {
        return TestOutcome::undefined(Why::NoMatchedTrials);
    }
    let options = WilcoxonOptions { variant: WilcoxonVariant::Thesis, ..Default::default() };
    let call = Call::new(Design::MatchedTrials, "wilcoxon_thesis")
        .text(&measure.id)
        .text(&factor.name)
        .list(&factor.levels)
        .list(&measure.matched_factors(export, factor));
    TestLine::wilcoxon(&blocks.differences(0, 1), options, &Unit::Trials, call).0
}

/// Every pair of levels: Wilcoxon, or the chi-square test for right and wrong answers.
pub(crate) fn pairs(
    export: &Export,
    measure: &Measure,
    factor: &Factor,
) -> Vec<(String, String, TestOutcome)> {
    let mut pairs = Vec::new();
    for (place, a) in factor.levels.iter().enumerate() {
        for b in &factor.levels[place + 1..] {
            let Ok(two) = factor.restricted(&[a.clone(), b.clone()]) else { continue };
            let line = if measure.kind == MeasureKind::Recognition {
                overall(measure, &two)
            } else {
                wilcoxon(export, measure, &two)
            };
            pairs.push((a.clone(), b.clone(), line));
        }
    }
    pairs
}
