//! One mesh in a pack: triangles, positions and displacements as small integers.

use super::bytes::{PackError, PackReader, PackWriter};
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

/// Writes a mesh; returns the largest error of any vertex over all poses with weights 0 to 1.
pub(super) fn mesh_to(out: &mut PackWriter, mesh: &Mesh) -> f64 {
    out.text(&mesh.name);
    out.u8(PARTS.iter().position(|p| *p == mesh.part).unwrap_or(PARTS.len() - 1) as u8);
    mesh.base_colour.iter().for_each(|&c| out.f32(c));
    out.varint(mesh.positions.len() as u32);
    out.varint(mesh.triangles.len() as u32);
    let mut last = [0u32; 3];
    for axis in 0..3 {
        for t in &mesh.triangles {
            // The first corner is near the last triangle's; the others are near the first.
            let reference = if axis == 0 { last[0] } else { t[0] };
            out.varint(zigzag(t[axis] as i32 - reference as i32));
            last = *t;
        }
    }
    out.u8(u8::from(!mesh.vertex_colours.is_empty()));
    for axis in 0..3 {
        mesh.vertex_colours.iter().for_each(|c| out.u8(colour_to_byte(c[axis])));
    }

    let prediction = Prediction::new(mesh.positions.len(), &mesh.triangles);
    let neutral: Vec<[i32; 3]> =
        mesh.positions.iter().map(|p| p.map(|x| quantised(x, POSITION_STEP))).collect();
    for axis in 0..3 {
        let values: Vec<i32> = neutral.iter().map(|q| q[axis]).collect();
        let visits = 0..prediction.order.len();
        residuals_to(out, visits.map(|i| (i, &values)), &prediction);
    }
    textured_to(out, mesh, &prediction);
    let (step, error) = displacement_step(mesh, &neutral);
    out.f32(step);
    let mut dense = vec![[0i32; 3]; mesh.positions.len()];
    for shape in &mesh.shapes {
        for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
            dense[v as usize] = d.map(|x| quantised(x, step));
        }
        shape_to(out, &dense, &prediction);
        shape.vertices.iter().for_each(|&v| dense[v as usize] = [0; 3]);
    }
    error
}

/// The runs of triangles with a picture, and where the vertices lie in it.
fn textured_to(out: &mut PackWriter, mesh: &Mesh, prediction: &Prediction) {
    out.varint(mesh.textured.len() as u32);
    for run in &mesh.textured {
        out.varint(run.triangles.start as u32);
        out.varint(run.triangles.len() as u32);
        out.varint(run.texture as u32);
    }
    if !mesh.textured.is_empty() {
        for axis in 0..2 {
            let at = |v| mesh.uvs.get(v).map_or(0, |uv: &[f32; 2]| quantised(uv[axis], UV_STEP));
            let values: Vec<i32> = (0..mesh.positions.len()).map(at).collect();
            let visits = 0..prediction.order.len();
            residuals_to(out, visits.map(|i| (i, &values)), prediction);
        }
    }
}

/// Reads what [`textured_to`] wrote.
fn textured_from(
    r: &mut PackReader<'_>,
    triangles: usize,
    prediction: &Prediction,
    plane: &mut [i32],
) -> Result<(Vec<Textured>, Vec<[f32; 2]>), PackError> {
    let mut runs = Vec::new();
    let mut free = 0;
    for _ in 0..r.count(3)? {
        let start = r.varint()? as usize;
        let end = start.saturating_add(r.varint()? as usize);
        if start < free || end > triangles {
            return r.refuse(format!("a picture on triangles {start} to {end} of {triangles}"));
        }
        free = end;
        runs.push(Textured { triangles: start..end, texture: r.varint()? as usize });
    }
    if runs.is_empty() {
        return Ok((runs, vec![]));
    }
    let mut uvs = vec![[0f32; 2]; plane.len()];
    let everywhere: Vec<u32> = (0..plane.len() as u32).collect();
    for axis in 0..2 {
        plane.fill(0);
        residuals_from(r, &everywhere, prediction, plane)?;
        uvs.iter_mut().zip(&*plane).for_each(|(uv, q)| uv[axis] = *q as f32 * UV_STEP);
    }
    Ok((runs, uvs))
}

/// Runs of resting and moving vertices in visiting order, then what moves.
fn shape_to(out: &mut PackWriter, dense: &[[i32; 3]], prediction: &Prediction) {
    let moves = |i: usize| dense[prediction.order[i] as usize] != [0; 3];
    let mut runs = Vec::new();
    let (mut start, mut moving) = (0, false);
    for i in 0..dense.len() {
        if moves(i) != moving {
            runs.push((i - start) as u32);
            (start, moving) = (i, !moving);
        }
    }
    if moving {
        runs.push((dense.len() - start) as u32);
    }
    out.varint(runs.len() as u32);
    runs.iter().for_each(|&r| out.varint(r));
    for axis in 0..3 {
        let values: Vec<i32> = dense.iter().map(|q| q[axis]).collect();
        let visits = (0..dense.len()).filter(|&i| moves(i));
        residuals_to(out, visits.map(|i| (i, &values)), prediction);
    }
}

/// The coarsest step whose error stays within the tolerance, and that error.
fn displacement_step(mesh: &Mesh, neutral: &[[i32; 3]]) -> (f32, f64) {
    // Displacements of a damaged size would leave the range of the integers.
    let largest =
        mesh.shapes.iter().flat_map(|s| &s.deltas).flatten().fold(0f32, |m, x| m.max(x.abs()));
    let finest = f64::from(largest) / f64::from(1 << 30);
    let mut step = COARSEST_STEP;
    loop {
        let s = step as f32;
        let mut error: Vec<f64> = mesh
            .positions
            .iter()
            .zip(neutral)
            .map(|(p, q)| distance(*p, q.map(|x| x as f32 * POSITION_STEP)))
            .collect();
        for shape in &mesh.shapes {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                error[v as usize] += distance(*d, d.map(|x| quantised(x, s) as f32 * s));
            }
        }
        let worst = error.into_iter().fold(0.0, f64::max);
        if worst <= TOLERANCE || step <= finest.max(1e-9) {
            return (s, worst);
        }
        step *= 0.9;
    }
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f64 {
    (0..3).map(|k| (f64::from(a[k]) - f64::from(b[k])).powi(2)).sum::<f64>().sqrt()
}

fn quantised(x: f32, step: f32) -> i32 {
    (f64::from(x) / f64::from(step)).round() as i32
}

/// How far the values of the visits lie from their guess: low bytes together, high parts together,
/// since they differ in kind and deflate best apart.
fn residuals_to<'v>(
    out: &mut PackWriter,
    visits: impl Iterator<Item = (usize, &'v Vec<i32>)> + Clone,
    prediction: &Prediction,
) {
    let residual = |(i, values): (usize, &Vec<i32>)| {
        let value = values[prediction.order[i] as usize];
        zigzag(value.wrapping_sub(prediction.at(i, values)))
    };
    visits.clone().for_each(|visit| out.u8(residual(visit) as u8));
    visits.for_each(|visit| out.varint(residual(visit) >> 8));
}

/// Reads what [`mesh_to`] wrote.
pub(super) fn mesh_from(r: &mut PackReader<'_>, shapes: usize) -> Result<Mesh, PackError> {
    let name = r.text()?;
    let part = r.u8()? as usize;
    let Some(&part) = PARTS.get(part) else { return r.refuse(format!("part {part}")) };
    let base_colour = [r.f32()?, r.f32()?, r.f32()?];
    // A vertex takes six bytes at least, a triangle three.
    let vertices = r.count(6)?;
    let count = r.count(3)?;
    let mut triangles = vec![[0u32; 3]; count];
    let mut last = 0u32;
    for axis in 0..3 {
        for triangle in &mut triangles {
            let reference = if axis == 0 { last } else { triangle[0] };
            let v = reference.wrapping_add(unzigzag(r.varint()?) as u32);
            if v as usize >= vertices {
                return r.refuse(format!("triangle corner {v} of {vertices}"));
            }
            triangle[axis] = v;
            last = v;
        }
    }
    let vertex_colours = match r.u8()? {
        0 => vec![],
        1 => {
            let planes = [r.raw(vertices)?, r.raw(vertices)?, r.raw(vertices)?];
            (0..vertices).map(|v| planes.map(|p| colour_of_byte(p[v]))).collect()
        }
        other => return r.refuse(format!("colour flag {other}")),
    };
    let prediction = Prediction::new(vertices, &triangles);
    let mut plane = vec![0i32; vertices];
    let mut positions = vec![[0f32; 3]; vertices];
    let everywhere: Vec<u32> = (0..vertices as u32).collect();
    for axis in 0..3 {
        residuals_from(r, &everywhere, &prediction, &mut plane)?;
        for (p, q) in positions.iter_mut().zip(&plane) {
            p[axis] = *q as f32 * POSITION_STEP;
        }
    }
    let (textured, uvs) = textured_from(r, count, &prediction, &mut plane)?;
    let step = r.f32()?;
    let shapes = (0..shapes)
        .map(|_| shape_from(r, &prediction, step, &mut plane))
        .collect::<Result<_, _>>()?;
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

fn shape_from(
    r: &mut PackReader<'_>,
    prediction: &Prediction,
    step: f32,
    plane: &mut [i32],
) -> Result<SparseShape, PackError> {
    let mut visits: Vec<u32> = Vec::new();
    let mut at = 0u32;
    for run in 0..r.count(1)? {
        let end = at.saturating_add(r.varint()?);
        if end as usize > plane.len() {
            return r.refuse(format!("a run to vertex {end} of {}", plane.len()));
        }
        if run % 2 == 1 {
            visits.extend(at..end);
        }
        at = end;
    }
    let mut moved: Vec<(u32, [f32; 3])> =
        visits.iter().map(|&i| (prediction.order[i as usize], [0.0; 3])).collect();
    for axis in 0..3 {
        plane.fill(0);
        residuals_from(r, &visits, prediction, plane)?;
        for (v, delta) in &mut moved {
            delta[axis] = plane[*v as usize] as f32 * step;
        }
    }
    moved.sort_unstable_by_key(|(v, _)| *v);
    let (vertices, deltas) = moved.into_iter().unzip();
    Ok(SparseShape { vertices, deltas })
}

fn residuals_from(
    r: &mut PackReader<'_>,
    visits: &[u32],
    prediction: &Prediction,
    plane: &mut [i32],
) -> Result<(), PackError> {
    let low = r.raw(visits.len())?;
    for (&i, &low) in visits.iter().zip(low) {
        let residual = unzigzag((r.varint()? << 8) | u32::from(low));
        let guess = prediction.at(i as usize, plane);
        plane[prediction.order[i as usize] as usize] = guess.wrapping_add(residual);
    }
    Ok(())
}

/// Linear colour to a byte by its square root: dark tones need the finer steps, as in sRGB.
fn colour_to_byte(c: f32) -> u8 {
    (c.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8
}

fn colour_of_byte(byte: u8) -> f32 {
    (f32::from(byte) / 255.0).powi(2)
}

/// Small numbers of either sign to small numbers without.
fn zigzag(x: i32) -> u32 {
    ((x << 1) ^ (x >> 31)) as u32
}

fn unzigzag(x: u32) -> i32 {
    ((x >> 1) as i32) ^ -((x & 1) as i32)
}
