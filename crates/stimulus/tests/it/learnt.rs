//! Surface and regression from captures to weights and packs: the built-in actor's range of motion
//! teaches emotions; packs, worker's function and the direct way agree; bad training is refused.

use mimique_actor::{
    Clip, Density, Emotion, HeadSpec, Identity, MarkerSites, SyntheticTake, build_head,
    marker_sites, range_of_motion_take, synthetic_take,
};
use mimique_avatar::Avatar;
use mimique_avatar::pack::{decode_pack, encode_pack};
use mimique_clip::{
    decode_operators, decode_take, encode_operators, encode_take, solve_packs, solve_segment,
};
use mimique_geometry::coordinates;
use mimique_mocap::{Capture, LengthUnit, WeightsTable};
use mimique_solver::{Fit, Inference, METRES_PER_WEIGHT, Method, MethodSpec, Operators};
use mimique_stimulus::{
    AvatarSkin, JoinedTake, MappedMarker, MarkerMap, MarkerPlace, SetUp, SolvedCapture,
    TakeOptions, Training, VertexFrames, solve_take, surface_avatar,
};

struct Scene {
    avatar: Avatar,
    skin: AvatarSkin,
    map: MarkerMap,
    take: SyntheticTake,
    training: Training,
}

fn head(seed: u64) -> (Avatar, MarkerSites) {
    let spec = HeadSpec { identity: Identity::from_seed(seed), density: Density::COARSE };
    (build_head(&spec), marker_sites(&spec))
}

fn capture(take: &SyntheticTake) -> Capture {
    Capture::new(take.labels.clone(), take.rate_hz, LengthUnit::Millimetre, take.positions.clone())
}

/// An actor's range of motion and two emotions, and an avatar (another person) for them.
fn scene() -> Scene {
    scene_with_noise(0.1)
}

/// The same with so much noise in the take of emotions, millimetres.
fn scene_with_noise(noise_mm: f64) -> Scene {
    let (actor, actor_sites) = head(41);
    let (avatar, sites) = head(3);
    let rom = range_of_motion_take(&actor, &actor_sites, 5, 0.1);
    let clips = [(Emotion::Joy, 2), (Emotion::Anger, 3)].map(|(emotion, intensity)| Clip {
        emotion,
        intensity,
        seed: 9,
    });
    let take = synthetic_take(&actor, &actor_sites, &clips, 6, noise_mm);
    let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
        MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
    });
    let map =
        MarkerMap { face: face.collect(), head: take.head_labels.clone(), ..MarkerMap::default() };
    let weights = WeightsTable::at_rate(rom.shape_names.clone(), rom.truth.clone(), 0, rom.rate_hz);
    let training = Training { capture: capture(&rom), weights, neutral: Some(0..100), head: None };
    let skin = AvatarSkin::of(&avatar).unwrap();
    Scene { avatar, skin, map, take, training }
}

fn solve(scene: &Scene, spec: &MethodSpec, training: Option<&Training>) -> SolvedCapture {
    let options = TakeOptions {
        neutral: Some(0..100),
        training: training.map(|t| Box::new(t.clone())),
        ..TakeOptions::default()
    };
    solve_take(&scene.skin, &capture(&scene.take), &scene.map, spec, &options, &mut || 0.0).unwrap()
}

fn rms(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn a_range_of_motion_teaches_the_emotions() {
    let scene = scene();
    let learnt = solve(&scene, &MethodSpec::new(Method::Regression), Some(&scene.training));
    let summary = learnt.report.regression.as_ref().unwrap();
    assert!(summary.basis_vectors <= 200 && summary.training_frames > 2000);
    assert!(learnt.report.frames.iter().all(|f| f.deviation.is_some()));
    // Gaze and blinks move no marker: no method can tell them.
    let seen: Vec<usize> = (0..scene.take.shape_names.len())
        .filter(|&k| !scene.take.shape_names[k].starts_with("eye"))
        .collect();
    let error = |weights: &[f64]| {
        let n = scene.take.shape_names.len();
        let of = |all: &[f64]| -> Vec<f64> {
            all.chunks_exact(n).flat_map(|row| seen.iter().map(|&k| row[k])).collect()
        };
        rms(&of(weights), &of(&scene.take.truth))
    };
    let regression = error(&learnt.table.weights);
    let lsts_norm = error(&solve(&scene, &MethodSpec::new(Method::LstsNorm), None).table.weights);
    let rest = error(&vec![0.0; scene.take.truth.len()]);
    eprintln!(
        "rms of weights: regression {regression:.4}, lsts-norm {lsts_norm:.4}, neutral face {rest:.4}; \
         {summary:?}; {:?}",
        learnt.report.warnings
    );
    // Another person's face, markers with noise: half the error of a fit that is not bounded.
    assert!(regression < 0.12, "{regression}");
    assert!(
        regression < 0.6 * rest && regression < 0.6 * lsts_norm,
        "{regression} {lsts_norm} {rest}"
    );
}

/// What the browser does, and the same without packs.
fn through_packs(
    scene: &Scene,
    spec: &MethodSpec,
    training: Option<&Training>,
) -> (SetUp, Vec<f64>) {
    let options = TakeOptions { neutral: Some(0..100), ..TakeOptions::default() };
    let recorded = capture(&scene.take);
    let joined = JoinedTake::new(&scene.skin, &recorded, &scene.map, &options).unwrap();
    let set_up = joined.set_up(spec, training).unwrap();
    let take = joined.segment(&set_up.operators, spec, 200..420).unwrap();
    let (operators, take) = (encode_operators(&set_up.operators), encode_take(&take));
    assert_eq!(decode_operators(&operators).unwrap(), set_up.operators);
    let solved = solve_packs(&operators, &take, spec).unwrap();
    let direct = solve_segment(&set_up.operators, &decode_take(&take).unwrap(), spec).unwrap();
    assert_eq!(solved.weights_hash, direct.weights_hash);
    assert_eq!(&solved.shape_names, &set_up.operators.parts().shape_names);
    assert_eq!(solved.frames(), 220);
    (set_up, solved.weights)
}

#[test]
fn what_was_learnt_travels_in_the_operators_pack() {
    let scene = scene_with_noise(0.0);
    let spec = MethodSpec { basis_vectors: Some(40), ..MethodSpec::new(Method::Regression) };
    let (set_up, weights) = through_packs(&scene, &spec, Some(&scene.training));
    let whole = solve(&scene, &spec, Some(&scene.training)).table;
    let n = whole.shape_names.len();
    // Without noise the pack's coordinates are rounded to a hundredth of a millimetre.
    assert!(rms(&weights, &whole.weights[200 * n..420 * n]) < 2e-3);
    // A pack that is cut short is refused, and a bank's pack has learnt nothing.
    let bytes = encode_operators(&set_up.operators);
    assert!(decode_operators(&bytes[..bytes.len() - 9]).is_err());
}

#[test]
fn what_a_pack_rounds_is_small_beside_the_sensors_noise() {
    let (clean, noisy) = (scene_with_noise(0.0), scene_with_noise(0.1));
    for method in [Method::LstsNorm, Method::Regression] {
        let learns = method == Method::Regression;
        let basis_vectors = learns.then_some(40);
        let spec = MethodSpec { basis_vectors, ..MethodSpec::new(method) };
        let training = Some(&noisy.training).filter(|_| learns);
        let (_, packed) = through_packs(&noisy, &spec, training);
        let weights = |scene: &Scene| {
            let table = solve(scene, &spec, training).table;
            let n = table.shape_names.len();
            table.weights[200 * n..420 * n].to_vec()
        };
        let exact = weights(&noisy);
        let (rounding, noise) = (rms(&packed, &exact), rms(&exact, &weights(&clean)));
        eprintln!("{method:?}: rounding moves weights by {rounding:.5}, noise by {noise:.5}");
        // Together they spread weights at most 3 % wider than noise alone.
        assert!(rounding < 0.25 * noise, "{method:?}: {rounding} of {noise}");
        assert!(rounding > 0.0);
    }
}

#[test]
fn a_surface_travels_as_an_avatar_of_markers() {
    let scene = scene();
    let spec = MethodSpec::new(Method::ThinShellSurface);
    let (set_up, weights) = through_packs(&scene, &spec, None);
    let surface = set_up.surface.unwrap();
    let bank: Operators = {
        let options = TakeOptions { neutral: Some(0..100), ..TakeOptions::default() };
        let recorded = capture(&scene.take);
        let joined = JoinedTake::new(&scene.skin, &recorded, &scene.map, &options).unwrap();
        joined.operators(&spec).unwrap()
    };
    let moved = surface_avatar(&scene.avatar, &scene.skin, &surface, &bank).unwrap();
    let pack = encode_pack(&moved);
    let shown = decode_pack(&pack.bytes).unwrap();
    eprintln!("surface avatar: {} bytes for {} shapes", pack.bytes.len(), shown.shape_names.len());
    assert_eq!(shown.face_shapes(), set_up.operators.parts().shape_names);
    // The head turns with the surface, too.
    assert!(shown.shape_names.ends_with(&mimique_avatar::HEAD_POSE_SHAPES.map(str::to_owned)));
    assert_eq!(shown.shape_names[1], format!("{}.y", bank.parts().marker_labels[0]));

    // What the stage draws is the surface: within the pack's rounding.
    let p = bank.marker_count();
    let frame = &weights[110 * 3 * p..111 * 3 * p];
    let skin = shown.skin().unwrap();
    let (drawn, exact) = (skin.posed(frame), surface.displacements(frame));
    let rest = &scene.avatar.skin().unwrap().positions;
    let mut worst = 0.0_f64;
    let mut most = 0.0_f64;
    for (v, (at, rest)) in drawn.iter().zip(rest).enumerate() {
        let d = exact[scene.skin.welded_from_file[v] as usize];
        for a in 0..3 {
            worst = worst.max((f64::from(at[a] - rest[a]) - d[a]).abs());
            most = most.max(d[a].abs());
        }
    }
    eprintln!("moves up to {most:.4} m, drawn within {worst:.2e} m");
    assert!(worst < 1e-4 && most > 2e-3, "{worst} {most}");
    // Markers are met: the weights are where they went, in centimetres.
    let fit = Fit::new(&set_up.operators, &spec).unwrap();
    let d: Vec<f64> = frame.iter().map(|w| w * METRES_PER_WEIGHT).collect();
    let again = fit.solve_frame(&d).unwrap();
    assert!(again.report.residual < 1e-12 && again.report.energy.unwrap() > 0.0);
    // Teeth follow the jaw, eyeballs rest, lashes stay on the lids.
    for mesh in &shown.meshes {
        let at = mesh.posed(frame);
        let way = at.iter().zip(&mesh.positions).fold(0.0_f32, |m, (p, q)| {
            m.max((0..3).map(|a| (p[a] - q[a]).powi(2)).sum::<f32>().sqrt())
        });
        eprintln!("{} ({:?}): moves by {:.2} mm", mesh.name, mesh.part, 1e3 * way);
        assert!(way < 0.03);
        if matches!(mesh.part, mimique_avatar::Part::EyeLeft | mimique_avatar::Part::EyeRight) {
            assert_eq!(way, 0.0);
        }
    }
    // The vertices of `--vertices` are those of the surface.
    let solved = solve(&scene, &spec, None);
    let frames = VertexFrames::new(&scene.skin, &solved);
    let (at, field) = (frames.positions(310), solved.surface.as_ref().unwrap());
    let d = field.displacements(solved.table.row(310));
    for (v, p) in at.iter().enumerate().step_by(97) {
        let welded = scene.skin.welded_from_file[v] as usize;
        for a in 0..3 {
            assert_eq!(p[a], scene.skin.mesh.positions[welded][a] + d[welded][a]);
        }
    }
    assert!(solved.report.frames.iter().all(|f| f.energy_mm2.is_some() && f.residual_mm < 1e-9));
}

#[test]
fn the_vertices_written_are_those_of_the_weights() {
    let scene = scene();
    let solved = solve(&scene, &MethodSpec::new(Method::Lsts), None);
    let mut frames = VertexFrames::new(&scene.skin, &solved);
    let mut npy = Vec::new();
    frames.write(&mut npy).unwrap();
    let (count, vertices) = (solved.table.frames.len(), scene.skin.welded_from_file.len());
    let data = npy.len() - 12 * count * vertices;
    assert!(npy.starts_with(b"\x93NUMPY\x01\x00") && data.is_multiple_of(64));
    let shape = format!("'shape': ({count}, {vertices}, 3)");
    assert!(String::from_utf8_lossy(&npy[..data]).contains(&shape));
    let mut most = 0.0_f64;
    for row in [0, 63, 64, 310, count - 1] {
        let bytes = &npy[data + 12 * row * vertices..][..12 * vertices];
        let written = bytes.as_chunks::<4>().0.iter().map(|b| f64::from(f32::from_le_bytes(*b)));
        for (x, y) in written.zip(coordinates(&frames.positions(row))) {
            // Positions of some 0.2 m in single precision, and sums of it.
            assert!((x - y).abs() < 2e-7, "row {row}: {x} {y}");
        }
        let moved = frames.positions(row).into_iter().zip(frames.positions(0));
        most = moved.fold(most, |m, (p, q)| m.max((p[1] - q[1]).abs()));
    }
    assert!(most > 1e-3, "the face moves by {most} m");
}

#[test]
fn bad_training_is_refused_with_what_to_do() {
    let scene = scene();
    let refuse = |spec: &MethodSpec, change: &dyn Fn(&mut Training)| {
        let mut training = scene.training.clone();
        change(&mut training);
        let options = TakeOptions {
            neutral: Some(0..100),
            training: Some(Box::new(training)),
            ..TakeOptions::default()
        };
        let recorded = capture(&scene.take);
        solve_take(&scene.skin, &recorded, &scene.map, spec, &options, &mut || 0.0)
            .unwrap_err()
            .to_string()
    };
    let spec = MethodSpec::new(Method::Regression);
    let says = |text: String, parts: &[&str]| {
        assert!(parts.iter().all(|part| text.contains(part)), "{text}");
    };
    let fewer_rows: &dyn Fn(&mut Training) = &|t| {
        let n = t.weights.shape_names.len();
        t.weights.weights.truncate(100 * n);
        t.weights.frames.truncate(100);
        t.weights.times.truncate(100);
    };
    says(refuse(&spec, fewer_rows), &["frames of markers, 100 of weights", "one row"]);
    let other_label: &dyn Fn(&mut Training) = &|t| t.capture.labels[3] = "elsewhere".into();
    let label = scene.map.face[3].label.clone();
    says(refuse(&spec, other_label), &[&label, "train with the same markers"]);
    let other_shapes: &dyn Fn(&mut Training) = &|t| {
        t.weights.shape_names.iter_mut().enumerate().for_each(|(i, n)| *n = format!("pose{i}"));
    };
    says(refuse(&spec, other_shapes), &["pose0", "ARKit"]);
    let short: &dyn Fn(&mut Training) = &|t| {
        let (n, p) = (t.weights.shape_names.len(), t.capture.labels.len());
        t.capture.positions.truncate(25 * p);
        t.weights.weights.truncate(25 * n);
        t.weights.frames.truncate(25);
        t.weights.times.truncate(25);
        t.neutral = Some(0..20);
    };
    says(refuse(&spec, short), &["25 frames", "30 or more"]);
    let exact = MethodSpec { inference: Some(Inference::Exact), ..spec.clone() };
    let long: &dyn Fn(&mut Training) = &|t| {
        let half = t.clone();
        t.capture.positions.extend(&half.capture.positions);
        t.weights.weights.extend(&half.weights.weights);
        t.weights.frames.extend(&half.weights.frames);
        t.weights.times.extend(&half.weights.times);
    };
    says(refuse(&exact, long), &["too many for the exact process", "sparse"]);
    let options = TakeOptions { neutral: Some(0..100), ..TakeOptions::default() };
    let recorded = capture(&scene.take);
    let none = solve_take(&scene.skin, &recorded, &scene.map, &spec, &options, &mut || 0.0);
    says(none.unwrap_err().to_string(), &["learnt nothing"]);
    // Shapes without weights are said.
    let mut partial = scene.training.clone();
    partial.weights.shape_names[0] = "unheardOf".into();
    let said = partial.warnings(&scene.skin.shape_names);
    let said = said.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
    says(said, &["no shape unheardOf", &format!("no weights of {}", scene.skin.shape_names[0])]);
}
