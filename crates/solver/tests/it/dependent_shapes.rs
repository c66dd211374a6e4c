//! A bank with visemes made of its other shapes, as many heads have: the markers cannot tell them from
//! their parts, the answers stay those of a face.

use mimique_geometry::Displacement;
use mimique_solver::{
    Fit, LARGEST_WEIGHT, Method, MethodSpec, OperatorOptions, Operators, SparseDeltas,
};
use mimique_test_support::real_data;

use crate::support;

/// The combination of some shapes, rounded as an avatar file stores it.
fn combined(shapes: &[SparseDeltas], vertices: usize, parts: &[(usize, f64)]) -> SparseDeltas {
    let mut dense = vec![Displacement::ZERO; vertices];
    for &(shape, weight) in parts {
        for (&vertex, &delta) in shapes[shape].vertices.iter().zip(&shapes[shape].deltas) {
            dense[vertex as usize] += weight * delta;
        }
    }
    let rounded = |d: Displacement| d.map(|x| f64::from(x as f32));
    let (vertices, deltas) = (dense.iter().zip(0..))
        .filter(|(d, _)| **d != Displacement::ZERO)
        .map(|(d, vertex)| (vertex, rounded(*d)))
        .unzip();
    SparseDeltas { vertices, deltas }
}

#[test]
fn visemes_made_of_other_shapes_change_no_face() {
    let Some(data) = real_data("visemes_made_of_other_shapes_change_no_face") else { return };
    let (mut mesh, mut names) = support::skin(&data);
    let markers = support::markers(&data, "face");
    let (frames, d) = support::table(&data.join("lsts/frames/_Dm_metres.csv"), 1);
    let specs = [Method::Nnls, Method::Box, Method::Kouadio, Method::Lsts, Method::Ridge]
        .map(MethodSpec::new);
    let built = |mesh: &_, names: &[String], spec: &MethodSpec| {
        Operators::build(mesh, names, &markers, &OperatorOptions::of(spec)).expect("operators")
    };
    let plain: Vec<_> = specs
        .iter()
        .map(|spec| {
            let operators = built(&mesh, &names, spec);
            Fit::new(&operators, spec).unwrap().solve_take(&d).unwrap()
        })
        .collect();

    let count = mesh.shapes.len();
    for viseme in 0..16 {
        let of = |k: usize| (7 * viseme + 11 * k) % count;
        let parts = [(of(0), 0.6), (of(1), 0.3), (of(2), 0.15)];
        let shape = combined(&mesh.shapes[..count], mesh.positions.len(), &parts);
        mesh.shapes.push(shape);
        names.push(format!("viseme_{viseme}"));
    }
    for (spec, plain) in specs.iter().zip(plain) {
        let operators = built(&mesh, &names, spec);
        let fit = Fit::new(&operators, spec).unwrap();
        // The prior of the ridge tells them apart by itself.
        assert_eq!(fit.chooses_least_norm(), spec.method != Method::Ridge, "{}", spec.method);
        let solved = fit.solve_take(&d).unwrap();
        assert_eq!(solved.reports.len(), frames);
        let largest = support::largest(&solved.weights);
        let before = support::largest(&plain.weights);
        eprintln!("{}: largest weight {largest:.3}, {before:.3} without visemes", spec.method);
        assert!(largest < 0.5 * LARGEST_WEIGHT, "{}: {largest}", spec.method);
        for (report, before) in solved.reports.iter().zip(&plain.reports) {
            assert_eq!(report.warning, None, "{}", spec.method);
            assert!(report.kkt_error < 1e-9, "{}: {report:?}", spec.method);
            // What fits the markers without visemes fits them with visemes.
            let slack = if spec.method == Method::Kouadio { 1.2 } else { 1.01 };
            assert!(report.residual < slack * before.residual + 1e-5, "{}", spec.method);
        }
    }
}
