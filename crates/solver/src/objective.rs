//! The smooth energies of the methods with soft bounds, with gradient and Hessian.

use crate::dense::{axpy, dot, mul, mul_transposed};

/// A term x -> w x^2 or w sqrt(x^2 + eps^2), of x^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Term {
    /// Not there.
    Absent,
    /// w x^2.
    Squared { weight: f64 },
    /// w sqrt(x^2 + eps^2), less the constant.
    Norm { weight: f64, eps: f64 },
}

/// E(c) = data(|Dc - d|) + shell(sqrt(c^T H c)) + w_b E_b(c); E_b is eq. 5.24.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Objective {
    pub(crate) data: Term,
    pub(crate) shell: Term,
    pub(crate) bounds_weight: f64,
    /// l_inf and l_sup of each shape.
    pub(crate) soft_bounds: Vec<[f64; 2]>,
    /// s of eq. 5.24.
    pub(crate) softness: f64,
}

/// The matrices that an objective is evaluated with; rows of lost markers are 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Matrices<'a> {
    /// 3P x n.
    pub(crate) deltas: &'a [f64],
    /// D^T D, n x n.
    pub(crate) gram: &'a [f64],
    /// H, n x n.
    pub(crate) shell: &'a [f64],
}

/// What an evaluation leaves behind.
#[derive(Debug, Clone, Default)]
pub(crate) struct Evaluation {
    /// Dc - d.
    pub(crate) residual: Vec<f64>,
    /// |Dc - d|^2.
    pub(crate) misfit: f64,
    /// D^T (Dc - d).
    pub(crate) data_slope: Vec<f64>,
    /// H c.
    pub(crate) shell_slope: Vec<f64>,
    pub(crate) shell_energy: f64,
    /// E_b' and E_b'' of each weight, times w_b.
    pub(crate) bound_slope: Vec<f64>,
    pub(crate) bound_curvature: Vec<f64>,
    pub(crate) gradient: Vec<f64>,
    pub(crate) value: f64,
}

impl Term {
    fn value(self, square: f64) -> f64 {
        match self {
            Term::Absent => 0.0,
            Term::Squared { weight } => weight * square,
            Term::Norm { weight, eps } => weight * (square + eps * eps).sqrt(),
        }
    }

    /// (a, b): for x^2 = y^T M y with M y = v, the gradient is a v and the Hessian a M - b v v^T.
    fn slopes(self, square: f64) -> (f64, f64) {
        match self {
            Term::Absent => (0.0, 0.0),
            Term::Squared { weight } => (2.0 * weight, 0.0),
            Term::Norm { weight, eps } => {
                let norm = (square + eps * eps).sqrt();
                let a = weight / norm;
                (a, a / (norm * norm))
            }
        }
    }
}

impl Objective {
    /// Value and gradient at c.
    pub(crate) fn evaluate(&self, m: Matrices<'_>, d: &[f64], c: &[f64], e: &mut Evaluation) {
        let n = c.len();
        e.residual.resize(d.len(), 0.0);
        mul(m.deltas, c, &mut e.residual);
        for (r, d) in e.residual.iter_mut().zip(d) {
            *r -= d;
        }
        e.misfit = dot(&e.residual, &e.residual);
        e.data_slope.resize(n, 0.0);
        mul_transposed(m.deltas, &e.residual, &mut e.data_slope);
        e.shell_slope.resize(n, 0.0);
        mul(m.shell, c, &mut e.shell_slope);
        // Rounding may leave a vanishing energy below 0.
        e.shell_energy = dot(&e.shell_slope, c).max(0.0);
        e.bound_slope.resize(n, 0.0);
        e.bound_curvature.resize(n, 0.0);
        let mut bound_energy = 0.0;
        let rate = 1.0 / self.softness;
        let slope = self.bounds_weight * rate;
        let curvature = slope * rate;
        for i in 0..n {
            let [lo, hi] = self.soft_bounds[i];
            let below = libm::exp((lo - c[i]) * rate);
            let above = libm::exp((c[i] - hi) * rate);
            bound_energy += below + above;
            e.bound_slope[i] = slope * (above - below);
            e.bound_curvature[i] = curvature * (above + below);
        }
        e.value = self.data.value(e.misfit)
            + self.shell.value(e.shell_energy)
            + self.bounds_weight * bound_energy;
        let (data, _) = self.data.slopes(e.misfit);
        let (shell, _) = self.shell.slopes(e.shell_energy);
        e.gradient.clear();
        e.gradient.extend_from_slice(&e.bound_slope);
        axpy(data, &e.data_slope, &mut e.gradient);
        axpy(shell, &e.shell_slope, &mut e.gradient);
    }

    /// Entries i.. of row i of the Hessian, at the point of `e`.
    ///
    /// With `majorised` the negative rank-one parts of the norms are left out: a quadratic that lies
    /// above the norms everywhere, so that its step descends from anywhere.
    pub(crate) fn hessian_row(
        &self,
        m: Matrices<'_>,
        e: &Evaluation,
        majorised: bool,
        i: usize,
        row: &mut [f64],
    ) {
        let n = e.gradient.len();
        let (a, mut b) = self.data.slopes(e.misfit);
        let (f, mut g) = self.shell.slopes(e.shell_energy);
        if majorised {
            (b, g) = (0.0, 0.0);
        }
        let gram = &m.gram[i * n + i..(i + 1) * n];
        let shell = &m.shell[i * n + i..(i + 1) * n];
        for ((out, x), y) in row.iter_mut().zip(gram).zip(shell) {
            *out = a * x + f * y;
        }
        if b != 0.0 {
            axpy(-b * e.data_slope[i], &e.data_slope[i..], row);
        }
        if g != 0.0 {
            axpy(-g * e.shell_slope[i], &e.shell_slope[i..], row);
        }
        row[0] += e.bound_curvature[i];
    }
}
