//! Standard errors that know that a participant's answers belong together, and the tests built on them.
//!
//! The covariance is I^-1 (G / (G - 1) Σ s_g s_g') I^-1, with s_g the score summed over participant g of G
//! (Liang and Zeger 1986). Equal worths are tested by Wald's W as F = W (G - q) / (q (G - 1)) on q = k - 1 and
//! G - q degrees of freedom, differences by t on G - 1; intervals are those of that t, so that a difference whose interval
//! leaves out 0 has p < .05 and the other way round. Percentiles of resampled participants cover less than they say with few
//! participants.

use nalgebra::{Cholesky, DMatrix, DVector};
use serde::Serialize;

use super::model::Model;
use crate::adjust::Adjustment;
use crate::distributions::tail::{Tail, f_upper, t_quantile_upper, t_two_sided};
use crate::table::comparisons::{Compared, PairedComparisons};

/// Wald's test of equal worths.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct EqualWorths {
    /// Wald's statistic.
    pub wald: f64,
    /// W (G - q) / (q (G - 1)).
    pub F: f64,
    /// q, items less one.
    pub df1: usize,
    /// G - q, participants less q.
    pub df2: usize,
    /// Upper F tail.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
}

/// Two items compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorthContrast {
    /// One item.
    pub a: String,
    /// The other.
    pub b: String,
    /// Worth of a less that of b.
    pub difference: f64,
    /// Its standard error, clustered by participant; none with one participant.
    pub se_cluster: Option<f64>,
    /// Two-sided t tail on participants less one.
    pub p: Option<f64>,
    /// After Holm's correction.
    pub p_holm: Option<f64>,
    /// The difference in just noticeable differences: in units of ln 3, which 75 % of choices tell.
    pub jnd: f64,
    /// Interval of `jnd` at 95 %.
    pub jnd_interval: Option<[f64; 2]>,
    /// Share of choices of a, without ties and side.
    pub preferred: f64,
    /// Interval of `preferred` at 95 %.
    pub preferred_interval: Option<[f64; 2]>,
}

/// The covariance of the fitted parameters, clustered by participant, with `score` the score of an answer in the
/// coordinates of its presentation; none with one participant.
pub(crate) fn clustered_of(
    model: Model,
    data: &PairedComparisons,
    inverse: &DMatrix<f64>,
    score: impl Fn(&Compared) -> [f64; 4],
) -> Option<DMatrix<f64>> {
    let groups = data.participants.len();
    if groups < 2 {
        return None;
    }
    let mut scores = DMatrix::<f64>::zeros(model.parameters(), groups);
    for answer in &data.answers {
        let mut own = scores.column_mut(answer.participant);
        model.scatter((answer.left, answer.right), score(answer), own.as_mut_slice());
    }
    let factor = groups as f64 / (groups - 1) as f64;
    Some(inverse * (&scores * scores.transpose()) * inverse * factor)
}

/// The test of equal worths; none where there are no more participants than worths to test, or where the
/// clustered covariance is singular.
pub(crate) fn equal_worths(
    items: usize,
    participants: usize,
    worth: &[f64],
    covariance: &DMatrix<f64>,
) -> Option<EqualWorths> {
    let q = items - 1;
    let df2 = participants.checked_sub(q).filter(|df| *df > 0)?;
    let own = DVector::from_column_slice(&worth[..q]);
    let factor = Cholesky::new(covariance.view((0, 0), (q, q)).into_owned())?;
    let wald = factor.solve(&own).dot(&own);
    let f = wald * df2 as f64 / (q as f64 * (participants - 1) as f64);
    let Tail { p, ln_p } = f_upper(f, q as f64, df2 as f64);
    Some(EqualWorths { wald, F: f, df1: q, df2, p, ln_p })
}

/// The interval at 95 % of an estimate with a standard error that is clustered by participant; none where the error is 0, as
/// where all participants chose alike.
pub(super) fn interval(estimate: f64, se: f64, participants: usize) -> Option<[f64; 2]> {
    let reach = t_quantile_upper(0.025, participants.checked_sub(1)? as f64) * se;
    (reach > 0.0).then_some([estimate - reach, estimate + reach])
}

/// All pairs of items.
pub(super) fn contrasts(
    names: &[String],
    worth: &[f64],
    covariance: Option<&DMatrix<f64>>,
    participants: usize,
) -> Vec<WorthContrast> {
    let items = names.len();
    let pairs = mimique_adaptive::all_pairs(items);
    let mut all: Vec<WorthContrast> = pairs
        .into_iter()
        .map(|(a, b)| {
            let difference = worth[a] - worth[b];
            let se = covariance.map(|covariance| {
                let way = direction(items, a, b);
                (covariance.view((0, 0), (items - 1, items - 1)) * &way).dot(&way).max(0.0).sqrt()
            });
            let df = participants as f64 - 1.0;
            let p = se.filter(|se| *se > 0.0).map(|se| t_two_sided(difference / se, df).p);
            let ends = se.and_then(|se| interval(difference, se, participants));
            WorthContrast {
                a: names[a].clone(),
                b: names[b].clone(),
                difference,
                se_cluster: se,
                p,
                p_holm: None,
                jnd: difference / JND,
                jnd_interval: ends.map(|ends| ends.map(|end| end / JND)),
                preferred: mimique_adaptive::logistic(difference),
                preferred_interval: ends.map(|ends| ends.map(mimique_adaptive::logistic)),
            }
        })
        .collect();
    let p: Vec<Option<f64>> = all.iter().map(|contrast| contrast.p).collect();
    for (contrast, p) in all.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        contrast.p_holm = p;
    }
    all
}

/// ln 3: the difference of worths at which 75 % of choices fall on one item.
pub(super) const JND: f64 = 1.098_612_288_668_109_8;

/// w_a - w_b in the fitted worths; the last worth is minus the sum of them.
fn direction(items: usize, a: usize, b: usize) -> DVector<f64> {
    let mut way = DVector::zeros(items - 1);
    for (item, sign) in [(a, 1.0), (b, -1.0)] {
        if item + 1 == items {
            way.add_scalar_mut(-sign);
        } else {
            way[item] += sign;
        }
    }
    way
}
