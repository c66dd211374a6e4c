//! The surface moved by its markers: the equation is met, planted answers come back, what is lost or
//! soft is what the whole surface would say.

use std::collections::BTreeMap;

use mimique_geometry::{Displacement, Point};
use mimique_solver::{
    Fit, FitError, FrameWarning, Hold, Laplacian, LaplacianKind, METRES_PER_WEIGHT, MarkerSite,
    Method, MethodSpec, OperatorOptions, Operators, SkinMesh, SparseDeltas, SurfaceError,
    SurfaceGreedy, SurfaceResponse,
};

use crate::support;

const WIDTH: usize = 13;
const KINDS: [LaplacianKind; 4] = [
    LaplacianKind::Uniform,
    LaplacianKind::Umbrella,
    LaplacianKind::CotanClamped,
    LaplacianKind::CotanLiteral,
];

/// A sheet of 13 x 13 vertices 1 cm apart, bent by `curvature`; one shape that lifts its middle.
fn sheet(curvature: f64) -> SkinMesh {
    let positions: Vec<Point> = (0..WIDTH * WIDTH)
        .map(|i| {
            let (x, y) = ((i % WIDTH) as f64 / 100.0 - 0.06, (i / WIDTH) as f64 / 100.0 - 0.06);
            Point::new(x, y, 0.1 - curvature * (x * x + 0.5 * y * y))
        })
        .collect();
    let at = |x: usize, y: usize| (y * WIDTH + x) as u32;
    let triangles = (0..(WIDTH - 1) * (WIDTH - 1))
        .flat_map(|i| {
            let (x, y) = (i % (WIDTH - 1), i / (WIDTH - 1));
            [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]
        })
        .collect();
    let middle =
        SparseDeltas { vertices: vec![84], deltas: vec![Displacement::new(0.0, 0.0, 0.01)] };
    SkinMesh { positions, triangles, shapes: vec![middle] }
}

const MARKERS: [usize; 8] = [16, 21, 50, 56, 84, 96, 120, 152];

fn labelled(markers: &[usize]) -> Vec<(String, usize)> {
    markers.iter().enumerate().map(|(m, &v)| (format!("M{m}"), v)).collect()
}

fn response(mesh: &SkinMesh, markers: &[usize], options: &OperatorOptions) -> SurfaceResponse {
    let held = vec![false; mesh.positions.len()];
    SurfaceResponse::build(mesh, markers, &held, options).unwrap()
}

fn options(laplacian: LaplacianKind) -> OperatorOptions {
    OperatorOptions { laplacian, k_s: 0.7, k_b: 1.6, association: None }
}

fn spec(options: &OperatorOptions, stiffness: f64) -> MethodSpec {
    MethodSpec {
        laplacian: Some(options.laplacian),
        k_s: Some(options.k_s),
        k_b: Some(options.k_b),
        stiffness: Some(stiffness),
        ..MethodSpec::new(Method::ThinShellSurface)
    }
}

fn operators(mesh: &SkinMesh, markers: &[usize], options: &OperatorOptions) -> Operators {
    let response = response(mesh, markers, options);
    let sites: Vec<MarkerSite> =
        labelled(markers).into_iter().map(|(label, v)| MarkerSite::at_vertex(label, v)).collect();
    response.operators(mesh, &sites, options).unwrap()
}

/// Marker displacements that have nothing to do with the sheet, metres.
fn displacements(markers: usize) -> Vec<f64> {
    (0..3 * markers).map(|i| 0.006 * (1.3 * i as f64 + 0.4).sin()).collect()
}

/// The energy by its definition: k_s sum of w (f_i - f_j)^2 over edges, k_b sum of M (M^-1 L* f)^2.
fn energy(mesh: &SkinMesh, options: &OperatorOptions, field: &[Displacement]) -> f64 {
    let (edges, masses) = Laplacian::symmetric(&mesh.positions, &mesh.triangles, options.laplacian);
    (0..3)
        .map(|a| {
            let f: Vec<f64> = field.iter().map(|d| d[a]).collect();
            let bend: f64 =
                edges.apply(&f).iter().zip(&masses).map(|(l, m)| l * l / m).sum::<f64>();
            let mut stretch = 0.0;
            for i in 0..f.len() {
                for (j, w) in edges.row(i).filter(|(j, _)| *j > i) {
                    stretch += w * (f[i] - f[j]).powi(2);
                }
            }
            options.k_s * stretch + options.k_b * bend
        })
        .sum()
}

#[test]
fn markers_are_met_and_everything_else_is_in_equilibrium() {
    let mesh = sheet(3.0);
    for kind in KINDS {
        let options = options(kind);
        let response = response(&mesh, &MARKERS, &options);
        assert!(response.residual < 1e-12, "{kind:?}: {:e}", response.residual);
        assert_eq!(response.without_marker, 0);
        let d = displacements(MARKERS.len());
        let fit = Fit::new(&operators(&mesh, &MARKERS, &options), &spec(&options, 0.0)).unwrap();
        let solved = fit.solve_frame(&d).unwrap();
        assert!(solved.report.residual < 1e-17);
        assert_eq!(solved.report.warning, None);
        assert!(solved.report.kkt_error < 1e-12);
        let field = response.displacements(&solved.weights);
        for (m, &v) in MARKERS.iter().enumerate() {
            for a in 0..3 {
                assert!((field[v][a] - d[3 * m + a]).abs() < 1e-17, "{kind:?}");
                assert!(
                    (solved.weights[3 * m + a] * METRES_PER_WEIGHT - d[3 * m + a]).abs() < 1e-17
                );
            }
        }
        // The report's energy is that of the whole surface, by its definition.
        let whole = energy(&mesh, &options, &field);
        let said = solved.report.energy.unwrap();
        assert!((said / whole - 1.0).abs() < 1e-10, "{kind:?}: {said:e} {whole:e}");
        // Its slope, by finite differences, vanishes at the free vertices and only there.
        let scale = whole / 0.006;
        let slope = |v: usize, a: usize| {
            let mut moved = field.clone();
            let h = 1e-5;
            moved[v][a] += h;
            let up = energy(&mesh, &options, &moved);
            moved[v][a] -= 2.0 * h;
            (up - energy(&mesh, &options, &moved)) / (2.0 * h) / scale
        };
        let mut pulled = 0;
        for v in 0..field.len() {
            for a in 0..3 {
                if MARKERS.contains(&v) {
                    pulled += usize::from(slope(v, a).abs() > 1e-4);
                } else {
                    assert!(slope(v, a).abs() < 1e-8, "{kind:?}, vertex {v}: {:e}", slope(v, a));
                }
            }
        }
        assert!(pulled > 20, "{kind:?}: {pulled}");
    }
}

#[test]
fn a_translation_of_all_markers_translates_the_surface() {
    let mesh = sheet(3.0);
    for kind in KINDS {
        let response = response(&mesh, &MARKERS, &options(kind));
        for (v, row) in response.fields.chunks_exact(MARKERS.len()).enumerate() {
            let sum: f64 = row.iter().sum();
            assert!((sum - 1.0).abs() < 1e-11, "{kind:?}, vertex {v}: {sum}");
        }
        let weights: Vec<f64> = MARKERS.iter().flat_map(|_| [0.3, -0.2, 0.5]).collect();
        assert!(energy(&mesh, &options(kind), &response.displacements(&weights)) < 1e-24);
    }
}

#[test]
fn turning_mesh_and_markers_together_turns_the_answer() {
    let mesh = sheet(3.0);
    let (sin, cos) = 1.1_f64.sin_cos();
    let turn = |p: [f64; 3]| [cos * p[0] - sin * p[2], p[1], sin * p[0] + cos * p[2]];
    let mut turned = mesh.clone();
    turned.positions.iter_mut().for_each(|p| *p = turn(p.to_array()).map(|x| x + 0.4).into());
    let d = displacements(MARKERS.len());
    let dt: Vec<f64> = d.chunks(3).flat_map(|x| turn([x[0], x[1], x[2]])).collect();
    for kind in KINDS {
        let (options, soft) = (options(kind), spec(&options(kind), 0.3));
        let field = |mesh: &SkinMesh, d: &[f64]| {
            let fit = Fit::new(&operators(mesh, &MARKERS, &options), &soft).unwrap();
            let weights = fit.solve_frame(d).unwrap().weights;
            response(mesh, &MARKERS, &options).displacements(&weights)
        };
        for (a, b) in field(&mesh, &d).into_iter().zip(field(&turned, &dt)) {
            assert!(support::worst(&turn(a.to_array()), &b.to_array()) < 1e-11, "{kind:?}");
        }
    }
}

#[test]
fn planted_fields_are_recovered_from_the_two_outer_rings() {
    let mesh = sheet(0.0);
    let inner =
        |i: usize| (2..WIDTH - 2).contains(&(i % WIDTH)) && (2..WIDTH - 2).contains(&(i / WIDTH));
    let markers: Vec<usize> = (0..WIDTH * WIDTH).filter(|&i| !inner(i)).collect();
    let options = OperatorOptions { k_s: 0.7, k_b: 1.6, ..OperatorOptions::default() };
    let response = response(&mesh, &markers, &options);
    // An affine field has no Laplacian. On this lattice e^(a x) has the Laplacian 4 (cosh a - 1)
    // e^(a x), and solves the equation where that factor is k_s / k_b.
    let a = (1.0 + options.k_s / (4.0 * options.k_b)).acosh();
    let planted = |i: usize| {
        let (x, y) = ((i % WIDTH) as f64, (i / WIDTH) as f64);
        [0.3 * x - 0.1 * y + 0.2, (a * x).exp() * 1e-2, (-a * y).exp() + (a * (x - y)).cosh() * 0.0]
    };
    let weights: Vec<f64> = markers.iter().flat_map(|&v| planted(v)).collect();
    let field = response.displacements(&weights);
    for (i, d) in field.iter().enumerate() {
        let expected = planted(i).map(|x| x * METRES_PER_WEIGHT);
        assert!(support::worst(&d.to_array(), &expected) < 1e-13, "vertex {i}: {d:?} {expected:?}");
    }
}

#[test]
fn a_lost_marker_is_a_marker_less() {
    let mesh = sheet(3.0);
    for (kind, stiffness) in KINDS.into_iter().flat_map(|k| [(k, 0.0), (k, 0.5)]) {
        let options = options(kind);
        // tau follows from all markers: the smaller problem is given what makes it the same.
        let trace = |o: &Operators| o.shell_scale();
        let all = operators(&mesh, &MARKERS, &options);
        let left: Vec<usize> = [0, 1, 3, 4, 5, 7].map(|m| MARKERS[m]).to_vec();
        let fewer = operators(&mesh, &left, &options);
        let mut d = displacements(MARKERS.len());
        let d_left: Vec<f64> =
            [0, 1, 3, 4, 5, 7].iter().flat_map(|m| d[3 * m..3 * m + 3].to_vec()).collect();
        d[3 * 2] = f64::NAN;
        d[3 * 6 + 1] = f64::NAN;
        let fit = Fit::new(&all, &spec(&options, stiffness)).unwrap();
        let found = fit.solve_frame(&d).unwrap();
        assert_eq!((found.report.missing_markers, found.report.warning), (2, None));
        assert!(found.report.kkt_error < 1e-11);
        let same = spec(&options, stiffness * trace(&fewer) / trace(&all));
        let expected = Fit::new(&fewer, &same).unwrap().solve_frame(&d_left).unwrap();
        let a = response(&mesh, &MARKERS, &options).displacements(&found.weights);
        let b = response(&mesh, &left, &options).displacements(&expected.weights);
        let worst = a
            .iter()
            .zip(&b)
            .fold(0.0_f64, |w, (a, b)| w.max(support::worst(&a.to_array(), &b.to_array())));
        assert!(worst < 1e-12, "{kind:?} {stiffness}: {worst:e}");
        // A marker without importance is one that is never seen.
        let mut unimportant = spec(&options, stiffness);
        unimportant.importance = BTreeMap::from_iter([("M2".into(), 0.0), ("M6".into(), 0.0)]);
        let fit = Fit::new(&all, &unimportant).unwrap();
        let ignored = fit.solve_frame(&displacements(MARKERS.len())).unwrap();
        assert!(support::worst(&ignored.weights, &found.weights) < 1e-12);
    }
    let options = options(LaplacianKind::Uniform);
    let fit = Fit::new(&operators(&mesh, &MARKERS, &options), &spec(&options, 0.0)).unwrap();
    let nothing = fit.solve_frame(&[f64::NAN; 24]).unwrap();
    assert_eq!(nothing.report.warning, Some(FrameWarning::NoMarkers));
    assert_eq!(nothing.weights, [0.0; 24]);
}

#[test]
fn soft_markers_balance_the_energy_and_harden_without_stiffness() {
    let mesh = sheet(3.0);
    let options = options(LaplacianKind::Uniform);
    let operators = operators(&mesh, &MARKERS, &options);
    let response = response(&mesh, &MARKERS, &options);
    let d = displacements(MARKERS.len());
    let importance: BTreeMap<String, f64> =
        (0..MARKERS.len()).map(|m| (format!("M{m}"), 0.5 + 0.4 * m as f64)).collect();
    let solve = |stiffness: f64, importance: &BTreeMap<String, f64>| {
        let spec = MethodSpec { importance: importance.clone(), ..spec(&options, stiffness) };
        Fit::new(&operators, &spec).unwrap().solve_frame(&d).unwrap()
    };
    // The objective as it is written, on the whole surface: no marker can be moved to lower it.
    let stiffness = 0.8;
    let found = solve(stiffness, &importance);
    let tau = operators.shell_scale() / (METRES_PER_WEIGHT * METRES_PER_WEIGHT);
    let objective = |weights: &[f64]| {
        let field = response.displacements(weights);
        let misfit: f64 = MARKERS
            .iter()
            .enumerate()
            .map(|(m, &v)| {
                let off: f64 = (0..3).map(|a| (field[v][a] - d[3 * m + a]).powi(2)).sum();
                importance[&format!("M{m}")] * off
            })
            .sum();
        misfit + stiffness * energy(&mesh, &options, &field) / tau
    };
    for k in 0..found.weights.len() {
        let mut moved = found.weights.clone();
        moved[k] += 1e-3;
        let up = objective(&moved);
        moved[k] -= 2e-3;
        let slope = (up - objective(&moved)) / 2e-3;
        assert!(slope.abs() < 1e-8 * objective(&[0.0; 24]), "{k}: {slope:e}");
    }
    assert!(found.report.residual > 1e-4);
    // Stiffness smooths: the energy falls, the distance grows; without it both are the hard ones.
    let none = BTreeMap::new();
    let mut last = solve(0.0, &none);
    for stiffness in [1e-9, 1e-3, 0.1, 1.0, 10.0] {
        let here = solve(stiffness, &none);
        assert!(here.report.energy < last.report.energy);
        assert!(here.report.residual > last.report.residual);
        if stiffness == 1e-9 {
            assert!(support::worst(&here.weights, &last.weights) < 1e-7);
        }
        last = here;
    }
}

#[test]
fn what_is_held_rests_and_pieces_without_marker_too() {
    let mut mesh = sheet(3.0);
    // A second sheet, apart.
    let other = sheet(3.0);
    let count = mesh.positions.len();
    mesh.positions.extend(other.positions.iter().map(|p| Point::new(p.x, p.y, p.z + 0.5)));
    mesh.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + count as u32)));
    let mut held = vec![false; 2 * count];
    held[..WIDTH].fill(true);
    held[16] = true; // A marker's own vertex follows the marker all the same.
    let options = options(LaplacianKind::Uniform);
    let response = SurfaceResponse::build(&mesh, &MARKERS, &held, &options).unwrap();
    assert_eq!(response.without_marker, count);
    let field = response.displacements(&[1.0; 24]);
    assert!(field[..WIDTH].iter().chain(&field[count..]).all(|d| *d == Displacement::ZERO));
    assert!(field[16].to_array().iter().all(|x| (x - METRES_PER_WEIGHT).abs() < 1e-17));
    assert!(field[WIDTH + 5].to_array().iter().all(|x| *x > 1e-4 && *x < METRES_PER_WEIGHT));
    // No shape of the bank moves anything but vertex 84.
    let unmoved = mesh.unmoved(1e-4);
    assert_eq!(unmoved.iter().filter(|still| !**still).count(), 1);
    assert!(!unmoved[84]);
}

#[test]
fn a_real_skin_follows_its_markers() {
    let Some(data) = mimique_test_support::real_data("a_real_skin_follows_its_markers") else {
        return;
    };
    let (skin, _) = support::skin(&data);
    let markers: Vec<usize> = support::markers(&data, "face").iter().map(|m| m.1).collect();
    let p = markers.len();
    // Nothing held: all markers moved by 1 carry the whole skin along.
    let free = response(&skin, &markers, &OperatorOptions::default());
    let worst = (free.fields.chunks_exact(p))
        .fold(0.0_f64, |w, row| w.max((row.iter().sum::<f64>() - 1.0).abs()));
    eprintln!("residual {:.1e}, partition of unity {worst:.1e}", free.residual);
    assert!(free.residual < 1e-9 && worst < 1e-8, "{:e} {worst:e}", free.residual);
    assert_eq!(free.without_marker, 0);
    // What no shape moves rests; the energy of holding it is that much larger.
    let held = skin.unmoved(1e-4);
    let resting =
        SurfaceResponse::build(&skin, &markers, &held, &OperatorOptions::default()).unwrap();
    assert!(resting.residual < 1e-9);
    for (v, row) in resting.fields.chunks_exact(p).enumerate() {
        assert!(!held[v] || markers.contains(&v) || row.iter().all(|x| *x == 0.0));
    }
    for m in 0..p {
        assert!(resting.stiffness[m * p + m] >= free.stiffness[m * p + m] * (1.0 - 1e-9));
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let mesh = sheet(0.0);
    let held = vec![false; mesh.positions.len()];
    let build = |markers: &[usize]| {
        SurfaceResponse::build(&mesh, markers, &held, &OperatorOptions::default())
    };
    assert_eq!(build(&[]), Err(SurfaceError::NoMarker));
    assert_eq!(build(&[3, 999]), Err(SurfaceError::MarkerVertex { vertex: 999, count: 169 }));
    let bank =
        Operators::build(&mesh, &["lift".into()], &labelled(&[84]), &OperatorOptions::default())
            .unwrap();
    let spec = MethodSpec::new(Method::ThinShellSurface);
    assert_eq!(Fit::new(&bank, &spec).err(), Some(FitError::NoSurface));
    let say = |spec: &MethodSpec| spec.validate().unwrap_err().to_string();
    let mut heavy = spec.clone();
    heavy.importance.insert("M3".into(), 2.0);
    assert!(say(&heavy).starts_with("importance.M3: is 2, but markers are met exactly"));
    assert!(
        say(&MethodSpec { stiffness: Some(-1.0), ..spec.clone() }).starts_with("stiffness: is -1")
    );
    assert!(say(&MethodSpec { alpha: Some(0.3), ..spec.clone() }).contains("does not use it"));
    assert_eq!(spec.resolved().hold, Some(Hold::Unmoved));
}

#[test]
fn markers_taken_one_by_one_leave_what_the_surface_of_all_of_them_leaves() {
    let mesh = sheet(3.0);
    let held: Vec<bool> = (0..WIDTH * WIDTH)
        .map(|i| [i % WIDTH, i / WIDTH].iter().any(|&c| c == 0 || c == WIDTH - 1))
        .collect();
    let options = options(LaplacianKind::Uniform);
    // Two smooth fields, at rest where the sheet is held.
    let field = |i: usize| {
        let (x, y) = ((i / 2 % WIDTH) as f64, (i / 2 / WIDTH) as f64);
        (0.3 * x + 0.5 * y).sin() + if i.is_multiple_of(2) { 0.5 } else { (0.6 * x).cos() }
    };
    let motion: Vec<f64> =
        (0..2 * WIDTH * WIDTH).map(|i| if held[i / 2] { 0.0 } else { field(i) }).collect();
    let mut greedy = SurfaceGreedy::new(&mesh, &held, &options, motion.clone(), 2).unwrap();
    let mut markers: Vec<usize> = Vec::new();
    let mut last = greedy.mean_square();
    for _ in 0..6 {
        let worst = (0..WIDTH * WIDTH)
            .max_by(|&a, &b| greedy.square_at(a).total_cmp(&greedy.square_at(b)))
            .unwrap();
        assert!(greedy.take(worst).unwrap());
        assert!(!greedy.take(worst).unwrap(), "a marker twice");
        markers.push(worst);
        let whole = SurfaceResponse::build(&mesh, &markers, &held, &options).unwrap();
        for v in 0..WIDTH * WIDTH {
            let left = (0..2).map(|k| {
                let of =
                    |m: usize| whole.fields[v * markers.len() + m] * motion[2 * markers[m] + k];
                motion[2 * v + k] - (0..markers.len()).map(of).sum::<f64>()
            });
            let square: f64 = left.map(|x| x * x).sum();
            assert!((greedy.square_at(v) - square).abs() < 1e-9 * (1.0 + square), "{v}");
        }
        assert!(greedy.square_at(worst) < 1e-20);
    }
    last -= greedy.mean_square();
    assert!(last > 0.0, "six markers tell something");
    assert!(!greedy.take(0).unwrap(), "what is held has no marker");
    let nothing_held = vec![false; WIDTH * WIDTH];
    let mut rests = SurfaceGreedy::new(&mesh, &nothing_held, &options, motion, 2).unwrap();
    assert!(!rests.take(84).unwrap(), "a piece without a vertex at rest rests");
}
