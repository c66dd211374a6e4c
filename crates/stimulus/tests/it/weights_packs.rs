//! A clip's weights at the playing rate: small, and no vertex further off than what is promised.

use std::path::PathBuf;

use mimique_actor::{Density, HeadSpec, build_head};
use mimique_avatar::pack::decode_pack;
use mimique_clip::{
    SolvedTake, TakeContent, TakePack, decode_take, encode_take_in_steps, solve_packs,
};
use mimique_mocap::npy_header;
use mimique_stimulus::{Places, prepare, weight_steps};
use mimique_study::Study;
use serde_json::{Value, json};

const RATE_HZ: f64 = 60.0;

/// Four seconds of strong anger by a noisy built-in actor, solved with two methods.
#[test]
fn four_seconds_of_solved_weights_fit_in_12_kb() {
    let folder = tempfile::tempdir().unwrap();
    let study = Study::from_value(&json!({
        "id": "weights", "studyMetadata": {"title": "Weights", "version": "1"},
        "languages": ["en"], "components": {}, "sequence": {"order": "fixed", "components": []},
        "stimuli": {
            "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
            // The promise is of the face: no shape of the head's pose moves a vertex of the pack.
            "captures": {"actor": {"builtin": {"actor": 1}, "headMotion": 0}},
            "segments": [{"id": "anger3", "capture": "actor",
                "performance": {"expression": "anger", "intensity": 3}}],
            "methods": {"norm": {"method": "lsts-norm", "alpha": 0.5}, "box": {"method": "box"}},
        },
    }))
    .unwrap();
    let packs = folder.path().to_owned();
    let places = Places { study: PathBuf::from("."), data: None, packs: packs.clone() };
    let prepared = prepare(&study, &places, &mut |_| {}).unwrap();
    let read = |hash: &str| std::fs::read(packs.join(hash)).unwrap();
    for (id, source) in &prepared.clips {
        let avatar = decode_pack(&read(&source.avatar)).unwrap();
        let solved =
            solve_packs(&read(&source.operators), &read(&source.take), &source.method).unwrap();
        let weights = at_playing_rate(&solved);
        let n = avatar.face_shapes().len();
        let found = weight_steps(&avatar, &weights, n);
        assert!(found.error_m > 1e-6 && found.error_m <= 1e-5, "{id}: {} m off", found.error_m);
        let take = TakePack {
            rate_hz: RATE_HZ,
            first_frame: 0,
            played: 0..240,
            content: TakeContent::Weights {
                shape_names: avatar.face_shapes().to_vec(),
                weights: weights.clone(),
            },
        };
        let bytes = encode_take_in_steps(&take, &found.steps);
        eprintln!("{id}: {} bytes, {:.2} um off", bytes.len(), 1e6 * found.error_m);
        assert!(bytes.len() <= 12_000, "{id}: {} bytes", bytes.len());

        // The promise, on the pack as it is read and the surface as it is drawn.
        let TakeContent::Weights { weights: back, .. } = decode_take(&bytes).unwrap().content
        else {
            panic!("{id}: markers");
        };
        let skin = avatar.skin().unwrap();
        let mut worst = 0f64;
        for (exact, rounded) in weights.chunks_exact(n).zip(back.chunks_exact(n)).step_by(6) {
            for (p, q) in skin.posed(exact).iter().zip(&skin.posed(rounded)) {
                let square: f64 = (0..3).map(|a| f64::from(p[a] - q[a]).powi(2)).sum();
                worst = worst.max(square.sqrt());
            }
        }
        // Poses are summed in single precision.
        assert!(worst <= found.error_m + 5e-8, "{id}: {worst} m, {} promised", found.error_m);
        assert!(worst > 0.3 * found.error_m, "{id}: {worst} m, {} promised", found.error_m);
    }
}

/// The weights at 240 frames, between the two nearest of the capture.
fn at_playing_rate(solved: &SolvedTake) -> Vec<f64> {
    let n = solved.shape_names.len();
    let last = solved.frames() - 1;
    let row = |f: usize| &solved.weights[f * n..(f + 1) * n];
    (0..240)
        .flat_map(|f| {
            let at = f64::from(f) / RATE_HZ * solved.rate_hz;
            let (low, part) = ((at as usize).min(last), at.fract());
            let between = move |(a, b): (&f64, &f64)| a + part * (b - a);
            row(low).iter().zip(row((low + 1).min(last))).map(between)
        })
        .collect()
}

#[test]
fn arrays_of_weights_are_read_at_the_rate_that_the_study_says_and_refused_without() {
    let folder = tempfile::tempdir().unwrap();
    let spec = HeadSpec { density: Density::nearest(2000), ..HeadSpec::person(3) };
    let n = build_head(&spec).face_shapes().len();
    let planted: Vec<f64> = (0..30 * n).map(|i| f64::from((i % 11) as u8) / 16.0).collect();
    let mut bytes = npy_header("<f8", &[30, n]);
    bytes.extend(planted.iter().flat_map(|weight| weight.to_le_bytes()));
    std::fs::write(folder.path().join("weights.npy"), bytes).unwrap();
    let study = |capture: Value| {
        Study::from_value(&json!({
            "id": "arrays", "studyMetadata": {"title": "Arrays", "version": "1"},
            "languages": ["en"], "components": {}, "sequence": {"order": "fixed", "components": []},
            "stimuli": {
                "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
                "captures": {"array": capture},
                "segments": [{"id": "part", "capture": "array", "first": 6, "end": 24}],
                "methods": {"recorded": {"method": "recorded"}},
            },
        }))
        .unwrap()
    };
    let packs = folder.path().join("packs");
    let places = Places { study: folder.path().into(), data: None, packs: packs.clone() };
    let known = study(json!({"file": "weights.npy", "fileRateHz": 30.0}));
    let prepared = prepare(&known, &places, &mut |_| {}).unwrap();
    let clip = prepared.clips.values().next().unwrap();
    assert_eq!(clip.duration_ms, 600.0);
    let take = decode_take(&std::fs::read(packs.join(&clip.take)).unwrap()).unwrap();
    let TakeContent::Weights { weights, shape_names } = take.content else { panic!("markers") };
    assert_eq!((take.rate_hz, weights.len()), (30.0, 18 * shape_names.len()));
    // The shapes of the body, behind those of the face, rest.
    for (row, planted) in
        weights.chunks_exact(shape_names.len()).zip(planted.chunks_exact(n).skip(6))
    {
        let apart = row.iter().zip(planted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Packs keep weights in steps.
        assert!(apart < 2e-4 && row[n..].iter().all(|weight| *weight == 0.0), "{apart}");
    }
    let unknown = study(json!({"file": "weights.npy"}));
    let error = prepare(&unknown, &places, &mut |_| {}).unwrap_err().remove(0).to_string();
    assert!(error.contains("/stimuli/captures/array/file") && error.contains("rate"), "{error}");
}
