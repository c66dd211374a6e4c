//! Rows that have a value in every used column.

use crate::factor::Factor;
use crate::outcome::Refusal;
use crate::table::Numbers;

/// Rows without a missing value in any of the columns, and how many rows were dropped. Refuses if none
/// is left.
pub fn complete_rows(
    numbers: &[&Numbers],
    factors: &[&Factor],
) -> Result<(Vec<usize>, usize), Refusal> {
    let first = numbers.first().map(|column| (column.values.len(), &column.name));
    let (total, name) = first
        .or_else(|| factors.first().map(|factor| (factor.codes.len(), &factor.name)))
        .ok_or_else(|| Refusal::Options {
            problem: "no column is named".to_owned(),
            remedy: "name the columns to use".to_owned(),
        })?;
    let rows: Vec<usize> = (0..total)
        .filter(|&row| {
            numbers.iter().all(|column| column.values[row].is_finite())
                && factors.iter().all(|factor| factor.codes[row] != Factor::MISSING)
        })
        .collect();
    let dropped = total - rows.len();
    if rows.is_empty() {
        return Err(Refusal::NoRows { column: name.clone(), dropped });
    }
    Ok((rows, dropped))
}
