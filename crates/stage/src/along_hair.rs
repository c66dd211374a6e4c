//! How far along a hair each vertex of lashes and hair lies: what `shade.wgsl` thins out by.

use std::collections::HashMap;

use glam::Vec3;
use mimique_avatar::{Mesh, Part};

use crate::framing::Landmarks;

/// One number per vertex: along a lash, or in from the border of a sheet of hair without a picture; 0
/// to 1. Empty for other meshes.
pub(crate) fn along_hair(mesh: &Mesh, landmarks: &Landmarks) -> Vec<f32> {
    match mesh.part {
        Part::Lashes => lash_length(mesh, landmarks),
        Part::Hair if mesh.textured.is_empty() && !mesh.vertex_colours.is_empty() => {
            from_border(mesh, FRINGE * landmarks.eye_span())
        }
        _ => Vec::new(),
    }
}

/// How far along a lash each vertex lies: 0 at the lid, 1 at the longest tip, measured as distance
/// from the nearer eye.
fn lash_length(mesh: &Mesh, landmarks: &Landmarks) -> Vec<f32> {
    let eyes = [Vec3::from(landmarks.eye_right), Vec3::from(landmarks.eye_left)];
    let nearer = |p: [f32; 3]| {
        eyes.map(|e| e.distance(Vec3::from(p))).into_iter().fold(f32::INFINITY, f32::min)
    };
    let distances: Vec<f32> = mesh.positions.iter().map(|&p| nearer(p)).collect();
    let low = distances.iter().copied().fold(f32::INFINITY, f32::min);
    let high = distances.iter().copied().fold(0.0, f32::max);
    distances.iter().map(|d| (d - low) / (high - low).max(1e-6)).collect()
}

/// Width of the border over which hair thins out, in units of the eyes' span.
const FRINGE: f32 = 0.13;

/// How far each vertex lies in from the mesh's open border: 0 on it, 1 at `width` and beyond.
fn from_border(mesh: &Mesh, width: f32) -> Vec<f32> {
    let mut edges: HashMap<[u32; 2], u32> = HashMap::with_capacity(3 * mesh.triangles.len());
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let at = |v: u32| Vec3::from(mesh.positions[v as usize]);
    let border: Vec<[Vec3; 2]> =
        edges.iter().filter(|e| *e.1 == 1).map(|(e, _)| e.map(at)).collect();
    let to_edge = |p: Vec3, [a, b]: [Vec3; 2]| {
        let side = b - a;
        let along = ((p - a).dot(side) / side.length_squared().max(1e-12)).clamp(0.0, 1.0);
        (p - a - along * side).length_squared()
    };
    let nearest = |p: &[f32; 3]| {
        let all = border.iter().map(|&edge| to_edge(Vec3::from(*p), edge));
        (all.fold(f32::INFINITY, f32::min).sqrt() / width).min(1.0)
    };
    mesh.positions.iter().map(nearest).collect()
}
