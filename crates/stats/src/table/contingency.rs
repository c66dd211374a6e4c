//! A table of counts: how often each level of one factor meets each level of another.

use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;

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

    /// From a table file: labels in the first column, counts in the others. Refuses a cell that is not a count.
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
                    let (column, line) = (name.clone(), table.line(row));
                    return Err(Refusal::NotACount { column, line, value: count });
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
