//! The middle plane of a face, and a symmetric shape cut in two along it (Kouadio 4.5, figure
//! 4.18): an artist models one symmetric expression, the bank gets its left and right halves.

use std::collections::HashMap;

use mimique_geometry::{DMat3, DVec3, Displacement, Point, centroid, eigenvectors};

use crate::mesh::skin_mesh::SkinMesh;

/// The plane n . x = offset, n towards the person's left (+X).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MirrorPlane {
    /// Unit normal.
    pub normal: Displacement,
    /// Distance from the origin, metres.
    pub offset: f64,
    /// Root mean square distance of the mirrored face from the face, metres: 0 for a symmetric one.
    pub asymmetry: f64,
}

/// Why there is no middle plane.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MirrorError {
    /// Too few vertices to tell.
    #[error("{0} vertices; a middle plane needs at least 4")]
    TooFew(usize),
    /// The face does not look like its mirror image.
    #[error(
        "the mirrored face is {:.1} mm from the face (rms); give a face that is symmetric to \
         within {:.0} mm", .0 * 1e3, MOST_ASYMMETRY * 1e3
    )]
    NotSymmetric(f64),
}

/// Half the width of the strip about the middle plane in which a shape passes from one half to the
/// other, where none is given: as wide as the bridge of a nose. Metres.
pub const FALL_OFF_M: f64 = 0.008;
/// A face further than this from its mirror image has no middle plane to cut along, metres.
const MOST_ASYMMETRY: f64 = 0.005;
/// Vertices that the search looks at; more move the plane by less than their own spacing.
const SAMPLES: usize = 4000;

impl MirrorPlane {
    /// The plane x = 0.
    pub const SAGITTAL: MirrorPlane =
        MirrorPlane { normal: Displacement(DVec3::X), offset: 0.0, asymmetry: 0.0 };

    /// The plane about which a neutral face (positions in metres) is most symmetric.
    ///
    /// A symmetric set's middle plane holds its centroid and is across one of its principal axes:
    /// from those within 45 degrees of +X, and from +X itself, mirror, find each point's nearest
    /// neighbour, take the best plane for those pairs, again until it stands; the plane that leaves
    /// least. For pairs (p, q) with means p', q' the best normal is the eigenvector of the smallest
    /// eigenvalue of the symmetric part of sum (p - p')(q - q')^T, and the plane holds (p' + q') / 2.
    ///
    /// # Errors
    /// [`MirrorError`] for fewer than four points, or a face that is not symmetric to 5 mm rms.
    pub fn find(positions: &[Point]) -> Result<MirrorPlane, MirrorError> {
        if positions.len() < 4 {
            return Err(MirrorError::TooFew(positions.len()));
        }
        let step = positions.len().div_ceil(SAMPLES);
        let samples: Vec<Point> = positions.iter().step_by(step).copied().collect();
        let grid = Grid::new(positions);
        let centre = centroid(positions.iter().copied());
        let spread = sum_of_products(positions.iter().map(|p| (*p - centre, *p - centre)));
        let mut best: Option<MirrorPlane> = None;
        for axis in eigenvectors(&spread).into_iter().chain([DVec3::X]) {
            if axis.x.abs() < std::f64::consts::FRAC_1_SQRT_2 {
                continue;
            }
            let start = MirrorPlane::through(centre, axis);
            let found = start.refined(&samples, &grid);
            if best.is_none_or(|b| found.asymmetry < b.asymmetry) {
                best = Some(found);
            }
        }
        match best {
            Some(plane) if plane.asymmetry <= MOST_ASYMMETRY => Ok(plane),
            other => Err(MirrorError::NotSymmetric(other.map_or(f64::INFINITY, |p| p.asymmetry))),
        }
    }

    /// The plane through a point, across an axis.
    fn through(point: Point, axis: DVec3) -> MirrorPlane {
        let normal = if axis.x < 0.0 { -axis } else { axis };
        MirrorPlane { normal: Displacement(normal), offset: normal.dot(point.0), asymmetry: 0.0 }
    }

    fn refined(self, samples: &[Point], grid: &Grid<'_>) -> MirrorPlane {
        let mut plane = self;
        // A few rounds do; 50 is a guard.
        for _ in 0..50 {
            let pairs: Vec<(Point, Point)> =
                samples.iter().map(|&p| (p, grid.nearest(plane.mirror(p)))).collect();
            let next = best_plane(&pairs);
            let moved = (next.normal - plane.normal).length() + (next.offset - plane.offset).abs();
            plane = next;
            if moved < 1e-9 {
                break;
            }
        }
        let squares: f64 = samples
            .iter()
            .map(|&p| {
                let m = plane.mirror(p);
                (m - grid.nearest(m)).length_squared()
            })
            .sum();
        plane.asymmetry = (squares / samples.len() as f64).sqrt();
        plane
    }

    /// Of a skin's neutral.
    ///
    /// # Errors
    /// As [`MirrorPlane::find`].
    pub fn of(mesh: &SkinMesh) -> Result<MirrorPlane, MirrorError> {
        MirrorPlane::find(&mesh.positions)
    }

    /// Signed distance, positive on the person's left, metres.
    pub fn distance(&self, p: Point) -> f64 {
        self.normal.dot(p - Point::ORIGIN) - self.offset
    }

    /// The mirror image.
    pub fn mirror(&self, p: Point) -> Point {
        p - self.normal * (2.0 * self.distance(p))
    }

    /// For each place the number of the one nearest to its mirror image, and how far that is from it,
    /// metres. Empty for no places.
    pub fn partners(&self, positions: &[Point]) -> Vec<(usize, f64)> {
        if positions.is_empty() {
            return Vec::new();
        }
        let grid = Grid::new(positions);
        positions.iter().map(|&p| grid.nearest_number(self.mirror(p))).collect()
    }

    /// How much of a shape at `p` belongs to the left half: 0 on the right, 1/2 on the plane, 1 on
    /// the left, 3t^2 - 2t^3 over the strip of half-width `fall_off` (metres) between.
    pub fn left_share(&self, p: Point, fall_off: f64) -> f64 {
        let d = self.distance(p);
        if d >= fall_off {
            1.0
        } else if d <= -fall_off {
            0.0
        } else {
            let t = 0.5 * (d / fall_off + 1.0);
            t * t * (3.0 - 2.0 * t)
        }
    }
}

/// A displacement cut in a left and a right part that add up to it exactly, in single precision as
/// avatars keep it.
///
/// The larger part is rounded, the other is what is left: of two numbers within a factor 2 of one
/// another the difference is exact (Sterbenz), so their sum is too.
pub fn split_delta(delta: [f32; 3], left_share: f64) -> [[f32; 3]; 2] {
    let part = |x: f32, share: f64| (f64::from(x) * share) as f32;
    let mut halves = [[0.0; 3]; 2];
    for a in 0..3 {
        let x = delta[a];
        let (left, right) = if left_share >= 0.5 {
            let left = part(x, left_share);
            (left, x - left)
        } else {
            let right = part(x, 1.0 - left_share);
            (x - right, right)
        };
        halves[0][a] = left;
        halves[1][a] = right;
    }
    halves
}

fn best_plane(pairs: &[(Point, Point)]) -> MirrorPlane {
    let p0 = centroid(pairs.iter().map(|(p, _)| *p));
    let q0 = centroid(pairs.iter().map(|(_, q)| *q));
    let products = sum_of_products(pairs.iter().map(|(p, q)| (*p - p0, *q - q0)));
    let [normal, ..] = eigenvectors(&((products + products.transpose()) * 0.5));
    MirrorPlane::through(p0 + (q0 - p0) * 0.5, normal)
}

/// Sum of p q^T.
fn sum_of_products(pairs: impl Iterator<Item = (Displacement, Displacement)>) -> DMat3 {
    pairs.fold(DMat3::ZERO, |sum, (p, q)| sum + DMat3::from_cols(p.0 * q.x, p.0 * q.y, p.0 * q.z))
}

/// Points in cubes, for the nearest one.
struct Grid<'a> {
    points: &'a [Point],
    size: f64,
    cubes: HashMap<[i64; 3], Vec<usize>>,
}

impl<'a> Grid<'a> {
    fn new(points: &'a [Point]) -> Grid<'a> {
        let low = points.iter().fold(DVec3::INFINITY, |low, p| low.min(p.0));
        let high = points.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(p.0));
        // A surface of n points in a box of this diagonal: a few points a cube.
        let size = (high - low).length() / (points.len() as f64).sqrt() + f64::MIN_POSITIVE;
        let mut cubes: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (i, p) in points.iter().enumerate() {
            cubes.entry(cube_of(*p, size)).or_default().push(i);
        }
        Grid { points, size, cubes }
    }

    /// The nearest point.
    fn nearest(&self, p: Point) -> Point {
        self.points[self.nearest_number(p).0]
    }

    /// The number of the nearest point and its distance: rings of cubes until no nearer one can come;
    /// after some empty rings all points are looked at.
    fn nearest_number(&self, p: Point) -> (usize, f64) {
        let home = cube_of(p, self.size);
        let mut best = (0, f64::INFINITY);
        for ring in 0..6_i64 {
            for dx in -ring..=ring {
                for dy in -ring..=ring {
                    for dz in -ring..=ring {
                        if dx.abs().max(dy.abs()).max(dz.abs()) != ring {
                            continue;
                        }
                        let cube = [home[0] + dx, home[1] + dy, home[2] + dz];
                        for &i in self.cubes.get(&cube).into_iter().flatten() {
                            let distance = (self.points[i] - p).length();
                            if distance < best.1 {
                                best = (i, distance);
                            }
                        }
                    }
                }
            }
            if best.1 <= ring as f64 * self.size {
                return best;
            }
        }
        for (i, q) in self.points.iter().enumerate() {
            let distance = (*q - p).length();
            if distance < best.1 {
                best = (i, distance);
            }
        }
        best
    }
}

/// The cube that a point lies in.
fn cube_of(p: Point, size: f64) -> [i64; 3] {
    p.to_array().map(|x| (x / size).floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_geometry::{DQuat, RigidMotion};

    /// A lopsided half face and its mirror image in x = 0.
    fn face() -> Vec<Point> {
        let mut points = Vec::new();
        for i in 0..25 {
            for j in 0..30 {
                let (x, y) = (0.003 * f64::from(i), 0.007 * f64::from(j) - 0.1);
                let z =
                    0.09 - 9.0 * x * x - 3.0 * y * y + 0.01 * (40.0 * y).sin() * (50.0 * x).cos();
                points.push(Point::new(x, y, z));
                if i > 0 {
                    points.push(Point::new(-x, y, z));
                }
            }
        }
        points
    }

    #[test]
    fn a_planted_plane_is_found() {
        let turn = DQuat::from_xyzw(0.05, -0.08, 0.07, 0.9924).normalize();
        let motion = RigidMotion::turn(turn).then_by(Displacement::new(0.02, -0.3, 1.0));
        let moved: Vec<Point> = face().iter().map(|&p| motion.apply(p)).collect();
        let plane = MirrorPlane::find(&moved).unwrap();
        let planted = motion.rotate(Displacement(DVec3::X));
        assert!((plane.normal - planted).length() < 1e-3, "{plane:?} {planted:?}");
        assert!(plane.distance(motion.apply(Point::ORIGIN)).abs() < 1e-4);
        assert!(plane.asymmetry < 2e-4);
        let again = plane.mirror(plane.mirror(moved[7]));
        assert!((again - moved[7]).length() < 1e-15);
    }

    #[test]
    fn half_a_face_is_refused() {
        let half: Vec<Point> =
            face()
                .into_iter()
                .map(|p| {
                    if p.x < 0.0 {
                        Point::new(p.x, p.y, p.z + 0.06 * (90.0 * p.y).sin())
                    } else {
                        p
                    }
                })
                .collect();
        assert!(matches!(MirrorPlane::find(&half), Err(MirrorError::NotSymmetric(_))));
        assert_eq!(MirrorPlane::find(&half[..3]), Err(MirrorError::TooFew(3)));
    }

    #[test]
    fn halves_add_up_to_the_shape_bit_for_bit() {
        let plane = MirrorPlane::SAGITTAL;
        let deltas = crate::linear_algebra::dense::numbers(3000, 0.9);
        for (i, d) in deltas.chunks_exact(3).enumerate() {
            let delta = [d[0] as f32 * 0.01, d[1] as f32 * 1e-5, d[2] as f32];
            let x = (i as f64 / 1000.0 - 0.5) * 0.03;
            let share = plane.left_share(Point::new(x, 0.0, 0.0), 0.008);
            let [left, right] = split_delta(delta, share);
            for a in 0..3 {
                assert_eq!((left[a] + right[a]).to_bits(), delta[a].to_bits(), "{share}");
            }
            match share {
                0.0 => assert_eq!(left, [0.0; 3]),
                1.0 => assert_eq!(right, [0.0; 3]),
                _ => assert!(left != [0.0; 3] && right != [0.0; 3]),
            }
        }
        // The share passes smoothly from one half to the other.
        let share = |x: f64| plane.left_share(Point::new(x, 0.0, 0.0), 0.008);
        assert_eq!((share(-0.01), share(0.0), share(0.01)), (0.0, 0.5, 1.0));
        for i in -100..100 {
            let x = f64::from(i) * 1e-4;
            let slope = (share(x + 1e-6) - share(x)) / 1e-6;
            let next = (share(x + 1e-4 + 1e-6) - share(x + 1e-4)) / 1e-6;
            assert!(slope >= 0.0 && (slope - next).abs() < 0.05 / 0.008);
            assert!((share(x) + share(-x) - 1.0).abs() < 1e-15);
        }
    }
}
