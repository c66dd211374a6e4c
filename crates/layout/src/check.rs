//! What a marker map cannot see, before a session begins: shapes, parts of the face, millimetres.
//!
//! Shapes and rules are `mimique_stimulus::BankDiagnosis`, the engine of `mimique inspect --bank`; what stays
//! unknown of the weights with all markers is that of the greedy choice; what misplacement does is rehearsed.

use mimique_geometry::Point;
use mimique_solver::{MarkerSite, Method, MethodSpec, head_error};
use mimique_stimulus::BankDiagnosis;
use serde::Serialize;

use crate::candidates::{MOVED_M, gaze_shapes, seen};
use crate::curve::ExpectedCurve;
use crate::error::LayoutError;
use crate::face::{Face, FacePart};
use crate::layout::{choose_heads, face_moments};
use crate::motion::FaceMotion;
use crate::rehearsal::{Conditions, Effort, Rehearsal};
use crate::spacing::Spacing;

/// A shape is told of where markers leave more of its variance than this.
const HARDLY_TOLD: f64 = 0.5;
/// Head markers whose error is this much larger than that of the best ones are told of.
const WORSE_HEAD: f64 = 1.5;

/// What a check counts with.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckOptions {
    /// Standard deviations of noise and of places, metres.
    pub noise: f64,
    /// See `noise`.
    pub slip: f64,
    /// Noise of head markers, metres.
    pub head_noise: f64,
    /// Smoothing that is advised where markers are put by hand.
    pub smoothing: f64,
    /// Seed of the rehearsal.
    pub seed: u64,
}

/// What the markers tell of a shape.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ShapeSight {
    /// The shape.
    pub shape: String,
    /// How far it moves the marker that it moves most, millimetres.
    pub at_markers_mm: f64,
    /// How far it moves the skin, millimetres.
    pub on_skin_mm: f64,
    /// Share of the weight's variance that the markers take away.
    pub told: f64,
}

/// What the markers tell of a part of the face.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PartSight {
    /// The part.
    pub part: FacePart,
    /// Markers on it.
    pub markers: usize,
    /// How far its vertices move, root mean square, millimetres.
    pub moves_mm: f64,
    /// What of that stays unknown with all markers, millimetres.
    pub unknown_mm: f64,
    /// How far the moved and seen vertex that is farthest from every marker is from it, millimetres.
    pub farthest_mm: f64,
}

/// The two markers that come nearest to each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct NearestPair {
    /// Their labels.
    pub labels: [String; 2],
    /// Their distance on the neutral face, millimetres.
    pub at_rest_mm: f64,
}

/// What the head's markers do.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct HeadSight {
    /// How many there are whose places are known.
    pub markers: usize,
    /// Root mean square error on the face by their noise, millimetres; null where they do not tell a pose.
    pub error_mm: Option<f64>,
    /// The same of as many at the best places.
    pub best_mm: Option<f64>,
    /// Whether they sit so that another place would be much better: on one side, or in one line.
    pub one_sided: bool,
}

/// What happens where markers are put by hand.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct PlacementSight {
    /// Error of a vertex with markers at their places, millimetres.
    pub exact_mm: f64,
    /// With markers beside them.
    pub put_mm: f64,
    /// The same with the adaptation of shape smoothed.
    pub smoothed_mm: f64,
}

/// What a map sees.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MapCheck {
    /// The rules of the bank at the markers.
    pub bank: BankDiagnosis,
    /// Shapes that turn the eyes: no marker on skin tells a gaze.
    pub gaze: Vec<String>,
    /// Other shapes of which the markers tell less than half, worst first.
    pub hardly_told: Vec<ShapeSight>,
    /// The parts of the face.
    pub parts: Vec<PartSight>,
    /// What stays unknown of the whole face, root mean square, millimetres.
    pub unknown_mm: f64,
    /// How far it moves.
    pub moves_mm: f64,
    /// The nearest pair.
    pub nearest: Option<NearestPair>,
    /// The head's markers, where places of some are known.
    pub head: Option<HeadSight>,
    /// What misplacement does; null where the markers cannot be solved.
    pub placement: Option<PlacementSight>,
}

impl MapCheck {
    /// Of markers on a face, and of head markers whose places are known.
    ///
    /// # Errors
    /// [`LayoutError::NoMotion`] for a bank that moves nothing.
    pub fn of(
        face: &Face<'_>,
        motion: &FaceMotion,
        sites: &[MarkerSite],
        heads: &[Point],
        options: &CheckOptions,
    ) -> Result<Self, LayoutError> {
        let vertices: Vec<usize> = sites.iter().map(MarkerSite::vertex).collect();
        let mut curve = ExpectedCurve::new(motion, options.noise, options.slip);
        let errors = curve.of(&face.gradients, motion, &vertices);
        let before = motion.prior();
        if errors[0].is_nan() || errors[0] <= 0.0 {
            return Err(LayoutError::NoMotion);
        }
        let after = curve.covariance();
        let mm = |square: f64| 1e3 * square.max(0.0).sqrt();
        let trace = |gram: &[f64], s: &[f64]| gram.iter().zip(s).map(|(g, s)| g * s).sum::<f64>();
        let moved: Vec<usize> =
            (0..face.skin.mesh.positions.len()).filter(|&v| face.reach[v] >= MOVED_M).collect();
        let seen = seen(face);
        let mut parts = Vec::new();
        for part in FacePart::ALL {
            let own: Vec<usize> = moved.iter().copied().filter(|&v| face.part(v) == part).collect();
            if own.is_empty() {
                continue;
            }
            let gram = motion.basis.gram_of(&own);
            let distance = |v: usize| {
                let far = |m: &usize| (face.place(*m) - face.place(v)).length();
                vertices.iter().map(far).fold(f64::INFINITY, f64::min)
            };
            let apart = own.iter().filter(|&&v| seen[v]).map(|&v| distance(v));
            parts.push(PartSight {
                part,
                markers: vertices.iter().filter(|&&v| face.part(v) == part).count(),
                moves_mm: mm(trace(&gram, &before)),
                unknown_mm: mm(trace(&gram, after)),
                farthest_mm: 1e3 * apart.fold(0.0, f64::max),
            });
        }
        Ok(Self {
            bank: BankDiagnosis::of(face.skin, Some(sites)),
            gaze: gaze_shapes(face).iter().map(|&k| face.skin.shape_names[k].clone()).collect(),
            hardly_told: hardly_told(face, motion, &vertices, &before, after),
            parts,
            unknown_mm: mm(trace(&motion.basis.gram, after)),
            moves_mm: mm(trace(&motion.basis.gram, &before)),
            nearest: nearest(face, sites),
            head: head(face, &vertices, heads, options.head_noise),
            placement: placement(face, motion, &vertices, options),
        })
    }
}

/// The shapes of which markers take less than half of the variance away.
fn hardly_told(
    face: &Face<'_>,
    motion: &FaceMotion,
    vertices: &[usize],
    before: &[f64],
    after: &[f64],
) -> Vec<ShapeSight> {
    let (n, w) = (face.shape_count(), motion.basis.width);
    let gaze = gaze_shapes(face);
    let length = |v: usize, k: usize| {
        let rows = face.deltas_of(v);
        let [x, y, z] = [rows[k], rows[n + k], rows[2 * n + k]];
        (x * x + y * y + z * z).sqrt()
    };
    let mut found: Vec<ShapeSight> = (0..n)
        .filter(|k| !gaze.contains(k))
        .map(|k| {
            let skin = &face.skin.mesh.shapes[k].deltas;
            let most = |lengths: &mut dyn Iterator<Item = f64>| lengths.fold(0.0, f64::max);
            ShapeSight {
                shape: face.skin.shape_names[k].clone(),
                at_markers_mm: 1e3 * most(&mut vertices.iter().map(|&v| length(v, k))),
                on_skin_mm: 1e3 * most(&mut skin.iter().map(|d| d.length())),
                told: 1.0 - after[k * w + k] / before[k * w + k].max(f64::MIN_POSITIVE),
            }
        })
        .filter(|sight| sight.on_skin_mm >= 1e3 * MOVED_M && sight.told < HARDLY_TOLD)
        .collect();
    found.sort_by(|a, b| a.told.total_cmp(&b.told).then_with(|| a.shape.cmp(&b.shape)));
    found
}

fn nearest(face: &Face<'_>, sites: &[MarkerSite]) -> Option<NearestPair> {
    let places: Vec<Point> = sites.iter().map(|site| site.position(&face.skin.mesh)).collect();
    let mut found: Option<(f64, [usize; 2])> = None;
    for i in 0..places.len() {
        for j in 0..i {
            let distance = (places[i] - places[j]).length();
            if found.is_none_or(|(least, _)| distance < least) {
                found = Some((distance, [j, i]));
            }
        }
    }
    found.map(|(distance, pair)| NearestPair {
        labels: pair.map(|i| sites[i].label.clone()),
        at_rest_mm: 1e3 * distance,
    })
}

fn head(face: &Face<'_>, taken: &[usize], heads: &[Point], noise: f64) -> Option<HeadSight> {
    if heads.is_empty() {
        return None;
    }
    let error = head_error(heads, &face_moments(face), noise);
    let spacing = Spacing::at_rest(face, 0.008);
    let best = choose_heads(face, &spacing, taken, heads.len().max(3), noise).ok();
    let best = best.map(|heads| heads.error);
    let one_sided = match (error, best) {
        (None, _) => true,
        (Some(error), Some(best)) => error > WORSE_HEAD * best,
        (Some(_), None) => false,
    };
    let mm = |metres: f64| 1e3 * metres;
    let (error_mm, best_mm) = (error.map(mm), best.map(mm));
    Some(HeadSight { markers: heads.len(), error_mm, best_mm, one_sided })
}

/// The error with markers at their places, beside them, and beside them with smoothing.
fn placement(
    face: &Face<'_>,
    motion: &FaceMotion,
    vertices: &[usize],
    options: &CheckOptions,
) -> Option<PlacementSight> {
    let rehearsed = |slip: f64, smoothing: f64| {
        let mut spec = MethodSpec::new(Method::Lsts);
        spec.rbf_smoothing = Some(smoothing);
        let conditions = Conditions { noise: options.noise, slip, others: slip > 0.0 };
        let seed = options.seed;
        let rehearsal = Rehearsal::new(face, motion, None, &spec, conditions, Effort::SEARCH, seed);
        rehearsal.mean_square(vertices).ok().map(|square| 1e3 * square.sqrt())
    };
    Some(PlacementSight {
        exact_mm: rehearsed(0.0, 0.0)?,
        put_mm: rehearsed(options.slip, 0.0)?,
        smoothed_mm: rehearsed(options.slip, options.smoothing)?,
    })
}
