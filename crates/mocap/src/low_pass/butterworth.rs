//! Second-order Butterworth run forwards and backwards.
//!
//! The same numbers as SciPy's `filtfilt(*butter(2, 2 * cutoff), x)`: bilinear transform, ends
//! extended by 9 samples mirrored in the end point, each pass started in the steady state of its
//! first sample.

/// Samples by which each end is extended: three times the filter's three coefficients.
const EXTENSION: usize = 9;

/// Filter in place; `cutoff` in cycles a sample, above 0 and below 1/2.
pub(crate) fn filter(samples: &mut [f64], cutoff: f64) {
    let n = samples.len();
    if n < 2 {
        return;
    }
    let (first, last) = (samples[0], samples[n - 1]);
    let period = 2 * (n - 1);
    // The samples mirrored in both end points, as often as a short stretch needs.
    let mirrored = |i: isize| {
        let (turn, place) = (i.div_euclid(period as isize), i.rem_euclid(period as isize) as usize);
        let value = if place < n { samples[place] } else { 2.0 * last - samples[period - place] };
        value + turn as f64 * 2.0 * (last - first)
    };
    let pad = EXTENSION as isize;
    let mut extended: Vec<f64> = (-pad..n as isize + pad).map(mirrored).collect();
    let section = Section::low_pass(cutoff);
    section.run(&mut extended);
    extended.reverse();
    section.run(&mut extended);
    extended.reverse();
    samples.copy_from_slice(&extended[EXTENSION..EXTENSION + n]);
}

/// Coefficients of `y = (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2) x`.
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl Section {
    fn low_pass(cutoff: f64) -> Self {
        // The analog frequency that the bilinear transform takes to the cut-off.
        let k = (std::f64::consts::PI * cutoff).tan();
        let root2 = std::f64::consts::SQRT_2;
        let norm = 1.0 / (1.0 + root2 * k + k * k);
        let b0 = k * k * norm;
        Self {
            b: [b0, 2.0 * b0, b0],
            a: [2.0 * (k * k - 1.0) * norm, (1.0 - root2 * k + k * k) * norm],
        }
    }

    /// One pass in place, from the steady state of the first sample (gain 1 at frequency 0).
    fn run(&self, samples: &mut [f64]) {
        let Some(&first) = samples.first() else { return };
        let mut z1 = (1.0 - self.b[0]) * first;
        let mut z2 = (self.b[2] - self.a[1]) * first;
        for sample in samples {
            let x = *sample;
            let y = self.b[0] * x + z1;
            z1 = self.b[1] * x - self.a[0] * y + z2;
            z2 = self.b[2] * x - self.a[1] * y;
            *sample = y;
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn equals_scipy_filtfilt() {
        let mut samples: Vec<f64> = (0..40)
            .map(f64::from)
            .map(|i| (0.3 * i).sin() + 0.5 * (1.7 * i).cos() + 0.01 * i * i)
            .collect();
        super::filter(&mut samples, 0.06);
        // scipy.signal.filtfilt(*scipy.signal.butter(2, 0.12), x), SciPy 1.x
        for (index, want) in GOLDEN {
            assert!((samples[index] - want).abs() < 1e-11, "{index}: {} {want}", samples[index]);
        }
    }

    const GOLDEN: [(usize, f64); 5] = [
        (0, 0.49287544299794106),
        (1, 0.6117186098355182),
        (13, 1.180507311794795),
        (27, 8.006204187943109),
        (39, 14.083564359773344),
    ];
}
