//! Firth's penalised likelihood: finite estimates where the answers are separated.
//!
//! The maximum of l(θ) + ln det I(θ) / 2 (Firth 1993, Biometrika 80, 27; Heinze and Schemper 2002), over all
//! parameters, the worths in the coordinates w_1 ... w_(k-1).

use nalgebra::{Cholesky, DMatrix, DVector};

use super::model::{Model, Parameters};
use crate::table::comparisons::Presentation;

/// Scoring steps, at most: near the maximum each takes off a share of the distance.
const STEPS: usize = 2000;
/// A score below this, in units of standard errors, is rounding.
const SETTLED: f64 = 1e-11;

/// Where the penalised likelihood is highest.
pub(super) struct PenalisedMaximum {
    /// The parameters.
    pub at: Parameters,
    /// l + ln det I / 2 there.
    pub height: f64,
    /// The inverse of the information there.
    pub covariance: DMatrix<f64>,
}

/// A place on the way.
struct Stand {
    at: Parameters,
    height: f64,
    covariance: DMatrix<f64>,
    score: DVector<f64>,
}

impl Model {
    /// The penalised maximum; none where the information is singular: items that no answer joins.
    pub(super) fn maximise_penalised(self, shown: &[Presentation]) -> Option<PenalisedMaximum> {
        let mut stand = self.stand(DVector::zeros(self.parameters()), shown)?;
        for _ in 0..STEPS {
            let step = &stand.covariance * &stand.score;
            // The step's length in standard errors, squared.
            if step.dot(&stand.score) <= SETTLED * SETTLED {
                break;
            }
            let Some(next) = self.higher(&stand, &step, shown) else { break };
            stand = next;
        }
        Some(PenalisedMaximum { at: stand.at, height: stand.height, covariance: stand.covariance })
    }

    fn stand(self, at: Parameters, shown: &[Presentation]) -> Option<Stand> {
        let (score, information) = self.derivatives(&at, shown);
        let factor = Cholesky::new(information)?;
        let half_ln_det: f64 = factor.l_dirty().diagonal().iter().map(|x| libm::log(*x)).sum();
        let covariance = factor.inverse();
        let height = self.log_likelihood(&at, shown) + half_ln_det;
        let score = score + self.firth_score(&at, shown, &covariance);
        height.is_finite().then_some(Stand { at, height, covariance, score })
    }

    fn higher(self, from: &Stand, step: &DVector<f64>, shown: &[Presentation]) -> Option<Stand> {
        // No parameter moves by more than 5 at once, where the quadratic says little.
        let mut share = (5.0 / step.amax()).min(1.0);
        while share > 1e-6 {
            let next = self.stand(&from.at + share * step, shown);
            match next {
                Some(next) if next.height >= from.height - 1e-12 * from.height.abs() => {
                    return Some(next);
                }
                _ => share /= 2.0,
            }
        }
        None
    }
}
