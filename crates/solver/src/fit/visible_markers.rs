//! What a method computes once for a set of visible markers, and again when markers are lost.

use mimique_geometry::{orthogonal_triangular, pseudo_inverse};

use crate::fit::problem::Problem;
use crate::fit::setup::{Engine, Quadratic};
use crate::linear_algebra::dense::{axpy, gram, packed_len};
use crate::quadratic::least_norm::choose_least_norm;

/// What is computed once for a set of visible markers.
#[derive(Debug, Clone)]
pub(crate) struct VisibleMarkers {
    /// Which markers are missing.
    pub(crate) missing: Vec<bool>,
    /// D, rows of missing markers 0.
    pub(crate) deltas: Vec<f64>,
    /// D^T D.
    pub(crate) gram: Vec<f64>,
    /// Q^T and R of D = Q R (empty but for the smooth methods).
    pub(crate) orthogonal: Vec<f64>,
    pub(crate) triangle: Vec<f64>,
    /// Q of the quadratic programme (empty for the smooth methods and the greedy one), or D^+, or what takes a surface's
    /// markers from where they are seen, or fills lost ones in for the regression.
    pub(crate) system: Vec<f64>,
    /// Whether the shapes depend on each other, so that the least weights are chosen.
    pub(crate) least_norm: bool,
    /// Sum of the importances.
    pub(crate) importance: f64,
}

impl VisibleMarkers {
    pub(crate) fn new(problem: &Problem, missing: Vec<bool>) -> VisibleMarkers {
        let n = problem.free.len();
        let mut deltas = problem.deltas.clone();
        for (rows, &gone) in deltas.chunks_exact_mut(3 * n).zip(&missing) {
            if gone {
                rows.fill(0.0);
            }
        }
        let gram = gram(&deltas, n);
        let mut system = match &problem.engine {
            Engine::Quadratic(Quadratic { data_weight, prior, .. }) => {
                gram.iter().zip(prior).map(|(g, m)| data_weight * g + m).collect()
            }
            Engine::Linked { .. } => linked_system(problem, &missing),
            Engine::PseudoInverse => pseudo_inverse(&deltas, 3 * problem.marker_count, n),
            Engine::Surface(surface) => surface.matrix(&missing, &problem.importance),
            Engine::Learnt { model, .. } => model.fill(&missing),
            Engine::Smooth { .. } | Engine::Greedy { .. } => Vec::new(),
        };
        let least_norm = matches!(problem.engine, Engine::Quadratic(_) | Engine::Linked { .. })
            && choose_least_norm(&mut system, n);
        let (orthogonal, triangle) = match &problem.engine {
            Engine::Smooth { .. } => orthogonal_triangular(&deltas, 3 * problem.marker_count, n),
            _ => (Vec::new(), Vec::new()),
        };
        let importance = (problem.importance.iter().zip(&missing))
            .fold(0.0, |s, (w, &gone)| if gone { s } else { s + w });
        VisibleMarkers {
            missing,
            deltas,
            gram,
            orthogonal,
            triangle,
            system,
            least_norm,
            importance,
        }
    }
}

fn linked_system(problem: &Problem, missing: &[bool]) -> Vec<f64> {
    let n = problem.free.len();
    let mut packed = vec![0.0; packed_len(n)];
    if let Some(associated) = &problem.associated {
        for ((gram, &gone), &importance) in
            associated.grams.chunks_exact(packed.len()).zip(missing).zip(&problem.importance)
        {
            if !gone {
                axpy(importance, gram, &mut packed);
            }
        }
    }
    let mut full = vec![0.0; n * n];
    let mut entries = packed.into_iter();
    for i in 0..n {
        for (j, x) in (i..n).zip(&mut entries) {
            full[i * n + j] = x;
            full[j * n + i] = x;
        }
    }
    full
}
