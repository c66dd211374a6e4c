//! What a linear mixed model gives back.

use serde::Serialize;

use crate::outcome::Labelled;

/// An estimate with its t.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LinearCoefficient {
    /// In units of the response.
    pub estimate: f64,
    /// Standard error.
    pub se: f64,
    /// Satterthwaite's degrees of freedom.
    pub df: f64,
    /// Estimate by standard error.
    pub t: f64,
    /// Of t, two-sided.
    pub p: f64,
}

/// Mean at a level of the factor, of the average person and clip.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LinearMean {
    /// In units of the response.
    pub mean: f64,
    /// Standard error.
    pub se: f64,
    /// Satterthwaite's degrees of freedom.
    pub df: f64,
    /// Its 95 % interval by t.
    pub interval_95: [f64; 2],
}

/// Two levels of the factor, the second less the first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinearPair {
    /// First level.
    pub a: String,
    /// Second level.
    pub b: String,
    /// b - a in units of the response.
    pub difference: f64,
    /// Standard error.
    pub se: f64,
    /// Satterthwaite's degrees of freedom.
    pub df: f64,
    /// Difference by standard error.
    pub t: f64,
    /// Of t, two-sided.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// After Holm's correction over the pairs.
    pub p_holm: f64,
    /// 95 % interval of the difference by t, of this pair alone.
    pub interval_95: [f64; 2],
}

/// Wald's F of the effect that is tested.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LinearEffect {
    /// F.
    pub f: f64,
    /// Degrees of freedom of the effect.
    pub df: usize,
    /// Those of the denominator, by Satterthwaite's method.
    pub df_denominator: f64,
    /// p.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
}

/// Result of [`linear_mixed_model`](crate::linear_mixed_model).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LinearMixedModel {
    /// Always `linear-mixed-model`.
    pub test: &'static str,
    /// As R writes it.
    pub formula: String,
    /// Responses.
    pub observations: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// The factor, or the interaction of all factors.
    pub effect: LinearEffect,
    /// Fixed effects, `(Intercept)` first.
    pub coefficients: Labelled<LinearCoefficient>,
    /// Of each level of the one factor; none of several factors.
    pub means: Labelled<LinearMean>,
    /// Every two levels of the one factor; none of several factors.
    pub pairs: Vec<LinearPair>,
    /// Standard deviation of each grouping's effects, in units of the response.
    pub sd: Labelled<f64>,
    /// That of what is left.
    pub residual_sd: f64,
    /// Levels of each grouping.
    pub levels: Labelled<usize>,
    /// Groupings whose standard deviation is 0: the likelihood is highest at that bound.
    pub at_zero: Vec<String>,
    /// Groupings that part the responses as one before them does, or each from all others, and are left out.
    pub left_out: Vec<String>,
    /// -2 ln of the restricted likelihood.
    pub reml_deviance: f64,
    /// Largest element of the gradient: below 1e-5, or there is no result.
    pub gradient: f64,
}
