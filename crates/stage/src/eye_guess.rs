//! Where the eyes are of a head that has no meshes for them: from what its blendshapes move, so that
//! hats, hair and shoulders, which no shape of a face moves, change nothing.

use glam::Vec3;
use mimique_avatar::{Avatar, Mesh, Part};

/// Parts of a lid's travel below which a vertex is beside the lid.
const LID_TRAVEL: f32 = 0.3;
/// Parts of the farthest way at any shape below which a vertex is beside the face.
const FACE_TRAVEL: f32 = 0.05;
/// How far the ball's centre lies behind the middle of the closing lid, and below it, in units of
/// the distance between the eyes.
const BEHIND_LID: f32 = 0.23;
const BELOW_LID: f32 = 0.07;
/// Where eyes lie in the box of what shapes move (from the brows to below the chin), and in that of a
/// whole head: how far apart in parts of its width, how high, how far forward.
const MOVED_EYES: [f32; 3] = [0.41, 0.67, 0.62];
const HEAD_EYES: [f32; 3] = [0.42, 0.62, 0.75];

/// The person's right and left eye, metres: from the lids that blink; else from the region of the
/// skin that shapes move; else from the skin's own box.
pub(crate) fn guess_eyes(avatar: &Avatar) -> (Vec3, Vec3) {
    let by_reach = || Some(in_box(moved_box(avatar)?, MOVED_EYES));
    lids(avatar).or_else(by_reach).unwrap_or_else(|| in_box(skin_box(avatar), HEAD_EYES))
}

fn skins(avatar: &Avatar) -> impl Iterator<Item = &Mesh> {
    avatar.meshes.iter().filter(|m| m.part == Part::Skin)
}

/// Middle of what the shapes called blink move on either side of the face.
fn lids(avatar: &Avatar) -> Option<(Vec3, Vec3)> {
    let blink = |name: &str| name.as_bytes().windows(5).any(|w| w.eq_ignore_ascii_case(b"blink"));
    let blinks = || avatar.shape_names.iter().enumerate().filter(|(_, name)| blink(name));
    let mut moved: Vec<(Vec3, f32)> = Vec::new();
    for mesh in skins(avatar) {
        for shape in blinks().filter_map(|(k, _)| mesh.shapes.get(k)) {
            let way = |d: &[f32; 3]| Vec3::from(*d).length();
            let least = LID_TRAVEL * shape.deltas.iter().map(way).fold(0.0, f32::max);
            let all = shape.vertices.iter().zip(&shape.deltas).map(|(v, d)| (*v, way(d)));
            let here = |v: u32| mesh.positions.get(v as usize).map(|p| Vec3::from(*p));
            moved.extend(all.filter(|m| m.1 > least).filter_map(|(v, w)| Some((here(v)?, w))));
        }
    }
    let ends = moved.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), (p, _)| {
        (low.min(p.x), high.max(p.x))
    });
    // Between two eyes lies a nose's width where no lid is.
    let middle = 0.5 * (ends.0 + ends.1);
    let mean = |left: bool| {
        let side = || moved.iter().filter(|(p, _)| (p.x > middle) == left);
        let weight: f32 = side().map(|(_, w)| w).sum();
        (weight > 0.0).then(|| side().map(|(p, w)| *p * *w).sum::<Vec3>() / weight)
    };
    let (right, left) = (mean(false)?, mean(true)?);
    let inner = moved.iter().map(|(p, _)| (p.x - middle).abs()).fold(f32::INFINITY, f32::min);
    let span = left.x - right.x;
    // One eye alone, which the middle cuts, has no such gap.
    let back = Vec3::new(0.0, BELOW_LID, BEHIND_LID) * span;
    (inner > 0.1 * span).then_some((right - back, left - back))
}

/// The box of the skin's vertices that shapes move.
fn moved_box(avatar: &Avatar) -> Option<(Vec3, Vec3)> {
    let mut moved: Vec<(Vec3, f32)> = Vec::new();
    for mesh in skins(avatar) {
        let mut ways = vec![0f32; mesh.positions.len()];
        // A breath moves no face.
        for shape in mesh.shapes.iter().take(avatar.face_shapes().len()) {
            for (v, d) in shape.vertices.iter().zip(&shape.deltas) {
                if let Some(way) = ways.get_mut(*v as usize) {
                    *way = way.max(Vec3::from(*d).length());
                }
            }
        }
        moved.extend(mesh.positions.iter().map(|p| Vec3::from(*p)).zip(ways));
    }
    let least = FACE_TRAVEL * moved.iter().map(|m| m.1).fold(0.0, f32::max);
    bounds(moved.into_iter().filter(|(_, way)| *way > least).map(|(p, _)| p))
}

fn skin_box(avatar: &Avatar) -> (Vec3, Vec3) {
    let points = skins(avatar).flat_map(|m| &m.positions).map(|p| Vec3::from(*p));
    bounds(points).unwrap_or((Vec3::ZERO, Vec3::ZERO))
}

fn bounds(mut points: impl Iterator<Item = Vec3>) -> Option<(Vec3, Vec3)> {
    let first = points.next()?;
    Some(points.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
}

fn in_box((low, high): (Vec3, Vec3), [span, up, forward]: [f32; 3]) -> (Vec3, Vec3) {
    let size = high - low;
    let middle = low + size * Vec3::new(0.5, up, forward);
    let half = Vec3::new(size.x.max(1e-3) * 0.5 * span, 0.0, 0.0);
    (middle - half, middle + half)
}
