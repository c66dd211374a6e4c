//! Friedman's test of one observation a block and group, with Iman and Davenport's F, Kendall's W and
//! Quade's test beside it.

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::adjust::Adjustment;
use crate::distributions::tail::{chi_square_upper, f_upper};
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{Arguments, GROUP, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::ranks::Ranks;
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::Table;
use crate::table::blocks::Blocks;
use crate::table::pairs::rounded;
use crate::test::wilcoxon::{WilcoxonOptions, thesis_p_without_rounding, wilcoxon};
use crate::undefined::Undefined;

/// Result of [`friedman`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Friedman {
    /// Always `friedman`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// Friedman's chi-square, corrected for ties.
    pub statistic: f64,
    /// Degrees of freedom, k - 1.
    pub df: usize,
    /// Upper chi-square tail.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// Blocks used.
    pub n_blocks: usize,
    /// Blocks left out because a group is missing in them.
    pub incomplete_blocks: usize,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// Groups.
    pub k: usize,
    /// Effect size, chi-square / (n (k - 1)).
    pub kendalls_w: f64,
    /// Mean rank within blocks a group.
    pub mean_ranks: Labelled<f64>,
    /// Mean response a group, over the blocks used.
    pub means: Labelled<f64>,
    /// Iman and Davenport 1980; none where all blocks agree perfectly (its denominator is zero).
    pub iman_davenport: Option<ImanDavenport>,
    /// Quade 1979; none where it does not exist.
    pub quade: Option<Quade>,
    /// Paired Wilcoxon tests of all pairs as R 4.2's `pairwise.wilcox.test` computes them (differences
    /// not rounded, zeros dropped, exact only below 50 without ties), with Holm's correction.
    pub posthoc_wilcoxon_holm: PairwiseHolm,
    /// Recommended comparisons: exact conditional Wilcoxon with Pratt's zeros, Holm.
    pub posthoc_exact_pratt_holm: PairwiseHolm,
    /// What to mind.
    pub warnings: Vec<String>,
}

/// Iman and Davenport's F.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct ImanDavenport {
    /// (n - 1) chi-square / (n (k - 1) - chi-square).
    pub F: f64,
    /// k - 1.
    pub df1: usize,
    /// (k - 1)(n - 1).
    pub df2: usize,
    /// Upper F tail.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
}

/// Quade's test: blocks weighted by the rank of their range.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quade {
    /// `Quade test`.
    pub method: &'static str,
    /// F.
    pub statistic: f64,
    /// k - 1.
    pub df1: usize,
    /// (k - 1)(n - 1).
    pub df2: usize,
    /// Upper F tail.
    pub p_value: f64,
}

/// All pairs of groups with Holm's correction; a pair without any difference has no p.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairwiseHolm {
    /// `a | b` is a minus b.
    pub pairs: Vec<String>,
    /// p of a pair.
    pub p: Vec<Option<f64>>,
    /// After Holm's correction.
    pub p_holm: Vec<Option<f64>>,
}

/// Do groups differ within blocks? Undefined if no block is complete, or if in each block all responses
/// are equal.
pub fn friedman(blocks: &Blocks) -> Outcome<Friedman> {
    let (n, k) = (blocks.responses.len(), blocks.groups.len());
    if n == 0 {
        let incomplete = blocks.incomplete;
        return Outcome::undefined(Undefined::NoCompleteBlock { groups: k, incomplete });
    }
    // Means differ by 1e-16 noise, and that would break ties.
    let ranks: Vec<Ranks> =
        blocks.responses.iter().map(|block| Ranks::of(&without_noise(block))).collect();
    let mut doubled_sums = vec![0u64; k];
    let mut within = 0.0;
    for block in &ranks {
        within += block.sum_of_squares();
        for (group, sum) in doubled_sums.iter_mut().enumerate() {
            *sum += block.doubled_rank(group);
        }
    }
    if within == 0.0 {
        return Outcome::undefined(Undefined::EqualWithinBlocks { blocks: n });
    }
    let (blocks_f, groups_f) = (n as f64, k as f64);
    let centre = blocks_f * (groups_f + 1.0) / 2.0;
    let between: f64 = doubled_sums.iter().map(|&sum| (sum as f64 / 2.0 - centre).powi(2)).sum();
    // Conover 1999: (k - 1) sum (R_j - n (k + 1)/2)^2 / within-block sum of squares of ranks.
    let statistic = (groups_f - 1.0) * between / within;
    let tail = chi_square_upper(statistic, groups_f - 1.0);
    let iman_davenport = iman_davenport(statistic, n, k);
    let warnings = warnings(blocks, iman_davenport.is_some());
    Outcome::Ok(Friedman {
        test: "friedman",
        variant: "chi-square approximation, corrected for ties; complete blocks only",
        statistic,
        df: k - 1,
        p_value: tail.p,
        ln_p: tail.ln_p,
        n_blocks: n,
        incomplete_blocks: blocks.incomplete,
        dropped: blocks.dropped,
        k,
        kendalls_w: statistic / (blocks_f * (groups_f - 1.0)),
        mean_ranks: Labelled::zip(
            &blocks.groups,
            doubled_sums.iter().map(|&sum| sum as f64 / 2.0 / blocks_f),
        ),
        means: Labelled::zip(
            &blocks.groups,
            (0..k).map(|j| blocks.responses.iter().map(|block| block[j]).sum::<f64>() / blocks_f),
        ),
        iman_davenport,
        quade: quade(blocks, &ranks),
        posthoc_wilcoxon_holm: pairwise(blocks, thesis_p_without_rounding),
        posthoc_exact_pratt_holm: pairwise(blocks, exact_pratt_p),
        warnings,
    })
}

/// F with k - 1 and (k - 1)(n - 1) degrees of freedom, of Friedman's chi-square of n blocks and k groups.
fn iman_davenport(chi_square: f64, n: usize, k: usize) -> Option<ImanDavenport> {
    let (blocks, groups) = (n as f64, k as f64);
    let room = blocks * (groups - 1.0) - chi_square;
    let (df1, df2) = (k - 1, (k - 1) * (n - 1));
    (room > 1e-9 && df2 > 0).then(|| {
        let f = (blocks - 1.0) * chi_square / room;
        let tail = f_upper(f, df1 as f64, df2 as f64);
        ImanDavenport { F: f, df1, df2, p_value: tail.p, ln_p: tail.ln_p }
    })
}

/// Why Iman and Davenport's F does not exist.
fn without_f(blocks: usize) -> Undefined {
    if blocks < 2 { Undefined::OneBlock } else { Undefined::BlocksAgree }
}

fn warnings(blocks: &Blocks, has_iman_davenport: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    if !has_iman_davenport {
        warnings.push(without_f(blocks.responses.len()).english());
    }
    if blocks.incomplete > 0 {
        warnings.push(format!("{} incomplete blocks were left out", blocks.incomplete));
    }
    warnings
}

/// p of the recommended Wilcoxon test of differences; none where it is undefined.
fn exact_pratt_p(differences: &[f64]) -> Option<f64> {
    let differences = Numbers { name: String::new(), values: differences.to_vec() };
    Some(wilcoxon(&differences, WilcoxonOptions::default()).ok()?.ok()?.p_value)
}

fn without_noise(values: &[f64]) -> Vec<f64> {
    values.iter().map(|&value| rounded(value)).collect()
}

fn pairwise(blocks: &Blocks, test: impl Fn(&[f64]) -> Option<f64>) -> PairwiseHolm {
    let tested: Vec<(Numbers, Option<f64>)> = blocks
        .pairs()
        .into_iter()
        .map(|(a, b)| {
            let differences = blocks.differences(a, b);
            let p = test(&differences.values);
            (differences, p)
        })
        .collect();
    let p: Vec<Option<f64>> = tested.iter().map(|(_, p)| *p).collect();
    PairwiseHolm {
        pairs: tested.into_iter().map(|(differences, _)| differences.name).collect(),
        p_holm: Adjustment::Holm.apply(&p),
        p,
    }
}

/// Quade 1979: S_ij = Q_i (r_ij - (k + 1)/2), Q_i the rank of block i's range; F on its sums.
fn quade(blocks: &Blocks, ranks: &[Ranks]) -> Option<Quade> {
    let (n, k) = (blocks.responses.len(), blocks.groups.len());
    let ranges: Vec<f64> = blocks
        .responses
        .iter()
        .map(|block| {
            block.iter().copied().fold(f64::NEG_INFINITY, f64::max)
                - block.iter().copied().fold(f64::INFINITY, f64::min)
        })
        .collect();
    // Not rounded, as R does it: ranges that differ by rounding only are not ties here.
    let weights = Ranks::of(&ranges);
    let score = |i: usize, j: usize| weights.rank(i) * (ranks[i].rank(j) - (k as f64 + 1.0) / 2.0);
    let squares: f64 =
        (0..n).flat_map(|i| (0..k).map(move |j| (i, j))).map(|(i, j)| score(i, j).powi(2)).sum();
    let between: f64 =
        (0..k).map(|j| (0..n).map(|i| score(i, j)).sum::<f64>().powi(2)).sum::<f64>() / n as f64;
    let rest = squares - between;
    if n < 2 || rest <= squares * 1e-12 {
        return None;
    }
    let statistic = (n - 1) as f64 * between / rest;
    let (df1, df2) = (k - 1, (k - 1) * (n - 1));
    let p_value = f_upper(statistic, df1 as f64, df2 as f64).p;
    Some(Quade { method: "Quade test", statistic, df1, df2, p_value })
}

/// `mimique test friedman`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "friedman",
    question: "Do groups differ within blocks? With Iman and Davenport's F and Quade's test",
    options: &[&[
        ProcedureOption::text("response", "Column of numbers, one a block and group").required(),
        GROUP,
        ProcedureOption::text(
            "block",
            "Column of the blocks (participants), or several with commas between",
        )
        .required(),
        ProcedureOption::list("levels", "Groups to use, in this order"),
    ]],
    run,
    sample: Sample::Blocks,
    r: r#"
friedman <- function(m) {
  n <- nrow(m)
  k <- ncol(m)
  chi_square <- unname(friedman.test(m)$statistic)
  f <- (n - 1) * chi_square / (n * (k - 1) - chi_square)
  c(statistic = f, p = pf(f, k - 1, (k - 1) * (n - 1), lower.tail = FALSE),
    effect = chi_square / (n * (k - 1)), n = n)
}
"#,
    python: r#"
def friedman(m):
    n, k = m.shape
    chi_square = stats.friedmanchisquare(*m.T)[0]
    f = (n - 1) * chi_square / (n * (k - 1) - chi_square)
    p = stats.f.sf(f, k - 1, (k - 1) * (n - 1))
    return dict(statistic=f, p=p, effect=chi_square / (n * (k - 1)), n=n)
"#,
    golden_cases: "friedman",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let group = arguments.groups(table)?;
    let block = table.combined_factor(arguments.needed("block")?)?;
    let blocks = Blocks::of(&arguments.numbers(table, "response")?, &group, &block)?;
    Ok(Answer::of_test(&friedman(&blocks), words))
}

impl TestResult for Friedman {
    const NAMES: TestNames = TestNames {
        test: "Friedman",
        short: "Friedman",
        in_words: ["Friedman’s test", "test de Friedman"],
        statistic: "F",
        statistic_symbol: "F",
        effect: "Kendall's W",
        effect_symbol: "W",
        function: "friedman",
    };

    /// Iman and Davenport's F.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        vec![match &self.iman_davenport {
            None => Outcome::undefined(without_f(self.n_blocks)),
            Some(f) => Outcome::Ok(TestRow {
                variant: "Iman-Davenport".to_owned(),
                term: Term::Whole,
                statistic: f.F,
                degrees_of_freedom: vec![f.df1, f.df2],
                p_value: f.p_value,
                ln_p: f.ln_p,
                effect: Some(self.kendalls_w),
                n: self.n_blocks,
            }),
        }]
    }
}

pub(crate) fn words(result: &Friedman) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Friedman test ({})", result.variant));
    lines.add(format!(
        "{} blocks, {} groups{}",
        result.n_blocks,
        result.k,
        lines::dropped(result.dropped)
    ));
    lines.add(format!(
        "chi-square = {}, df = {}, p {}",
        format_number(result.statistic),
        result.df,
        format_p(result.p_value, result.ln_p)
    ));
    if let Some(f) = &result.iman_davenport {
        lines.add(format!(
            "Iman and Davenport: F = {}, df = {} and {}, p {}",
            format_number(f.F),
            f.df1,
            f.df2,
            format_p(f.p_value, f.ln_p)
        ));
    }
    if let Some(quade) = &result.quade {
        lines.add(format!(
            "Quade: F = {}, df = {} and {}, p {}",
            format_number(quade.statistic),
            quade.df1,
            quade.df2,
            lines::p_value(Some(quade.p_value))
        ));
    }
    lines.add(format!("effect: Kendall's W = {}", format_number(result.kendalls_w)));
    let mut rows = vec![lines::row(["group", "mean rank", "mean"])];
    for (level, rank) in result.mean_ranks.iter() {
        rows.push(vec![
            level.to_owned(),
            format_number(*rank),
            lines::optional(result.means.get(level).copied()),
        ]);
    }
    lines.table(&rows);
    lines.add("paired comparisons: Wilcoxon, exact conditional, Pratt; Holm");
    let pairwise = &result.posthoc_exact_pratt_holm;
    let mut rows = vec![lines::row(["pair", "p", "corrected"])];
    for (i, pair) in pairwise.pairs.iter().enumerate() {
        rows.push(vec![
            pair.clone(),
            lines::p_value(pairwise.p[i]),
            lines::p_value(pairwise.p_holm[i]),
        ]);
    }
    lines.table(&rows);
    lines.warnings(&result.warnings);
    lines.into_text()
}
