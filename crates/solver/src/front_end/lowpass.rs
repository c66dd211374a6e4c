//! The low-pass of the head's pose: a zero-phase Butterworth whose memory fades before the ends.

use mimique_geometry::{Butterworth, Point, rows_mut};

/// A second-order Butterworth low-pass, run both ways by [`Lowpass::filter`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lowpass {
    butterworth: Butterworth,
    /// Frames by which the ends are continued: three periods of the cut-off, in which the filter's
    /// memory fades to a hundred-thousandth and below.
    settling: usize,
}

/// Why there is no such filter.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "low-pass {cutoff_hz} Hz at {rate_hz} frames/s; give a cut-off above 0 and below {} Hz",
    .rate_hz / 2.0
)]
pub struct LowpassError {
    /// The cut-off that was asked for.
    pub cutoff_hz: f64,
    /// The rate of the frames.
    pub rate_hz: f64,
}

impl Lowpass {
    /// The filter whose single run has its -3 dB at `cutoff_hz`.
    ///
    /// # Errors
    /// [`LowpassError`] unless 0 < cutoff < rate / 2.
    pub fn new(cutoff_hz: f64, rate_hz: f64) -> Result<Lowpass, LowpassError> {
        let butterworth = (rate_hz.is_finite().then_some(cutoff_hz / rate_hz))
            .and_then(Butterworth::low_pass)
            .ok_or(LowpassError { cutoff_hz, rate_hz })?;
        Ok(Lowpass { butterworth, settling: (3.0 * rate_hz / cutoff_hz).ceil() as usize })
    }

    /// Filter in place, forwards and backwards: no delay, and twice the slope.
    ///
    /// The ends are continued by odd reflection, as far as a short signal reaches, so that a constant
    /// or a straight line passes unchanged.
    pub fn filter(&self, signal: &mut [f64]) {
        self.butterworth.filter(signal, self.settling.min(signal.len().saturating_sub(1)));
    }

    /// The same of every coordinate of a way through space.
    pub fn filter_points(&self, track: &mut [Point]) {
        let settling = self.settling.min(track.len().saturating_sub(1));
        self.butterworth.filter_lanes(rows_mut(track), settling);
    }
}
