//! Where the camera stands: from the head's landmarks in the neutral pose, so that every condition
//! of a study is framed alike and a shoulder or a hat changes nothing.

use std::collections::HashMap;

use glam::camera::rh::proj::directx::{orthographic, perspective};
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use mimique_avatar::{Avatar, Mesh, Part};

use crate::eye_guess::guess_eyes;

/// What the camera does relative to the standard portrait.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Turn of the camera about the vertical, radians; positive shows the person's left side.
    pub yaw: f32,
    /// Turn of the camera about the horizontal, radians; positive looks from above.
    pub pitch: f32,
    /// Magnification; 1 is the standard portrait.
    pub zoom: f32,
}

impl View {
    /// The standard portrait, straight from the front.
    pub const FRONT: Self = Self { yaw: 0.0, pitch: 0.0, zoom: 1.0 };
    /// Turned by 35 degrees to the person's left side.
    pub const THREE_QUARTER: Self = Self { yaw: 0.61, pitch: 0.0, zoom: 1.0 };
}

impl Default for View {
    fn default() -> Self {
        Self::FRONT
    }
}

/// The landmarks that frame a head, metres, neutral pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landmarks {
    /// Centre of the person's right eyeball (at smaller x).
    pub eye_right: [f32; 3],
    /// Centre of the person's left eyeball (at larger x).
    pub eye_left: [f32; 3],
    /// Lowest point of the chin, on the midline.
    pub chin: [f32; 3],
    /// Most forward point between the eyes' height and the chin: the tip of the nose.
    pub nose_tip: [f32; 3],
    /// Where the lips part, on the midline; a guess where the skin has no rim at the mouth.
    pub mouth: [f32; 3],
    /// Corner of the mouth on the person's left, where the skin has a rim at the mouth.
    pub mouth_corner: Option<[f32; 3]>,
}

/// Eye to chin in units of the distance between the eyes, where no chin can be found.
const CHIN_DROP: f32 = 1.85;
/// Vertical field of view of the portrait lens, radians (about 85 mm on a full frame).
const FIELD_OF_VIEW: f32 = 0.30;

impl Landmarks {
    /// Finds them: eyes from the eyeballs (else from what the shapes move), chin and nose
    /// from the skin near the midline.
    pub fn find(avatar: &Avatar) -> Self {
        let (right, left) = eyes(avatar);
        let middle = (right + left) * 0.5;
        let span = (left - right).length().max(1e-6);
        let mut chin = middle - Vec3::new(0.0, CHIN_DROP * span, 0.0);
        let mut nose = middle + Vec3::new(0.0, -0.6 * span, 0.6 * span);
        let mut lowest = f32::INFINITY;
        let mut foremost = f32::NEG_INFINITY;
        for mesh in avatar.meshes.iter().filter(|m| m.part == Part::Skin) {
            for p in mesh.positions.iter().map(|&p| Vec3::from(p)) {
                let off = p - middle;
                let on_midline = off.x.abs() < 0.25 * span;
                if !on_midline || off.y > -0.1 * span || off.y < -2.6 * span {
                    continue;
                }
                // The neck lies behind the plane of the eyes; the chin does not.
                if off.z > -0.15 * span && off.y < -1.2 * span && p.y < lowest {
                    lowest = p.y;
                    chin = p;
                }
                if off.y > -1.2 * span && p.z > foremost {
                    foremost = p.z;
                    nose = p;
                }
            }
        }
        let guess = Vec3::new(middle.x, middle.y + 0.6 * (chin.y - middle.y), nose.z - 0.3 * span);
        let (mouth, corner) = mouth(avatar, guess, span);
        Self {
            eye_right: right.into(),
            eye_left: left.into(),
            chin: chin.into(),
            nose_tip: nose.into(),
            mouth: mouth.into(),
            mouth_corner: corner,
        }
    }

    /// Midpoint of the eyes, metres.
    pub fn eyes_middle(&self) -> [f32; 3] {
        ((Vec3::from(self.eye_right) + Vec3::from(self.eye_left)) * 0.5).into()
    }

    /// Distance between the eyes' centres, metres: the unit in which everything else is placed.
    pub fn eye_span(&self) -> f32 {
        (Vec3::from(self.eye_left) - Vec3::from(self.eye_right)).length()
    }
}

fn eyes(avatar: &Avatar) -> (Vec3, Vec3) {
    let centre = |part: Part| {
        let index = avatar.meshes.iter().position(|m| m.part == part && !m.positions.is_empty())?;
        match avatar.eyeballs.iter().find(|e| e.mesh == index) {
            Some(eyeball) => Some(Vec3::from(eyeball.centre)),
            None => Some(bounds_centre(&avatar.meshes[index])),
        }
    };
    if let (Some(right), Some(left)) = (centre(Part::EyeRight), centre(Part::EyeLeft)) {
        return if right.x <= left.x { (right, left) } else { (left, right) };
    }
    guess_eyes(avatar)
}

/// The midpoint and the left corner of the open border of the skin nearest to where a mouth is.
fn mouth(avatar: &Avatar, guess: Vec3, span: f32) -> (Vec3, Option<[f32; 3]>) {
    let mut rim = Vec::new();
    for mesh in avatar.meshes.iter().filter(|m| m.part == Part::Skin) {
        let near = |p: Vec3| {
            let off = (p - guess).abs() / span;
            off.x < 0.6 && off.y < 0.3 && off.z < 0.6
        };
        let near_vertex = |v: u32| mesh.positions.get(v as usize).is_some_and(|&p| near(p.into()));
        // Vertices at one place count as the first of them. Map and edges are of the types that `geometry`
        // has, since each further type that is hashed or sorted weighs 1 to 3 KB of the canvas.
        let mut here: HashMap<[u32; 3], Vec<u32>> = HashMap::new();
        let mut first = |v: u32| {
            let place = here.entry(mesh.positions[v as usize].map(f32::to_bits)).or_default();
            if place.is_empty() {
                place.push(v);
            }
            u64::from(place[0])
        };
        let mut edges: Vec<u64> = (mesh.triangles.iter())
            .filter(|t| t.iter().any(|&v| near_vertex(v)))
            .filter(|t| t.iter().all(|&v| (v as usize) < mesh.positions.len()))
            .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
            .map(|e| e.map(&mut first))
            .map(|[a, b]| a.min(b) << 32 | a.max(b))
            .collect();
        edges.sort_unstable();
        let alone = edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1);
        // The border of the region itself is alone too, but has an end outside.
        let point = |v: u64| Vec3::from(mesh.positions[v as u32 as usize]);
        let ends = alone.map(|same| [same[0] >> 32, same[0]].map(point));
        rim.extend(ends.filter(|e| e.iter().all(|&p| near(p))).flatten());
    }
    let Some(corner) = rim.iter().copied().reduce(|a, b| if b.x > a.x { b } else { a }) else {
        return (guess, None);
    };
    let reach = corner.x - guess.x;
    let central = || rim.iter().filter(|p| (p.x - guess.x).abs() < 0.3 * reach);
    let (low, high) =
        central().fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), p| (l.min(p.y), h.max(p.y)));
    let front = central().fold(f32::NEG_INFINITY, |z, p| z.max(p.z));
    if reach < 0.15 * span || low > high {
        return (guess, None);
    }
    (Vec3::new(guess.x, (low + high) * 0.5, front), Some(corner.into()))
}

/// Centre of a mesh's bounding box.
pub(crate) fn bounds_centre(mesh: &Mesh) -> Vec3 {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for p in mesh.positions.iter().map(|&p| Vec3::from(p)) {
        low = low.min(p);
        high = high.max(p);
    }
    (low + high) * 0.5
}

/// Camera of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    pub clip_from_world: Mat4,
    pub position: Vec3,
}

impl Camera {
    /// The portrait: the face from above the brow to below the chin with room for an open jaw, at
    /// any aspect ratio.
    pub fn portrait(landmarks: &Landmarks, view: View, aspect: f32) -> Self {
        let span = landmarks.eye_span().max(1e-4);
        let eyes = Vec3::from(landmarks.eyes_middle());
        let chin = Vec3::from(landmarks.chin);
        // Not `clamp`: its panic prints numbers, which is 10 KB of the canvas module.
        let drop = (eyes.y - chin.y).max(1.3 * span).min(2.6 * span);
        let (top, bottom) = (eyes.y + 2.25 * span, eyes.y - drop - 0.75 * span);
        let half_height = (top - bottom) * 0.5;
        let half_width = 1.75 * span;
        let half = half_height.max(half_width / aspect) / view.zoom.clamp(0.2, 20.0);
        let target = Vec3::new(eyes.x, (top + bottom) * 0.5, eyes.z - 0.1 * span);
        let distance = half / (FIELD_OF_VIEW * 0.5).tan() + 0.7 * span;
        let pitch = view.pitch.clamp(-1.5, 1.5);
        let (sin_yaw, cos_yaw) = view.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = pitch.sin_cos();
        let back = Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
        let position = target + back * distance;
        let view_from_world = look_at_mat4(position, target, Vec3::Y);
        let near = (distance - 12.0 * span).max(distance * 0.05);
        let clip_from_view = perspective(FIELD_OF_VIEW, aspect, near, distance + 12.0 * span);
        Self { clip_from_world: clip_from_view * view_from_world, position }
    }

    /// The key light's own view of the head, orthographic, for its shadows.
    pub fn light(landmarks: &Landmarks, towards_light: Vec3) -> Mat4 {
        let span = landmarks.eye_span().max(1e-4);
        let centre = Vec3::from(landmarks.eyes_middle()) - Vec3::new(0.0, 0.6 * span, 0.3 * span);
        let radius = 3.0 * span;
        let view = look_at_mat4(centre + towards_light * radius * 2.0, centre, Vec3::Y);
        orthographic(-radius, radius, -radius, radius, radius * 0.5, radius * 3.5) * view
    }
}
