//! Degrees of freedom of a contrast by Satterthwaite's method: those of the chi-square distribution whose variance is
//! that of the contrast's estimated variance (Giesbrecht and Burns 1985; Fai and Cornelius 1996 for several contrasts;
//! Kuznetsova, Brockhoff and Christensen 2017).

use nalgebra::{DMatrix, DVector};

use super::reml::{Data, Solved};

/// Relative step of the differences of slopes that give second derivatives.
const DIFFERENCE: f64 = 1e-4;

/// How well the variances are known.
pub(super) struct Satterthwaite<'d> {
    data: &'d Data,
    solved: &'d Solved,
    /// Standard deviations that are not 0: the others are left out as the search leaves them out.
    free: Vec<usize>,
    /// Covariance of these deviations and of the logarithm of the residual variance, last.
    covariance: DMatrix<f64>,
    sds: Vec<f64>,
    variance: f64,
}

impl<'d> Satterthwaite<'d> {
    /// At the highest restricted likelihood; none where its second derivatives are no information.
    pub(super) fn new(data: &'d Data, solved: &'d Solved, sds: &[f64]) -> Option<Self> {
        let df = data.residual_df() as f64;
        let variance = solved.squares / df;
        let free: Vec<usize> = (0..sds.len()).filter(|term| sds[*term] != 0.0).collect();
        let size = free.len() + 1;
        let mut second = DMatrix::zeros(size, size);
        let all: Vec<f64> = data.slopes(sds, solved, variance);
        let twice: Vec<f64> = data.slopes(sds, solved, 2.0 * variance);
        for (column, term) in free.iter().enumerate() {
            let step = DIFFERENCE * sds[*term].abs();
            let side = |by: f64| {
                let mut at = sds.to_vec();
                at[*term] += by;
                Some(data.slopes(&at, &data.solved(&at)?, variance))
            };
            let (above, below) = (side(step)?, side(-step)?);
            for (row, other) in free.iter().enumerate() {
                second[(row, column)] = (above[*other] - below[*other]) / (2.0 * step);
            }
            // Slopes are (trace - squares / variance) / sd: their slope by the variance's logarithm is squares /
            // variance / sd, which is twice the difference from the slope at twice the variance.
            let by_variance = 2.0 * (twice[*term] - all[*term]);
            second[(size - 1, column)] = by_variance;
            second[(column, size - 1)] = by_variance;
        }
        second[(size - 1, size - 1)] = df / 2.0;
        let second = (&second + second.transpose()) / 2.0;
        let covariance = second.cholesky()?.inverse();
        let sds = sds.to_vec();
        Some(Self { data, solved, free, covariance, sds, variance })
    }

    /// Variance of a contrast of the coefficients and its degrees of freedom.
    pub(super) fn of(&self, contrast: &DVector<f64>) -> (f64, f64) {
        let weights = self.solved.information.solve(contrast);
        let variance = self.variance * contrast.dot(&weights);
        let squares = self.data.squares_by_deviation(self.solved, &weights);
        // By each deviation: 2/σ times the squares, in units of the residual variance.
        let slopes =
            self.free.iter().map(|term| 2.0 * self.variance * squares[*term] / self.sds[*term]);
        let slopes: Vec<f64> = slopes.chain([variance]).collect();
        let slopes = DVector::from_vec(slopes);
        let of_variance = (&self.covariance * &slopes).dot(&slopes);
        (variance, 2.0 * variance * variance / of_variance)
    }

    /// Wald's F of several contrasts, rows of a matrix, and its denominator's degrees of freedom.
    pub(super) fn together(&self, contrasts: &DMatrix<f64>) -> Option<(f64, f64)> {
        let count = contrasts.nrows();
        let estimates = contrasts * &self.solved.coefficients;
        let solved = self.solved.information.solve(&contrasts.transpose());
        let covariance = contrasts * solved * self.variance;
        let f = estimates.dot(&covariance.clone().cholesky()?.solve(&estimates)) / count as f64;
        if count == 1 {
            let contrast = contrasts.row(0).transpose();
            return Some((f, self.of(&contrast).1));
        }
        // Independent contrasts, along the axes of their covariance.
        let axes = covariance.symmetric_eigen().eigenvectors.transpose() * contrasts;
        let df: Vec<f64> = axes.row_iter().map(|axis| self.of(&axis.transpose()).1).collect();
        Some((f, denominator(&df)))
    }
}

/// Degrees of freedom of F from those of its independent t: so that the means agree, E F = ν / (ν - 2).
fn denominator(df: &[f64]) -> f64 {
    let count = df.len() as f64;
    let mean = df.iter().sum::<f64>() / count;
    if df.iter().all(|own| (own - mean).abs() < 1e-8 * mean) {
        return mean;
    }
    if df.iter().any(|own| *own <= 2.0) {
        return 2.0;
    }
    let sum: f64 = df.iter().map(|own| own / (own - 2.0)).sum();
    2.0 * sum / (sum - count)
}
