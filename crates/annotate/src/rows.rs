//! A table of numbers: a frame or a segment a row, a shape a column.

use serde::{Deserialize, Serialize};

use crate::AnnotateError;
use crate::error::as_many;

/// A table, row after row; every number is finite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Rows {
    values: Vec<f64>,
    width: usize,
}

/// A table as a file has it.
#[derive(Deserialize)]
struct Unchecked {
    values: Vec<f64>,
    width: usize,
}

impl TryFrom<Unchecked> for Rows {
    type Error = AnnotateError;

    fn try_from(Unchecked { values, width }: Unchecked) -> Result<Self, AnnotateError> {
        Self::new(values, width)
    }
}

impl Rows {
    /// A table of `values.len() / width` rows.
    ///
    /// # Errors
    /// [`AnnotateError::Shape`], [`AnnotateError::NotFinite`].
    pub fn new(values: Vec<f64>, width: usize) -> Result<Self, AnnotateError> {
        if width == 0 || !values.len().is_multiple_of(width) {
            return Err(AnnotateError::Shape { values: values.len(), width });
        }
        if let Some(place) = values.iter().position(|v| !v.is_finite()) {
            let (row, column) = (place / width, place % width);
            return Err(AnnotateError::NotFinite { row, column, value: values[place] });
        }
        Ok(Self { values, width })
    }

    /// Rows.
    pub fn len(&self) -> usize {
        self.values.len() / self.width
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// A row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.width..(row + 1) * self.width]
    }

    /// The rows in order.
    pub fn iter(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.width)
    }

    /// All numbers, row after row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// These rows, in this order.
    pub fn select(&self, rows: impl IntoIterator<Item = usize>) -> Self {
        let mut values = Vec::new();
        rows.into_iter().for_each(|row| values.extend_from_slice(self.row(row)));
        Self { values, width: self.width }
    }
}

/// Rows and the label of each, an index from 0: what a classifier learns from.
#[derive(Debug, Clone, PartialEq)]
pub struct Examples {
    rows: Rows,
    labels: Vec<usize>,
    count: usize,
}

impl Examples {
    /// Rows with a label each, below `count`.
    ///
    /// # Errors
    /// [`AnnotateError::Count`], [`AnnotateError::Label`]; [`AnnotateError::OneLabel`] when fewer
    /// than two labels have rows.
    pub fn new(rows: Rows, labels: Vec<usize>, count: usize) -> Result<Self, AnnotateError> {
        as_many("labels of rows", labels.len(), rows.len())?;
        if let Some(row) = labels.iter().position(|&label| label >= count) {
            return Err(AnnotateError::Label { row, label: labels[row], labels: count });
        }
        let examples = Self { rows, labels, count };
        let found = examples.sizes().iter().filter(|&&n| n > 0).count();
        if found < 2 {
            return Err(AnnotateError::OneLabel { found });
        }
        Ok(examples)
    }

    /// The table.
    pub fn rows(&self) -> &Rows {
        &self.rows
    }

    /// The label of each row.
    pub fn labels(&self) -> &[usize] {
        &self.labels
    }

    /// How many labels there are, with rows or without.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Rows of each label.
    pub fn sizes(&self) -> Vec<usize> {
        let mut sizes = vec![0; self.count];
        self.labels.iter().for_each(|&label| sizes[label] += 1);
        sizes
    }
}

/// How much the rows of each label count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClassWeight {
    /// Each row counts once.
    #[default]
    Even,
    /// n / (K n of the label), K the labels that have rows: each label counts as much as another.
    Balanced,
}

impl ClassWeight {
    /// The weight of each label.
    pub fn of(self, examples: &Examples) -> Vec<f64> {
        let sizes = examples.sizes();
        let n = examples.labels.len() as f64;
        let present = sizes.iter().filter(|&&size| size > 0).count() as f64;
        let weight = |&size: &usize| match self {
            Self::Balanced if size > 0 => n / (present * size as f64),
            _ => 1.0,
        };
        sizes.iter().map(weight).collect()
    }
}
