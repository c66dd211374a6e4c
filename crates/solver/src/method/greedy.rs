//! `greedy`: one shape after the other (Seol et al., "Artist friendly facial animation retargeting", 2011).
//!
//! The shapes in the order of their size, the largest first: each takes the weight within 0 and 1 that
//! leaves least of what those before it left, and none is looked at again:
//!
//! c_k = clamp(D_k^T r / |D_k|^2), then r := r - c_k D_k, from r = d.
//!
//! It minimises nothing as a whole: its KKT error is that of each step by itself, 0.

use super::definition::{Defaults, Definition, Needs};
use crate::fit::problem::FitError;
use crate::fit::setup::{Engine, Setup, UNIT_INTERVAL};
use crate::fit::visible_markers::VisibleMarkers;
use crate::parameters::group::Group;
use crate::quadratic::box_qp::Outcome;

/// Largest shape first.
pub(crate) const GREEDY: Definition = Definition {
    summary: "squared marker error by one shape after the other, the largest first, within 0 and 1",
    needs: Needs::Shapes,
    uses: &[Group::Bounds, Group::Shapes, Group::Markers, Group::FrontEnd, Group::Frames],
    defaults: Defaults::USUAL,
    engine: greedy,
};

/// The order: by |D_k|^2 over all markers, seen or not; equal ones as in the bank.
fn greedy(setup: &Setup<'_>) -> Result<Engine, FitError> {
    let bounds = setup.bounds(UNIT_INTERVAL);
    let mut left: Vec<usize> = (0..bounds.len()).collect();
    let mut order = Vec::with_capacity(left.len());
    let size: Vec<f64> = left.iter().map(|&k| setup.product(k, k)).collect();
    while !left.is_empty() {
        let largest = (1..left.len())
            .fold(0, |best, at| if size[left[at]] > size[left[best]] { at } else { best });
        order.push(left.remove(largest));
    }
    Ok(Engine::Greedy { order, bounds })
}

/// The weights `c` for displacements whose rows carry the roots of their importances; `left` is what
/// no shape explains.
pub(crate) fn one_after_the_other(
    order: &[usize],
    bounds: &[[f64; 2]],
    visible: &VisibleMarkers,
    d: &[f64],
    left: &mut Vec<f64>,
    c: &mut [f64],
) -> Outcome {
    let n = c.len();
    left.clear();
    left.extend_from_slice(d);
    for &k in order {
        let column = || visible.deltas[k..].iter().step_by(n);
        let along = column().zip(&*left).fold(0.0, |sum, (x, r)| sum + x * r);
        let own = visible.gram[k * n + k];
        let best = if own > 0.0 { along / own } else { 0.0 };
        c[k] = best.clamp(bounds[k][0], bounds[k][1]);
        for (r, x) in left.iter_mut().zip(column()) {
            *r -= c[k] * x;
        }
    }
    let converged = c.iter().chain(&*left).all(|x| x.is_finite());
    Outcome { iterations: 1, kkt_error: if converged { 0.0 } else { f64::INFINITY }, converged }
}
