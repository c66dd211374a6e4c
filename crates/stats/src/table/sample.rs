//! Rows that have a value in every used column.

use std::borrow::Cow;

use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::factor::Factor;

/// Rows without a missing value in any of the columns. Where all rows are whole nothing is copied.
pub struct CompleteRows {
    kept: Option<Vec<usize>>,
    total: usize,
}

impl CompleteRows {
    /// Rows that are whole.
    pub fn len(&self) -> usize {
        self.kept.as_ref().map_or(self.total, Vec::len)
    }

    /// Rows left out.
    pub fn dropped(&self) -> usize {
        self.total - self.len()
    }

    /// The whole rows' places, ascending.
    pub fn to_vec(&self) -> Vec<usize> {
        self.kept.clone().unwrap_or_else(|| (0..self.total).collect())
    }

    /// A column's values in the whole rows.
    pub fn numbers<'a>(&self, column: &'a Numbers) -> Cow<'a, [f64]> {
        match &self.kept {
            None => Cow::Borrowed(&column.values),
            Some(kept) => Cow::Owned(kept.iter().map(|&row| column.values[row]).collect()),
        }
    }

    /// A factor in the whole rows, without the levels that none of them has.
    pub fn factor<'a>(&self, factor: &'a Factor) -> Cow<'a, Factor> {
        match &self.kept {
            None if factor.uses_all_levels() => Cow::Borrowed(factor),
            _ => Cow::Owned(factor.rows(&self.to_vec())),
        }
    }
}

/// Finds the whole rows. Refuses if none is left.
pub fn complete_rows(numbers: &[&Numbers], factors: &[&Factor]) -> Result<CompleteRows, Refusal> {
    let first = numbers.first().map(|column| (column.values.len(), &column.name));
    let (total, name) = first
        .or_else(|| factors.first().map(|factor| (factor.codes.len(), &factor.name)))
        .ok_or(Refusal::NoColumns)?;
    let all = numbers.iter().all(|column| column.values.iter().all(|value| value.is_finite()))
        && factors.iter().all(|factor| !factor.codes.contains(&Factor::MISSING));
    let whole = |row: &usize| {
        numbers.iter().all(|column| column.values[*row].is_finite())
            && factors.iter().all(|factor| factor.codes[*row] != Factor::MISSING)
    };
    let rows = CompleteRows { kept: (!all).then(|| (0..total).filter(whole).collect()), total };
    if rows.len() == 0 {
        return Err(Refusal::NoRows { column: name.clone(), dropped: rows.dropped() });
    }
    Ok(rows)
}
