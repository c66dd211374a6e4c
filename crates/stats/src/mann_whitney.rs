//! Mann-Whitney test of two groups: U of the first, exact without ties when both have fewer than 50
//! observations, else normal with tie and continuity correction.

use serde::Serialize;

use crate::factor::Factor;
use crate::grouped::Grouped;
use crate::outcome::{Labelled, Outcome, Refusal};
use crate::table::Numbers;
use crate::tail::{Alternative, Tail, normal_quantile_upper, normal_tail};
use crate::walsh::{LEVEL, cut_of, two_sample_interval};

/// Result of [`mann_whitney`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MannWhitney {
    /// Always `mann-whitney`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// The two groups; effects are first minus second.
    pub pair: String,
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
        let problem = format!("{} levels, this test compares two", used.levels.len());
        return Err(Refusal::column(&group.name, problem, "choose two with --levels A,B"));
    }
    let (ranks, dropped) = (&grouped.ranks, grouped.dropped);
    let (x, y) = (grouped.tally(0), grouped.tally(1));
    let (m, n) = (grouped.sizes[0], grouped.sizes[1]);
    let u = (grouped.doubled_sums[0] - (m * (m + 1)) as u64) as f64 / 2.0;
    let pairs = (m * n) as f64;

    let total = (m + n) as f64;
    let variance =
        |tie_term: f64| pairs / 12.0 * ((total + 1.0) - tie_term / (total * (total - 1.0)));
    let sd = variance(ranks.tie_term()).sqrt();
    let distance = u - pairs / 2.0;
    let correction = if distance == 0.0 { 0.0 } else { 0.5 * distance.signum() };
    let plain = normal_tail(distance / sd, Alternative::TwoSided);
    let corrected = normal_tail((distance - correction) / sd, Alternative::TwoSided);
    let small = m < 50 && n < 50;
    let exact = small && !ranks.has_ties();

    let mut warnings = Vec::new();
    let (tail, cut) = if exact {
        let distribution = u_distribution(m, n);
        let observed = u as usize;
        let at_most: f64 = distribution[..=observed].iter().sum();
        let at_least: f64 = distribution[observed..].iter().sum();
        let reachable = distribution[0] <= (1.0 - LEVEL) / 2.0;
        (Tail::from_p(at_most.min(at_least)).doubled(), reachable.then(|| cut_of(distribution)))
    } else {
        if small {
            warnings.push("cannot compute exact p-value with ties".to_owned());
            warnings.push("cannot compute exact confidence intervals with ties".to_owned());
        }
        // Inverting the test: only ties inside a sample remain at every shift.
        let inner = x.tie_term() + y.tie_term();
        let reach =
            0.5 + normal_quantile_upper((1.0 - LEVEL) / 2.0) * variance(inner).max(0.0).sqrt();
        let cut = (pairs / 2.0 - reach).floor();
        (corrected, (cut >= 0.0).then_some(cut as u64))
    };
    let interval = two_sample_interval(&x, &y, cut);
    if !interval.level_reached {
        warnings.push("too few observations for an interval of 95 %: the widest is given".into());
    }
    Ok(Outcome::Ok(MannWhitney {
        test: "mann-whitney",
        variant: if exact {
            "exact, no ties"
        } else {
            "normal, corrected for ties, with continuity correction"
        },
        pair: format!("{} | {}", used.levels[0], used.levels[1]),
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
        warnings,
    }))
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
