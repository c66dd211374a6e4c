//! The openings of a skin: the borders of mouth and eyes, where the mesh of an avatar ends.

use std::collections::BTreeMap;

use mimique_avatar::arkit_shapes;
use mimique_geometry::{DVec3, Point, centroid};
use mimique_solver::MirrorPlane;
use mimique_stimulus::AvatarSkin;

/// A border further than this from where the shapes say that its opening is belongs to something else,
/// metres.
const REACH_M: f64 = 0.025;
/// Where a skin has no border, the vertices that the shapes of an opening move by this share of the most
/// stand for it.
const MOST: f64 = 0.6;

/// The vertices around eyes and mouth.
#[derive(Debug, Clone, PartialEq)]
pub struct Openings {
    /// Of the left eye, then of the right one (the person's).
    pub eyes: [Vec<usize>; 2],
    /// Of the mouth.
    pub mouth: Vec<usize>,
}

/// What no shape and no border tells the place of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MissingOpening {
    /// The left eye.
    LeftEye,
    /// The right eye.
    RightEye,
    /// The mouth.
    Mouth,
}

impl Openings {
    /// Of a skin: near where its shapes of lids and lips move it.
    ///
    /// # Errors
    /// [`MissingOpening`] where no shape of ARKit's vocabulary, or of the action units, moves it.
    pub fn of(skin: &AvatarSkin, plane: &MirrorPlane) -> Result<Self, MissingOpening> {
        let borders = borders(&skin.mesh.triangles, skin.mesh.positions.len());
        let left = |p: Point| plane.distance(p) > 0.0;
        let eye = |shape: &str, side: &dyn Fn(Point) -> bool, missing| {
            opening(skin, &borders, &[shape], side).ok_or(missing)
        };
        Ok(Self {
            eyes: [
                eye("eyeBlinkLeft", &left, MissingOpening::LeftEye)?,
                eye("eyeBlinkRight", &|p| !left(p), MissingOpening::RightEye)?,
            ],
            mouth: opening(skin, &borders, &MOUTH, &|_| true).ok_or(MissingOpening::Mouth)?,
        })
    }
}

/// Shapes that move the lips more than all else.
const MOUTH: [&str; 4] = ["mouthRollLower", "mouthRollUpper", "mouthPucker", "mouthFunnel"];

/// The border nearest to where some shapes move the skin, on one side of the face; the vertices that they
/// move most where there is no border.
fn opening(
    skin: &AvatarSkin,
    borders: &[Vec<usize>],
    shapes: &[&str],
    side: &dyn Fn(Point) -> bool,
) -> Option<Vec<usize>> {
    let moved = moved_by(skin, shapes);
    let positions = &skin.mesh.positions;
    let here = |v: &usize| side(positions[*v]);
    let most = (0..positions.len()).filter(here).fold(0.0_f64, |most, v| most.max(moved[v]));
    if most <= 0.0 {
        return None;
    }
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for v in (0..positions.len()).filter(here) {
        let weight = moved[v] * moved[v];
        sum += weight * positions[v].0;
        total += weight;
    }
    let centre = Point(sum / total);
    let distance =
        |border: &&Vec<usize>| (centroid(border.iter().map(|&v| positions[v])) - centre).length();
    let nearest = (borders.iter())
        .filter(|border| border.iter().all(here))
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .filter(|border| distance(border) < REACH_M);
    Some(match nearest {
        Some(border) => border.clone(),
        None => (0..positions.len()).filter(here).filter(|&v| moved[v] >= MOST * most).collect(),
    })
}

/// How far each vertex is moved by the shape of some names that moves it farthest, metres.
pub(super) fn moved_by(skin: &AvatarSkin, shapes: &[&str]) -> Vec<f64> {
    let mut moved = vec![0.0_f64; skin.mesh.positions.len()];
    for (name, shape) in skin.shape_names.iter().zip(&skin.mesh.shapes) {
        if !arkit_shapes(name).iter().any(|meant| shapes.contains(meant)) {
            continue;
        }
        for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
            moved[v as usize] = moved[v as usize].max(d.length());
        }
    }
    moved
}

/// Runs of vertices joined by edges that one triangle has, by their lowest vertex.
fn borders(triangles: &[[u32; 3]], count: usize) -> Vec<Vec<usize>> {
    let mut edges: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let mut joined: Vec<Vec<usize>> = vec![Vec::new(); count];
    for ([a, b], _) in edges.iter().filter(|(_, triangles)| **triangles == 1) {
        joined[*a as usize].push(*b as usize);
        joined[*b as usize].push(*a as usize);
    }
    let mut seen = vec![false; count];
    let mut found = Vec::new();
    for start in 0..count {
        if seen[start] || joined[start].is_empty() {
            continue;
        }
        let (mut border, mut next) = (Vec::new(), vec![start]);
        while let Some(v) = next.pop() {
            if !std::mem::replace(&mut seen[v], true) {
                border.push(v);
                next.extend(&joined[v]);
            }
        }
        border.sort_unstable();
        found.push(border);
    }
    found
}
