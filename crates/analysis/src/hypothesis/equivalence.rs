//! Whether two levels differ by less than the smallest difference that matters: two one-sided tests on one value a
//! person, by ranks, with t beside.

use mimique_stats::{
    EQUIVALENCE_PAIRED_T, EQUIVALENCE_WELCH, EquivalenceOfGroups, EquivalenceOptions, EquivalenceT,
    EquivalenceVerdict, Factor, Numbers, Outcome, TestNames, TestResult as _, Undefined,
    equivalence_of_groups, equivalence_of_pairs,
};
use mimique_study::{Hypothesis, Study};
use serde::Serialize;

use crate::hypothesis::ClipScope;
use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::not_tested::NotTested;
use crate::hypothesis::person_level::PersonLevel;
use crate::hypothesis::test_line::{TestLine, Unit};
use crate::hypothesis::undefined::{TestOutcome, Why};
use crate::trials::export::Export;
use crate::trials::measure::Measure;

/// One pair of one-sided tests.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct OneSidedTests {
    /// The larger p of both.
    pub line: TestOutcome,
    /// Of the first level less the second.
    pub estimate: Option<f64>,
    /// Its interval at 90 %; none of rank sums, which give none.
    pub interval_90: Option<[f64; 2]>,
    /// p of any difference, two-sided.
    pub p_difference: Option<f64>,
    /// What both say at 5 %.
    pub verdict: Option<EquivalenceVerdict>,
}

/// What a hypothesis of equivalence finds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Equivalence {
    /// Differences of less than this, either way, do not matter.
    pub smallest_effect: f64,
    /// The two levels: differences are the first less the second.
    pub levels: [String; 2],
    /// Whether each person has a value at both levels, or at one.
    pub within_people: bool,
    /// People of the pairs, or of each group.
    pub people: Vec<usize>,
    /// By the linear mixed model, where that decides for other clips; none where it cannot be estimated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub for_other_clips: Option<EquivalenceT>,
    /// By ranks; what decides for these clips.
    pub by_ranks: OneSidedTests,
    /// By t.
    pub by_t: OneSidedTests,
    /// Difference of each person; none between people.
    #[serde(skip)]
    pub differences: Vec<f64>,
}

/// The difference of both levels as the test that decides estimates it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EstimatedDifference {
    /// Of the first level less the second.
    pub estimate: f64,
    pub interval_90: [f64; 2],
}

impl Equivalence {
    /// p of any difference by the test that decides for these clips or for others.
    pub(crate) fn p_difference(&self, scope: ClipScope) -> Option<f64> {
        match scope {
            ClipScope::Others => self.for_other_clips.map(|own| own.p_difference),
            ClipScope::These | ClipScope::NotTold => self.by_ranks.p_difference,
        }
    }

    /// The difference by the test that decides; for these clips by t where ranks give none.
    pub(crate) fn difference(&self, scope: ClipScope) -> Option<EstimatedDifference> {
        match scope {
            ClipScope::Others => self.for_other_clips.map(|own| EstimatedDifference {
                estimate: own.difference,
                interval_90: own.interval_90,
            }),
            ClipScope::These | ClipScope::NotTold => {
                [&self.by_ranks, &self.by_t].into_iter().find_map(|own| {
                    let (estimate, interval_90) = (own.estimate?, own.interval_90?);
                    Some(EstimatedDifference { estimate, interval_90 })
                })
            }
        }
    }
}

/// The tests of a hypothesis of equivalence.
pub(crate) struct Tested {
    pub equivalence: Equivalence,
    /// Of trials as if they were independent.
    pub trials: Vec<TestOutcome>,
    /// What decides, where other tests have theirs.
    pub people: PersonLevel,
}

/// Tests two levels within people, or two groups of people.
pub(crate) fn tested(
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    measure: &Measure,
) -> Result<Tested, NotTested> {
    let smallest = hypothesis.smallest_effect.ok_or(NotTested::NoSmallestEffect)?;
    let mut factors = super::factors(export, study, hypothesis, measure)?;
    let Some((factor, of_clips)) = factors.pop() else { return Err(NotTested::NoFactorNamed) };
    let [a, b] = factor.levels.as_slice() else {
        let (factor, levels) = (factor.name.clone(), factor.levels.len());
        return Err(NotTested::NotTwoLevels { factor, levels });
    };
    let levels = [a.clone(), b.clone()];
    let options = EquivalenceOptions::smallest_effect(smallest);
    let (trials, ..) = of_groups(&measure.numbers(), &factor, &options, &Unit::Trials);
    let (equivalence, incomplete) = match of_clips {
        true => within(export, measure, &factor, &options),
        false => {
            let means = measure.overall_person_means();
            let factor = factor.rows(&means.first_rows);
            let values = Numbers { name: measure.id.clone(), values: means.means };
            let (decides, beside, people) =
                of_groups(&values, &factor, &options, &Unit::PersonMeans);
            (Parts { people, decides, beside, differences: Vec::new() }, 0)
        }
    };
    let Parts { people, decides, beside, differences } = equivalence;
    let person_level = PersonLevel {
        people: people.iter().sum(),
        incomplete,
        overall: vec![decides.line.clone()],
        pairs: Vec::new(),
    };
    let equivalence = Equivalence {
        smallest_effect: smallest,
        levels,
        within_people: of_clips,
        people,
        for_other_clips: None,
        by_ranks: decides,
        by_t: beside,
        differences,
    };
    Ok(Tested { equivalence, trials: vec![trials.line], people: person_level })
}

/// What is computed alike within and between people.
struct Parts {
    people: Vec<usize>,
    decides: OneSidedTests,
    beside: OneSidedTests,
    differences: Vec<f64>,
}

/// Tests on person means, and how many people have no value at one of the levels.
fn within(
    export: &Export,
    measure: &Measure,
    factor: &Factor,
    options: &EquivalenceOptions,
) -> (Parts, usize) {
    let matching = measure.matching(export, factor);
    let blocks = measure.person_means(export, factor, &matching);
    let differences = blocks.differences(0, 1);
    let call = |test: &'static str| {
        bounds(
            Call::new(Design::EquivalenceOfPeople, test)
                .list(&matching.by)
                .text(&measure.id)
                .text(&factor.name)
                .list(&factor.levels),
            options,
        )
    };
    let n = differences.values.len();
    let (decides, beside) = match equivalence_of_pairs(&differences, options) {
        Err(refusal) => (none(refusal.clone()), none(refusal)),
        Ok(found) => {
            let line = TestLine::equivalence_of_pairs(
                &found,
                call(mimique_stats::EquivalenceOfPairs::NAMES.function),
            );
            let ranks = found.wilcoxon.ok();
            let decides = OneSidedTests {
                line,
                estimate: ranks.as_ref().map(|found| found.hodges_lehmann),
                interval_90: ranks.as_ref().map(|found| found.interval_90),
                p_difference: ranks.as_ref().and_then(|found| found.p_difference),
                verdict: ranks.map(|found| found.verdict),
            };
            let names = EQUIVALENCE_PAIRED_T;
            let unit = Unit::MeansWithinPeople;
            (decides, of_t(found.paired_t, names, n, unit, call(names.function)))
        }
    };
    (Parts { people: vec![n], decides, beside, differences: differences.values }, blocks.incomplete)
}

/// By rank sums and by Welch's t, and the observations of each group.
fn of_groups(
    values: &Numbers,
    factor: &Factor,
    options: &EquivalenceOptions,
    unit: &Unit,
) -> (OneSidedTests, OneSidedTests, Vec<usize>) {
    let of = |level: usize| {
        let own = factor.codes.iter().zip(&values.values);
        let own = own.filter(|(code, _)| **code != Factor::MISSING && **code as usize == level);
        Numbers { name: factor.levels[level].clone(), values: own.map(|(_, y)| *y).collect() }
    };
    let (a, b) = (of(0), of(1));
    let people = vec![a.values.len(), b.values.len()];
    let call = |test: &'static str| {
        bounds(
            Call::new(Design::EquivalenceOfGroups, test)
                .text(&values.name)
                .text(&factor.name)
                .list(&factor.levels)
                .text(unit.in_scripts()),
            options,
        )
    };
    match equivalence_of_groups(&a, &b, options) {
        Err(refusal) => (none(refusal.clone()), none(refusal), people),
        Ok(found) => {
            let line = call(EquivalenceOfGroups::NAMES.function);
            let line = TestLine::equivalence_of_groups(&found, unit, line);
            let ranks = found.mann_whitney_normal.ok();
            let decides = OneSidedTests {
                line,
                estimate: None,
                interval_90: None,
                p_difference: ranks.map(|found| found.p_difference),
                verdict: ranks.map(|found| found.verdict),
            };
            let (names, n) = (EQUIVALENCE_WELCH, people.iter().sum());
            (decides, of_t(found.welch, names, n, unit.clone(), call(names.function)), people)
        }
    }
}

fn of_t(
    found: Outcome<EquivalenceT>,
    names: TestNames,
    n: usize,
    unit: Unit,
    call: Call,
) -> OneSidedTests {
    match found {
        Outcome::Undefined { reason } => none(reason),
        Outcome::Ok(found) => OneSidedTests {
            line: Outcome::Ok(TestLine::beside(names, found.row(n), unit, call)),
            estimate: Some(found.difference),
            interval_90: Some(found.interval_90),
            p_difference: Some(found.p_difference),
            verdict: Some(found.verdict),
        },
    }
}

/// In the place of tests, why there are none.
fn none(why: impl Into<Undefined>) -> OneSidedTests {
    OneSidedTests {
        line: TestOutcome::undefined(Why::Statistic(why.into())),
        estimate: None,
        interval_90: None,
        p_difference: None,
        verdict: None,
    }
}

fn bounds(call: Call, options: &EquivalenceOptions) -> Call {
    let [low, high] = options.bounds;
    call.given(low).given(high)
}
