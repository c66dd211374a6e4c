//! The planted problem of the real data, read for tests.

pub mod sheet;

use std::path::Path;

use mimique_solver::{OperatorOptions, Operators, SkinMesh, SparseDeltas};
use serde_json::Value;

/// The skin of the planted problem, welded, and its shape names.
pub fn skin(data: &Path) -> (SkinMesh, Vec<String>) {
    read_skin(&data.join("lsts/avatar_skin.glb"))
}

/// The skin of an avatar file, welded, and its shape names.
pub fn read_skin(file: &Path) -> (SkinMesh, Vec<String>) {
    let avatar = mimique_avatar_files::read_avatar(file).expect("the avatar file").avatar;
    let skin = avatar.skin().expect("a skin");
    let mesh = SkinMesh {
        positions: skin.positions.iter().map(|p| p.map(f64::from).into()).collect(),
        triangles: skin.triangles.clone(),
        shapes: (skin.shapes.iter())
            .map(|s| SparseDeltas {
                vertices: s.vertices.clone(),
                deltas: s.deltas.iter().map(|d| d.map(f64::from).into()).collect(),
            })
            .collect(),
    };
    (mesh.weld().expect("a sound mesh").mesh, avatar.shape_names)
}

/// Labels and vertices of the face (or head) markers.
pub fn markers(data: &Path, role: &str) -> Vec<(String, usize)> {
    let text = std::fs::read_to_string(data.join("lsts/mapping.csv")).unwrap();
    (text.lines().skip(1))
        .map(|line| line.split(',').collect::<Vec<_>>())
        .filter(|cells| cells[1] == role)
        .map(|cells| (cells[0].to_owned(), cells[2].parse().unwrap()))
        .collect()
}

pub fn operators(data: &Path, options: &OperatorOptions) -> Operators {
    let (mesh, names) = skin(data);
    Operators::build(&mesh, &names, &markers(data, "face"), options).expect("operators")
}

pub fn json(file: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap()
}

/// Numbers of a (nested) JSON array, in order.
pub fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().unwrap()],
    }
}

/// The cells of a CSV after its first `skip` columns: (rows, numbers).
pub fn table(file: &Path, skip: usize) -> (usize, Vec<f64>) {
    let text = std::fs::read_to_string(file).unwrap();
    let rows: Vec<&str> = text.lines().skip(1).filter(|l| !l.is_empty()).collect();
    let cells = |row: &str| -> Vec<f64> {
        row.split(',').skip(skip).map(|c| c.trim().parse().unwrap_or(f64::NAN)).collect()
    };
    (rows.len(), rows.iter().flat_map(|r| cells(r)).collect())
}

/// The largest difference; NaN counts as infinite.
pub fn worst(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |s, (x, y)| {
        let d = (x - y).abs();
        if d.is_nan() { f64::INFINITY } else { s.max(d) }
    })
}

/// The largest entry, absolute.
pub fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |s, x| s.max(x.abs()))
}
