//! Inputs of a regression, centred and scaled by their training examples (thesis 3.4.3).

use crate::linear_algebra::dense::axpy;

/// Least scale of a coordinate against the largest one: one that hardly moves would be scaled up to noise.
const LEAST_SCALE: f64 = 0.1;

/// Mean and scale of each number of an input.
#[derive(Debug, Clone, PartialEq)]
pub struct InputScale {
    /// The means.
    pub centre: Vec<f64>,
    /// The standard deviations (1/n), none below a tenth of the largest.
    pub scale: Vec<f64>,
}

impl InputScale {
    /// Of examples, row after row of `width` numbers; none where nothing moves.
    ///
    /// # Panics
    /// If `width` is 0.
    pub fn of(examples: &[f64], width: usize) -> Option<InputScale> {
        let n = (examples.len() / width) as f64;
        let mut centre = vec![0.0; width];
        examples.chunks_exact(width).for_each(|row| axpy(1.0, row, &mut centre));
        centre.iter_mut().for_each(|c| *c /= n);
        let mut scale = vec![0.0; width];
        for row in examples.chunks_exact(width) {
            for ((s, x), c) in scale.iter_mut().zip(row).zip(&centre) {
                *s += (x - c) * (x - c);
            }
        }
        scale.iter_mut().for_each(|s| *s = (*s / n).sqrt());
        let largest = scale.iter().fold(0.0_f64, |m, &s| m.max(s));
        if !(largest > 0.0) {
            return None;
        }
        scale.iter_mut().for_each(|s| *s = s.max(LEAST_SCALE * largest));
        Some(InputScale { centre, scale })
    }

    /// An input less the means, divided by the scales.
    pub fn apply(&self, input: &mut [f64]) {
        standardise(input, &self.centre, &self.scale);
    }
}

pub(crate) fn standardise(row: &mut [f64], centre: &[f64], scale: &[f64]) {
    for ((x, c), s) in row.iter_mut().zip(centre).zip(scale) {
        *x = (*x - c) / s;
    }
}
