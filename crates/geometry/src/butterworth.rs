//! Zero-phase low-pass: a second-order Butterworth run forwards and backwards.

use std::f64::consts::{PI, SQRT_2};

/// A second-order Butterworth low-pass (bilinear transform). One run has its -3 dB at the cut-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Butterworth {
    b: [f64; 3],
    a: [f64; 2],
}

impl Butterworth {
    /// The filter for a cut-off in cycles per sample; none unless 0 < cutoff < 1/2.
    pub fn low_pass(cutoff: f64) -> Option<Butterworth> {
        if !(cutoff > 0.0 && cutoff < 0.5) {
            return None;
        }
        // Prewarped analogue frequency: `libm`, the same bits everywhere.
        let w = libm::tan(PI * cutoff);
        let norm = 1.0 / (1.0 + SQRT_2 * w + w * w);
        let b0 = w * w * norm;
        let a1 = 2.0 * (w * w - 1.0) * norm;
        let a2 = (1.0 - SQRT_2 * w + w * w) * norm;
        Some(Butterworth { b: [b0, 2.0 * b0, b0], a: [a1, a2] })
    }

    /// Filters in place, forwards and backwards: no delay, twice the slope, gain 1/2 at the cut-off.
    ///
    /// The ends are continued by `extension` samples, mirrored in the end points as often as a short
    /// stretch needs, and each run starts as if its first value had always been there: a constant or,
    /// with an extension that the filter's memory fades in, a straight line passes unchanged.
    pub fn filter(&self, samples: &mut [f64], extension: usize) {
        let lanes: &mut [[f64; 1]] = bytemuck::cast_slice_mut(samples);
        self.filter_lanes(lanes, extension);
    }

    /// The same of several signals side by side, each by itself: a processor goes on with the others
    /// while it waits for one.
    pub fn filter_lanes<const N: usize>(&self, samples: &mut [[f64; N]], extension: usize) {
        let n = samples.len();
        if n < 2 {
            return;
        }
        let (first, last) = (samples[0], samples[n - 1]);
        let period = 2 * (n - 1) as isize;
        let mirrored = |i: isize| -> [f64; N] {
            let (turn, place) = (i.div_euclid(period), i.rem_euclid(period));
            std::array::from_fn(|k| {
                let value = match samples.get(place as usize) {
                    Some(sample) => sample[k],
                    None => 2.0 * last[k] - samples[(period - place) as usize][k],
                };
                value + turn as f64 * 2.0 * (last[k] - first[k])
            })
        };
        let beyond = extension as isize;
        let mut extended = Vec::with_capacity(n + 2 * extension);
        extended.extend((-beyond..0).map(mirrored));
        extended.extend_from_slice(samples);
        extended.extend((n as isize..n as isize + beyond).map(mirrored));
        self.run(extended.iter_mut());
        self.run(extended.iter_mut().rev());
        samples.copy_from_slice(&extended[extension..extension + n]);
    }

    /// One run, transposed direct form II, from the steady state of the first sample.
    fn run<'a, const N: usize>(&self, mut samples: impl Iterator<Item = &'a mut [f64; N]>) {
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        let Some(first) = samples.next() else { return };
        let mut z2 = first.map(|x| (b2 - a2) * x);
        let mut z1: [f64; N] = std::array::from_fn(|k| (b1 - a1) * first[k] + z2[k]);
        let mut step = |x: &mut [f64; N]| {
            for k in 0..N {
                let y = b0 * x[k] + z1[k];
                z1[k] = b1 * x[k] - a1 * y + z2[k];
                z2[k] = b2 * x[k] - a2 * y;
                x[k] = y;
            }
        };
        step(first);
        samples.for_each(step);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equals_scipy_filtfilt() {
        let mut samples: Vec<f64> = (0..40)
            .map(f64::from)
            .map(|i| (0.3 * i).sin() + 0.5 * (1.7 * i).cos() + 0.01 * i * i)
            .collect();
        Butterworth::low_pass(0.06).unwrap().filter(&mut samples, 9);
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

    #[test]
    fn lanes_are_filtered_as_if_each_were_alone() {
        let alone = |k: u32| -> Vec<f64> {
            (0..50).map(|i| (0.2 * f64::from(i + k)).sin() + 0.1 * f64::from(i * k)).collect()
        };
        let filter = Butterworth::low_pass(0.07).unwrap();
        let mut lanes: Vec<[f64; 3]> = (0..50).map(|i| [0, 1, 2].map(|k| alone(k)[i])).collect();
        filter.filter_lanes(&mut lanes, 43);
        for k in 0..3 {
            let mut own = alone(k);
            filter.filter(&mut own, 43);
            assert!(own.iter().zip(&lanes).all(|(a, b)| a.to_bits() == b[k as usize].to_bits()));
        }
    }

    #[test]
    fn constants_pass_at_any_length_and_there_is_no_filter_beyond_half_the_rate() {
        for n in [1, 2, 3, 5, 400] {
            let mut samples = vec![3.5; n];
            Butterworth::low_pass(0.1).unwrap().filter(&mut samples, 30);
            assert!(samples.iter().all(|x| (x - 3.5).abs() < 1e-12));
        }
        for cutoff in [0.0, -0.1, 0.5, f64::NAN] {
            assert_eq!(Butterworth::low_pass(cutoff), None);
        }
    }
}
