//! Hair on the skull and the brows: layers over the skin, which carry the skin's own displacements.

use super::identity::Identity;
use super::muscles::HEAD_SHAPES;
use super::sculpt::Landmarks;
use super::topology::{Feature, Site, Topology};
use super::vec3::{Vec3, bump, mix, smoothstep, v3};
use super::{Subdivided, sparse, split};
use mimique_avatar::{Avatar, Mesh, Part, SparseShape};
use std::f64::consts::{PI, TAU};

/// The finest skin, millimetres, from which the layers are lifted.
pub(crate) struct SkinLayer<'a> {
    pub positions: &'a [Vec3],
    pub quads: &'a [[u32; 4]],
    pub shapes: &'a [Vec<Vec3>],
    pub normals: Vec<Vec3>,
}

impl<'a> SkinLayer<'a> {
    pub(crate) fn new(
        positions: &'a [Vec3],
        quads: &'a [[u32; 4]],
        shapes: &'a [Vec<Vec3>],
    ) -> SkinLayer<'a> {
        let mut normals = vec![Vec3::default(); positions.len()];
        for q in quads {
            let at = |k: usize| positions[q[k] as usize];
            let n = (at(2) - at(0)).cross(at(3) - at(1));
            for &v in q {
                normals[v as usize] += n;
            }
        }
        for n in &mut normals {
            *n = n.unit();
        }
        SkinLayer { positions, quads, shapes, normals }
    }
}

/// Height of the hair line at a bearing about the head: 0 degrees in front, 180 behind.
fn hair_line(bearing: f64, who: &Identity) -> f64 {
    let m = who.masculinity;
    // Hair recedes at the temples with age, in men.
    let receding = 14.0 * m * who.age;
    let points = [
        (0.0, 67.0 + 0.6 * receding),
        (24.0, 65.0 + receding),
        (42.0, 52.0 + 0.5 * receding),
        (56.0, 34.0),
        (72.0, 14.0),
        (82.0, mix(2.0, -12.0, m)),
        (97.0, mix(0.0, -10.0, m)),
        (106.0, 8.0),
        (124.0, -30.0),
        (140.0, -54.0),
        (180.0, -66.0),
    ];
    for pair in points.windows(2) {
        let ((a, ya), (b, yb)) = (pair[0], pair[1]);
        if bearing <= b {
            return mix(ya, yb, smoothstep(a, b, bearing));
        }
    }
    -66.0
}

/// Add the hair of the skull.
pub(crate) fn add_cap(
    avatar: &mut Avatar,
    skin: &SkinLayer,
    fine: &Subdivided,
    topology: &Topology,
    who: &Identity,
) {
    let inside = depths_inside_hair(skin, fine, topology, who);
    let (from, triangles) = haired_skin(skin, &inside);
    let roots = roots(skin, &inside, &from);
    let place = |values: &[Vec3]| -> Vec<Vec3> {
        let mixed = |&(a, b, f): &(usize, usize, f64)| values[a].lerp(values[b], f);
        roots.iter().map(mixed).collect()
    };
    let depth = |&(a, b, f): &(usize, usize, f64)| mix(inside[a], inside[b], f);
    let (at, normals) = (place(skin.positions), place(&skin.normals));
    let lift = |((&p, n), root)| lifted(p, Vec3::unit(n), depth(root), who).metres();
    let colour = who.hair_colour;
    avatar.meshes.push(Mesh {
        name: "hair".to_string(),
        part: Part::Hair,
        positions: at.iter().zip(normals).zip(&roots).map(lift).collect(),
        triangles,
        vertex_colours: at
            .iter()
            .map(|&p| {
                let shine = 1.0 + 0.28 * lock(p) as f32;
                colour.map(|c| c * shine)
            })
            .collect(),
        base_colour: colour,
        shapes: skin.shapes.iter().map(|d| sparse(place(d).into_iter())).collect(),
        ..Mesh::default()
    });
}

/// How far inside the hair each vertex of the skin is, mm; negative outside.
fn depths_inside_hair(
    skin: &SkinLayer,
    fine: &Subdivided,
    topology: &Topology,
    who: &Identity,
) -> Vec<f64> {
    let ear: Vec<Vec3> = topology
        .sites
        .iter()
        .map(|s| match s {
            Site::Ring(Feature::EarLeft | Feature::EarRight, ..)
            | Site::Fill(Feature::EarLeft | Feature::EarRight, ..) => v3(1.0, 0.0, 0.0),
            _ => Vec3::default(),
        })
        .collect();
    let ear = fine.refine(&ear);
    skin.positions
        .iter()
        .zip(&ear)
        .map(|(p, e)| {
            let bearing = libm::atan2(p.x.abs(), p.z + 4.0).to_degrees();
            if e.x > 0.6 || p.y < -110.0 {
                return -100.0;
            }
            // Round the ear the line is drawn on the ear's own loops, so that it stays smooth.
            p.y - hair_line(bearing, who) - 70.0 * e.x
        })
        .collect()
}

/// How far before the hair line the first hairs stand, mm: the mesh ends there, and the stage thins it
/// out towards its border.
const FRINGE: f64 = 4.0;

/// Where on the skin each vertex of the hair stands: between two vertices of the skin, and how far from
/// the first to the second. Those before the fringe are drawn in along an edge, so that the border
/// is a smooth line on any mesh.
fn roots(skin: &SkinLayer, inside: &[f64], from: &[usize]) -> Vec<(usize, usize, f64)> {
    let mut deepest: Vec<Option<usize>> = vec![None; skin.positions.len()];
    for quad in skin.quads {
        for k in 0..4 {
            for (v, next) in [(quad[k], quad[(k + 1) % 4]), (quad[(k + 1) % 4], quad[k])] {
                let (v, next) = (v as usize, next as usize);
                if inside[next] > inside[deepest[v].unwrap_or(v)] {
                    deepest[v] = Some(next);
                }
            }
        }
    }
    let root = |&v: &usize| match deepest[v] {
        Some(next) if inside[v] < -FRINGE && inside[next] > -FRINGE => {
            // Not wholly to the next one: its triangles would be empty.
            let f = (-FRINGE - inside[v]) / (inside[next] - inside[v]);
            (v, next, f.min(0.85))
        }
        _ => (v, v, 0.0),
    };
    from.iter().map(root).collect()
}

/// The part of the skin that the hair covers: the skin's vertices, and triangles of them.
fn haired_skin(skin: &SkinLayer, inside: &[f64]) -> (Vec<usize>, Vec<[u32; 3]>) {
    let mut own = vec![u32::MAX; skin.positions.len()];
    let mut from = Vec::new();
    let mut triangles = Vec::new();
    for quad in skin.quads {
        if quad.iter().all(|&v| inside[v as usize] < -FRINGE)
            || quad.iter().any(|&v| inside[v as usize] < -60.0)
        {
            continue;
        }
        let q = quad.map(|v| {
            let slot = &mut own[v as usize];
            if *slot == u32::MAX {
                *slot = from.len() as u32;
                from.push(v as usize);
            }
            *slot
        });
        // Bent along the same diagonal as the skin under it, which would else come through.
        triangles.extend(split(q, quad.map(|v| skin.positions[v as usize])));
    }
    (from, triangles)
}

/// The relief of the locks at a place, from -1 to 1.
fn lock(p: Vec3) -> f64 {
    // Combed back from a side parting: locks run along the head.
    let across = p.x + 0.18 * p.z - 16.0 + 0.05 * p.y;
    libm::sin(across * 0.42 + 1.7 * libm::sin(p.z * 0.045)) * 0.6
        + libm::sin(across * 1.13 + 0.6 + 1.1 * libm::sin(p.z * 0.08)) * 0.4
}

/// A place on the skin with its normal lifted to the surface of the hair.
fn lifted(p: Vec3, n: Vec3, depth: f64, who: &Identity) -> Vec3 {
    let top = smoothstep(30.0, 100.0, p.y);
    let full = mix(mix(6.5, 5.0, who.masculinity), mix(11.5, 13.0, who.masculinity), top);
    let full = full - 3.0 * who.age * who.masculinity;
    // A lick over the forehead on one side of the parting.
    let lick =
        5.0 * bump((p.x - 4.0) / 24.0) * bump((p.y - 88.0) / 16.0) * smoothstep(0.0, 50.0, p.z);
    // Flat on the skin at its border.
    let rise = 0.35
        + 0.18 * (depth + FRINGE).clamp(0.0, 9.0)
        + (full - 2.0 + lick) * smoothstep(1.0, 26.0, depth);
    let relief = 0.75 * lock(p) * smoothstep(3.0, 16.0, depth);
    p + n * (rise + relief)
}

/// Stations along a brow and across it.
const ALONG: usize = 33;
const ACROSS: usize = 7;

/// Middle line and half thickness of the left brow at `s` (0 at the nose, 1 at the temple), mm.
fn brow_line(s: f64, who: &Identity, at: &Landmarks) -> (f64, f64, f64) {
    let m = who.masculinity;
    let arch = mix(2.8, 1.4, m);
    let x = mix(10.5 - 1.0 * m, 52.0, s) + 0.5 * (at.eye.x - 31.5);
    // Rises to two thirds, then falls to the tail.
    let y = at.brow_y - 0.2
        + arch * (smoothstep(0.0, 0.66, s) - 1.25 * libm::pow(((s - 0.62) / 0.38).max(0.0), 1.7));
    // The stage thins the hairs out towards the border.
    let half = (4.8 + 0.9 * m + 0.45 * who.brow_weight)
        * mix(0.55, 1.0, smoothstep(0.0, 0.16, s))
        * mix(1.0, 0.34, libm::pow(s, 2.2));
    (x, y, half)
}

/// Add both brows as one mesh.
pub(crate) fn add_brows(avatar: &mut Avatar, skin: &SkinLayer, who: &Identity, at: &Landmarks) {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let mut colours = Vec::new();
    let mut deltas: Vec<Vec<Vec3>> = vec![Vec::new(); skin.shapes.len()];
    let finder = Finder::new(skin);
    // Brows are darker than fair hair and keep their colour longer.
    let [r, g, b] = who.hair_colour.map(|c| f64::from(c) * 0.8);
    for side in [1.0, -1.0] {
        let base = positions.len() as u32;
        for i in 0..ALONG {
            let s = i as f64 / (ALONG - 1) as f64;
            let (x, y, half) = brow_line(s, who, at);
            for j in 0..ACROSS {
                let t = 2.0 * j as f64 / (ACROSS - 1) as f64 - 1.0;
                // Hairs lean outwards: upper ones stand further out.
                let place = (side * (x + 1.2 * t), y + t * half);
                let hit = finder.at(place.0, place.1);
                let round = (1.0 - t * t) * smoothstep(0.0, 0.06, s) * smoothstep(1.0, 0.9, s);
                let tuft = 0.5 + 0.5 * libm::sin(s * 88.0 + t * 2.2);
                let lift =
                    0.25 + (0.7 + 0.25 * tuft + 0.25 * who.masculinity) * libm::pow(round, 0.6);
                positions.push(hit.mix(skin.positions) + hit.mix(&skin.normals).unit() * lift);
                let tone = 0.8 + 0.4 * tuft;
                colours.push(v3(r, g, b) * tone);
                for (out, shape) in deltas.iter_mut().zip(skin.shapes) {
                    out.push(hit.mix(shape));
                }
            }
        }
        for i in 0..ALONG - 1 {
            for j in 0..ACROSS - 1 {
                let v = |i: usize, j: usize| base + (i * ACROSS + j) as u32;
                let q = [v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1)];
                for t in [[q[0], q[1], q[2]], [q[0], q[2], q[3]]] {
                    triangles.push(if side > 0.0 { t } else { [t[0], t[2], t[1]] });
                }
            }
        }
    }
    avatar.meshes.push(Mesh {
        name: "brows".to_string(),
        part: Part::Hair,
        positions: positions.iter().map(|p: &Vec3| p.metres()).collect(),
        triangles,
        vertex_colours: colours.iter().map(|c| c.linear_rgb()).collect(),
        base_colour: who.hair_colour.map(|c| c * 0.62),
        shapes: deltas.into_iter().map(|d| sparse(d.into_iter())).collect(),
        ..Mesh::default()
    });
}

/// A point on a quad: its corners and their weights.
struct Hit {
    corners: [u32; 4],
    weights: [f64; 4],
}

impl Hit {
    fn mix(&self, values: &[Vec3]) -> Vec3 {
        let mut sum = Vec3::default();
        for (&c, &w) in self.corners.iter().zip(&self.weights) {
            sum += values[c as usize] * w;
        }
        sum
    }
}

/// Finds the skin behind a point seen from the front.
struct Finder<'a> {
    skin: &'a SkinLayer<'a>,
    front: Vec<[u32; 4]>,
}

impl<'a> Finder<'a> {
    fn new(skin: &'a SkinLayer<'a>) -> Finder<'a> {
        let brow = |v: u32| {
            let p = skin.positions[v as usize];
            p.z > 20.0 && p.y > 0.0 && p.y < 60.0 && skin.normals[v as usize].z > 0.05
        };
        let front = skin.quads.iter().copied().filter(|q| q.iter().all(|&v| brow(v))).collect();
        Finder { skin, front }
    }

    /// The quad over which (x, y) lies; the nearest one if it misses all.
    fn at(&self, x: f64, y: f64) -> Hit {
        let mut best = (f64::INFINITY, Hit { corners: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
        for &q in &self.front {
            for (a, b, c) in [(0, 1, 2), (0, 2, 3)] {
                let p = |k: usize| self.skin.positions[q[k] as usize];
                let (pa, pb, pc) = (p(a), p(b), p(c));
                let det = (pb.x - pa.x) * (pc.y - pa.y) - (pb.y - pa.y) * (pc.x - pa.x);
                if det.abs() < 1e-9 {
                    continue;
                }
                let wb = ((x - pa.x) * (pc.y - pa.y) - (y - pa.y) * (pc.x - pa.x)) / det;
                let wc = ((pb.x - pa.x) * (y - pa.y) - (pb.y - pa.y) * (x - pa.x)) / det;
                let w = [1.0 - wb - wc, wb, wc].map(|w| w.clamp(0.0, 1.0));
                let total: f64 = w.iter().sum();
                let w = w.map(|w| w / total);
                let at = pa * w[0] + pb * w[1] + pc * w[2];
                let miss = (at.x - x).powi(2) + (at.y - y).powi(2) - 1e-6 * at.z;
                if miss < best.0 {
                    let mut weights = [0.0; 4];
                    for (k, w) in [a, b, c].into_iter().zip(w) {
                        weights[k] = w;
                    }
                    best = (miss, Hit { corners: q, weights });
                }
            }
        }
        best.1
    }
}

/// Add a knot of hair at the back of the crown.
pub(crate) fn add_knot(avatar: &mut Avatar, who: &Identity) {
    const RINGS: usize = 18;
    const SEGMENTS: usize = 28;
    let centre = v3(0.0, 96.0, -74.0);
    let axis = v3(0.0, 0.66, -0.75);
    let beside = v3(1.0, 0.0, 0.0);
    let across = axis.cross(beside);
    let mut positions = Vec::new();
    let mut vertex_colours = Vec::new();
    for r in 0..=RINGS {
        let polar = PI * r as f64 / RINGS as f64;
        for s in 0..SEGMENTS {
            let turn = TAU * s as f64 / SEGMENTS as f64;
            // Strands wind round the knot.
            let strand = libm::sin(3.0 * turn + 5.0 * polar);
            let radius = 25.0 + 0.9 * strand * libm::sin(polar);
            let d = (beside * libm::cos(turn) + across * libm::sin(turn)) * libm::sin(polar)
                + axis * (0.82 * libm::cos(polar));
            positions.push((centre + d * radius).metres());
            vertex_colours.push(who.hair_colour.map(|c| c * (1.0 + 0.22 * strand as f32)));
        }
    }
    let mut triangles = Vec::new();
    for r in 0..RINGS {
        for s in 0..SEGMENTS {
            let v = |r: usize, s: usize| (r * SEGMENTS + s % SEGMENTS) as u32;
            let q = [v(r, s), v(r + 1, s), v(r + 1, s + 1), v(r, s + 1)];
            // The poles are points: half of their quads would be empty.
            if r + 1 < RINGS {
                triangles.push([q[0], q[1], q[2]]);
            }
            if r > 0 {
                triangles.push([q[0], q[2], q[3]]);
            }
        }
    }
    avatar.meshes.push(Mesh {
        name: "hair_knot".to_string(),
        part: Part::Hair,
        positions,
        triangles,
        vertex_colours,
        base_colour: who.hair_colour,
        shapes: vec![SparseShape::default(); HEAD_SHAPES.len()],
        ..Mesh::default()
    });
}
