//! A face in small: a curved sheet with bumps as shapes, and markers on it.

use mimique_geometry::Point;
use mimique_solver::{
    Fit, MethodSpec, OperatorOptions, OperatorParts, Operators, SkinMesh, SparseDeltas,
};

const WIDTH: usize = 15;

/// A curved sheet of 15 x 15 vertices with bumps as shapes: a face in small. `unit` numbers make
/// a metre.
pub fn sheet(unit: f64) -> (SkinMesh, Vec<String>, Vec<(String, usize)>) {
    let place = |i: usize| {
        let (x, y) = ((i % WIDTH) as f64 / 70.0 - 0.1, (i / WIDTH) as f64 / 70.0 - 0.1);
        Point::new(x, y, 0.1 - 3.0 * (x * x + 0.5 * y * y))
    };
    let positions: Vec<Point> = (0..WIDTH * WIDTH).map(place).collect();
    let at = |x: usize, y: usize| (y * WIDTH + x) as u32;
    let triangles = (0..(WIDTH - 1) * (WIDTH - 1))
        .flat_map(|i| {
            let (x, y) = (i % (WIDTH - 1), i / (WIDTH - 1));
            [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]
        })
        .collect();
    let shapes = (0..9)
        .map(|k| {
            let centre = place((3 + 4 * (k / 3)) * WIDTH + 3 + 4 * (k % 3));
            let turn = k as f64;
            let direction = [0.004 * turn.cos(), 0.006 * turn.sin(), 0.005];
            let mut shape = SparseDeltas::default();
            for (v, p) in positions.iter().enumerate() {
                let r2: f64 = (0..3).map(|a| (p[a] - centre[a]).powi(2)).sum();
                if r2 < 0.08 * 0.08 {
                    shape.vertices.push(v as u32);
                    shape.deltas.push(direction.map(|d| d * (-r2 / 0.0009).exp()).into());
                }
            }
            shape
        })
        .collect();
    let mut mesh = SkinMesh { positions, triangles, shapes };
    for p in &mut mesh.positions {
        *p = p.map(|x| x * unit);
    }
    for d in mesh.shapes.iter_mut().flat_map(|s| &mut s.deltas) {
        *d = d.map(|x| x * unit);
    }
    let names = (0..9).map(|k| format!("bump{k}")).collect();
    let markers = [32, 36, 41, 78, 82, 100, 112, 123, 150, 157, 172, 189]
        .into_iter()
        .enumerate()
        .map(|(i, v)| (format!("M{i:02}"), v))
        .collect();
    (mesh, names, markers)
}

pub fn operators(unit: f64, options: &OperatorOptions) -> Operators {
    let (mesh, names, markers) = sheet(unit);
    Operators::build(&mesh, &names, &markers, options).unwrap()
}

pub fn fit(spec: &MethodSpec) -> Fit {
    Fit::new(&operators(1.0, &OperatorOptions::of(spec)), spec).unwrap()
}

/// D c: what the markers do at the given weights.
pub fn displacements(parts: &OperatorParts, c: &[f64]) -> Vec<f64> {
    parts
        .marker_deltas
        .chunks(c.len())
        .map(|row| row.iter().zip(c).map(|(a, b)| a * b).sum())
        .collect()
}

pub fn noisy(c: &[f64], noise: f64) -> Vec<f64> {
    let mut seed = 7_u64;
    let d = displacements(operators(1.0, &OperatorOptions::default()).parts(), c);
    d.into_iter()
        .map(|d| {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            d + noise * ((seed >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0)
        })
        .collect()
}

pub const EXPRESSION: [f64; 9] = [0.2, 0.0, 0.7, 1.0, 0.4, 0.0, 0.9, 0.1, 0.5];
