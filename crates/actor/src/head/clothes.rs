//! A plain shirt that ends the neck.

use super::muscles::{HEAD_SHAPES, risen};
use super::sparse;
use super::vec3::{mix, v3};
use mimique_avatar::{Avatar, Mesh, Part, SparseShape};
use std::f64::consts::TAU;

/// Height against the chin, half breadth, half depth, centre in depth, from inside the collar over
/// its edge and down the shoulders; millimetres.
const RINGS: [[f64; 4]; 10] = [
    [-52.0, 44.0, 46.0, -23.0],
    [-42.0, 52.0, 53.0, -23.0],
    [-38.5, 56.0, 57.0, -23.0],
    [-40.0, 60.0, 61.0, -22.0],
    [-47.0, 65.0, 65.0, -21.0],
    [-54.0, 84.0, 69.0, -20.0],
    [-64.0, 118.0, 76.0, -19.0],
    [-80.0, 152.0, 86.0, -18.0],
    [-104.0, 172.0, 95.0, -16.0],
    [-150.0, 182.0, 102.0, -14.0],
];
const SEGMENTS: usize = 64;

/// Add the shirt; nothing of a face moves it, only the breath.
pub(crate) fn add(avatar: &mut Avatar, chin_y: f64, neck: f64) {
    let mut at = Vec::new();
    for (r, &[y, breadth, depth, z]) in RINGS.iter().enumerate() {
        // The collar fits this person's neck; the shoulders are everyone's.
        let fit = mix(neck, 1.0, (r as f64 - 4.0).max(0.0) / 5.0);
        for s in 0..SEGMENTS {
            let turn = TAU * s as f64 / SEGMENTS as f64;
            let (x, front) = (libm::sin(turn), libm::cos(turn));
            // The collar dips in front.
            let dip = if r < 6 { -13.0 * (0.5 + 0.5 * front) } else { -6.0 * front.max(0.0) };
            at.push(v3(x * breadth * fit, chin_y + y + dip, z + front * depth * fit));
        }
    }
    let mut triangles = Vec::new();
    for r in 0..RINGS.len() - 1 {
        for s in 0..SEGMENTS {
            let v = |r: usize, s: usize| (r * SEGMENTS + s % SEGMENTS) as u32;
            let q = [v(r, s), v(r + 1, s), v(r + 1, s + 1), v(r, s + 1)];
            triangles.extend([[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
        }
    }
    let shape = |name: &&str| match *name {
        "breath" => sparse(at.iter().map(|&p| risen(p, chin_y))),
        _ => SparseShape::default(),
    };
    avatar.meshes.push(Mesh {
        name: "shirt".to_string(),
        part: Part::Other,
        positions: at.iter().map(|p| p.metres()).collect(),
        triangles,
        vertex_colours: Vec::new(),
        base_colour: [0.055, 0.075, 0.105],
        shapes: HEAD_SHAPES.iter().map(shape).collect(),
        ..Mesh::default()
    });
}
