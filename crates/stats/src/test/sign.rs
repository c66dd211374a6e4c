//! Sign test of paired differences: do more of them point one way than the other?
//!
//! Arbuthnott 1710; Conover 1999, section 3.4: differences of zero are dropped, the number of positive
//! ones is then binomial with probability 1/2. The interval of the median difference is that of the
//! order statistics of all differences (Conover 1999, section 3.2); its level is exact.

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::distributions::tail::{Alternative, Tail, binomial_half_at_least};
use crate::estimate::proportion::proportion;
use crate::outcome::Outcome;
use crate::procedure::arguments::{ALTERNATIVE, Arguments};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::summary::describe::quantile_sorted;
use crate::table::pairs::{PAIR_OPTIONS, differences, rounded};
use crate::table::{Numbers, Table};
use crate::undefined::Undefined;

/// Level of the interval of the median difference.
const LEVEL: f64 = 0.95;

/// Result of [`sign`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sign {
    /// Always `sign`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// Direction.
    pub alternative: &'static str,
    /// Pairs without a missing value.
    pub n_pairs: usize,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// Differences that are zero, which the test drops.
    pub n_zero: usize,
    /// Differences that are not zero.
    pub n_used: usize,
    /// Positive differences.
    pub statistic: usize,
    /// Negative differences.
    pub negative: usize,
    /// p of the direction.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// p in either direction: twice the smaller of the two below, at most 1.
    pub p_two_sided: f64,
    /// Probability of so many positive differences or more.
    pub p_greater: f64,
    /// Probability of so many positive differences or fewer.
    pub p_less: f64,
    /// Effect size: share of positive differences among those that are not zero.
    pub proportion_positive: f64,
    /// Its Clopper-Pearson interval at 95 %.
    pub proportion_ci_clopper_pearson: [f64; 2],
    /// Median of all differences, zeros included.
    pub median: f64,
    /// Its interval: two of the differences.
    pub median_ci: [f64; 2],
    /// The exact level of that interval.
    pub median_ci_level: f64,
    /// Whether that level is at least 95 %; below six pairs it cannot be.
    pub level_reached: bool,
    /// What to mind.
    pub warnings: Vec<String>,
}

/// Are differences as often positive as negative? NaN is missing. Differences are rounded to 9 decimals,
/// so that means that should be equal are.
///
/// Undefined if every difference is zero; refuses a column without a value.
pub fn sign(differences: &Numbers, alternative: Alternative) -> Result<Outcome<Sign>, Refusal> {
    let given = differences.values.iter().copied().filter(|d| d.is_finite());
    let mut sorted: Vec<f64> = given.map(rounded).collect();
    let (n, dropped) = (sorted.len(), differences.values.len() - sorted.len());
    if n == 0 {
        return Err(Refusal::NoRows { column: differences.name.clone(), dropped });
    }
    sorted.sort_unstable_by(f64::total_cmp);
    let positive = sorted.iter().filter(|&&d| d > 0.0).count();
    let negative = sorted.iter().filter(|&&d| d < 0.0).count();
    let used = positive + negative;
    if used == 0 {
        return Ok(Outcome::undefined(Undefined::AllDifferencesZero {
            column: differences.name.clone(),
            n,
        }));
    }
    let greater = binomial_half_at_least(positive, used);
    let less = binomial_half_at_least(negative, used);
    let two_sided = if greater.ln_p < less.ln_p { greater } else { less }.doubled();
    let Tail { p, ln_p } = match alternative {
        Alternative::TwoSided => two_sided,
        Alternative::Greater => greater,
        Alternative::Less => less,
    };
    let share = proportion(positive as u64, used as u64);
    let (median_ci, median_ci_level) = median_interval(&sorted);
    let level_reached = median_ci_level >= LEVEL;
    Ok(Outcome::Ok(Sign {
        test: "sign",
        variant: "exact binomial, zeros dropped",
        alternative: alternative.as_str(),
        n_pairs: n,
        dropped,
        n_zero: n - used,
        n_used: used,
        statistic: positive,
        negative,
        p_value: p,
        ln_p,
        p_two_sided: two_sided.p,
        p_greater: greater.p,
        p_less: less.p,
        proportion_positive: positive as f64 / used as f64,
        proportion_ci_clopper_pearson: share.clopper_pearson.unwrap_or([0.0, 1.0]),
        median: quantile_sorted(&sorted, 0.5),
        median_ci,
        median_ci_level,
        level_reached,
        warnings: warnings(n, used, alternative),
    }))
}

fn warnings(n: usize, used: usize, alternative: Alternative) -> Vec<String> {
    let mut warnings = Vec::new();
    if used < n {
        warnings.push(format!("{} of {n} differences are zero and are dropped", n - used));
    }
    let least = binomial_half_at_least(used, used).doubled().p;
    if alternative == Alternative::TwoSided && least > 0.05 {
        warnings.push(format!(
            "{used} non-zero differences can never give p below {least}: too few for a test at 5 %"
        ));
    }
    warnings
}

/// The narrowest interval of the median between the k-th smallest and the k-th largest of ascending
/// values whose level is at least 95 %, else the widest; and its exact level
/// 1 - 2 P(fewer than k of n fall on one side).
fn median_interval(sorted: &[f64]) -> ([f64; 2], f64) {
    let n = sorted.len();
    // P(X < k) = P(X > n - k) of a binomial variable with probability 1/2.
    let outside = |k: usize| 2.0 * binomial_half_at_least(n - k + 1, n).p;
    let (mut k, mut above) = (1, n / 2 + 1);
    while above - k > 1 {
        let middle = (k + above) / 2;
        if outside(middle) <= 1.0 - LEVEL { k = middle } else { above = middle }
    }
    ([sorted[k - 1], sorted[n - k]], (1.0 - outside(k)).max(0.0))
}

/// `mimique test sign`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "sign",
    question: "Do more pairs differ one way than the other? Exact sign test",
    options: &[&PAIR_OPTIONS, &[ALTERNATIVE]],
    run,
    sample: Sample::Differences,
    r: r#"
# The sign test, zeros dropped, and the interval of the median by order statistics.
sign_test <- function(d) {
  d <- round(d, 9)
  test <- binom.test(sum(d > 0), sum(d != 0))
  n <- length(d)
  k <- max(qbinom(0.025, n, 0.5), 1)
  c(statistic = unname(test$statistic), p = test$p.value, effect = unname(test$estimate), n = n,
    proportion_low = test$conf.int[1], proportion_high = test$conf.int[2], median = median(d),
    median_low = sort(d)[k], median_high = sort(d)[n - k + 1])
}
"#,
    python: r#"
def sign_test(d):
    """The sign test, zeros dropped, and the interval of the median by order statistics."""
    d = np.sort(np.round(d, 9))
    test = stats.binomtest(int((d > 0).sum()), int((d != 0).sum()))
    interval = test.proportion_ci(method="exact")
    n = len(d)
    k = max(int(stats.binom.ppf(0.025, n, 0.5)), 1)
    return dict(
        statistic=test.k,
        p=test.pvalue,
        effect=test.k / test.n,
        n=n,
        proportion_low=interval.low,
        proportion_high=interval.high,
        median=np.median(d),
        median_low=d[k - 1],
        median_high=d[n - k],
    )
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let differences = differences(table, arguments)?;
    let outcome = sign(&differences, arguments.alternative()?)?;
    Ok(Answer::of_test(&outcome, |result| words(result, &differences.name)))
}

impl TestResult for Sign {
    const NAMES: TestNames = TestNames {
        test: "sign test",
        short: "sign",
        in_words: ["sign test", "test des signes"],
        statistic: "positive differences",
        statistic_symbol: "S",
        effect: "share of positive differences",
        effect_symbol: "share",
        function: "sign_test",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        vec![Outcome::Ok(TestRow {
            variant: self.variant.to_owned(),
            term: Term::Whole,
            statistic: self.statistic as f64,
            degrees_of_freedom: Vec::new(),
            p_value: self.p_value,
            ln_p: self.ln_p,
            effect: Some(self.proportion_positive),
            n: self.n_pairs,
        })]
    }
}

fn words(result: &Sign, name: &str) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Sign test of {name} ({})", result.variant));
    lines.add(lines::pairs(result.n_pairs, result.n_zero, result.dropped));
    lines.add(format!(
        "{} positive, {} negative, {}, p {}",
        result.statistic,
        result.negative,
        result.alternative,
        format_p(result.p_value, result.ln_p)
    ));
    let [low, high] = result.proportion_ci_clopper_pearson;
    lines.add(format!(
        "effect: share of positive differences = {}, 95 % interval {} to {} (Clopper-Pearson)",
        format_number(result.proportion_positive),
        format_number(low),
        format_number(high)
    ));
    let [low, high] = result.median_ci;
    lines.add(format!(
        "median difference = {}, {} % interval {} to {} (order statistics){}",
        format_number(result.median),
        format_number(100.0 * result.median_ci_level),
        format_number(low),
        format_number(high),
        if result.level_reached { "" } else { " (too few pairs for 95 %)" }
    ));
    lines.warnings(&result.warnings);
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64], alternative: Alternative) -> Outcome<Sign> {
        sign(&Numbers { name: "d".to_owned(), values: values.to_vec() }, alternative).unwrap()
    }

    #[test]
    fn p_is_the_share_of_all_ways_to_choose_signs() {
        for positive in 0..=11usize {
            let values: Vec<f64> = (0..11).map(|i| if i < positive { 1.0 } else { -2.0 }).collect();
            let ways = |enough: &dyn Fn(u32) -> bool| {
                (0u32..1 << 11).filter(|signs| enough(signs.count_ones())).count() as f64 / 2048.0
            };
            let (at_least, at_most) =
                (ways(&|count| count >= positive as u32), ways(&|count| count <= positive as u32));
            let result = of(&values, Alternative::TwoSided).ok().unwrap();
            assert!((result.p_greater - at_least).abs() < 1e-14, "{positive}");
            assert!((result.p_less - at_most).abs() < 1e-14, "{positive}");
            assert!((result.p_value - (2.0 * at_least.min(at_most)).min(1.0)).abs() < 1e-14);
        }
    }

    #[test]
    fn zeros_are_dropped_from_the_test_and_said_but_count_for_the_median() {
        let result = of(&[0.0, 0.0, 1.0, 2.0, -1.0, f64::NAN], Alternative::Greater).ok().unwrap();
        assert_eq!((result.n_pairs, result.n_zero, result.n_used, result.dropped), (5, 2, 3, 1));
        assert_eq!((result.statistic, result.negative, result.median), (2, 1, 0.0));
        assert_eq!(result.p_value, result.p_greater);
        assert!((result.p_greater - 0.5).abs() < 1e-14);
        assert!(result.warnings[0].contains("2 of 5 differences are zero"));
        let reason = of(&[0.0, 1e-12], Alternative::TwoSided);
        let why = Undefined::AllDifferencesZero { column: "d".to_owned(), n: 2 };
        assert_eq!(reason.reason(), Some(&why));
    }

    #[test]
    fn the_interval_of_the_median_has_its_exact_level() {
        // Of 10 values the second smallest and second largest: 1 - 2 (1 + 10) / 1024.
        let values: Vec<f64> = (1..=10).map(f64::from).collect();
        let (interval, level) = median_interval(&values);
        assert_eq!(interval, [2.0, 9.0]);
        assert!((level - (1.0 - 22.0 / 1024.0)).abs() < 1e-14);
        // Five values never reach 95 %.
        let (interval, level) = median_interval(&values[..5]);
        assert_eq!(interval, [1.0, 5.0]);
        assert!((level - 0.9375).abs() < 1e-14);
        assert_eq!(median_interval(&values[..1]).0, [1.0, 1.0]);
    }

    #[test]
    fn many_pairs_keep_a_finite_logarithm() {
        let result = of(&vec![1.0; 3000], Alternative::TwoSided).ok().unwrap();
        assert_eq!(result.p_value, 0.0);
        let expected = -2999.0 * std::f64::consts::LN_2;
        assert!((result.ln_p - expected).abs() < 1e-9 * expected.abs(), "{}", result.ln_p);
    }
}
