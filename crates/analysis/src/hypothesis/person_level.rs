//! Tests as recommended: every person counts once.

use mimique_stats::{
    Adjustment, Blocks, Factor, Friedman, HodgesLehmann, Numbers, Outcome, Term, TestNames,
    TestResult, TestRow, Wilcoxon, WilcoxonOptions, rounded, spearman,
};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;

use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::test_line::{OutcomeP, TestLine, Unit};
use crate::hypothesis::undefined::TestOutcome;
use crate::trials::export::Export;
use crate::trials::matching::Matching;
use crate::trials::measure::{Measure, as_numbers};

/// Two levels compared within people.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Pair {
    /// First level.
    pub a: String,
    /// Second level.
    pub b: String,
    /// People.
    pub n: usize,
    /// People whose mean is higher at the first level.
    pub a_higher: usize,
    /// People whose mean is higher at the second level.
    pub b_higher: usize,
    /// The smallest p that so many people can give.
    pub least_p: f64,
    /// Exact conditional Wilcoxon, Pratt.
    pub wilcoxon: TestOutcome,
    /// Hodges-Lehmann estimate of a - b, with its interval.
    pub difference: Option<HodgesLehmann>,
    /// Difference of each person.
    pub differences: Vec<f64>,
}

/// Tests on one value a person.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PersonLevel {
    /// People with a value at each level.
    pub people: usize,
    /// People without.
    pub incomplete: usize,
    /// Overall tests: Iman and Davenport's F of Friedman's test, or others.
    pub overall: Vec<TestOutcome>,
    /// Pairs, Holm-corrected.
    pub pairs: Vec<Pair>,
}

/// How the scripts take what is compared within people from the trials.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WithinDesigns {
    /// A number of each person at each level.
    blocks: Design,
    /// Each person's difference between two levels.
    pair: Design,
}

impl WithinDesigns {
    /// Of a measure, whose means are compared.
    const MEASURE: Self = Self { blocks: Design::Blocks, pair: Design::People };
    /// Of a category's detection.
    pub(crate) const DETECTION: Self =
        Self { blocks: Design::DetectionBlocks, pair: Design::DetectionPeople };
}

/// Friedman with Iman and Davenport's F, then exact paired tests with Holm's correction, of person means.
pub(crate) fn within(export: &Export, measure: &Measure, factor: &Factor) -> PersonLevel {
    within_matched(export, measure, factor, &measure.matching(export, factor))
}

/// The same of matched sets that are known.
pub(crate) fn within_matched(
    export: &Export,
    measure: &Measure,
    factor: &Factor,
    matching: &Matching,
) -> PersonLevel {
    let blocks = &measure.person_means(export, factor, matching);
    of_blocks(blocks, WithinDesigns::MEASURE, |design, test| {
        let call = Call::new(design, test).list(&matching.by).text(&measure.id);
        call.text(&factor.name).list(&factor.levels)
    })
}

/// The same of any one number of each person at each level; a call says what is taken from the trials.
pub(crate) fn of_blocks(
    blocks: &Blocks,
    designs: WithinDesigns,
    call: impl Fn(Design, &'static str) -> Call,
) -> PersonLevel {
    let n = blocks.responses.len();
    let mut overall = Vec::new();
    if blocks.groups.len() > 2 {
        overall.push(TestLine::friedman(blocks, call(designs.blocks, Friedman::NAMES.function)));
    }
    let mut pairs: Vec<Pair> = blocks
        .pairs()
        .into_iter()
        .map(|(a, b)| {
            pair(
                blocks,
                a,
                b,
                call(designs.pair, Wilcoxon::NAMES.function).number(a + 1).number(b + 1),
            )
        })
        .collect();
    let p: Vec<Option<f64>> = pairs.iter().map(|pair| pair.wilcoxon.p()).collect();
    for (pair, p_holm) in pairs.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        if let Outcome::Ok(line) = &mut pair.wilcoxon {
            line.p_holm = p_holm;
        }
    }
    PersonLevel { people: n, incomplete: blocks.incomplete, overall, pairs }
}

fn pair(blocks: &Blocks, a: usize, b: usize, call: Call) -> Pair {
    let differences = blocks.differences(a, b);
    let count = |positive: bool| {
        differences.values.iter().filter(|&&d| (d > 1e-9) == positive && d.abs() > 1e-9).count()
    };
    let n = differences.values.len();
    let (outcome, difference) = TestLine::wilcoxon(
        &differences,
        WilcoxonOptions::default(),
        &Unit::MeansWithinPeople,
        call,
    );
    Pair {
        a: blocks.groups[a].clone(),
        b: blocks.groups[b].clone(),
        n,
        a_higher: count(true),
        b_higher: count(false),
        least_p: 2.0 * 0.5f64.powi(n.min(1000) as i32),
        wilcoxon: outcome,
        difference,
        differences: differences.values,
    }
}

/// Aligned rank transform of the means of each person and combination.
pub(crate) fn two_way(export: &Export, measure: &Measure, factors: [&Factor; 2]) -> PersonLevel {
    let keys = factors.map(|factor| measure.matching_keys(export, factor));
    let matched_on = keys.each_ref().map(|keys| keys.names(export));
    let (measure, [first, second]) = &measure.matched_in_both(export, factors, &keys);
    let width = second.levels.len();
    let combinations: Vec<[&str; 2]> = first
        .levels
        .iter()
        .flat_map(|a| second.levels.iter().map(move |b| [a.as_str(), b.as_str()]))
        .collect();
    let code = |(&a, &b): (&u32, &u32)| match (a, b) {
        (Factor::MISSING, _) | (_, Factor::MISSING) => Factor::MISSING,
        (a, b) => a * width as u32 + b,
    };
    let cells = Factor {
        name: "cell".to_owned(),
        levels: combinations.iter().map(|levels| levels.join(", ")).collect(),
        codes: first.codes.iter().zip(&second.codes).map(code).collect(),
    };
    // Without the combinations that no trial has.
    let mut is_used = vec![false; combinations.len()];
    for &code in &cells.codes {
        if let Some(used) = is_used.get_mut(code as usize) {
            *used = true;
        }
    }
    let used = combinations.into_iter().zip(is_used).filter(|(_, used)| *used);
    let combinations: Vec<[&str; 2]> = used.map(|(levels, _)| levels).collect();
    let cells = cells.used();
    let blocks = measure.cell_means(export, &cells);
    let (mut values, mut people, mut level) = (Vec::new(), Vec::new(), [Vec::new(), Vec::new()]);
    for (person, means) in blocks.blocks.iter().zip(&blocks.responses) {
        for ([a, b], mean) in combinations.iter().zip(means) {
            values.push(*mean);
            people.push(person.as_str());
            level[0].push(*a);
            level[1].push(*b);
        }
    }
    let factor = |name: &str, cells: &[&str]| {
        Factor::from_cells(name, cells.iter().map(|cell| Some(*cell)), |level| level.parse().ok())
    };
    let (a, b) = (factor(&first.name, &level[0]), factor(&second.name, &level[1]));
    let person = factor("participant_id", &people);
    let values = Numbers { name: measure.id.clone(), values };
    let overall = TestLine::aligned_rank_transform(&values, [&a, &b], &person, &matched_on);
    PersonLevel {
        people: blocks.blocks.len(),
        incomplete: blocks.incomplete,
        overall,
        pairs: Vec::new(),
    }
}

/// Whether people's differences between two levels depend on something about them, a line a pair of
/// levels.
pub(crate) fn differences_by_trait(
    export: &Export,
    measure: &Measure,
    within: &Factor,
    about: &Factor,
) -> Vec<TestOutcome> {
    let matching = measure.matching(export, within);
    let means = measure.person_means_by_place(within, &matching);
    let overall = measure.overall_person_means();
    let rows: Vec<usize> = means
        .people
        .iter()
        .filter_map(|person| Some(overall.first_rows[overall.people.binary_search(person).ok()?]))
        .collect();
    let about = about.rows(&rows);
    let blocks = means.blocks(export, within);
    blocks
        .pairs()
        .into_iter()
        .map(|(a, b)| {
            let differences = Numbers {
                name: format!("{} - {}", blocks.groups[a], blocks.groups[b]),
                values: blocks.differences(a, b).values.iter().map(|d| rounded(*d)).collect(),
            };
            let unit = Unit::DifferencesOfPeople(differences.name.clone());
            let line = TestLine::of_groups(&differences, &about, &unit);
            let call = |test| {
                Call::new(Design::DifferencesByTrait, test)
                    .list(&matching.by)
                    .text(&measure.id)
                    .text(&within.name)
                    .list(&within.levels)
                    .number(a + 1)
                    .number(b + 1)
                    .text(&about.name)
                    .list(&about.levels)
            };
            line.map(|line| TestLine { call: call(line.names.function), ..line })
        })
        .collect()
}

/// One value a person against something about the person.
pub(crate) fn between(measure: &Measure, factor: &Factor) -> PersonLevel {
    let means = measure.overall_person_means();
    let factor = factor.rows(&means.first_rows);
    let people = factor.codes.iter().filter(|code| **code != Factor::MISSING).count();
    let values = Numbers { name: measure.id.clone(), values: means.means };
    let overall = TestLine::of_groups(&values, &factor, &Unit::PersonMeans);
    PersonLevel { people, incomplete: 0, overall: vec![overall], pairs: Vec::new() }
}

/// Each person's own rho of a factor of the clips and a measure, over the matched sets.
pub(crate) fn correlation_with_levels(
    export: &Export,
    measure: &Measure,
    factor: &Factor,
) -> TestOutcome {
    let matching = measure.matching(export, factor);
    let (measure, factor) = measure.at(factor, &matching.rows());
    let outcome = correlation_within_people(&as_numbers(&factor), &measure);
    outcome.map(|line| TestLine { call: line.call.list(&factor.levels).list(&matching.by), ..line })
}

/// Each person's own rho, then a signed rank test of them against zero.
pub(crate) fn correlation_within_people(x: &Numbers, measure: &Measure) -> TestOutcome {
    let name = x.name.clone();
    let mut by_person: Vec<(Vec<f64>, Vec<f64>)> = vec![Default::default(); measure.people()];
    for (i, &person) in measure.person.iter().enumerate() {
        if x.values[i].is_finite() {
            by_person[person].0.push(x.values[i]);
            by_person[person].1.push(measure.values[i]);
        }
    }
    let rhos: Vec<f64> = by_person
        .into_par_iter()
        .filter(|(x, _)| !x.is_empty())
        .filter_map(|(x, y)| {
            let column = |values| Numbers { name: String::new(), values };
            Some(spearman(&column(x), &column(y)).ok()?.ok()?.rho)
        })
        .collect();
    let rhos = Numbers { name: "rho".to_owned(), values: rhos };
    let call =
        Call::new(Design::Correlations, Wilcoxon::NAMES.function).text(&name).text(&measure.id);
    let options = WilcoxonOptions::default();
    let (line, estimate) = TestLine::wilcoxon(&rhos, options, &Unit::CorrelationsOfPeople, call);
    line.map(|line| TestLine {
        names: TestNames { effect: "median rho", effect_symbol: "median rho", ..line.names },
        row: TestRow {
            term: Term::Whole,
            effect: estimate.map(|estimate| estimate.estimate),
            ..line.row
        },
        ..line
    })
}

/// Something about each person, as numbers a value, against the person's mean.
pub(crate) fn correlation(x: &Numbers, measure: &Measure) -> PersonLevel {
    let means = measure.overall_person_means();
    let of_people = Numbers {
        name: x.name.clone(),
        values: means.first_rows.iter().map(|&row| x.values[row]).collect(),
    };
    let means = Numbers { name: measure.id.clone(), values: means.means };
    PersonLevel {
        people: means.values.len(),
        incomplete: 0,
        overall: vec![TestLine::spearman(&of_people, &means, &Unit::PersonMeans)],
        pairs: Vec::new(),
    }
}
