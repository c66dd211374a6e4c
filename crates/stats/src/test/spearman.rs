//! Spearman's rank correlation, with Kendall's tau-b beside it.

use mimique_locale::format_number;
use serde::Serialize;

use crate::distributions::tail::{Tail, normal_quantile_upper, normal_upper, t_two_sided};
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::ranks::Ranks;
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::Table;
use crate::table::sample::complete_rows;
use crate::test::kendall;
use crate::undefined::Undefined;

/// Up to this many pairs without ties all orders are enumerated.
const ENUMERATED: usize = 9;
/// Up to this many pairs without ties the Edgeworth series of AS 89 is used.
const EDGEWORTH: usize = 1290;

/// Result of [`spearman`].
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct Spearman {
    /// Always `spearman`.
    pub test: &'static str,
    /// How `p_value` was computed.
    pub variant: &'static str,
    /// Pairs used.
    pub n: usize,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// Pearson correlation of the midranks.
    pub rho: f64,
    /// (n^3 - n) (1 - rho) / 6, the sum of squared rank differences where there are no ties.
    pub S: f64,
    /// t = rho sqrt((n - 2) / (1 - rho^2)); none for a perfect correlation.
    pub t: Option<f64>,
    /// Degrees of freedom of t.
    pub df: usize,
    /// Two-sided p: exact up to 9 pairs, Edgeworth to 1290, both without ties; else t.
    pub p_value: Option<f64>,
    /// Natural logarithm of the p of the t approximation.
    pub ln_p: Option<f64>,
    /// p of every variant that exists here.
    pub p_by_semantics: Labelled<Option<f64>>,
    /// Fisher's interval, standard error 1 / sqrt(n - 3).
    pub ci95_fisher: Option<[f64; 2]>,
    /// Fieller, Hartley and Pearson's interval, variance 1.06 / (n - 3).
    pub ci95_fieller: Option<[f64; 2]>,
    /// Bonett and Wright's interval, variance (1 + rho^2 / 2) / (n - 3).
    pub ci95_bonett_wright: Option<[f64; 2]>,
    /// Kendall's tau-b.
    pub kendall_tau_b: f64,
    /// What to mind.
    pub warnings: Vec<String>,
}

/// Do two variables rise together? Undefined if one of them is constant, naming it.
pub fn spearman(x: &Numbers, y: &Numbers) -> Result<Outcome<Spearman>, Refusal> {
    let rows = complete_rows(&[x, y], &[])?;
    let (n, dropped) = (rows.len(), rows.dropped());
    let (rank_x, rank_y) =
        rayon::join(|| Ranks::of(&rows.numbers(x)), || Ranks::of(&rows.numbers(y)));
    for (ranks, column) in [(&rank_x, x), (&rank_y, y)] {
        if ranks.values.len() == 1 {
            let (column, value) = (column.name.clone(), ranks.values[0]);
            return Ok(Outcome::undefined(Undefined::EqualValues { column, n, value }));
        }
    }
    let (squares, kendall_tau_b) = squares_and_tau_b(&rank_x, &rank_y);
    let (ssx, ssy) = (rank_x.sum_of_squares(), rank_y.sum_of_squares());
    // Cov = (SSx + SSy - sum d^2) / 2
    let rho = ((ssx + ssy - squares / 4.0) / 2.0 / (ssx * ssy).sqrt()).clamp(-1.0, 1.0);
    let size = n as f64;
    let s = size * (size * size - 1.0) * (1.0 - rho) / 6.0;

    let ties = rank_x.has_ties() || rank_y.has_ties();
    let perfect = 1.0 - rho * rho < 1e-15;
    let t = (!perfect && n > 2).then(|| rho * ((size - 2.0) / (1.0 - rho * rho)).sqrt());
    let significance = Significance::of(n, s, ties, t);
    let mut warnings = Vec::new();
    if perfect && significance.p().is_none() {
        warnings.push(Undefined::PerfectCorrelation.english());
    }
    if n <= 3 {
        warnings.push(format!("{n} pairs are too few for an interval"));
    }
    let interval = |variance_times| interval(rho, n, variance_times);
    Ok(Outcome::Ok(Spearman {
        test: "spearman",
        variant: significance.variant(),
        n,
        dropped,
        rho,
        S: s,
        t,
        df: n.saturating_sub(2),
        p_value: significance.p(),
        ln_p: significance.by_t.map(|tail| tail.ln_p),
        p_by_semantics: significance.by_semantics(),
        ci95_fisher: fisher_interval(rho, n),
        ci95_fieller: interval(1.06),
        ci95_bonett_wright: bonett_wright_interval(rho, n),
        kendall_tau_b,
        warnings,
    }))
}

/// Bonett and Wright's 95 % interval of a rank correlation of `n` pairs, variance (1 + rho^2 / 2) / (n - 3) of Fisher's z
/// (Psychometrika 65, 2000, p. 23); none of fewer than four pairs, or of a perfect correlation.
pub fn bonett_wright_interval(rho: f64, n: usize) -> Option<[f64; 2]> {
    interval(rho, n, 1.0 + rho * rho / 2.0)
}

/// Fisher's 95 % interval of Pearson's correlation of `n` pairs, variance 1 / (n - 3) of z (Fisher 1921); none of fewer than
/// four pairs, or of a perfect correlation.
pub fn fisher_interval(r: f64, n: usize) -> Option<[f64; 2]> {
    interval(r, n, 1.0)
}

/// A 95 % interval by Fisher's z, whose variance is so many times 1 / (n - 3).
fn interval(rho: f64, n: usize, variance_times: f64) -> Option<[f64; 2]> {
    let perfect = 1.0 - rho * rho < 1e-15;
    (n > 3 && !perfect).then(|| {
        let reach = normal_quantile_upper(0.025) * (variance_times / (n as f64 - 3.0)).sqrt();
        [(rho.atanh() - reach).tanh(), (rho.atanh() + reach).tanh()]
    })
}

/// Sum of squared differences of doubled ranks, and Kendall's tau-b.
fn squares_and_tau_b(x: &Ranks, y: &Ranks) -> (f64, f64) {
    if kendall::is_small_table(x, y) {
        let ranks = (0..x.len()).map(|i| (x.doubled_rank(i), y.doubled_rank(i)));
        return (sum_of_squares(ranks), kendall::by_table(x, y));
    }
    // In the order of x neither ranks are looked up all over the memory.
    let order = y.codes_in_order_of(x);
    let of_x = x.doubled.iter().zip(&x.counts);
    let of_x = of_x.flat_map(|(&rank, &count)| std::iter::repeat_n(rank, count as usize));
    let of_y = order.iter().map(|&code| match y.has_ties() {
        true => y.doubled[code as usize],
        false => 2 * (u64::from(code) + 1),
    });
    (sum_of_squares(of_x.zip(of_y)), kendall::by_sorting(x, y, order))
}

/// Two-sided p of every variant that exists for a correlation.
struct Significance {
    ties: bool,
    exact: Option<f64>,
    edgeworth: Option<f64>,
    by_t: Option<Tail>,
}

impl Significance {
    fn of(n: usize, s: f64, ties: bool, t: Option<f64>) -> Self {
        Self {
            ties,
            exact: (!ties && n <= ENUMERATED)
                .then(|| two_sided(&|q, upper| exact_tail(n, q, upper), s, n)),
            edgeworth: (!ties && n > ENUMERATED && n <= EDGEWORTH)
                .then(|| two_sided(&|q, upper| edgeworth_tail(n, q, upper), s, n)),
            by_t: t.map(|t| t_two_sided(t, n as f64 - 2.0)),
        }
    }

    /// The p that counts, as R chooses it.
    fn p(&self) -> Option<f64> {
        self.exact.or(self.edgeworth).or(self.by_t.map(|tail| tail.p))
    }

    /// How it was computed.
    fn variant(&self) -> &'static str {
        match (self.exact, self.edgeworth) {
            (Some(_), _) => "exact over all orders, no ties",
            (_, Some(_)) => "Edgeworth series (AS 89), no ties",
            _ if self.ties => "t approximation, ties",
            _ => "t approximation",
        }
    }

    fn by_semantics(&self) -> Labelled<Option<f64>> {
        let by_t = self.by_t.map(|tail| tail.p);
        let mut semantics = vec![
            ("R_default".to_owned(), self.p()),
            ("t_approximation".to_owned(), by_t),
            ("scipy".to_owned(), by_t),
        ];
        if self.exact.is_some() {
            semantics.push(("exact_permutation".to_owned(), self.exact));
        }
        Labelled(semantics)
    }
}

/// Sum of squared differences of doubled ranks: an integer, so its order does not matter.
fn sum_of_squares(ranks: impl Iterator<Item = (u64, u64)>) -> f64 {
    let squares = ranks.map(|(x, y)| u128::from(x.abs_diff(y)).pow(2));
    squares.sum::<u128>() as f64
}

/// Twice the smaller tail of S; S is an even integer without ties. `tail(q, true)` is P(S >= q), else
/// P(S < q).
fn two_sided(tail: &dyn Fn(f64, bool) -> f64, s: f64, n: usize) -> f64 {
    let s = s.round();
    let size = n as f64;
    let one_sided =
        if s > size * (size * size - 1.0) / 6.0 { tail(s, true) } else { tail(s + 2.0, false) };
    Tail::from_p(one_sided).doubled().p
}

/// Tail of S over all orders of n.
fn exact_tail(n: usize, q: f64, upper: bool) -> f64 {
    let counts = sum_of_squares_counts(n);
    let all: u64 = counts.iter().sum();
    let at_least: u64 =
        counts.iter().enumerate().filter(|(s, _)| *s as f64 >= q).map(|(_, count)| count).sum();
    (if upper { at_least } else { all - at_least }) as f64 / all as f64
}

/// Number of orders of n for every sum of squared rank differences, by the set of ranks already used.
fn sum_of_squares_counts(n: usize) -> Vec<u64> {
    let largest = n * (n * n - 1) / 3;
    let mut ways: Vec<Vec<u64>> = vec![Vec::new(); 1 << n];
    ways[0] = vec![0; largest + 1];
    ways[0][0] = 1;
    for used in 0usize..1 << n {
        let from = std::mem::take(&mut ways[used]);
        if used == (1 << n) - 1 {
            return from;
        }
        let place = used.count_ones() as usize;
        for rank in (0..n).filter(|rank| used >> rank & 1 == 0) {
            let square = place.abs_diff(rank).pow(2);
            let to = &mut ways[used | 1 << rank];
            to.resize(largest + 1, 0);
            for s in 0..=largest - square {
                to[s + square] += from[s];
            }
        }
    }
    Vec::new()
}

/// Best and Roberts 1975, algorithm AS 89: Edgeworth series of the tail of S.
fn edgeworth_tail(n: usize, q: f64, upper: bool) -> f64 {
    let size = n as f64;
    let b = 1.0 / size;
    let x = (6.0 * (q - 1.0) * b / (size * size - 1.0) - 1.0) * (size - 1.0).sqrt();
    let y = x * x;
    let series = x
        * b
        * (0.2274
            + b * (0.2531 + 0.1745 * b)
            + y * (-0.0758 + b * (0.1033 + 0.3932 * b)
                - y * b
                    * (0.0879 + 0.0151 * b
                        - y * (0.0072 - 0.0831 * b + y * b * (0.0131 - 0.00046 * y)))));
    let correction = series / (y / 2.0).exp();
    let tail = if upper { correction + normal_upper(x).p } else { normal_upper(-x).p - correction };
    tail.clamp(0.0, 1.0)
}

/// `mimique test spearman`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "spearman",
    question: "Do two variables rise together? Spearman's rho, with Kendall's tau-b",
    options: &[&[
        ProcedureOption::text("x", "Column of numbers").required(),
        ProcedureOption::text("y", "Column of numbers").required(),
    ]],
    run,
    sample: Sample::Columns,
    r: r#"
spearman <- function(x, y) {
  keep <- !is.na(x) & !is.na(y)
  test <- suppressWarnings(cor.test(x[keep], y[keep], method = "spearman"))
  c(statistic = unname(test$estimate), p = test$p.value, effect = unname(test$estimate), n = sum(keep))
}
"#,
    python: r#"
def spearman_p(x, y, rho):
    """As R: over all orders up to 9 pairs, Edgeworth series (AS 89) to 1290, both without ties."""
    n = len(x)
    ties = len(set(x)) < n or len(set(y)) < n
    if ties or n > 1290:
        return stats.spearmanr(x, y).pvalue
    s = round(n * (n * n - 1) * (1 - rho) / 6)
    upper = s > n * (n * n - 1) / 6
    if n <= 9:
        sums = [
            sum((i - j) ** 2 for i, j in enumerate(order)) for order in itertools.permutations(range(n))
        ]
        tail = np.mean(np.array(sums) >= s) if upper else np.mean(np.array(sums) <= s)
        return min(1.0, 2 * tail)
    b = 1 / n
    q = s if upper else s + 2
    z = (6 * (q - 1) * b / (n * n - 1) - 1) * math.sqrt(n - 1)
    w = z * z
    inner = 0.0879 + 0.0151 * b - w * (0.0072 - 0.0831 * b + w * b * (0.0131 - 0.00046 * w))
    series = z * b * (
        0.2274 + b * (0.2531 + 0.1745 * b) + w * (-0.0758 + b * (0.1033 + 0.3932 * b) - w * b * inner)
    )
    correction = series / math.exp(w / 2)
    tail = correction + stats.norm.sf(z) if upper else stats.norm.cdf(z) - correction
    return min(1.0, 2 * min(max(tail, 0.0), 1.0))


def spearman(x, y):
    keep = ~np.isnan(x) & ~np.isnan(y)
    x, y = x[keep], y[keep]
    rho = stats.spearmanr(x, y).statistic
    return dict(statistic=rho, p=spearman_p(x, y, rho), effect=rho, n=len(x))
"#,
    golden_cases: "spearman",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let (x, y) = (arguments.numbers(table, "x")?, arguments.numbers(table, "y")?);
    Ok(Answer::of_test(&spearman(&x, &y)?, words))
}

impl TestResult for Spearman {
    const NAMES: TestNames = TestNames {
        test: "Spearman",
        short: "Spearman",
        in_words: ["Spearman’s correlation", "corrélation de Spearman"],
        statistic: "rho",
        statistic_symbol: "rho",
        effect: "rho",
        effect_symbol: "rho",
        function: "spearman",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        vec![match self.p_value {
            None => Outcome::undefined(Undefined::PerfectCorrelation),
            Some(p_value) => Outcome::Ok(TestRow {
                variant: String::new(),
                term: Term::Whole,
                statistic: self.rho,
                degrees_of_freedom: vec![self.df],
                p_value,
                ln_p: p_value.ln(),
                effect: Some(self.rho),
                n: self.n,
            }),
        }]
    }
}

fn words(result: &Spearman) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Spearman's rank correlation ({})", result.variant));
    lines.add(format!("{} pairs{}", result.n, lines::dropped(result.dropped)));
    lines.add(format!(
        "rho = {}, p {}; t = {}, df = {}",
        format_number(result.rho),
        lines::p_value(result.p_value),
        lines::optional(result.t),
        result.df
    ));
    if let Some([low, high]) = result.ci95_bonett_wright {
        lines.add(format!(
            "95 % interval {} to {} (Bonett and Wright)",
            format_number(low),
            format_number(high)
        ));
    }
    lines.add(format!("Kendall's tau-b = {}", format_number(result.kendall_tau_b)));
    lines.warnings(&result.warnings);
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_those_of_all_orders() {
        // n = 3: S = 0 once, 2 twice, 6 twice, 8 once.
        let counts = sum_of_squares_counts(3);
        assert_eq!([counts[0], counts[2], counts[6], counts[8]], [1, 2, 2, 1]);
        assert_eq!(sum_of_squares_counts(9).iter().sum::<u64>(), 362_880);
    }

    #[test]
    fn the_series_is_close_to_the_exact_tail() {
        for q in [60.0, 100.0, 140.0, 180.0] {
            let exact = exact_tail(9, q, true);
            assert!((edgeworth_tail(9, q, true) - exact).abs() < 0.003, "{q}");
        }
    }
}
