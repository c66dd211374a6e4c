//! Gauss and Hermite's quadrature: means over a normal variable (Abramowitz and Stegun 25.4.46).

use core::f64::consts::PI;

/// Nodes x and weights w of n points: Σ w f(x) is the integral of exp(-x²) f(x), exact for polynomials
/// below degree 2n.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussHermite {
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

impl GaussHermite {
    /// Of n points, from 2 to 100.
    pub fn new(points: usize) -> Self {
        let points = points.clamp(2, 100);
        let mut nodes = vec![0.0; points];
        let mut weights = vec![0.0; points];
        let half = points.div_ceil(2);
        for place in 0..half {
            // The largest zero first. The intervals between zeros near each start are wider than its error
            // (Szegő 1975, section 6.32, and Newton's extrapolation from the two before).
            let mut x = match place {
                0 => {
                    let n = points as f64;
                    libm::sqrt(2.0 * n + 1.0) - 1.85575 * libm::pow(2.0 * n + 1.0, -1.0 / 6.0)
                }
                1 => {
                    let last = nodes[0];
                    last - 1.14 * libm::pow(points as f64, 0.426) / last
                }
                2 => 1.86 * nodes[1] - 0.86 * nodes[0],
                3 => 1.91 * nodes[2] - 0.91 * nodes[1],
                _ => 2.0 * nodes[place - 1] - nodes[place - 2],
            };
            for _ in 0..50 {
                let (value, slope) = hermite(points, x);
                let step = value / slope;
                x -= step;
                if step.abs() < 1e-15 * (1.0 + x.abs()) {
                    break;
                }
            }
            if place == points - 1 - place {
                x = 0.0;
            }
            let (_, slope) = hermite(points, x);
            nodes[place] = x;
            weights[place] = 2.0 / (slope * slope);
            nodes[points - 1 - place] = -x;
            weights[points - 1 - place] = weights[place];
        }
        Self { nodes, weights }
    }

    /// The mean of a function of a normal variable.
    pub fn mean(&self, mean: f64, variance: f64, f: impl Fn(f64) -> f64) -> f64 {
        let width = libm::sqrt(2.0 * variance);
        let sum: f64 = self
            .nodes
            .iter()
            .zip(&self.weights)
            .map(|(node, weight)| weight * f(mean + width * node))
            .sum();
        sum / libm::sqrt(PI)
    }
}

/// The orthonormal Hermite polynomial of degree n, and its slope.
fn hermite(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut own) = (0.0, libm::pow(PI, -0.25));
    for degree in 0..n {
        let k = degree as f64;
        let next = x * libm::sqrt(2.0 / (k + 1.0)) * own - libm::sqrt(k / (k + 1.0)) * before;
        (before, own) = (own, next);
    }
    (own, libm::sqrt(2.0 * n as f64) * before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_the_normal_distribution_are_exact() {
        for points in [2, 3, 5, 16, 32, 33, 64] {
            let rule = GaussHermite::new(points);
            let mut expected = 1.0;
            for degree in (0..2 * points).step_by(2).take(12) {
                let moment = rule.mean(0.0, 1.0, |x| libm::pow(x, degree as f64));
                assert!((moment / expected - 1.0).abs() < 1e-11, "{points} {degree} {moment}");
                expected *= degree as f64 + 1.0;
            }
            let odd = rule.mean(0.0, 1.0, |x| x * x * x);
            assert!(odd.abs() < 1e-12, "{points} {odd}");
            let mut sorted = rule.nodes.clone();
            sorted.dedup();
            assert_eq!(sorted.len(), points);
        }
        let mean = GaussHermite::new(32).mean(2.0, 9.0, |x| x * x);
        assert!((mean - 13.0).abs() < 1e-12);
    }
}
