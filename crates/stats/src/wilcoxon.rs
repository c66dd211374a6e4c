//! Wilcoxon's signed rank test, in every variant that the usual tools compute.
//!
//! The tools disagree about zero differences, ties and continuity; the chosen variant is part of the
//! result and all variants stand beside it in [`Wilcoxon::p_by_semantics`].

use serde::Serialize;

use crate::outcome::{Labelled, Outcome, Refusal};
use crate::signed_rank::{Magnitudes, SignedRanks, Zeros};
use crate::table::Numbers;
use crate::tail::{Alternative, Tail};
use crate::tally::Tally;
use crate::walsh::{HodgesLehmann, intervals};

/// Up to this many non-zero differences the conditional distribution is computed exactly.
const EXACT_UP_TO: usize = 200;

/// Which p-value is the answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WilcoxonVariant {
    /// Exact conditional with Pratt's ranks up to 200 differences, asymptotic Pratt beyond.
    #[default]
    Automatic,
    /// Exact conditional, zeros ranked and then left out.
    ExactPratt,
    /// Exact conditional, zeros dropped before ranking.
    ExactWilcox,
    /// Normal with Pratt's ranks.
    AsymptoticPratt,
    /// Normal, zeros dropped before ranking.
    AsymptoticWilcox,
    /// R of 2019: zeros dropped; exact below 50 differences with neither ties nor zeros, else normal
    /// with continuity correction.
    Thesis,
}

/// Options of [`wilcoxon`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WilcoxonOptions {
    /// Which p-value is the answer.
    pub variant: WilcoxonVariant,
    /// Continuity correction of the asymptotic variants.
    pub continuity: bool,
    /// Direction.
    pub alternative: Alternative,
}

/// Result of [`wilcoxon`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct Wilcoxon {
    /// Always `wilcoxon`.
    pub test: &'static str,
    /// The variant whose p-value is `p_value`, in words.
    pub variant: String,
    /// Its key in `p_by_semantics`.
    pub semantics: &'static str,
    /// Direction.
    pub alternative: &'static str,
    /// Pairs without a missing value.
    pub n_pairs: usize,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// Differences that are zero.
    pub n_zero: usize,
    /// Differences that are not.
    pub n_used: usize,
    /// W+ of the chosen variant.
    pub statistic: f64,
    /// Rank sum of the positive differences, zeros dropped.
    pub W_plus: f64,
    /// Rank sum of the negative differences, zeros dropped.
    pub W_minus: f64,
    /// Rank sum of the positive differences, zeros ranked.
    pub W_plus_pratt: f64,
    /// Rank sum of the negative differences, zeros ranked.
    pub W_minus_pratt: f64,
    /// Of the chosen variant.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// Matched rank-biserial correlation (W+ - W-) / (W+ + W-), zeros dropped.
    pub rank_biserial: f64,
    /// Median of the Walsh averages of all differences.
    pub hodges_lehmann_walsh_median: f64,
    /// Median of the Walsh averages of the non-zero differences.
    pub hodges_lehmann_zeros_dropped: f64,
    /// Interval of the location, from the Walsh averages of all differences.
    pub hodges_lehmann_ci: HodgesLehmann,
    /// Estimate and interval as R of 2019 gives them.
    pub R_ci: HodgesLehmann,
    /// p of every variant. The exact ones are none beyond 200 differences.
    pub p_by_semantics: Labelled<Option<f64>>,
    /// What to mind.
    pub warnings: Vec<String>,
}

/// Differences of two columns, `x - y`.
pub fn paired_differences(x: &Numbers, y: &Numbers) -> Numbers {
    Numbers {
        name: format!("{} - {}", x.name, y.name),
        values: x.values.iter().zip(&y.values).map(|(x, y)| x - y).collect(),
    }
}

/// Is the distribution of differences symmetric about zero? NaN is missing. Differences are rounded to
/// 9 decimals: means that should be equal differ by 1e-16, which would move ranks.
///
/// Undefined if every difference is zero.
pub fn wilcoxon(
    differences: &Numbers,
    options: WilcoxonOptions,
) -> Result<Outcome<Wilcoxon>, Refusal> {
    let given = differences.values.iter().copied().filter(|d| d.is_finite());
    let all: Vec<f64> = given.map(rounded).collect();
    let dropped = differences.values.len() - all.len();
    if all.is_empty() {
        return Err(Refusal::NoRows { column: differences.name.clone(), dropped });
    }
    let all = Tally::of(&all);
    let without_zeros = all.has(0.0).then(|| all.without(0.0));
    let nonzero = without_zeros.as_ref().unwrap_or(&all);
    let (n, n_used) = (all.total() as usize, nonzero.total() as usize);
    if n_used == 0 {
        return Ok(Outcome::undefined(format!(
            "all differences are zero ({n} of \"{}\"), so there is nothing to rank",
            differences.name
        )));
    }
    let alternative = options.alternative;
    let magnitudes = Magnitudes::of(&all);
    let dropping = SignedRanks::of(&magnitudes, Zeros::Drop);
    let pratt = if without_zeros.is_some() {
        SignedRanks::of(&magnitudes, Zeros::Pratt)
    } else {
        dropping.clone()
    };
    let split = SignedRanks::of(&magnitudes, Zeros::Split);
    let ties = dropping.has_ties();
    let zeros = n > n_used;

    let exact = |ranks: &SignedRanks| (n_used <= EXACT_UP_TO).then(|| ranks.exact(alternative));
    let exact_dropping = exact(&dropping);
    let exact_pratt = exact(&pratt);
    let thesis_is_exact = n_used < 50 && !ties && !zeros;
    let wilcox_cc = dropping.normal(alternative, true);
    let wilcox = dropping.normal(alternative, false);
    let pratt_cc = pratt.normal(alternative, true);
    let pratt_normal = pratt.normal(alternative, false);
    let thesis = exact_dropping.filter(|_| thesis_is_exact).unwrap_or(wilcox_cc);
    let r_4_6 = exact_pratt.filter(|_| n < 50).unwrap_or(wilcox_cc);
    let r_4_7 = exact_pratt.filter(|_| n < 50).unwrap_or(pratt_cc);
    let scipy_is_exact = n <= 50 && ((!ties && !zeros) || n <= 13);
    let scipy = exact_dropping.filter(|_| scipy_is_exact).unwrap_or(wilcox);

    let chosen = Chosen::of(options, n_used)?;
    let (tail, ranks, words): (Tail, &SignedRanks, String) = match chosen {
        Chosen::ExactPratt => (
            exact_pratt.unwrap_or(pratt_normal),
            &pratt,
            "exact conditional on the ranks, zeros by Pratt".to_owned(),
        ),
        Chosen::ExactWilcox => (
            exact_dropping.unwrap_or(wilcox),
            &dropping,
            "exact conditional on the ranks, zeros dropped".to_owned(),
        ),
        Chosen::Pratt { continuity } => (
            if continuity { pratt_cc } else { pratt_normal },
            &pratt,
            format!("normal, corrected for ties, zeros by Pratt, {}", in_words(continuity)),
        ),
        Chosen::Wilcox { continuity } => (
            if continuity { wilcox_cc } else { wilcox },
            &dropping,
            format!("normal, corrected for ties, zeros dropped, {}", in_words(continuity)),
        ),
        Chosen::Thesis => (
            thesis,
            &dropping,
            if thesis_is_exact {
                "as R of 2019: exact, no ties, no zeros".to_owned()
            } else {
                "as R of 2019: normal, corrected for ties, zeros dropped, with continuity correction"
                    .to_owned()
            },
        ),
    };

    let mut warnings = Vec::new();
    if zeros {
        warnings.push(format!("{} of {n} differences are zero", n - n_used));
    }
    if alternative == Alternative::TwoSided && n_used <= EXACT_UP_TO {
        let least = 0.5f64.powi(n_used as i32 - 1);
        if least > 0.05 {
            warnings.push(format!(
                "{n_used} non-zero differences can never give p below {least}: too few for a test at 5 %"
            ));
        }
    }
    let p_by_semantics = [
        ("R_le_4.5_default (thesis era)", Some(thesis)),
        ("R_4.6.0_default", Some(r_4_6)),
        ("R_4.7_devel_default", Some(r_4_7)),
        ("scipy_default", Some(scipy)),
        ("normal_wilcox_zeros_cc", Some(wilcox_cc)),
        ("normal_wilcox_zeros_nocc", Some(wilcox)),
        ("normal_pratt_nocc", Some(pratt_normal)),
        ("normal_pratt_cc", Some(pratt_cc)),
        ("normal_zsplit_nocc", Some(split.normal(alternative, false))),
        ("exact_conditional_wilcox_zeros", exact_dropping),
        ("exact_conditional_pratt", exact_pratt),
    ]
    .into_iter()
    .map(|(key, tail)| (key.to_owned(), tail.map(|tail| tail.p)))
    .collect();

    let (plus, minus) = (dropping.plus(), dropping.minus());
    let (interval, thesis_interval) = intervals(&all, without_zeros.as_ref(), thesis_is_exact);
    Ok(Outcome::Ok(Wilcoxon {
        test: "wilcoxon",
        variant: words,
        semantics: chosen.key(),
        alternative: alternative.as_str(),
        n_pairs: n,
        dropped,
        n_zero: n - n_used,
        n_used,
        statistic: ranks.plus(),
        W_plus: plus,
        W_minus: minus,
        W_plus_pratt: pratt.plus(),
        W_minus_pratt: pratt.minus(),
        p_value: tail.p,
        ln_p: tail.ln_p,
        rank_biserial: (plus - minus) / (plus + minus),
        hodges_lehmann_walsh_median: interval.estimate,
        hodges_lehmann_zeros_dropped: thesis_interval.estimate,
        hodges_lehmann_ci: interval,
        R_ci: thesis_interval,
        p_by_semantics: Labelled(p_by_semantics),
        warnings,
    }))
}

/// Two-sided p as R of 2019, on differences as they are. None if all are zero.
pub(crate) fn thesis_p_without_rounding(differences: &[f64]) -> Option<f64> {
    let all = Tally::of(differences);
    let nonzero = all.without(0.0);
    if nonzero.values.is_empty() {
        return None;
    }
    let magnitudes = Magnitudes::of(&nonzero);
    let ranks = SignedRanks::of(&magnitudes, Zeros::Drop);
    let plain = nonzero.total() == all.total() && !ranks.has_ties();
    let tail = if plain && nonzero.total() < 50 {
        ranks.exact(Alternative::TwoSided)
    } else {
        ranks.normal(Alternative::TwoSided, true)
    };
    Some(tail.p)
}

/// Rounded to 9 decimals, where that changes anything.
pub(crate) fn rounded(difference: f64) -> f64 {
    // Ratings and their halves are exact as they are.
    let doubled = difference * 2.0;
    if doubled.abs() < 1e6 && f64::from(doubled as i32) == doubled {
        return difference;
    }
    let scaled = difference * 1e9;
    if scaled.abs() < 9e15 { scaled.round() / 1e9 } else { difference }
}

fn in_words(continuity: bool) -> &'static str {
    if continuity { "with continuity correction" } else { "without continuity correction" }
}

/// A variant with its options resolved.
#[derive(Clone, Copy)]
enum Chosen {
    ExactPratt,
    ExactWilcox,
    Pratt { continuity: bool },
    Wilcox { continuity: bool },
    Thesis,
}

impl Chosen {
    fn of(options: WilcoxonOptions, n_used: usize) -> Result<Self, Refusal> {
        let continuity = options.continuity;
        let exact = |chosen: Self| {
            if n_used <= EXACT_UP_TO {
                return Ok(chosen);
            }
            Err(Refusal::Options {
                problem: format!(
                    "the exact variant is computed up to {EXACT_UP_TO} non-zero differences, here are {n_used}"
                ),
                remedy: "take an asymptotic variant".to_owned(),
            })
        };
        match options.variant {
            WilcoxonVariant::Automatic if n_used <= EXACT_UP_TO => Ok(Self::ExactPratt),
            WilcoxonVariant::Automatic | WilcoxonVariant::AsymptoticPratt => {
                Ok(Self::Pratt { continuity })
            }
            WilcoxonVariant::ExactPratt => exact(Self::ExactPratt),
            WilcoxonVariant::ExactWilcox => exact(Self::ExactWilcox),
            WilcoxonVariant::AsymptoticWilcox => Ok(Self::Wilcox { continuity }),
            WilcoxonVariant::Thesis => Ok(Self::Thesis),
        }
    }

    fn key(self) -> &'static str {
        match self {
            Self::ExactPratt => "exact_conditional_pratt",
            Self::ExactWilcox => "exact_conditional_wilcox_zeros",
            Self::Pratt { continuity: true } => "normal_pratt_cc",
            Self::Pratt { continuity: false } => "normal_pratt_nocc",
            Self::Wilcox { continuity: true } => "normal_wilcox_zeros_cc",
            Self::Wilcox { continuity: false } => "normal_wilcox_zeros_nocc",
            Self::Thesis => "R_le_4.5_default (thesis era)",
        }
    }
}
