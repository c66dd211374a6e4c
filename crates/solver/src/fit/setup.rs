//! What a method is set up from, and what it is then solved by.

use crate::energy::operators::OperatorParts;
use crate::gaussian_process::regression::Regression;
use crate::newton::objective::{Objective, Term};
use crate::parameters::table::MethodSpec;
use crate::surface::frame::SurfaceProblem;

/// Bounds of a weight: 0 and 1.
pub(crate) const UNIT_INTERVAL: [f64; 2] = [0.0, 1.0];
/// Bounds of a weight: 0 and none.
pub(crate) const NOT_NEGATIVE: [f64; 2] = [0.0, f64::INFINITY];
/// Bounds of a weight: none.
pub(crate) const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// What a method is set up from: parameters, operators and their scales. Lengths in metres.
#[derive(Debug)]
pub(crate) struct Setup<'a> {
    /// The parameters.
    pub(crate) spec: &'a MethodSpec,
    /// The operators.
    pub(crate) parts: &'a OperatorParts,
    /// H of the shapes that are not locked, n x n, m^2.
    pub(crate) shell: &'a [f64],
    /// The n shapes that are not locked.
    pub(crate) free: &'a [usize],
    /// Their names.
    pub(crate) free_names: Vec<&'a str>,
    /// l^2 of the weighted rows, m^2: a common factor of all importances changes nothing.
    pub(crate) data_scale: f64,
    /// tau, m^2.
    pub(crate) shell_scale: f64,
}

/// Minimise data_weight |Dc - d|^2 / 2 + c^T M c / 2 + linear 1^T c in a box, n weights; the rest is 0 or
/// empty for methods that look at one frame and solve it once.
#[derive(Debug, Clone)]
pub(crate) struct Quadratic {
    pub(crate) data_weight: f64,
    /// M, n x n.
    pub(crate) prior: Vec<f64>,
    pub(crate) linear: f64,
    pub(crate) bounds: Vec<[f64; 2]>,
    /// w of - w c^T c(t-1), c(t-1) the weights of the frame before.
    pub(crate) last_frame: f64,
    /// mu of mu |c(t-1) - 2 c(t) + c(t+1)|^2.
    pub(crate) roughness: f64,
    /// Pairs of which the weaker one is then held at 0, and the rest solved again.
    pub(crate) cancelling: Vec<[usize; 2]>,
}

impl Quadratic {
    /// |Dc - d|^2 and c^T M c alone.
    pub(crate) fn new(data_weight: f64, prior: Vec<f64>, bounds: Vec<[f64; 2]>) -> Quadratic {
        let (linear, last_frame, roughness) = (0.0, 0.0, 0.0);
        Quadratic {
            data_weight,
            prior,
            linear,
            bounds,
            last_frame,
            roughness,
            cancelling: Vec::new(),
        }
    }
}

/// How a method is solved, over its n free shapes.
#[derive(Debug, Clone)]
pub(crate) enum Engine {
    /// A quadratic programme in a box.
    Quadratic(Quadratic),
    /// The same in a box over associated rows, D^T D and D^T d replaced by theirs.
    Linked { bounds: Vec<[f64; 2]> },
    /// Each shape of `order` at its best after those before it.
    Greedy { order: Vec<usize>, bounds: Vec<[f64; 2]> },
    /// Newton; `fallback_eps` smooths the data norm where it vanishes.
    Smooth { objective: Objective, fallback_eps: f64 },
    /// c = D^+ d.
    PseudoInverse,
    /// The surface's markers, one problem per coordinate.
    Surface(SurfaceProblem),
    /// What was learnt, in a box.
    Learnt { model: Box<Regression>, bounds: Vec<[f64; 2]> },
}

impl Engine {
    /// The bounds of the n free weights, where they have some.
    pub(crate) fn bounds(&self) -> Option<&[[f64; 2]]> {
        match self {
            Engine::Quadratic(Quadratic { bounds, .. })
            | Engine::Linked { bounds }
            | Engine::Greedy { bounds, .. }
            | Engine::Learnt { bounds, .. } => Some(bounds),
            Engine::Smooth { objective, .. } => Some(&objective.soft_bounds),
            Engine::PseudoInverse | Engine::Surface(_) => None,
        }
    }
}

impl Setup<'_> {
    /// N, the shapes.
    pub(crate) fn shapes(&self) -> f64 {
        self.parts.shape_names.len() as f64
    }

    /// S, the vertices.
    pub(crate) fn vertices(&self) -> f64 {
        self.parts.vertex_count as f64
    }

    /// l, metres.
    pub(crate) fn length(&self) -> f64 {
        self.data_scale.sqrt()
    }

    /// 1 / l^2.
    pub(crate) fn data_weight(&self) -> f64 {
        1.0 / self.data_scale
    }

    /// (D^T D)_ij of two free shapes, every marker alike, m^2.
    pub(crate) fn product(&self, i: usize, j: usize) -> f64 {
        let rows = self.parts.marker_deltas.chunks_exact(self.parts.shape_names.len());
        rows.fold(0.0, |sum, row| sum + row[self.free[i]] * row[self.free[j]])
    }

    /// The bounds of the free shapes: those that the parameters give, `default` for the others.
    pub(crate) fn bounds(&self, default: [f64; 2]) -> Vec<[f64; 2]> {
        let given = &self.spec.bounds;
        self.free_names.iter().map(|&name| given.get(name).copied().unwrap_or(default)).collect()
    }

    /// Data term, thin shell and soft bounds, minimised by Newton's method.
    pub(crate) fn smooth(&self, data: Term, shell: Term, bounds_weight: f64) -> Engine {
        let soft_bounds = self.bounds(self.spec.soft_bounds());
        let softness = self.spec.s();
        Engine::Smooth {
            objective: Objective::new(data, shell, bounds_weight, soft_bounds, softness),
            fallback_eps: 1e-4 * self.length(),
        }
    }
}
