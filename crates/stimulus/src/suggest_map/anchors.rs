//! Places that labels and shapes both name: where the markers called brow are on the actor, and what
//! the avatar's brow shapes move.

use std::collections::BTreeMap;

use mimique_face::arkit_shapes;
use mimique_solver::align_rigidly;

use super::label_words::{Region, Side, place_of};
use super::{Face, minus};
use crate::AvatarSkin;

/// Fewest places that a face is laid by.
const FEWEST: usize = 4;

/// Places named by both, metres.
#[derive(Debug, Clone, Default)]
pub(super) struct Anchors {
    /// On the actor.
    pub actor: Vec<[f64; 3]>,
    /// On the avatar.
    pub avatar: Vec<[f64; 3]>,
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
        points: &[[f64; 3]],
    ) -> Self {
        let mut groups: BTreeMap<(Region, Side), Vec<[f64; 3]>> = BTreeMap::new();
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
            .map(|(p, q)| minus(motion.apply(*p), *q).iter().map(|x| x * x).sum::<f64>())
            .sum();
        Some((square / self.actor.len() as f64).sqrt())
    }
}

/// Where the avatar's shapes show a part of the face to be.
fn avatar_place(skin: &AvatarSkin, face: &Face, region: Region, side: Side) -> Option<[f64; 3]> {
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
            let millimetres = 1e3 * d.iter().map(|x| x * x).sum::<f64>().sqrt();
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
            .filter(|(p, w)| *w > 0.0 && on_side(p[0]))
    };
    of().next()?;
    Some(mean(of()))
}

fn mean(points: impl Iterator<Item = ([f64; 3], f64)>) -> [f64; 3] {
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for (p, w) in points {
        (0..3).for_each(|a| sum[a] += w * p[a]);
        total += w;
    }
    sum.map(|x| x / total)
}
