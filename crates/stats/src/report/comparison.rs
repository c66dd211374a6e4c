//! A measure against a factor: as in the thesis (trial by trial) and as recommended (one value a
//! person), side by side.

use serde::Serialize;

use super::export::Export;
use super::measure::{Measure, MeasureKind};
use crate::adjust::Adjustment;
use crate::aligned_rank_transform::aligned_rank_transform;
use crate::chi_square::{Contingency, chi_square};
use crate::describe::{Description, describe};
use crate::factor::Factor;
use crate::friedman::{Blocks, friedman};
use crate::kruskal_wallis::kruskal_wallis;
use crate::mann_whitney::mann_whitney;
use crate::outcome::{Labelled, Outcome, Refusal};
use crate::scheirer_ray_hare::{SumsOfSquares, scheirer_ray_hare};
use crate::spearman::spearman;
use crate::table::Numbers;
use crate::walsh::HodgesLehmann;
use crate::wilcoxon::{WilcoxonOptions, WilcoxonVariant, wilcoxon};

/// One test's numbers, whatever the test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct TestLine {
    /// Name and variant.
    pub test: String,
    /// What is compared, where there are several lines of one test.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub term: String,
    /// Name of the statistic: H, W+, F.
    pub statistic_name: &'static str,
    /// Its value.
    pub statistic: f64,
    /// Degrees of freedom, as written.
    pub df: String,
    /// p.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// p after Holm's correction, where several were tested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub p_holm: Option<f64>,
    /// Name of the effect size.
    pub effect_name: &'static str,
    /// Effect size.
    pub effect: Option<f64>,
    /// Observations: trials or people.
    pub n: usize,
}

/// Tests that treat trials as independent observations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct TrialLevel {
    /// Always `independent observations`, which trials of one person are not.
    pub assumes: &'static str,
    /// The tests.
    pub tests: Vec<Outcome<TestLine>>,
}

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
    pub wilcoxon: Outcome<TestLine>,
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
    pub overall: Vec<Outcome<TestLine>>,
    /// Pairs, Holm-corrected.
    pub pairs: Vec<Pair>,
}

/// A measure against a factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Comparison {
    pub measure: String,
    pub kind: MeasureKind,
    pub factor: String,
    pub levels: Vec<String>,
    /// Trials a level.
    pub descriptions: Labelled<Outcome<Description>>,
    /// Mean over people of their means, a level.
    pub person_means: Labelled<Option<f64>>,
    pub as_in_the_thesis: TrialLevel,
    pub recommended: PersonLevel,
}

const TRIALS: &str = "independent observations";

/// Compares the levels of a within-person factor.
pub(crate) fn within(export: &Export, measure: &Measure, factor: &Factor) -> Comparison {
    let blocks = measure.person_means(export, factor);
    let mut tests = vec![trial_level_overall(measure, factor)];
    if factor.levels.len() == 2 && measure.kind != MeasureKind::Recognition {
        tests.push(trial_level_wilcoxon(export, measure, factor));
    }
    let k = factor.levels.len();
    let n = blocks.responses.len() as f64;
    Comparison {
        measure: measure.id.clone(),
        kind: measure.kind,
        factor: factor.name.clone(),
        levels: factor.levels.clone(),
        descriptions: describe_levels(measure, factor),
        person_means: Labelled::zip(
            &factor.levels,
            (0..k).map(|j| {
                (n > 0.0).then(|| blocks.responses.iter().map(|row| row[j]).sum::<f64>() / n)
            }),
        ),
        as_in_the_thesis: TrialLevel { assumes: TRIALS, tests },
        recommended: person_level(&blocks),
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

/// Friedman with Iman and Davenport's F, then exact paired tests with Holm's correction.
pub(crate) fn person_level(blocks: &Blocks) -> PersonLevel {
    let n = blocks.responses.len();
    let mut overall = Vec::new();
    if blocks.groups.len() > 2 {
        overall.push(friedman_line(blocks));
    }
    let mut pairs: Vec<Pair> =
        blocks.pairs().into_iter().map(|(a, b)| pair(blocks, a, b)).collect();
    let p: Vec<Option<f64>> = pairs
        .iter()
        .map(|pair| match &pair.wilcoxon {
            Outcome::Ok(line) => Some(line.p_value),
            Outcome::Undefined { .. } => None,
        })
        .collect();
    for (pair, p_holm) in pairs.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        if let Outcome::Ok(line) = &mut pair.wilcoxon {
            line.p_holm = p_holm;
        }
    }
    PersonLevel { people: n, incomplete: blocks.incomplete, overall, pairs }
}

fn friedman_line(blocks: &Blocks) -> Outcome<TestLine> {
    match friedman(blocks) {
        Outcome::Undefined { reason } => Outcome::Undefined { reason },
        Outcome::Ok(result) => match &result.iman_davenport {
            Some(f) => Outcome::Ok(TestLine {
                test: "Friedman on person means, Iman-Davenport".to_owned(),
                term: String::new(),
                statistic_name: "F",
                statistic: f.F,
                df: format!("{}, {}", f.df1, f.df2),
                p_value: f.p_value,
                ln_p: f.ln_p,
                p_holm: None,
                effect_name: "Kendall's W",
                effect: Some(result.kendalls_w),
                n: result.n_blocks,
            }),
            None => Outcome::undefined(result.warnings.join("; ")),
        },
    }
}

fn pair(blocks: &Blocks, a: usize, b: usize) -> Pair {
    let differences = blocks.differences(a, b);
    let count = |positive: bool| {
        differences.values.iter().filter(|&&d| (d > 1e-9) == positive && d.abs() > 1e-9).count()
    };
    let n = differences.values.len();
    let (outcome, difference) = match wilcoxon(&differences, WilcoxonOptions::default()) {
        Err(refusal) => (Outcome::undefined(refusal.to_string()), None),
        Ok(Outcome::Undefined { reason }) => (Outcome::Undefined { reason }, None),
        Ok(Outcome::Ok(result)) => (
            Outcome::Ok(TestLine {
                test: format!("Wilcoxon on person means, {}", result.variant),
                term: differences.name.clone(),
                statistic_name: "W+",
                statistic: result.statistic,
                df: String::new(),
                p_value: result.p_value,
                ln_p: result.ln_p,
                p_holm: None,
                effect_name: "rank-biserial",
                effect: Some(result.rank_biserial),
                n: result.n_pairs,
            }),
            Some(result.hodges_lehmann_ci),
        ),
    };
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

/// Kruskal-Wallis of trials; for right and wrong answers the chi-square test.
pub(crate) fn trial_level_overall(measure: &Measure, factor: &Factor) -> Outcome<TestLine> {
    if measure.kind == MeasureKind::Recognition {
        let answers = Factor::from_cells(
            &measure.id,
            measure.values.iter().map(|&value| Some(if value > 0.5 { "right" } else { "wrong" })),
            |_| None,
        );
        return trial_level_chi_square(factor, &answers);
    }
    let test = "Kruskal-Wallis of trials";
    from_refusal(kruskal_wallis(&measure.numbers(), factor).map(|outcome| {
        outcome.map(|result| TestLine {
            test: test.to_owned(),
            term: String::new(),
            statistic_name: "H",
            statistic: result.statistic,
            df: result.df.to_string(),
            p_value: result.p_value,
            ln_p: result.ln_p,
            p_holm: None,
            effect_name: "epsilon squared",
            effect: Some(result.epsilon_squared),
            n: result.n,
        })
    }))
}

/// Chi-square of trials.
pub(crate) fn trial_level_chi_square(factor: &Factor, answers: &Factor) -> Outcome<TestLine> {
    let result = Contingency::of(factor, answers).and_then(|table| chi_square(&table));
    from_refusal(result.map(|result| {
        let chosen = &result.default_yates_if_2x2;
        Outcome::Ok(TestLine {
            test: "chi-square of trials".to_owned(),
            term: String::new(),
            statistic_name: "chi-square",
            statistic: chosen.statistic,
            df: chosen.df.to_string(),
            p_value: chosen.p_value,
            ln_p: chosen.ln_p,
            p_holm: None,
            effect_name: "Cramer's V",
            effect: Some(result.cramers_v),
            n: result.n as usize,
        })
    }))
}

/// Wilcoxon as R of 2019 on matched trials of two levels.
pub(crate) fn trial_level_wilcoxon(
    export: &Export,
    measure: &Measure,
    factor: &Factor,
) -> Outcome<TestLine> {
    let blocks = measure.matched_trials(export, factor);
    if blocks.responses.is_empty() {
        return Outcome::undefined("no trials of one person differ in this factor only");
    }
    let differences = blocks.differences(0, 1);
    let options = WilcoxonOptions { variant: WilcoxonVariant::Thesis, ..Default::default() };
    from_refusal(wilcoxon(&differences, options).map(|outcome| {
        outcome.map(|result| TestLine {
            test: format!("Wilcoxon of trials, {}", result.variant),
            term: differences.name.clone(),
            statistic_name: "W+",
            statistic: result.statistic,
            df: String::new(),
            p_value: result.p_value,
            ln_p: result.ln_p,
            p_holm: None,
            effect_name: "rank-biserial",
            effect: Some(result.rank_biserial),
            n: result.n_pairs,
        })
    }))
}

/// Mann-Whitney of trials.
pub(crate) fn trial_level_mann_whitney(measure: &Measure, factor: &Factor) -> Outcome<TestLine> {
    mann_whitney_line(&measure.numbers(), factor, "Mann-Whitney of trials")
}

fn mann_whitney_line(values: &Numbers, factor: &Factor, test: &str) -> Outcome<TestLine> {
    from_refusal(mann_whitney(values, factor).map(|outcome| {
        outcome.map(|result| TestLine {
            test: test.to_owned(),
            term: result.pair.clone(),
            statistic_name: "U",
            statistic: result.statistic,
            df: String::new(),
            p_value: result.p_value,
            ln_p: result.ln_p,
            p_holm: None,
            effect_name: "rank-biserial",
            effect: Some(result.rank_biserial),
            n: result.n,
        })
    }))
}

/// Scheirer-Ray-Hare of trials with the sums of squares of the thesis's tool (type I): three lines.
pub(crate) fn trial_level_two_way(
    measure: &Measure,
    factors: [&Factor; 2],
) -> Vec<Outcome<TestLine>> {
    match scheirer_ray_hare(&measure.numbers(), factors, SumsOfSquares::One) {
        Err(refusal) => vec![Outcome::undefined(refusal.to_string())],
        Ok(Outcome::Undefined { reason }) => vec![Outcome::Undefined { reason }],
        Ok(Outcome::Ok(result)) => (0..3)
            .map(|effect| {
                let table = &result.type1;
                match (table.H[effect], table.p[effect], table.ln_p[effect]) {
                    (Some(h), Some(p_value), Some(ln_p)) => Outcome::Ok(TestLine {
                        test: "Scheirer-Ray-Hare of trials, type I".to_owned(),
                        term: result.effects[effect].clone(),
                        statistic_name: "H",
                        statistic: h,
                        df: table.df[effect].to_string(),
                        p_value,
                        ln_p,
                        p_holm: None,
                        effect_name: "eta squared H",
                        effect: table.eta_squared_H[effect],
                        n: result.n,
                    }),
                    _ => Outcome::undefined(format!(
                        "{}: no degrees of freedom are left",
                        result.effects[effect]
                    )),
                }
            })
            .collect(),
    }
}

/// Aligned rank transform of the means of each person and combination.
pub(crate) fn person_level_two_way(
    export: &Export,
    measure: &Measure,
    factors: [&Factor; 2],
) -> PersonLevel {
    let [first, second] = factors;
    let joined: Vec<Option<String>> = (0..measure.values.len())
        .map(|i| Some(format!("{}\u{1f}{}", first.level(i)?, second.level(i)?)))
        .collect();
    let cells = Factor::from_cells("cell", joined.iter().map(Option::as_deref), |_| None);
    let blocks = measure.person_means(export, &cells);
    let (mut values, mut people, mut level) = (Vec::new(), Vec::new(), [Vec::new(), Vec::new()]);
    for (person, means) in blocks.blocks.iter().zip(&blocks.responses) {
        for (cell, mean) in blocks.groups.iter().zip(means) {
            if let Some((a, b)) = cell.split_once('\u{1f}') {
                values.push(*mean);
                people.push(person.as_str());
                level[0].push(a);
                level[1].push(b);
            }
        }
    }
    let factor = |name: &str, cells: &[&str]| {
        Factor::from_cells(name, cells.iter().map(|cell| Some(*cell)), |level| level.parse().ok())
    };
    let (a, b) = (factor(&first.name, &level[0]), factor(&second.name, &level[1]));
    let person = factor("participant_id", &people);
    let values = Numbers { name: measure.id.clone(), values };
    let overall = match aligned_rank_transform(&values, &[&a, &b], &person) {
        Err(refusal) => vec![Outcome::undefined(refusal.to_string())],
        Ok(Outcome::Undefined { reason }) => vec![Outcome::Undefined { reason }],
        Ok(Outcome::Ok(result)) => result
            .effects
            .iter()
            .map(|effect| match (effect.F, effect.p_value, effect.ln_p) {
                (Some(f), Some(p_value), Some(ln_p)) => Outcome::Ok(TestLine {
                    test: "aligned rank transform of person means".to_owned(),
                    term: effect.term.clone(),
                    statistic_name: "F",
                    statistic: f,
                    df: format!("{}, {}", effect.df1, effect.df2),
                    p_value,
                    ln_p,
                    p_holm: None,
                    effect_name: "partial eta squared",
                    effect: Some({
                        let explained = f * effect.df1 as f64;
                        explained / (explained + effect.df2 as f64)
                    }),
                    n: result.n_blocks,
                }),
                _ => Outcome::undefined(format!("{}: no residual is left", effect.term)),
            })
            .collect(),
    };
    PersonLevel {
        people: blocks.blocks.len(),
        incomplete: blocks.incomplete,
        overall,
        pairs: Vec::new(),
    }
}

/// One value a person against something about the person.
pub(crate) fn between(measure: &Measure, factor: &Factor) -> PersonLevel {
    let means = measure.overall_person_means();
    let first_rows = measure.first_rows();
    let first_row: Vec<usize> =
        means.keys().filter_map(|person| first_rows.get(person).copied()).collect();
    let factor = factor.rows(&first_row);
    let values = Numbers { name: measure.id.clone(), values: means.values().copied().collect() };
    let overall = if factor.levels.len() == 2 {
        mann_whitney_line(&values, &factor, "Mann-Whitney of person means")
    } else {
        from_refusal(kruskal_wallis(&values, &factor).map(|outcome| {
            outcome.map(|result| TestLine {
                test: "Kruskal-Wallis of person means".to_owned(),
                term: String::new(),
                statistic_name: "H",
                statistic: result.statistic,
                df: result.df.to_string(),
                p_value: result.p_value,
                ln_p: result.ln_p,
                p_holm: None,
                effect_name: "epsilon squared",
                effect: Some(result.epsilon_squared),
                n: result.n,
            })
        }))
    };
    PersonLevel { people: means.len(), incomplete: 0, overall: vec![overall], pairs: Vec::new() }
}

/// Spearman of trials, or of person means where the variable is about the person.
pub(crate) fn correlation(x: &Numbers, y: &Numbers, test: &str) -> Outcome<TestLine> {
    from_refusal(spearman(x, y).map(|outcome| match outcome {
        Outcome::Undefined { reason } => Outcome::Undefined { reason },
        Outcome::Ok(result) => match result.p_value {
            Some(p_value) => Outcome::Ok(TestLine {
                test: test.to_owned(),
                term: format!("{} ~ {}", y.name, x.name),
                statistic_name: "rho",
                statistic: result.rho,
                df: result.df.to_string(),
                p_value,
                ln_p: p_value.ln(),
                p_holm: None,
                effect_name: "rho",
                effect: Some(result.rho),
                n: result.n,
            }),
            None => Outcome::undefined(result.warnings.join("; ")),
        },
    }))
}

/// Each person's own rho, then a signed rank test of them against zero.
pub(crate) fn correlation_within_people(x: &[f64], measure: &Measure) -> Outcome<TestLine> {
    let mut by_person: std::collections::BTreeMap<usize, (Vec<f64>, Vec<f64>)> = Default::default();
    for (i, &person) in measure.person.iter().enumerate() {
        if x[i].is_finite() {
            let cell = by_person.entry(person).or_default();
            cell.0.push(x[i]);
            cell.1.push(measure.values[i]);
        }
    }
    let rhos: Vec<f64> = by_person
        .into_values()
        .filter_map(|(x, y)| {
            let column = |values| Numbers { name: String::new(), values };
            Some(spearman(&column(x), &column(y)).ok()?.ok()?.rho)
        })
        .collect();
    let rhos = Numbers { name: "rho".to_owned(), values: rhos };
    from_refusal(wilcoxon(&rhos, WilcoxonOptions::default()).map(|outcome| {
        outcome.map(|result| TestLine {
            test: "Wilcoxon of each person's rho".to_owned(),
            term: String::new(),
            statistic_name: "W+",
            statistic: result.statistic,
            df: String::new(),
            p_value: result.p_value,
            ln_p: result.ln_p,
            p_holm: None,
            effect_name: "median rho",
            effect: Some(result.hodges_lehmann_walsh_median),
            n: result.n_pairs,
        })
    }))
}

fn from_refusal(result: Result<Outcome<TestLine>, Refusal>) -> Outcome<TestLine> {
    result.unwrap_or_else(|refusal| Outcome::undefined(refusal.to_string()))
}
