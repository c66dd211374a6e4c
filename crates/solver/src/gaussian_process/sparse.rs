//! The sparse on-line Gaussian process of Csató & Opper, "Sparse On-Line Gaussian Processes",
//! Neural Computation 14 (2002), 641-668: examples come one after the other, the posterior is kept
//! on a few of them, the basis vectors.
//!
//! | paper | code | size |
//! |---|---|---|
//! | BV set | `basis` | m x D |
//! | alpha, C: mean and covariance of the posterior on the basis | `coefficients`, `covariance` | m x N, m x m |
//! | Q = K_BV^-1 | `inverse_gram` | m x m |
//! | q, r for a Gaussian likelihood | (y - mean) / (variance + s_n^2), -1 / (variance + s_n^2) | |
//! | s = C k + e: e the new vector, or its projection Q k onto the basis | `s` | |
//! | gamma = k(x, x) - k^T Q k: what the basis cannot say of an example | `novelty` | |
//! | score abs(alpha_i) / Q_ii: what the mean would lose with a basis vector | `SparseProcess::least` | |
//!
//! The likelihood of several outputs with one kernel shares C, Q and the basis; alpha and the score
//! are over all of them.

use crate::gaussian_process::exact::{Kernel, posterior};
use crate::linear_algebra::dense::{axpy, dot};

/// An example whose novelty is below this part of the kernel's variance is told by the basis: it
/// changes the posterior on the basis and does not enter it. Smooth takes lie near few dimensions:
/// a smaller one would make Q's condition number that of rounding.
const NOVELTY: f64 = 1e-6;

/// What became of an example.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Learning {
    /// The basis tells it: it changed the posterior alone.
    Projected,
    /// It is the last basis vector now.
    Grown,
    /// It is the last basis vector now, and the one at this place, counted with it, has gone.
    Exchanged(usize),
}

/// A posterior that grows example by example, up to a number of basis vectors.
#[derive(Debug, Clone, PartialEq)]
pub struct SparseProcess {
    kernel: Kernel,
    capacity: usize,
    width: usize,
    outputs_width: usize,
    /// m x D.
    basis: Vec<f64>,
    /// m x N.
    coefficients: Vec<f64>,
    /// m x m.
    covariance: Vec<f64>,
    /// m x m.
    inverse_gram: Vec<f64>,
    /// k, C k and Q k of the last example, the outputs' errors.
    scratch: [Vec<f64>; 4],
}

impl SparseProcess {
    /// An empty one: inputs of `width` numbers, outputs of `outputs_width`, at most `capacity`
    /// basis vectors (at least 1).
    pub fn new(
        kernel: Kernel,
        width: usize,
        outputs_width: usize,
        capacity: usize,
    ) -> SparseProcess {
        SparseProcess {
            kernel,
            capacity: capacity.max(1),
            width,
            outputs_width,
            basis: Vec::new(),
            coefficients: Vec::new(),
            covariance: Vec::new(),
            inverse_gram: Vec::new(),
            scratch: Default::default(),
        }
    }

    /// Number of basis vectors m.
    pub fn len(&self) -> usize {
        self.basis.len() / self.width.max(1)
    }

    /// Whether nothing has been learnt.
    pub fn is_empty(&self) -> bool {
        self.basis.is_empty()
    }

    /// The basis vectors, m x D.
    pub fn basis(&self) -> &[f64] {
        &self.basis
    }

    /// alpha, m x N.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// C, m x m.
    pub fn covariance(&self) -> &[f64] {
        &self.covariance
    }

    /// Q, m x m.
    pub fn inverse_gram(&self) -> &[f64] {
        &self.inverse_gram
    }

    /// Mean of the outputs and variance of the process (without noise) at `x`.
    ///
    /// # Panics
    /// If sizes are not those of [`SparseProcess::new`].
    pub fn predict(&self, x: &[f64], mean: &mut [f64]) -> f64 {
        assert_eq!((x.len(), mean.len()), (self.width, self.outputs_width), "sizes as of new");
        let mut k = vec![0.0; self.len()];
        self.kernel.covariances(x, &self.basis, &mut k);
        posterior(&self.kernel, &k, &self.coefficients, &self.covariance, mean)
    }

    /// One example more.
    ///
    /// # Panics
    /// If sizes are not those of [`SparseProcess::new`].
    pub fn learn(&mut self, x: &[f64], y: &[f64]) -> Learning {
        assert_eq!((x.len(), y.len()), (self.width, self.outputs_width), "sizes as of new");
        let m = self.len();
        let own = self.kernel.signal * self.kernel.signal;
        let [mut k, mut s, mut projected, mut q] = std::mem::take(&mut self.scratch);
        k.resize(m, 0.0);
        s.resize(m, 0.0);
        projected.resize(m, 0.0);
        q.resize(self.outputs_width, 0.0);
        self.kernel.covariances(x, &self.basis, &mut k);
        let variance = posterior(&self.kernel, &k, &self.coefficients, &self.covariance, &mut q);
        let spread = variance + self.kernel.noise * self.kernel.noise;
        for (q, y) in q.iter_mut().zip(y) {
            *q = (y - *q) / spread;
        }
        let r = -1.0 / spread;
        for i in 0..m {
            s[i] = dot(&self.covariance[i * m..(i + 1) * m], &k);
            projected[i] = dot(&self.inverse_gram[i * m..(i + 1) * m], &k);
        }
        let novelty = own - dot(&k, &projected);
        let learning = if novelty < NOVELTY * own {
            // The example is projected onto the basis; eta corrects for what that leaves out.
            let eta = 1.0 / (1.0 + novelty.max(0.0) * r);
            for (s, e) in s.iter_mut().zip(&projected) {
                *s += e;
            }
            q.iter_mut().for_each(|q| *q *= eta);
            self.update(&s, &q, eta * r);
            Learning::Projected
        } else {
            self.grow(x, novelty, &projected);
            s.push(1.0);
            self.update(&s, &q, r);
            if self.len() > self.capacity {
                let least = self.least();
                self.remove(least);
                Learning::Exchanged(least)
            } else {
                Learning::Grown
            }
        };
        self.scratch = [k, s, projected, q];
        learning
    }

    /// alpha += s q, C += r s s^T.
    fn update(&mut self, s: &[f64], q: &[f64], r: f64) {
        let m = s.len();
        for (i, &si) in s.iter().enumerate() {
            axpy(si, q, &mut self.coefficients[i * self.outputs_width..][..self.outputs_width]);
            axpy(r * si, s, &mut self.covariance[i * m..(i + 1) * m]);
        }
    }

    /// The example becomes a basis vector, its row of alpha and C still 0; Q by the
    /// inverse of a bordered matrix.
    fn grow(&mut self, x: &[f64], novelty: f64, projected: &[f64]) {
        let m = self.len();
        self.basis.extend_from_slice(x);
        self.coefficients.resize((m + 1) * self.outputs_width, 0.0);
        self.covariance = widened(&self.covariance, m);
        self.inverse_gram = widened(&self.inverse_gram, m);
        let mut e = projected.to_vec();
        e.push(-1.0);
        for (i, &ei) in e.iter().enumerate() {
            axpy(ei / novelty, &e, &mut self.inverse_gram[i * (m + 1)..(i + 1) * (m + 1)]);
        }
    }

    /// The basis vector with the smallest score: the one the mean would miss least.
    fn least(&self) -> usize {
        let m = self.len();
        let score = |i: usize| {
            let alpha = &self.coefficients[i * self.outputs_width..(i + 1) * self.outputs_width];
            dot(alpha, alpha).sqrt() / self.inverse_gram[i * m + i]
        };
        let mut least = (0, score(0));
        for i in 1..m {
            let here = score(i);
            if here < least.1 {
                least = (i, here);
            }
        }
        least.0
    }

    /// Takes basis vector `out` away, its part projected onto the others.
    fn remove(&mut self, out: usize) {
        let (m, width) = (self.len(), self.outputs_width);
        let q_own = self.inverse_gram[out * m + out];
        let c_own = self.covariance[out * m + out];
        let q_row: Vec<f64> = self.inverse_gram[out * m..(out + 1) * m].to_vec();
        let c_row: Vec<f64> = self.covariance[out * m..(out + 1) * m].to_vec();
        let alpha: Vec<f64> = self.coefficients[out * width..(out + 1) * width].to_vec();
        for i in 0..m {
            let part = q_row[i] / q_own;
            axpy(-part, &alpha, &mut self.coefficients[i * width..(i + 1) * width]);
            let c = &mut self.covariance[i * m..(i + 1) * m];
            let q = &mut self.inverse_gram[i * m..(i + 1) * m];
            for j in 0..m {
                let other = q_row[j] / q_own;
                c[j] += c_own * part * other - (part * c_row[j] + c_row[i] * other);
                q[j] -= part * q_row[j];
            }
        }
        self.basis.drain(out * self.width..(out + 1) * self.width);
        self.coefficients.drain(out * width..(out + 1) * width);
        self.covariance = narrowed(&self.covariance, m, out);
        self.inverse_gram = narrowed(&self.inverse_gram, m, out);
    }
}

/// An m x m matrix with a row and a column of zeros more.
fn widened(matrix: &[f64], m: usize) -> Vec<f64> {
    let mut out = vec![0.0; (m + 1) * (m + 1)];
    for i in 0..m {
        out[i * (m + 1)..i * (m + 1) + m].copy_from_slice(&matrix[i * m..(i + 1) * m]);
    }
    out
}

/// An m x m matrix without row and column `out`.
fn narrowed(matrix: &[f64], m: usize, out: usize) -> Vec<f64> {
    (0..m * m).filter(|at| at / m != out && at % m != out).map(|at| matrix[at]).collect()
}
