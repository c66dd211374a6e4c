//! Whether the model describes the answers: G2 and X2 over ordered presentations.

use serde::Serialize;

use super::model::{Model, Parameters};
use super::resample::parametric_p;
use crate::distributions::tail::chi_square_upper;
use crate::table::comparisons::Presentation;

/// Test of the model against a table with a share of its own for each answer of each presentation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct LackOfFit {
    /// 2 Σ O ln(O / E).
    pub G2: f64,
    /// Σ (O - E)² / E.
    pub X2: f64,
    /// Presentations x (answers - 1) - parameters.
    pub df: usize,
    /// Upper chi-square tail of G2; none without degrees of freedom.
    pub p_G2: Option<f64>,
    /// Upper chi-square tail of X2.
    pub p_X2: Option<f64>,
    /// Presentations: pairs in one order that were shown.
    pub cells: usize,
    /// The smallest expected count. Below 5 the tails are not to be trusted, and the drawn p is given.
    pub least_expected: f64,
    /// Of G2 and X2, p by drawing answers from the model; none where no expected count is small.
    pub p_drawn: Option<[f64; 2]>,
}

/// Expected counts below this make the chi-square tails doubtful (Cochran 1954).
const SMALL: f64 = 5.0;

/// Both statistics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Deviance {
    pub g2: f64,
    pub x2: f64,
    least_expected: f64,
}

/// Distance of counts from what the model expects.
pub(super) fn deviance(model: Model, at: &Parameters, shown: &[Presentation]) -> Deviance {
    let worth = model.worth(at);
    let mut found = Deviance { g2: 0.0, x2: 0.0, least_expected: f64::INFINITY };
    for p in shown {
        let ln_p = model.ln_p(at, &worth, (p.left, p.right));
        let total = p.counts.iter().sum::<u64>() as f64;
        let answers = [0, 1, 2].into_iter().filter(|answer| model.ties || *answer != 1);
        for answer in answers {
            let (observed, expected) = (p.counts[answer] as f64, total * libm::exp(ln_p[answer]));
            if observed > 0.0 {
                found.g2 += 2.0 * observed * (libm::log(observed / total) - ln_p[answer]);
            }
            if expected > 0.0 {
                found.x2 += (observed - expected) * (observed - expected) / expected;
            }
            found.least_expected = found.least_expected.min(expected);
        }
    }
    found
}

impl LackOfFit {
    /// Of the estimates; `rounds` draws where an expected count is small.
    pub(super) fn of(
        model: Model,
        at: &Parameters,
        shown: &[Presentation],
        rounds: usize,
        seed: u64,
    ) -> Self {
        let found = deviance(model, at, shown);
        let free = shown.len() * (model.answers() - 1);
        let df = free.saturating_sub(model.parameters());
        let tail = |statistic: f64| (df > 0).then(|| chi_square_upper(statistic, df as f64).p);
        let drawn = df > 0 && rounds > 0 && found.least_expected < SMALL;
        Self {
            G2: found.g2,
            X2: found.x2,
            df,
            p_G2: tail(found.g2),
            p_X2: tail(found.x2),
            cells: shown.len(),
            least_expected: found.least_expected,
            p_drawn: drawn.then(|| parametric_p(model, at, shown, found, rounds, seed)),
        }
    }
}
