//! The eyeballs: spheres with painted sclera, iris and pupil, and how the look shapes turn them.

use super::eyelids::Eye;
use super::identity::Identity;
use super::muscles::HEAD_SHAPES;
use super::vec3::{Vec3, mix, v3};
use mimique_avatar::{Avatar, Eyeball, Look, Mesh, Part, SparseShape};
use std::f64::consts::TAU;

/// Angle of the iris' edge from the axis of sight, degrees.
pub(crate) const IRIS: f64 = 27.0;
const PUPIL: f64 = 10.5;
const SEGMENTS: usize = 48;

/// Turn of the eye at a look shape's weight 1, radians.
pub(crate) const LOOK_SIDE: f64 = 0.56;
pub(crate) const LOOK_UP: f64 = 0.40;
pub(crate) const LOOK_DOWN: f64 = 0.50;

/// Angles of the sphere's circles from the axis of sight (degrees): closer where colour changes.
const CIRCLES: [f64; 24] = [
    3.5,
    7.0,
    PUPIL - 0.5,
    PUPIL + 0.5,
    12.5,
    16.0,
    20.0,
    23.5,
    IRIS - 1.8,
    IRIS - 0.2,
    IRIS + 1.4,
    31.0,
    36.0,
    42.0,
    50.0,
    58.0,
    67.0,
    77.0,
    90.0,
    105.0,
    120.0,
    138.0,
    155.0,
    168.0,
];

/// Add both eyeballs.
pub(crate) fn add(avatar: &mut Avatar, eye: &Eye, who: &Identity) {
    for (part, name, side) in
        [(Part::EyeLeft, "eye_left", 1.0), (Part::EyeRight, "eye_right", -1.0)]
    {
        let centre = v3(side * eye.centre.x, eye.centre.y, eye.centre.z);
        let mesh = avatar.meshes.len();
        avatar.meshes.push(ball(name, part, centre, eye.radius, who));
        avatar.eyeballs.push(Eyeball { mesh, centre: centre.metres(), looks: looks(side) });
    }
}

/// The four look shapes of one eye. "In" is towards the nose.
fn looks(side: f64) -> Vec<Look> {
    let suffix = if side > 0.0 { "Left" } else { "Right" };
    let yaw_out = if side > 0.0 { 1.0 } else { -1.0 };
    [
        ("eyeLookDown", [1.0, 0.0, 0.0], LOOK_DOWN),
        ("eyeLookIn", [0.0, -yaw_out, 0.0], LOOK_SIDE),
        ("eyeLookOut", [0.0, yaw_out, 0.0], LOOK_SIDE),
        ("eyeLookUp", [-1.0, 0.0, 0.0], LOOK_UP),
    ]
    .into_iter()
    .filter_map(|(stem, axis, radians)| {
        let name = format!("{stem}{suffix}");
        let shape = HEAD_SHAPES.iter().position(|s| *s == name)?;
        Some(Look { shape, axis, radians: radians as f32 })
    })
    .collect()
}

fn ball(name: &str, part: Part, centre: Vec3, radius: f64, who: &Identity) -> Mesh {
    let mut positions = vec![(centre + v3(0.0, 0.0, radius)).metres()];
    let mut vertex_colours = vec![paint(0.0, 0.0, who)];
    for &degrees in &CIRCLES {
        let polar = degrees.to_radians();
        for s in 0..SEGMENTS {
            let turn = TAU * s as f64 / SEGMENTS as f64;
            let d = v3(
                libm::sin(polar) * libm::cos(turn),
                libm::sin(polar) * libm::sin(turn),
                libm::cos(polar),
            );
            positions.push((centre + d * radius).metres());
            vertex_colours.push(paint(degrees, turn, who));
        }
    }
    positions.push((centre + v3(0.0, 0.0, -radius)).metres());
    vertex_colours.push(paint(180.0, 0.0, who));
    let ring = |c: usize, s: usize| (1 + c * SEGMENTS + s % SEGMENTS) as u32;
    let mut triangles = Vec::new();
    for s in 0..SEGMENTS {
        triangles.push([0, ring(0, s), ring(0, s + 1)]);
        for c in 0..CIRCLES.len() - 1 {
            triangles.push([ring(c, s), ring(c + 1, s), ring(c + 1, s + 1)]);
            triangles.push([ring(c, s), ring(c + 1, s + 1), ring(c, s + 1)]);
        }
        let last = CIRCLES.len() - 1;
        triangles.push([ring(last, s), (positions.len() - 1) as u32, ring(last, s + 1)]);
    }
    Mesh {
        name: name.to_string(),
        part,
        positions,
        triangles,
        vertex_colours,
        base_colour: [0.8, 0.78, 0.75],
        shapes: vec![SparseShape::default(); HEAD_SHAPES.len()],
        ..Mesh::default()
    }
}

/// Colour at an angle from the axis of sight; fibres of the iris vary with the turn about it.
fn paint(degrees: f64, turn: f64, who: &Identity) -> [f32; 3] {
    let iris = who.iris_colour.map(f64::from);
    let c = if degrees <= PUPIL - 0.4 {
        [0.004; 3]
    } else if degrees < IRIS - 0.1 {
        let depth = (degrees - PUPIL) / (IRIS - PUPIL);
        let fibre = 1.0 + 0.16 * libm::sin(turn * 12.0) * (1.0 - depth);
        // Light inner iris, dark limbal ring.
        let light = if depth < 0.85 { mix(1.55, 1.0, depth) } else { 0.38 };
        iris.map(|c| c * light * fibre)
    } else {
        let pink = ((degrees - 35.0) / 50.0).clamp(0.0, 1.0);
        [0.80, mix(0.77, 0.60, pink), mix(0.74, 0.54, pink)]
    };
    c.map(|c| c as f32)
}
