//! Operators of a layout in microseconds: H of the whole skin is known, and the rows of the marked vertices
//! are taken out of it.

use mimique_clip::with_gaze_at_rest;
use mimique_solver::{
    Fit, Laplacian, MarkerSite, Method, MethodSpec, OperatorOptions, OperatorParts, Operators,
    apply_shell, shell_gram,
};

use crate::error::LayoutError;
use crate::face::Face;

/// A method for an avatar, ready for any markers.
#[derive(Debug, Clone)]
pub struct BankSolver {
    spec: MethodSpec,
    options: OperatorOptions,
    /// H of the skin without any marker, N x N.
    whole: Vec<f64>,
    /// Rows of AB, vertices x 3 x N.
    rows: Vec<f64>,
}

impl BankSolver {
    /// Of a method that solves for the avatar's shapes; the eyes rest as in every solve.
    pub fn new(face: &Face<'_>, spec: &MethodSpec) -> Self {
        let options = OperatorOptions::of(spec);
        let mesh = &face.skin.mesh;
        let n = face.shape_count();
        if spec.method == Method::ThinShellSurface {
            // It has no shapes: a surface is set up for each layout.
            return Self { spec: spec.clone(), options, whole: Vec::new(), rows: Vec::new() };
        }
        let laplacian = Laplacian::new(&mesh.positions, &mesh.triangles, options.laplacian);
        let whole = shell_gram(mesh, &laplacian, options.k_s, options.k_b, &[]);
        let count = mesh.positions.len();
        let mut rows = vec![0.0; count * 3 * n];
        for (k, shape) in mesh.shapes.iter().enumerate() {
            for axis in 0..3 {
                let mut field = vec![0.0; count];
                for (&v, delta) in shape.vertices.iter().zip(&shape.deltas) {
                    field[v as usize] = delta[axis];
                }
                let bent = apply_shell(&laplacian, options.k_s, options.k_b, &field);
                for (v, x) in bent.into_iter().enumerate() {
                    rows[(3 * v + axis) * n + k] = x;
                }
            }
        }
        let spec = with_gaze_at_rest(spec, &face.skin.shape_names);
        Self { spec, options, whole, rows }
    }

    /// The method, with the shapes that rest.
    pub fn spec(&self) -> &MethodSpec {
        &self.spec
    }

    /// D and H of markers at some vertices.
    ///
    /// # Errors
    /// [`LayoutError::Operators`] where the markers see no shape.
    pub fn operators(&self, face: &Face<'_>, markers: &[usize]) -> Result<Operators, LayoutError> {
        let names = &face.skin.shape_names;
        if self.options.association.is_some() {
            let sites: Vec<MarkerSite> =
                markers.iter().map(|&v| MarkerSite::at_vertex(v.to_string(), v)).collect();
            return Ok(Operators::build_at(&face.skin.mesh, names, &sites, &self.options)?);
        }
        let n = face.shape_count();
        let mut shell_gram = self.whole.clone();
        for &v in markers {
            for row in self.rows[v * 3 * n..(v + 1) * 3 * n].chunks_exact(n) {
                for (i, x) in row.iter().enumerate().filter(|(_, x)| **x != 0.0) {
                    let line = &mut shell_gram[i * n..(i + 1) * n];
                    line.iter_mut().zip(row).for_each(|(h, y)| *h -= x * y);
                }
            }
        }
        Ok(Operators::from_parts(OperatorParts {
            options: self.options,
            shape_names: names.clone(),
            marker_labels: markers.iter().map(ToString::to_string).collect(),
            marker_positions: markers.iter().map(|&v| face.place(v)).collect(),
            vertex_count: face.skin.mesh.positions.len(),
            marker_deltas: markers.iter().flat_map(|&v| face.deltas_of(v)).copied().collect(),
            shell_gram,
            associated: None,
            regression: None,
        })?)
    }

    /// The method set up for operators.
    ///
    /// # Errors
    /// [`LayoutError::Fit`] where method and operators do not fit.
    pub fn fit(&self, operators: &Operators) -> Result<Fit, LayoutError> {
        Ok(Fit::new(operators, &self.spec)?)
    }
}
