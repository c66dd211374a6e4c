//! Epsilon support vector regression with a Gaussian kernel; the optimality conditions of each answer are computed again
//! from its coefficients.

use mimique_exertion::{SupportVectorParts, gaussian_kernels};
use mimique_stats::{KernelMatrix, SupportVectorDual};

use crate::TrainingError;

/// Rows that are learnt from: below, there is nothing to learn; above, kernels fill the memory.
pub const ROWS: [usize; 2] = [2, 6000];

/// minimise a'Ka/2 - a'y + epsilon |a|_1 over |a_i| <= C, sum a = 0, with K_ij = exp(-gamma |x_i - x_j|^2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EpsilonSvr {
    /// The bound C of every coefficient.
    pub c: f64,
    /// One over the squared width of the kernel.
    pub gamma: f64,
    /// Half the width of the tube in which an error costs nothing.
    pub epsilon: f64,
    /// By how much the optimality conditions may be missed.
    pub tolerance: f64,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// A coefficient a row; 0 for rows inside the tube.
    pub coefficients: Vec<f64>,
    /// The constant; where no coefficient lies between its bounds, the middle of what the conditions allow.
    pub b: f64,
    /// The minimum.
    pub objective: f64,
    /// By how much the optimality conditions are missed.
    pub violation: f64,
    /// Whether some coefficient lies at C: where none does, a larger C has the same answer.
    pub at_bound: bool,
}

impl EpsilonSvr {
    /// Learns from rows of the same width and their targets.
    ///
    /// # Errors
    /// [`TrainingError`]: rows and targets that do not fit, numbers that are none, settings out of range.
    pub fn fit(&self, rows: &[&[f64]], targets: &[f64]) -> Result<Fitted, TrainingError> {
        self.check(rows, targets)?;
        let by_feature = |k: usize| rows.iter().map(|row| row[k]).collect();
        let features: Vec<Vec<f64>> = (0..rows[0].len()).map(by_feature).collect();
        let kernel_row = |i: usize, out: &mut [f64]| {
            gaussian_kernels(self.gamma, &features, rows[i].iter().copied(), out);
        };
        let matrix = KernelMatrix { diagonal: vec![1.0; rows.len()], row: &kernel_row };
        let (c, epsilon, tolerance) = (self.c, self.epsilon, self.tolerance);
        let found = SupportVectorDual::regression(matrix, targets, c, epsilon, tolerance).solve();
        // Predictions without the constant: of the coefficients alone, so that rounding in the solver's steps shows.
        let mut sums = vec![0.0; rows.len()];
        let mut kernels = vec![0.0; rows.len()];
        for (j, a) in found.coefficients.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            kernel_row(j, &mut kernels);
            sums.iter_mut().zip(&kernels).for_each(|(sum, kernel)| *sum += a * kernel);
        }
        Ok(self.with_violation(targets, &sums, found.coefficients, found.bias))
    }

    fn check(&self, rows: &[&[f64]], targets: &[f64]) -> Result<(), TrainingError> {
        let [least, most] = ROWS;
        if !(least..=most).contains(&rows.len()) {
            return Err(TrainingError::Rows { found: rows.len(), least, most });
        }
        if targets.len() != rows.len() {
            let (found, expected) = (targets.len(), rows.len());
            return Err(TrainingError::Count { what: "targets", found, expected });
        }
        let width = rows[0].len();
        for (row, (own, target)) in rows.iter().zip(targets).enumerate() {
            if own.len() != width || width == 0 {
                let (found, expected) = (own.len(), width.max(1));
                return Err(TrainingError::Count { what: "features", found, expected });
            }
            if !target.is_finite() || own.iter().any(|value| !value.is_finite()) {
                return Err(TrainingError::NotANumber { row });
            }
        }
        for (setting, value) in
            [("C", self.c), ("gamma", self.gamma), ("tolerance", self.tolerance)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(TrainingError::Setting { setting, value, range: "above 0" });
            }
        }
        if !(self.epsilon >= 0.0 && self.epsilon.is_finite()) {
            let (setting, value) = ("epsilon", self.epsilon);
            return Err(TrainingError::Setting { setting, value, range: "from 0 on" });
        }
        Ok(())
    }

    /// Adds the objective and the violation to an answer; `sums` are Ka. With r = y - Ka every coefficient bounds the constant b: inside
    /// the tube r - epsilon <= b <= r + epsilon, between its bounds b lies on one side of the tube, at C it
    /// lies beyond.
    fn with_violation(
        &self,
        targets: &[f64],
        sums: &[f64],
        coefficients: Vec<f64>,
        b: f64,
    ) -> Fitted {
        let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut objective = 0.0;
        let mut at_bound = false;
        for ((target, sum), &a) in targets.iter().zip(sums).zip(&coefficients) {
            let r = target - sum;
            objective += 0.5 * a * sum - a * target + self.epsilon * a.abs();
            let bound = a.abs() >= self.c * (1.0 - 1e-12);
            at_bound |= bound;
            let side = if a > 0.0 { r - self.epsilon } else { r + self.epsilon };
            if a == 0.0 {
                least = least.max(r - self.epsilon);
                most = most.min(r + self.epsilon);
            } else {
                if !(bound && a > 0.0) {
                    least = least.max(side);
                }
                if !(bound && a < 0.0) {
                    most = most.min(side);
                }
            }
        }
        let violation = (least - most).max(0.0);
        Fitted { coefficients, b, objective, violation, at_bound }
    }
}

impl Fitted {
    /// The regression's numbers: the rows that have a coefficient, of a fit on (x - offset) / scale.
    pub fn parts(
        &self,
        rows: &[&[f64]],
        gamma: f64,
        offset: Vec<f64>,
        scale: Vec<f64>,
    ) -> SupportVectorParts {
        let used: Vec<usize> = (0..rows.len()).filter(|&i| self.coefficients[i] != 0.0).collect();
        SupportVectorParts {
            gamma,
            b: self.b,
            offset,
            scale,
            vectors: used.iter().map(|&i| rows[i].to_vec()).collect(),
            coefficients: used.iter().map(|&i| self.coefficients[i]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use mimique_exertion::SupportVectors;
    use mimique_test_support::Random;

    use super::*;

    fn rows(values: &[Vec<f64>]) -> Vec<&[f64]> {
        values.iter().map(Vec::as_slice).collect()
    }

    /// A planted function with noise, and its regression.
    fn planted(noise: f64) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut random = Random::new(3);
        let x: Vec<Vec<f64>> =
            (0..120).map(|_| vec![4.0 * random.uniform() - 2.0, random.normal()]).collect();
        let y =
            x.iter().map(|x| 30.0 * x[0].sin() + 10.0 * x[1] + noise * random.normal()).collect();
        (x, y)
    }

    #[test]
    fn a_planted_function_is_recovered_and_the_conditions_hold() {
        let (x, y) = planted(0.0);
        let svr = EpsilonSvr { c: 1e3, gamma: 0.3, epsilon: 0.5, tolerance: 1e-6 };
        let fitted = svr.fit(&rows(&x), &y).unwrap();
        assert!(fitted.violation < 2e-6, "{}", fitted.violation);
        assert!(fitted.coefficients.iter().sum::<f64>().abs() < 1e-6);
        let model =
            SupportVectors::new(fitted.parts(&rows(&x), svr.gamma, vec![0.0; 2], vec![1.0; 2]));
        let model = model.unwrap();
        for (x, y) in x.iter().zip(&y) {
            assert!((model.predict(x).unwrap() - y).abs() < 0.6);
        }
    }

    #[test]
    fn below_the_bound_a_larger_bound_changes_nothing() {
        let (x, y) = planted(2.0);
        let fit = |c: f64| {
            EpsilonSvr { c, gamma: 50.0, epsilon: 1.0, tolerance: 1e-6 }.fit(&rows(&x), &y).unwrap()
        };
        let (small, free, freer) = (fit(10.0), fit(1e3), fit(1e6));
        assert!(small.at_bound && !free.at_bound && !freer.at_bound);
        assert!(free.coefficients.iter().all(|a| a.abs() < 1e3));
        assert!((free.objective - freer.objective).abs() < 1e-6 * free.objective.abs());
    }

    #[test]
    fn scikit_learn_finds_the_same_regressions() {
        // Objective, constant, number of vectors and predictions by SVR of scikit-learn 1.9.1 with tol=1e-10.
        let expected = [
            (
                (2.0, 0.5, 1.0),
                (-590.6892014346, -2.5603419404, 42),
                [3.3635315268, 13.0435438680, -6.8115913694],
            ),
            (
                (500.0, 0.1, 0.25),
                (-22040.7940840175, -7.0531045973, 57),
                [3.2600297899, 18.2567912888, -14.1037499073],
            ),
            (
                (1e4, 2.0, 0.0),
                (-2194.2154564743, -1.8513520490, 60),
                [3.3002832095, 18.7954622238, -2.6793715441],
            ),
            (
                (0.05, 0.3, 3.0),
                (-24.0999447971, -2.3203071449, 50),
                [-2.1385009665, -1.7199832942, -2.6308436073],
            ),
        ];
        let sixteenth =
            |i: u32, factor: u32, shift: u32| f64::from((factor * i + shift) % 64) / 16.0 - 2.0;
        let x: Vec<Vec<f64>> =
            (0..60).map(|i| vec![sixteenth(i, 37, 0), sixteenth(i, 23, 5)]).collect();
        let y: Vec<f64> = (0..60u32)
            .zip(&x)
            .map(|(i, x)| 10.0 * x[0] - 3.0 * x[1] * x[1] + x[0] * x[1] + f64::from(11 * i % 7))
            .collect();
        for ((c, gamma, epsilon), (objective, b, vectors), predictions) in expected {
            let svr = EpsilonSvr { c, gamma, epsilon, tolerance: 1e-9 };
            let fitted = svr.fit(&rows(&x), &y).unwrap();
            // LIBSVM, which scikit-learn calls, stores kernels with the 24 bits of f32.
            let largest = fitted.coefficients.iter().fold(0.0f64, |most, a| most.max(a.abs()));
            let rounding = 60.0 * largest * 0.5f64.powi(24);
            let near = |found: f64, expected: f64, what: &str| {
                let most = rounding.max(1e-7 * expected.abs());
                assert!((found - expected).abs() < most, "{svr:?} {what}: {found}, not {expected}");
            };
            near(fitted.objective, objective, "objective");
            near(fitted.b, b, "constant");
            assert_eq!(fitted.coefficients.iter().filter(|a| **a != 0.0).count(), vectors);
            let model = fitted.parts(&rows(&x), gamma, vec![0.0; 2], vec![1.0; 2]);
            let model = SupportVectors::new(model).unwrap();
            for (at, expected) in [[0.1, -0.2], [1.5, 1.0], [-3.0, 0.5]].iter().zip(predictions) {
                near(model.predict(at).unwrap(), expected, "prediction");
            }
        }
    }

    #[test]
    fn what_cannot_be_learnt_from_is_refused() {
        let svr = EpsilonSvr { c: 1.0, gamma: 1.0, epsilon: 1.0, tolerance: 1e-3 };
        let x = vec![vec![0.0], vec![1.0]];
        assert!(matches!(svr.fit(&[], &[]), Err(TrainingError::Rows { found: 0, .. })));
        assert!(matches!(svr.fit(&rows(&x), &[1.0]), Err(TrainingError::Count { .. })));
        let odd = vec![vec![0.0], vec![1.0, 2.0]];
        assert!(matches!(svr.fit(&rows(&odd), &[1.0, 2.0]), Err(TrainingError::Count { .. })));
        let none = [1.0, f64::NAN];
        assert!(matches!(svr.fit(&rows(&x), &none), Err(TrainingError::NotANumber { row: 1 })));
        for svr in [
            EpsilonSvr { c: 0.0, ..svr },
            EpsilonSvr { gamma: f64::INFINITY, ..svr },
            EpsilonSvr { epsilon: -1.0, ..svr },
        ] {
            let refused = svr.fit(&rows(&x), &[1.0, 2.0]);
            assert!(matches!(refused, Err(TrainingError::Setting { .. })), "{svr:?}");
        }
    }
}
