//! Is a difference smaller than the smallest one that matters? Two one-sided tests (Schuirmann 1987).
//!
//! With bounds low < 0 < high on a - b, "the difference is above low" and "it is below high" are each tested one-sided;
//! p is the larger. The interval at 1 - 2 alpha lies between the bounds exactly if both are shown. Of pairs by t
//! and by Wilcoxon's signed ranks (exact conditional, Pratt's zeros), of independent groups by Welch's t, the
//! pooled t, and Mann and Whitney's ranks (normal, corrected for ties and continuity).

mod procedure;

use serde::Serialize;

use crate::distributions::tail::{
    Alternative, Tail, normal_tail, t_quantile_upper, t_two_sided, t_upper,
};
use crate::estimate::hodges_lehmann::one_sample_interval;
use crate::outcome::Outcome;
use crate::ranks::Ranks;
use crate::ranks::tally::Tally;
use crate::refusal::{Refusal, Unfit};
use crate::summary::describe::moments;
use crate::table::Numbers;
use crate::table::pairs::rounded;
use crate::test::mann_whitney::u_variance;
use crate::test::wilcoxon::{WilcoxonOptions, wilcoxon};
use crate::undefined::{NoEstimate, Undefined};
pub(crate) use procedure::PROCEDURE;
pub use procedure::{EQUIVALENCE_PAIRED_T, EQUIVALENCE_WELCH};

/// What counts as equivalent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquivalenceOptions {
    /// The differences a - b between which nothing matters, the lower first.
    pub bounds: [f64; 2],
    /// Level of each of the two tests.
    pub alpha: f64,
}

impl EquivalenceOptions {
    /// Differences of less than `smallest` do not matter, at 5 %.
    pub fn smallest_effect(smallest: f64) -> Self {
        Self { bounds: [-smallest, smallest], alpha: 0.05 }
    }

    fn check(&self) -> Result<(), Refusal> {
        let [low, high] = self.bounds;
        if low.is_finite() && high.is_finite() && low < high && self.alpha > 0.0 && self.alpha < 0.5
        {
            return Ok(());
        }
        Err(Unfit::EquivalenceBounds { low, high, alpha: self.alpha }.into())
    }
}

/// What both questions together say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum EquivalenceVerdict {
    /// Within the bounds, and no difference shown.
    Equivalent,
    /// A difference is shown, and it may be as large as matters.
    Different,
    /// A difference is shown, and it is too small to matter.
    DifferentButSmall,
    /// Neither is shown: more people are needed.
    Undecided,
}

impl EquivalenceVerdict {
    /// From p of equivalence and p of a difference.
    pub fn of(p_equivalence: f64, p_difference: f64, alpha: f64) -> Self {
        match (p_equivalence < alpha, p_difference < alpha) {
            (true, false) => Self::Equivalent,
            (true, true) => Self::DifferentButSmall,
            (false, true) => Self::Different,
            (false, false) => Self::Undecided,
        }
    }
}

/// Two one-sided t tests.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EquivalenceT {
    /// Mean of a less mean of b.
    pub difference: f64,
    /// Its standard error.
    pub se: f64,
    /// Degrees of freedom, not whole for Welch's.
    pub df: f64,
    /// (difference - low) / se.
    pub t_lower: f64,
    /// (difference - high) / se.
    pub t_upper: f64,
    /// p that the difference is above low.
    pub p_lower: f64,
    /// p that the difference is below high.
    pub p_upper: f64,
    /// The larger of both.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// Interval of the difference at 1 - 2 alpha: at 90 % for 5 %.
    pub interval_90: [f64; 2],
    /// p of any difference, two-sided.
    pub p_difference: f64,
    /// What both say.
    pub verdict: EquivalenceVerdict,
}

/// Two one-sided signed rank tests.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EquivalenceWilcoxon {
    /// What was computed.
    pub variant: String,
    /// W+ of the differences less low, zeros ranked.
    pub w_plus_lower: f64,
    /// p that the differences lie above low.
    pub p_lower: f64,
    /// W+ of the differences less high, zeros ranked.
    pub w_plus_upper: f64,
    /// p that the differences lie below high.
    pub p_upper: f64,
    /// The larger of both.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// Hodges and Lehmann's estimate of the difference.
    pub hodges_lehmann: f64,
    /// Its interval at 1 - 2 alpha.
    pub interval_90: [f64; 2],
    /// p of any difference, two-sided; none where all differences are zero.
    pub p_difference: Option<f64>,
    /// What both say.
    pub verdict: EquivalenceVerdict,
}

/// Two one-sided rank sum tests.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EquivalenceMannWhitney {
    /// What was computed.
    pub variant: &'static str,
    /// U of a less low.
    pub u_lower: f64,
    /// p that a lies above b by more than low.
    pub p_lower: f64,
    /// U of a less high.
    pub u_upper: f64,
    /// p that a lies above b by less than high.
    pub p_upper: f64,
    /// The larger of both.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// p of any difference, two-sided.
    pub p_difference: f64,
    /// What both say.
    pub verdict: EquivalenceVerdict,
}

/// Result of [`equivalence_of_pairs`]. Read Wilcoxon's; the t test stands beside it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EquivalenceOfPairs {
    /// Always `equivalence`.
    pub test: &'static str,
    /// Pairs.
    pub n: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// The bounds.
    pub bounds: [f64; 2],
    /// Level of each test.
    pub alpha: f64,
    /// By signed ranks.
    pub wilcoxon: Outcome<EquivalenceWilcoxon>,
    /// By t.
    pub paired_t: Outcome<EquivalenceT>,
}

/// Result of [`equivalence_of_groups`]. Read Mann and Whitney's; the t tests stand beside it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EquivalenceOfGroups {
    /// Always `equivalence`.
    pub test: &'static str,
    /// The two groups: differences are the first less the second.
    pub groups: [String; 2],
    /// Observations in each.
    pub n: [usize; 2],
    /// Rows left out.
    pub dropped: usize,
    /// The bounds.
    pub bounds: [f64; 2],
    /// Level of each test.
    pub alpha: f64,
    /// By rank sums.
    pub mann_whitney_normal: Outcome<EquivalenceMannWhitney>,
    /// By t, variances of their own.
    pub welch: Outcome<EquivalenceT>,
    /// By t, one variance.
    pub pooled: Outcome<EquivalenceT>,
}

/// Equivalence of pairs by their differences; NaN is missing. Refuses bounds that are none.
pub fn equivalence_of_pairs(
    differences: &Numbers,
    options: &EquivalenceOptions,
) -> Result<EquivalenceOfPairs, Refusal> {
    options.check()?;
    let used: Vec<f64> = differences.values.iter().copied().filter(|d| d.is_finite()).collect();
    let dropped = differences.values.len() - used.len();
    if used.is_empty() {
        return Err(Refusal::NoRows { column: differences.name.clone(), dropped });
    }
    let size = used.len() as f64;
    let (mean, variance) = moments(&used);
    let paired_t = match variance {
        Some(variance) => t_tests(mean, (variance / size).sqrt(), size - 1.0, options),
        None => Outcome::undefined(NoEstimate::NoVariance),
    };
    Ok(EquivalenceOfPairs {
        test: "equivalence",
        n: used.len(),
        dropped,
        bounds: options.bounds,
        alpha: options.alpha,
        wilcoxon: signed_ranks(&used, &differences.name, options)?,
        paired_t,
    })
}

/// Equivalence of two independent samples; NaN is missing. Refuses an empty one, and bounds that are none.
pub fn equivalence_of_groups(
    a: &Numbers,
    b: &Numbers,
    options: &EquivalenceOptions,
) -> Result<EquivalenceOfGroups, Refusal> {
    options.check()?;
    let finite = |column: &Numbers| -> Result<Vec<f64>, Refusal> {
        let used: Vec<f64> = column.values.iter().copied().filter(|y| y.is_finite()).collect();
        let (column, dropped) = (column.name.clone(), column.values.len() - used.len());
        if used.is_empty() { Err(Refusal::NoRows { column, dropped }) } else { Ok(used) }
    };
    let (x, y) = (finite(a)?, finite(b)?);
    let (m, n) = (x.len() as f64, y.len() as f64);
    let ((mean_x, var_x), (mean_y, var_y)) = (moments(&x), moments(&y));
    let difference = mean_x - mean_y;
    let none = || Outcome::undefined(NoEstimate::NoVariance);
    let (welch, pooled) = match (var_x, var_y) {
        (Some(var_x), Some(var_y)) => {
            let (of_x, of_y) = (var_x / m, var_y / n);
            let below = of_x * of_x / (m - 1.0) + of_y * of_y / (n - 1.0);
            let df = (of_x + of_y) * (of_x + of_y) / below;
            let both = ((m - 1.0) * var_x + (n - 1.0) * var_y) / (m + n - 2.0);
            (
                t_tests(difference, (of_x + of_y).sqrt(), df, options),
                t_tests(difference, (both * (1.0 / m + 1.0 / n)).sqrt(), m + n - 2.0, options),
            )
        }
        _ => (none(), none()),
    };
    Ok(EquivalenceOfGroups {
        test: "equivalence",
        groups: [a.name.clone(), b.name.clone()],
        n: [x.len(), y.len()],
        dropped: a.values.len() + b.values.len() - x.len() - y.len(),
        bounds: options.bounds,
        alpha: options.alpha,
        mann_whitney_normal: rank_sums(&x, &y, options),
        welch,
        pooled,
    })
}

fn larger(lower: Tail, upper: Tail) -> Tail {
    if lower.ln_p > upper.ln_p { lower } else { upper }
}

impl EquivalenceT {
    /// The tests of a difference that is known up to a standard error with t's distribution of `df` degrees of freedom.
    ///
    /// Refuses bounds that are no interval. Undefined where the standard error is 0.
    pub fn of(
        difference: f64,
        se: f64,
        df: f64,
        options: &EquivalenceOptions,
    ) -> Result<Outcome<Self>, Refusal> {
        options.check()?;
        Ok(t_tests(difference, se, df, options))
    }
}

fn t_tests(
    difference: f64,
    se: f64,
    df: f64,
    options: &EquivalenceOptions,
) -> Outcome<EquivalenceT> {
    // A spread of nothing but rounding is none.
    if !(se > 1e-14 * difference.abs() && se > 0.0) {
        return Outcome::undefined(NoEstimate::NoVariance);
    }
    let [low, high] = options.bounds;
    let (t_lower, t_upper_) = ((difference - low) / se, (difference - high) / se);
    let (lower, upper) = (t_upper(t_lower, df), t_upper(-t_upper_, df));
    let Tail { p, ln_p } = larger(lower, upper);
    let reach = t_quantile_upper(options.alpha, df) * se;
    let p_difference = t_two_sided(difference / se, df).p;
    Outcome::Ok(EquivalenceT {
        difference,
        se,
        df,
        t_lower,
        t_upper: t_upper_,
        p_lower: lower.p,
        p_upper: upper.p,
        p,
        ln_p,
        interval_90: [difference - reach, difference + reach],
        p_difference,
        verdict: EquivalenceVerdict::of(p, p_difference, options.alpha),
    })
}

/// W+, its one-sided tail and its variant.
struct SignedRankTail {
    plus: f64,
    tail: Tail,
    variant: String,
}

fn signed_ranks(
    differences: &[f64],
    name: &str,
    options: &EquivalenceOptions,
) -> Result<Outcome<EquivalenceWilcoxon>, Refusal> {
    let one_sided =
        |bound: f64, alternative: Alternative| -> Result<Outcome<SignedRankTail>, Refusal> {
            let values = differences.iter().map(|d| d - bound).collect();
            let shifted = Numbers { name: name.to_owned(), values };
            let tested = wilcoxon(&shifted, WilcoxonOptions { alternative, ..Default::default() })?;
            Ok(tested.map(|found| SignedRankTail {
                plus: found.statistic,
                tail: Tail { p: found.p_value, ln_p: found.ln_p },
                variant: found.variant,
            }))
        };
    let [low, high] = options.bounds;
    let (lower, upper) =
        match (one_sided(low, Alternative::Greater)?, one_sided(high, Alternative::Less)?) {
            (Outcome::Ok(lower), Outcome::Ok(upper)) => (lower, upper),
            (Outcome::Undefined { reason }, _) | (_, Outcome::Undefined { reason }) => {
                return Ok(Outcome::Undefined::<_, Undefined> { reason });
            }
        };
    let any = one_sided(0.0, Alternative::TwoSided)?.ok().map(|found| found.tail.p);
    let Tail { p, ln_p } = larger(lower.tail, upper.tail);
    let all: Vec<f64> = differences.iter().map(|d| rounded(*d)).collect();
    let interval = one_sample_interval(&Tally::of(&all), 1.0 - 2.0 * options.alpha);
    Ok(Outcome::Ok(EquivalenceWilcoxon {
        variant: lower.variant,
        w_plus_lower: lower.plus,
        p_lower: lower.tail.p,
        w_plus_upper: upper.plus,
        p_upper: upper.tail.p,
        p,
        ln_p,
        hodges_lehmann: interval.estimate,
        interval_90: [interval.ci_low, interval.ci_high],
        p_difference: any,
        verdict: EquivalenceVerdict::of(p, any.unwrap_or(1.0), options.alpha),
    }))
}

/// U of x less a shift, and the normal tail of a direction, corrected for ties and continuity.
fn rank_sum(x: &[f64], y: &[f64], shift: f64, alternative: Alternative) -> Option<(f64, Tail)> {
    // Rounded, so that values that should be equal are.
    let shifted = x.iter().map(|x| rounded(x - shift));
    let both: Vec<f64> = shifted.chain(y.iter().map(|y| rounded(*y))).collect();
    let ranks = Ranks::of(&both);
    let (m, n) = (x.len(), y.len());
    let sum: u64 = (0..m).map(|place| ranks.doubled_rank(place)).sum();
    let u = (sum - (m * (m + 1)) as u64) as f64 / 2.0;
    let sd = u_variance(m, n, ranks.tie_term()).sqrt();
    let distance = u - (m * n) as f64 / 2.0;
    let correction = match alternative {
        Alternative::Greater => 0.5,
        Alternative::Less => -0.5,
        Alternative::TwoSided if distance == 0.0 => 0.0,
        Alternative::TwoSided => 0.5 * distance.signum(),
    };
    (sd > 0.0).then(|| (u, normal_tail((distance - correction) / sd, alternative)))
}

fn rank_sums(
    x: &[f64],
    y: &[f64],
    options: &EquivalenceOptions,
) -> Outcome<EquivalenceMannWhitney> {
    let [low, high] = options.bounds;
    let lower = rank_sum(x, y, low, Alternative::Greater);
    let upper = rank_sum(x, y, high, Alternative::Less);
    let (Some((u_lower, lower)), Some((u_upper, upper))) = (lower, upper) else {
        return Outcome::undefined(NoEstimate::NoVariance);
    };
    let any = rank_sum(x, y, 0.0, Alternative::TwoSided).map_or(1.0, |(_, tail)| tail.p);
    let Tail { p, ln_p } = larger(lower, upper);
    Outcome::Ok(EquivalenceMannWhitney {
        variant: "normal, corrected for ties, with continuity correction",
        u_lower,
        p_lower: lower.p,
        u_upper,
        p_upper: upper.p,
        p,
        ln_p,
        p_difference: any,
        verdict: EquivalenceVerdict::of(p, any, options.alpha),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(name: &str, values: &[f64]) -> Numbers {
        Numbers { name: name.to_owned(), values: values.to_vec() }
    }

    const SMALL: [f64; 12] = [0.1, -0.2, 0.05, 0.15, -0.1, 0.0, 0.2, -0.05, 0.1, -0.15, 0.05, 0.12];

    #[test]
    fn the_verdict_is_what_both_tests_say() {
        let of = |shift: f64, bound: f64| {
            let values = SMALL.map(|d| d + shift);
            let options = EquivalenceOptions::smallest_effect(bound);
            let found = equivalence_of_pairs(&numbers("d", &values), &options).unwrap();
            (found.wilcoxon.ok().unwrap().verdict, found.paired_t.ok().unwrap().verdict)
        };
        use EquivalenceVerdict::{Different, DifferentButSmall, Equivalent, Undecided};
        assert_eq!(of(0.0, 0.5), (Equivalent, Equivalent));
        assert_eq!(of(0.3, 0.6), (DifferentButSmall, DifferentButSmall));
        assert_eq!(of(0.5, 0.5), (Different, Different));
        assert_eq!(of(0.0, 0.02), (Undecided, Undecided));
    }

    #[test]
    fn p_is_below_five_percent_exactly_if_the_interval_lies_within() {
        let mut random = mimique_test_support::Random::new(21);
        for _ in 0..300 {
            let values: Vec<f64> =
                (0..10).map(|_| 0.4 * random.normal() + 0.3 * random.uniform()).collect();
            let options = EquivalenceOptions::smallest_effect(0.4);
            let found = equivalence_of_pairs(&numbers("d", &values), &options).unwrap();
            let found = found.paired_t.ok().unwrap();
            let within = found.interval_90[0] > -0.4 && found.interval_90[1] < 0.4;
            assert_eq!(found.p < 0.05, within, "{found:?}");
        }
    }

    #[test]
    fn exchanging_the_groups_mirrors_everything() {
        let (a, b) = (numbers("a", &SMALL), numbers("b", &SMALL.map(|x| 0.4 - 2.0 * x)));
        // No value is as far from another one as a bound: such ties are rounding's.
        let options = EquivalenceOptions { bounds: [-0.312_3, 0.512_3], alpha: 0.05 };
        let mirrored = EquivalenceOptions { bounds: [-0.512_3, 0.312_3], alpha: 0.05 };
        let one = equivalence_of_groups(&a, &b, &options).unwrap();
        let other = equivalence_of_groups(&b, &a, &mirrored).unwrap();
        let (one_t, other_t) = (one.welch.ok().unwrap(), other.welch.ok().unwrap());
        assert!((one_t.p_lower - other_t.p_upper).abs() < 1e-14);
        assert!((one_t.interval_90[0] + other_t.interval_90[1]).abs() < 1e-14);
        let (one, other) =
            (one.mann_whitney_normal.ok().unwrap(), other.mann_whitney_normal.ok().unwrap());
        assert!((one.p_lower - other.p_upper).abs() < 1e-12, "{one:?} {other:?}");
    }

    #[test]
    fn differences_without_spread_are_undefined_by_t_but_not_by_ranks() {
        let options = EquivalenceOptions::smallest_effect(0.5);
        let found = equivalence_of_pairs(&numbers("d", &[0.1; 8]), &options).unwrap();
        assert!(found.paired_t.reason().is_some());
        assert!((found.wilcoxon.ok().unwrap().p - 1.0 / 256.0).abs() < 1e-14);
        let on_the_bound = equivalence_of_pairs(&numbers("d", &[0.5; 8]), &options).unwrap();
        assert!(on_the_bound.wilcoxon.reason().is_some(), "all differences from the bound are 0");
        let equal =
            equivalence_of_groups(&numbers("a", &[3.0; 4]), &numbers("b", &[3.0; 5]), &options);
        assert!(equal.unwrap().welch.reason().is_some());
        for bounds in [[0.5, -0.5], [0.0, 0.0], [f64::NAN, 1.0]] {
            let wrong = EquivalenceOptions { bounds, alpha: 0.05 };
            assert!(equivalence_of_pairs(&numbers("d", &SMALL), &wrong).is_err());
        }
    }
}
