//! Kruskal-Wallis test and Dunn's comparisons.
//!
//! Kruskal and Wallis 1952: H = (n - 1) * between-group sum of squares of midranks / total sum of
//! squares, which contains the tie correction; upper chi-square tail with k - 1 degrees of freedom.

use std::collections::HashMap;

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::adjust::Adjustment;
use crate::distributions::tail::{Alternative, chi_square_upper, normal_tail};
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{Arguments, Choice, GROUP, ProcedureOption, RESPONSE};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::ranks::Ranks;
use crate::ranks::grouped::Grouped;
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::Table;
use crate::table::factor::Factor;

/// Arrangements of the observations into groups up to which the permutation p is enumerated.
const ENUMERATED: f64 = 1e6;

/// Result of [`kruskal_wallis`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KruskalWallis {
    /// Always `kruskal-wallis`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// Observations used.
    pub n: usize,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// Groups.
    pub k: usize,
    /// H, corrected for ties.
    pub statistic: f64,
    /// Degrees of freedom, k - 1.
    pub df: usize,
    /// Upper chi-square tail.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// 1 - sum(t^3 - t) / (n^3 - n).
    pub tie_correction: f64,
    /// Effect size H / (n - 1).
    pub epsilon_squared: f64,
    /// Effect size (H - k + 1) / (n - k), which may be negative; none where n = k.
    #[serde(rename = "eta_squared_H")]
    pub eta_squared_h: Option<f64>,
    /// Observations a group.
    pub group_n: Labelled<usize>,
    /// Mean midrank a group.
    pub mean_ranks: Labelled<f64>,
    /// Median a group.
    pub medians: Labelled<f64>,
    /// Share of all arrangements with a statistic as large, where there are few enough to enumerate.
    pub exact_permutation_p: Option<f64>,
    /// Dunn's comparisons of all pairs.
    pub dunn: Dunn,
    /// What to mind.
    pub warnings: Vec<String>,
}

/// Dunn 1964: differences of mean ranks in units of their tie-corrected standard error, two-sided.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Dunn {
    /// `a | b` is a minus b.
    pub pairs: Vec<String>,
    /// z a pair.
    pub z: Vec<f64>,
    /// Two-sided p a pair.
    pub p: Vec<f64>,
    /// Holm's correction.
    pub p_holm: Vec<f64>,
    /// Bonferroni's correction.
    pub p_bonferroni: Vec<f64>,
    /// Benjamini and Hochberg's correction.
    #[serde(rename = "p_BH")]
    pub p_bh: Vec<f64>,
    /// Benjamini and Yekutieli's correction.
    #[serde(rename = "p_BY")]
    pub p_by: Vec<f64>,
    /// Hochberg's correction.
    pub p_hochberg: Vec<f64>,
}

impl Dunn {
    /// The p-values under a correction.
    pub fn adjusted(&self, adjustment: Adjustment) -> &[f64] {
        match adjustment {
            Adjustment::Holm => &self.p_holm,
            Adjustment::Bonferroni => &self.p_bonferroni,
            Adjustment::Bh => &self.p_bh,
            Adjustment::By => &self.p_by,
            Adjustment::Hochberg => &self.p_hochberg,
        }
    }
}

/// Do groups differ in location? Rows with a missing response or group are dropped and counted.
///
/// Refuses a group column with one level; undefined if all responses are equal.
pub fn kruskal_wallis(
    response: &Numbers,
    group: &Factor,
) -> Result<Outcome<KruskalWallis>, Refusal> {
    let grouped = match Grouped::of(response, group)? {
        Outcome::Undefined { reason } => return Ok(Outcome::Undefined { reason }),
        Outcome::Ok(grouped) => grouped,
    };
    let Grouped { ranks, group, dropped, sizes, doubled_sums, .. } = &grouped;
    let (k, n) = (group.levels.len(), ranks.len());
    let mean_ranks: Vec<f64> =
        doubled_sums.iter().zip(sizes).map(|(&sum, &n)| sum as f64 / 2.0 / n as f64).collect();
    let grand_mean = (n as f64 + 1.0) / 2.0;
    let between: f64 =
        mean_ranks.iter().zip(sizes).map(|(m, &n)| n as f64 * (m - grand_mean).powi(2)).sum();
    let total = ranks.sum_of_squares();
    let statistic = (n - 1) as f64 * between / total;
    let tail = chi_square_upper(statistic, (k - 1) as f64);

    let mut warnings = Vec::new();
    if let Some(smallest) = sizes.iter().min()
        && *smallest < 5
    {
        warnings.push(format!(
            "the smallest group has {smallest} observations: the chi-square approximation is rough"
        ));
    }
    let n_cubed = n as f64 * ((n * n) as f64 - 1.0);
    Ok(Outcome::Ok(KruskalWallis {
        test: "kruskal-wallis",
        variant: "chi-square approximation, corrected for ties",
        n,
        dropped: *dropped,
        k,
        statistic,
        df: k - 1,
        p_value: tail.p,
        ln_p: tail.ln_p,
        tie_correction: 1.0 - ranks.tie_term() / n_cubed,
        epsilon_squared: statistic / (n - 1) as f64,
        eta_squared_h: (n > k).then(|| (statistic - k as f64 + 1.0) / (n - k) as f64),
        group_n: Labelled::zip(&group.levels, sizes.iter().copied()),
        medians: Labelled::zip(&group.levels, grouped.medians()),
        exact_permutation_p: permutation_p(ranks, sizes, doubled_sums),
        dunn: dunn(&group.levels, &mean_ranks, sizes, total / (n - 1) as f64),
        mean_ranks: Labelled::zip(&group.levels, mean_ranks),
        warnings,
    }))
}

/// `rank_variance` is the total sum of squares of the midranks over n - 1.
fn dunn(levels: &[String], mean_ranks: &[f64], sizes: &[usize], rank_variance: f64) -> Dunn {
    let (mut pairs, mut z, mut p) = (Vec::new(), Vec::new(), Vec::new());
    for a in 0..levels.len() {
        for b in a + 1..levels.len() {
            let spread = rank_variance * (1.0 / sizes[a] as f64 + 1.0 / sizes[b] as f64);
            let score = (mean_ranks[a] - mean_ranks[b]) / spread.sqrt();
            pairs.push(format!("{} | {}", levels[a], levels[b]));
            z.push(score);
            p.push(normal_tail(score, Alternative::TwoSided).p);
        }
    }
    let given: Vec<Option<f64>> = p.iter().copied().map(Some).collect();
    let adjusted = |by: Adjustment| by.apply(&given).into_iter().flatten().collect::<Vec<f64>>();
    Dunn {
        p_holm: adjusted(Adjustment::Holm),
        p_bonferroni: adjusted(Adjustment::Bonferroni),
        p_bh: adjusted(Adjustment::Bh),
        p_by: adjusted(Adjustment::By),
        p_hochberg: adjusted(Adjustment::Hochberg),
        pairs,
        z,
        p,
    }
}

/// Share of all assignments of the midranks to groups of these sizes whose statistic is at least the
/// observed one. Counts rank sums by dynamic programming over the observations, in integers.
fn permutation_p(ranks: &Ranks, sizes: &[usize], observed: &[u64]) -> Option<f64> {
    let n = ranks.len();
    let ln_arrangements = libm::lgamma(n as f64 + 1.0)
        - sizes.iter().map(|&size| libm::lgamma(size as f64 + 1.0)).sum::<f64>();
    if ln_arrangements > ENUMERATED.ln() || n > 60 {
        return None;
    }
    // Sum of S_j^2 / n_j decides; times the product of the sizes it is an integer.
    let common: u128 =
        sizes.iter().try_fold(1u128, |product, &n| product.checked_mul(n as u128))?;
    let weight = |sums: &[u64]| -> u128 {
        sums.iter()
            .zip(sizes)
            .map(|(&sum, &n)| u128::from(sum) * u128::from(sum) * (common / n as u128))
            .sum()
    };
    if common > 1 << 60 {
        return None;
    }
    // State: observations and doubled rank sum in each group.
    type State = Vec<(usize, u64)>;
    let mut states: HashMap<State, f64> = HashMap::from([(vec![(0, 0); sizes.len()], 1.0)]);
    for observation in 0..n {
        let rank = ranks.doubled_rank(observation);
        let mut next: HashMap<State, f64> = HashMap::new();
        for (state, ways) in states {
            for group in 0..sizes.len() {
                if state[group].0 < sizes[group] {
                    let mut with = state.clone();
                    with[group].0 += 1;
                    with[group].1 += rank;
                    *next.entry(with).or_insert(0.0) += ways;
                }
            }
        }
        states = next;
    }
    let limit = weight(observed);
    let (mut extreme, mut all) = (0.0, 0.0);
    for (state, ways) in &states {
        let sums: Vec<u64> = state.iter().map(|(_, sum)| *sum).collect();
        all += ways;
        if weight(&sums) >= limit {
            extreme += ways;
        }
    }
    Some(extreme / all)
}

/// `mimique test kruskal-wallis`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "kruskal-wallis",
    question: "Do independent groups differ? With Dunn's comparisons of all pairs",
    options: &[&[
        RESPONSE,
        GROUP,
        ProcedureOption::list("levels", "Groups to use, in this order"),
        POSTHOC,
        ADJUST,
    ]],
    run,
    sample: Sample::Groups,
    r: r#"
kruskal_wallis <- function(data) {
  test <- kruskal.test(data$values, data$groups)
  h <- unname(test$statistic)
  n <- length(data$values)
  c(statistic = h, p = test$p.value, effect = h / (n - 1), n = n)
}
"#,
    python: r#"
def kruskal_wallis(samples):
    h, p = stats.kruskal(*samples)
    n = sum(map(len, samples))
    return dict(statistic=h, p=p, effect=h / (n - 1), n=n)
"#,
    golden_cases: "kruskal_wallis",
};

const POSTHOC: ProcedureOption = ProcedureOption::one_of(
    "posthoc",
    "Comparisons of pairs to print",
    &[Choice::new("dunn", "Dunn's z of mean ranks")],
    None,
);

const ADJUST: ProcedureOption = ProcedureOption::one_of(
    "adjust",
    "Correction of those comparisons",
    &[
        Choice::new("holm", "Holm"),
        Choice::new("bonferroni", "Bonferroni"),
        Choice::new("bh", "Benjamini and Hochberg").or(&["BH", "fdr"]),
        Choice::new("by", "Benjamini and Yekutieli").or(&["BY"]),
        Choice::new("hochberg", "Hochberg"),
    ],
    Some("holm"),
);

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let group = arguments.groups(table)?;
    let outcome = kruskal_wallis(&arguments.numbers(table, "response")?, &group)?;
    let adjustment = arguments.chosen(&ADJUST)?.and_then(Adjustment::from_name);
    let posthoc = arguments.chosen(&POSTHOC)?.and(adjustment);
    Ok(Answer::of_test(&outcome, |result| words(result, posthoc)))
}

impl TestResult for KruskalWallis {
    const NAMES: TestNames = TestNames {
        test: "Kruskal-Wallis",
        short: "Kruskal-Wallis",
        in_words: ["Kruskal-Wallis test", "test de Kruskal-Wallis"],
        statistic: "H",
        statistic_symbol: "H",
        effect: "epsilon squared",
        effect_symbol: "ε²",
        function: "kruskal_wallis",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        vec![Outcome::Ok(TestRow {
            variant: String::new(),
            term: Term::Whole,
            statistic: self.statistic,
            degrees_of_freedom: vec![self.df],
            p_value: self.p_value,
            ln_p: self.ln_p,
            effect: Some(self.epsilon_squared),
            n: self.n,
        })]
    }
}

fn words(result: &KruskalWallis, posthoc: Option<Adjustment>) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Kruskal-Wallis test ({})", result.variant));
    lines.add(format!(
        "{} observations in {} groups{}",
        result.n,
        result.k,
        lines::dropped(result.dropped)
    ));
    lines.add(format!(
        "H = {}, df = {}, p {}",
        format_number(result.statistic),
        result.df,
        format_p(result.p_value, result.ln_p)
    ));
    if let Some(exact) = result.exact_permutation_p {
        lines.add(format!("p over all arrangements {}", lines::p_value(Some(exact))));
    }
    lines.add(format!(
        "effect: epsilon squared = {}, eta squared H = {}",
        format_number(result.epsilon_squared),
        lines::optional(result.eta_squared_h)
    ));
    let mut rows = vec![lines::row(["group", "n", "median", "mean rank"])];
    for (level, count) in result.group_n.iter() {
        let of = |values: &Labelled<f64>| lines::optional(values.get(level).copied());
        rows.push(vec![
            level.to_owned(),
            count.to_string(),
            of(&result.medians),
            of(&result.mean_ranks),
        ]);
    }
    lines.table(&rows);
    if let Some(adjustment) = posthoc {
        lines.add(format!("Dunn's comparisons, {} correction", adjustment.as_str()));
        let dunn = &result.dunn;
        let mut rows = vec![lines::row(["pair", "z", "p", "corrected"])];
        for (i, pair) in dunn.pairs.iter().enumerate() {
            rows.push(vec![
                pair.clone(),
                format_number(dunn.z[i]),
                lines::p_value(Some(dunn.p[i])),
                lines::p_value(Some(dunn.adjusted(adjustment)[i])),
            ]);
        }
        lines.table(&rows);
    }
    lines.warnings(&result.warnings);
    lines.into_text()
}
