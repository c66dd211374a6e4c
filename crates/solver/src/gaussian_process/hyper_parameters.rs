//! Hyper-parameters by maximal marginal likelihood: BFGS with the analytic gradient over
//! (ln l, ln s_f, ln s_n), from the best of some lengths and noises.

use mimique_geometry::{DMat3, DVec3};

use crate::gaussian_process::exact::{Evidence, Kernel};

/// Least noise against the signal: nobody knows weights better than to a hundredth, and with much
/// less the sparse form's updates lose their digits on frames that are nearly equal.
const LEAST_NOISE: f64 = 1e-2;
/// Steps of one start; the likelihood of three parameters takes some twenty.
const STEPS: usize = 80;
/// A gradient by the logarithms below this part of the number of numbers explained is flat.
const FLAT: f64 = 1e-6;

/// The kernel with the largest marginal likelihood, and its logarithm. What `given` fixes
/// (length, signal, noise) stays. None for examples that are all alike.
///
/// `inputs`: n x `width`, `outputs`: n x `outputs_width`; O(n^3) a step.
pub fn maximise_likelihood(
    inputs: &[f64],
    width: usize,
    outputs: &[f64],
    outputs_width: usize,
    given: [Option<f64>; 3],
) -> Option<(Kernel, f64)> {
    let evidence = Evidence::new(inputs, width, outputs, outputs_width);
    let squares: f64 = outputs.iter().map(|y| y * y).sum();
    let signal = (squares / outputs.len().max(1) as f64).sqrt();
    let length = median_distance(evidence.distances());
    if !(signal > 0.0 && length > 0.0) {
        return None;
    }
    let bounds = Bounds {
        low: logarithms([1e-3 * length, 1e-3 * signal, 1e-6 * signal]),
        high: logarithms([1e3 * length, 1e3 * signal, 1e2 * signal]),
        fixed: given.map(|value| value.is_some()),
    };
    if let [Some(length), Some(signal), Some(noise)] = given {
        let kernel = Kernel { length, signal, noise };
        let value = evidence.at(&kernel).0;
        return value.is_finite().then_some((kernel, value));
    }
    let mut best: Option<(Kernel, f64)> = None;
    for (stretch, noise) in
        [0.2, 0.5, 1.0, 2.0, 5.0].into_iter().flat_map(|l| [(l, 0.2), (l, 0.01)])
    {
        let start = Kernel {
            length: given[0].unwrap_or(stretch * length),
            signal: given[1].unwrap_or(signal),
            noise: given[2].unwrap_or(noise * signal),
        };
        let value = evidence.at(&start).0;
        if value.is_finite() && best.is_none_or(|(_, most)| value > most) {
            best = Some((start, value));
        }
    }
    best.map(|(start, _)| ascend(&evidence, start, &bounds))
}

/// Half of the pairs are nearer than this.
fn median_distance(squares: &[f64]) -> f64 {
    let mut away: Vec<f64> = squares.iter().copied().filter(|x| *x > 0.0).collect();
    if away.is_empty() {
        return 0.0;
    }
    away.sort_unstable_by(f64::total_cmp);
    away[away.len() / 2].sqrt()
}

/// ln l, ln s_f and ln s_n, the three numbers that are looked for, as one vector.
fn logarithms(parameters: [f64; 3]) -> DVec3 {
    DVec3::from_array(parameters.map(libm::log))
}

struct Bounds {
    low: DVec3,
    high: DVec3,
    fixed: [bool; 3],
}

impl Bounds {
    fn clamp(&self, x: DVec3, from: DVec3) -> DVec3 {
        let mut out = x.max(self.low).min(self.high);
        for (i, _) in self.fixed.iter().enumerate().filter(|(_, fixed)| **fixed) {
            out[i] = from[i];
        }
        if !self.fixed[2] {
            out[2] = out[2].max(out[1] + libm::log(LEAST_NOISE));
        }
        out
    }
}

fn kernel(x: DVec3) -> Kernel {
    Kernel { length: libm::exp(x.x), signal: libm::exp(x.y), noise: libm::exp(x.z) }
}

fn ascend(evidence: &Evidence<'_>, start: Kernel, bounds: &Bounds) -> (Kernel, f64) {
    let logs = logarithms([start.length, start.signal, start.noise]);
    let mut x = bounds.clamp(logs, logs);
    let (mut value, mut gradient) = evidence.at(&kernel(x));
    let flat = FLAT * evidence.numbers() as f64;
    let mut inverse = identity(1.0 / evidence.numbers() as f64);
    let mut fresh = true;
    for _ in 0..STEPS {
        let step = inverse * gradient;
        // No parameter changes by more than e^1.5 at once: far away the model is no guide.
        let largest = step.abs().max_element();
        let mut part = if largest > 1.5 { 1.5 / largest } else { 1.0 };
        let mut accepted = None;
        for _ in 0..12 {
            let to = bounds.clamp(x + part * step, x);
            let moved = to - x;
            let slope = moved.dot(gradient);
            if moved == DVec3::ZERO {
                break;
            }
            let (there, slope_there) = evidence.at(&kernel(to));
            if there.is_finite() && there >= value + 1e-4 * slope.max(0.0) && there > value {
                accepted = Some((to, moved, there, slope_there));
                break;
            }
            part *= 0.5;
        }
        let Some((to, moved, there, slope_there)) = accepted else {
            if fresh {
                break;
            }
            inverse = identity(1.0 / evidence.numbers() as f64);
            fresh = true;
            continue;
        };
        // BFGS on minus the likelihood.
        let change = gradient - slope_there;
        (x, value, gradient, fresh) = (to, there, slope_there, false);
        let free = |i: usize| bounds.clamp(x + gradient, x)[i] != x[i];
        if (0..3).all(|i| gradient[i].abs() < flat || !free(i)) {
            break;
        }
        let curvature = moved.dot(change);
        if curvature > 0.0 {
            inverse = updated(inverse, moved, change, curvature);
        }
    }
    (kernel(x), value)
}

fn identity(scale: f64) -> DMat3 {
    DMat3::from_diagonal(DVec3::splat(scale))
}

/// (I - s y^T / c) H (I - y s^T / c) + s s^T / c.
fn updated(h: DMat3, s: DVec3, y: DVec3, c: f64) -> DMat3 {
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    let hy = h * y;
    h - (outer(s, hy) + outer(hy, s)) * (1.0 / c) + outer(s, s) * ((1.0 + y.dot(hy) / c) / c)
}
