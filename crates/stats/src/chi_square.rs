//! Pearson's chi-square test of a contingency table.

use serde::Serialize;

use crate::factor::Factor;
use crate::outcome::{Labelled, Refusal};
use crate::sample::complete_rows;
use crate::table::Table;
use crate::tail::{Tail, chi_square_upper};

/// A table of counts with named rows and columns, none of them empty.
#[derive(Debug, Clone, PartialEq)]
pub struct Contingency {
    /// Name of the row factor.
    pub row_name: String,
    /// Name of the column factor.
    pub column_name: String,
    /// Levels of the rows.
    pub rows: Vec<String>,
    /// Levels of the columns.
    pub columns: Vec<String>,
    /// Counts, row after row.
    pub counts: Vec<Vec<u64>>,
    /// Rows of data dropped because of missing values.
    pub dropped: usize,
    /// Rows and columns left out because they were empty.
    pub left_out: Vec<String>,
}

impl Contingency {
    /// Counts two factors.
    pub fn of(rows: &Factor, columns: &Factor) -> Result<Self, Refusal> {
        let complete = complete_rows(&[], &[rows, columns])?;
        let dropped = complete.dropped();
        let (rows, columns) = (complete.factor(rows), complete.factor(columns));
        let mut counts = vec![vec![0; columns.levels.len()]; rows.levels.len()];
        for (&row, &column) in rows.codes.iter().zip(&columns.codes) {
            counts[row as usize][column as usize] += 1;
        }
        Ok(Self {
            row_name: rows.name.clone(),
            column_name: columns.name.clone(),
            rows: rows.levels.clone(),
            columns: columns.levels.clone(),
            counts,
            dropped,
            left_out: Vec::new(),
        })
    }

    /// From a table file: labels in the first column, counts in the others. Refuses what is no count.
    pub fn from_table(table: &Table) -> Result<Self, Refusal> {
        let names = table.names();
        let rows: Vec<String> = (0..table.rows())
            .map(|row| match table.cell(row, 0) {
                Some(label) => label.to_owned(),
                None => format!("line {}", table.line(row)),
            })
            .collect();
        let mut counts = vec![Vec::new(); rows.len()];
        for name in &names[1..] {
            for (row, value) in table.numbers(name)?.values.into_iter().enumerate() {
                // A blank cell of a table of counts is a count of none.
                let count = if value.is_nan() { 0.0 } else { value };
                if count < 0.0 || count.fract() != 0.0 || count > 1e15 {
                    let problem = format!("line {}: {count} is no count", table.line(row));
                    return Err(Refusal::column(name, problem, "give whole numbers from 0"));
                }
                counts[row].push(count as u64);
            }
        }
        Ok(Self::from_counts([&names[0], "columns"], &rows, &names[1..], &counts))
    }

    /// From counts; rows and columns without any are left out and named.
    pub fn from_counts(
        [row_name, column_name]: [&str; 2],
        rows: &[String],
        columns: &[String],
        counts: &[Vec<u64>],
    ) -> Self {
        let filled_row: Vec<usize> =
            (0..rows.len()).filter(|&i| counts[i].iter().any(|&count| count > 0)).collect();
        let filled_column: Vec<usize> =
            (0..columns.len()).filter(|&j| counts.iter().any(|row| row[j] > 0)).collect();
        let mut left_out: Vec<String> = Vec::new();
        let missing = |all: &[String], filled: &[usize]| -> Vec<String> {
            (0..all.len()).filter(|i| !filled.contains(i)).map(|i| all[i].clone()).collect()
        };
        left_out.extend(missing(rows, &filled_row));
        left_out.extend(missing(columns, &filled_column));
        Self {
            row_name: row_name.to_owned(),
            column_name: column_name.to_owned(),
            rows: filled_row.iter().map(|&i| rows[i].clone()).collect(),
            columns: filled_column.iter().map(|&j| columns[j].clone()).collect(),
            counts: filled_row
                .iter()
                .map(|&i| filled_column.iter().map(|&j| counts[i][j]).collect())
                .collect(),
            dropped: 0,
            left_out,
        }
    }
}

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

/// Are rows and columns independent? Refuses a single row or column, naming it.
pub fn chi_square(table: &Contingency) -> Result<ChiSquare, Refusal> {
    let (r, c) = (table.rows.len(), table.columns.len());
    for (levels, name) in [(&table.rows, &table.row_name), (&table.columns, &table.column_name)] {
        if levels.len() < 2 {
            return Err(Refusal::TooFewLevels {
                column: name.clone(),
                found: match levels.first() {
                    Some(one) => format!("only one level (\"{one}\")"),
                    None => "no level".to_owned(),
                },
                rows: table.counts.iter().flatten().sum::<u64>() as usize,
                needed: 2,
                remedy: "give a column with at least two levels".to_owned(),
            });
        }
    }
    let row_sums: Vec<f64> =
        table.counts.iter().map(|row| row.iter().sum::<u64>() as f64).collect();
    let column_sums: Vec<f64> =
        (0..c).map(|j| table.counts.iter().map(|row| row[j]).sum::<u64>() as f64).collect();
    let n: u64 = table.counts.iter().flatten().sum();
    let total = n as f64;
    let expected = |i: usize, j: usize| row_sums[i] * column_sums[j] / total;
    let cells = || (0..r).flat_map(move |i| (0..c).map(move |j| (i, j)));
    let observed = |i: usize, j: usize| table.counts[i][j] as f64;

    let df = (r - 1) * (c - 1);
    let statistic = |shrink: f64| -> f64 {
        cells()
            .map(|(i, j)| {
                let e = expected(i, j);
                ((observed(i, j) - e).abs() - shrink).max(0.0).powi(2) / e
            })
            .sum()
    };
    let two_by_two = r == 2 && c == 2;
    // In a 2x2 table all |O - E| are equal.
    let yates = if two_by_two { (observed(0, 0) - expected(0, 0)).abs().min(0.5) } else { 0.0 };
    let min_expected = cells().map(|(i, j)| expected(i, j)).fold(f64::INFINITY, f64::min);
    let cells_below_5 = cells().filter(|&(i, j)| expected(i, j) < 5.0).count();
    let doubt = (cells_below_5 > 0).then_some(DOUBTFUL);
    let variant = |method, shrink| {
        let statistic = statistic(shrink);
        let Tail { p, ln_p } = chi_square_upper(statistic, df as f64);
        ChiSquareVariant { method, statistic, df, p_value: p, ln_p, warnings: doubt }
    };
    const PLAIN: &str = "Pearson's Chi-squared test";
    let uncorrected = variant(PLAIN, 0.0);
    let default_yates_if_2x2 = if two_by_two {
        variant("Pearson's Chi-squared test with Yates' continuity correction", yates)
    } else {
        uncorrected.clone()
    };

    let phi_squared = uncorrected.statistic / total;
    let smaller = (r.min(c) - 1) as f64;
    let g: f64 = 2.0
        * cells()
            .filter(|&(i, j)| observed(i, j) > 0.0)
            .map(|(i, j)| observed(i, j) * (observed(i, j) / expected(i, j)).ln())
            .sum::<f64>();
    let named = |value: &dyn Fn(usize, usize) -> f64| {
        Labelled::zip(
            &table.rows,
            (0..r).map(|i| Labelled::zip(&table.columns, (0..c).map(|j| value(i, j)))),
        )
    };
    let mut warnings = Vec::new();
    if cells_below_5 > 0 {
        let advice = if two_by_two { "; see Fisher's exact p" } else { "" };
        warnings.push(format!(
            "{cells_below_5} of {} expected counts are below 5 (smallest {min_expected:.2}): the chi-square approximation is rough{advice}",
            r * c
        ));
    }
    if !table.left_out.is_empty() {
        warnings.push(format!("left out because empty: {}", table.left_out.join(", ")));
    }
    Ok(ChiSquare {
        test: "chi-square",
        n,
        dropped: table.dropped,
        left_out: table.left_out.clone(),
        observed: Labelled::zip(
            &table.rows,
            table.counts.iter().map(|row| Labelled::zip(&table.columns, row.iter().copied())),
        ),
        expected: named(&expected),
        min_expected,
        cells_below_5,
        std_residuals: named(&|i, j| {
            let e = expected(i, j);
            let spread = e * (1.0 - row_sums[i] / total) * (1.0 - column_sums[j] / total);
            (observed(i, j) - e) / spread.sqrt()
        }),
        cramers_v: (phi_squared / smaller).sqrt(),
        cramers_v_bias_corrected: bias_corrected_v(phi_squared, r, c, total),
        ln_p: uncorrected.ln_p,
        fisher_p: two_by_two.then(|| {
            fisher_two_sided([
                [table.counts[0][0], table.counts[0][1]],
                [table.counts[1][0], table.counts[1][1]],
            ])
        }),
        g_test: GTest { statistic: g, df, p_value: chi_square_upper(g.max(0.0), df as f64).p },
        default_yates_if_2x2,
        uncorrected,
        warnings,
    })
}

fn bias_corrected_v(phi_squared: f64, r: usize, c: usize, n: f64) -> Option<f64> {
    if n < 2.0 {
        return None;
    }
    let (r1, c1) = ((r - 1) as f64, (c - 1) as f64);
    let corrected = (phi_squared - r1 * c1 / (n - 1.0)).max(0.0);
    let smaller = (r1 - r1 * r1 / (n - 1.0)).min(c1 - c1 * c1 / (n - 1.0));
    (smaller > 0.0).then(|| (corrected / smaller).sqrt())
}

/// Fisher's exact test, two-sided: the tables with the same margins that are no more probable.
fn fisher_two_sided(counts: [[u64; 2]; 2]) -> f64 {
    let [[a, b], [c, d]] = counts;
    let (row, other, column) = (a + b, c + d, a + c);
    let low = column.saturating_sub(other);
    let high = row.min(column);
    // Probabilities relative to that of the observed table, by the ratio of neighbours.
    let ratio = |x: u64| {
        // P(x + 1) / P(x)
        (row - x) as f64 * (column - x) as f64 / ((x + 1) as f64 * (other + x + 1 - column) as f64)
    };
    // Equal probabilities must count as equal.
    let limit = 1.0 + 1e-7;
    let (mut all, mut extreme) = (1.0, 1.0);
    let mut add = |relative: f64| {
        all += relative;
        if relative <= limit {
            extreme += relative;
        }
    };
    let mut relative = 1.0;
    for x in a..high {
        relative *= ratio(x);
        add(relative);
    }
    relative = 1.0;
    for x in (low..a).rev() {
        relative /= ratio(x);
        add(relative);
    }
    (extreme / all).min(1.0)
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
