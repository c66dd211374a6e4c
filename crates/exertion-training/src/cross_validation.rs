//! How well a regression foretells rows that it has not seen: blocks of one piece, or people.

use std::ops::Range;

use mimique_exertion::SupportVectors;

use crate::TrainingError;
use crate::regression::{EpsilonSvr, Fitted};

/// Contiguous blocks of rows, as long as each other: the first `rows mod folds` are one longer. Neighbours in
/// time are alike, so that blocks drawn at random would foretell themselves.
pub fn contiguous_blocks(rows: usize, folds: usize) -> Vec<Range<usize>> {
    let folds = folds.clamp(1, rows.max(1));
    let (length, longer) = (rows / folds, rows % folds);
    let mut start = 0;
    (0..folds)
        .map(|fold| {
            let end = start + length + usize::from(fold < longer);
            let block = start..end;
            start = end;
            block
        })
        .collect()
}

/// What every feature is moved and divided by before the fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Scaling {
    /// Taken away.
    pub offset: Vec<f64>,
    /// Divided by.
    pub scale: Vec<f64>,
}

impl Scaling {
    /// None.
    pub fn none(width: usize) -> Self {
        Self { offset: vec![0.0; width], scale: vec![1.0; width] }
    }

    /// To mean 0 and standard deviation 1; a feature that does not vary is only moved.
    pub fn standard(rows: &[&[f64]]) -> Self {
        let width = rows.first().map_or(0, |row| row.len());
        let count = rows.len().max(1) as f64;
        let mean = |k: usize| rows.iter().map(|row| row[k]).sum::<f64>() / count;
        let offset: Vec<f64> = (0..width).map(mean).collect();
        let deviation = |k: usize| {
            let squares = rows.iter().map(|row| (row[k] - offset[k]) * (row[k] - offset[k]));
            let deviation = (squares.sum::<f64>() / count).sqrt();
            // Rounding alone makes no width.
            if deviation > 1e-9 * offset[k].abs().max(1e-9) { deviation } else { 1.0 }
        };
        let scale = (0..width).map(deviation).collect();
        Self { offset, scale }
    }

    /// Rows moved and divided.
    pub fn apply(&self, rows: &[&[f64]]) -> Vec<Vec<f64>> {
        let own = |row: &&[f64]| {
            let each = row.iter().zip(&self.offset).zip(&self.scale);
            each.map(|((x, offset), scale)| (x - offset) / scale).collect()
        };
        rows.iter().map(own).collect()
    }
}

/// A regression fitted on rows after its own scaling.
#[derive(Debug, Clone, PartialEq)]
pub struct Learnt {
    /// What foretells.
    pub model: SupportVectors,
    /// Its numbers.
    pub parts: mimique_exertion::SupportVectorParts,
    /// What the solver found.
    pub fitted: Fitted,
}

/// Learns from rows, standardised on request.
///
/// # Errors
/// As [`EpsilonSvr::fit`]; [`TrainingError::NotConverged`] where the conditions are missed by more than a
/// hundred tolerances.
pub fn learn(
    svr: &EpsilonSvr,
    rows: &[&[f64]],
    targets: &[f64],
    standardise: bool,
) -> Result<Learnt, TrainingError> {
    let width = rows.first().map_or(0, |row| row.len());
    let scaling = if standardise { Scaling::standard(rows) } else { Scaling::none(width) };
    let scaled = scaling.apply(rows);
    let scaled: Vec<&[f64]> = scaled.iter().map(Vec::as_slice).collect();
    let fitted = svr.fit(&scaled, targets)?;
    if fitted.violation > 100.0 * svr.tolerance {
        let (c, gamma, violation) = (svr.c, svr.gamma, fitted.violation);
        return Err(TrainingError::NotConverged { c, gamma, violation });
    }
    let parts = fitted.parts(&scaled, svr.gamma, scaling.offset, scaling.scale);
    Ok(Learnt { model: SupportVectors::new(parts.clone())?, parts, fitted })
}

/// What is foretold of some rows by a regression that has learnt from all others.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldOut {
    /// Sum of the squared errors.
    pub squares: f64,
    /// Rows.
    pub rows: usize,
    /// Whether a coefficient of the regression lies at C.
    pub at_bound: bool,
}

/// Holds some rows out and foretells them.
///
/// # Errors
/// As [`learn`].
pub fn hold_out(
    svr: &EpsilonSvr,
    rows: &[&[f64]],
    targets: &[f64],
    held: impl Fn(usize) -> bool,
    standardise: bool,
) -> Result<HeldOut, TrainingError> {
    let kept: Vec<usize> = (0..rows.len()).filter(|&row| !held(row)).collect();
    let kept_rows: Vec<&[f64]> = kept.iter().map(|&row| rows[row]).collect();
    let kept_targets: Vec<f64> = kept.iter().map(|&row| targets[row]).collect();
    let learnt = learn(svr, &kept_rows, &kept_targets, standardise)?;
    let mut out = HeldOut { squares: 0.0, rows: 0, at_bound: learnt.fitted.at_bound };
    for row in (0..rows.len()).filter(|&row| held(row)) {
        let error = learnt.model.predict(rows[row])? - targets[row];
        out.squares += error * error;
        out.rows += 1;
    }
    Ok(out)
}

/// The root of the mean squared error over all held-out rows of contiguous blocks.
///
/// # Errors
/// As [`learn`].
pub fn cross_validate(
    svr: &EpsilonSvr,
    rows: &[&[f64]],
    targets: &[f64],
    folds: usize,
    standardise: bool,
) -> Result<f64, TrainingError> {
    let (mut squares, mut count) = (0.0, 0);
    for block in contiguous_blocks(rows.len(), folds) {
        let out = hold_out(svr, rows, targets, |row| block.contains(&row), standardise)?;
        squares += out.squares;
        count += out.rows;
    }
    Ok((squares / count as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_all_rows_once_in_order() {
        assert_eq!(contiguous_blocks(43, 10)[..4], [0..5, 5..10, 10..15, 15..19]);
        for (rows, folds) in [(43, 10), (10, 10), (3, 10), (100, 7), (1, 1)] {
            let blocks = contiguous_blocks(rows, folds);
            let all: Vec<usize> = blocks.iter().cloned().flatten().collect();
            assert_eq!(all, (0..rows).collect::<Vec<_>>());
            assert!(blocks.iter().all(|block| !block.is_empty()));
        }
    }

    #[test]
    fn standard_rows_have_mean_0_and_deviation_1_and_still_features_stay() {
        let values = [vec![1.0, 5.0], vec![3.0, 5.0], vec![8.0, 5.0]];
        let rows: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
        let scaled = Scaling::standard(&rows).apply(&rows);
        let sum: f64 = scaled.iter().map(|row| row[0]).sum();
        let squares: f64 = scaled.iter().map(|row| row[0] * row[0]).sum();
        assert!(sum.abs() < 1e-12 && (squares / 3.0 - 1.0).abs() < 1e-12);
        assert!(scaled.iter().all(|row| row[1] == 0.0));
    }
}
