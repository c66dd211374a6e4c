//! Raised-cosine low-pass in the Fourier domain (Kouadio 1997, eq. 7.1):
//!
//! H(f) = 1 below fc - df/2, (sin((fc - f) pi / df) + 1) / 2 on the flank, 0 above fc + df/2.
//!
//! The Fourier transform takes a take for a period of an endless repetition, so a take that ends
//! elsewhere than it started would ring at both ends. Here the straight line from the first to the
//! last sample is set aside and the rest continued as an odd function: it then repeats every
//! 2(n - 1) samples without a jump or a kink, and the line is added again after the filter.

use rustfft::{FftPlanner, num_complex::Complex};
use std::f64::consts::PI;

/// Gain of eq. 7.1; all in the same unit of frequency.
fn gain(frequency: f64, cutoff: f64, width: f64) -> f64 {
    if frequency <= cutoff - width / 2.0 {
        1.0
    } else if frequency < cutoff + width / 2.0 {
        (((cutoff - frequency) * PI / width).sin() + 1.0) / 2.0
    } else {
        0.0
    }
}

/// Filter in place; cut-off and width in cycles per sample.
pub(crate) fn filter(samples: &mut [f64], cutoff: f64, width: f64) {
    let n = samples.len();
    if n < 3 {
        return;
    }
    let (first, last) = (samples[0], samples[n - 1]);
    let line = |i: usize| first + (last - first) * i as f64 / (n - 1) as f64;
    let period = 2 * (n - 1);
    let mut spectrum: Vec<Complex<f64>> = Vec::with_capacity(period);
    spectrum.extend(samples.iter().enumerate().map(|(i, s)| Complex::new(s - line(i), 0.0)));
    for i in (1..n - 1).rev() {
        spectrum.push(-spectrum[i]);
    }
    let mut planner = FftPlanner::new();
    planner.plan_fft_forward(period).process(&mut spectrum);
    for (bin, value) in spectrum.iter_mut().enumerate() {
        let frequency = bin.min(period - bin) as f64 / period as f64;
        *value *= gain(frequency, cutoff, width) / period as f64;
    }
    planner.plan_fft_inverse(period).process(&mut spectrum);
    for (i, sample) in samples.iter_mut().enumerate() {
        *sample = line(i) + spectrum[i].re;
    }
}
