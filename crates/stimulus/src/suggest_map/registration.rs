//! Points laid on a surface by a similarity, from every way up and round: iterated closest points
//! (Besl and McKay 1992), the farthest left out, the best of all starts.

use mimique_geometry::{DQuat, Point, RigidMotion, align_rigidly, centroid};

use super::anchors::Anchors;

/// Vertices that the search looks at; the last steps look at all.
const COARSE: usize = 1_200;
/// Steps of each start, and at the end.
const STEPS: usize = 25;
/// Share of the points that must fit: the rest may be on a headband.
const KEPT: f64 = 0.85;
/// Sizes of faces differ by less.
const SCALES: [f64; 2] = [0.8, 1.25];
/// Millimetres of distance that a whole unit of agreement is worth.
const AGREEMENT_MM: f64 = 4.0;
/// Share of the distance of places that labels name.
const ANCHOR_SHARE: f64 = 0.25;
/// Turns about the vertical that are tried.
const TURNS: usize = 8;

/// A similarity from the points to the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Similarity {
    /// Size.
    pub scale: f64,
    motion: RigidMotion,
    /// What the caller's judgement said of it.
    pub agreement: f64,
    rms: f64,
    anchor_rms: f64,
}

impl From<RigidMotion> for Similarity {
    fn from(motion: RigidMotion) -> Self {
        let unknown = f64::INFINITY;
        Self { scale: 1.0, motion, agreement: 0.0, rms: unknown, anchor_rms: 0.0 }
    }
}

impl Similarity {
    /// Where a point comes to lie.
    pub fn apply(&self, p: Point) -> Point {
        self.motion.apply(p.map(|x| x * self.scale))
    }

    /// Lower is better, millimetres.
    fn cost(&self) -> f64 {
        1e3 * (self.rms + ANCHOR_SHARE * self.anchor_rms) - AGREEMENT_MM * self.agreement
    }
}

/// Lays `points` on `surface` (both metres), drawn to the `anchors`; `judge` says from the nearest vertices (indices into
/// `surface`) how likely a way of lying is, -1 to 1.
pub(super) fn register(
    points: &[Point],
    surface: &[Point],
    anchors: &Anchors,
    judge: &dyn Fn(&[usize]) -> f64,
) -> Similarity {
    let step = surface.len().div_ceil(COARSE);
    let coarse: Vec<usize> = (0..surface.len()).step_by(step.max(1)).collect();
    let places: Vec<Point> = coarse.iter().map(|&v| surface[v]).collect();
    let [from, to] = [points, surface].map(|all| centroid(all.iter().copied()));
    let mut best: Option<Similarity> = None;
    let by_form = starts()
        .into_iter()
        .map(|rotation| RigidMotion { translation: to - rotation.apply(from), ..rotation });
    let by_labels = align_rigidly(&anchors.actor, &anchors.avatar).ok();
    for motion in by_labels.into_iter().chain(by_form) {
        let (mut fit, nearest) = settle(points, &places, anchors, Similarity::from(motion));
        let nearest: Vec<usize> = nearest.into_iter().map(|v| coarse[v]).collect();
        fit.agreement = judge(&nearest);
        if best.as_ref().is_none_or(|b| fit.cost() < b.cost()) {
            best = Some(fit);
        }
    }
    let start = best.unwrap_or(Similarity::from(RigidMotion::IDENTITY));
    let (mut fit, nearest) = settle(points, surface, anchors, start);
    fit.agreement = judge(&nearest);
    fit
}

/// Every axis upwards, and turns about it.
fn starts() -> Vec<RigidMotion> {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // Quaternions (x, y, z, w) that bring +Y, -Y, +Z, -Z, +X, -X upwards.
    let ups = [
        [0.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 0.0],
        [-half, 0.0, 0.0, half],
        [half, 0.0, 0.0, half],
        [0.0, 0.0, half, half],
        [0.0, 0.0, -half, half],
    ];
    let turn = |i: usize| {
        let angle = std::f64::consts::PI * i as f64 / TURNS as f64;
        RigidMotion::turn(DQuat::from_xyzw(0.0, angle.sin(), 0.0, angle.cos()))
    };
    let up = ups.map(|up| RigidMotion::turn(DQuat::from_array(up)));
    (0..TURNS).flat_map(|i| up.iter().map(move |u| turn(i).after(u))).collect()
}

/// Iterated closest points; the similarity and the nearest place of every point.
fn settle(
    points: &[Point],
    surface: &[Point],
    anchors: &Anchors,
    mut fit: Similarity,
) -> (Similarity, Vec<usize>) {
    let mut nearest = vec![0; points.len()];
    for _ in 0..STEPS {
        let laid: Vec<Point> = points.iter().map(|&p| fit.apply(p)).collect();
        let mut order: Vec<(usize, f64)> = Vec::with_capacity(points.len());
        for (m, p) in laid.iter().enumerate() {
            let (v, square) = closest(*p, surface);
            nearest[m] = v;
            order.push((m, square));
        }
        order.sort_by(|a, b| a.1.total_cmp(&b.1));
        let kept = ((KEPT * points.len() as f64).ceil() as usize).clamp(3, points.len());
        let kept = &order[..kept.min(order.len())];
        let rms = (kept.iter().map(|(_, d)| d).sum::<f64>() / kept.len() as f64).sqrt();
        let (mut from, mut to): (Vec<Point>, Vec<Point>) =
            kept.iter().map(|&(m, _)| (points[m], surface[nearest[m]])).unzip();
        let mut square = 0.0;
        for ((&p, &q), &weight) in anchors.actor.iter().zip(&anchors.avatar).zip(&anchors.weight) {
            square += (fit.apply(p) - q).length_squared();
            from.extend(std::iter::repeat_n(p, weight));
            to.extend(std::iter::repeat_n(q, weight));
        }
        let anchor_rms = (square / anchors.actor.len().max(1) as f64).sqrt();
        let Ok(motion) = align_rigidly(&from, &to) else { break };
        let settled = (fit.rms - rms).abs() < 1e-7;
        fit = similarity(&from, &to, motion);
        (fit.rms, fit.anchor_rms) = (rms, anchor_rms);
        if settled {
            break;
        }
    }
    (fit, nearest)
}

/// The motion with the size of the one set in units of the other's. Their spreads say it: the least
/// squares' own size shrinks with every step, as nearest points are never too far.
pub(super) fn similarity(from: &[Point], to: &[Point], motion: RigidMotion) -> Similarity {
    let [a, b] = [from, to].map(|all| centroid(all.iter().copied()));
    let spread = |points: &[Point], centre: Point| -> f64 {
        points.iter().map(|p| (*p - centre).length_squared()).sum()
    };
    let (actor, avatar) = (spread(from, a), spread(to, b));
    let scale = if actor > 0.0 { (avatar / actor).sqrt().clamp(SCALES[0], SCALES[1]) } else { 1.0 };
    let turned = RigidMotion { rotation: motion.rotation, ..RigidMotion::IDENTITY };
    let translation = b - turned.apply(a.map(|x| x * scale));
    Similarity { scale, ..Similarity::from(RigidMotion { translation, ..motion }) }
}

fn closest(p: Point, surface: &[Point]) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (v, q) in surface.iter().enumerate() {
        let square = (p - *q).length_squared();
        if square < best.1 {
            best = (v, square);
        }
    }
    best
}
