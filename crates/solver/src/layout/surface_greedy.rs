//! Markers for a surface that they move without shapes: each where the surface of those before is
//! farthest from where it should be (Sorkine & Cohen-Or, "Least-Squares Meshes", 2004, who choose the
//! control points of a mesh so).
//!
//! With K of eq. 2.16 at the vertices that do not rest, a surface whose marked vertices are put somewhere is a
//! sum of columns of K^-1, one for each marker: a marker more costs one solution with K's factor, and an
//! update of what is left of the motion.

use crate::energy::operators::OperatorOptions;
use crate::linear_algebra::dense::{axpy, dot};
use crate::mesh::laplacian::Laplacian;
use crate::mesh::skin_mesh::SkinMesh;
use crate::surface::response::{HELD, SurfaceError, reached, restricted, stiffness_rows};
use crate::surface::sparse_cholesky::{NoFactor, SparseCholesky};

/// A surface that follows the markers chosen so far, and how far that is from its motion.
pub struct SurfaceGreedy {
    factor: SparseCholesky,
    /// The place of each vertex among the unknowns.
    place: Vec<usize>,
    /// For each marker the field that is 1 there and 0 at those before, at the unknowns.
    fields: Vec<(usize, Vec<f64>)>,
    width: usize,
    /// What is left of the motion: vertices x width.
    left: Vec<f64>,
}

impl SurfaceGreedy {
    /// Of a welded mesh whose `held` vertices rest. `motion` has `width` numbers a vertex whose squares add
    /// up to its mean square displacement. Pieces of the skin without a vertex at rest rest as a whole.
    ///
    /// # Errors
    /// [`SurfaceError`] for a mesh that is not usable, or a matrix that is not positive definite.
    ///
    /// # Panics
    /// If sizes disagree.
    pub fn new(
        mesh: &SkinMesh,
        held: &[bool],
        options: &OperatorOptions,
        motion: Vec<f64>,
        width: usize,
    ) -> Result<Self, SurfaceError> {
        mesh.check()?;
        let count = mesh.positions.len();
        assert_eq!((held.len(), motion.len()), (count, count * width), "numbers for each vertex");
        let (edges, masses) =
            Laplacian::symmetric(&mesh.positions, &mesh.triangles, options.laplacian);
        let k = stiffness_rows(&edges, &masses, options.k_s, options.k_b);
        let resting: Vec<usize> = (0..count).filter(|&v| held[v]).collect();
        let hangs = reached(&edges, &resting);
        let mut place = vec![HELD; count];
        let free: Vec<usize> = (0..count).filter(|&v| !held[v] && hangs[v]).collect();
        free.iter().enumerate().for_each(|(unknown, &v)| place[v] = unknown);
        let factor =
            SparseCholesky::new(&restricted(&k, &place, &free)).map_err(|why| match why {
                NoFactor::Pivot(unknown) => SurfaceError::NotDefinite(free[unknown]),
                NoFactor::Memory => SurfaceError::Memory(free.len()),
            })?;
        Ok(Self { factor, place, fields: Vec::new(), width, left: motion })
    }

    /// Mean over the vertices of the square of what the surface leaves of its motion.
    pub fn mean_square(&self) -> f64 {
        let vertices = self.place.len().max(1) as f64;
        dot(&self.left, &self.left) / vertices
    }

    /// What the surface leaves of the motion of a vertex, squared.
    ///
    /// # Panics
    /// If there is no such vertex.
    pub fn square_at(&self, vertex: usize) -> f64 {
        let row = &self.left[vertex * self.width..(vertex + 1) * self.width];
        dot(row, row)
    }

    /// A marker more; false where the vertex rests, or has a marker already.
    ///
    /// # Errors
    /// [`SurfaceError`] where the system cannot be solved.
    ///
    /// # Panics
    /// If there is no such vertex.
    pub fn take(&mut self, vertex: usize) -> Result<bool, SurfaceError> {
        let own = self.place[vertex];
        if own == HELD || self.fields.iter().any(|(other, _)| *other == own) {
            return Ok(false);
        }
        let mut field = vec![0.0; self.place.iter().filter(|p| **p != HELD).count()];
        field[own] = 1.0;
        let size = field.len();
        self.factor.solve(&mut field, 1).map_err(|_| SurfaceError::Memory(size))?;
        for (at, other) in &self.fields {
            axpy(-field[*at], other, &mut field);
        }
        let height = field[own];
        if !(height > 0.0) {
            return Ok(false);
        }
        field.iter_mut().for_each(|x| *x /= height);
        let row = self.left[vertex * self.width..(vertex + 1) * self.width].to_vec();
        let rows = self.left.chunks_exact_mut(self.width.max(1)).zip(&self.place);
        for (left, &place) in rows.filter(|(_, place)| **place != HELD) {
            axpy(-field[place], &row, left);
        }
        self.fields.push((own, field));
        Ok(true)
    }
}
