//! `toy.json`: a small mesh with every matrix of the method and the weights of one displacement.

use std::path::Path;

use mimique_geometry::Point;
use mimique_solver::{
    Fit, Laplacian, LaplacianKind, MethodSpec, OperatorOptions, Operators, SkinMesh, SparseDeltas,
    Unit, apply_shell, mixed_voronoi_areas,
};
use serde_json::Value;

use super::{head, variants};
use crate::case::{Tolerance, number, numbers, rows};
use crate::document::{Document, Part};
use crate::{Case, VerifyError};

/// Everything, as a share of the matrix' largest entry.
const SHARE: f64 = 1e-12;

/// The toy, one case.
pub(super) fn case(file: &Path) -> Result<Case, VerifyError> {
    let document = Document::read(file)?;
    let toy = document.root();
    let (mesh, vertices) = mesh(&toy)?;
    let mut case = Case::new("toy");
    matrices(&mut case, &toy, &mesh)?;
    let names: Vec<String> = (0..mesh.shapes.len()).map(|k| format!("shape{k}")).collect();
    let markers: Vec<(String, usize)> = vertices.iter().map(|&v| (format!("M{v}"), v)).collect();
    let operators = match Operators::build(&mesh, &names, &markers, &OperatorOptions::default()) {
        Ok(operators) => operators,
        Err(why) => {
            case.refused("operators", &why);
            return Ok(case);
        }
    };
    let gram = rows(&operators.parts().shell_gram, names.len());
    head::near_largest(&mut case, "H_uniform_nonmarker", &toy.get("H_uniform_nonmarker")?, &gram)?;
    let relative = Tolerance::Relative { share: SHARE, floor: 0.0 };
    case.compare("ell2", toy.get("ell2")?.value(), &number(operators.data_scale()), relative);
    case.compare("tau", toy.get("tau")?.value(), &number(operators.shell_scale()), relative);
    solutions(&mut case, &toy, &operators)?;
    Ok(case)
}

/// Rows of three numbers.
fn triples(part: &Part<'_>) -> Result<Vec<[f64; 3]>, VerifyError> {
    let numbers = part.numbers()?;
    let (triples, rest) = numbers.as_chunks::<3>();
    if rest.is_empty() { Ok(triples.to_vec()) } else { Err(part.wrong("rows of three numbers")) }
}

/// The mesh, and the vertices of its markers.
fn mesh(toy: &Part<'_>) -> Result<(SkinMesh, Vec<usize>), VerifyError> {
    let positions: Vec<Point> =
        triples(&toy.get("vertices")?)?.into_iter().map(Point::from).collect();
    let count = positions.len();
    let mut triangles = Vec::new();
    for triangle in toy.get("triangles")?.list()? {
        let corners = triangle.indices_below(count, "a vertex of the mesh")?;
        let [a, b, c] = corners[..] else { return Err(triangle.wrong("three vertices")) };
        triangles.push([a, b, c].map(|vertex| vertex as u32));
    }
    let mut shapes = Vec::new();
    for deltas in toy.get("deltas")?.list()? {
        let own = triples(&deltas)?;
        if own.len() != count {
            return Err(deltas.wrong("a displacement of every vertex"));
        }
        let deltas = own.into_iter().map(Into::into).collect();
        shapes.push(SparseDeltas { vertices: (0..count as u32).collect(), deltas });
    }
    let markers = toy.get("markers")?.indices_below(count, "a vertex of the mesh")?;
    Ok((SkinMesh { positions, triangles, shapes }, markers))
}

/// A of both Laplacians, areas, and A applied to the shapes.
fn matrices(case: &mut Case, toy: &Part<'_>, mesh: &SkinMesh) -> Result<(), VerifyError> {
    let count = mesh.positions.len();
    let uniform = Laplacian::new(&mesh.positions, &mesh.triangles, LaplacianKind::Uniform);
    let cotangent = Laplacian::cotangent_over_areas(&mesh.positions, &mesh.triangles);
    for (key, laplacian) in [("A_uniform", &uniform), ("A_cot", &cotangent)] {
        let mut matrix = vec![0.0; count * count];
        for column in 0..count {
            let unit: Vec<f64> = (0..count).map(|i| f64::from(u8::from(i == column))).collect();
            for (row, x) in apply_shell(laplacian, 1.0, 1.0, &unit).into_iter().enumerate() {
                matrix[row * count + column] = x;
            }
        }
        head::near_largest(case, key, &toy.get(key)?, &rows(&matrix, count))?;
    }
    let areas = mixed_voronoi_areas(&mesh.positions, &mesh.triangles);
    head::near_largest(case, "area_mixed", &toy.get("area_mixed")?, &numbers(&areas))?;
    let all: Vec<usize> = (0..count).collect();
    let applied = head::shell_rows(mesh, &uniform, &all);
    head::near_largest(case, "AB", &toy.get("AB")?, &rows(&applied, mesh.shapes.len()))
}

/// The weights of the file's displacement by each method.
fn solutions(case: &mut Case, toy: &Part<'_>, operators: &Operators) -> Result<(), VerifyError> {
    let displacement = toy.get("d")?.numbers()?;
    let stored = toy.get("solutions")?;
    let constant = |method: &str, key: &str| -> Option<f64> {
        stored.find(method)?.find(key)?.value().as_f64()
    };
    // Eq. 5.30 as printed has alpha itself before the thin shell; F3 has kappa alpha / tau there.
    let alpha = constant("thesis_literal", "wts").unwrap_or(0.5);
    let kappa = constant("F3", "wts").map_or(0.1, |w| w * operators.shell_scale() / alpha);
    for (name, solution) in stored.members()? {
        let field = format!("solutions/{name}/c");
        let by = Tolerance::Absolute(SHARE);
        let outcome = variants::spec(name).and_then(|spec| {
            let own = MethodSpec {
                alpha: Some(alpha),
                kappa: name.starts_with("F3").then_some(kappa).or(spec.kappa),
                unit: name.contains("literal").then_some(Unit::M),
                ..spec
            };
            let fit = Fit::new(operators, &own).map_err(|why| why.to_string())?;
            fit.solve_frame(&displacement).map_err(|why| why.to_string())
        });
        let shown = |solved: mimique_solver::FrameSolution| -> Value { numbers(&solved.weights) };
        case.compare_outcome(&field, solution.get("c")?.value(), outcome, by, shown);
    }
    Ok(())
}
