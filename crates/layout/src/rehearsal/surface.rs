//! The surface moved by its markers alone, without shapes, held against what was played.

use mimique_solver::{
    Fit, METRES_PER_WEIGHT, MarkerSite, MethodSpec, OperatorOptions, SurfaceResponse,
};

use super::VertexGroup;
use crate::error::LayoutError;
use crate::face::Face;
use crate::motion::Basis;

/// A vertex that no shape moves by more is at rest, metres.
const UNMOVED_M: f64 = 1e-4;

/// A surface that follows some markers.
pub(super) struct SurfaceSolver {
    fit: Fit,
    fields: Vec<f64>,
    markers: usize,
}

/// What the errors of a group of vertices need of a surface.
pub(super) struct SurfaceGroup {
    /// Mean over the vertices of the products of the markers' fields, P x P.
    fields: Vec<f64>,
    /// Mean of the products of fields and basis for each axis, 3 x P x width.
    crossed: Vec<f64>,
    /// The same of the basis with itself, width x width, all axes.
    basis: Vec<f64>,
}

impl SurfaceSolver {
    /// Of markers at some vertices.
    pub(super) fn new(
        face: &Face<'_>,
        spec: &MethodSpec,
        markers: &[usize],
    ) -> Result<Self, LayoutError> {
        let mesh = &face.skin.mesh;
        let options = OperatorOptions::of(spec);
        let held = mesh.unmoved(UNMOVED_M);
        let surface = SurfaceResponse::build(mesh, markers, &held, &options)?;
        let sites: Vec<MarkerSite> =
            markers.iter().map(|&v| MarkerSite::at_vertex(v.to_string(), v)).collect();
        let operators = surface.operators(mesh, &sites, &options)?;
        let fit = Fit::new(&operators, spec)?;
        Ok(Self { fit, fields: surface.fields, markers: markers.len() })
    }

    /// Where the markers of the surface are, frames x 3P, metres.
    pub(super) fn solve(&self, displacements: &[f64]) -> Result<Vec<f64>, LayoutError> {
        let mut moved = self.fit.solve_take(displacements)?.weights;
        moved.iter_mut().for_each(|x| *x *= METRES_PER_WEIGHT);
        Ok(moved)
    }

    /// The products of a group.
    pub(super) fn group(&self, basis: &Basis, group: &VertexGroup) -> SurfaceGroup {
        let (p, w) = (self.markers, basis.width);
        let share = 1.0 / group.vertices.len().max(1) as f64;
        let mut out = SurfaceGroup {
            fields: vec![0.0; p * p],
            crossed: vec![0.0; 3 * p * w],
            basis: group.gram.clone(),
        };
        for &v in &group.vertices {
            let field = &self.fields[v * p..(v + 1) * p];
            let rows = basis.of(v);
            for (i, &x) in field.iter().enumerate().filter(|(_, x)| **x != 0.0) {
                let line = &mut out.fields[i * p..(i + 1) * p];
                line.iter_mut().zip(field).for_each(|(s, y)| *s += share * x * y);
                for axis in 0..3 {
                    let line = &mut out.crossed[(axis * p + i) * w..][..w];
                    let row = &rows[axis * w..(axis + 1) * w];
                    line.iter_mut().zip(row).for_each(|(s, y)| *s += share * x * y);
                }
            }
        }
        out
    }
}

impl SurfaceGroup {
    /// Mean square distance between the surface with its markers at `moved` (3P) and what was played.
    pub(super) fn square_error(&self, moved: &[f64], played: &[f64]) -> f64 {
        let (p, w) = (moved.len() / 3, played.len());
        let mut sum = quadratic(&self.basis, played, played);
        for axis in 0..3 {
            let y: Vec<f64> = moved.iter().skip(axis).step_by(3).copied().collect();
            sum += quadratic(&self.fields, &y, &y);
            sum -= 2.0 * quadratic(&self.crossed[axis * p * w..(axis + 1) * p * w], &y, played);
        }
        sum.max(0.0)
    }
}

/// x^T M y of a row-major M.
fn quadratic(m: &[f64], x: &[f64], y: &[f64]) -> f64 {
    let rows = m.chunks_exact(y.len().max(1));
    rows.zip(x).map(|(row, x)| x * row.iter().zip(y).map(|(m, y)| m * y).sum::<f64>()).sum()
}
