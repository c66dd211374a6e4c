//! The middle plane of a face, and a symmetric shape cut in two along it (Kouadio 4.5, figure
//! 4.18): an artist models one symmetric expression, the bank gets its left and right halves.

use std::collections::HashMap;

use crate::marker_site::{difference, inner, length};
use crate::rigid_alignment::eigenvectors;
use crate::skin_mesh::SkinMesh;

/// The plane n . x = offset, n towards the person's left (+X).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MirrorPlane {
    /// Unit normal.
    pub normal: [f64; 3],
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
        MirrorPlane { normal: [1.0, 0.0, 0.0], offset: 0.0, asymmetry: 0.0 };

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
    pub fn find(positions: &[[f64; 3]]) -> Result<MirrorPlane, MirrorError> {
        if positions.len() < 4 {
            return Err(MirrorError::TooFew(positions.len()));
        }
        let step = positions.len().div_ceil(SAMPLES);
        let samples: Vec<[f64; 3]> = positions.iter().step_by(step).copied().collect();
        let grid = Grid::new(positions);
        let centre = mean(positions);
        let mut spread = [[0.0; 3]; 3];
        for p in positions {
            let p = difference(*p, centre);
            for i in 0..3 {
                for j in 0..3 {
                    spread[i][j] += p[i] * p[j];
                }
            }
        }
        let mut best: Option<MirrorPlane> = None;
        for axis in eigenvectors(&spread).into_iter().chain([[1.0, 0.0, 0.0]]) {
            if axis[0].abs() < std::f64::consts::FRAC_1_SQRT_2 {
                continue;
            }
            let normal = if axis[0] < 0.0 { axis.map(|x| -x) } else { axis };
            let start = MirrorPlane { normal, offset: inner(normal, centre), asymmetry: 0.0 };
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

    fn refined(self, samples: &[[f64; 3]], grid: &Grid<'_>) -> MirrorPlane {
        let mut plane = self;
        // A few rounds do; 50 is a guard.
        for _ in 0..50 {
            let pairs: Vec<([f64; 3], [f64; 3])> =
                samples.iter().map(|&p| (p, grid.nearest(plane.mirror(p)))).collect();
            let next = best_plane(&pairs);
            let moved =
                length(difference(next.normal, plane.normal)) + (next.offset - plane.offset).abs();
            plane = next;
            if moved < 1e-9 {
                break;
            }
        }
        let squares: f64 = samples
            .iter()
            .map(|&p| {
                let m = plane.mirror(p);
                let d = difference(m, grid.nearest(m));
                inner(d, d)
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
    pub fn distance(&self, p: [f64; 3]) -> f64 {
        inner(self.normal, p) - self.offset
    }

    /// The mirror image.
    pub fn mirror(&self, p: [f64; 3]) -> [f64; 3] {
        let d = 2.0 * self.distance(p);
        std::array::from_fn(|a| p[a] - d * self.normal[a])
    }

    /// How much of a shape at `p` belongs to the left half: 0 on the right, 1/2 on the plane, 1 on
    /// the left, 3t^2 - 2t^3 over the strip of half-width `fall_off` (metres) between.
    pub fn left_share(&self, p: [f64; 3], fall_off: f64) -> f64 {
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

fn best_plane(pairs: &[([f64; 3], [f64; 3])]) -> MirrorPlane {
    let count = pairs.len() as f64;
    let (mut p0, mut q0) = ([0.0; 3], [0.0; 3]);
    for (p, q) in pairs {
        for a in 0..3 {
            p0[a] += p[a] / count;
            q0[a] += q[a] / count;
        }
    }
    let mut m = [[0.0; 3]; 3];
    for (p, q) in pairs {
        let (p, q) = (difference(*p, p0), difference(*q, q0));
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] += 0.5 * (p[i] * q[j] + p[j] * q[i]);
            }
        }
    }
    let [mut normal, ..] = eigenvectors(&m);
    if normal[0] < 0.0 {
        normal = normal.map(|x| -x);
    }
    let middle: [f64; 3] = std::array::from_fn(|a| 0.5 * (p0[a] + q0[a]));
    MirrorPlane { normal, offset: inner(normal, middle), asymmetry: 0.0 }
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for p in points {
        for a in 0..3 {
            sum[a] += p[a];
        }
    }
    sum.map(|x| x / points.len() as f64)
}

/// Points in cubes, for the nearest one.
struct Grid<'a> {
    points: &'a [[f64; 3]],
    size: f64,
    cubes: HashMap<[i64; 3], Vec<usize>>,
}

impl<'a> Grid<'a> {
    fn new(points: &'a [[f64; 3]]) -> Grid<'a> {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for p in points {
            for a in 0..3 {
                low[a] = low[a].min(p[a]);
                high[a] = high[a].max(p[a]);
            }
        }
        // A surface of n points in a box of this diagonal: a few points a cube.
        let size = length(difference(high, low)) / (points.len() as f64).sqrt() + f64::MIN_POSITIVE;
        let mut cubes: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
        for (i, p) in points.iter().enumerate() {
            cubes.entry(p.map(|x| (x / size).floor() as i64)).or_default().push(i);
        }
        Grid { points, size, cubes }
    }

    /// The nearest point: rings of cubes until no nearer one can come; after some empty rings all
    /// points are looked at.
    fn nearest(&self, p: [f64; 3]) -> [f64; 3] {
        let home = p.map(|x| (x / self.size).floor() as i64);
        let mut best = (f64::INFINITY, self.points[0]);
        for ring in 0..6_i64 {
            for dx in -ring..=ring {
                for dy in -ring..=ring {
                    for dz in -ring..=ring {
                        if dx.abs().max(dy.abs()).max(dz.abs()) != ring {
                            continue;
                        }
                        let cube = [home[0] + dx, home[1] + dy, home[2] + dz];
                        for &i in self.cubes.get(&cube).into_iter().flatten() {
                            let distance = length(difference(self.points[i], p));
                            if distance < best.0 {
                                best = (distance, self.points[i]);
                            }
                        }
                    }
                }
            }
            if best.0 <= ring as f64 * self.size {
                return best.1;
            }
        }
        for q in self.points {
            let distance = length(difference(*q, p));
            if distance < best.0 {
                best = (distance, *q);
            }
        }
        best.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RigidMotion;

    /// A lopsided half face and its mirror image in x = 0.
    fn face() -> Vec<[f64; 3]> {
        let mut points = Vec::new();
        for i in 0..25 {
            for j in 0..30 {
                let (x, y) = (0.003 * f64::from(i), 0.007 * f64::from(j) - 0.1);
                let z =
                    0.09 - 9.0 * x * x - 3.0 * y * y + 0.01 * (40.0 * y).sin() * (50.0 * x).cos();
                points.push([x, y, z]);
                if i > 0 {
                    points.push([-x, y, z]);
                }
            }
        }
        points
    }

    #[test]
    fn a_planted_plane_is_found() {
        let turn = RigidMotion::from_quaternion([0.9924, 0.05, -0.08, 0.07].map(|x| x / 0.9998));
        let motion = RigidMotion { translation: [0.02, -0.3, 1.0], ..turn };
        let moved: Vec<[f64; 3]> = face().iter().map(|&p| motion.apply(p)).collect();
        let plane = MirrorPlane::find(&moved).unwrap();
        let planted = motion.rotate([1.0, 0.0, 0.0]);
        assert!(length(difference(plane.normal, planted)) < 1e-3, "{plane:?} {planted:?}");
        assert!(plane.distance(motion.translation).abs() < 1e-4);
        assert!(plane.asymmetry < 2e-4);
        let again = plane.mirror(plane.mirror(moved[7]));
        assert!(length(difference(again, moved[7])) < 1e-15);
    }

    #[test]
    fn half_a_face_is_refused() {
        let half: Vec<[f64; 3]> = face()
            .into_iter()
            .map(|p| if p[0] < 0.0 { [p[0], p[1], p[2] + 0.06 * (90.0 * p[1]).sin()] } else { p })
            .collect();
        assert!(matches!(MirrorPlane::find(&half), Err(MirrorError::NotSymmetric(_))));
        assert_eq!(MirrorPlane::find(&half[..3]), Err(MirrorError::TooFew(3)));
    }

    #[test]
    fn halves_add_up_to_the_shape_bit_for_bit() {
        let plane = MirrorPlane::SAGITTAL;
        let deltas = crate::dense::numbers(3000, 0.9);
        for (i, d) in deltas.chunks_exact(3).enumerate() {
            let delta = [d[0] as f32 * 0.01, d[1] as f32 * 1e-5, d[2] as f32];
            let x = (i as f64 / 1000.0 - 0.5) * 0.03;
            let share = plane.left_share([x, 0.0, 0.0], 0.008);
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
        let share = |x: f64| plane.left_share([x, 0.0, 0.0], 0.008);
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
