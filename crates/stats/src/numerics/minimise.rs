//! Minimum of a smooth function by limited memory BFGS (Nocedal and Wright, Numerical Optimization,
//! 2006, algorithms 7.4 and 7.5) with a line search for the weak Wolfe conditions by bisection
//! (Lewis and Overton, Math. Program. 2013, algorithm 2.6).

use std::collections::VecDeque;

use crate::numerics::dot;

/// When to stop.
pub struct Stop {
    /// Largest element of the gradient.
    pub gradient: f64,
    /// Most steps.
    pub steps: usize,
}

/// Where the search ended.
pub struct Minimum {
    /// The place.
    pub at: Vec<f64>,
    /// The value there.
    pub value: f64,
    /// Largest element of the gradient there.
    pub gradient: f64,
    /// Whether that is small enough.
    pub converged: bool,
}

/// Steps that are remembered.
const MEMORY: usize = 20;
/// Share of the slope's promise that a step must keep (Armijo), and share of the slope left (Wolfe).
const KEPT: f64 = 1e-4;
const LEFT: f64 = 0.9;
/// Share of the value by which rounding alone may raise it: near the bottom a good step looks level.
const ROUNDING: f64 = 1e-13;

/// A step, the change of the gradient along it, one over their product.
struct Step {
    way: Vec<f64>,
    change: Vec<f64>,
    rho: f64,
}

/// Minimise from a start; `value` writes the gradient into its second argument.
pub fn minimise(
    start: Vec<f64>,
    stop: &Stop,
    mut value: impl FnMut(&[f64], &mut [f64]) -> f64,
) -> Minimum {
    let mut at = start;
    let mut gradient = vec![0.0; at.len()];
    let mut height = value(&at, &mut gradient);
    let mut memory: VecDeque<Step> = VecDeque::with_capacity(MEMORY);
    let mut next = at.clone();
    let mut next_gradient = gradient.clone();
    for _ in 0..stop.steps {
        if largest(&gradient) <= stop.gradient {
            break;
        }
        let direction = direction(&gradient, &memory);
        let slope = dot(&direction, &gradient);
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut length = if memory.is_empty() { 1.0 / largest(&gradient).max(1.0) } else { 1.0 };
        let mut moved = false;
        let mut next_height = height;
        for _ in 0..60 {
            for ((n, a), d) in next.iter_mut().zip(&at).zip(&direction) {
                *n = a + length * d;
            }
            next_height = value(&next, &mut next_gradient);
            let promised = height + KEPT * length * slope + ROUNDING * height.abs();
            if next_height.is_nan() || next_height > promised {
                high = length;
            } else {
                moved = true;
                if dot(&next_gradient, &direction) >= LEFT * slope {
                    break;
                }
                low = length;
            }
            length = if high.is_finite() { (low + high) / 2.0 } else { 2.0 * low };
        }
        if !moved {
            break;
        }
        let way: Vec<f64> = next.iter().zip(&at).map(|(n, a)| n - a).collect();
        let change: Vec<f64> = next_gradient.iter().zip(&gradient).map(|(n, g)| n - g).collect();
        let product = dot(&way, &change);
        if product > 0.0 {
            if memory.len() == MEMORY {
                memory.pop_front();
            }
            memory.push_back(Step { way, change, rho: 1.0 / product });
        }
        std::mem::swap(&mut at, &mut next);
        std::mem::swap(&mut gradient, &mut next_gradient);
        height = next_height;
    }
    let gradient = largest(&gradient);
    Minimum { at, value: height, gradient, converged: gradient <= stop.gradient }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| v.abs().max(most))
}

/// Minus the inverse of the remembered curvature times the gradient (algorithm 7.4).
fn direction(gradient: &[f64], memory: &VecDeque<Step>) -> Vec<f64> {
    let mut direction: Vec<f64> = gradient.iter().map(|g| -g).collect();
    let mut shares = Vec::with_capacity(memory.len());
    for step in memory.iter().rev() {
        let share = step.rho * dot(&step.way, &direction);
        direction.iter_mut().zip(&step.change).for_each(|(d, y)| *d -= share * y);
        shares.push(share);
    }
    if let Some(last) = memory.back() {
        let scale = 1.0 / (last.rho * dot(&last.change, &last.change));
        direction.iter_mut().for_each(|d| *d *= scale);
    }
    for (step, share) in memory.iter().zip(shares.into_iter().rev()) {
        let other = step.rho * dot(&step.change, &direction);
        direction.iter_mut().zip(&step.way).for_each(|(d, s)| *d += (share - other) * s);
    }
    direction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bottom_of_rosenbrocks_valley_is_found() {
        let found = minimise(vec![-1.2, 1.0], &Stop { gradient: 1e-10, steps: 500 }, |p, g| {
            let (a, b) = (1.0 - p[0], p[1] - p[0] * p[0]);
            g[0] = -2.0 * a - 400.0 * p[0] * b;
            g[1] = 200.0 * b;
            a * a + 100.0 * b * b
        });
        assert!(found.converged, "{}", found.gradient);
        found.at.iter().for_each(|p| assert!((p - 1.0).abs() < 1e-9));
    }
}
