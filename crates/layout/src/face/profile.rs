//! The profile of a face: where the middle plane cuts the skin.

use mimique_geometry::Point;
use mimique_solver::{MirrorPlane, SkinMesh};

/// Height of a step of the profile, metres.
const STEP_M: f64 = 0.001;

/// The foremost point of the skin in the middle plane at each height.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Profile {
    /// From below to above.
    points: Vec<Point>,
}

impl Profile {
    /// Of a skin whose front is +Z.
    pub(super) fn of(mesh: &SkinMesh, plane: &MirrorPlane) -> Self {
        let mut foremost: std::collections::BTreeMap<i64, Point> = Default::default();
        for t in &mesh.triangles {
            let corners = t.map(|v| mesh.positions[v as usize]);
            let Some([a, b]) = cut(corners, plane) else { continue };
            let steps = ((a.y - b.y).abs() / STEP_M).ceil().max(1.0) as usize;
            for step in 0..=steps {
                let p = a + (b - a) * (step as f64 / steps as f64);
                let row = (p.y / STEP_M).round() as i64;
                let front = foremost.entry(row).or_insert(p);
                if p.z > front.z {
                    *front = p;
                }
            }
        }
        Self { points: foremost.into_values().collect() }
    }

    /// The point between two heights (metres) where something is largest; none where the profile has no
    /// point there.
    pub(super) fn most(&self, low: f64, high: f64, of: impl Fn(Point) -> f64) -> Option<Point> {
        (self.points.iter().copied())
            .filter(|p| p.y >= low && p.y <= high)
            .reduce(|best, p| if of(p) > of(best) { p } else { best })
    }

    /// The point at a height.
    pub(super) fn at(&self, height: f64) -> Option<Point> {
        let near = |p: &&Point| (p.y - height).abs();
        self.points.iter().min_by(|a, b| near(a).total_cmp(&near(b))).copied()
    }

    /// Heights that the profile runs over, metres.
    pub(super) fn range(&self) -> Option<[f64; 2]> {
        Some([self.points.first()?.y, self.points.last()?.y])
    }
}

/// Where a triangle meets the plane.
fn cut(corners: [Point; 3], plane: &MirrorPlane) -> Option<[Point; 2]> {
    let side = corners.map(|p| plane.distance(p));
    let mut found: Vec<Point> = Vec::new();
    for k in 0..3 {
        let (i, j) = (k, (k + 1) % 3);
        if side[i] == 0.0 {
            found.push(corners[i]);
        } else if side[i] * side[j] < 0.0 {
            let share = side[i] / (side[i] - side[j]);
            found.push(corners[i] + (corners[j] - corners[i]) * share);
        }
    }
    match found[..] {
        [a, b, ..] => Some([a, b]),
        _ => None,
    }
}
