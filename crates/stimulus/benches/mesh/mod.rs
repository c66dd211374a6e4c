//! The whole head of the real data as one surface, as fine as asked for.

use std::collections::HashMap;
use std::path::Path;

use mimique_avatar_files::read_avatar;
use mimique_geometry::{DVec3, Displacement, Point};
use mimique_solver::{SkinMesh, SparseDeltas};

/// All the meshes of the head as one, every triangle cut into `parts` x `parts`; names of its
/// shapes, and 40 markers spread over the vertices that move.
///
/// The file has 26,719 vertices before exporters split them; only the skin's seams are split here,
/// and closed again.
pub fn whole_head(data: &Path, parts: usize) -> (SkinMesh, Vec<String>, Vec<(String, usize)>) {
    let file = data.join("ict-facekit/ict-facekit.glb");
    let avatar = read_avatar(&file).expect("the head").avatar;
    let mut whole = SkinMesh {
        shapes: vec![SparseDeltas::default(); avatar.shape_names.len()],
        ..SkinMesh::default()
    };
    for mesh in &avatar.meshes {
        let base = whole.positions.len() as u32;
        whole.positions.extend(mesh.positions.iter().map(|p| Point::from(p.map(f64::from))));
        whole.triangles.extend(mesh.triangles.iter().map(|t| t.map(|v| v + base)));
        for (to, from) in whole.shapes.iter_mut().zip(&mesh.shapes) {
            to.vertices.extend(from.vertices.iter().map(|v| v + base));
            to.deltas.extend(from.deltas.iter().map(|d| Displacement::from(d.map(f64::from))));
        }
    }
    let mesh = finer(&whole.weld().expect("a sound head").mesh, parts);
    let moving = &mesh.shapes.iter().max_by_key(|s| s.vertices.len()).expect("a shape").vertices;
    let markers =
        (0..40).map(|m| (format!("M{m}"), moving[m * moving.len() / 40] as usize)).collect();
    (mesh, avatar.shape_names, markers)
}

/// Every triangle cut into `parts` x `parts` along straight lines, deltas in between as positions.
pub fn finer(mesh: &SkinMesh, parts: usize) -> SkinMesh {
    if parts == 1 {
        return mesh.clone();
    }
    let p = parts as u32;
    let own = mesh.positions.len() as u32;
    // New vertices: up to three old ones with their parts.
    let mut mixes: Vec<[(u32, u32); 3]> = Vec::new();
    let mut on_edge: HashMap<(u32, u32, u32), u32> = HashMap::new();
    let mut triangles = Vec::with_capacity(mesh.triangles.len() * parts * parts);
    for t in &mesh.triangles {
        // Row i holds the points with i parts of the second corner, by their parts of the third.
        let mut grid: Vec<Vec<u32>> = vec![Vec::new(); parts + 1];
        for i in 0..=p {
            for j in 0..=p - i {
                let mut mix = [(t[0], p - i - j), (t[1], i), (t[2], j)];
                mix.sort_unstable_by_key(|&(v, part)| (part == 0, v));
                let new = own + mixes.len() as u32;
                let at = match mix.iter().filter(|m| m.1 > 0).count() {
                    1 => mix[0].0,
                    2 => *on_edge.entry((mix[0].0, mix[1].0, mix[0].1)).or_insert(new),
                    _ => new,
                };
                if at == new {
                    mixes.push(mix);
                }
                grid[i as usize].push(at);
            }
        }
        for i in 0..parts {
            for j in 0..parts - i {
                triangles.push([grid[i][j], grid[i + 1][j], grid[i][j + 1]]);
                if i + j + 1 < parts {
                    triangles.push([grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]]);
                }
            }
        }
    }
    let between = |value: &dyn Fn(usize) -> DVec3, mix: &[(u32, u32); 3]| -> DVec3 {
        mix.iter().map(|&(v, part)| value(v as usize) * f64::from(part)).sum::<DVec3>()
            / f64::from(p)
    };
    let mut positions = mesh.positions.clone();
    positions.extend(mixes.iter().map(|mix| Point(between(&|v| mesh.positions[v].0, mix))));
    let mut dense = vec![DVec3::ZERO; mesh.positions.len()];
    let shapes = (mesh.shapes.iter())
        .map(|shape| {
            dense.fill(DVec3::ZERO);
            for (&v, &d) in shape.vertices.iter().zip(&shape.deltas) {
                dense[v as usize] = d.0;
            }
            let mut out = shape.clone();
            for (at, mix) in mixes.iter().enumerate() {
                let d = between(&|v| dense[v], mix);
                if d != DVec3::ZERO {
                    out.vertices.push(own + at as u32);
                    out.deltas.push(Displacement(d));
                }
            }
            out
        })
        .collect();
    SkinMesh { positions, triangles, shapes }
}
