//! The probability of an answer under the cumulative logit, and its derivatives.
//!
//! P(y <= j) = logistic(θ_j - η). Of an answer between the thresholds θ_l and θ_u,
//! σ(θ_u - η) - σ(θ_l - η) = σ(θ_u - η) σ(η - θ_l) (1 - exp(θ_l - θ_u)): a product, which loses nothing where both
//! probabilities are near 0 or near 1.

/// Thresholds, ascending, with what each answer's category needs of them.
pub(super) struct Thresholds {
    values: Vec<f64>,
    /// Of each category: ln(1 - exp(-width)), 0 at both ends.
    ln_width: Vec<f64>,
    /// Of each category: 1 / (exp(width) - 1), 0 at both ends.
    by_width: Vec<f64>,
}

/// The derivatives of minus the log probability of an answer.
pub(super) struct Terms {
    /// By η: first, second (above 0), third.
    pub by_eta: [f64; 3],
    /// Derivatives by the upper and by the lower threshold, of -ln P, of its first and of its second derivative by η;
    /// 0 for a threshold that the category does not have.
    pub by_threshold: [[f64; 2]; 3],
}

/// What Newton's method for the effects needs of an answer.
pub(super) struct Curvature {
    pub minus_ln_p: f64,
    pub first: f64,
    pub second: f64,
}

impl Thresholds {
    pub(super) fn new(values: Vec<f64>) -> Self {
        let inner: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let around = |of: fn(f64) -> f64| {
            let mut all = vec![0.0];
            all.extend(inner.iter().map(|width| of(*width)));
            all.push(0.0);
            all
        };
        let ln_width = around(|width| libm::log(-libm::expm1(-width)));
        let by_width = around(|width| 1.0 / libm::expm1(width));
        Self { values, ln_width, by_width }
    }

    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// σ(θ_u - η) and σ(θ_l - η) of a category, with the logarithms of the first and of one less the second.
    #[inline(always)]
    fn ends(&self, category: usize, eta: f64) -> ([f64; 2], f64) {
        let (mut upper, mut lower, mut ln) = (1.0, 0.0, self.ln_width[category]);
        if let Some(threshold) = self.values.get(category) {
            let (p, ln_p) = logistic(threshold - eta);
            upper = p;
            ln += ln_p;
        }
        if category > 0 {
            let (above, ln_above) = logistic(eta - self.values[category - 1]);
            lower = 1.0 - above;
            ln += ln_above;
        }
        ([upper, lower], ln)
    }

    /// Of an answer in a category (from 0).
    #[inline(always)]
    pub(super) fn curvature(&self, category: usize, eta: f64) -> Curvature {
        let ([a, b], ln_p) = self.ends(category, eta);
        Curvature { minus_ln_p: -ln_p, first: 1.0 - a - b, second: a * (1.0 - a) + b * (1.0 - b) }
    }

    /// Of an answer in a category (from 0).
    pub(super) fn terms(&self, category: usize, eta: f64) -> Terms {
        let ([a, b], _) = self.ends(category, eta);
        let (slope_a, slope_b) = (a * (1.0 - a), b * (1.0 - b));
        let (bend_a, bend_b) = (slope_a * (1.0 - 2.0 * a), slope_b * (1.0 - 2.0 * b));
        // At an end of the scale the slopes of the threshold that is not there are 0 of themselves.
        let edge = self.by_width[category];
        Terms {
            by_eta: [1.0 - a - b, slope_a + slope_b, -bend_a - bend_b],
            by_threshold: [[a - 1.0 - edge, b + edge], [-slope_a, -slope_b], [bend_a, bend_b]],
        }
    }
}

/// The logistic function and its logarithm.
#[inline(always)]
fn logistic(x: f64) -> (f64, f64) {
    let small = libm::exp(-x.abs());
    let ln = libm::log1p(small);
    if x >= 0.0 { (1.0 / (1.0 + small), -ln) } else { (small / (1.0 + small), x - ln) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_add_up_and_derivatives_are_slopes() {
        let values = vec![-1.5, 0.2, 0.9];
        let thresholds = Thresholds::new(values.clone());
        for eta in [-30.0, -2.0, 0.0, 0.7, 5.0] {
            let sum: f64 = (0..4).map(|c| (-thresholds.curvature(c, eta).minus_ln_p).exp()).sum();
            assert!((sum - 1.0).abs() < 1e-14);
            for category in 0..4 {
                let own = thresholds.terms(category, eta);
                let h = 1e-5;
                let at = |eta: f64| thresholds.terms(category, eta);
                let (above, below) = (at(eta + h), at(eta - h));
                let slope = |above: f64, below: f64| (above - below) / (2.0 * h);
                let near = |own: f64, slope: f64| {
                    assert!((own - slope).abs() < 1e-8, "{category} at {eta}: {own}, {slope}");
                };
                let height = |eta: f64| thresholds.curvature(category, eta).minus_ln_p;
                near(own.by_eta[0], slope(height(eta + h), height(eta - h)));
                near(own.by_eta[1], slope(above.by_eta[0], below.by_eta[0]));
                near(own.by_eta[2], slope(above.by_eta[1], below.by_eta[1]));
                let short = thresholds.curvature(category, eta);
                assert_eq!([short.first, short.second], [own.by_eta[0], own.by_eta[1]]);
                for (side, threshold) in [(0, Some(category)), (1, category.checked_sub(1))] {
                    let Some(threshold) = threshold.filter(|t| *t < values.len()) else { continue };
                    let moved = |by: f64| {
                        let mut values = values.clone();
                        values[threshold] += by;
                        let moved = Thresholds::new(values);
                        (moved.terms(category, eta), moved.curvature(category, eta).minus_ln_p)
                    };
                    let ((above, high), (below, low)) = (moved(h), moved(-h));
                    near(own.by_threshold[0][side], slope(high, low));
                    near(own.by_threshold[1][side], slope(above.by_eta[0], below.by_eta[0]));
                    near(own.by_threshold[2][side], slope(above.by_eta[1], below.by_eta[1]));
                }
            }
        }
    }

    #[test]
    fn far_out_nothing_is_lost() {
        let thresholds = Thresholds::new(vec![0.0, 1.0]);
        // ln(σ(1 - 800) - σ(-800)) = -800 + ln(e - 1), to rounding.
        let own = thresholds.curvature(1, 800.0).minus_ln_p;
        assert!((own - (800.0 - 1.0_f64.exp_m1().ln())).abs() < 1e-9);
    }
}
