//! Cases of marker layouts, in the files of their README: every field that is expected is computed and
//! compared; the README's table says how near.

mod avatar;
mod clusters;
mod order;
mod processes;

use mimique_geometry::Point;
use mimique_solver::{SkinMesh, SparseDeltas};
use serde_json::Value;

use crate::case::Tolerance;
use crate::document::Part;
use crate::files::{FileFamily, Source};
use crate::{Case, VerifyError};

/// The family.
pub(crate) static LAYOUTS: FileFamily = FileFamily {
    name: "layouts",
    files: &[
        ("kmeans_plane.json", clusters::plane),
        ("kmeans_face.json", clusters::face),
        ("kmeans_symmetric.json", clusters::symmetric),
        ("sogp_small.json", processes::sparse),
        ("sogp_face.json", processes::sparse),
        ("gp_face.json", processes::exact),
        ("curve_face.json", processes::curve),
        ("greedy_face.json", order::greedy),
        ("slip_face.json", order::slip),
        ("qr_face.json", order::pivoted_qr),
        ("head_face.json", order::heads),
        ("avatar_kmeans.json", avatar::kmeans),
        ("avatar_greedy.json", avatar::greedy),
        ("avatar_curve.json", avatar::curve),
    ],
};

/// Exact: labels, orders, markers.
const EXACT: Tolerance = Tolerance::Exact;

/// A share of the expected number, however small that is.
const fn relative(share: f64) -> Tolerance {
    Tolerance::Relative { share, floor: 1e-300 }
}

/// Compares a member with what was computed; one that the case does not have is not asked for.
fn member(case: &mut Case, expected: &Part<'_>, key: &str, by: Tolerance, got: &Value) {
    if let Some(expected) = expected.find(key) {
        case.compare(key, expected.value(), got, by);
    }
}

/// The points of a list of three numbers each, in the unit that they are given in.
fn points(part: &Part<'_>) -> Result<Vec<Point>, VerifyError> {
    let point = |entry: &Part<'_>| match entry.numbers()?[..] {
        [x, y, z] => Ok(Point::new(x, y, z)),
        _ => Err(entry.wrong("three numbers")),
    };
    part.list()?.iter().map(point).collect()
}

/// Numbers of so many rows of a width.
fn matrix(part: &Part<'_>, rows: usize, width: usize) -> Result<Vec<f64>, VerifyError> {
    let numbers = part.numbers()?;
    match numbers.len() == rows * width {
        true => Ok(numbers),
        false => Err(part.wrong("a number for every row and column")),
    }
}

/// The deltas of shapes, as cases write them (shapes x vertices x 3), in the order vertices x 3 x shapes.
struct Deltas {
    shapes: usize,
    /// Vertices x 3 x shapes.
    values: Vec<f64>,
}

impl Deltas {
    fn read(part: &Part<'_>, vertices: usize) -> Result<Self, VerifyError> {
        let shapes = part.list()?.len();
        let numbers = matrix(part, shapes, 3 * vertices)?;
        let value = |place: usize| numbers[place % shapes * 3 * vertices + place / shapes];
        let values = (0..numbers.len()).map(value).collect();
        Ok(Self { shapes, values })
    }

    /// The rows of some vertices, 3 x shapes each.
    fn rows(&self, vertices: &[usize]) -> Vec<f64> {
        vertices.iter().flat_map(|&v| self.of(v)).copied().collect()
    }

    /// The rows of a vertex.
    fn of(&self, vertex: usize) -> &[f64] {
        &self.values[vertex * 3 * self.shapes..(vertex + 1) * 3 * self.shapes]
    }

    /// The mean over the vertices of B^T B, shapes x shapes.
    fn gram(&self) -> Vec<f64> {
        let (n, vertices) = (self.shapes, self.values.len() / (3 * self.shapes).max(1));
        let mut gram = vec![0.0; n * n];
        for row in self.values.chunks_exact(n) {
            for (i, x) in row.iter().enumerate() {
                gram[i * n..(i + 1) * n].iter_mut().zip(row).for_each(|(g, y)| *g += x * y);
            }
        }
        gram.iter_mut().for_each(|g| *g /= vertices as f64);
        gram
    }

    /// What weights do to some vertices: frames x 3 vertices.
    fn displaced(&self, weights: &[f64], vertices: &[usize]) -> Vec<f64> {
        let rows = self.rows(vertices);
        let of_frame = |frame: &[f64]| -> Vec<f64> {
            let row = |row: &[f64]| row.iter().zip(frame).map(|(d, w)| d * w).sum();
            rows.chunks_exact(self.shapes).map(row).collect()
        };
        weights.chunks_exact(self.shapes).flat_map(of_frame).collect()
    }

    /// Root mean square distances between the vertices at some weights and at others: the sum over the
    /// vertices as eq. 3.5 has it, and their mean.
    fn errors(&self, weights: &[f64], others: &[f64]) -> [f64; 2] {
        let (n, vertices) = (self.shapes, self.values.len() / (3 * self.shapes).max(1));
        let frames = weights.len() / n;
        let mut sum = 0.0;
        for (a, b) in weights.chunks_exact(n).zip(others.chunks_exact(n)) {
            let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
            for row in self.values.chunks_exact(n) {
                let distance: f64 = row.iter().zip(&off).map(|(d, o)| d * o).sum();
                sum += distance * distance;
            }
        }
        [(sum / frames as f64).sqrt(), (sum / (frames * vertices) as f64).sqrt()]
    }
}

/// A mesh of points and triangles without shapes.
fn bare_mesh(positions: Vec<Point>, triangles: Vec<[u32; 3]>) -> SkinMesh {
    SkinMesh { positions, triangles, shapes: vec![SparseDeltas::default()] }
}

/// Whether two points are not nearer than a distance.
fn apart(positions: &[Point], minimum: f64) -> impl Fn(usize, usize) -> bool + '_ {
    move |a, b| (positions[a] - positions[b]).length() >= minimum
}
