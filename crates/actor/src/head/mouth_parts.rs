//! Teeth and tongue: two arches of crowns and a tongue; the lower ones ride on the jaw.

use super::muscles::{HEAD_SHAPES, JawMotion};
use super::vec3::{Vec3, mix, v3};
use super::{Cage, sparse};
use mimique_avatar::{Avatar, Mesh, Part, SparseShape};
use std::f64::consts::PI;

/// Add both arches and the tongue.
pub(crate) fn add(avatar: &mut Avatar, cage: &Cage) {
    let bone = JawMotion::new(&cage.at);
    let front = cage.sculpt.front(0.0, cage.at.mouth_y).z;
    let mouth = v3(0.0, cage.at.mouth_y, front);
    for (name, upper) in [("teeth_upper", true), ("teeth_lower", false)] {
        let (positions, triangles, vertex_colours) = arch(mouth, cage.at.mouth_half, upper);
        let shapes = if upper { still() } else { riding(&bone, &positions) };
        avatar.meshes.push(mesh(name, Part::Teeth, &positions, triangles, vertex_colours, shapes));
    }
    let (positions, triangles) = tongue(mouth);
    let shapes = riding(&bone, &positions);
    let colours = vec![[0.45, 0.13, 0.12]; positions.len()];
    avatar.meshes.push(mesh("tongue", Part::Tongue, &positions, triangles, colours, shapes));
}

fn mesh(
    name: &str,
    part: Part,
    positions: &[Vec3],
    triangles: Vec<[u32; 3]>,
    vertex_colours: Vec<[f32; 3]>,
    shapes: Vec<SparseShape>,
) -> Mesh {
    Mesh {
        name: name.to_string(),
        part,
        positions: positions.iter().map(|p| p.metres()).collect(),
        triangles,
        base_colour: vertex_colours[0],
        vertex_colours,
        shapes,
        ..Mesh::default()
    }
}

fn still() -> Vec<SparseShape> {
    vec![SparseShape::default(); HEAD_SHAPES.len()]
}

/// The shapes of something that is fixed to the jaw's bone.
fn riding(bone: &JawMotion, positions: &[Vec3]) -> Vec<SparseShape> {
    HEAD_SHAPES
        .iter()
        .map(|&name| {
            let moved = |p: Vec3| match name {
                "jawOpen" => bone.open(p),
                "jawForward" => bone.forward(p),
                "jawLeft" => bone.left(p),
                "jawRight" => bone.left(p.mirrored()).mirrored(),
                _ => Vec3::default(),
            };
            sparse(positions.iter().map(|&p| moved(p)))
        })
        .collect()
}

/// Widths of the crowns from the midline outwards, as shares of half the arch.
const UPPER_CROWNS: [f64; 7] = [0.0, 0.185, 0.33, 0.475, 0.61, 0.74, 1.0];
const LOWER_CROWNS: [f64; 7] = [0.0, 0.125, 0.26, 0.41, 0.56, 0.71, 1.0];
const ACROSS: usize = 8;
/// Cross-section of an arch from the back edge of the gum over the biting edge to the front gum.
const SECTION: usize = 9;

type Painted = (Vec<Vec3>, Vec<[u32; 3]>, Vec<[f32; 3]>);

fn arch(mouth: Vec3, half: f64, upper: bool) -> Painted {
    let crowns = if upper { &UPPER_CROWNS } else { &LOWER_CROWNS };
    let (breadth, depth) = if upper { (half + 1.5, 36.0) } else { (half - 0.5, 34.0) };
    let sign = if upper { 1.0 } else { -1.0 };
    // The biting edges meet a little below the line of the lips; the upper ones stand before.
    let edge = mouth.y - if upper { 2.4 } else { 1.6 };
    let front = mouth.z - if upper { 6.6 } else { 8.6 };
    let mut columns = Vec::new();
    for side in [-1.0, 1.0] {
        let mut half_columns = Vec::new();
        for pair in crowns.windows(2) {
            for i in 0..ACROSS {
                let f = i as f64 / ACROSS as f64;
                half_columns.push((side * mix(pair[0], pair[1], f), f));
            }
        }
        half_columns.push((side, 0.0));
        if side < 0.0 {
            half_columns.reverse();
            half_columns.pop();
        }
        columns.extend(half_columns);
    }
    let mut positions = Vec::new();
    let mut colours = Vec::new();
    for &(along, in_crown) in &columns {
        let angle = along * PI * 0.5;
        let centre = v3(breadth * libm::sin(angle), 0.0, front - depth * (1.0 - libm::cos(angle)));
        let outward = v3(libm::sin(angle) / breadth, 0.0, libm::cos(angle) / depth).unit();
        // Between crowns the surface dips and the edge rounds off.
        let crown = libm::pow(libm::sin(PI * in_crown).max(0.0), 0.35);
        let tall = mix(9.5, 7.0, along.abs());
        for s in 0..SECTION {
            let around = PI * s as f64 / (SECTION - 1) as f64;
            let (out, up) = (-libm::cos(around), 1.0 - libm::sin(around));
            let thick = mix(1.5, 3.2, along.abs()) * mix(0.72, 1.0, crown);
            let height = tall * libm::pow(up, 1.6) + (1.0 - crown) * 0.9 * (1.0 - up);
            positions.push(centre + outward * (out * thick) + v3(0.0, edge + sign * height, 0.0));
            let gum = s == 0 || s == SECTION - 1;
            colours.push(if gum { [0.48, 0.17, 0.16] } else { [0.80, 0.76, 0.67] });
        }
    }
    let triangles = strips(columns.len(), SECTION, !upper);
    (positions, triangles, colours)
}

fn tongue(mouth: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    const LONG: usize = 14;
    const ROUND: usize = 17;
    let mut positions = Vec::new();
    for i in 0..LONG {
        let f = i as f64 / (LONG - 1) as f64;
        // From the root to the tip.
        let tip = libm::pow(1.0 - libm::pow(f, 3.0), 0.5).max(0.02);
        let z = mouth.z - 46.0 + 36.0 * f;
        let y = mouth.y - 7.5 + 3.0 * libm::sin(PI * f) - 2.0 * f;
        for k in 0..ROUND {
            let turn = PI * (k as f64 / (ROUND - 1) as f64);
            let groove = 0.8 * libm::exp(-libm::pow((turn - PI * 0.5) / 0.25, 2.0));
            positions.push(v3(
                -16.0 * tip * libm::cos(turn),
                y + (5.5 * libm::sin(turn) - groove) * tip,
                z,
            ));
        }
    }
    (positions, strips(LONG, ROUND, false))
}

/// Triangles of a grid of `columns` times `rows` vertices, column by column.
fn strips(columns: usize, rows: usize, flip: bool) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for c in 0..columns - 1 {
        for r in 0..rows - 1 {
            let at = |c: usize, r: usize| (c * rows + r) as u32;
            let q = [at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)];
            for t in [[q[0], q[1], q[2]], [q[0], q[2], q[3]]] {
                triangles.push(if flip { [t[0], t[2], t[1]] } else { t });
            }
        }
    }
    triangles
}
