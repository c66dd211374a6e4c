//! Wilcoxon's signed rank test, in every variant that the usual tools compute.
//!
//! The tools disagree about zero differences, ties and continuity; the chosen variant is part of the
//! result and all variants stand beside it in [`Wilcoxon::p_by_semantics`].

mod tails;
mod variant;

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::distributions::tail::Alternative;
use crate::estimate::hodges_lehmann::{HodgesLehmann, intervals};
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{ALTERNATIVE, Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::ranks::signed_rank::{Magnitudes, SignedRanks, Zeros};
use crate::ranks::tally::Tally;
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::Table;
use crate::table::pairs::{PAIR_OPTIONS, differences, rounded};
use crate::undefined::Undefined;
use tails::{Counts, Tails};
use variant::{Chosen, EXACT_UP_TO, VARIANT};
pub use variant::{WilcoxonOptions, WilcoxonVariant};

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
        return Ok(Outcome::undefined(Undefined::AllDifferencesZero {
            column: differences.name.clone(),
            n,
        }));
    }
    let alternative = options.alternative;
    let counts = Counts { all: n, used: n_used };
    let magnitudes = Magnitudes::of(&all);
    let tails = Tails::of(&magnitudes, counts, alternative);
    let chosen = Chosen::of(options, n_used)?;
    let (tail, ranks, words) = tails.chosen(chosen);
    let Tails { dropping, pratt, .. } = &tails;
    let (plus, minus) = (dropping.plus(), dropping.minus());
    let (interval, thesis_interval) =
        intervals(&all, without_zeros.as_ref(), tails.thesis_is_exact());
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
        p_by_semantics: Labelled(tails.by_semantics()),
        warnings: warnings(counts, alternative),
    }))
}

fn warnings(counts: Counts, alternative: Alternative) -> Vec<String> {
    let Counts { all, used } = counts;
    let mut warnings = Vec::new();
    if all > used {
        warnings.push(format!("{} of {all} differences are zero", all - used));
    }
    if alternative == Alternative::TwoSided && used <= EXACT_UP_TO {
        let least = 0.5f64.powi(used as i32 - 1);
        if least > 0.05 {
            warnings.push(format!(
                "{used} non-zero differences can never give p below {least}: too few for a test at 5 %"
            ));
        }
    }
    warnings
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

/// `mimique test wilcoxon`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "wilcoxon",
    question: "Do pairs differ? Wilcoxon's signed rank test",
    options: &[
        &PAIR_OPTIONS,
        &[
            VARIANT,
            ProcedureOption::flag("continuity", "Continuity correction of the asymptotic variants"),
            ALTERNATIVE,
        ],
    ],
    run,
    sample: Sample::Differences,
    r: r#"
# Wilcoxon's signed ranks with Pratt's zeros: exact and conditional on the ranks up to 200 differences
# other than zero, normal beyond.
wilcoxon <- function(d) {
  d <- round(d, 9)
  r <- rank(abs(d))
  tossed <- r[d != 0]
  plus <- sum(r[d > 0])
  if (length(tossed) <= 200) {
    distribution <- 1
    for (k in round(2 * tossed)) distribution <- (c(distribution, numeric(k)) + c(numeric(k), distribution)) / 2
    w <- round(2 * plus)
    p <- min(1, 2 * min(sum(distribution[1:(w + 1)]), sum(distribution[(w + 1):length(distribution)])))
  } else {
    p <- 2 * pnorm(-abs(plus - sum(tossed) / 2) / sqrt(sum(tossed^2) / 4))
  }
  c(statistic = plus, p = p, effect = rank_biserial(d), n = length(d), hodges_lehmann(d))
}
rank_biserial <- function(d) {
  d <- d[d != 0]
  r <- rank(abs(d))
  (sum(r[d > 0]) - sum(r[d < 0])) / sum(r)
}

# Median and 95 % interval of the Walsh averages.
hodges_lehmann <- function(d) {
  walsh <- outer(d, d, "+") / 2
  walsh <- sort(walsh[lower.tri(walsh, diag = TRUE)])
  n <- length(d)
  cut <- if (n <= 200) {
    max(qsignrank(0.025, n) - 1, 0)
  } else {
    max(floor(length(walsh) / 2 - qnorm(0.975) * sqrt(n * (n + 1) * (2 * n + 1) / 24) - 0.5), 0)
  }
  cut <- min(cut, (length(walsh) - 1) %/% 2)
  c(estimate = median(walsh), low = walsh[cut + 1], high = walsh[length(walsh) - cut])
}
# As R of 2019: zeros dropped, exact only below 50 differences without ties and zeros.
wilcoxon_thesis <- function(d) {
  d <- round(d, 9)
  used <- d[d != 0]
  exact <- length(used) < 50 && length(used) == length(d) && !anyDuplicated(abs(used))
  test <- suppressWarnings(wilcox.test(used, exact = exact, correct = TRUE))
  c(statistic = unname(test$statistic), p = test$p.value, effect = rank_biserial(d), n = length(d))
}
"#,
    python: r#"
def wilcoxon(d):
    """Pratt's zeros: exact and conditional on the ranks up to 200 differences other than zero."""
    d = np.round(d, 9)
    r = stats.rankdata(np.abs(d))
    tossed = r[d != 0]
    plus = r[d > 0].sum()
    if len(tossed) <= 200:
        distribution = np.ones(1)
        for k in np.round(2 * tossed).astype(int):
            zeros = np.zeros(k)
            distribution = (np.append(distribution, zeros) + np.append(zeros, distribution)) / 2
        w = int(round(2 * plus))
        p = min(1.0, 2 * min(distribution[: w + 1].sum(), distribution[w:].sum()))
    else:
        z = (plus - tossed.sum() / 2) / math.sqrt((tossed**2).sum() / 4)
        p = 2 * stats.norm.sf(abs(z))
    return dict(statistic=plus, p=p, effect=rank_biserial(d), n=len(d), **hodges_lehmann(d))


def rank_biserial(d):
    d = d[d != 0]
    r = stats.rankdata(np.abs(d))
    return (r[d > 0].sum() - r[d < 0].sum()) / r.sum()


def hodges_lehmann(d):
    """Median and 95 % interval of the Walsh averages."""
    n = len(d)
    walsh = np.sort((np.add.outer(d, d) / 2)[np.tril_indices(n)])
    if n <= 200:
        counts = np.ones(1)
        for k in range(1, n + 1):
            counts = (np.append(counts, np.zeros(k)) + np.append(np.zeros(k), counts)) / 2
        cut = max(int((np.cumsum(counts) <= 0.025).sum()) - 1, 0)
    else:
        variance = n * (n + 1) * (2 * n + 1) / 24
        cut = max(math.floor(len(walsh) / 2 - stats.norm.isf(0.025) * math.sqrt(variance) - 0.5), 0)
    cut = min(cut, (len(walsh) - 1) // 2)
    return dict(estimate=np.median(walsh), low=walsh[cut], high=walsh[len(walsh) - 1 - cut])


def wilcoxon_thesis(d):
    """As R of 2019: zeros dropped, exact only below 50 differences without ties and zeros."""
    d = np.round(d, 9)
    used = d[d != 0]
    exact = len(used) < 50 and len(used) == len(d) and len(set(np.abs(used))) == len(used)
    p = stats.wilcoxon(used, correction=not exact, method="exact" if exact else "asymptotic").pvalue
    plus = stats.rankdata(np.abs(used))[used > 0].sum()
    return dict(statistic=plus, p=p, effect=rank_biserial(d), n=len(d))
"#,
    golden_cases: "wilcoxon_signed_rank",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let differences = differences(table, arguments)?;
    let options = WilcoxonOptions {
        variant: arguments.chosen(&VARIANT)?.map(WilcoxonVariant::from_name).unwrap_or_default(),
        continuity: arguments.has("continuity"),
        alternative: arguments.alternative()?,
    };
    Ok(Answer::of_test(&wilcoxon(&differences, options)?, |result| {
        words(result, &differences.name)
    }))
}

impl TestResult for Wilcoxon {
    const NAMES: TestNames = TestNames {
        test: "Wilcoxon",
        short: "Wilcoxon",
        in_words: ["Wilcoxon’s signed rank test", "test des rangs signés de Wilcoxon"],
        statistic: "W+",
        statistic_symbol: "W+",
        effect: "rank-biserial",
        effect_symbol: "r",
        function: "wilcoxon",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        vec![Outcome::Ok(TestRow {
            variant: self.variant.clone(),
            term: Term::Whole,
            statistic: self.statistic,
            degrees_of_freedom: Vec::new(),
            p_value: self.p_value,
            ln_p: self.ln_p,
            effect: Some(self.rank_biserial),
            n: self.n_pairs,
        })]
    }
}

fn words(result: &Wilcoxon, name: &str) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Wilcoxon signed rank test of {name} ({})", result.variant));
    lines.add(lines::pairs(result.n_pairs, result.n_zero, result.dropped));
    lines.add(format!(
        "W+ = {}, W- = {} (zeros ranked: {}, {}), {}, p {}",
        format_number(result.W_plus),
        format_number(result.W_minus),
        format_number(result.W_plus_pratt),
        format_number(result.W_minus_pratt),
        result.alternative,
        format_p(result.p_value, result.ln_p)
    ));
    let interval = &result.hodges_lehmann_ci;
    lines.add(format!(
        "effect: rank-biserial correlation = {}",
        format_number(result.rank_biserial)
    ));
    lines.add(format!(
        "Hodges-Lehmann estimate = {}, 95 % interval {} to {}{}",
        format_number(interval.estimate),
        format_number(interval.ci_low),
        format_number(interval.ci_high),
        if interval.level_reached { "" } else { " (too few pairs for 95 %)" }
    ));
    lines.add("p by variant");
    let rows: Vec<Vec<String>> = result
        .p_by_semantics
        .iter()
        .map(|(key, value)| vec![key.to_owned(), lines::p_value(*value)])
        .collect();
    lines.table(&rows);
    lines.warnings(&result.warnings);
    lines.into_text()
}
