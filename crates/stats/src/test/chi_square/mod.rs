//! Pearson's chi-square test of a contingency table.

mod fisher;
mod independence;

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::distributions::tail::{Tail, chi_square_upper};
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::contingency::Contingency;
use fisher::fisher_two_sided;
use independence::Independence;

/// One chi-square statistic.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChiSquareVariant {
    /// Its full name.
    pub method: &'static str,
    /// The statistic.
    pub statistic: f64,
    /// Degrees of freedom.
    pub df: usize,
    /// Upper tail.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// Whether small expected counts make it doubtful.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warnings: Option<&'static str>,
}

/// The likelihood ratio statistic.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GTest {
    /// 2 sum O ln(O/E).
    pub statistic: f64,
    /// Degrees of freedom.
    pub df: usize,
    /// Upper tail.
    pub p_value: f64,
}

/// Result of [`chi_square`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChiSquare {
    /// Always `chi-square`.
    pub test: &'static str,
    /// The variant that answers: with Yates's correction for 2x2.
    pub default_yates_if_2x2: ChiSquareVariant,
    /// Without it.
    pub uncorrected: ChiSquareVariant,
    /// Observations.
    pub n: u64,
    /// Rows of data dropped because of missing values.
    pub dropped: usize,
    /// Empty rows and columns of a given table, left out.
    pub left_out: Vec<String>,
    /// Counts.
    pub observed: Labelled<Labelled<u64>>,
    /// Counts expected of independence.
    pub expected: Labelled<Labelled<f64>>,
    /// The smallest of them.
    pub min_expected: f64,
    /// How many are below 5.
    pub cells_below_5: usize,
    /// (O - E) / sqrt(E (1 - row share) (1 - column share)).
    pub std_residuals: Labelled<Labelled<f64>>,
    /// Cramer's V of the uncorrected statistic.
    pub cramers_v: f64,
    /// Bias-corrected V (Bergsma 2013).
    pub cramers_v_bias_corrected: Option<f64>,
    /// ln p of the uncorrected statistic.
    pub ln_p: f64,
    /// Fisher's exact two-sided p, 2x2 only.
    pub fisher_p: Option<f64>,
    /// Likelihood ratio test.
    pub g_test: GTest,
    /// What to mind.
    pub warnings: Vec<String>,
}

const DOUBTFUL: &str = "Chi-squared approximation may be incorrect";

/// Two rows and two columns at least.
fn require_levels(table: &Contingency) -> Result<(), Refusal> {
    for (levels, name) in [(&table.rows, &table.row_name), (&table.columns, &table.column_name)] {
        if levels.len() < 2 {
            return Err(Refusal::TooFewLevels {
                column: name.clone(),
                levels: levels.clone(),
                rows: table.counts.iter().flatten().sum::<u64>() as usize,
                needed: 2,
            });
        }
    }
    Ok(())
}

fn warnings(table: &Contingency, min_expected: f64, cells_below_5: usize) -> Vec<String> {
    let (r, c) = (table.rows.len(), table.columns.len());
    let mut warnings = Vec::new();
    if cells_below_5 > 0 {
        let two_by_two = (r, c) == (2, 2);
        let advice = if two_by_two { "; see Fisher's exact p" } else { "" };
        warnings.push(format!(
            "{cells_below_5} of {} expected counts are below 5 (smallest {min_expected:.2}): the chi-square approximation is rough{advice}",
            r * c
        ));
    }
    if !table.left_out.is_empty() {
        warnings.push(format!("left out because empty: {}", table.left_out.join(", ")));
    }
    warnings
}

/// Are rows and columns independent? Refuses a single row or column, naming it.
pub fn chi_square(table: &Contingency) -> Result<ChiSquare, Refusal> {
    require_levels(table)?;
    let model = Independence::of(table);
    let two_by_two = (table.rows.len(), table.columns.len()) == (2, 2);
    let (min_expected, cells_below_5) = (model.min_expected(), model.cells_below(5.0));
    let doubt = (cells_below_5 > 0).then_some(DOUBTFUL);
    let variant = |method, shrink| {
        let (statistic, df) = (model.statistic(shrink), model.df());
        let Tail { p, ln_p } = chi_square_upper(statistic, df as f64);
        ChiSquareVariant { method, statistic, df, p_value: p, ln_p, warnings: doubt }
    };
    let uncorrected = variant("Pearson's Chi-squared test", 0.0);
    let default_yates_if_2x2 = if two_by_two {
        variant("Pearson's Chi-squared test with Yates' continuity correction", model.yates())
    } else {
        uncorrected.clone()
    };
    let named = |value: &dyn Fn(usize, usize) -> f64| {
        let row = |i| Labelled::zip(&table.columns, (0..table.columns.len()).map(|j| value(i, j)));
        Labelled::zip(&table.rows, (0..table.rows.len()).map(row))
    };
    let phi_squared = uncorrected.statistic / model.total;
    Ok(ChiSquare {
        test: "chi-square",
        n: table.counts.iter().flatten().sum(),
        dropped: table.dropped,
        left_out: table.left_out.clone(),
        observed: Labelled::zip(
            &table.rows,
            table.counts.iter().map(|row| Labelled::zip(&table.columns, row.iter().copied())),
        ),
        expected: named(&|i, j| model.expected(i, j)),
        min_expected,
        cells_below_5,
        std_residuals: named(&|i, j| model.standardised_residual(i, j)),
        cramers_v: model.cramers_v(phi_squared),
        cramers_v_bias_corrected: model.bias_corrected_v(phi_squared),
        ln_p: uncorrected.ln_p,
        fisher_p: two_by_two.then(|| {
            fisher_two_sided([
                [table.counts[0][0], table.counts[0][1]],
                [table.counts[1][0], table.counts[1][1]],
            ])
        }),
        g_test: g_test(&model),
        default_yates_if_2x2,
        uncorrected,
        warnings: warnings(table, min_expected, cells_below_5),
    })
}

fn g_test(model: &Independence<'_>) -> GTest {
    let (statistic, df) = (model.likelihood_ratio(), model.df());
    GTest { statistic, df, p_value: chi_square_upper(statistic.max(0.0), df as f64).p }
}

/// `mimique test chi-square`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "chi-square",
    question: "Are two factors independent? Pearson's chi-square",
    options: &[&[
        ProcedureOption::text("rows", "Column of the rows")
            .required_unless("counts")
            .requires(&["columns"]),
        ProcedureOption::text("columns", "Column of the columns")
            .required_unless("counts")
            .requires(&["rows"]),
        ProcedureOption::flag(
            "counts",
            "The file is the table itself: labels in the first column, counts in the others",
        )
        .excludes(&["rows", "columns"]),
    ]],
    run,
    sample: Sample::Counts,
    r: r#"
chi_square <- function(data) {
  counts <- table(data$groups, data$values)
  test <- suppressWarnings(chisq.test(counts))
  plain <- suppressWarnings(chisq.test(counts, correct = FALSE))$statistic
  n <- sum(counts)
  c(statistic = unname(test$statistic), p = test$p.value,
    effect = sqrt(unname(plain) / (n * (min(dim(counts)) - 1))), n = n)
}
"#,
    python: r#"
def chi_square(samples):
    answers = sorted(set(np.concatenate(samples)))
    counts = np.array([[(sample == answer).sum() for answer in answers] for sample in samples])
    chosen = stats.chi2_contingency(counts)
    plain = stats.chi2_contingency(counts, correction=False)[0]
    n = counts.sum()
    effect = math.sqrt(plain / (n * (min(counts.shape) - 1)))
    return dict(statistic=chosen[0], p=chosen[1], effect=effect, n=n)
"#,
    golden_cases: "chi_square",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let contingency = if arguments.has("counts") {
        Contingency::from_table(table)?
    } else {
        Contingency::of(&arguments.factor(table, "rows")?, &arguments.factor(table, "columns")?)?
    };
    Ok(Answer::of_test(&Outcome::Ok(chi_square(&contingency)?), words))
}

impl TestResult for ChiSquare {
    const NAMES: TestNames = TestNames {
        test: "chi-square",
        short: "",
        in_words: ["chi-square test", "test du khi-deux"],
        statistic: "chi-square",
        statistic_symbol: "χ²",
        effect: "Cramer's V",
        effect_symbol: "V",
        function: "chi_square",
    };

    /// With Yates's correction for two by two.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let chosen = &self.default_yates_if_2x2;
        vec![Outcome::Ok(TestRow {
            variant: String::new(),
            term: Term::Whole,
            statistic: chosen.statistic,
            degrees_of_freedom: vec![chosen.df],
            p_value: chosen.p_value,
            ln_p: chosen.ln_p,
            effect: Some(self.cramers_v),
            n: self.n as usize,
        })]
    }
}

fn words(result: &ChiSquare) -> String {
    let mut lines = Lines::default();
    let chosen = &result.default_yates_if_2x2;
    lines.add(chosen.method);
    lines.add(format!("{} observations{}", result.n, lines::dropped(result.dropped)));
    lines.add(format!(
        "chi-square = {}, df = {}, p {}",
        format_number(chosen.statistic),
        chosen.df,
        format_p(chosen.p_value, chosen.ln_p)
    ));
    if chosen.method != result.uncorrected.method {
        lines.add(format!(
            "without correction: chi-square = {}, p {}",
            format_number(result.uncorrected.statistic),
            format_p(result.uncorrected.p_value, result.uncorrected.ln_p)
        ));
    }
    if let Some(fisher) = result.fisher_p {
        lines.add(format!("Fisher's exact p {}", lines::p_value(Some(fisher))));
    }
    lines.add(format!(
        "effect: Cramer's V = {} (bias-corrected {})",
        format_number(result.cramers_v),
        lines::optional(result.cramers_v_bias_corrected)
    ));
    lines.add("observed (expected, standardised residual)");
    let mut rows = Vec::new();
    for (label, counts) in result.observed.iter() {
        if rows.is_empty() {
            let header = counts.iter().map(|(column, _)| column);
            rows.push(lines::row(std::iter::once("").chain(header)));
        }
        let mut cells = vec![label.to_owned()];
        for (column, count) in counts.iter() {
            let of = |table: &Labelled<Labelled<f64>>| {
                table.get(label).and_then(|row| row.get(column)).copied().unwrap_or(0.0)
            };
            cells.push(format!(
                "{count} ({:.1}, {:+.1})",
                of(&result.expected),
                of(&result.std_residuals)
            ));
        }
        rows.push(cells);
    }
    lines.table(&rows);
    lines.warnings(&result.warnings);
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(counts: &[Vec<u64>]) -> Contingency {
        let names = |n: usize| (0..n).map(|i| format!("l{i}")).collect::<Vec<_>>();
        Contingency::from_counts(
            ["row", "column"],
            &names(counts.len()),
            &names(counts[0].len()),
            counts,
        )
    }

    #[test]
    fn the_continuity_correction_never_overshoots() {
        // |O - E| is 0.2 here: shrinking by 0.5 would turn it round.
        let result = chi_square(&table(&[vec![5, 5], vec![3, 2]])).unwrap();
        assert!(result.default_yates_if_2x2.statistic.abs() < 1e-12);
        assert!((result.default_yates_if_2x2.p_value - 1.0).abs() < 1e-12);
    }

    #[test]
    fn empty_rows_and_columns_are_left_out_and_named() {
        let result = chi_square(&table(&[vec![5, 0, 1], vec![0, 0, 0], vec![2, 0, 7]])).unwrap();
        assert_eq!(result.left_out, ["l1", "l1"]);
        assert_eq!(result.uncorrected.df, 1);
        assert!(chi_square(&table(&[vec![5, 0], vec![3, 0]])).is_err());
    }

    #[test]
    fn transposing_changes_nothing() {
        let one = chi_square(&table(&[vec![5, 3, 9], vec![2, 8, 4]])).unwrap();
        let two = chi_square(&table(&[vec![5, 2], vec![3, 8], vec![9, 4]])).unwrap();
        assert!((one.uncorrected.statistic - two.uncorrected.statistic).abs() < 1e-12);
        assert!((one.cramers_v - two.cramers_v).abs() < 1e-14);
    }
}
