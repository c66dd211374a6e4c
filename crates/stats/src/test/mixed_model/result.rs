//! What a mixed model gives back.

use serde::Serialize;

use crate::outcome::Labelled;
use crate::test::bradley_terry::LikelihoodRatio;

/// A coefficient of the fixed effects, a level against the first one of its factor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MixedCoefficient {
    /// In log odds of a higher rating.
    pub estimate: f64,
    /// Standard error.
    pub se: f64,
    /// Estimate by standard error.
    pub z: f64,
    /// Of z, two-sided.
    pub p: f64,
}

/// Two levels of the factor, the second against the first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedPair {
    /// First level.
    pub a: String,
    /// Second level.
    pub b: String,
    /// b - a in log odds of a higher rating, with its standard error.
    pub estimate: f64,
    /// Standard error.
    pub se: f64,
    /// Of z, two-sided.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// After Holm's correction over the pairs.
    pub p_holm: f64,
    /// exp of the estimate: how many times the odds of a higher rating are those at a.
    pub odds_ratio: f64,
    /// Its 95 % interval.
    pub interval_95: [f64; 2],
    /// Of two answers of one person to clips that are equal but for the level, how often b stands higher (on the
    /// latent scale, where none are alike).
    pub higher: f64,
}

/// The effect held against the model without it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedEffectRatio {
    /// The fixed effects that remain, `1` for none.
    pub reduced: String,
    /// Log likelihood without the effect.
    pub loglik: f64,
    /// The ratio.
    #[serde(flatten)]
    pub ratio: LikelihoodRatio,
}

/// The last grouping held against the model without it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedGroupingRatio {
    /// The grouping.
    pub grouping: String,
    /// Log likelihood without it.
    pub loglik: f64,
    /// Twice the difference of the log likelihoods.
    pub statistic: f64,
    /// Half of the upper tail of chi-square with 1 degree of freedom: a standard deviation of 0 is a bound
    /// (Self and Liang 1987).
    pub p_half_chi_square: f64,
}

/// Shares of each rating at a level of the factor, lowest rating first; they add up to 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedShares {
    /// Of the model, where every random effect is 0: of the average person and clip on the scale of the log odds.
    pub model: Vec<f64>,
    /// Of the answers, of all people and clips together.
    pub observed: Vec<f64>,
}

/// Result of [`mixed_model`](crate::mixed_model).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedModel {
    /// Always `mixed-model`.
    pub test: &'static str,
    /// `cumulative logit`, or `binomial`.
    pub variant: &'static str,
    /// As R writes it.
    pub formula: String,
    /// Ratings.
    pub observations: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// Between every two ratings, `1|2`, on the logit scale.
    pub thresholds: Labelled<f64>,
    /// The different ratings, ascending.
    pub ratings: Vec<f64>,
    /// Shares of these at each level of the one factor; none of several factors.
    pub shares: Labelled<MixedShares>,
    /// Fixed effects.
    pub coefficients: Labelled<MixedCoefficient>,
    /// Every two levels of the one factor; none of several factors.
    pub pairs: Vec<MixedPair>,
    /// Standard deviation of each grouping's effects, in log odds.
    pub sd: Labelled<f64>,
    /// Levels of each grouping.
    pub levels: Labelled<usize>,
    /// Groupings whose standard deviation is 0: the likelihood is highest at that bound.
    pub at_zero: Vec<String>,
    /// Groupings that part the answers as one before them does, and are left out.
    pub left_out: Vec<String>,
    /// Log likelihood.
    pub loglik: f64,
    /// Largest element of its gradient: below 1e-5, or there is no result.
    pub gradient: f64,
    /// The factor, or the interaction of all factors, against the model without it.
    pub lr_effect: MixedEffectRatio,
    /// The last grouping against the model without it, where asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lr_last: Option<MixedGroupingRatio>,
}
