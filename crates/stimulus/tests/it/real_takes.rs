//! Real avatars and captures, end to end: `solve_take`, and the packs.

use std::path::Path;

use mimique_clip::{decode_operators, encode_operators, encode_take, solve_packs, solve_segment};
use mimique_mocap::Capture;
use mimique_solver::{Gaze, Method, MethodSpec, Untold};
use mimique_stimulus::{AvatarSkin, JoinedTake, MarkerMap, TakeOptions, solve_take, suggest_map};
use mimique_test_support::real_data;

fn skin(path: &Path) -> AvatarSkin {
    AvatarSkin::of(&mimique_avatar_files::read_avatar(path).unwrap().avatar).unwrap()
}

fn map(path: &Path) -> MarkerMap {
    MarkerMap::from_text(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// The first 60 frames, which are neutral, and then these.
fn cut(whole: &Capture, frames: &[usize]) -> Capture {
    let all = (0..60).chain(frames.iter().copied());
    let positions = all.flat_map(|frame| whole.frame(frame).to_vec());
    Capture::new(whole.labels.clone(), whole.rate_hz, whole.unit, positions)
}

fn lsts(alpha: f64) -> MethodSpec {
    MethodSpec { alpha: Some(alpha), kappa: Some(0.1), ..MethodSpec::new(Method::Lsts) }
}

/// A head that is not filtered, every shape solved: no frame depends on another.
fn unfiltered(spec: MethodSpec) -> MethodSpec {
    let (gaze, untold) = (Some(Gaze::Markers), Some(Untold::Solve));
    MethodSpec { head_lowpass_hz: Some(0.0), gaze, untold, ..spec }
}

/// `mimique verify` holds single frames against stored optima: the whole take has the same there.
#[test]
fn a_take_gives_the_weights_of_its_frames() {
    let Some(root) = real_data("a_take_gives_the_weights_of_its_frames") else { return };
    let skin = skin(&root.join("lsts/avatar_skin.glb"));
    let map = map(&root.join("lsts/mapping.csv"));
    let options = TakeOptions { neutral: Some(0..60), ..TakeOptions::default() };
    let frames: Vec<usize> = (195..5660).step_by(620).collect();
    for take in ["take_n01.csv", "take_n01.c3d"] {
        let capture = mimique_mocap::read(&root.join("lsts").join(take)).unwrap();
        let some = cut(&capture, &frames);
        for spec in [lsts(0.3), lsts(0.5), MethodSpec::new(Method::Box)] {
            let spec = unfiltered(spec);
            let solve =
                |capture| solve_take(&skin, capture, &map, &spec, &options, &mut || 0.0).unwrap();
            let (whole, alone) = (solve(&capture), solve(&some));
            assert_eq!(whole.table.frames.len(), 5660);
            assert!(whole.report.summary.held.is_none());
            let mut worst = 0.0_f64;
            for (at, &frame) in frames.iter().enumerate() {
                for (a, b) in whole.table.row(frame).iter().zip(alone.table.row(60 + at)) {
                    worst = worst.max((a - b).abs());
                }
            }
            eprintln!("{take} {}: {worst:.2e}", spec.method);
            assert!(worst <= 1e-8, "{take}, {}: {worst:e}", spec.method);
        }
    }
}

#[test]
fn a_c3d_gives_the_weights_of_its_rounded_numbers() {
    let Some(root) = real_data("a_c3d_gives_the_weights_of_its_rounded_numbers") else { return };
    let skin = skin(&root.join("lsts/avatar_skin.glb"));
    let map = map(&root.join("lsts/mapping.csv"));
    let mut rounded = mimique_mocap::read(&root.join("lsts/take_n01.csv")).unwrap();
    rounded.positions.iter_mut().for_each(|p| *p = p.map(|x| f64::from(x as f32)));
    let c3d = mimique_mocap::read(&root.join("lsts/take_n01.c3d")).unwrap();
    let options = TakeOptions { neutral: Some(0..60), ..TakeOptions::default() };
    let spec = MethodSpec::new(Method::Box);
    let hash = |capture| {
        solve_take(&skin, capture, &map, &spec, &options, &mut || 0.0).unwrap().report.weights_hash
    };
    assert_eq!(hash(&rounded), hash(&c3d));
}

#[test]
fn a_segment_s_packs_give_the_take_s_weights() {
    let Some(root) = real_data("a_segment_s_packs_give_the_take_s_weights") else { return };
    let capture = mimique_mocap::read(&root.join("lsts/take_n01.csv")).unwrap();
    let skin = skin(&root.join("lsts/avatar_skin.glb"));
    let map = map(&root.join("lsts/mapping.csv"));
    let options = TakeOptions { neutral: Some(0..60), ..TakeOptions::default() };
    let spec = MethodSpec { head_lowpass_hz: Some(10.0), ..lsts(0.3) };
    let whole = solve_take(&skin, &capture, &map, &spec, &options, &mut || 0.0).unwrap();

    let joined = JoinedTake::new(&skin, &capture, &map, &options).unwrap();
    let spec = joined.with_shapes_held(&spec);
    let operators = joined.operators(&spec).unwrap();
    let take = joined.segment(&operators, &spec, 80..310).unwrap();
    // Unrounded markers: only the settling of the low-pass at the margins differs.
    let exact = solve_segment(&operators, &take, &spec).unwrap();
    let (operators, take) = (encode_operators(&operators), encode_take(&take));
    eprintln!("operators {} bytes, take {} bytes", operators.len(), take.len());
    let packed = solve_packs(&operators, &take, &spec).unwrap();
    assert_eq!(packed.frames(), 230);
    assert_eq!(packed.rate_hz, 200.0);
    let differences = |weights: &[f64]| {
        let whole = &whole.table.weights[80 * 53..310 * 53];
        let d: Vec<f64> = whole.iter().zip(weights).map(|(a, b)| (a - b).abs()).collect();
        let rms = (d.iter().map(|x| x * x).sum::<f64>() / d.len() as f64).sqrt();
        (rms, d.into_iter().fold(0.0, f64::max))
    };
    let (rms, most) = differences(&exact.weights);
    eprintln!("margins: rms {rms:.1e}, most {most:.1e}");
    assert!(rms < 1e-4 && most < 2e-3, "{rms} {most}");
    let (rms, most) = differences(&packed.weights);
    eprintln!("rounding: rms {rms:.1e}, most {most:.1e}");
    assert!(rms < 2e-3 && most < 0.03, "{rms} {most}");
    // The same bytes, the same bits.
    assert_eq!(solve_packs(&operators, &take, &spec).unwrap().weights_hash, packed.weights_hash);
    assert_eq!(decode_operators(&operators).unwrap(), joined.operators(&spec).unwrap());
}

#[test]
fn real_motion_capture_moves_ict_facekit() {
    let Some(root) = real_data("real_motion_capture_moves_ict_facekit") else { return };
    let skin = skin(&root.join("ict-facekit/ict-facekit.glb"));
    let map = map(&root.join("animface/markers-ict-facekit.json"));
    for take in ["JawMoCap.c3d", "CheeksMoCap.c3d"] {
        let capture = mimique_mocap::read(&root.join("animface").join(take)).unwrap();
        for spec in [lsts(0.3), MethodSpec::new(Method::Box)] {
            let options = TakeOptions::default();
            let origin = std::time::Instant::now();
            let mut clock = || origin.elapsed().as_secs_f64();
            let solved = solve_take(&skin, &capture, &map, &spec, &options, &mut clock).unwrap();
            let summary = &solved.report.summary;
            let jaw = solved.table.shape_names.iter().position(|n| n == "jawOpen").unwrap();
            let most = (0..summary.frames).map(|f| solved.table.row(f)[jaw]).fold(0.0, f64::max);
            eprintln!(
                "{take} {}: {:.2} mm rms, jawOpen up to {most:.2}, {:?} {:?}",
                spec.method, summary.residual_rms_mm, solved.report.seconds, solved.report.warnings
            );
            // A face of another shape and size, 41 markers: one to three millimetres are left.
            assert!(summary.residual_rms_mm < 3.0);
            assert!((0.5..=1.0).contains(&most), "the jaw opens: {most}");
        }
    }
}

#[test]
fn real_motion_capture_moves_the_built_in_head_by_a_suggested_map() {
    let Some(root) = real_data("real_motion_capture_moves_the_built_in_head_by_a_suggested_map")
    else {
        return;
    };
    let head = mimique_actor::build_head(&mimique_actor::HeadSpec::default());
    let skin = AvatarSkin::of(&head).unwrap();
    for take in ["JawMoCap.c3d", "CheeksMoCap.c3d"] {
        let capture = mimique_mocap::read(&root.join("animface").join(take)).unwrap();
        // No label of this head is known to the capture: the places are found by their geometry.
        let map = suggest_map(&skin, &capture, None).unwrap().to_map(&skin);
        let options = TakeOptions::default();
        let solved = solve_take(&skin, &capture, &map, &lsts(0.3), &options, &mut || 0.0).unwrap();
        let summary = &solved.report.summary;
        let jaw = solved.table.shape_names.iter().position(|n| n == "jawOpen").unwrap();
        let most = (0..summary.frames).map(|f| solved.table.row(f)[jaw]).fold(0.0, f64::max);
        eprintln!(
            "{take}: {:.2} mm rms, jawOpen up to {most:.2}, {:?}",
            summary.residual_rms_mm, solved.report.warnings
        );
        assert!(summary.residual_rms_mm < 3.0, "{} mm", summary.residual_rms_mm);
        assert!(most > 0.3, "the jaw opens: {most}");
    }
}
