//! A mesh four times as fine: the same face, and frames that cost the same (METHOD, tests 7 and 8).

#[path = "../../../stimulus/benches/mesh/mod.rs"]
#[allow(dead_code, reason = "the benchmarks use the rest")]
mod mesh;

use mimique_geometry::{Displacement, Point};
use mimique_solver::{Fit, Method, MethodSpec, OperatorOptions, Operators, SkinMesh, SparseDeltas};
use mimique_test_support::real_data;

use crate::support;

/// The forms that are free of units and of the mesh's density.
const NORMALISED: [Method; 4] =
    [Method::Lsts, Method::LstsSoft, Method::LstsNorm, Method::LstsShort];

/// A skin, its shapes' names, and its markers.
type Scene = (SkinMesh, Vec<String>, Vec<(String, usize)>);

/// Rounded hills on a curved sheet of 0.2 m, 24 x 24 squares times `parts` x `parts`.
fn hills(parts: usize) -> Scene {
    let width = 24 * parts + 1;
    let step = 0.2 / (24 * parts) as f64;
    let place = |i: usize| {
        let (x, y) = ((i % width) as f64 * step - 0.1, (i / width) as f64 * step - 0.1);
        Point::new(x, y, 0.1 - 3.0 * (x * x + 0.5 * y * y))
    };
    let positions: Vec<Point> = (0..width * width).map(place).collect();
    let at = |x: usize, y: usize| (y * width + x) as u32;
    let triangles = (0..(width - 1) * (width - 1))
        .flat_map(|i| {
            let (x, y) = (i % (width - 1), i / (width - 1));
            [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]
        })
        .collect();
    let shapes = (0..9)
        .map(|k| {
            let centre = place(parts * ((5 + 7 * (k / 3)) * width + 5 + 7 * (k % 3)));
            let direction = [0.004 * (k as f64).cos(), 0.006 * (k as f64).sin(), 0.005];
            let mut shape = SparseDeltas::default();
            for (v, p) in positions.iter().enumerate() {
                let r2: f64 = (0..3).map(|a| (p[a] - centre[a]).powi(2)).sum();
                shape.vertices.push(v as u32);
                shape.deltas.push(direction.map(|d| d * (-r2 / 0.0016).exp()).into());
            }
            shape
        })
        .collect();
    let names = (0..9).map(|k| format!("hill{k}")).collect();
    let vertex = |m: usize| parts * ((3 + 6 * (m / 4)) * width + 3 + 6 * (m % 4));
    let markers = (0..16).map(|m| (format!("M{m:02}"), vertex(m)));
    (SkinMesh { positions, triangles, shapes }, names, markers.collect())
}

/// Root mean square distance of the skin's vertices under two answers, over all frames, millimetres.
fn apart(mesh: &SkinMesh, a: &[f64], b: &[f64]) -> f64 {
    let n = mesh.shapes.len();
    let mut squares = 0.0;
    for (a, b) in a.chunks_exact(n).zip(b.chunks_exact(n)) {
        let mut difference = vec![Displacement::ZERO; mesh.positions.len()];
        for (shape, (a, b)) in mesh.shapes.iter().zip(a.iter().zip(b)) {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                difference[v as usize] += (a - b) * *d;
            }
        }
        squares += difference.iter().map(|d| d.length_squared()).sum::<f64>();
    }
    1e3 * (squares / (mesh.positions.len() * a.len() / n) as f64).sqrt()
}

/// Each normalised form on both skins; the markers are at the same places.
fn check(coarse: &Scene, fine: &Scene, d: &[f64], most_mm: [f64; 4]) {
    assert_eq!(fine.0.triangles.len(), 4 * coarse.0.triangles.len());
    let found = NORMALISED.map(|method| {
        let spec = MethodSpec::new(method);
        let build = |(mesh, names, markers): &Scene| {
            Operators::build(mesh, names, markers, &OperatorOptions::of(&spec)).unwrap()
        };
        let (of_coarse, of_fine) = (build(coarse), build(fine));
        // What a frame reads has the same size: its time cannot depend on S.
        let sizes = |o: &Operators| (o.parts().marker_deltas.len(), o.parts().shell_gram.len());
        assert_eq!(sizes(&of_coarse), sizes(&of_fine));
        assert!(
            support::worst(&of_coarse.parts().marker_deltas, &of_fine.parts().marker_deltas)
                < 1e-15
        );
        assert_ne!(of_coarse.parts().shell_gram, of_fine.parts().shell_gram);
        let solve = |o: &Operators| Fit::new(o, &spec).unwrap().solve_take(d).unwrap().weights;
        let (a, b) = (solve(&of_coarse), solve(&of_fine));
        let moved = apart(&coarse.0, &a, &vec![0.0; a.len()]);
        let mm = apart(&coarse.0, &a, &b);
        eprintln!("{method}: {mm:.4} mm of {moved:.2}");
        mm
    });
    assert!(found.iter().zip(most_mm).all(|(found, most)| *found < most), "{found:?} mm");
}

#[test]
fn a_sheet_four_times_as_fine_moves_alike() {
    let scene = hills(2);
    let d: Vec<f64> = (0..10)
        .flat_map(|frame| {
            let weights: Vec<f64> =
                (0..9).map(|k| 0.5 + 0.5 * (1.7 * f64::from(frame) + k as f64).sin()).collect();
            let mut row = vec![0.0; 48];
            for (shape, w) in scene.0.shapes.iter().zip(&weights) {
                for (m, (_, v)) in scene.2.iter().enumerate() {
                    (0..3).for_each(|a| row[3 * m + a] += w * shape.deltas[*v][a]);
                }
            }
            row.iter_mut().enumerate().for_each(|(i, x)| *x += 2e-4 * (2.3 * i as f64).sin());
            row
        })
        .collect();
    check(&scene, &hills(4), &d, [0.02, 0.03, 0.15, 0.03]);
}

#[test]
fn a_real_skin_four_times_as_fine_moves_alike() {
    let Some(data) = real_data("a_real_skin_four_times_as_fine_moves_alike") else { return };
    let (skin, names) = support::skin(&data);
    let (_, d) = support::table(&data.join("lsts/frames/_Dm_metres.csv"), 1);
    // Cut along straight lines: old vertices stay, and keep their numbers.
    let finer = mesh::finer(&skin, 2);
    let markers = support::markers(&data, "face");
    let coarse = (skin, names.clone(), markers.clone());
    check(&coarse, &(finer, names, markers), &d, [0.1, 0.1, 0.15, 0.12]);
}
