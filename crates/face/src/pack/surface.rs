//! One mesh in a pack: triangles, positions and displacements as small integers.

use super::bytes::{PackError, PackReader, PackWriter};
use super::entropy::{IntegerReader, IntegerWriter, Integers, Model, magnitude_bits};
use super::predict::Prediction;
use crate::{Mesh, Part, SparseShape, Textured};

/// Most that any vertex may be off in any pose, metres.
const TOLERANCE: f64 = 1e-5;
/// Step of the neutral positions, metres: half a micrometre of error on each axis.
const POSITION_STEP: f32 = 1e-6;
/// Step of places in a picture: an eighth of a texel of the largest texture.
const UV_STEP: f32 = 1.0 / 16384.0;
/// Coarsest step of displacements that is tried, metres; each try is a tenth finer.
const COARSEST_STEP: f64 = 2e-5;

const PARTS: [Part; 10] = [
    Part::Skin,
    Part::EyeLeft,
    Part::EyeRight,
    Part::Teeth,
    Part::Tongue,
    Part::Socket,
    Part::Lashes,
    Part::Hair,
    Part::EyeOverlay,
    Part::Other,
];

/// Most vertices or triangles of a mesh.
const MOST: usize = 1 << 24;
/// Most of them for each byte that is left: what a damaged count promises beyond is not made room for.
const MOST_A_BYTE: usize = 512;

/// Writes a mesh; returns the largest error of any vertex over all poses with weights 0 to 1.
pub(super) fn mesh_to(out: &mut PackWriter, mesh: &Mesh) -> f64 {
    out.text(&mesh.name);
    out.u8(PARTS.iter().position(|p| *p == mesh.part).unwrap_or(PARTS.len() - 1) as u8);
    mesh.base_colour.iter().for_each(|&c| out.f32(c));
    let neutral: Vec<[i32; 3]> =
        mesh.positions.iter().map(|p| p.map(|x| quantised(x, POSITION_STEP))).collect();
    let (step, error) = displacement_step(mesh, &neutral);
    out.f32(step);
    out.u8(u8::from(!mesh.vertex_colours.is_empty()));
    out.varint(mesh.textured.len() as u32);
    for run in &mesh.textured {
        out.varint(run.triangles.start as u32);
        out.varint(run.triangles.len() as u32);
        out.varint(run.texture as u32);
    }
    out.varint(mesh.positions.len() as u32);
    out.varint(mesh.triangles.len() as u32);

    let mut coder = IntegerWriter::new();
    let mut triangles = mesh.triangles.clone();
    connect(&mut coder, &mut triangles);
    let prediction = Prediction::new(mesh.positions.len(), &mesh.triangles);
    let mut planes = Planes::new(&prediction);
    let colours: Vec<[i32; 3]> =
        (mesh.vertex_colours.iter()).map(|c| c.map(|c| i32::from(colour_to_byte(c)))).collect();
    if !colours.is_empty() {
        planes.write(&mut coder, &mut Residuals::new(), &colours, None);
    }
    planes.write(&mut coder, &mut Residuals::new(), &neutral, None);
    if !mesh.textured.is_empty() {
        let place =
            |v| mesh.uvs.get(v).map_or([0; 2], |uv: &[f32; 2]| uv.map(|x| quantised(x, UV_STEP)));
        let places: Vec<[i32; 2]> = (0..mesh.positions.len()).map(place).collect();
        planes.write(&mut coder, &mut Residuals::new(), &places, None);
    }
    let (mut runs, mut residuals) = (Model::new(2), Residuals::new());
    let mut dense = vec![[0i32; 3]; mesh.positions.len()];
    for shape in &mesh.shapes {
        for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
            dense[v as usize] = d.map(|x| quantised(x, step));
        }
        let moves = |&i: &u32| dense[prediction.order[i as usize] as usize] != [0; 3];
        let visits: Vec<u32> = (0..dense.len() as u32).filter(moves).collect();
        runs_to(&mut coder, &mut runs, &visits);
        planes.write(&mut coder, &mut residuals, &dense, Some(&visits));
        shape.vertices.iter().for_each(|&v| dense[v as usize] = [0; 3]);
    }
    let coded = coder.into_bytes();
    out.varint(coded.len() as u32);
    out.raw(&coded);
    error
}

/// Reads what [`mesh_to`] wrote.
pub(super) fn mesh_from(r: &mut PackReader<'_>, shapes: usize) -> Result<Mesh, PackError> {
    let name = r.text()?;
    let part = r.u8()? as usize;
    let Some(&part) = PARTS.get(part) else { return r.refuse(format!("part {part}")) };
    let base_colour = [r.f32()?, r.f32()?, r.f32()?];
    let step = r.f32()?;
    if !(step > 0.0 && step <= COARSEST_STEP as f32) {
        let nanometres = (f64::from(step) * 1e9) as i64;
        return r.refuse(format!("displacements in steps of {nanometres} nm"));
    }
    let coloured = match r.u8()? {
        0 => false,
        1 => true,
        other => return r.refuse(format!("colour flag {other}")),
    };
    let textured = textured_from(r)?;
    let (vertices, count) = (r.varint()? as usize, r.varint()? as usize);
    if vertices.max(count) > MOST.min(r.left().saturating_mul(MOST_A_BYTE)) {
        return r
            .refuse(format!("{vertices} vertices and {count} triangles in {} bytes", r.left()));
    }
    if let Some(beyond) = textured.iter().map(|t| t.triangles.end).find(|end| *end > count) {
        return r.refuse(format!("a picture to triangle {beyond} of {count}"));
    }
    let length = r.count(1)?;
    let mut coder = IntegerReader::new(r.raw(length)?);
    let mut triangles = vec![[0u32; 3]; count];
    connect(&mut coder, &mut triangles);
    if let Some(v) = triangles.iter().flatten().find(|v| **v as usize >= vertices) {
        return r.refuse(format!("triangle corner {v} of {vertices}"));
    }
    let prediction = Prediction::new(vertices, &triangles);
    let mut planes = Planes::new(&prediction);
    let mut vertex_colours = vec![];
    if coloured {
        let bytes: Vec<[i32; 3]> = planes.read(&mut coder, &mut Residuals::new(), None);
        vertex_colours =
            bytes.into_iter().map(|c| c.map(|c| colour_of_byte(c.clamp(0, 255) as u8))).collect();
    }
    let neutral: Vec<[i32; 3]> = planes.read(&mut coder, &mut Residuals::new(), None);
    let positions = neutral.into_iter().map(|q| q.map(|x| x as f32 * POSITION_STEP)).collect();
    let mut uvs = vec![];
    if !textured.is_empty() {
        let places: Vec<[i32; 2]> = planes.read(&mut coder, &mut Residuals::new(), None);
        uvs = places.into_iter().map(|q| q.map(|x| x as f32 * UV_STEP)).collect();
    }
    let (mut runs, mut residuals) = (Model::new(2), Residuals::new());
    let mut read = Vec::new();
    for _ in 0..shapes {
        let Some(visits) = runs_from(&mut coder, &mut runs, vertices) else {
            return r.refuse(format!("a run of moving vertices beyond vertex {vertices}"));
        };
        let moved: Vec<[i32; 3]> = planes.read(&mut coder, &mut residuals, Some(&visits));
        if coder.spent() {
            break;
        }
        // The vertex, and which of the displacements is its.
        let mut order: Vec<u64> = (visits.iter().zip(0..))
            .map(|(&i, k): (_, u64)| u64::from(prediction.order[i as usize]) << 32 | k)
            .collect();
        order.sort_unstable();
        let (vertices, deltas) = (order.iter())
            .map(|&at| ((at >> 32) as u32, moved[at as u32 as usize].map(|x| x as f32 * step)))
            .unzip();
        read.push(SparseShape { vertices, deltas });
    }
    if coder.spent() {
        return r.refuse(format!("mesh {name} ends after {length} bytes"));
    }
    let shapes = read;
    Ok(Mesh {
        name,
        part,
        positions,
        triangles,
        vertex_colours,
        base_colour,
        shapes,
        uvs,
        textured,
    })
}

/// The runs of triangles with a picture.
fn textured_from(r: &mut PackReader<'_>) -> Result<Vec<Textured>, PackError> {
    let mut runs = Vec::new();
    let mut free = 0;
    for _ in 0..r.count(3)? {
        let start = r.varint()? as usize;
        let end = start.saturating_add(r.varint()? as usize);
        if start < free {
            return r.refuse(format!("a picture on triangles {start} to {end}, again"));
        }
        free = end;
        runs.push(Textured { triangles: start..end, texture: r.varint()? as usize });
    }
    Ok(runs)
}

/// Vertices of late that a corner is looked for among.
const LATE: usize = 24;

/// Corners of triangles, written or read: most are a vertex of late, or the first that is new.
fn connect(coder: &mut impl Integers, triangles: &mut [[u32; 3]]) {
    // What a corner is: 0 new, n > 0 the n-th latest, or else one past them and a step from the first.
    let mut kinds: [Model; 3] = std::array::from_fn(|_| Model::new(LATE + 2));
    let mut steps = Model::new(1);
    let mut late = [0u32; LATE];
    let mut kinds_before = [0usize; 3];
    let mut new = 0u32;
    for triangle in triangles {
        for corner in 0..3 {
            let v = triangle[corner];
            let kind = match late.iter().position(|l| *l == v) {
                _ if v == new => 0,
                Some(place) => place + 1,
                None => LATE + 1,
            };
            let context = kinds_before[corner];
            let kind = coder.integer(&mut kinds[corner], context, kind as i32);
            let kind = (kind.max(0) as usize).min(LATE + 1);
            kinds_before[corner] = kind;
            let v = match kind {
                0 => new,
                k if k <= LATE => late[k - 1],
                _ => {
                    let step = v.wrapping_sub(late[0]) as i32;
                    late[0].wrapping_add(coder.integer(&mut steps, 0, step) as u32)
                }
            };
            if kind == 0 {
                new = new.wrapping_add(1);
            } else {
                new = new.max(v.wrapping_add(1));
            }
            let place = late.iter().position(|l| *l == v).unwrap_or(LATE - 1);
            late.copy_within(0..place, 1);
            late[0] = v;
            triangle[corner] = v;
        }
    }
}

/// Runs of resting and moving vertices in visiting order, how many of them first.
fn runs_to(coder: &mut IntegerWriter, model: &mut Model, visits: &[u32]) {
    let mut runs = Vec::new();
    let mut at = 0;
    for span in visits.chunk_by(|a, b| a + 1 == *b) {
        runs.extend([span[0] - at, span.len() as u32]);
        at = span[0] + span.len() as u32;
    }
    coder.integer(model, 0, runs.len() as i32);
    for (i, run) in runs.into_iter().enumerate() {
        coder.integer(model, i % 2, run as i32);
    }
}

/// The moving visits, unless they leave the mesh.
fn runs_from(coder: &mut IntegerReader<'_>, model: &mut Model, count: usize) -> Option<Vec<u32>> {
    let mut visits = Vec::new();
    let mut at = 0u32;
    let runs = coder.integer(model, 0, 0);
    for i in 0..runs.max(0) {
        let run = u32::try_from(coder.integer(model, i as usize % 2, 0)).ok()?;
        let end = at.checked_add(run).filter(|end| *end as usize <= count)?;
        if i % 2 == 1 {
            visits.extend(at..end);
        }
        at = end;
        if coder.spent() {
            return None;
        }
    }
    Some(visits)
}

/// What has been learnt of how far values lie from their guess.
struct Residuals(Model);

/// Lengths of residuals that are told apart.
const LENGTHS: usize = 10;

impl Residuals {
    fn new() -> Self {
        Self(Model::new(LENGTHS * (LENGTHS + 1)))
    }
}

/// Values of vertices, one axis after the other.
struct Planes<'p> {
    prediction: &'p Prediction,
    everywhere: Vec<u32>,
    plane: Vec<i32>,
}

impl<'p> Planes<'p> {
    fn new(prediction: &'p Prediction) -> Self {
        let count = prediction.order.len();
        Self { prediction, everywhere: (0..count as u32).collect(), plane: vec![0; count] }
    }

    /// Writes the values of the visits (none = of all); those of other vertices must be 0.
    fn write<const N: usize>(
        &mut self,
        coder: &mut IntegerWriter,
        model: &mut Residuals,
        values: &[[i32; N]],
        visits: Option<&[u32]>,
    ) {
        let visits = visits.unwrap_or(&self.everywhere);
        let mut lengths = vec![LENGTHS; visits.len()];
        for axis in 0..N {
            self.plane.iter_mut().zip(values).for_each(|(p, v)| *p = v[axis]);
            residuals(coder, model, visits, self.prediction, &mut self.plane, &mut lengths);
        }
    }

    /// Reads what [`Planes::write`] wrote, one for each visit; for all, in the vertices' own order.
    fn read<const N: usize>(
        &mut self,
        coder: &mut IntegerReader<'_>,
        model: &mut Residuals,
        visits: Option<&[u32]>,
    ) -> Vec<[i32; N]> {
        let everywhere = visits.is_none();
        let visits = visits.unwrap_or(&self.everywhere);
        let mut lengths = vec![LENGTHS; visits.len()];
        let mut out = vec![[0; N]; visits.len()];
        for axis in 0..N {
            self.plane.fill(0);
            residuals(coder, model, visits, self.prediction, &mut self.plane, &mut lengths);
            for (n, value) in out.iter_mut().enumerate() {
                let vertex =
                    if everywhere { n } else { self.prediction.order[visits[n] as usize] as usize };
                value[axis] = self.plane[vertex];
            }
        }
        out
    }
}

/// How far the values of the visits lie from their guess. What is expected of one follows from the
/// two before it and from the same vertex on the axis before, whose lengths are in `lengths`.
fn residuals(
    coder: &mut impl Integers,
    model: &mut Residuals,
    visits: &[u32],
    prediction: &Prediction,
    plane: &mut [i32],
    lengths: &mut [usize],
) {
    let mut before = [0usize; 2];
    for (&i, length) in visits.iter().zip(lengths) {
        let vertex = prediction.order[i as usize] as usize;
        let guess = prediction.at(i as usize, plane);
        let near = (before[0] + before[1]).div_ceil(2).min(LENGTHS - 1);
        let context = near * (LENGTHS + 1) + *length;
        let value = plane[vertex].wrapping_sub(guess);
        let residual = coder.integer(&mut model.0, context, value);
        plane[vertex] = guess.wrapping_add(residual);
        let bits = magnitude_bits(residual) as usize;
        before = [bits, before[0]];
        *length = bits.min(LENGTHS - 1);
        if coder.spent() {
            return;
        }
    }
}

/// Lines through the corners of an icosahedron and the middles of its edges.
const DIRECTIONS: usize = 21;
/// Cosine of the angle between any direction and the nearest of them, at most 21 degrees.
const NEAREST: f64 = 0.934;

fn directions() -> [[f64; 3]; DIRECTIONS] {
    let g = f64::midpoint(1.0, 5f64.sqrt());
    let mut out = [[0.0; 3]; DIRECTIONS];
    let around = [[1.0, 0.0, 0.0], [0.0, 1.0, g], [0.0, 1.0, -g]].into_iter().chain(
        [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
            .map(|[a, b]| [g / 2.0, a / 2.0, b * g * g / 2.0]),
    );
    let turned = around.flat_map(|[x, y, z]| [[x, y, z], [y, z, x], [z, x, y]]);
    for (out, d) in out.iter_mut().zip(turned) {
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        *out = d.map(|x| x / length);
    }
    out
}

/// The coarsest step whose error stays within the tolerance, and that error.
///
/// The error of a pose is the neutral's and a sum of the shapes', each with a weight from 0 to 1: at
/// its farthest in some direction it is the sum of those that go that way. The farthest of all lies
/// near one of [`directions`], whose farthest is therefore at least [`NEAREST`] of it.
fn displacement_step(mesh: &Mesh, neutral: &[[i32; 3]]) -> (f32, f64) {
    // Displacements of a damaged size would leave the range of the integers.
    let largest =
        mesh.shapes.iter().flat_map(|s| &s.deltas).flatten().fold(0f32, |m, x| m.max(x.abs()));
    let finest = f64::from(largest) / f64::from(1 << 30);
    let directions = directions();
    let mut step = COARSEST_STEP;
    loop {
        let s = step as f32;
        let mut reach = vec![[[0f64; 2]; DIRECTIONS]; mesh.positions.len()];
        for shape in &mesh.shapes {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                let off = difference(*d, d.map(|x| quantised(x, s) as f32 * s));
                for (sides, u) in reach[v as usize].iter_mut().zip(&directions) {
                    let along = off[0] * u[0] + off[1] * u[1] + off[2] * u[2];
                    sides[usize::from(along < 0.0)] += along.abs();
                }
            }
        }
        let mut worst = 0f64;
        for ((p, q), reach) in mesh.positions.iter().zip(neutral).zip(&reach) {
            let off = difference(*p, q.map(|x| x as f32 * POSITION_STEP));
            let still = off.iter().map(|x| x * x).sum::<f64>().sqrt();
            let farthest = reach.iter().flatten().fold(0.0, |most: f64, x| most.max(*x));
            worst = worst.max(still + farthest / NEAREST);
        }
        if worst <= TOLERANCE || step <= finest.max(1e-9) {
            return (s, worst);
        }
        step *= 0.9;
    }
}

fn difference(a: [f32; 3], b: [f32; 3]) -> [f64; 3] {
    std::array::from_fn(|k| f64::from(a[k]) - f64::from(b[k]))
}

fn quantised(x: f32, step: f32) -> i32 {
    (f64::from(x) / f64::from(step)).round() as i32
}

/// Linear colour to a byte by its square root: dark tones need the finer steps, as in sRGB.
fn colour_to_byte(c: f32) -> u8 {
    (c.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8
}

fn colour_of_byte(byte: u8) -> f32 {
    (f32::from(byte) / 255.0).powi(2)
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
