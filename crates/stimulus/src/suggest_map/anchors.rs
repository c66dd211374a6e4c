//! Places that labels and shapes both name: where the markers called brow are on the actor, and what
//! the avatar's brow shapes move.

use std::collections::BTreeMap;

use mimique_avatar::arkit_shapes;
use mimique_geometry::{DVec3, Point, align_rigidly};

use super::Face;
use super::label_words::{Region, Side, place_of};
use crate::AvatarSkin;

/// Fewest places that a face is laid by.
const FEWEST: usize = 4;

/// Places named by both, metres.
#[derive(Debug, Clone, Default)]
pub(super) struct Anchors {
    /// On the actor.
    pub actor: Vec<Point>,
    /// On the avatar.
    pub avatar: Vec<Point>,
    /// Markers that each stands for.
    pub weight: Vec<usize>,
    /// Whether the labels' left is the viewer's.
    pub swapped: bool,
}

impl Anchors {
    /// The places that labels (of `points`) and the avatar's shapes both name; empty where they are
    /// too few to say how a face lies.
    pub fn of<'l>(
        skin: &AvatarSkin,
        face: &Face,
        labels: impl Iterator<Item = &'l str>,
        points: &[Point],
    ) -> Self {
        let mut groups: BTreeMap<(Region, Side), Vec<Point>> = BTreeMap::new();
        for (label, p) in labels.zip(points) {
            if let Some(place) = place_of(label) {
                groups.entry(place).or_default().push(*p);
            }
        }
        let both = [false, true].map(|swapped| {
            let mut found = Self { swapped, ..Self::default() };
            for ((region, side), members) in &groups {
                let side = if swapped { side.other() } else { *side };
                if let Some(place) = avatar_place(skin, face, *region, side) {
                    found.actor.push(mean(members.iter().map(|p| (*p, 1.0))));
                    found.avatar.push(place);
                    found.weight.push(members.len());
                }
            }
            found
        });
        let [as_said, swapped] = both;
        let best = match (as_said.misfit(), swapped.misfit()) {
            (Some(a), Some(b)) if b < 0.7 * a => swapped,
            (Some(_), _) => as_said,
            (None, _) => return Self::default(),
        };
        if best.actor.len() < FEWEST { Self::default() } else { best }
    }

    /// Root mean square distance when laid on each other rigidly.
    fn misfit(&self) -> Option<f64> {
        let motion = align_rigidly(&self.actor, &self.avatar).ok()?;
        let square: f64 = (self.actor.iter().zip(&self.avatar))
            .map(|(p, q)| (motion.apply(*p) - *q).length_squared())
            .sum();
        Some((square / self.actor.len() as f64).sqrt())
    }
}

/// Where the avatar's shapes show a part of the face to be.
fn avatar_place(skin: &AvatarSkin, face: &Face, region: Region, side: Side) -> Option<Point> {
    // Shapes whose largest displacements lie there, of the left side.
    let (shapes, power): (&[&str], i32) = match region {
        Region::Brow => (&["browDownLeft", "browOuterUpLeft"], 2),
        Region::Eye => (&["eyeBlinkLeft", "eyeSquintLeft"], 2),
        Region::Nose => (&["noseSneerLeft"], 4),
        Region::Cheek => (&["cheekSquintLeft", "cheekPuff"], 2),
        Region::Mouth => (&["mouthPucker", "mouthFunnel", "mouthRollLower", "mouthRollUpper"], 2),
        Region::MouthCorner => (&["mouthSmileLeft", "mouthDimpleLeft"], 4),
        // The jaw turns about the ears: what is farthest moves most.
        Region::Chin => (&["jawOpen"], 8),
    };
    let wanted = |name: &&'static str| {
        shapes.iter().any(|s| s == name || s.replace("Left", "Right") == **name)
    };
    let mut weight = vec![0.0_f64; skin.mesh.positions.len()];
    for (name, shape) in skin.shape_names.iter().zip(&skin.mesh.shapes) {
        if !arkit_shapes(name).iter().any(wanted) {
            continue;
        }
        for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
            let millimetres = 1e3 * d.length();
            weight[v as usize] += millimetres.powi(power);
        }
    }
    let on_side = |x: f64| match side {
        Side::Left => x > 0.0,
        Side::Right => x < 0.0,
        Side::Middle => true,
    };
    let of = || {
        (face.vertices.iter())
            .map(|&v| (skin.mesh.positions[v], weight[v]))
            .filter(|(p, w)| *w > 0.0 && on_side(p.x))
    };
    of().next()?;
    Some(mean(of()))
}

/// The weighted mean of some points.
fn mean(points: impl Iterator<Item = (Point, f64)>) -> Point {
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for (p, w) in points {
        sum += w * p.0;
        total += w;
    }
    Point(sum / total)
}
