//! A take: weights of shapes over time, missing ones bridged.

use mimique_mocap::LowPass;
use mimique_stimulus::bridge;

use crate::{AnnotateError, Rows};

/// Cut-off of the low-pass before anything is differentiated, Hz.
pub const CUTOFF_HZ: f64 = 6.0;

/// Weights of a take, a frame a row.
#[derive(Debug, Clone, PartialEq)]
pub struct Take {
    /// The weights, no unit; a gap lies on the line between its neighbours, at the ends it is the
    /// nearest, in an empty column 0.
    pub weights: Rows,
    /// Frames per second.
    pub rate_hz: f64,
}

impl Take {
    /// Bridge what is missing (NaN or infinite) in `values`: frame after frame, `shapes` a frame.
    ///
    /// # Errors
    /// [`AnnotateError::Shape`], [`AnnotateError::Setting`] for a rate that is none,
    /// [`AnnotateError::Limit`] above 1,000,000 frames or 500 shapes.
    pub fn new(values: Vec<f64>, shapes: usize, rate_hz: f64) -> Result<Self, AnnotateError> {
        crate::error::above_zero("rate in Hz", rate_hz)?;
        if shapes == 0 || !values.len().is_multiple_of(shapes) {
            return Err(AnnotateError::Shape { values: values.len(), width: shapes });
        }
        let frames = values.len() / shapes;
        for (what, found, most) in [("frames", frames, 1_000_000), ("shapes", shapes, 500)] {
            if found > most {
                return Err(AnnotateError::Limit { what, found, most });
            }
        }
        let weights = by_column(values, shapes, |column| {
            bridge(column);
            Ok(())
        })?;
        Ok(Self { weights, rate_hz })
    }

    /// Frames.
    pub fn frames(&self) -> usize {
        self.weights.len()
    }

    /// The weights after a Butterworth of second order run both ways (gain 1/2 at the cut-off).
    ///
    /// # Errors
    /// [`AnnotateError::Filter`] when the cut-off is not below half the rate.
    pub fn smooth(&self, cutoff_hz: f64) -> Result<Rows, AnnotateError> {
        let low_pass = LowPass::Butterworth { cutoff_hz };
        low_pass.check(self.rate_hz)?;
        by_column(self.weights.values().to_vec(), self.weights.width(), |column| {
            Ok(low_pass.filter(column, self.rate_hz)?)
        })
    }

    /// Columns of these indices, in this order: the take without blinks, or with a model's shapes.
    ///
    /// # Errors
    /// [`AnnotateError::Shape`] when none is kept, [`AnnotateError::Count`] when a column is absent.
    pub fn columns(&self, kept: &[usize]) -> Result<Self, AnnotateError> {
        let width = self.weights.width();
        if let Some(&column) = kept.iter().find(|&&column| column >= width) {
            let what = "shapes of a take";
            return Err(AnnotateError::Count { what, found: width, expected: column + 1 });
        }
        let frames = self.weights.iter();
        let values = frames.flat_map(|frame| kept.iter().map(|&column| frame[column])).collect();
        Ok(Self { weights: Rows::new(values, kept.len())?, rate_hz: self.rate_hz })
    }
}

/// Change every column of a table.
fn by_column(
    mut values: Vec<f64>,
    width: usize,
    mut change: impl FnMut(&mut [f64]) -> Result<(), AnnotateError>,
) -> Result<Rows, AnnotateError> {
    let mut column = Vec::with_capacity(values.len() / width);
    for place in 0..width {
        column.clear();
        column.extend(values.iter().skip(place).step_by(width));
        change(&mut column)?;
        for (value, changed) in values.iter_mut().skip(place).step_by(width).zip(&column) {
            *value = *changed;
        }
    }
    Rows::new(values, width)
}
