//! Standardised effect sizes with 95 % intervals, without a test.

mod cliff_delta;
mod concordance;
mod paired_dominance;
mod standardised_difference;
#[cfg(test)]
mod tests;

use serde::Serialize;

use crate::test::spearman::{bonett_wright_interval, fisher_interval};

pub use cliff_delta::cliff_delta;
pub use concordance::kendall_w_interval;
pub use paired_dominance::paired_dominance;
pub use standardised_difference::standardised_difference;

/// A standardised effect size: a number without a unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EffectSize {
    /// Which one.
    pub kind: EffectSizeKind,
    /// The estimate.
    pub estimate: f64,
    /// 95 % interval; `None` where the data do not determine one.
    pub interval_95: Option<[f64; 2]>,
    /// Number of participants, pairs or blocks.
    pub n: usize,
}

/// The effect sizes that have an interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EffectSizeKind {
    /// Mean of the differences divided by their standard deviation, without Hedges's correction.
    CohenDz,
    /// Share of positive less share of negative differences; zeros count in the denominator.
    PairedDominance,
    /// The same of two independent groups: P(a > b) - P(a < b).
    CliffDelta,
    /// Kendall's coefficient of concordance.
    KendallW,
    /// Spearman's rank correlation.
    SpearmanRho,
    /// Pearson's correlation.
    PearsonR,
}

impl EffectSizeKind {
    /// The symbol in tables and papers.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::CohenDz => "d_z",
            Self::PairedDominance => "d_w",
            Self::CliffDelta => "delta",
            Self::KendallW => "W",
            Self::SpearmanRho => "rho",
            Self::PearsonR => "r",
        }
    }

    /// Whether its absolute value cannot exceed 1, so that APA style prints no zero before the point.
    pub fn is_bounded(self) -> bool {
        self != Self::CohenDz
    }
}

impl EffectSize {
    /// Kendall's W of `n` blocks and `k` groups, with [`kendall_w_interval`].
    pub fn kendall_w(w: f64, n: usize, k: usize) -> Self {
        let interval_95 = kendall_w_interval(w, n, k);
        Self { kind: EffectSizeKind::KendallW, estimate: w, interval_95, n }
    }

    /// Spearman's rho of `n` pairs, with Bonett and Wright's interval.
    pub fn spearman(rho: f64, n: usize) -> Self {
        let interval_95 = bonett_wright_interval(rho, n);
        Self { kind: EffectSizeKind::SpearmanRho, estimate: rho, interval_95, n }
    }

    /// Pearson's r of `n` pairs, with Fisher's interval.
    pub fn pearson(r: f64, n: usize) -> Self {
        let interval_95 = fisher_interval(r, n);
        Self { kind: EffectSizeKind::PearsonR, estimate: r, interval_95, n }
    }
}
