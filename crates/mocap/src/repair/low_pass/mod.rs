//! Low-pass filters without phase shift, by frequency in Hz at any rate.

mod raised_cosine;

use mimique_geometry::Butterworth;

use crate::Capture;

/// Samples by which the Butterworth continues each end: three times its three coefficients, as SciPy's
/// `filtfilt` does it.
const EXTENSION: usize = 9;

/// A low-pass filter.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum LowPass {
    /// Butterworth of second order run forwards and backwards: gain 1/2 at the cut-off.
    Butterworth {
        /// Cut-off, Hz.
        cutoff_hz: f64,
    },
    /// Raised cosine in the Fourier domain (Kouadio 1997, eq. 7.1): gain 1/2 at the cut-off.
    RaisedCosine {
        /// Middle of the flank, Hz.
        cutoff_hz: f64,
        /// Width of the flank from gain 1 to gain 0, Hz.
        width_hz: f64,
    },
}

/// Why a filter cannot run.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FilterError {
    /// The cut-off is not between 0 and half the rate.
    #[error(
        "low-pass: cut-off {cutoff_hz} Hz at {rate_hz} frames per second; \
         give a frequency above 0 and below {} Hz", rate_hz / 2.0
    )]
    Cutoff {
        /// The cut-off asked for, Hz.
        cutoff_hz: f64,
        /// The rate of the capture, Hz.
        rate_hz: f64,
    },
    /// The flank does not fit between 0 and twice the cut-off.
    #[error(
        "low-pass: flank of {width_hz} Hz at a cut-off of {cutoff_hz} Hz; \
         give a width above 0 and up to {} Hz", 2.0 * cutoff_hz
    )]
    Width {
        /// The width asked for, Hz.
        width_hz: f64,
        /// The cut-off, Hz.
        cutoff_hz: f64,
    },
}

impl LowPass {
    /// Check the filter against a rate.
    ///
    /// # Errors
    /// [`FilterError`] when a frequency is out of range.
    pub fn check(&self, rate_hz: f64) -> Result<(), FilterError> {
        let (Self::Butterworth { cutoff_hz } | Self::RaisedCosine { cutoff_hz, .. }) = *self;
        if !(cutoff_hz > 0.0 && cutoff_hz < rate_hz / 2.0) {
            return Err(FilterError::Cutoff { cutoff_hz, rate_hz });
        }
        match *self {
            Self::RaisedCosine { width_hz, .. }
                if !(width_hz > 0.0 && width_hz <= 2.0 * cutoff_hz) =>
            {
                Err(FilterError::Width { width_hz, cutoff_hz })
            }
            _ => Ok(()),
        }
    }

    /// Filter evenly spaced samples in place; all finite.
    ///
    /// # Errors
    /// [`FilterError`] when a frequency is out of range.
    pub fn filter(&self, samples: &mut [f64], rate_hz: f64) -> Result<(), FilterError> {
        self.check(rate_hz)?;
        match *self {
            Self::Butterworth { cutoff_hz } => {
                let filter = Butterworth::low_pass(cutoff_hz / rate_hz);
                filter
                    .ok_or(FilterError::Cutoff { cutoff_hz, rate_hz })?
                    .filter(samples, EXTENSION);
            }
            Self::RaisedCosine { cutoff_hz, width_hz } => {
                raised_cosine::filter(samples, cutoff_hz / rate_hz, width_hz / rate_hz);
            }
        }
        Ok(())
    }

    /// Filter every coordinate of every marker in place. A gap stays a gap: each stretch without
    /// one is filtered by itself.
    ///
    /// # Errors
    /// [`FilterError`] when a frequency is out of range; the capture is then unchanged.
    pub fn filter_capture(&self, capture: &mut Capture) -> Result<(), FilterError> {
        self.check(capture.rate_hz)?;
        let mut samples = Vec::new();
        for marker in 0..capture.labels.len() {
            for stretch in crate::repair::gaps::stretches(capture, marker) {
                for axis in 0..3 {
                    samples.clear();
                    samples.extend(stretch.clone().map(|f| capture.frame(f)[marker][axis]));
                    self.filter(&mut samples, capture.rate_hz)?;
                    let markers = capture.labels.len();
                    for (frame, value) in stretch.clone().zip(&samples) {
                        capture.positions[frame * markers + marker][axis] = *value;
                    }
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LengthUnit;
    use mimique_geometry::Point;
    use std::f64::consts::PI;

    /// A sine that starts and ends at 0: `cycles` half periods over `n` samples.
    fn sine(n: usize, half_periods: f64) -> Vec<f64> {
        (0..n).map(|i| (PI * half_periods * i as f64 / (n - 1) as f64).sin()).collect()
    }

    #[test]
    fn raised_cosine_multiplies_by_equation_7_1() {
        // 200 Hz, 1001 samples: half periods k have k / 10 Hz.
        let filter = LowPass::RaisedCosine { cutoff_hz: 10.0, width_hz: 4.0 };
        for (half_periods, gain) in [
            (70.0, 1.0),
            (80.0, 1.0),
            (90.0, ((PI / 4.0).sin() + 1.0) / 2.0),
            (100.0, 0.5),
            (110.0, ((-PI / 4.0).sin() + 1.0) / 2.0),
            (121.0, 0.0),
            (500.0, 0.0),
        ] {
            let input = sine(1001, half_periods);
            let mut output = input.clone();
            filter.filter(&mut output, 200.0).unwrap();
            for (i, o) in input.iter().zip(&output) {
                assert!((gain * i - o).abs() < 1e-12, "{half_periods}: {o} for {i}");
            }
        }
    }

    #[test]
    fn raised_cosine_leaves_lines_and_butterworth_constants_of_any_length() {
        let raised_cosine = LowPass::RaisedCosine { cutoff_hz: 6.0, width_hz: 3.0 };
        let butterworth = LowPass::Butterworth { cutoff_hz: 6.0 };
        for (filter, slope) in [(raised_cosine, -0.25), (butterworth, 0.0)] {
            for n in [1, 2, 3, 5, 11, 400] {
                let line: Vec<f64> = (0..n).map(|i| 3.0 + slope * f64::from(i)).collect();
                let mut output = line.clone();
                filter.filter(&mut output, 100.0).unwrap();
                for (l, o) in line.iter().zip(&output) {
                    assert!((l - o).abs() < 1e-9, "{filter:?} {n}: {o} for {l}");
                }
            }
        }
    }

    #[test]
    fn gaps_stay_and_stretches_are_filtered_apart() {
        let mut capture = Capture {
            labels: vec!["a".to_owned()],
            rate_hz: 100.0,
            first_frame: 0,
            unit: LengthUnit::Millimetre,
            positions: (0..60).map(|i| Point::from([if i < 30 { 1.0 } else { 9.0 }; 3])).collect(),
            notes: Vec::new(),
        };
        capture.positions[30] = Point::UNSEEN;
        LowPass::Butterworth { cutoff_hz: 5.0 }.filter_capture(&mut capture).unwrap();
        for (frame, p) in capture.positions.iter().enumerate() {
            let want = if frame < 30 { 1.0 } else { 9.0 };
            assert!(frame == 30 && p[0].is_nan() || (p[2] - want).abs() < 1e-12, "{frame} {p:?}");
        }
        let message = LowPass::Butterworth { cutoff_hz: 60.0 }
            .filter_capture(&mut capture)
            .unwrap_err()
            .to_string();
        assert_eq!(
            message,
            "low-pass: cut-off 60 Hz at 100 frames per second; give a frequency above 0 and below 50 Hz"
        );
    }
}
