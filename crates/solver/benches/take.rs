//! Frames per second on the planted take (5,660 frames, S = 11,248, N = 53, P = 40), and set-up.
//!
//! `cargo bench -p mimique-solver`; reads the real data as the tests do, one thread.
#![allow(missing_docs)]

#[path = "../tests/it/support/mod.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod support;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mimique_solver::{
    Fit, FrontEnd, Laplacian, LaplacianKind, MarkerColumns, MarkerFrames, Method, MethodSpec,
    OperatorOptions, Operators, Synthesis, shell_gram,
};

fn take(c: &mut Criterion) {
    let Some(data) = mimique_test_support::real_data("benches") else { return };
    let operators = support::operators(&data, &OperatorOptions::default());
    let avatar = &operators.parts().marker_positions;
    let (frames, cells) = support::table(&data.join("lsts/take_n01.csv"), 2);
    let metres: Vec<f64> = cells.iter().map(|x| x / 1000.0).collect();
    let take = MarkerFrames { positions: &metres, columns: 46 };
    let columns = MarkerColumns { face: (0..40).collect(), head: Some((40..46).collect()) };
    let solve_front_end = || {
        let poses = FrontEnd::head_poses(take, &columns, None).unwrap();
        let front = FrontEnd::fit(take, &columns, &poses, 0..60, avatar).unwrap();
        front.take_displacements(take, &poses).unwrap()
    };

    let mut group = c.benchmark_group("take");
    group.sample_size(10).throughput(Throughput::Elements(frames as u64));
    group.bench_function("front end", |b| b.iter(|| black_box(solve_front_end())));
    let d = solve_front_end();
    for (method, alpha) in [
        (Method::Lsts, Some(0.3)),
        (Method::LstsNorm, Some(0.5)),
        (Method::LstsShort, Some(0.5)),
        (Method::Ridge, None),
        (Method::A2f, None),
        (Method::Sparse, None),
        (Method::SmoothSparse, None),
        (Method::Greedy, None),
        (Method::Box, None),
    ] {
        let mut spec = MethodSpec::new(method);
        spec.alpha = alpha;
        let fit = Fit::new(&operators, &spec).unwrap();
        group.bench_function(method.name(), |b| b.iter(|| black_box(fit.solve_take(&d).unwrap())));
    }
    let (mesh, names) = support::skin(&data);
    let mut spec = MethodSpec::new(Method::Lsts);
    spec.alpha = Some(0.3);
    let weights = Fit::new(&operators, &spec).unwrap().solve_take(&d).unwrap().weights;
    let synthesis = Synthesis::new(&mesh);
    let mut out = vec![0.0; Synthesis::FRAMES * synthesis.coordinates()];
    group.bench_function("synthesis", |b| {
        b.iter(|| {
            for frames in weights.chunks(Synthesis::FRAMES * names.len()) {
                synthesis.pose(black_box(frames), &mut out);
                black_box(&out);
            }
        });
    });
    group.finish();

    let markers = support::markers(&data, "face");
    let vertices: Vec<usize> = markers.iter().map(|m| m.1).collect();
    let mut group = c.benchmark_group("set-up");
    group.sample_size(10);
    group.bench_function("weld", |b| b.iter(|| black_box(mesh.weld().unwrap())));
    group.bench_function("Laplacian", |b| {
        b.iter(|| {
            Laplacian::new(black_box(&mesh.positions), &mesh.triangles, LaplacianKind::Uniform)
        });
    });
    let laplacian = Laplacian::new(&mesh.positions, &mesh.triangles, LaplacianKind::Uniform);
    group.bench_function("AB and H", |b| {
        b.iter(|| black_box(shell_gram(&mesh, &laplacian, 1.0, 1.0, &vertices)));
    });
    group.bench_function("all", |b| {
        b.iter(|| {
            Operators::build(black_box(&mesh), &names, &markers, &OperatorOptions::default())
                .unwrap()
        });
    });
    group.finish();
}

criterion_group!(benches, take);
criterion_main!(benches);
