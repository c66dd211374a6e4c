//! Maximum likelihood difference scaling: how a perceived difference grows with a parameter (Maloney and Yang
//! 2003, Journal of Vision 3(8):5; Knoblauch and Maloney 2008).
//!
//! Of two pairs of levels, (a, b) and (c, d), the answer says whether the second differs more:
//! P = Φ(|ψ_d - ψ_c| - |ψ_b - ψ_a|), ψ rising. A triad a, b, c is the pairs (a, b) and (b, c). The lowest level
//! has ψ = 0, the unit is the standard deviation of the judgement.

use mimique_locale::format_number;
use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;

use crate::distributions::tail::normal_upper;
use crate::estimate::resampled::percentiles;
use crate::numerics::random::Stream;
use crate::numerics::recession::{Recession, rank, recession};
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, DEFAULT_ROUNDS, ProcedureOption, ROUNDS, SEED};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::{Refusal, Unfit};
use crate::table::Table;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::undefined::NoEstimate;

/// Newton's steps, at most; the likelihood is concave.
const STEPS: usize = 100;
/// A step below this is rounding.
const SETTLED: f64 = 1e-12;

/// One answer about two pairs of levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DifferenceJudgement {
    /// Place of the participant; all 0 where nobody is told apart.
    pub participant: usize,
    /// Levels of the first pair, then of the second.
    pub levels: [f64; 4],
    /// Whether the second pair differs more.
    pub second_differs_more: bool,
}

/// Result of [`difference_scaling`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DifferenceScale {
    /// Always `difference-scaling`.
    pub test: &'static str,
    /// Answers.
    pub trials: usize,
    /// Participants.
    pub participants: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// The levels, ascending.
    pub levels: Vec<f64>,
    /// ψ of each level; the first is 0.
    pub scale: Vec<f64>,
    /// Standard errors; the first is 0.
    pub se: Vec<f64>,
    /// The standard deviation of the judgement where the highest level has 1; none where that has no positive
    /// ψ.
    pub sigma_if_scale_ends_at_1: Option<f64>,
    /// ψ where the highest level has 1.
    pub scale_to_1: Option<Vec<f64>>,
    /// Log likelihood.
    pub loglik: f64,
    /// Percentile intervals at 95 % of ψ over resampled participants; none with fewer than two, or without draws.
    pub interval: Option<Vec<[f64; 2]>>,
    /// Draws of participants.
    pub rounds: usize,
    /// Draws whose answers were separated or did not tell all levels: left out.
    pub without_scale: usize,
    /// The seed of the draws.
    pub seed: u64,
}

/// The scale of the levels. Undefined where answers do not tell all levels, or are separated.
pub fn difference_scaling(
    judgements: &[DifferenceJudgement],
    rounds: usize,
    seed: u64,
) -> Result<Outcome<DifferenceScale>, Refusal> {
    let levels = levels(judgements);
    if levels.len() < 3 {
        return Err(Unfit::TooFewStimulusLevels { levels: levels.len(), needed: 3 }.into());
    }
    let rows: Vec<Row> = judgements.iter().map(|own| Row::of(own, &levels)).collect();
    let found = match fit(&rows, levels.len()) {
        Err(why) => return Ok(Outcome::undefined(why)),
        Ok(found) => found,
    };
    let participants = judgements.iter().map(|own| own.participant + 1).max().unwrap_or(0);
    let draws = resampled(judgements, &rows, levels.len(), participants, rounds, seed);
    let kept: Vec<&Vec<f64>> = draws.iter().flatten().collect();
    let interval = |level: usize| percentiles(kept.iter().map(|draw| draw[level]).collect());
    let last = found.scale[levels.len() - 1];
    Ok(Outcome::Ok(DifferenceScale {
        test: "difference-scaling",
        trials: judgements.len(),
        participants,
        dropped: 0,
        sigma_if_scale_ends_at_1: (last > 0.0).then(|| 1.0 / last),
        scale_to_1: (last > 0.0).then(|| found.scale.iter().map(|psi| psi / last).collect()),
        interval: (0..levels.len()).map(interval).collect(),
        rounds: draws.len(),
        without_scale: draws.iter().filter(|draw| draw.is_none()).count(),
        seed,
        levels,
        scale: found.scale,
        se: found.se,
        loglik: found.log_likelihood,
    }))
}

fn levels(judgements: &[DifferenceJudgement]) -> Vec<f64> {
    let mut levels: Vec<f64> = judgements.iter().flat_map(|own| own.levels).collect();
    levels.sort_unstable_by(f64::total_cmp);
    levels.dedup();
    levels
}

/// By how much the second pair's difference exceeds the first's, a whole number of each ψ but the lowest
/// level's; and the answer.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    of_level: Vec<i64>,
    second: bool,
}

impl Row {
    fn of(judgement: &DifferenceJudgement, levels: &[f64]) -> Self {
        let place = |level: f64| levels.partition_point(|own| *own < level);
        let mut of_level = vec![0; levels.len()];
        let mut add = |one: f64, other: f64, sign: i64| {
            of_level[place(one.max(other))] += sign;
            of_level[place(one.min(other))] -= sign;
        };
        let [a, b, c, d] = judgement.levels;
        add(a, b, -1);
        add(c, d, 1);
        of_level.remove(0);
        Self { of_level, second: judgement.second_differs_more }
    }
}

struct Found {
    scale: Vec<f64>,
    se: Vec<f64>,
    log_likelihood: f64,
}

/// ln Φ(z), and φ(z) / Φ(z).
fn probit(z: f64) -> (f64, f64) {
    let ln_p = normal_upper(-z).ln_p;
    let ln_density = -0.5 * z * z - 0.5 * libm::log(2.0 * std::f64::consts::PI);
    (ln_p, libm::exp(ln_density - ln_p))
}

fn fit(rows: &[Row], levels: usize) -> Result<Found, NoEstimate> {
    let size = levels - 1;
    let plain: Vec<Vec<i64>> = rows.iter().map(|row| row.of_level.clone()).collect();
    if rank(&plain, size).is_some_and(|rank| rank < size) {
        return Err(NoEstimate::LevelsNotTold);
    }
    let signed = |row: &Row| {
        let sign = if row.second { 1 } else { -1 };
        row.of_level.iter().map(|x| sign * x).collect()
    };
    let signed: Vec<Vec<i64>> = rows.iter().map(signed).collect();
    if matches!(recession(&signed, size), Recession::Along(_)) {
        return Err(NoEstimate::JudgementsSeparated);
    }
    let x = DMatrix::from_fn(signed.len(), size, |row, level| signed[row][level] as f64);
    let height = |psi: &DVector<f64>| (&x * psi).iter().map(|z| probit(*z).0).sum::<f64>();
    let derivatives = |psi: &DVector<f64>| {
        let z = &x * psi;
        let ratio = z.map(|z| probit(z).1);
        let weight = DVector::from_fn(z.len(), |row, _| ratio[row] * (ratio[row] + z[row]));
        let mut weighed = x.clone();
        for (mut row, weight) in weighed.row_iter_mut().zip(weight.iter()) {
            row *= *weight;
        }
        (x.tr_mul(&ratio), x.tr_mul(&weighed))
    };
    let mut psi = DVector::from_element(size, 0.0);
    let mut own = height(&psi);
    for _ in 0..STEPS {
        let (score, information) = derivatives(&psi);
        let Some(factor) = Cholesky::new(information) else { return Err(NoEstimate::Singular) };
        let step = factor.solve(&score);
        let mut share = 1.0;
        while share > 1e-6 && height(&(&psi + share * &step)) < own - 1e-12 * own.abs() {
            share /= 2.0;
        }
        psi += share * &step;
        own = height(&psi);
        if step.amax() * share <= SETTLED * (1.0 + psi.amax()) {
            break;
        }
    }
    let inverse = Cholesky::new(derivatives(&psi).1).ok_or(NoEstimate::Singular)?.inverse();
    let with_first = |values: DVector<f64>| {
        std::iter::once(0.0).chain(values.iter().copied()).collect::<Vec<f64>>()
    };
    Ok(Found {
        scale: with_first(psi),
        se: with_first(inverse.diagonal().map(|variance| variance.max(0.0).sqrt())),
        log_likelihood: own,
    })
}

/// The scale of each draw of participants; none inside where it has none. Empty with fewer than two participants.
fn resampled(
    judgements: &[DifferenceJudgement],
    rows: &[Row],
    levels: usize,
    participants: usize,
    rounds: usize,
    seed: u64,
) -> Vec<Option<Vec<f64>>> {
    if participants < 2 {
        return Vec::new();
    }
    let mut of_participant = vec![Vec::new(); participants];
    for (own, row) in judgements.iter().zip(rows) {
        of_participant[own.participant].push(row.clone());
    }
    let draw = |round: usize| {
        let mut stream = Stream::new(seed, round as u64);
        let drawn: Vec<Row> = (0..participants)
            .flat_map(|_| of_participant[stream.below(participants)].iter().cloned())
            .collect();
        fit(&drawn, levels).ok().map(|found| found.scale)
    };
    (0..rounds).into_par_iter().map(draw).collect()
}

/// `mimique test difference-scaling`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "difference-scaling",
    question: "How does a perceived difference grow with a parameter? Difference scaling (MLDS)",
    options: &[&[
        ProcedureOption::list(
            "levels",
            "Columns of the levels: three of a triad, or four of two pairs",
        )
        .required(),
        ProcedureOption::text("answer", "Column: 1 where the second pair differs more, else 0")
            .required(),
        ProcedureOption::text("participant", "Column of the participants, for intervals"),
        ROUNDS,
        SEED,
    ]],
    run,
    sample: Sample::Coefficient,
    r: r#"
# Maximum likelihood difference scaling; `levels` has a row per trial: three of a triad, or four of two pairs.
difference_scaling <- function(levels, answer) {
  if (ncol(levels) == 3) levels <- levels[, c(1, 2, 2, 3)]
  known <- sort(unique(c(levels)))
  x <- t(apply(levels, 1, function(own) {
    place <- match(own, known)
    row <- numeric(length(known))
    row[max(place[3:4])] <- row[max(place[3:4])] + 1
    row[min(place[3:4])] <- row[min(place[3:4])] - 1
    row[max(place[1:2])] <- row[max(place[1:2])] - 1
    row[min(place[1:2])] <- row[min(place[1:2])] + 1
    row
  }))[, -1]
  fit <- glm.fit(x, answer, family = binomial("probit"), intercept = FALSE,
    control = glm.control(epsilon = 1e-14, maxit = 200))
  psi <- unname(fit$coefficients)
  # Standard errors by the observed information.
  signed <- x * ifelse(answer == 1, 1, -1)
  z <- drop(signed %*% psi)
  ratio <- exp(dnorm(z, log = TRUE) - pnorm(z, log.p = TRUE))
  se <- sqrt(diag(solve(crossprod(signed, ratio * (ratio + z) * signed))))
  named <- function(name, values) setNames(c(0, values), paste(name, seq_along(known), sep = "."))
  c(named("psi", psi), named("se", se), loglik = -fit$deviance / 2)
}
"#,
    python: r#"
def difference_scaling(levels, answer):
    """Maximum likelihood difference scaling; a row per trial: three levels of a triad, or four of two
    pairs."""
    from scipy.optimize import minimize

    if levels.shape[1] == 3:
        levels = levels[:, [0, 1, 1, 2]]
    known, place = np.unique(levels, return_inverse=True)
    place = place.reshape(levels.shape)
    x = np.zeros((len(levels), len(known)))
    rows = np.arange(len(levels))
    for columns, sign in (([2, 3], 1), ([0, 1], -1)):
        np.add.at(x, (rows, place[:, columns].max(axis=1)), sign)
        np.add.at(x, (rows, place[:, columns].min(axis=1)), -sign)
    x = x[:, 1:] * np.where(answer == 1, 1, -1)[:, None]

    def minus_likelihood(psi):
        return -stats.norm.logcdf(x @ psi).sum()

    def slope(psi):
        z = x @ psi
        return -x.T @ np.exp(stats.norm.logpdf(z) - stats.norm.logcdf(z))

    found = minimize(minus_likelihood, np.zeros(len(known) - 1), jac=slope, method="BFGS", options=dict(gtol=1e-10))
    z = x @ found.x
    ratio = np.exp(stats.norm.logpdf(z) - stats.norm.logcdf(z))
    # Standard errors by the observed information.
    se = np.sqrt(np.diag(np.linalg.inv(x.T @ ((ratio * (ratio + z))[:, None] * x))))
    named = {"psi.1": 0.0, "se.1": 0.0, "loglik": -found.fun}
    for place, (psi, error) in enumerate(zip(found.x, se)):
        named.update({f"psi.{place + 2}": psi, f"se.{place + 2}": error})
    return named
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let names = arguments.list("levels");
    if !(3..=4).contains(&names.len()) {
        return Err(Unfit::NumberOfLevelColumns { named: names.len() }.into());
    }
    let columns = names.iter().map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let answer = arguments.numbers(table, "answer")?;
    let people =
        arguments.text("participant").map(|name| table.combined_factor(name)).transpose()?;
    let mut used: Vec<_> = columns.iter().collect();
    used.push(&answer);
    let factors: Vec<&Factor> = people.iter().collect();
    let complete = complete_rows(&used, &factors)?;
    let rows = complete.to_vec();
    let people = people.map(|factor| factor.rows(&rows));
    let mut judgements = Vec::with_capacity(rows.len());
    for (at, &row) in rows.iter().enumerate() {
        let given = answer.values[row];
        if given != 0.0 && given != 1.0 {
            let (column, line) = (answer.name.clone(), table.line(row));
            return Err(Unfit::NotZeroOrOne { column, line, value: given }.into());
        }
        let own = |place: usize| columns[place].values[row];
        let levels = match columns.len() {
            3 => [own(0), own(1), own(1), own(2)],
            _ => [own(0), own(1), own(2), own(3)],
        };
        let participant = people.as_ref().map_or(0, |factor| factor.codes[at] as usize);
        judgements.push(DifferenceJudgement {
            participant,
            levels,
            second_differs_more: given == 1.0,
        });
    }
    let rounds = if people.is_some() { arguments.whole("rounds", DEFAULT_ROUNDS)? } else { 0 };
    let outcome = difference_scaling(&judgements, rounds as usize, arguments.whole("seed", 1)?)?;
    let dropped = complete.dropped();
    Ok(Answer::of(&outcome.map(|found| DifferenceScale { dropped, ..found }), words))
}

fn words(result: &DifferenceScale) -> String {
    let mut lines = Lines::default();
    lines.add(format!(
        "Difference scale of {} levels, {} answers{}",
        result.levels.len(),
        result.trials,
        lines::dropped(result.dropped)
    ));
    let mut rows = vec![lines::row(["level", "scale", "se", "to 1", "95 % interval"])];
    for (at, level) in result.levels.iter().enumerate() {
        let interval = result.interval.as_ref().map(|all| all[at]);
        rows.push(vec![
            format_number(*level),
            format_number(result.scale[at]),
            format_number(result.se[at]),
            lines::optional(result.scale_to_1.as_ref().map(|scale| scale[at])),
            interval.map_or_else(String::new, |[low, high]| {
                format!("{} to {}", format_number(low), format_number(high))
            }),
        ]);
    }
    lines.table(&rows);
    lines.add(format!(
        "unit: the standard deviation of the judgement, {} where the scale ends at 1",
        lines::optional(result.sigma_if_scale_ends_at_1)
    ));
    if result.rounds > 0 {
        lines.add(format!(
            "intervals: {} draws of participants, {} without a scale left out",
            result.rounds, result.without_scale
        ));
    }
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    const TRUTH: [f64; 6] = [0.0, 0.6, 1.6, 2.2, 4.0, 4.4];

    fn judged(people: usize, trials: usize, seed: u64) -> Vec<DifferenceJudgement> {
        let mut random = Random::new(seed);
        let mut all = Vec::new();
        for participant in 0..people {
            for _ in 0..trials {
                let mut place = || (random.uniform() * 6.0) as usize;
                let [a, b, c, d] = [place(), place(), place(), place()];
                let difference =
                    (TRUTH[d] - TRUTH[c]).abs() - (TRUTH[b] - TRUTH[a]).abs() + random.normal();
                all.push(DifferenceJudgement {
                    participant,
                    levels: [a, b, c, d].map(|place| place as f64 / 10.0),
                    second_differs_more: difference > 0.0,
                });
            }
        }
        all
    }

    #[test]
    fn a_planted_scale_is_found_within_its_errors() {
        let found = difference_scaling(&judged(20, 200, 4), 200, 1).unwrap().ok().unwrap();
        for ((psi, se), truth) in found.scale.iter().zip(&found.se).zip(TRUTH) {
            assert!((psi - truth).abs() <= 3.5 * se, "{psi} {truth} {se}");
        }
        let intervals = found.interval.unwrap();
        assert!(intervals[5][0] < found.scale[5] && found.scale[5] < intervals[5][1]);
        let sigma = found.sigma_if_scale_ends_at_1.unwrap();
        assert!((sigma * found.scale[5] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn exchanging_pairs_or_levels_of_a_pair_changes_nothing() {
        let plain = judged(1, 400, 9);
        let exchanged: Vec<DifferenceJudgement> = plain
            .iter()
            .map(|own| {
                let [a, b, c, d] = own.levels;
                let second_differs_more = !own.second_differs_more;
                DifferenceJudgement { levels: [d, c, b, a], second_differs_more, ..*own }
            })
            .collect();
        let of = |all: &[DifferenceJudgement]| difference_scaling(all, 0, 1).unwrap().ok().unwrap();
        let (one, other) = (of(&plain), of(&exchanged));
        for (a, b) in one.scale.iter().zip(&other.scale) {
            assert!((a - b).abs() < 1e-10, "{a} {b}");
        }
    }

    #[test]
    fn separated_and_untold_levels_are_undefined_and_two_levels_refused() {
        let sure: Vec<DifferenceJudgement> = judged(1, 60, 2)
            .into_iter()
            .map(|own| {
                let [a, b, c, d] = own.levels;
                let second_differs_more = (d - c).abs() > (b - a).abs();
                DifferenceJudgement { second_differs_more, ..own }
            })
            .collect();
        let why = difference_scaling(&sure, 0, 1).unwrap();
        assert_eq!(why.reason(), Some(&NoEstimate::JudgementsSeparated.into()));
        // 0.3 and 0.4 are only ever shown together, against themselves.
        let one =
            |levels| DifferenceJudgement { participant: 0, levels, second_differs_more: true };
        let untold =
            [one([0.0, 0.1, 0.1, 0.2]), one([0.1, 0.2, 0.0, 0.1]), one([0.3, 0.4, 0.3, 0.4])];
        let why = difference_scaling(&untold, 0, 1).unwrap();
        assert_eq!(why.reason(), Some(&NoEstimate::LevelsNotTold.into()));
        assert!(difference_scaling(&[one([0.0, 0.1, 0.0, 0.1])], 0, 1).is_err());
    }
}
