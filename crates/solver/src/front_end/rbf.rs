//! Morphological adaptation (thesis 5.2.2): radial basis functions r^3 plus an affine part.
//!
//! Interpolation takes a marker that was put 1.5 mm beside its place for a face of another shape there: at
//! a spacing of 8 mm a quarter of the motion that it passes on is wrong. With a smoothing lambda the function
//! misses its values by what bends it least (Carr et al. 2001; SciPy's `RBFInterpolator(smoothing=...)`):
//! (Phi + lambda I) u + affine = values, u orthogonal to the affine functions.

use mimique_geometry::{Point, centroid, solve_linear};

/// F(m) = sum over k of u_k |m - M0_k|^3 + affine(m), eq. 5.18 (where q is printed wrongly: it is
/// ax + by + cz + d), for the three coordinates at once.
#[derive(Debug, Clone, PartialEq)]
pub struct Rbf {
    /// Coordinates inside are (x - centre) * scale: the system of eq. 5.19 is then well scaled in
    /// any unit, and the weights of an expression do not depend on it.
    centre: Point,
    scale: f64,
    /// The P centres, coordinate by coordinate, scaled.
    centres: [Vec<f64>; 3],
    /// The P coefficients u of each output coordinate.
    coefficients: [Vec<f64>; 3],
    /// For each output coordinate a, b, c, d.
    affine: [[f64; 4]; 3],
}

/// Why the system of eq. 5.19 cannot be solved.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RbfError {
    /// An affine map in space needs four centres.
    #[error("{0} markers; the adaptation of shape needs at least 4 that are not in one plane")]
    TooFew(usize),
    /// Two centres coincide.
    #[error("markers {0} and {1} are at one place on the neutral face; remove one of them")]
    Coincident(usize, usize),
    /// All the centres lie in a plane.
    #[error("the neutral markers lie in one plane; add markers that stand out of it")]
    Planar,
}

impl Rbf {
    /// The function that takes `centres` (M0, P points) to `values` exactly (eq. 5.19-5.20).
    ///
    /// # Errors
    /// [`RbfError`] for fewer than four points, two that coincide, or all in a plane.
    pub fn interpolate(centres: &[Point], values: &[Point]) -> Result<Rbf, RbfError> {
        Rbf::smooth(centres, values, 0.0)
    }

    /// The function that takes `centres` near `values`: exactly where `smoothing` is 0, ever nearer to the
    /// best affine map the larger it is. `smoothing` stands on the diagonal of eq. 5.19 for centres at a
    /// root mean square distance of 1 from their mean, so that it has no unit.
    ///
    /// # Errors
    /// As [`Rbf::interpolate`].
    pub fn smooth(centres: &[Point], values: &[Point], smoothing: f64) -> Result<Rbf, RbfError> {
        let p = centres.len().min(values.len());
        if p < 4 {
            return Err(RbfError::TooFew(p));
        }
        for i in 0..p {
            if let Some(j) = (0..i).find(|&j| centres[j] == centres[i]) {
                return Err(RbfError::Coincident(j, i));
            }
        }
        let centre = centroid(centres[..p].iter().copied());
        let extent =
            (centres[..p].iter()).map(|c| (*c - centre).abs().max_element()).fold(0.0, f64::max);
        let scale = 1.0 / extent;
        let scaled: [Vec<f64>; 3] = std::array::from_fn(|a| {
            centres[..p].iter().map(|c| (c[a] - centre[a]) * scale).collect()
        });

        // phi of centres scaled to 1 / radius is that of ours divided by (scale radius)^3.
        let radius = |axis: &Vec<f64>| axis.iter().map(|x| x * x).sum::<f64>();
        let radius = (scaled.iter().map(radius).sum::<f64>() / p as f64).sqrt();
        let diagonal = smoothing * radius * radius * radius;

        let n = p + 4;
        let mut system = vec![0.0; n * n];
        let mut right = vec![0.0; n * 3];
        for i in 0..p {
            for j in 0..p {
                let [x, y, z] = scaled.each_ref().map(|axis| axis[i] - axis[j]);
                system[i * n + j] = cubed_length([x, y, z]);
            }
            for a in 0..3 {
                system[i * n + p + a] = scaled[a][i];
                system[(p + a) * n + i] = scaled[a][i];
                right[i * 3 + a] = values[i][a];
            }
            system[i * n + i] += diagonal;
            system[i * n + p + 3] = 1.0;
            system[(p + 3) * n + i] = 1.0;
        }
        solve_linear(&system, &mut right, n).ok_or(RbfError::Planar)?;
        Ok(Rbf {
            centre,
            scale,
            centres: scaled,
            coefficients: std::array::from_fn(|a| (0..p).map(|i| right[i * 3 + a]).collect()),
            affine: std::array::from_fn(|a| std::array::from_fn(|k| right[(p + k) * 3 + a])),
        })
    }

    /// F at one point.
    pub fn apply(&self, x: Point) -> Point {
        let mut points = x.to_array().map(|x| [x]);
        let [px, py, pz] = &mut points;
        let mut out = [[0.0], [0.0], [0.0]];
        let [ox, oy, oz] = &mut out;
        self.apply_all([px, py, pz], [ox, oy, oz]);
        Point::new(out[0][0], out[1][0], out[2][0])
    }

    /// F at many points given coordinate by coordinate; `points` is used as scratch.
    ///
    /// The sum over the centres runs in their order for every point by itself, so that the bits do
    /// not depend on how many points are done at a time.
    pub(crate) fn apply_all(&self, points: [&mut [f64]; 3], out: [&mut [f64]; 3]) {
        let [px, py, pz] = points;
        let [ox, oy, oz] = out;
        let n = px.len();
        let (py, pz) = (&mut py[..n], &mut pz[..n]);
        let (ox, oy, oz) = (&mut ox[..n], &mut oy[..n], &mut oz[..n]);
        for i in 0..n {
            px[i] = (px[i] - self.centre[0]) * self.scale;
            py[i] = (py[i] - self.centre[1]) * self.scale;
            pz[i] = (pz[i] - self.centre[2]) * self.scale;
            let affine = |[a, b, c, d]: [f64; 4]| ((a * px[i] + b * py[i]) + c * pz[i]) + d;
            ox[i] = affine(self.affine[0]);
            oy[i] = affine(self.affine[1]);
            oz[i] = affine(self.affine[2]);
        }
        for k in 0..self.centres[0].len() {
            let c = [self.centres[0][k], self.centres[1][k], self.centres[2][k]];
            let u = [self.coefficients[0][k], self.coefficients[1][k], self.coefficients[2][k]];
            for i in 0..n {
                let phi = cubed_length([px[i] - c[0], py[i] - c[1], pz[i] - c[2]]);
                ox[i] += u[0] * phi;
                oy[i] += u[1] * phi;
                oz[i] += u[2] * phi;
            }
        }
    }
}

fn cubed_length(d: [f64; 3]) -> f64 {
    let r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    r2 * r2.sqrt()
}
