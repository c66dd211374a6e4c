//! Gaussian process regression with a Gaussian (RBF) kernel, several outputs sharing one kernel
//! (thesis 3.3.1, eq. 3.2-3.4; Rasmussen & Williams 2006, algorithm 2.1 and eq. 5.8-5.9).
//!
//! | book | code | size |
//! |---|---|---|
//! | X | inputs, row-major, one row an example | n x D |
//! | y | outputs, row-major | n x N |
//! | k(x, x') = s_f^2 exp(-abs(x - x')^2 / (2 l^2)) | [`Kernel::covariances`] | |
//! | K_y = K + s_n^2 I | Gram matrix with noise | n x n |
//! | log p(y given X), summed over the outputs | [`log_marginal_likelihood`] | |
//!
//! The mean of the process is 0: far from every example it answers the neutral face.

use mimique_geometry::DVec3;
use serde::{Deserialize, Serialize};

use crate::linear_algebra::cholesky::Cholesky;
use crate::linear_algebra::dense::{axpy, dot, squared_distance, widest};
use crate::linear_algebra::exp::exp_all;

/// Hyper-parameters of the kernel, shared by all outputs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Kernel {
    /// l: distance over which the answer changes, in the unit of the inputs.
    pub length: f64,
    /// s_f: standard deviation of the process, in the unit of the outputs.
    pub signal: f64,
    /// s_n: standard deviation of the noise on the outputs.
    pub noise: f64,
}

/// The exact posterior of n examples: O(n^3) once, O(n^2) a prediction.
#[derive(Debug, Clone, PartialEq)]
pub struct ExactProcess {
    /// K_y^-1 y, n x N.
    pub coefficients: Vec<f64>,
    /// -K_y^-1, n x n: what the examples take from the variance.
    pub covariance: Vec<f64>,
}

impl Kernel {
    /// k(x, b) for each row b of `basis` (rows of `x.len()` numbers).
    ///
    /// # Panics
    /// If `out` has more entries than `basis` has rows.
    pub fn covariances(&self, x: &[f64], basis: &[f64], out: &mut [f64]) {
        squared_distances(x, basis, out);
        self.of_squared_distances(out);
    }

    /// k of squared distances, in place.
    pub(crate) fn of_squared_distances(&self, values: &mut [f64]) {
        let scale = -0.5 / (self.length * self.length);
        values.iter_mut().for_each(|v| *v *= scale);
        exp_all(values);
        let variance = self.signal * self.signal;
        values.iter_mut().for_each(|v| *v *= variance);
    }
}

widest! {
    /// abs(x - b)^2 for each row b of a row-major matrix.
    fn squared_distances(x: &[f64], basis: &[f64], out: &mut [f64]) {
        let width = x.len();
        for (row, out) in basis.chunks_exact(width.max(1)).zip(out.iter_mut()) {
            *out = squared_distance(x, row);
        }
    }
}

/// n x n squared distances between the rows of `inputs`.
pub(crate) fn distance_matrix(inputs: &[f64], width: usize) -> Vec<f64> {
    let n = inputs.len() / width.max(1);
    let mut out = vec![0.0; n * n];
    for (x, row) in inputs.chunks_exact(width.max(1)).zip(out.chunks_exact_mut(n.max(1))) {
        squared_distances(x, inputs, row);
    }
    out
}

impl ExactProcess {
    /// The posterior of examples: `inputs` n x `width`, `outputs` n x `outputs_width`. None where the
    /// Gram matrix is singular in double precision (equal inputs, no noise).
    pub fn fit(
        inputs: &[f64],
        width: usize,
        outputs: &[f64],
        outputs_width: usize,
        kernel: &Kernel,
    ) -> Option<ExactProcess> {
        let distances = distance_matrix(inputs, width);
        let n = inputs.len() / width.max(1);
        let factored = Factored::new(&distances, n, kernel)?;
        let covariance = factored.inverse().iter().map(|x| -x).collect();
        Some(ExactProcess { coefficients: factored.solve_all(outputs, outputs_width), covariance })
    }

    /// Mean of the outputs and variance of the process (without noise) at `x`; `inputs` and `kernel` are
    /// those of [`ExactProcess::fit`].
    ///
    /// # Panics
    /// If sizes are not those of the fit.
    pub fn predict(&self, kernel: &Kernel, inputs: &[f64], x: &[f64], mean: &mut [f64]) -> f64 {
        let n = self.covariance.len().isqrt();
        assert_eq!((inputs.len(), self.coefficients.len()), (n * x.len(), n * mean.len()));
        let mut k = vec![0.0; n];
        kernel.covariances(x, inputs, &mut k);
        posterior(kernel, &k, &self.coefficients, &self.covariance, mean)
    }
}

/// The factor of K_y.
struct Factored {
    n: usize,
    factor: Cholesky,
}

impl Factored {
    fn new(distances: &[f64], n: usize, kernel: &Kernel) -> Option<Factored> {
        let mut factor = Cholesky::default();
        factor.reset(n);
        for i in 0..n {
            let row = factor.row_mut(i);
            row.copy_from_slice(&distances[i * n + i..(i + 1) * n]);
            kernel.of_squared_distances(row);
            row[0] += kernel.noise * kernel.noise;
        }
        (factor.factor() == 0).then_some(Factored { n, factor })
    }

    /// K_y^-1 Y for a row-major Y with `width` columns.
    fn solve_all(&self, y: &[f64], width: usize) -> Vec<f64> {
        let mut out = vec![0.0; y.len()];
        let mut column = vec![0.0; self.n];
        for j in 0..width {
            for (c, row) in column.iter_mut().zip(y.chunks_exact(width)) {
                *c = row[j];
            }
            self.factor.solve(&mut column);
            for (c, row) in column.iter().zip(out.chunks_exact_mut(width)) {
                row[j] = *c;
            }
        }
        out
    }

    fn inverse(&self) -> Vec<f64> {
        let n = self.n;
        let mut out = vec![0.0; n * n];
        for (i, row) in out.chunks_exact_mut(n).enumerate() {
            row[i] = 1.0;
            self.factor.solve(row);
        }
        // Rounding makes it a little uneven; what follows takes it for symmetric.
        for i in 0..n {
            for j in 0..i {
                out[j * n + i] = out[i * n + j];
            }
        }
        out
    }
}

/// log p(Y given X) summed over the outputs, and its gradient by (ln l, ln s_f, ln s_n): R&W eq. 5.8
/// and 5.9. Minus infinity where K_y is singular in double precision.
///
/// `inputs`: n x `width`, `outputs`: n x `outputs_width`.
pub fn log_marginal_likelihood(
    inputs: &[f64],
    width: usize,
    outputs: &[f64],
    outputs_width: usize,
    kernel: &Kernel,
) -> (f64, DVec3) {
    let evidence = Evidence::new(inputs, width, outputs, outputs_width);
    evidence.at(kernel)
}

/// Examples whose marginal likelihood is asked for again and again.
pub(crate) struct Evidence<'a> {
    n: usize,
    outputs: &'a [f64],
    outputs_width: usize,
    distances: Vec<f64>,
}

impl<'a> Evidence<'a> {
    pub(crate) fn new(
        inputs: &[f64],
        width: usize,
        outputs: &'a [f64],
        outputs_width: usize,
    ) -> Evidence<'a> {
        let n = inputs.len() / width.max(1);
        Evidence { n, outputs, outputs_width, distances: distance_matrix(inputs, width) }
    }

    /// The n x n squared distances.
    pub(crate) fn distances(&self) -> &[f64] {
        &self.distances
    }

    /// How many numbers are to be explained, n N.
    pub(crate) fn numbers(&self) -> usize {
        self.outputs.len().max(1)
    }

    /// See [`log_marginal_likelihood`].
    pub(crate) fn at(&self, kernel: &Kernel) -> (f64, DVec3) {
        let (n, width) = (self.n, self.outputs_width);
        let Some(factored) = Factored::new(&self.distances, n, kernel) else {
            return (f64::NEG_INFINITY, DVec3::ZERO);
        };
        let alpha = factored.solve_all(self.outputs, width);
        let outputs = width as f64;
        let value = -0.5 * dot(self.outputs, &alpha)
            - 0.5 * outputs * factored.factor.log_determinant()
            - 0.5 * outputs * n as f64 * libm::log(std::f64::consts::TAU);
        // G = (A A^T - N K_y^-1) / 2; the gradient is the sum of G with the derivative of K_y.
        let inverse = factored.inverse();
        let mut gradient = DVec3::ZERO;
        let inverse_square = 1.0 / (kernel.length * kernel.length);
        let mut covariance = vec![0.0; n];
        let mut g = vec![0.0; n];
        for i in 0..n {
            let own = &alpha[i * width..(i + 1) * width];
            for (g, (a, k)) in
                g.iter_mut().zip(alpha.chunks_exact(width).zip(&inverse[i * n..(i + 1) * n]))
            {
                *g = 0.5 * (dot(own, a) - outputs * k);
            }
            let squares = &self.distances[i * n..(i + 1) * n];
            covariance.copy_from_slice(squares);
            kernel.of_squared_distances(&mut covariance);
            for j in 0..n {
                let gk = g[j] * covariance[j];
                gradient[0] += gk * squares[j] * inverse_square;
                gradient[1] += 2.0 * gk;
            }
            gradient[2] += 2.0 * g[i] * kernel.noise * kernel.noise;
        }
        (value, gradient)
    }
}

/// Mean of the N outputs and variance of the process, from the covariances k of an input with the
/// basis: mean = k^T `coefficients`, variance = s_f^2 + k^T `covariance` k.
pub(crate) fn posterior(
    kernel: &Kernel,
    k: &[f64],
    coefficients: &[f64],
    covariance: &[f64],
    mean: &mut [f64],
) -> f64 {
    let (m, width) = (k.len(), mean.len());
    mean.fill(0.0);
    let mut variance = 0.0;
    for i in 0..m {
        axpy(k[i], &coefficients[i * width..(i + 1) * width], mean);
        variance += k[i] * dot(&covariance[i * m..(i + 1) * m], k);
    }
    // Below 0 it is rounding.
    (kernel.signal * kernel.signal + variance).max(0.0)
}
