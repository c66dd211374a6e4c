//! A clip's weights at the playing rate: small, and no vertex further off than what is promised.

use std::path::PathBuf;

use mimique_avatar::pack::decode_pack;
use mimique_clip::{
    SolvedTake, TakeContent, TakePack, decode_take, encode_take_in_steps, solve_packs,
};
use mimique_stimulus::{Places, prepare, weight_steps};
use mimique_study::Study;
use serde_json::json;

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
            "captures": {"actor": {"builtin": {"actor": 1}}},
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
        let found = weight_steps(&avatar, &weights);
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
        let n = avatar.face_shapes().len();
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
