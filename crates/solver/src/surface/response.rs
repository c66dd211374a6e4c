//! The surface itself moved by its markers, without blendshapes (thesis 2.3.4, eq. 2.15-2.17).
//!
//! The displacement d of a thin shell whose marked vertices are put somewhere satisfies eq. 2.16,
//! (-k_s L* + k_b L* M^-1 L*) d = 0, at every other vertex: it minimises d^T K d, K the matrix in
//! brackets. The three coordinates do not meet, and d is linear in where the markers go:
//!
//! | paper | code | size |
//! |---|---|---|
//! | L*, M (2.3.4) | [`Laplacian::symmetric`] | S x S, S |
//! | a, b of eq. 2.17 | K at the free vertices, and minus its columns of the markers | sparse |
//! | d* for marker m moved by 1 | [`SurfaceResponse::fields`], column m | S x P |
//! | energy of the whole surface, given its markers | [`SurfaceResponse::stiffness`] | P x P |
//!
//! The second is the Schur complement of K: with it a frame is a problem of P unknowns, whatever S
//! is, and lost markers and soft constraints have the answers that the whole surface would give.
//! All of this runs where packs are prepared, and browsers get the result.

use mimique_geometry::Displacement;

use crate::energy::operators::{OperatorError, OperatorOptions, OperatorParts, Operators};
use crate::mesh::laplacian::Laplacian;
use crate::mesh::marker_site::MarkerSite;
use crate::mesh::skin_mesh::{MeshError, SkinMesh};
use crate::surface::frame::METRES_PER_WEIGHT;
use crate::surface::sparse_cholesky::{NoFactor, SparseCholesky, SymmetricRows};

/// How a surface follows its markers.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceResponse {
    /// S x P, vertex-major: how far vertex i goes when marker m goes by 1, the other markers and
    /// the held vertices stay, and the energy is least. Without a unit; the same for x, y and z.
    pub fields: Vec<f64>,
    /// P x P: with the markers at y (one coordinate), the energy of the surface is y^T K y.
    pub stiffness: Vec<f64>,
    /// Largest entry of K d at the free vertices for any of the fields, in units of displacement
    /// (divided by the row's diagonal): 0 but for rounding.
    pub residual: f64,
    /// Vertices of pieces of the skin that have no marker: they rest.
    pub without_marker: usize,
}

/// Why a surface has no response.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// The mesh is not usable.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A marker's vertex is not in the mesh.
    #[error("marker vertex {vertex} of {count}; correct the marker map")]
    MarkerVertex {
        /// The vertex.
        vertex: usize,
        /// How many there are.
        count: usize,
    },
    /// There is no marker.
    #[error("no marker on the skin; map at least one")]
    NoMarker,
    /// The matrix of eq. 2.17 is not positive definite.
    #[error(
        "thin shell: its matrix is not positive definite (vertex {0}); take the uniform, \
         umbrella or cotan-clamped Laplacian, or repair the mesh's degenerate triangles"
    )]
    NotDefinite(usize),
    /// The factor does not fit into memory.
    #[error("thin shell: the factor of {0} vertices does not fit into memory; take a coarser skin")]
    Memory(usize),
}

/// The place among the unknowns of a vertex that is marked.
const MARKER: usize = usize::MAX - 1;
/// The place among the unknowns of a vertex that rests.
pub(crate) const HELD: usize = usize::MAX;

impl SurfaceResponse {
    /// The response of a welded mesh to markers at `markers` (vertices, each once), with the
    /// vertices of `held` at rest. A vertex that is marked and held is marked.
    ///
    /// Pieces of the skin without a marker rest. Costs one sparse factor and P solutions with it.
    ///
    /// # Errors
    /// [`SurfaceError`] for a mesh or marker that does not fit, or a matrix that is not positive
    /// definite (negative cotangent weights).
    ///
    /// # Panics
    /// If `held` does not have one entry per vertex.
    pub fn build(
        mesh: &SkinMesh,
        markers: &[usize],
        held: &[bool],
        options: &OperatorOptions,
    ) -> Result<SurfaceResponse, SurfaceError> {
        mesh.check()?;
        let count = mesh.positions.len();
        assert_eq!(held.len(), count, "held has one entry per vertex");
        if markers.is_empty() {
            return Err(SurfaceError::NoMarker);
        }
        if let Some(&vertex) = markers.iter().find(|&&v| v >= count) {
            return Err(SurfaceError::MarkerVertex { vertex, count });
        }
        let (edges, masses) =
            Laplacian::symmetric(&mesh.positions, &mesh.triangles, options.laplacian);
        let k = stiffness_rows(&edges, &masses, options.k_s, options.k_b);

        // Where each vertex stands among the unknowns.
        let reached = reached(&edges, markers);
        let mut place = vec![HELD; count];
        markers.iter().for_each(|&v| place[v] = MARKER);
        let mut free = Vec::new();
        for v in 0..count {
            if place[v] != MARKER && !held[v] && reached[v] {
                place[v] = free.len();
                free.push(v);
            }
        }
        let p = markers.len();
        let mut right = vec![0.0; free.len() * p];
        for (m, &v) in markers.iter().enumerate() {
            // Eq. 2.17: the columns of known vertices go to the right. K is symmetric.
            for (j, x) in k.row(v) {
                if place[j] < MARKER {
                    right[place[j] * p + m] = -x;
                }
            }
        }
        let among_free = restricted(&k, &place, &free);
        SparseCholesky::new(&among_free).and_then(|factor| factor.solve(&mut right, p)).map_err(
            |why| match why {
                NoFactor::Pivot(unknown) => SurfaceError::NotDefinite(free[unknown]),
                NoFactor::Memory => SurfaceError::Memory(free.len()),
            },
        )?;

        let mut fields = vec![0.0; count * p];
        for (m, &v) in markers.iter().enumerate() {
            fields[v * p + m] = 1.0;
        }
        for (row, &v) in right.chunks_exact(p).zip(&free) {
            fields[v * p..(v + 1) * p].copy_from_slice(row);
        }
        let (stiffness, residual) = reduced(&k, &fields, markers, &free);
        let without_marker = reached.iter().filter(|reached| !**reached).count();
        Ok(SurfaceResponse { fields, stiffness, residual, without_marker })
    }

    /// The operators of the surface: 3P "shapes" LABEL.x, LABEL.y, LABEL.z, each of them a marker
    /// moved along an axis by [`METRES_PER_WEIGHT`] at weight 1. D is diagonal, H the stiffness on
    /// each axis.
    ///
    /// # Errors
    /// [`OperatorError`] where `markers`, each at its own vertex, are not those of [`Self::build`].
    pub fn operators(
        &self,
        mesh: &SkinMesh,
        markers: &[MarkerSite],
        options: &OperatorOptions,
    ) -> Result<Operators, OperatorError> {
        let p = markers.len();
        let n = 3 * p;
        let mut marker_deltas = vec![0.0; n * n];
        let mut shell_gram = vec![0.0; n * n];
        if self.stiffness.len() == p * p {
            for i in 0..n {
                marker_deltas[i * n + i] = METRES_PER_WEIGHT;
                for j in (0..n).filter(|j| j % 3 == i % 3) {
                    shell_gram[i * n + j] =
                        METRES_PER_WEIGHT * METRES_PER_WEIGHT * self.stiffness[(i / 3) * p + j / 3];
                }
            }
        }
        Operators::from_parts(OperatorParts {
            options: OperatorOptions { association: None, ..*options },
            shape_names: surface_shape_names(markers.iter().map(|site| site.label.as_str())),
            marker_labels: markers.iter().map(|site| site.label.clone()).collect(),
            marker_positions: markers.iter().map(|site| mesh.positions[site.vertex()]).collect(),
            vertex_count: mesh.positions.len(),
            marker_deltas,
            shell_gram,
            associated: None,
            regression: None,
        })
    }

    /// How far each vertex goes at the 3P weights of a frame, metres.
    ///
    /// # Panics
    /// If `weights` are not 3P.
    pub fn displacements(&self, weights: &[f64]) -> Vec<Displacement> {
        let p = weights.len() / 3;
        self.fields
            .chunks_exact(p.max(1))
            .map(|row| {
                let mut d = Displacement::ZERO;
                for (field, weight) in row.iter().zip(weights.chunks_exact(3)) {
                    d += *field * Displacement::new(weight[0], weight[1], weight[2]);
                }
                d * METRES_PER_WEIGHT
            })
            .collect()
    }
}

/// Names of the 3P "shapes" of a surface: LABEL.x, LABEL.y, LABEL.z.
pub fn surface_shape_names<'l>(labels: impl Iterator<Item = &'l str>) -> Vec<String> {
    labels.flat_map(|label| ["x", "y", "z"].map(|axis| format!("{label}.{axis}"))).collect()
}

/// K = -k_s L* + k_b L* M^-1 L* of eq. 2.16, a vertex and its two rings in each row.
pub(crate) fn stiffness_rows(
    edges: &Laplacian,
    masses: &[f64],
    k_s: f64,
    k_b: f64,
) -> SymmetricRows {
    let count = edges.len();
    let own: Vec<f64> = (0..count).map(|i| edges.row(i).fold(0.0, |sum, (_, w)| sum - w)).collect();
    let row = |i: usize| std::iter::once((i, own[i])).chain(edges.row(i));
    let mut out = SymmetricRows { starts: vec![0], ..SymmetricRows::default() };
    let mut sums = vec![0.0; count];
    let mut touched = Vec::new();
    let mut is_touched = vec![false; count];
    for i in 0..count {
        let mut add = |j: usize, x: f64| {
            if !is_touched[j] {
                is_touched[j] = true;
                touched.push(j);
            }
            sums[j] += x;
        };
        for (v, l_iv) in row(i) {
            add(v, -k_s * l_iv);
            // A vertex without triangles has no mass, and no bending.
            if masses[v] > 0.0 {
                let weight = k_b * l_iv / masses[v];
                for (j, l_vj) in row(v) {
                    add(j, weight * l_vj);
                }
            }
        }
        touched.sort_unstable();
        for &j in &touched {
            out.columns.push(j);
            out.values.push(sums[j]);
            sums[j] = 0.0;
            is_touched[j] = false;
        }
        touched.clear();
        out.starts.push(out.columns.len());
    }
    out
}

/// Which vertices hang together with one of `markers`.
pub(crate) fn reached(edges: &Laplacian, markers: &[usize]) -> Vec<bool> {
    let mut reached = vec![false; edges.len()];
    let mut next: Vec<usize> = markers.to_vec();
    markers.iter().for_each(|&v| reached[v] = true);
    while let Some(v) = next.pop() {
        for (j, _) in edges.row(v) {
            if !reached[j] {
                reached[j] = true;
                next.push(j);
            }
        }
    }
    reached
}

/// a of eq. 2.17: the rows and columns of the free vertices.
pub(crate) fn restricted(k: &SymmetricRows, place: &[usize], free: &[usize]) -> SymmetricRows {
    let mut out = SymmetricRows { starts: vec![0], ..SymmetricRows::default() };
    for &v in free {
        // Free vertices are numbered in ascending order, and so are the columns.
        for (j, x) in k.row(v).filter(|(j, _)| place[*j] < MARKER) {
            out.columns.push(place[j]);
            out.values.push(x);
        }
        out.starts.push(out.columns.len());
    }
    out
}

/// The Schur complement K_mm + K_mf d*, and what is left of K d = 0 at the free vertices.
fn reduced(
    k: &SymmetricRows,
    fields: &[f64],
    markers: &[usize],
    free: &[usize],
) -> (Vec<f64>, f64) {
    let p = markers.len();
    let force = |vertex: usize, out: &mut [f64]| {
        out.fill(0.0);
        for (j, x) in k.row(vertex) {
            for (out, field) in out.iter_mut().zip(&fields[j * p..(j + 1) * p]) {
                *out += x * field;
            }
        }
    };
    let mut stiffness = vec![0.0; p * p];
    for (row, &v) in stiffness.chunks_exact_mut(p).zip(markers) {
        force(v, row);
    }
    for i in 0..p {
        for j in 0..i {
            let mean = 0.5 * (stiffness[i * p + j] + stiffness[j * p + i]);
            stiffness[i * p + j] = mean;
            stiffness[j * p + i] = mean;
        }
    }
    let mut row = vec![0.0; p];
    let mut residual = 0.0_f64;
    for &v in free {
        force(v, &mut row);
        let diagonal = k.row(v).find(|(j, _)| *j == v).map_or(1.0, |(_, x)| x);
        for x in &row {
            residual = residual.max((x / diagonal).abs());
        }
    }
    (stiffness, residual)
}
