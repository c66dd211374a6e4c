//! Zero-phase low-pass: a second-order Butterworth run forwards and backwards.

use std::f64::consts::{PI, SQRT_2};

use crate::number_text::number_text;

/// A second-order Butterworth low-pass (bilinear transform), run both ways by [`Lowpass::filter`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lowpass {
    b: [f64; 3],
    a: [f64; 2],
    /// Frames by which the ends are continued: three periods of the cut-off, in which the filter's
    /// memory fades to a hundred-thousandth and below.
    settling: usize,
}

/// Why there is no such filter.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "low-pass {} Hz at {} frames/s; give a cut-off above 0 and below {} Hz",
    number_text(*.cutoff_hz), number_text(*.rate_hz), number_text(.rate_hz / 2.0)
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
        if !(rate_hz.is_finite() && cutoff_hz > 0.0 && cutoff_hz < rate_hz / 2.0) {
            return Err(LowpassError { cutoff_hz, rate_hz });
        }
        // Prewarped analogue frequency: `libm`, the same bits everywhere.
        let w = libm::tan(PI * cutoff_hz / rate_hz);
        let norm = 1.0 / (1.0 + SQRT_2 * w + w * w);
        let b0 = w * w * norm;
        let a1 = 2.0 * (w * w - 1.0) * norm;
        let a2 = (1.0 - SQRT_2 * w + w * w) * norm;
        let settling = (3.0 * rate_hz / cutoff_hz).ceil() as usize;
        Ok(Lowpass { b: [b0, 2.0 * b0, b0], a: [a1, a2], settling })
    }

    /// Filter in place, forwards and backwards: no delay, and twice the slope.
    ///
    /// The ends are continued by odd reflection, and the state starts as if the first value had
    /// always been there, so that a constant or a straight line passes unchanged.
    pub fn filter(&self, signal: &mut [f64]) {
        let n = signal.len();
        if n < 2 {
            return;
        }
        let pad = self.settling.min(n - 1);
        let (first, last) = (signal[0], signal[n - 1]);
        let mut padded = Vec::with_capacity(n + 2 * pad);
        padded.extend((1..=pad).rev().map(|i| 2.0 * first - signal[i]));
        padded.extend_from_slice(signal);
        padded.extend((1..=pad).map(|i| 2.0 * last - signal[n - 1 - i]));
        self.run(padded.iter_mut());
        self.run(padded.iter_mut().rev());
        signal.copy_from_slice(&padded[pad..pad + n]);
    }

    /// One run, transposed direct form II.
    fn run<'a>(&self, mut signal: impl Iterator<Item = &'a mut f64>) {
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        let Some(first) = signal.next() else { return };
        // The steady state for a constant input.
        let x = *first;
        let mut z2 = (b2 - a2) * x;
        let mut z1 = (b1 - a1) * x + z2;
        let mut step = |x: &mut f64| {
            let y = b0 * *x + z1;
            z1 = b1 * *x - a1 * y + z2;
            z2 = b2 * *x - a2 * y;
            *x = y;
        };
        step(first);
        signal.for_each(step);
    }
}
