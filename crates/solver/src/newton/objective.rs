//! The smooth energies of the methods with soft bounds, with gradient and Hessian.

use crate::linear_algebra::cholesky::Cholesky;
use crate::linear_algebra::dense::{axpy, dot, mul, mul_triangle, mul_triangle_transposed, widest};
use crate::linear_algebra::exp::exp_all;

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
    /// exp((l_inf - l_sup) / s) of each shape.
    pub(crate) bound_products: Vec<f64>,
}

/// The matrices that an objective is evaluated with.
///
/// With D = Q R, |Dc - d|^2 = |Rc - Q^T d|^2 + |d - Q Q^T d|^2: a triangle of n x n numbers instead
/// of 3P x n for every evaluation, without the cancellation that c^T D^T D c - 2 c^T D^T d + d^T d
/// suffers where the markers are met.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Matrices<'a> {
    /// R: at most n rows, n columns.
    pub(crate) triangle: &'a [f64],
    /// D^T D, n x n.
    pub(crate) gram: &'a [f64],
    /// H, n x n.
    pub(crate) shell: &'a [f64],
}

/// What the shapes should meet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Target<'a> {
    /// Q^T d, one number per row of R.
    pub(crate) inside: &'a [f64],
    /// |d - Q Q^T d|^2: what no weights can meet.
    pub(crate) outside: f64,
}

/// What an evaluation leaves behind.
#[derive(Debug, Clone, Default)]
pub(crate) struct Evaluation {
    /// Rc - Q^T d.
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
    pub(crate) fn new(
        data: Term,
        shell: Term,
        bounds_weight: f64,
        soft_bounds: Vec<[f64; 2]>,
        softness: f64,
    ) -> Objective {
        let mut bound_products: Vec<f64> =
            soft_bounds.iter().map(|[lo, hi]| (lo - hi) / softness).collect();
        exp_all(&mut bound_products);
        Objective { data, shell, bounds_weight, soft_bounds, softness, bound_products }
    }

    /// Value and gradient at c.
    pub(crate) fn evaluate(
        &self,
        m: Matrices<'_>,
        target: Target<'_>,
        c: &[f64],
        e: &mut Evaluation,
    ) {
        let n = c.len();
        e.residual.resize(target.inside.len(), 0.0);
        mul_triangle(m.triangle, c, &mut e.residual);
        for (r, d) in e.residual.iter_mut().zip(target.inside) {
            *r -= d;
        }
        e.misfit = dot(&e.residual, &e.residual) + target.outside;
        e.data_slope.resize(n, 0.0);
        mul_triangle_transposed(m.triangle, &e.residual, &mut e.data_slope);
        e.shell_slope.resize(n, 0.0);
        mul(m.shell, c, &mut e.shell_slope);
        // Rounding may leave a vanishing energy below 0.
        e.shell_energy = dot(&e.shell_slope, c).max(0.0);
        e.bound_slope.resize(n, 0.0);
        e.bound_curvature.resize(n, 0.0);
        let rate = 1.0 / self.softness;
        let slope = self.bounds_weight * rate;
        let curvature = slope * rate;
        for ((x, c), [lo, _]) in e.bound_slope.iter_mut().zip(c).zip(&self.soft_bounds) {
            *x = (lo - c) * rate;
        }
        exp_all(&mut e.bound_slope);
        let mut bound_energy = 0.0;
        for i in 0..n {
            // exp((c - hi) / s) = exp((lo - hi) / s) / exp((lo - c) / s).
            let below = e.bound_slope[i];
            let above = self.bound_products[i] / below;
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

    /// The upper triangle of the Hessian at the point of `e`.
    ///
    /// With `majorised` the negative rank-one parts of the norms are left out: a quadratic that lies
    /// above the norms everywhere, so that its step descends from anywhere.
    pub(crate) fn hessian(
        &self,
        m: Matrices<'_>,
        e: &Evaluation,
        majorised: bool,
        out: &mut Cholesky,
    ) {
        let n = e.gradient.len();
        let (data, mut data_bend) = self.data.slopes(e.misfit);
        let (shell, mut shell_bend) = self.shell.slopes(e.shell_energy);
        if majorised {
            (data_bend, shell_bend) = (0.0, 0.0);
        }
        out.reset(n);
        for i in 0..n {
            let parts = [
                (data, &m.gram[i * n + i..(i + 1) * n]),
                (shell, &m.shell[i * n + i..(i + 1) * n]),
                (-data_bend * e.data_slope[i], &e.data_slope[i..]),
                (-shell_bend * e.shell_slope[i], &e.shell_slope[i..]),
            ];
            let row = out.row_mut(i);
            combine(parts, row);
            row[0] += e.bound_curvature[i];
        }
    }
}

widest! {
    /// out = sum of the rows times their factors, in order.
    fn combine(parts: [(f64, &[f64]); 4], out: &mut [f64]) {
        let n = out.len();
        let [(a, x), (b, y), (c, z), (d, w)] = parts;
        let (x, y, z, w) = (&x[..n], &y[..n], &z[..n], &w[..n]);
        for j in 0..n {
            out[j] = ((a * x[j] + b * y[j]) + c * z[j]) + d * w[j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: usize = 4;

    /// 6 rows of D and a positive H, made of cosines.
    fn matrices() -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let deltas: Vec<f64> = (0..6 * N).map(|i| (1.7 * i as f64).cos()).collect();
        let roots: Vec<f64> = (0..5 * N).map(|i| (0.9 * i as f64 + 1.0).cos()).collect();
        let (_, triangle) = mimique_geometry::orthogonal_triangular(&deltas, 6, N);
        (
            crate::linear_algebra::dense::gram(&deltas, N),
            crate::linear_algebra::dense::gram(&roots, N),
            triangle,
        )
    }

    fn objectives() -> Vec<Objective> {
        let terms = |weight, eps| [Term::Squared { weight }, Term::Norm { weight, eps }];
        (terms(1.3, 0.02).into_iter())
            .flat_map(|data| {
                [Term::Absent].into_iter().chain(terms(0.4, 0.1)).map(move |shell| {
                    let soft = vec![[-0.1, 1.1], [-0.1, 1.1], [0.2, 0.6], [-0.5, 1.0]];
                    Objective::new(data, shell, 0.3, soft, 0.1)
                })
            })
            .collect()
    }

    #[test]
    fn gradient_and_hessian_are_the_differences_of_value_and_gradient() {
        let (gram, shell, triangle) = matrices();
        let m = Matrices { triangle: &triangle, gram: &gram, shell: &shell };
        let d = Target { inside: &[0.3, -0.2, 0.5, 0.9], outside: 0.01 };
        let c = [0.4, 1.05, 0.1, -0.2];
        let step = 1e-5;
        for objective in objectives() {
            let at = |k: usize, h: f64| {
                let mut there = c;
                there[k] += h;
                let mut e = Evaluation::default();
                objective.evaluate(m, d, &there, &mut e);
                e
            };
            let here = at(0, 0.0);
            for k in 0..N {
                let (up, down) = (at(k, step), at(k, -step));
                let slope = (up.value - down.value) / (2.0 * step);
                assert!((slope - here.gradient[k]).abs() < 1e-7, "{objective:?}");
                let mut hessian = Cholesky::default();
                objective.hessian(m, &here, false, &mut hessian);
                for i in k..N {
                    let curvature = (up.gradient[i] - down.gradient[i]) / (2.0 * step);
                    let entry = hessian.row_mut(k)[i - k];
                    assert!((curvature - entry).abs() < 1e-6, "{objective:?}");
                }
            }
        }
    }

    #[test]
    fn majorised_quadratic_lies_above() {
        let (gram, shell, triangle) = matrices();
        let m = Matrices { triangle: &triangle, gram: &gram, shell: &shell };
        let d = Target { inside: &[0.3, -0.2, 0.5, 0.9], outside: 0.01 };
        for mut objective in objectives() {
            // The bounds are not majorised.
            objective.bounds_weight = 0.0;
            let (mut here, mut there) = (Evaluation::default(), Evaluation::default());
            let c = [0.4, 1.05, 0.1, -0.2];
            objective.evaluate(m, d, &c, &mut here);
            let mut hessian = Cholesky::default();
            objective.hessian(m, &here, true, &mut hessian);
            for k in 0..40 {
                let p: [f64; N] = std::array::from_fn(|i| 3.0 * (k as f64 + 2.0 * i as f64).sin());
                let moved: [f64; N] = std::array::from_fn(|i| c[i] + p[i]);
                objective.evaluate(m, d, &moved, &mut there);
                let mut model = here.value;
                for i in 0..N {
                    model += here.gradient[i] * p[i];
                    let row = hessian.row_mut(i);
                    model += 0.5 * row[0] * p[i] * p[i];
                    model += (i + 1..N).map(|j| row[j - i] * p[i] * p[j]).sum::<f64>();
                }
                assert!(there.value <= model + 1e-12);
            }
        }
    }
}
