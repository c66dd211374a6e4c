//! The discrete Laplacian of a triangle mesh (thesis 5.1.2, eq. 5.9-5.12), as weighted differences.

use mimique_geometry::Point;

use crate::parameters::choices::LaplacianKind;

/// (L f)_i = sum over j of w_ij (f_j - f_i), the sign of eq. 5.12 (eq. 5.8 is its negative).
///
/// S rows; the vertex weights W_v of eq. 5.11 are already in `weights`, so that applying it twice is
/// (W_v L)(W_v L), the bi-Laplacian of eq. 5.9.
#[derive(Debug, Clone, PartialEq)]
pub struct Laplacian {
    /// Row i is `starts[i]..starts[i + 1]` of `neighbours` and `weights`; S + 1 entries.
    starts: Vec<usize>,
    neighbours: Vec<u32>,
    weights: Vec<f64>,
}

/// How many of the operator's unit make a metre in [`LaplacianKind::CotanLiteral`], whose areas have
/// a unit: millimetres, in which the papers work.
const LITERAL_UNIT_PER_METRE: f64 = 1000.0;

impl Laplacian {
    /// The Laplacian of a mesh in metres. Indices must be in range ([`crate::SkinMesh::check`]).
    ///
    /// A vertex without triangles has an empty row. An isolated or degenerate triangle has no
    /// cotangents: its terms are left out.
    pub fn new(positions: &[Point], triangles: &[[u32; 3]], kind: LaplacianKind) -> Laplacian {
        match kind {
            LaplacianKind::Uniform => Laplacian::uniform(positions.len(), triangles),
            LaplacianKind::Umbrella => {
                let mut l = Laplacian::uniform(positions.len(), triangles);
                l.normalise_rows();
                l
            }
            LaplacianKind::CotanClamped => {
                let mut l = Laplacian::cotangent(positions, triangles);
                for w in &mut l.weights {
                    *w = w.clamp(0.0, 10.0);
                }
                l.normalise_rows();
                l
            }
            LaplacianKind::CotanLiteral => {
                let scaled: Vec<Point> =
                    positions.iter().map(|p| p.map(|x| x * LITERAL_UNIT_PER_METRE)).collect();
                Laplacian::cotangent_over_areas(&scaled, triangles)
            }
        }
    }

    /// Cotangent weights divided by the mixed Voronoi area, in the unit of the positions.
    pub fn cotangent_over_areas(positions: &[Point], triangles: &[[u32; 3]]) -> Laplacian {
        let mut l = Laplacian::cotangent(positions, triangles);
        let areas = mixed_voronoi_areas(positions, triangles);
        for (i, area) in areas.into_iter().enumerate() {
            if area > 0.0 {
                for w in &mut l.weights[l.starts[i]..l.starts[i + 1]] {
                    *w /= area;
                }
            }
        }
        l
    }

    /// The two factors of a Laplacian W_v L (thesis 2.3.4: M^-1 L*): the symmetric L with its edge
    /// weights alone, and M, the S inverses of W_v. `CotanLiteral` measures areas in mm^2.
    pub fn symmetric(
        positions: &[Point],
        triangles: &[[u32; 3]],
        kind: LaplacianKind,
    ) -> (Laplacian, Vec<f64>) {
        let sums = |l: &Laplacian| -> Vec<f64> {
            (0..l.len()).map(|i| l.row(i).fold(0.0, |sum, (_, w)| sum + w)).collect()
        };
        match kind {
            LaplacianKind::Uniform => {
                (Laplacian::uniform(positions.len(), triangles), vec![1.0; positions.len()])
            }
            LaplacianKind::Umbrella => {
                let l = Laplacian::uniform(positions.len(), triangles);
                let masses = sums(&l);
                (l, masses)
            }
            LaplacianKind::CotanClamped => {
                let mut l = Laplacian::cotangent(positions, triangles);
                for w in &mut l.weights {
                    *w = w.clamp(0.0, 10.0);
                }
                let masses = sums(&l);
                (l, masses)
            }
            LaplacianKind::CotanLiteral => {
                let unit = LITERAL_UNIT_PER_METRE * LITERAL_UNIT_PER_METRE;
                let areas = mixed_voronoi_areas(positions, triangles);
                let l = Laplacian::cotangent(positions, triangles);
                (l, areas.into_iter().map(|area| area * unit).collect())
            }
        }
    }

    /// Number of vertices, S.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is no vertex.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The neighbours of a vertex with their weights, neighbours ascending.
    pub fn row(&self, vertex: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[vertex]..self.starts[vertex + 1];
        range.map(|k| (self.neighbours[k] as usize, self.weights[k]))
    }

    /// L f of a scalar field, S numbers.
    ///
    /// # Panics
    /// If `f` does not have S entries.
    pub fn apply(&self, f: &[f64]) -> Vec<f64> {
        assert_eq!(f.len(), self.len(), "a field has one number per vertex");
        (0..self.len())
            .map(|i| self.row(i).fold(0.0, |sum, (j, w)| sum + w * (f[j] - f[i])))
            .collect()
    }

    fn uniform(count: usize, triangles: &[[u32; 3]]) -> Laplacian {
        let mut l = Laplacian::with_neighbours(count, triangles);
        l.weights.fill(1.0);
        l
    }

    /// Edge weights (cot a + cot b) / 2, no vertex weights.
    fn cotangent(positions: &[Point], triangles: &[[u32; 3]]) -> Laplacian {
        let mut l = Laplacian::with_neighbours(positions.len(), triangles);
        for t in triangles {
            let corners = t.map(|v| positions[v as usize]);
            for k in 0..3 {
                let cot = corner_cotangent(corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
                let (a, b) = (t[(k + 1) % 3], t[(k + 2) % 3]);
                if let Some(cot) = cot
                    && a != b
                {
                    l.add(a, b, 0.5 * cot);
                    l.add(b, a, 0.5 * cot);
                }
            }
        }
        l
    }

    /// The pattern of the adjacency matrix (eq. 5.1), every weight 0.
    fn with_neighbours(count: usize, triangles: &[[u32; 3]]) -> Laplacian {
        let mut degree = vec![0_usize; count + 1];
        let edges = |t: &[u32; 3]| {
            let [a, b, c] = *t;
            [(a, b), (b, c), (c, a), (b, a), (c, b), (a, c)]
        };
        for (a, b) in triangles.iter().flat_map(edges) {
            if a != b {
                degree[a as usize + 1] += 1;
            }
        }
        for i in 0..count {
            degree[i + 1] += degree[i];
        }
        let mut next = degree.clone();
        let mut doubled = vec![0_u32; degree[count]];
        for (a, b) in triangles.iter().flat_map(edges) {
            if a != b {
                doubled[next[a as usize]] = b;
                next[a as usize] += 1;
            }
        }
        let mut starts = Vec::with_capacity(count + 1);
        starts.push(0);
        let mut neighbours = Vec::with_capacity(doubled.len() / 2 + count);
        for i in 0..count {
            let row = &mut doubled[degree[i]..degree[i + 1]];
            row.sort_unstable();
            let mut last = None;
            for &j in row.iter() {
                if last != Some(j) {
                    neighbours.push(j);
                    last = Some(j);
                }
            }
            starts.push(neighbours.len());
        }
        let weights = vec![0.0; neighbours.len()];
        Laplacian { starts, neighbours, weights }
    }

    fn add(&mut self, row: u32, column: u32, weight: f64) {
        let start = self.starts[row as usize];
        let end = self.starts[row as usize + 1];
        if let Ok(k) = self.neighbours[start..end].binary_search(&column) {
            self.weights[start + k] += weight;
        }
    }

    fn normalise_rows(&mut self) {
        for i in 0..self.len() {
            let row = &mut self.weights[self.starts[i]..self.starts[i + 1]];
            let sum: f64 = row.iter().sum();
            if sum > 0.0 {
                for w in row {
                    *w /= sum;
                }
            }
        }
    }
}

/// The mixed Voronoi area of each vertex (thesis figure 5.2): circumcentric cells, and in obtuse
/// triangles half of the triangle to the obtuse corner and a quarter to the others. They add up to
/// the surface.
pub fn mixed_voronoi_areas(positions: &[Point], triangles: &[[u32; 3]]) -> Vec<f64> {
    let mut areas = vec![0.0; positions.len()];
    for t in triangles {
        let p = t.map(|v| positions[v as usize]);
        let area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).length();
        let cotangents: [Option<f64>; 3] =
            std::array::from_fn(|k| corner_cotangent(p[k], p[(k + 1) % 3], p[(k + 2) % 3]));
        let [Some(c0), Some(c1), Some(c2)] = cotangents else { continue };
        let cot = [c0, c1, c2];
        let obtuse = cot.iter().position(|&c| c < 0.0);
        for k in 0..3 {
            let (l, r) = ((k + 1) % 3, (k + 2) % 3);
            areas[t[k] as usize] += match obtuse {
                Some(o) if o == k => area / 2.0,
                Some(_) => area / 4.0,
                // The edge to r is opposite the corner l, and the other way round.
                None => {
                    let to_l = p[l] - p[k];
                    let to_r = p[r] - p[k];
                    (to_r.length_squared() * cot[l] + to_l.length_squared() * cot[r]) / 8.0
                }
            };
        }
    }
    areas
}

/// Cotangent of the angle at `corner`; none where the triangle has no area.
fn corner_cotangent(corner: Point, a: Point, b: Point) -> Option<f64> {
    let (u, v) = (a - corner, b - corner);
    let sine = u.cross(v).length();
    (sine > 0.0).then(|| u.dot(v) / sine)
}
