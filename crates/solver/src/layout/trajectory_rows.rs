//! The rows that vertices are clustered by (thesis 3.6.1, eq. 3.6): the trajectory of each, every
//! coordinate with mean 0 and standard deviation 1.
//!
//! | thesis | code | size |
//! |---|---|---|
//! | v-bar of eq. 3.6, a row of V | a row of [`TrajectoryRows`] | 3 frames |
//! | mu_p, sigma_p | mean and deviation (1/N) of each coordinate by itself | 3 |
//!
//! "Standard error" and "standard deviation" both stand in the text: the deviation is meant, since the
//! error would only scale all rows alike. Where a coordinate rests, eq. 3.6 divides rounding by
//! rounding: its entries are 0.

use crate::linear_algebra::cholesky::Cholesky;
use crate::linear_algebra::dense::dot;

/// A coordinate with a smaller standard deviation rests, metres: a millionth of a millimetre.
pub const STILL_M: f64 = 1e-9;

/// Rows of numbers, all of one width: one for each vertex that is clustered.
#[derive(Debug, Clone, PartialEq)]
pub struct TrajectoryRows {
    /// Numbers of a row.
    pub width: usize,
    /// Row after row.
    pub values: Vec<f64>,
}

/// How a person's weights vary over a take.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightMotion {
    /// Frames that the covariance is of.
    pub frames: usize,
    /// Covariance of the weights (1/frames), N x N.
    pub covariance: Vec<f64>,
}

/// The positions of a person's vertices over a take.
#[derive(Debug, Clone, Copy)]
pub struct VertexTrajectories<'a> {
    /// How many vertices a frame has.
    pub vertices: usize,
    /// Frames x vertices x 3, metres.
    pub positions: &'a [f64],
}

impl TrajectoryRows {
    /// The number of rows.
    pub fn len(&self) -> usize {
        self.values.len() / self.width.max(1)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The row of that place.
    ///
    /// # Panics
    /// If there is none.
    pub fn row(&self, place: usize) -> &[f64] {
        &self.values[place * self.width..(place + 1) * self.width]
    }

    /// The rows in order.
    pub fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.width.max(1))
    }

    /// Eq. 3.6 for `vertices`, in their order. The columns are person after person, each by its own mean
    /// and deviation, frame after frame, x y z.
    ///
    /// # Panics
    /// If a person has no such vertex.
    pub fn of_trajectories(people: &[VertexTrajectories<'_>], vertices: &[usize]) -> Self {
        let frames =
            |person: &VertexTrajectories<'_>| person.positions.len() / (3 * person.vertices).max(1);
        let width: usize = people.iter().map(|person| 3 * frames(person)).sum();
        let mut values = Vec::with_capacity(vertices.len() * width);
        for &vertex in vertices {
            for person in people {
                let places = person.positions.chunks_exact(3 * person.vertices);
                let start = values.len();
                values.extend(places.flat_map(|frame| frame[3 * vertex..3 * vertex + 3].to_vec()));
                (0..3).for_each(|axis| normalise(&mut values[start + axis..]));
            }
        }
        Self { width, values }
    }

    /// Rows with the distances of [`Self::of_trajectories`] for vertices that the weights of some people
    /// move: `deltas` are vertices x 3 x N, metres.
    ///
    /// With C = U^T U the covariance, a coordinate with deltas b has variance b^T C b = abs(U b)^2, and the
    /// trajectories of two coordinates have the scalar product of their U b, times the frames: 3N numbers
    /// say what 3 frames do.
    ///
    /// # Panics
    /// If a covariance is not N x N.
    pub fn of_bank(deltas: &[f64], shape_count: usize, people: &[WeightMotion]) -> Self {
        let n = shape_count;
        let takes: Vec<(Vec<f64>, f64)> = (people.iter())
            .map(|person| {
                let rows = motion_rows(deltas, n, &person.covariance);
                (rows, (person.frames as f64).sqrt())
            })
            .collect();
        let vertices = deltas.len() / (3 * n).max(1);
        let mut values = Vec::with_capacity(vertices * 3 * n * takes.len());
        for vertex in 0..vertices {
            for (rows, length) in &takes {
                for row in rows[vertex * 3 * n..(vertex + 1) * 3 * n].chunks_exact(n) {
                    let deviation = dot(row, row).sqrt();
                    let factor = if deviation < STILL_M { 0.0 } else { length / deviation };
                    values.extend(row.iter().map(|x| x * factor));
                }
            }
        }
        Self { width: 3 * n * takes.len(), values }
    }

    /// The same vertices with the columns of more people.
    ///
    /// # Panics
    /// Unless both have as many rows.
    pub fn beside(&self, other: &Self) -> Self {
        assert_eq!(self.len(), other.len(), "rows of the same vertices");
        let both = self.iter().zip(other.iter()).flat_map(|(a, b)| a.iter().chain(b));
        Self { width: self.width + other.width, values: both.copied().collect() }
    }

    /// For each of `pairs` the row of the one joined with the row of the other, as K-means of mirrored
    /// vertices needs them.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn joined(&self, pairs: &[[usize; 2]]) -> Self {
        let values = pairs.iter().flatten().flat_map(|&row| self.row(row)).copied().collect();
        Self { width: 2 * self.width, values }
    }
}

/// Every third number to mean 0 and deviation 1, or to 0 where it rests.
fn normalise(coordinates: &mut [f64]) {
    let count = coordinates.len().div_ceil(3) as f64;
    let every_third = || coordinates.iter().step_by(3);
    let mean = every_third().sum::<f64>() / count;
    let square = every_third().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    let deviation = (square / count).sqrt();
    for x in coordinates.iter_mut().step_by(3) {
        *x = if deviation < STILL_M { 0.0 } else { (*x - mean) / deviation };
    }
}

/// U b for each row b of N deltas, C = U^T U the covariance of the weights, N x N: its square is the mean
/// square displacement along that row, and QR of such rows is QR of the modes of the motion, each scaled by
/// its deviation.
///
/// # Panics
/// If the covariance is not N x N.
pub fn motion_rows(deltas: &[f64], shape_count: usize, covariance: &[f64]) -> Vec<f64> {
    let n = shape_count;
    let factor = factor(covariance, n);
    let mut out = vec![0.0; deltas.len()];
    for (row, b) in out.chunks_exact_mut(n).zip(deltas.chunks_exact(n)) {
        for (i, x) in row.iter_mut().enumerate() {
            *x = dot(&factor[i * n + i..(i + 1) * n], &b[i..]);
        }
    }
    out
}

/// U of C = U^T U, n x n row-major; rows of 0 where a weight depends on those before it.
fn factor(covariance: &[f64], n: usize) -> Vec<f64> {
    assert_eq!(covariance.len(), n * n, "a covariance is N x N");
    let mut cholesky = Cholesky::default();
    cholesky.reset(n);
    for i in 0..n {
        cholesky.row_mut(i).copy_from_slice(&covariance[i * n + i..(i + 1) * n]);
    }
    cholesky.factor();
    let mut out = vec![0.0; n * n];
    for i in 0..n {
        out[i * n + i..(i + 1) * n].copy_from_slice(cholesky.row_mut(i));
    }
    out
}
