//! How coarsely each vertex's displacements are stored: so that no pose puts it farther than the
//! tolerance from where it belongs.
//!
//! The error of a pose is the neutral's and a sum of the shapes', each with a weight from 0 to 1: at
//! its farthest in some direction it is the sum of those that go that way. The farthest of all lies
//! near one of [`directions`], whose farthest is therefore at least [`NEAREST`] of it. A vertex that
//! many shapes move gets finer steps than one that only few do.

use super::surface::{POSITION_STEP, quantised};
use crate::Mesh;

/// Most that any vertex may be off in any pose, metres.
const TOLERANCE: f64 = 1e-5;
/// Finest step that is tried first, metres; halved until every vertex is within the tolerance.
const UNIT: f64 = 2.5e-7;
/// Steps that a vertex may have, units. Its place in here is what is stored.
pub(super) const STEPS: [i32; 24] =
    [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 19, 22, 25, 28, 32, 38, 44, 50, 57, 64, 76, 96];

/// Lines through the corners of an icosahedron and the middles of its edges.
const DIRECTIONS: usize = 21;
/// Cosine of the angle between any direction and the nearest of them, at most 21 degrees.
const NEAREST: f64 = 0.934;

/// Steps of a mesh's displacements.
pub(super) struct Steps {
    /// What the steps are multiples of, metres.
    pub unit: f32,
    /// For each vertex, its place in [`STEPS`].
    pub places: Vec<u8>,
    /// Largest error of any vertex over all poses with weights 0 to 1, metres.
    pub error: f64,
}

/// The coarsest steps with which every vertex stays within the tolerance.
pub(super) fn steps(mesh: &Mesh, neutral: &[[i32; 3]]) -> Steps {
    // Displacements of a damaged size would leave the range of the integers.
    let largest =
        mesh.shapes.iter().flat_map(|s| &s.deltas).flatten().fold(0f32, |m, x| m.max(x.abs()));
    let finest = (f64::from(largest) / f64::from(1 << 29)).max(1e-10);
    let mut of_vertex = vec![vec![]; mesh.positions.len()];
    for shape in &mesh.shapes {
        for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
            of_vertex[v as usize].push(*d);
        }
    }
    let directions = directions();
    let still = |v: usize| {
        length(difference(mesh.positions[v], neutral[v].map(|x| x as f32 * POSITION_STEP)))
    };
    let mut unit = UNIT.max(finest);
    loop {
        let mut out = Steps { unit: unit as f32, places: vec![], error: 0.0 };
        for (v, deltas) in of_vertex.iter().enumerate() {
            let still = still(v);
            let error = |place: usize| {
                still + farthest(deltas, unit as f32, STEPS[place], &directions) / NEAREST
            };
            let place = match deltas.len() {
                0 => 0,
                _ => (1..STEPS.len()).rev().find(|&p| error(p) <= TOLERANCE).unwrap_or(0),
            };
            out.error = out.error.max(error(place));
            out.places.push(place as u8);
        }
        if out.error <= TOLERANCE || unit <= finest {
            return out;
        }
        unit = (unit / 2.0).max(finest);
    }
}

/// The displacement in units: a multiple of the vertex's step.
pub(super) fn in_units(d: [f32; 3], unit: f32, step: i32) -> [i32; 3] {
    d.map(|x| quantised(x, unit * step as f32) * step)
}

/// The farthest along any of the lines that weights from 0 to 1 put a vertex off.
fn farthest(deltas: &[[f32; 3]], unit: f32, step: i32, lines: &[[f64; 3]; DIRECTIONS]) -> f64 {
    let mut reach = [[0f64; 2]; DIRECTIONS];
    for &d in deltas {
        let off = difference(d, in_units(d, unit, step).map(|x| x as f32 * unit));
        for (sides, u) in reach.iter_mut().zip(lines) {
            let along = off[0] * u[0] + off[1] * u[1] + off[2] * u[2];
            sides[usize::from(along < 0.0)] += along.abs();
        }
    }
    reach.iter().flatten().fold(0.0, |most: f64, x| most.max(*x))
}

fn directions() -> [[f64; 3]; DIRECTIONS] {
    let g = f64::midpoint(1.0, 5f64.sqrt());
    let mut out = [[0.0; 3]; DIRECTIONS];
    let around = [[1.0, 0.0, 0.0], [0.0, 1.0, g], [0.0, 1.0, -g]].into_iter().chain(
        [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
            .map(|[a, b]| [g / 2.0, a / 2.0, b * g * g / 2.0]),
    );
    let turned = around.flat_map(|[x, y, z]| [[x, y, z], [y, z, x], [z, x, y]]);
    for (out, d) in out.iter_mut().zip(turned) {
        *out = d.map(|x| x / length(d));
    }
    out
}

fn difference(a: [f32; 3], b: [f32; 3]) -> [f64; 3] {
    std::array::from_fn(|k| f64::from(a[k]) - f64::from(b[k]))
}

fn length(d: [f64; 3]) -> f64 {
    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_direction_is_far_from_all_lines() {
        let lines = directions();
        // Fibonacci's points: even over the sphere.
        for i in 0..20_000 {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 20_000.0;
            let (sin, cos) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
            let flat = (1.0 - z * z).sqrt();
            let u = [flat * cos, flat * sin, z];
            let dot = |d: &[f64; 3]| (d[0] * u[0] + d[1] * u[1] + d[2] * u[2]).abs();
            let nearest = lines.iter().map(dot).fold(0.0, f64::max);
            assert!(nearest >= NEAREST, "{u:?}: {nearest}");
        }
    }
}
