//! Head, neutral, alignment and adaptation, alone and up to the planted take.

use std::path::Path;

use mimique_geometry::{DQuat, Point, RigidError, RigidMotion, align_rigidly};
use mimique_solver::{
    Fit, FrontEnd, FrontEndError, Lowpass, MarkerColumns, MarkerFrames, Method, MethodSpec,
    OperatorOptions, Rbf, RbfError,
};
use mimique_test_support::real_data;

use crate::support;

type Points = Vec<Point>;

/// SciPy 1.17's cubic RBF with degree 1 on 40 points of a face, and the same in 40-digit arithmetic, as it
/// interpolates and with a smoothing of 0.1; millimetres.
struct Golden {
    actor: Points,
    avatar: Points,
    points: Points,
    scipy: Points,
    exact: Points,
    smooth_scipy: Points,
    smooth: Points,
}

fn golden() -> Golden {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/rbf_scipy.json");
    let json = support::json(&file);
    let points = |key: &str| -> Points {
        support::numbers(&json[key]).as_chunks::<3>().0.iter().map(|&p| p.into()).collect()
    };
    Golden {
        actor: points("actor"),
        avatar: points("avatar"),
        points: points("points"),
        scipy: points("scipy"),
        exact: points("exact"),
        smooth_scipy: points("smooth_scipy"),
        smooth: points("smooth"),
    }
}

/// A turn about a slanted axis, and a shift.
fn motion(angle: f64, shift: [f64; 3]) -> RigidMotion {
    let (s, c) = (angle / 2.0).sin_cos();
    let axis = [0.6 * s, -0.48 * s, 0.64 * s];
    RigidMotion::turn(DQuat::from_xyzw(axis[0], axis[1], axis[2], c)).then_by(shift.into())
}

fn worst_distance(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).fold(0.0, |s, (a, b)| (0..3).fold(s, |s: f64, k| s.max((a[k] - b[k]).abs())))
}

#[test]
fn rbf_interpolates_and_equals_scipy() {
    let g = golden();
    let rbf = Rbf::interpolate(&g.actor, &g.avatar).unwrap();
    let at_centres: Points = g.actor.iter().map(|&p| rbf.apply(p)).collect();
    let elsewhere: Points = g.points.iter().map(|&p| rbf.apply(p)).collect();
    let at_centres = worst_distance(&at_centres, &g.avatar);
    let ours = worst_distance(&elsewhere, &g.exact);
    let scipys = worst_distance(&g.scipy, &g.exact);
    eprintln!("at the centres {at_centres:.1e} mm; ours {ours:.1e} mm, SciPy {scipys:.1e} mm off");
    assert!(at_centres < 2e-12 && ours < 2e-12 && ours < scipys, "{at_centres:e} {ours:e}");
}

#[test]
fn a_smoothed_rbf_equals_scipy_in_every_unit_and_position() {
    let g = golden();
    let smoothed = |actor: &Points, avatar: &Points, points: &Points, smoothing: f64| -> Points {
        let rbf = Rbf::smooth(actor, avatar, smoothing).unwrap();
        points.iter().map(|&p| rbf.apply(p)).collect()
    };
    let found = smoothed(&g.actor, &g.avatar, &g.points, 0.1);
    let (ours, scipys) =
        (worst_distance(&found, &g.smooth), worst_distance(&g.smooth_scipy, &g.smooth));
    assert!(ours < 2e-12 && scipys < 2e-12, "{ours:e} {scipys:e}");
    assert!(worst_distance(&found, &g.exact) > 0.5, "smoothing changes the function");
    let scaled =
        |points: &Points| -> Points { points.iter().map(|p| p.map(|x| 1e-3 * x)).collect() };
    let metres = smoothed(&scaled(&g.actor), &scaled(&g.avatar), &scaled(&g.points), 0.1);
    assert!(worst_distance(&metres, &scaled(&g.smooth)) < 1e-14);
    let turn = motion(2.1, [300.0, -20.0, 7.0]);
    let turned = |points: &Points| -> Points { points.iter().map(|&p| turn.apply(p)).collect() };
    let moved = smoothed(&turned(&g.actor), &g.avatar, &turned(&g.points), 0.1);
    assert!(worst_distance(&moved, &g.smooth) < 1e-10);
    // Without smoothing it interpolates, bit for bit as ever; with a very large one it is affine.
    assert_eq!(Rbf::smooth(&g.actor, &g.avatar, 0.0), Rbf::interpolate(&g.actor, &g.avatar));
    let affine = Rbf::smooth(&g.actor, &g.avatar, 1e6).unwrap();
    let (a, b) = (g.points[0], g.points[9]);
    let middle = a + (b - a) * 0.5;
    let ends = (affine.apply(a).0 + affine.apply(b).0) * 0.5;
    assert!((affine.apply(middle).0 - ends).length() < 1e-4);
}

#[test]
fn rbf_reproduces_affine_maps() {
    let g = golden();
    let map = |p: Point| {
        Point::new(
            1.1 * p[0] - 0.2 * p[1] + 3.0,
            0.9 * p[1] + 0.1 * p[2] - 2.0,
            0.3 * p[0] + 1.2 * p[2] + 5.0,
        )
    };
    let values: Points = g.actor.iter().map(|&p| map(p)).collect();
    for smoothing in [0.0, 0.1, 3.0] {
        let rbf = Rbf::smooth(&g.actor, &values, smoothing).unwrap();
        for &p in &g.points {
            assert!(worst_distance(&[rbf.apply(p)], &[map(p)]) < 1e-11);
        }
    }
}

#[test]
fn rbf_without_a_solution_is_refused_in_words() {
    let g = golden();
    let mut twice = g.actor.clone();
    twice[7] = twice[3];
    assert_eq!(Rbf::interpolate(&twice, &g.avatar), Err(RbfError::Coincident(3, 7)));
    assert_eq!(Rbf::interpolate(&g.actor[..3], &g.avatar), Err(RbfError::TooFew(3)));
    let flat: Points = g.actor.iter().map(|p| Point::new(p.x, p.y, 2.0 * p.x - p.y)).collect();
    assert_eq!(Rbf::interpolate(&flat, &g.avatar), Err(RbfError::Planar));
}

#[test]
fn alignment_recovers_a_rigid_motion_and_never_reflects() {
    let g = golden();
    for angle in [0.0, 0.3, 1.5, 3.0, std::f64::consts::PI, -2.0] {
        let m = motion(angle, [10.0, -40.0, 500.0]);
        let moved: Points = g.actor.iter().map(|&p| m.apply(p)).collect();
        let found = align_rigidly(&g.actor, &moved).unwrap();
        let back: Points = g.actor.iter().map(|&p| found.apply(p)).collect();
        assert!(worst_distance(&back, &moved) < 1e-11, "angle {angle}");
    }
    let mirrored: Points = g.actor.iter().map(|p| Point::new(-p.x, p.y, p.z)).collect();
    let determinant = align_rigidly(&g.actor, &mirrored).unwrap().rotation.determinant();
    assert!((determinant - 1.0).abs() < 1e-12);
}

#[test]
fn alignment_refuses_lines_and_too_few() {
    let line: Points = (0..5).map(|i| Point::new(f64::from(i), 2.0 * f64::from(i), 1.0)).collect();
    assert_eq!(align_rigidly(&line, &line), Err(RigidError::Collinear));
    assert_eq!(align_rigidly(&line[..2], &line), Err(RigidError::TooFew(2)));
    let one = [Point::new(1.0, 1.0, 1.0); 4];
    assert_eq!(align_rigidly(&one, &one), Err(RigidError::Collinear));
}

/// A slow nod of 0.2 rad and a drift of the head, at 200 frames/s.
fn head_motion(frame: usize) -> RigidMotion {
    let t = frame as f64;
    motion(0.2 * (t / 60.0).sin(), [0.0004 * t, 0.3, -0.0002 * t])
}

/// A made-up take in metres: the golden actor smiles a little while the head moves; 5 head markers.
fn small_take(frames: usize, head_moves: bool) -> (Vec<f64>, MarkerColumns) {
    let g = golden();
    let mut out = Vec::new();
    for f in 0..frames {
        let t = f as f64;
        let m = if head_moves { head_motion(f) } else { RigidMotion::IDENTITY };
        for (k, p) in g.actor.iter().enumerate() {
            let moves = if f < 5 { 0.0 } else { 0.002 * (t / 4.0 + k as f64).sin() };
            let here = Point::new(p.x / 1e3 + moves, p.y / 1e3 - moves, p.z / 1e3);
            out.extend(m.apply(here).to_array());
        }
        for p in [[0.0, 0.2, 0.0], [0.09, 0.1, 0.0], [-0.09, 0.1, 0.01], [0.0, 0.1, 0.1]] {
            out.extend(m.apply(p.into()).to_array());
        }
    }
    (out, MarkerColumns { face: (0..40).collect(), head: Some(vec![40, 41, 42, 43]) })
}

fn displacements(positions: &[f64], columns: &MarkerColumns) -> Result<Vec<f64>, FrontEndError> {
    let avatar: Points = golden().avatar.iter().map(|p| p.map(|x| x / 1e3)).collect();
    let take = MarkerFrames { positions, columns: 44 };
    let poses = FrontEnd::head_poses(take, columns, None)?;
    FrontEnd::fit(take, columns, &poses, 0..5, &avatar)?.take_displacements(take, &poses)
}

#[test]
fn head_motion_leaves_displacements_unchanged() {
    let (still, columns) = small_take(40, false);
    let (moving, _) = small_take(40, true);
    let a = displacements(&still, &columns).unwrap();
    let b = displacements(&moving, &columns).unwrap();
    // 3e-12 mm in metres.
    let error = support::worst(&a, &b);
    eprintln!("head motion moves d by {error:.1e} m");
    assert!(error < 3e-15, "{error:e}");
    assert!(support::largest(&a) > 1e-3);
    // The neutral is met exactly.
    assert!(support::largest(&a[..120]) < 1e-15);
    // A capture that was stabilised before needs no head.
    let none = MarkerColumns { head: None, ..columns };
    let c = displacements(&still, &none).unwrap();
    assert!(support::worst(&a, &c) < 1e-15);
}

#[test]
fn lost_head_markers_are_refused_with_their_frame() {
    let (mut take, columns) = small_take(12, true);
    let cell = |frame: usize, column: usize| (frame * 44 + column) * 3;
    take[cell(4, 41)] = f64::NAN;
    let three = displacements(&take, &columns).unwrap();
    assert!(three.iter().all(|x| x.is_finite()), "three head markers are enough");
    take[cell(7, 41)] = f64::NAN;
    take[cell(7, 43)] = f64::NAN;
    assert_eq!(
        displacements(&take, &columns).unwrap_err().to_string(),
        "frame 7, head markers: 2 points in common, 3 are needed; name other head markers, or \
         fill the gap"
    );
    for frame in 0..12 {
        for (axis, x) in [0.01, 0.0, 0.05].into_iter().enumerate() {
            take[cell(frame, 40) + axis] = x;
            take[cell(frame, 41) + axis] = 2.0 * x;
            take[cell(frame, 42) + axis] = 3.0 * x;
            take[cell(frame, 43) + axis] = 4.0 * x;
        }
    }
    assert_eq!(
        displacements(&take, &columns).unwrap_err().to_string(),
        "frame 0, head markers: the points stand in one line; name other head markers, or fill \
         the gap"
    );
}

#[test]
fn lost_face_markers_stay_lost_and_others_do_not_move() {
    let (mut take, columns) = small_take(12, true);
    let whole = displacements(&take, &columns).unwrap();
    take[(8 * 44 + 13) * 3 + 1] = f64::NAN;
    let holed = displacements(&take, &columns).unwrap();
    for (i, (a, b)) in whole.iter().zip(&holed).enumerate() {
        let lost = i / 3 == 8 * 40 + 13;
        assert!(if lost { b.is_nan() } else { a.to_bits() == b.to_bits() }, "number {i}");
    }
    for frame in 0..5 {
        take[(frame * 44 + 2) * 3] = f64::NAN;
    }
    assert_eq!(
        displacements(&take, &columns).unwrap_err(),
        FrontEndError::NeutralUnseen { marker: 2 }
    );
}

#[test]
fn near_rigid_face_markers_can_be_the_head() {
    let (take, columns) = small_take(12, true);
    let shared = MarkerColumns { head: Some(vec![0, 7, 11, 19, 40, 41]), ..columns };
    let d = displacements(&take, &shared).unwrap();
    assert!(d.iter().all(|x| x.is_finite()) && support::largest(&d) < 0.02);
}

#[test]
fn segment_restored_from_its_parts_has_the_same_bits() {
    let (take, columns) = small_take(30, true);
    let avatar: Points = golden().avatar.iter().map(|p| p.map(|x| x / 1e3)).collect();
    let whole = MarkerFrames { positions: &take, columns: 44 };
    let poses = FrontEnd::head_poses(whole, &columns, None).unwrap();
    let front = FrontEnd::fit(whole, &columns, &poses, 0..5, &avatar).unwrap();
    let all = front.take_displacements(whole, &poses).unwrap();
    let (head, neutral) = (front.head_reference().to_vec(), front.neutral().to_vec());
    let restored = FrontEnd::from_neutral(columns, head, neutral, avatar).unwrap();
    let segment = MarkerFrames { positions: &take[10 * 132..20 * 132], columns: 44 };
    let poses = restored.segment_poses(segment, None).unwrap();
    assert_eq!(restored.take_displacements(segment, &poses).unwrap(), all[1200..2400]);
}

#[test]
fn lowpass_passes_lines_and_halves_the_power_at_its_cutoff_both_ways() {
    let lowpass = Lowpass::new(10.0, 200.0).unwrap();
    let mut line: Vec<f64> = (0..300).map(|i| 3.0 + 0.1 * f64::from(i)).collect();
    let before = line.clone();
    lowpass.filter(&mut line);
    assert!(support::worst(&line, &before) < 1e-6 * 30.0);
    for (hz, gain) in [(1.0, 1.0), (10.0, 0.5), (40.0, 0.0)] {
        let wave = |i: usize| (2.0 * std::f64::consts::PI * hz * i as f64 / 200.0).sin();
        let mut signal: Vec<f64> = (0..2000).map(wave).collect();
        lowpass.filter(&mut signal);
        // Zero phase: the filtered wave is the wave itself, scaled.
        let found = (500..1500).map(|i| signal[i] * wave(i)).sum::<f64>() / 500.0;
        assert!((found - gain).abs() < 0.01, "{hz} Hz: {found}");
    }
    assert_eq!(
        Lowpass::new(120.0, 200.0).unwrap_err().to_string(),
        "low-pass 120 Hz at 200 frames/s; give a cut-off above 0 and below 100 Hz"
    );
}

#[test]
fn head_lowpass_takes_noise_out_of_the_pose() {
    let (clean, columns) = small_take(400, true);
    let mut noisy = clean.clone();
    let mut seed = 1_u64;
    for frame in 0..400 {
        for x in &mut noisy[(frame * 44 + 40) * 3..(frame + 1) * 44 * 3] {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            *x += 3e-4 * ((seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5);
        }
    }
    let error = |lowpass: Option<&Lowpass>| {
        let take = |positions| MarkerFrames { positions, columns: 44 };
        let truth = FrontEnd::head_poses(take(&clean), &columns, None).unwrap();
        let found = FrontEnd::head_poses(take(&noisy), &columns, lowpass).unwrap();
        let at = Point::new(0.05, 0.0, 0.1);
        let squares: f64 = (truth.iter().zip(&found).enumerate())
            .map(|(f, (a, b))| {
                let m =
                    motion(0.2 * (f as f64 / 9.0).sin(), [0.01 * f as f64, 0.3, -0.004 * f as f64]);
                let p = m.apply(at);
                worst_distance(&[a.apply(p)], &[b.apply(p)]).powi(2)
            })
            .sum();
        (squares / 400.0).sqrt()
    };
    let lowpass = Lowpass::new(10.0, 200.0).unwrap();
    let (raw, filtered) = (error(None), error(Some(&lowpass)));
    assert!(filtered < 0.6 * raw, "{raw:e} {filtered:e}");
}

/// The planted take: millimetres in the CSV, metres here; 40 face and 6 head markers.
fn planted_displacements(data: &Path, avatar: &Points) -> (usize, Vec<f64>) {
    let (frames, cells) = support::table(&data.join("lsts/take_n01.csv"), 2);
    let metres: Vec<f64> = cells.iter().map(|x| x / 1000.0).collect();
    let take = MarkerFrames { positions: &metres, columns: 46 };
    let columns = MarkerColumns { face: (0..40).collect(), head: Some((40..46).collect()) };
    let poses = FrontEnd::head_poses(take, &columns, None).unwrap();
    let front = FrontEnd::fit(take, &columns, &poses, 0..60, avatar).unwrap();
    (frames, front.take_displacements(take, &poses).unwrap())
}

#[test]
fn every_frame_of_the_planted_take_meets_its_conditions() {
    let Some(data) = real_data("every_frame_of_the_planted_take_meets_its_conditions") else {
        return;
    };
    let operators = support::operators(&data, &OperatorOptions::default());
    let (frames, d) = planted_displacements(&data, &operators.parts().marker_positions);
    assert_eq!(frames, 5660);
    for (method, alpha) in
        [(Method::Lsts, Some(0.3)), (Method::Box, None), (Method::LstsNorm, Some(0.5))]
    {
        let mut spec = MethodSpec::new(method);
        spec.alpha = alpha;
        let take = Fit::new(&operators, &spec).unwrap().solve_take(&d).unwrap();
        let steps: u32 = take.reports.iter().map(|r| r.iterations).sum();
        eprintln!("{method}: {:.2} steps per frame", f64::from(steps) / 5660.0);
        let kkt = take.reports.iter().fold(0.0_f64, |s, r| s.max(r.kkt_error));
        assert!(kkt < 1e-9 && take.reports.iter().all(|r| r.warning.is_none()), "{kkt:e}");
    }
}
