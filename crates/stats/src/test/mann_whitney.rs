//! Mann-Whitney test of two groups: U of the first, exact without ties when both have fewer than 50
//! observations, else normal with tie and continuity correction.

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::distributions::tail::{Alternative, Tail, normal_quantile_upper, normal_tail};
use crate::estimate::hodges_lehmann::{LEVEL, cut_of, two_sample_interval};
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{Arguments, GROUP, ProcedureOption, RESPONSE};
use crate::procedure::lines::Lines;
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::ranks::grouped::Grouped;
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::Table;
use crate::table::factor::Factor;

/// Result of [`mann_whitney`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MannWhitney {
    /// Always `mann-whitney`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// The two groups; effects are first minus second.
    pub pair: Term,
    /// Observations used.
    pub n: usize,
    /// Rows dropped: a missing value or another level.
    pub dropped: usize,
    /// Observations a group.
    pub group_n: Labelled<usize>,
    /// U of the first group: pairs in which it is larger, ties counting one half.
    pub statistic: f64,
    /// Two-sided p of the variant.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// Normal, tie-corrected, without continuity correction.
    pub p_asymptotic_nocc: f64,
    /// Normal, tie-corrected, with continuity correction.
    pub p_asymptotic_cc: f64,
    /// 2 U / (m n) - 1.
    pub rank_biserial: f64,
    /// Hodges-Lehmann shift: median of the pairwise differences.
    pub estimate: f64,
    /// Lower end of its interval.
    pub ci_low: f64,
    /// Upper end of its interval.
    pub ci_high: f64,
    /// Level of the interval.
    pub conf_level: f64,
    /// What to mind.
    pub warnings: Vec<String>,
}

/// Does the first of two groups tend to larger responses? `group` must have two levels among the rows
/// used. Undefined if all responses are equal.
pub fn mann_whitney(response: &Numbers, group: &Factor) -> Result<Outcome<MannWhitney>, Refusal> {
    let grouped = match Grouped::of(response, group)? {
        Outcome::Undefined { reason } => return Ok(Outcome::Undefined { reason }),
        Outcome::Ok(grouped) => grouped,
    };
    let used = &grouped.group;
    if used.levels.len() > 2 {
        let (column, levels) = (group.name.clone(), used.levels.len());
        return Err(Refusal::NotTwoLevels { column, levels });
    }
    let (ranks, dropped) = (&grouped.ranks, grouped.dropped);
    let (x, y) = (grouped.tally(0), grouped.tally(1));
    let (m, n) = (grouped.sizes[0], grouped.sizes[1]);
    let u = (grouped.doubled_sums[0] - (m * (m + 1)) as u64) as f64 / 2.0;
    let pairs = (m * n) as f64;

    let sd = u_variance(m, n, ranks.tie_term()).sqrt();
    let distance = u - pairs / 2.0;
    let correction = if distance == 0.0 { 0.0 } else { 0.5 * distance.signum() };
    let plain = normal_tail(distance / sd, Alternative::TwoSided);
    let corrected = normal_tail((distance - correction) / sd, Alternative::TwoSided);
    let small = m < 50 && n < 50;
    let exact = small && !ranks.has_ties();

    let (tail, cut) = if exact {
        exact_tail_and_cut(u as usize, m, n)
    } else {
        // Inverting the test: only ties inside a sample remain at every shift.
        (corrected, normal_cut(m, n, x.tie_term() + y.tie_term()))
    };
    let interval = two_sample_interval(&x, &y, cut);
    Ok(Outcome::Ok(MannWhitney {
        test: "mann-whitney",
        variant: if exact {
            "exact, no ties"
        } else {
            "normal, corrected for ties, with continuity correction"
        },
        pair: Term::Pair([0, 1].map(|group| used.levels[group].clone())),
        n: m + n,
        dropped,
        group_n: Labelled::zip(&used.levels, [m, n]),
        statistic: u,
        p_value: tail.p,
        ln_p: tail.ln_p,
        p_asymptotic_nocc: plain.p,
        p_asymptotic_cc: corrected.p,
        rank_biserial: 2.0 * u / pairs - 1.0,
        estimate: interval.estimate,
        ci_low: interval.ci_low,
        ci_high: interval.ci_high,
        conf_level: LEVEL,
        warnings: warnings(small && !exact, interval.level_reached),
    }))
}

/// Two-sided tail of U without ties, and the cut of the interval; none where 95 % cannot be reached.
fn exact_tail_and_cut(u: usize, m: usize, n: usize) -> (Tail, Option<u64>) {
    let distribution = u_distribution(m, n);
    let at_most: f64 = distribution[..=u].iter().sum();
    let at_least: f64 = distribution[u..].iter().sum();
    let reachable = distribution[0] <= (1.0 - LEVEL) / 2.0;
    (Tail::from_p(at_most.min(at_least)).doubled(), reachable.then(|| cut_of(distribution, LEVEL)))
}

/// Cut of the interval by the normal approximation; none where 95 % cannot be reached.
fn normal_cut(m: usize, n: usize, tie_term: f64) -> Option<u64> {
    let reach = 0.5
        + normal_quantile_upper((1.0 - LEVEL) / 2.0) * u_variance(m, n, tie_term).max(0.0).sqrt();
    let cut = ((m * n) as f64 / 2.0 - reach).floor();
    (cut >= 0.0).then_some(cut as u64)
}

/// Variance of U of samples of `m` and `n`, corrected for ties.
pub(crate) fn u_variance(m: usize, n: usize, tie_term: f64) -> f64 {
    let (pairs, total) = ((m * n) as f64, (m + n) as f64);
    pairs / 12.0 * ((total + 1.0) - tie_term / (total * (total - 1.0)))
}

fn warnings(inexact_by_ties: bool, level_reached: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    if inexact_by_ties {
        warnings.push("cannot compute exact p-value with ties".to_owned());
        warnings.push("cannot compute exact confidence intervals with ties".to_owned());
    }
    if !level_reached {
        warnings.push("too few observations for an interval of 95 %: the widest is given".into());
    }
    warnings
}

/// Probability of every U of samples of `m` and `n` without ties (Mann and Whitney 1947): the counts of
/// partitions into at most m parts of at most n.
fn u_distribution(m: usize, n: usize) -> Vec<f64> {
    // counts[i][u]: ways to choose i of the observations seen so far with rank sum u above the least
    let largest = m * n;
    let mut counts = vec![vec![0.0f64; largest + 1]; m + 1];
    counts[0][0] = 1.0;
    for seen in 0..m + n {
        for chosen in (0..m.min(seen + 1)).rev() {
            // The (chosen+1)-th chosen at place `seen` has seen - chosen of the others below it.
            let below = seen - chosen;
            if below > n {
                continue;
            }
            for u in (below..=largest).rev() {
                let ways = counts[chosen][u - below];
                counts[chosen + 1][u] += ways;
            }
        }
    }
    let all: f64 = counts[m].iter().sum();
    counts[m].iter().map(|ways| ways / all).collect()
}

/// `mimique test mann-whitney`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "mann-whitney",
    question: "Do two independent groups differ?",
    options: &[&[
        RESPONSE,
        GROUP,
        ProcedureOption::list("levels", "The two groups: U is of the first"),
    ]],
    run,
    sample: Sample::Groups,
    r: r#"
mann_whitney <- function(data) {
  x <- data$values[data$groups == levels(data$groups)[1]]
  y <- data$values[data$groups == levels(data$groups)[2]]
  test <- suppressWarnings(wilcox.test(x, y))
  u <- unname(test$statistic)
  c(statistic = u, p = test$p.value, effect = 2 * u / (length(x) * length(y)) - 1,
    n = length(x) + length(y))
}
"#,
    python: r#"
def mann_whitney(samples):
    x, y = samples
    ties = len(set(x) | set(y)) < len(x) + len(y)
    exact = len(x) < 50 and len(y) < 50 and not ties
    u, p = stats.mannwhitneyu(x, y, method="exact" if exact else "asymptotic")
    return dict(statistic=u, p=p, effect=2 * u / (len(x) * len(y)) - 1, n=len(x) + len(y))
"#,
    golden_cases: "mann_whitney",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let group = arguments.groups(table)?;
    Ok(Answer::of_test(&mann_whitney(&arguments.numbers(table, "response")?, &group)?, words))
}

impl TestResult for MannWhitney {
    const NAMES: TestNames = TestNames {
        test: "Mann-Whitney",
        short: "Mann-Whitney",
        in_words: ["Mann-Whitney test", "test de Mann-Whitney"],
        statistic: "U",
        statistic_symbol: "U",
        effect: "rank-biserial",
        effect_symbol: "r",
        function: "mann_whitney",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        vec![Outcome::Ok(TestRow {
            variant: String::new(),
            term: self.pair.clone(),
            statistic: self.statistic,
            degrees_of_freedom: Vec::new(),
            p_value: self.p_value,
            ln_p: self.ln_p,
            effect: Some(self.rank_biserial),
            n: self.n,
        })]
    }
}

fn words(result: &MannWhitney) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Mann-Whitney test of {} ({})", result.pair, result.variant));
    let sizes: Vec<String> =
        result.group_n.iter().map(|(level, count)| format!("{level}: {count}")).collect();
    let elsewhere = match result.dropped {
        0 => String::new(),
        rows => format!(", {rows} rows with missing values or other levels not used"),
    };
    lines.add(format!("{} observations ({}){elsewhere}", result.n, sizes.join(", ")));
    lines.add(format!(
        "U = {}, p {}",
        format_number(result.statistic),
        format_p(result.p_value, result.ln_p)
    ));
    lines.add(format!(
        "effect: rank-biserial correlation = {}",
        format_number(result.rank_biserial)
    ));
    lines.add(format!(
        "Hodges-Lehmann shift = {}, 95 % interval {} to {}",
        format_number(result.estimate),
        format_number(result.ci_low),
        format_number(result.ci_high)
    ));
    lines.warnings(&result.warnings);
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distribution_is_that_of_enumeration() {
        for (m, n) in [(1, 1), (2, 3), (4, 4), (5, 2), (3, 7)] {
            let mut counts = vec![0.0; m * n + 1];
            let mut all = 0.0;
            for chosen in 0u32..1 << (m + n) {
                if chosen.count_ones() as usize != m {
                    continue;
                }
                let mut u = 0;
                let mut others = 0;
                for place in 0..m + n {
                    if chosen >> place & 1 == 1 {
                        u += others;
                    } else {
                        others += 1;
                    }
                }
                counts[u] += 1.0;
                all += 1.0;
            }
            let expected: Vec<f64> = counts.iter().map(|c| c / all).collect();
            assert_eq!(u_distribution(m, n), expected, "{m} {n}");
        }
    }
}
