//! One mesh in a pack: triangles, positions and displacements as small integers.

use super::bytes::{PackError, PackReader, PackWriter};
use super::connectivity::connect;
use super::entropy::{IntegerReader, IntegerWriter, Integers, Model};
use super::mirror::{Halves, Places};
use super::predict::Prediction;
use super::shapes::Shapes;
use super::steps::{STEPS, in_units, steps};
use super::values::{Residuals, Source, price};
use crate::{Mesh, Part, SparseShape, Textured};

/// Step of the neutral positions, metres: a micrometre of error on each axis.
pub(super) const POSITION_STEP: f32 = 2e-6;
/// Step of places in a picture: an eighth of a texel of the largest texture.
const UV_STEP: f32 = 1.0 / 16384.0;
/// Coarsest unit of displacements, metres: finer for a displacement of 2 km.
const COARSEST_UNIT: f32 = 4e-6;
/// Most that the two halves of a vertex differ on an axis, steps of positions: a rounding.
const SAME: u32 = 8;
/// How far from its guess a vertex's mirror image is looked for, steps of positions: three millimetres
/// along the axes together.
const REACH: i32 = 1500;

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

/// The neutral positions of a mesh as integers.
pub(super) fn neutral(mesh: &Mesh) -> Vec<[i32; 3]> {
    mesh.positions.iter().map(|p| p.map(|x| quantised(x, POSITION_STEP))).collect()
}

/// Writes a mesh; returns the largest error of any vertex over all poses with weights 0 to 1.
/// `places` knows the vertices of the meshes before it.
pub(super) fn mesh_to(out: &mut PackWriter, mesh: &Mesh, places: &mut Places) -> f64 {
    let mut neutral = neutral(mesh);
    let steps = steps(mesh, &neutral);
    out.text(&mesh.name);
    out.u8(PARTS.iter().position(|p| *p == mesh.part).unwrap_or(PARTS.len() - 1) as u8);
    mesh.base_colour.iter().for_each(|&c| out.f32(c));
    out.f32(steps.unit);
    out.u8(u8::from(!mesh.vertex_colours.is_empty()));
    out.varint(mesh.textured.len() as u32);
    for run in &mesh.textured {
        out.varint(run.triangles.start as u32);
        out.varint(run.triangles.len() as u32);
        out.varint(run.texture as u32);
    }
    let count = mesh.positions.len();
    out.varint(count as u32);
    out.varint(mesh.triangles.len() as u32);

    let mut coder = IntegerWriter::new();
    let mut triangles = mesh.triangles.clone();
    connect(&mut coder, &mut triangles);
    let prediction = Prediction::new(count, &mesh.triangles);
    let first = places.count();
    positions(&mut coder, &prediction, &mut neutral, places);
    let halves = Halves::new(&prediction, places, first);
    if !mesh.vertex_colours.is_empty() {
        let bytes = |c: &[f32; 3]| c.map(|c| i32::from(colour_to_byte(c)));
        let mut colours: Vec<_> = mesh.vertex_colours.iter().map(bytes).collect();
        plain(&mut coder, &prediction, &halves, &mut colours);
    }
    if !mesh.textured.is_empty() {
        let place = |v| {
            let [x, y] =
                mesh.uvs.get(v).map_or([0; 2], |uv: &[f32; 2]| uv.map(|x| quantised(x, UV_STEP)));
            [x, y, 0]
        };
        plain(&mut coder, &prediction, &halves, &mut (0..count).map(place).collect::<Vec<_>>());
    }
    if !mesh.shapes.is_empty() {
        let mut classes: Vec<_> =
            steps.places.iter().map(|&place| [i32::from(place), 0, 0]).collect();
        plain(&mut coder, &prediction, &halves, &mut classes);
        let of_vertex: Vec<i32> = steps.places.iter().map(|&p| STEPS[usize::from(p)]).collect();
        let mut shapes = Shapes::new(&prediction, &halves, of_vertex);
        for shape in &mesh.shapes {
            let moved = |(&v, d): (&u32, &[f32; 3])| {
                (v, in_units(*d, steps.unit, shapes.steps[v as usize]))
            };
            let moved: Vec<_> = shape.vertices.iter().zip(&shape.deltas).map(moved).collect();
            shapes.write(&mut coder, &moved);
        }
    }
    let coded = coder.into_bytes();
    out.varint(coded.len() as u32);
    out.raw(&coded);
    steps.error
}

/// What a pack says of a mesh before its numbers.
struct Header {
    name: String,
    part: Part,
    base_colour: [f32; 3],
    /// Unit of displacements, metres.
    unit: f32,
    coloured: bool,
    textured: Vec<Textured>,
    vertex_count: usize,
    triangle_count: usize,
}

/// Reads what stands before the numbers of a mesh, as far as it can be true.
fn header_from(r: &mut PackReader<'_>) -> Result<Header, PackError> {
    let name = r.text()?;
    let part = r.u8()? as usize;
    let Some(&part) = PARTS.get(part) else { return r.refuse(format!("part {part}")) };
    let base_colour = [r.f32()?, r.f32()?, r.f32()?];
    let unit = r.f32()?;
    if !(unit > 0.0 && unit <= COARSEST_UNIT) {
        let picometres = (f64::from(unit) * 1e12) as i64;
        return r.refuse(format!("displacements in units of {picometres} pm"));
    }
    let coloured = match r.u8()? {
        0 => false,
        1 => true,
        other => return r.refuse(format!("colour flag {other}")),
    };
    let textured = textured_from(r)?;
    let (vertex_count, triangle_count) = (r.varint()? as usize, r.varint()? as usize);
    if vertex_count.max(triangle_count) > MOST.min(r.left().saturating_mul(MOST_A_BYTE)) {
        return r.refuse(format!(
            "{vertex_count} vertices and {triangle_count} triangles in {} bytes",
            r.left()
        ));
    }
    if let Some(beyond) = textured.iter().map(|t| t.triangles.end).find(|end| *end > triangle_count)
    {
        return r.refuse(format!("a picture to triangle {beyond} of {triangle_count}"));
    }
    Ok(Header { name, part, base_colour, unit, coloured, textured, vertex_count, triangle_count })
}

/// Reads what [`mesh_to`] wrote.
pub(super) fn mesh_from(
    r: &mut PackReader<'_>,
    shape_count: usize,
    places: &mut Places,
) -> Result<Mesh, PackError> {
    let header = header_from(r)?;
    let Header { unit, vertex_count: count, triangle_count, .. } = header;
    let length = r.count(1)?;
    let mut coder = IntegerReader::new(r.raw(length)?);
    let mut triangles = vec![[0u32; 3]; triangle_count];
    connect(&mut coder, &mut triangles);
    if let Some(v) = triangles.iter().flatten().find(|v| **v as usize >= count) {
        return r.refuse(format!("triangle corner {v} of {count}"));
    }
    let prediction = Prediction::new(count, &triangles);
    let mut values = vec![[0i32; 3]; count];
    let first = places.count();
    positions(&mut coder, &prediction, &mut values, places);
    let positions = values.iter().map(|q| q.map(|x| x as f32 * POSITION_STEP)).collect();
    let halves = Halves::new(&prediction, places, first);
    let (mut vertex_colours, mut uvs) = (vec![], vec![]);
    if header.coloured && !coder.spent() {
        plain(&mut coder, &prediction, &halves, &mut values);
        vertex_colours =
            values.iter().map(|c| c.map(|c| colour_of_byte(c.clamp(0, 255) as u8))).collect();
    }
    if !header.textured.is_empty() && !coder.spent() {
        plain(&mut coder, &prediction, &halves, &mut values);
        uvs = values.iter().map(|q| [q[0], q[1]].map(|x| x as f32 * UV_STEP)).collect();
    }
    let mut read = Vec::new();
    if shape_count > 0 && !coder.spent() {
        plain(&mut coder, &prediction, &halves, &mut values);
        let step = |q: &[i32; 3]| STEPS[(q[0].max(0) as usize).min(STEPS.len() - 1)];
        let mut shapes = Shapes::new(&prediction, &halves, values.iter().map(step).collect());
        for _ in 0..shape_count {
            let Some(moved) = shapes.read(&mut coder) else { break };
            let (vertices, deltas) =
                moved.iter().map(|&(v, q)| (v, q.map(|x| x as f32 * unit))).unzip();
            read.push(SparseShape { vertices, deltas });
        }
    }
    if coder.spent() || read.len() < shape_count {
        return r.refuse(format!("mesh {} is damaged within {length} bytes", header.name));
    }
    Ok(Mesh {
        name: header.name,
        part: header.part,
        positions,
        triangles,
        vertex_colours,
        base_colour: header.base_colour,
        shapes: read,
        uvs,
        textured: header.textured,
    })
}

/// Neutral positions, written or read. Where a vertex is known near the mirror image of the guess, a
/// bit says whether it is the other half of this one.
fn positions(
    coder: &mut impl Integers,
    prediction: &Prediction,
    values: &mut [[i32; 3]],
    places: &mut Places,
) {
    let (mut residuals, mut halves) = (Residuals::new(), Model::new(4));
    let mut before = [true; 2];
    for (visit, &v) in prediction.order.iter().enumerate() {
        let mut guess = (Source::Neighbours, prediction.at(visit, values));
        let value = &mut values[v as usize];
        if let Some((image, _)) = places.across(guess.1, 0, REACH) {
            let near = (0..3).all(|k| value[k].abs_diff(image[k]) <= SAME);
            let context = 2 * usize::from(before[0]) + usize::from(before[1]);
            let half = coder.integer(&mut halves, context, i32::from(near)) != 0;
            if half {
                guess = (Source::Mirror, image);
            }
            before = [half, before[0]];
        }
        residuals.vertex(coder, guess.0, guess.1, 1, value);
        places.add(*value);
        if coder.spent() {
            return;
        }
    }
}

/// Values of all vertices, written or read, guessed from the other side if that pays. What a reader
/// hands in is overwritten.
fn plain(
    coder: &mut impl Integers,
    prediction: &Prediction,
    halves: &Halves,
    values: &mut [[i32; 3]],
) {
    let visits: Vec<u32> = (0..values.len() as u32).collect();
    let mirrored = |v: u32, values: &[[i32; 3]]| halves.known(v).map(|w| values[w as usize]);
    let alone = |_: u32, _: &[[i32; 3]]| None;
    let steps = vec![1; values.len()];
    let pays = coder.writes()
        && price(prediction, &visits, &steps, values, &mirrored)
            < price(prediction, &visits, &steps, values, &alone);
    let residuals = &mut Residuals::new();
    if coder.integer(&mut Model::new(1), 0, i32::from(pays)) != 0 {
        residuals.vertices(coder, prediction, &visits, &steps, values, &mirrored);
    } else {
        residuals.vertices(coder, prediction, &visits, &steps, values, &alone);
    }
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

pub(super) fn quantised(x: f32, step: f32) -> i32 {
    (f64::from(x) / f64::from(step)).round() as i32
}

/// Linear colour to a byte by its square root: dark tones need the finer steps, as in sRGB.
fn colour_to_byte(c: f32) -> u8 {
    (c.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8
}

fn colour_of_byte(byte: u8) -> f32 {
    (f32::from(byte) / 255.0).powi(2)
}
