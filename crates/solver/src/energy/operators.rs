//! Everything of an avatar that a frame needs: D, H, l^2, tau; nothing of the size of the mesh.

use mimique_geometry::{Point, coordinates};

use crate::energy::thin_shell::shell_gram;
use crate::gaussian_process::regression::{Regression, TrainingError};
use crate::kouadio::associated_rows::{AssociatedRows, VertexAssociation};
use crate::linear_algebra::dense::packed_len;
use crate::mesh::laplacian::Laplacian;
use crate::mesh::marker_site::MarkerSite;
use crate::mesh::skin_mesh::{MeshError, SkinMesh};
use crate::parameters::choices::LaplacianKind;
use crate::parameters::group::Group;
use crate::parameters::table::MethodSpec;

/// What the operators are built with: two methods with equal options can share them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OperatorOptions {
    /// Weights of the Laplacian.
    pub laplacian: LaplacianKind,
    /// Resistance to stretching.
    pub k_s: f64,
    /// Resistance to bending.
    pub k_b: f64,
    /// Kouadio's association of the face's points with the markers; none leaves his rows out.
    pub association: Option<VertexAssociation>,
}

/// D, H and the names, as plain data: what is stored and sent.
#[derive(Debug, Clone, PartialEq)]
pub struct OperatorParts {
    /// What they were built with.
    pub options: OperatorOptions,
    /// The N shapes, in the avatar's order.
    pub shape_names: Vec<String>,
    /// The P face markers, in the order of the rows of `marker_deltas`.
    pub marker_labels: Vec<String>,
    /// Where each marker sits on the neutral avatar, metres.
    pub marker_positions: Vec<Point>,
    /// S, the vertices of the welded skin (the literal forms weigh E_b by 3S).
    pub vertex_count: usize,
    /// D: the rows of the shapes at the markers' vertices, 3P x N row-major, marker-major rows
    /// (x, y, z of marker 0, then of marker 1...), metres.
    pub marker_deltas: Vec<f64>,
    /// H: N x N row-major, m^2.
    pub shell_gram: Vec<f64>,
    /// Kouadio's associated rows, when asked for.
    pub associated: Option<AssociatedRows>,
    /// What `regression` has learnt, when it has.
    pub regression: Option<Regression>,
}

/// Checked [`OperatorParts`] with the scales that follow from them.
#[derive(Debug, Clone, PartialEq)]
pub struct Operators {
    parts: OperatorParts,
    data_scale: f64,
    shell_scale: f64,
}

/// Why operators cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OperatorError {
    /// The mesh is not usable.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A stored regression is damaged.
    #[error(transparent)]
    Regression(#[from] TrainingError),
    /// Names and data do not have the same number.
    #[error("{what}: {found} of them, {expected} expected; {remedy}")]
    Count {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
        /// What to do.
        remedy: &'static str,
    },
    /// A marker's vertex is not in the mesh.
    #[error("marker {label}: vertex {vertex} of {count}; correct the marker map")]
    MarkerVertex {
        /// The marker.
        label: String,
        /// The vertex it names.
        vertex: usize,
        /// How many there are.
        count: usize,
    },
    /// A number of D, H or the positions is not finite.
    #[error("operators, {what}: a number is not finite; build them again from the avatar")]
    NotFinite {
        /// Which matrix.
        what: &'static str,
    },
    /// The markers see no shape at all, or the shapes do not bend the skin.
    #[error("{what} is 0; {remedy}")]
    NoMotion {
        /// Which scale.
        what: &'static str,
        /// What to do.
        remedy: &'static str,
    },
}

impl OperatorOptions {
    /// What `spec` needs.
    pub fn of(spec: &MethodSpec) -> OperatorOptions {
        OperatorOptions {
            laplacian: spec.laplacian(),
            k_s: spec.k_s(),
            k_b: spec.k_b(),
            association: spec.method.uses(Group::Association).then(|| spec.vertex_association()),
        }
    }
}

impl Default for OperatorOptions {
    fn default() -> OperatorOptions {
        OperatorOptions { laplacian: LaplacianKind::Uniform, k_s: 1.0, k_b: 1.0, association: None }
    }
}

impl Operators {
    /// Compute D, H and the associated rows of a welded mesh ([`SkinMesh::weld`]) with markers at
    /// vertices: label and vertex of the welded mesh. O(S) time and memory.
    ///
    /// # Errors
    /// As [`Operators::build_at`].
    pub fn build(
        mesh: &SkinMesh,
        shape_names: &[String],
        markers: &[(String, usize)],
        options: &OperatorOptions,
    ) -> Result<Operators, OperatorError> {
        let sites: Vec<MarkerSite> =
            markers.iter().map(|(label, v)| MarkerSite::at_vertex(label, *v)).collect();
        Operators::build_at(mesh, shape_names, &sites, options)
    }

    /// The same with markers at vertices or inside triangles.
    ///
    /// # Errors
    /// [`OperatorError`] for a mesh, a name list or a marker that does not fit, or shapes that move
    /// no marker.
    pub fn build_at(
        mesh: &SkinMesh,
        shape_names: &[String],
        sites: &[MarkerSite],
        options: &OperatorOptions,
    ) -> Result<Operators, OperatorError> {
        mesh.check()?;
        let count = mesh.positions.len();
        for site in sites {
            if let Some(&vertex) = site.corners.iter().find(|&&v| v >= count) {
                let label = site.label.clone();
                return Err(OperatorError::MarkerVertex { label, vertex, count });
            }
        }
        expect_count("shape names", shape_names.len(), mesh.shapes.len(), "name every shape")?;
        let vertices: Vec<usize> = sites.iter().map(MarkerSite::vertex).collect();
        let laplacian = Laplacian::new(&mesh.positions, &mesh.triangles, options.laplacian);
        Operators::from_parts(OperatorParts {
            options: *options,
            shape_names: shape_names.to_vec(),
            marker_labels: sites.iter().map(|s| s.label.clone()).collect(),
            marker_positions: sites.iter().map(|s| s.position(mesh)).collect(),
            vertex_count: count,
            marker_deltas: marker_deltas(mesh, sites),
            shell_gram: shell_gram(mesh, &laplacian, options.k_s, options.k_b, &vertices),
            associated: options
                .association
                .map(|association| AssociatedRows::build(mesh, sites, association)),
            regression: None,
        })
    }

    /// Take up stored data; the same bits as when they were built.
    ///
    /// # Errors
    /// [`OperatorError`] where sizes disagree, a number is not finite or a scale is 0.
    pub fn from_parts(parts: OperatorParts) -> Result<Operators, OperatorError> {
        let n = parts.shape_names.len();
        let p = parts.marker_labels.len();
        let again = "build the operators again from the avatar";
        expect_count("marker positions", parts.marker_positions.len(), p, again)?;
        expect_count("numbers of D", parts.marker_deltas.len(), 3 * p * n, again)?;
        expect_count("numbers of H", parts.shell_gram.len(), n * n, again)?;
        if let Some(associated) = &parts.associated {
            expect_count(
                "associated Gram matrices",
                associated.grams.len(),
                p * packed_len(n),
                again,
            )?;
            expect_count("associated sums", associated.sums.len(), 3 * p * n, again)?;
            finite("associated rows", associated.grams.iter().chain(&associated.sums))?;
        }
        if let Some(model) = &parts.regression {
            expect_count("inputs of the regression", model.width(), 3 * p, again)?;
            expect_count("outputs of the regression", model.shape_count, n, again)?;
            model.check()?;
        }
        finite("marker positions", coordinates(&parts.marker_positions))?;
        finite("D", &parts.marker_deltas)?;
        finite("H", &parts.shell_gram)?;
        let squares = parts.marker_deltas.iter().fold(0.0, |s, x| s + x * x);
        let trace = (0..n).fold(0.0, |s, i| s + parts.shell_gram[i * n + i]);
        if !(squares > 0.0) {
            return Err(OperatorError::NoMotion {
                what: "the motion of all shapes at all markers",
                remedy: "place markers where the blendshapes move the skin",
            });
        }
        if !(trace > 0.0) {
            return Err(OperatorError::NoMotion {
                what: "the thin-shell energy of all shapes",
                remedy: "give blendshapes that bend the skin away from the markers",
            });
        }
        let data_scale = squares / n as f64;
        let shell_scale = trace / n as f64;
        Ok(Operators { parts, data_scale, shell_scale })
    }

    /// The same with what `regression` has learnt.
    ///
    /// # Errors
    /// [`OperatorError`] where the model has other markers or shapes.
    pub fn with_regression(self, model: Regression) -> Result<Operators, OperatorError> {
        Operators::from_parts(OperatorParts { regression: Some(model), ..self.parts })
    }

    /// D, H and the names.
    pub fn parts(&self) -> &OperatorParts {
        &self.parts
    }

    /// N, the shapes.
    pub fn shape_count(&self) -> usize {
        self.parts.shape_names.len()
    }

    /// P, the face markers.
    pub fn marker_count(&self) -> usize {
        self.parts.marker_labels.len()
    }

    /// l^2 = tr(D^T D) / N, m^2.
    pub fn data_scale(&self) -> f64 {
        self.data_scale
    }

    /// tau = tr(H) / N, m^2.
    pub fn shell_scale(&self) -> f64 {
        self.shell_scale
    }

    /// |D_k|^2: the squared displacements of all markers by each shape at weight 1, square metres.
    pub fn marker_squares(&self) -> Vec<f64> {
        let n = self.shape_count();
        let rows = || self.parts.marker_deltas.chunks_exact(n);
        (0..n).map(|k| rows().map(|row| row[k] * row[k]).sum()).collect()
    }

    /// The largest displacement of any marker by each shape at weight 1, metres: shapes under a
    /// millimetre are all but unseen.
    pub fn marker_reach(&self) -> Vec<f64> {
        let n = self.shape_count();
        let mut reach = vec![0.0_f64; n];
        for rows in self.parts.marker_deltas.chunks_exact(3 * n) {
            for (k, reach) in reach.iter_mut().enumerate() {
                let [x, y, z] = [rows[k], rows[n + k], rows[2 * n + k]];
                *reach = reach.max((x * x + y * y + z * z).sqrt());
            }
        }
        reach
    }
}

/// D: 3P x N, marker-major rows.
fn marker_deltas(mesh: &SkinMesh, sites: &[MarkerSite]) -> Vec<f64> {
    let n = mesh.shapes.len();
    let mut d = vec![0.0; 3 * sites.len() * n];
    for k in 0..n {
        for (m, site) in sites.iter().enumerate() {
            for (a, x) in site.delta(mesh, k).to_array().into_iter().enumerate() {
                d[(3 * m + a) * n + k] = x;
            }
        }
    }
    d
}

fn expect_count(
    what: &'static str,
    found: usize,
    expected: usize,
    remedy: &'static str,
) -> Result<(), OperatorError> {
    if found == expected {
        Ok(())
    } else {
        Err(OperatorError::Count { what, found, expected, remedy })
    }
}

fn finite<'a>(
    what: &'static str,
    numbers: impl IntoIterator<Item = &'a f64>,
) -> Result<(), OperatorError> {
    if numbers.into_iter().all(|x| x.is_finite()) {
        Ok(())
    } else {
        Err(OperatorError::NotFinite { what })
    }
}
