//! What every method must obey: invariances, limits, lost markers, names, words.

use std::collections::BTreeMap;

use mimique_solver::{
    Fit, FitError, FrameWarning, Group, LaplacianKind, Method, MethodSpec, Needs, OperatorOptions,
    Operators, SkinMesh, SparseDeltas, Unit,
};
use proptest::prelude::*;

use crate::support;
use crate::support::sheet::{EXPRESSION, displacements, fit, noisy, operators, sheet};

/// Every method that finds weights from markers and shapes alone.
fn solved() -> Vec<Method> {
    Method::ALL.into_iter().filter(|method| method.needs() == Needs::Shapes).collect()
}

/// Those whose frames are solved each by itself.
fn solved_alone() -> Vec<Method> {
    solved().into_iter().filter(|method| !method.uses_other_frames()).collect()
}

/// Those whose energies are normalised, so that they have no unit.
fn normalised() -> Vec<Method> {
    let groups = [Group::Balance, Group::Sparsity, Group::Audio2Face];
    let has_none =
        |m: &Method| !m.uses(Group::LiteralUnit) && groups.iter().any(|&group| m.uses(group));
    solved().into_iter().filter(has_none).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn normalised_forms_are_free_of_units(
        c in prop::collection::vec(-0.2..1.2_f64, 9),
        method in prop::sample::select(normalised()),
        unit in prop::sample::select(vec![100.0, 1000.0]),
    ) {
        let spec = MethodSpec::new(method);
        let d = noisy(&c, 2e-4);
        let metres = fit(&spec).solve_frame(&d).unwrap().weights;
        let scaled: Vec<f64> = d.iter().map(|x| x * unit).collect();
        let other = operators(unit, &OperatorOptions::default());
        let units = Fit::new(&other, &spec).unwrap().solve_frame(&scaled).unwrap().weights;
        prop_assert!(support::worst(&metres, &units) < 1e-12);
    }

    #[test]
    fn order_of_the_shapes_does_not_matter(
        c in prop::collection::vec(-0.2..1.2_f64, 9),
        method in prop::sample::select(solved()),
        order in Just((0..9_usize).collect::<Vec<_>>()).prop_shuffle(),
    ) {
        let spec = MethodSpec::new(method);
        let options = OperatorOptions::of(&spec);
        let d = noisy(&c, 2e-4);
        let (mesh, names, markers) = sheet(1.0);
        let shuffled = SkinMesh {
            shapes: order.iter().map(|&k| mesh.shapes[k].clone()).collect(),
            ..mesh
        };
        let other_names: Vec<String> = order.iter().map(|&k| names[k].clone()).collect();
        let other = Operators::build(&shuffled, &other_names, &markers, &options).unwrap();
        let a = fit(&spec).solve_frame(&d).unwrap().weights;
        let b = Fit::new(&other, &spec).unwrap().solve_frame(&d).unwrap().weights;
        let back: Vec<f64> = order.iter().map(|&k| a[k]).collect();
        prop_assert!(support::worst(&back, &b) < 1e-10);
    }

    #[test]
    fn turning_avatar_and_markers_together_changes_nothing(
        c in prop::collection::vec(-0.2..1.2_f64, 9),
        method in prop::sample::select(solved()),
        angle in -3.0..3.0_f64,
    ) {
        let spec = MethodSpec::new(method);
        let (sin, cos) = angle.sin_cos();
        let turn = |p: [f64; 3]| [cos * p[0] - sin * p[2], p[1], sin * p[0] + cos * p[2]];
        let (mut mesh, names, markers) = sheet(1.0);
        for p in &mut mesh.positions {
            *p = turn(p.to_array()).map(|x| x + 0.3).into();
        }
        for x in mesh.shapes.iter_mut().flat_map(|s| &mut s.deltas) {
            *x = turn(x.to_array()).into();
        }
        let turned = Operators::build(&mesh, &names, &markers, &OperatorOptions::of(&spec)).unwrap();
        let d = noisy(&c, 2e-4);
        let dt: Vec<f64> = d.chunks(3).flat_map(|x| turn([x[0], x[1], x[2]])).collect();
        let a = fit(&spec).solve_frame(&d).unwrap().weights;
        let b = Fit::new(&turned, &spec).unwrap().solve_frame(&dt).unwrap().weights;
        prop_assert!(support::worst(&a, &b) < 1e-9);
    }

    #[test]
    fn two_starts_lead_to_one_minimiser(
        c in prop::collection::vec(-0.5..1.5_f64, 9),
        other in prop::collection::vec(-3.0..4.0_f64, 9),
        method in prop::sample::select(solved_alone()),
    ) {
        let fit = fit(&MethodSpec::new(method));
        let d = noisy(&c, 2e-4);
        let cold = fit.solve_frame(&d).unwrap();
        prop_assert!(cold.report.warning.is_none() && cold.report.kkt_error < 1e-9);
        let mut solver = fit.frames();
        let mut warm = vec![0.0; 9];
        solver.solve(&noisy(&other, 0.0), &mut warm).unwrap();
        solver.solve(&d, &mut warm).unwrap();
        prop_assert!(support::worst(&cold.weights, &warm) < 1e-10);
    }

    #[test]
    fn shell_energy_never_rises_with_its_weight(
        c in prop::collection::vec(-0.2..1.2_f64, 9),
        method in prop::sample::select(vec![Method::Lsts, Method::ThinShellOnly]),
    ) {
        // Both forms weigh the shell by kappa alpha and nothing else by either.
        let operators = operators(1.0, &OperatorOptions::default());
        let h = &operators.parts().shell_gram;
        let d = noisy(&c, 2e-4);
        let mut last = f64::INFINITY;
        for alpha in [0.05, 0.2, 0.4, 0.7, 1.0] {
            let mut spec = MethodSpec::new(method);
            spec.alpha = Some(alpha);
            let c = Fit::new(&operators, &spec).unwrap().solve_frame(&d).unwrap().weights;
            let energy: f64 = (0..81).map(|k| c[k / 9] * h[k] * c[k % 9]).sum();
            prop_assert!(energy <= last * (1.0 + 1e-12));
            last = energy;
        }
    }
}

#[test]
fn literal_form_depends_on_its_unit() {
    let d = noisy(&EXPRESSION, 2e-4);
    let solve = |unit| {
        let mut spec = MethodSpec::new(Method::ThesisLiteral);
        spec.unit = Some(unit);
        fit(&spec).solve_frame(&d).unwrap().weights
    };
    assert!(support::worst(&solve(Unit::Mm), &solve(Unit::M)) > 1e-6);
}

#[test]
fn without_noise_and_shell_the_weights_are_recovered_and_the_error_follows_alpha() {
    let d = noisy(&EXPRESSION, 0.0);
    for method in [Method::Box, Method::Nnls, Method::PseudoInverse] {
        let found = fit(&MethodSpec::new(method)).solve_frame(&d).unwrap();
        assert!(support::worst(&found.weights, &EXPRESSION) < 1e-11, "{method}");
        assert!(found.report.residual < 1e-14);
    }
    let error = |kappa: f64| {
        let mut spec = MethodSpec::new(Method::ThinShellOnly);
        spec.kappa = Some(kappa);
        support::worst(&fit(&spec).solve_frame(&d).unwrap().weights, &EXPRESSION)
    };
    let (large, small) = (error(1e-5), error(1e-6));
    assert!(small < 1e-4 && (large / small - 10.0).abs() < 0.1, "{large:e} {small:e}");
}

#[test]
fn neutral_face_stays_neutral() {
    for method in [Method::Lsts, Method::Box, Method::Nnls, Method::PseudoInverse] {
        let found = fit(&MethodSpec::new(method)).solve_frame(&[0.0; 36]).unwrap();
        assert_eq!(found.weights, [0.0; 9], "{method}");
    }
    // The residual of lsts-norm vanishes there: it says that it smoothed the norm.
    let report = fit(&MethodSpec::new(Method::LstsShort)).solve_frame(&[0.0; 36]).unwrap().report;
    assert!(report.warning.is_none() && report.kkt_error < 1e-9);
}

#[test]
fn exactly_met_markers_are_smoothed_and_said_so() {
    let mut spec = MethodSpec::new(Method::LstsNorm);
    spec.alpha = Some(1e-5);
    spec.soft_bounds = Some([-3.0, 4.0]);
    let found = fit(&spec).solve_frame(&noisy(&EXPRESSION, 0.0)).unwrap();
    assert_eq!(found.report.warning, Some(FrameWarning::Smoothed));
    assert!(support::worst(&found.weights, &EXPRESSION) < 1e-2, "{:?}", found.weights);
    assert!(found.report.kkt_error < 1e-9);
}

#[test]
fn frames_that_do_not_reach_their_tolerance_are_warned_of() {
    let good = noisy(&EXPRESSION, 2e-4);
    // Numbers whose squares, or sums, are none: no search can end there.
    let mut absurd = good.clone();
    absurd[7] = 1e300;
    absurd[20] = f64::MAX;
    absurd[21] = f64::MAX;
    let take = [good.clone(), absurd, good].concat();
    let mut failed = 0;
    for method in solved() {
        let solved = fit(&MethodSpec::new(method)).solve_take(&take).unwrap();
        assert!(solved.weights.iter().all(|c| c.is_finite()), "{method}: {:?}", solved.weights);
        let [before, during, after] = &solved.reports[..] else { panic!("three frames") };
        assert_eq!((before.warning, after.warning), (None, None), "{method}");
        assert!(before.kkt_error < 1e-9 && after.kkt_error < 1e-9, "{method}");
        let reached = during.kkt_error < 1e-6;
        assert_eq!(during.warning.is_none(), reached, "{method}: {during:?}");
        if !reached {
            assert_eq!(during.warning, Some(FrameWarning::NotConverged), "{method}");
            failed += 1;
        }
    }
    assert!(failed >= 8, "{failed} methods say so");

    // A norm that is not smoothed has a corner where the face is neutral.
    let mut spec = MethodSpec::new(Method::LstsShort);
    spec.eps = Some(0.0);
    let corner = fit(&spec).solve_frame(&[0.0; 36]).unwrap();
    assert!(corner.weights.iter().all(|c| c.is_finite()), "{corner:?}");
    assert!(corner.report.warning.is_some() || corner.report.kkt_error < 1e-6, "{corner:?}");
}

#[test]
fn lost_markers_drop_their_rows() {
    let d = noisy(&EXPRESSION, 2e-4);
    for method in solved() {
        let spec = MethodSpec::new(method);
        let mut holed = d.clone();
        // One coordinate is enough to lose a marker.
        holed[3 * 4 + 1] = f64::NAN;
        holed[3 * 9] = f64::NAN;
        let with_holes = fit(&spec).solve_frame(&holed).unwrap();
        assert_eq!(with_holes.report.missing_markers, 2);
        let full = fit(&spec).solve_frame(&d).unwrap();
        assert_eq!(full.report.missing_markers, 0);
        assert!(support::worst(&full.weights, &with_holes.weights) > 1e-9, "{method}");

        // The same as markers without importance (which also take their part of l^2 with them: the
        // methods without a prior do not see it).
        if matches!(method, Method::Box | Method::Nnls | Method::PseudoInverse | Method::Kouadio) {
            let mut unimportant = spec.clone();
            unimportant.importance =
                BTreeMap::from_iter([("M04".to_owned(), 0.0), ("M09".to_owned(), 0.0)]);
            let without = fit(&unimportant).solve_frame(&d).unwrap();
            assert!(support::worst(&without.weights, &with_holes.weights) < 1e-9, "{method}");
        }
        if method.uses_other_frames() {
            continue;
        }
        // The answer does not depend on what was lost before.
        let take = [d.clone(), holed.clone(), d.clone(), holed].concat();
        let solved = fit(&spec).solve_take(&take).unwrap();
        assert!(support::worst(&solved.weights[18..27], &full.weights) < 1e-10, "{method}");
        assert!(support::worst(&solved.weights[27..], &with_holes.weights) < 1e-10, "{method}");
    }
    let nothing = fit(&MethodSpec::new(Method::Lsts)).solve_frame(&[f64::NAN; 36]).unwrap();
    assert_eq!(nothing.weights, [0.0; 9]);
    assert_eq!(nothing.report.warning, Some(FrameWarning::NoMarkers));
}

#[test]
fn locked_shapes_stay_at_zero_and_bounds_hold() {
    let d = noisy(&EXPRESSION, 2e-4);
    for method in solved() {
        let mut spec = MethodSpec::new(method);
        spec.locked = vec!["bump3".to_owned(), "bump6".to_owned()];
        let found = fit(&spec).solve_frame(&d).unwrap();
        assert_eq!((found.weights[3], found.weights[6]), (0.0, 0.0), "{method}");
        assert!(found.report.kkt_error < 1e-9 && found.report.warning.is_none());
    }
    for method in [Method::Lsts, Method::Box, Method::Kouadio, Method::Sparse, Method::Greedy] {
        let mut spec = MethodSpec::new(method);
        spec.bounds = BTreeMap::from_iter([
            ("bump3".to_owned(), [0.1, 0.25]),
            ("bump5".to_owned(), [0.3, 0.3]),
            ("bump6".to_owned(), [-1.0, 1.5]),
        ]);
        let c = fit(&spec).solve_frame(&d).unwrap().weights;
        assert_eq!((c[3], c[5]), (0.25, 0.3), "{method}");
        assert!(c.iter().enumerate().all(|(k, x)| k == 6 || (0.0..=1.0).contains(x)));
    }
}

#[test]
fn importance_has_no_unit_and_pulls() {
    let d = noisy(&EXPRESSION, 5e-4);
    for method in solved() {
        if matches!(method, Method::ThesisLiteral | Method::ShortLiteral) {
            continue;
        }
        let spec = MethodSpec::new(method);
        let all = |w: f64| (0..12).map(|i| (format!("M{i:02}"), w)).collect();
        let even = MethodSpec { importance: all(4.0), ..spec.clone() };
        let a = fit(&spec).solve_frame(&d).unwrap();
        let b = fit(&even).solve_frame(&d).unwrap();
        assert!(support::worst(&a.weights, &b.weights) < 1e-10, "{method}");
        assert!((a.report.residual - b.report.residual).abs() < 1e-12);
    }
    // A marker that slipped by 4 mm does less harm the less it counts.
    let mut slipped = noisy(&EXPRESSION, 0.0);
    slipped[14] += 0.004;
    let harm = |importance: f64| {
        let mut spec = MethodSpec::new(Method::Box);
        spec.importance.insert("M04".to_owned(), importance);
        support::worst(&fit(&spec).solve_frame(&slipped).unwrap().weights, &EXPRESSION)
    };
    let (none, little, full) = (harm(0.0), harm(0.1), harm(1.0));
    assert!(none < 1e-11 && 0.0 < little && little < 0.7 * full, "{none:e} {little} {full}");
}

#[test]
fn unseen_shapes_stay_at_zero() {
    // A shape that moves no marker, and a copy of another: least squares has no one answer.
    let (mut mesh, mut names, markers) = sheet(1.0);
    mesh.shapes.push(SparseDeltas { vertices: vec![0], deltas: vec![[0.01; 3].into()] });
    mesh.shapes.push(mesh.shapes[2].clone());
    names.extend(["corner".to_owned(), "twin".to_owned()]);
    let d = noisy(&EXPRESSION, 2e-4);
    for method in [Method::Box, Method::Nnls, Method::PseudoInverse, Method::Lsts] {
        let spec = MethodSpec::new(method);
        let operators =
            Operators::build(&mesh, &names, &markers, &OperatorOptions::of(&spec)).unwrap();
        assert_eq!(operators.marker_reach()[9], 0.0);
        let found = Fit::new(&operators, &spec).unwrap().solve_frame(&d).unwrap();
        assert_eq!(found.weights[9], 0.0, "{method}");
        assert!(found.report.warning.is_none(), "{method}: {:?}", found.report);
        assert!(found.report.kkt_error < 1e-9, "{method}");
    }
}

#[test]
fn take_does_not_depend_on_how_it_is_cut() {
    let frames: Vec<f64> = (0..300)
        .flat_map(|f| {
            let c: Vec<f64> =
                (0..9).map(|k| 0.5 + 0.7 * (f as f64 / 20.0 + k as f64).sin()).collect();
            noisy(&c, 2e-4)
        })
        .collect();
    for method in solved() {
        let fit = fit(&MethodSpec::new(method));
        let take = fit.solve_take(&frames).unwrap();
        assert_eq!(take.reports.len(), 300);
        assert!(take.reports.iter().all(|r| r.warning.is_none() && r.kkt_error < 1e-9));
        if method.uses_other_frames() {
            continue;
        }
        // By hand: chunks of CHUNK_FRAMES, one solver each.
        for (chunk, expected) in frames
            .chunks(36 * mimique_solver::CHUNK_FRAMES)
            .zip(take.weights.chunks(9 * mimique_solver::CHUNK_FRAMES))
        {
            let mut solver = fit.frames();
            let mut weights = vec![0.0; 9];
            for (d, expected) in chunk.chunks(36).zip(expected.chunks(9)) {
                solver.solve(d, &mut weights).unwrap();
                assert_eq!(weights, expected, "{method}");
            }
        }
    }
}

#[test]
fn refusals_name_field_value_and_remedy() {
    let say = |change: &dyn Fn(&mut MethodSpec), method| {
        let mut spec = MethodSpec::new(method);
        change(&mut spec);
        let options = OperatorOptions::of(&MethodSpec::new(method));
        Fit::new(&operators(1.0, &options), &spec).unwrap_err().to_string()
    };
    assert_eq!(
        say(&|s| s.sigma = Some(0.01), Method::Lsts),
        format!(
            "sigma: 'lsts' does not use it; remove it (it takes {})",
            Method::Lsts.parameters().join(", ")
        )
    );
    assert_eq!(
        say(&|s| s.alpha = Some(1.5), Method::Lsts),
        "alpha: is 1.5; give a number between 0 and 1"
    );
    assert_eq!(
        say(&|s| s.locked = vec!["jawOpen".into()], Method::Lsts),
        "locked.0: no shape 'jawOpen'; use names of bump0, bump1, bump2, bump3, bump4, bump5, \
         bump6, bump7, bump8"
    );
    assert!(
        say(&|s| s.importance = BTreeMap::from_iter([("X".into(), 1.0)]), Method::Box)
            .starts_with("importance.X: no marker 'X'; use names of M00, M01")
    );
    assert_eq!(
        say(&|s| s.laplacian = Some(LaplacianKind::Umbrella), Method::Lsts),
        "operators built with laplacian uniform, kS 1, kB 1, association none, the method asks \
         for laplacian umbrella, kS 1, kB 1, association none; build them with \
         OperatorOptions::of"
    );
    assert_eq!(
        say(&|_| (), Method::Recorded),
        "method: 'recorded' reads weights from a file, there is nothing to solve; give the \
         weights file, or another method"
    );
    assert_eq!(
        say(&|_| (), Method::Regression),
        "method: 'regression' has learnt nothing; give a training take and its weights"
    );
    assert_eq!(
        say(&|s| s.locked = (0..9).map(|k| format!("bump{k}")).collect(), Method::Box),
        "locked: all 9 shapes; leave some of them free"
    );
    let lsts = fit(&MethodSpec::new(Method::Lsts));
    assert_eq!(
        lsts.solve_take(&[0.0; 37]),
        Err(FitError::Displacements { found: 37, markers: 12 })
    );
}

#[test]
fn specs_are_written_and_read_as_the_study_file_has_them() {
    let text = r#"{"method":"lsts-soft","alpha":0.7,"kS":2.0,"laplacian":"cotan-clamped",
        "softBounds":[-0.2,1.2],"s":0.05,"locked":["bump1"],"importance":{"M01":0.5},
        "headLowpassHz":10}"#;
    let spec: MethodSpec = serde_json::from_str(text).unwrap();
    assert_eq!(spec.problems(), []);
    assert_eq!(spec.k_s, Some(2.0));
    assert_eq!(spec.laplacian, Some(LaplacianKind::CotanClamped));
    let again: MethodSpec = serde_json::from_str(&serde_json::to_string(&spec).unwrap()).unwrap();
    assert_eq!(again, spec);
    let resolved = spec.resolved();
    assert_eq!((resolved.kappa, resolved.k_b, resolved.sigma), (Some(0.1), Some(1.0), None));
    assert_eq!(resolved.problems(), []);
    assert!(serde_json::from_str::<MethodSpec>(r#"{"method":"lsts","beta":1}"#).is_err());
    for method in Method::ALL {
        assert_eq!(method.name().parse::<Method>().unwrap(), method);
        assert_eq!(serde_json::to_value(method).unwrap(), method.name());
    }
    let many = MethodSpec { alpha: Some(f64::NAN), s: Some(0.0), ..spec };
    let fields: Vec<String> = many.problems().into_iter().map(|p| p.field).collect();
    assert_eq!(fields, ["alpha", "s"]);
}

#[test]
fn gain_multiplies_the_weights_within_their_bounds() {
    let d = noisy(&EXPRESSION, 2e-4);
    for method in solved() {
        let spec = MethodSpec::new(method);
        let plain = fit(&spec).solve_frame(&d).unwrap();
        let once = fit(&MethodSpec { gain: Some(1.0), ..spec.clone() }).solve_frame(&d).unwrap();
        assert_eq!(once, plain, "{method}");
        for gain in [0.5, 2.0] {
            let with = fit(&MethodSpec { gain: Some(gain), ..spec.clone() });
            let found = with.solve_frame(&d).unwrap();
            let [low, high] = match method {
                _ if method.uses(Group::SoftBounds) => spec.soft_bounds(),
                Method::Nnls => [0.0, f64::INFINITY],
                Method::PseudoInverse | Method::ThinShellOnly => [f64::NEG_INFINITY, f64::INFINITY],
                _ => [0.0, 1.0],
            };
            for (k, (w, c)) in found.weights.iter().zip(&plain.weights).enumerate() {
                let expected = (gain * c).max(low.min(*c)).min(high.max(*c));
                assert_eq!(*w, expected, "{method}, shape {k}");
            }
            // The residual is that of the weights that are shown; the solve is the same.
            let moved =
                displacements(operators(1.0, &OperatorOptions::of(&spec)).parts(), &found.weights);
            let squares: f64 = moved.iter().zip(&d).map(|(a, b)| (a - b).powi(2)).sum();
            let residual = (squares / 12.0).sqrt();
            assert!((found.report.residual - residual).abs() < 1e-12, "{method}");
            assert_eq!(found.report.kkt_error, plain.report.kkt_error, "{method}");
            // The next frame starts from the solved weights, not from the amplified ones.
            let take = [d.clone(), d.clone()].concat();
            let twice = with.solve_take(&take).unwrap();
            if method.uses_other_frames() {
                let once = fit(&spec).solve_take(&take).unwrap();
                let expected: Vec<f64> =
                    once.weights.iter().map(|c| (gain * c).clamp(0.0, 1.0)).collect();
                assert_eq!(twice.weights, expected, "{method}");
                continue;
            }
            assert!(support::worst(&twice.weights[9..], &found.weights) < 1e-9, "{method}");
        }
    }
    let wrong = MethodSpec { gain: Some(0.0), ..MethodSpec::new(Method::Box) };
    assert_eq!(
        wrong.validate().unwrap_err().to_string(),
        "gain: is 0; give a number above 0 and at most 3"
    );
}

#[test]
fn ridge_recovers_planted_weights_and_meets_its_conditions() {
    let operators = operators(1.0, &OperatorOptions::default());
    let (parts, n) = (operators.parts(), 9);
    let spec = |kappa| MethodSpec { kappa: Some(kappa), ..MethodSpec::new(Method::Ridge) };
    let exact = noisy(&EXPRESSION, 0.0);
    let error = |kappa| {
        support::worst(&fit(&spec(kappa)).solve_frame(&exact).unwrap().weights, &EXPRESSION)
    };
    // The prior draws the weights away from the planted ones as much as it weighs.
    let (large, small) = (error(1e-5), error(1e-6));
    assert!(small < 1e-4 && (large / small - 10.0).abs() < 0.1, "{large:e} {small:e}");

    // Karush-Kuhn-Tucker: no slope inside the bounds, none that leads back from a bound; the gradient
    // is computed here from the equation itself.
    let d = noisy(&EXPRESSION, 2e-3);
    let (kappa, alpha) = (0.1, 0.3);
    let found = fit(&spec(kappa)).solve_frame(&d).unwrap();
    let c = &found.weights;
    assert!(found.report.kkt_error < 1e-10, "{:e}", found.report.kkt_error);
    let residual: Vec<f64> = displacements(parts, c).iter().zip(&d).map(|(a, b)| a - b).collect();
    for (k, weight) in c.iter().enumerate() {
        let column = |row: usize| parts.marker_deltas[row * n + k];
        let data: f64 = (0..residual.len()).map(|row| column(row) * residual[row]).sum();
        let own: f64 = (0..residual.len()).map(|row| column(row).powi(2)).sum();
        let slope = data / operators.data_scale() + kappa * alpha * weight;
        let step = slope / (own / operators.data_scale() + kappa * alpha);
        let error = match *weight {
            0.0 => (-step).max(0.0),
            1.0 => step.max(0.0),
            _ => step.abs(),
        };
        assert!(error < 1e-10, "shape {k}: {error:e}");
    }
    assert!(c.contains(&0.0) || c.contains(&1.0), "no bound is met: {c:?}");

    // `lsts` with H in the place of the scaled identity is another answer.
    let shell = fit(&MethodSpec::new(Method::Lsts)).solve_frame(&d).unwrap();
    assert!(support::worst(&shell.weights, c) > 1e-3);
}
