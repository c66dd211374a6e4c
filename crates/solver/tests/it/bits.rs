//! The same bits everywhere: a hash of every method's weights on a made-up take, written here.
//!
//! A change of the solver may change the hashes: then they are written anew, on purpose. The same
//! values on another processor, or with other features, is what this test is for. Inputs are made
//! with exact operations only, since `sin` and `exp` of the platform differ in their last bits.

use mimique_geometry::{Displacement, Point};
use mimique_solver::{
    Fit, FrontEnd, Lowpass, MarkerColumns, MarkerFrames, MarkerSite, Method, MethodSpec,
    OperatorOptions, Operators, Regression, SkinMesh, SparseDeltas, SurfaceResponse,
    TrainingOptions,
};

/// Numbers in -1..1 from a linear congruence: the same on every machine.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A bulging sheet of `width` x `width` vertices, its 14 shapes and 15 markers.
fn sheet(width: usize) -> (SkinMesh, Vec<String>, Vec<(String, usize)>) {
    let spacing = 64.0 * width as f64 / 12.0;
    let mut noise = Numbers(3);
    let positions: Vec<Point> = (0..width * width)
        .map(|i| {
            let (x, y) = ((i % width) as f64 / spacing, (i / width) as f64 / spacing);
            Point::new(x, y, 0.1 - 2.0 * (x - 0.08) * (x - 0.08) - (y - 0.08) * (y - 0.08))
        })
        .collect();
    let at = |x: usize, y: usize| (y * width + x) as u32;
    let triangles = (0..(width - 1) * (width - 1))
        .flat_map(|i| {
            let (x, y) = (i % (width - 1), i / (width - 1));
            [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]
        })
        .collect();
    let shapes = (0..14)
        .map(|k| {
            let centre = positions[(k * 41 + 13) % positions.len()];
            let direction = [noise.next() * 0.01, noise.next() * 0.01, noise.next() * 0.01];
            let (vertices, deltas) = (positions.iter().enumerate())
                .filter_map(|(v, p)| {
                    let r2: f64 = (0..3).map(|a| (p[a] - centre[a]) * (p[a] - centre[a])).sum();
                    let bump = 1.0 - r2 / 0.006;
                    (bump > 0.0)
                        .then(|| (v as u32, Displacement::from(direction.map(|d| d * bump * bump))))
                })
                .unzip();
            SparseDeltas { vertices, deltas }
        })
        .collect();
    let mesh = SkinMesh { positions, triangles, shapes };
    let names: Vec<String> = (0..14).map(|k| format!("shape{k}")).collect();
    let markers: Vec<(String, usize)> =
        (0..15).map(|m| (format!("M{m}"), (m * 29 + 17) % (width * width))).collect();
    (mesh, names, markers)
}

fn operators(width: usize, options: &OperatorOptions) -> Operators {
    let (mesh, names, markers) = sheet(width);
    Operators::build(&mesh, &names, &markers, options).unwrap()
}

/// The surface moved by the markers.
fn surface(spec: &MethodSpec) -> Operators {
    let (mesh, _, markers) = sheet(12);
    let (options, held) = (OperatorOptions::of(spec), vec![false; mesh.positions.len()]);
    let vertices: Vec<usize> = markers.iter().map(|m| m.1).collect();
    let response = SurfaceResponse::build(&mesh, &vertices, &held, &options).unwrap();
    let sites: Vec<MarkerSite> =
        markers.into_iter().map(|(label, v)| MarkerSite::at_vertex(label, v)).collect();
    response.operators(&mesh, &sites, &options).unwrap()
}

/// What is learnt of the take itself, with the weights of least squares.
fn learnt(plain: &Operators, d: &[f64]) -> Operators {
    let spec = MethodSpec::new(Method::Box);
    let weights = Fit::new(plain, &spec).unwrap().solve_take(d).unwrap().weights;
    let options = TrainingOptions { capacity: Some(60), given: [None; 3] };
    let model = Regression::train(d, 45, &weights, 14, &options).unwrap();
    plain.clone().with_regression(model).unwrap()
}

/// 150 frames of 15 face markers and 4 head markers; some are lost.
fn take(operators: &Operators) -> Vec<f64> {
    let mut noise = Numbers(11);
    let n = operators.shape_count();
    let mut c = vec![0.0; n];
    let mut out = Vec::new();
    for frame in 0..150 {
        for c in &mut c {
            let pull = if frame < 10 { 0.0 } else { 0.2 * (4.0 * noise.next() + 0.4 - *c) };
            *c += pull;
        }
        let deltas = &operators.parts().marker_deltas;
        for (m, p) in operators.parts().marker_positions.iter().enumerate() {
            let lost = frame > 20 && (frame * 7 + m * 3) % 101 == 0;
            for a in 0..3 {
                let row = &deltas[(3 * m + a) * n..(3 * m + a + 1) * n];
                let moved: f64 = row.iter().zip(&c).map(|(d, c)| d * c).sum();
                let x = 1.1 * p[a] + moved + 1e-4 * noise.next();
                out.push(if lost { f64::NAN } else { x });
            }
        }
        for head in [[0.0, 0.2, 0.1], [0.2, 0.2, 0.0], [0.1, 0.25, 0.05], [0.1, 0.2, 0.15]] {
            out.extend(head.map(|x: f64| x + 1e-4 * noise.next()));
        }
    }
    out
}

fn hash(numbers: &[f64]) -> u64 {
    numbers.iter().fold(0xcbf2_9ce4_8422_2325, |h, x| {
        let bits = if x.is_nan() { 0x7ff8 << 48 } else { x.to_bits() };
        (h ^ bits).wrapping_mul(0x100_0000_01b3).rotate_left(23)
    })
}

#[test]
fn every_method_gives_the_same_bits_everywhere() {
    let plain = operators(12, &OperatorOptions::default());
    let positions = take(&plain);
    let take = MarkerFrames { positions: &positions, columns: 19 };
    let columns = MarkerColumns { face: (0..15).collect(), head: Some((15..19).collect()) };
    let lowpass = Lowpass::new(10.0, 100.0).unwrap();
    let poses = FrontEnd::head_poses(take, &columns, Some(&lowpass)).unwrap();
    let avatar = &plain.parts().marker_positions;
    let front = FrontEnd::fit(take, &columns, &poses, 0..10, avatar).unwrap();
    let d = front.take_displacements(take, &poses).unwrap();
    let mut found = vec![format!("operators {:016x}", hash(&plain.parts().shell_gram))];
    // A mesh of several patches, whose parts of H are added in their order.
    let larger = operators(72, &OperatorOptions::default());
    found.push(format!("operators of 5184 vertices {:016x}", hash(&larger.parts().shell_gram)));
    found.push(format!("displacements {:016x}", hash(&d)));
    for method in Method::ALL {
        let spec = MethodSpec::new(method);
        let options = OperatorOptions::of(&spec);
        let ready = match method {
            Method::ThinShellSurface => surface(&spec),
            Method::Regression => learnt(&plain, &d),
            _ => operators(12, &options),
        };
        if let Ok(fit) = Fit::new(&ready, &spec) {
            let solved = fit.solve_take(&d).unwrap();
            // With few basis vectors some frames are far from what was learnt.
            let silent = solved.reports.iter().all(|r| r.warning.is_none());
            assert!(silent || method == Method::Regression, "{method}");
            found.push(format!("{method} {:016x}", hash(&solved.weights)));
        }
    }
    let soft = MethodSpec { stiffness: Some(0.2), ..MethodSpec::new(Method::ThinShellSurface) };
    let solved = Fit::new(&surface(&soft), &soft).unwrap().solve_take(&d).unwrap();
    found.push(format!("soft surface {:016x}", hash(&solved.weights)));
    assert_eq!(found.join("\n"), include_str!("../golden/bits.txt").trim());
}
