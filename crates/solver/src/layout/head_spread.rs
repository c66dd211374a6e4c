//! Which markers tell the pose of a head best: the error that their noise makes on the face.
//!
//! A small motion of the head, translation and turn about the centroid c of its markers, moves a point x by
//! J(x) = \[I, -\[x - c\]x\] times six numbers. Least squares over markers with noise sigma leaves those six a
//! covariance of sigma^2 M^-1, M = sum of J^T J over the markers, so a point of the face the error
//! sigma^2 tr(J M^-1 J^T).

use mimique_geometry::{DMat3, DVec3, Point, centroid};

/// Directions in which a set of head markers has less than this share of its largest extent are no extent.
const THIN: f64 = 1e-9;
/// Rounds of exchange; each lowers the error, and a few are enough.
const MOST_ROUNDS: usize = 50;

/// The moments of a face: all that the error of a pose needs of it, however many points it has.
#[derive(Debug, Clone, Copy)]
pub struct FaceMoments {
    count: f64,
    mean: Point,
    /// Sum of |x|^2 I - x x^T about the mean.
    about_mean: DMat3,
}

impl FaceMoments {
    /// Of the points of a face.
    pub fn of(face: &[Point]) -> Self {
        let mean = centroid(face.iter().copied());
        let about_mean = face.iter().fold(DMat3::ZERO, |sum, x| sum + inertia((*x - mean).0));
        Self { count: face.len() as f64, mean, about_mean }
    }
}

/// |x|^2 I - x x^T, which is \[x\]x^T \[x\]x.
fn inertia(x: DVec3) -> DMat3 {
    let outer = DMat3::from_cols(x * x.x, x * x.y, x * x.z);
    DMat3::from_diagonal(DVec3::splat(x.length_squared())) - outer
}

/// Root of the mean over the face of the square error that the pose of the head puts on it, in the unit of
/// `noise`, the standard deviation of the head markers. None for fewer than three markers, markers in a
/// line, or a face without points.
pub fn head_error(heads: &[Point], face: &FaceMoments, noise: f64) -> Option<f64> {
    if heads.len() < 3 || face.count == 0.0 {
        return None;
    }
    let centre = centroid(heads.iter().copied());
    // About the centroid translation and turn do not meet: M = diag(n I, T).
    let turn = heads.iter().fold(DMat3::ZERO, |sum, p| sum + inertia((*p - centre).0));
    let scale = turn.x_axis.x + turn.y_axis.y + turn.z_axis.z;
    if !(turn.determinant() > THIN * scale * scale * scale) {
        return None;
    }
    // The sum of tr([x]x T^-1 [x]x^T) over the face is tr(T^-1 sum of [x]x^T [x]x).
    let face_about = face.about_mean + inertia((face.mean - centre).0) * face.count;
    let product = turn.inverse() * face_about;
    let of_turn = (product.x_axis.x + product.y_axis.y + product.z_axis.z) / face.count;
    Some(noise * (3.0 / heads.len() as f64 + of_turn).sqrt())
}

/// Which `count` of `candidates` have the least [`head_error`]: farthest points, then exchanged one by one
/// as long as that lowers the error. `fits` says whether a candidate may stand beside others. None where no
/// set of `count`, three at least, fits or tells a pose.
pub fn best_heads(
    candidates: &[Point],
    face: &FaceMoments,
    count: usize,
    fits: &dyn Fn(&[usize], usize) -> bool,
) -> Option<Vec<usize>> {
    let mut best: Option<(f64, Vec<usize>)> = None;
    // From each of the eight corners of the box around them: a start of its own.
    for corner in 0..8_u32 {
        let sign = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let direction = DVec3::new(sign(0), sign(1), sign(2));
        let first = (0..candidates.len())
            .max_by(|&a, &b| {
                let along = |i: usize| candidates[i].0.dot(direction);
                along(a).total_cmp(&along(b)).then(b.cmp(&a))
            })
            .filter(|&first| fits(&[], first));
        let Some(mut heads) = first.and_then(|first| spread(candidates, first, count, fits)) else {
            continue;
        };
        let Some(error) = exchange(candidates, face, &mut heads, fits) else { continue };
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            best = Some((error, heads));
        }
    }
    best.map(|(_, heads)| heads)
}

/// Farthest points from a first one.
fn spread(
    candidates: &[Point],
    first: usize,
    count: usize,
    fits: &dyn Fn(&[usize], usize) -> bool,
) -> Option<Vec<usize>> {
    let mut heads = vec![first];
    let mut far: Vec<f64> = candidates.iter().map(|p| (*p - candidates[first]).length()).collect();
    while heads.len() < count {
        let free = (0..candidates.len()).filter(|i| !heads.contains(i) && fits(&heads, *i));
        let next = free.reduce(|best, i| if far[i] > far[best] { i } else { best })?;
        for (far, p) in far.iter_mut().zip(candidates) {
            *far = far.min((*p - candidates[next]).length());
        }
        heads.push(next);
    }
    Some(heads)
}

/// Exchanges single markers as long as that lowers the error; gives it.
fn exchange(
    candidates: &[Point],
    face: &FaceMoments,
    heads: &mut [usize],
    fits: &dyn Fn(&[usize], usize) -> bool,
) -> Option<f64> {
    let error = |heads: &[usize]| {
        let points: Vec<Point> = heads.iter().map(|&i| candidates[i]).collect();
        head_error(&points, face, 1.0).unwrap_or(f64::INFINITY)
    };
    let mut least = error(heads);
    for _ in 0..MOST_ROUNDS {
        let mut better = false;
        for place in 0..heads.len() {
            let others: Vec<usize> =
                heads.iter().enumerate().filter(|(i, _)| *i != place).map(|(_, &h)| h).collect();
            for other in 0..candidates.len() {
                if heads.contains(&other) || !fits(&others, other) {
                    continue;
                }
                let was = std::mem::replace(&mut heads[place], other);
                let now = error(heads);
                if now < least * (1.0 - 1e-12) {
                    (least, better) = (now, true);
                } else {
                    heads[place] = was;
                }
            }
        }
        if !better {
            break;
        }
    }
    least.is_finite().then_some(least)
}
