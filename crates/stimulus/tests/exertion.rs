//! Captures of a study that are exertions: computed, repeatable, refused at their place.

#[path = "support/study.rs"]
mod study_of_stimuli;

use std::collections::BTreeSet;
use std::path::Path;

use mimique_clip::solve_packs;
use mimique_stimulus::{Places, Prepared, built_in_bvh, exertion_drawing, prepare};
use mimique_study::Study;
use serde_json::{Value, json};
use study_of_stimuli::study_of;

/// A study of one exertion, cut at frames.
fn study(exertion: &Value, [first, end]: [usize; 2]) -> Study {
    study_of(&json!({
        "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
        "captures": {"body": {"exertion": exertion}},
        "segments": [{"id": "end", "capture": "body", "first": first, "end": end}],
        "methods": {"recorded": {"method": "recorded"}},
    }))
}

fn places(folder: &Path) -> Places {
    Places { study: folder.to_owned(), data: None, packs: folder.join("packs") }
}

/// What a page plays of the only clip: weights by shape.
fn weights(prepared: &Prepared, folder: &Path, shape: &str) -> Vec<f64> {
    let source = &prepared.clips["end.recorded"];
    let fetch = |hash: &str| std::fs::read(folder.join("packs").join(hash)).unwrap();
    let solved =
        solve_packs(&fetch(&source.operators), &fetch(&source.take), &source.method).unwrap();
    assert_eq!(solved.weights_hash, source.weights_hash);
    let column = solved.shape_names.iter().position(|name| name == shape).unwrap();
    let shapes = solved.shape_names.len();
    solved.weights.chunks_exact(shapes).map(|row| row[column]).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn exertions_are_computed_and_each_factor_shows() {
    let folder = tempfile::tempdir().unwrap();
    let prepared = |own: &Value| {
        prepare(&study(own, [6900, 7201]), &places(folder.path()), &mut |_| ()).unwrap()
    };
    let run = json!({"builtin": "run", "for": 120});
    let plain = prepared(&run);
    let source = &plain.clips["end.recorded"];
    assert!((source.duration_ms - 301.0 / 60.0 * 1e3).abs() < 1e-6, "{}", source.duration_ms);
    let jaw = weights(&plain, folder.path(), "jawOpen");
    assert_eq!(jaw.len(), 301);
    assert!(mean(&jaw) > 0.1, "{}", mean(&jaw));
    assert_eq!(prepared(&run).clips["end.recorded"].weights_hash, source.weights_hash);

    let mut seen = BTreeSet::from([source.weights_hash.clone()]);
    for (key, value) in [
        ("builtin", json!("sprint")),
        ("person", json!({"level": 9})),
        ("person", json!({"expressivity": {"mouthOpen": 0.5}})),
        ("person", json!({"loads": {"back": 20}})),
        ("heart", json!("steady")),
        ("model", json!("linear")),
        ("breath", json!(false)),
        ("seed", json!(4)),
    ] {
        let mut own = run.clone();
        own[key] = value;
        let hash = prepared(&own).clips["end.recorded"].weights_hash.clone();
        assert!(seen.insert(hash), "{key} makes no difference");
    }
    let mut fit = run;
    fit["person"] = json!({"level": 10});
    let of_fit = weights(&prepared(&fit), folder.path(), "jawOpen");
    assert!(mean(&of_fit) < 0.8 * mean(&jaw), "{} {}", mean(&of_fit), mean(&jaw));
}

#[test]
fn a_motion_of_a_file_is_the_built_in_one() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("run.bvh"), built_in_bvh(&mimique_actor::Gait::RUN)).unwrap();
    let hash = |own: Value| {
        let study = study(&own, [0, 61]);
        let prepared = prepare(&study, &places(folder.path()), &mut |_| ()).unwrap();
        prepared.clips["end.recorded"].weights_hash.clone()
    };
    assert_eq!(
        hash(json!({"motion": "run.bvh", "for": 20})),
        hash(json!({"builtin": "run", "for": 20}))
    );
}

#[test]
fn exertions_that_cannot_be_are_refused_at_their_place() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("model.json"), "{\"version\": 9}").unwrap();
    std::fs::write(folder.path().join("run.bvh"), "HIERARCHY\n").unwrap();
    let refused = |own: &Value, cut: [usize; 2]| {
        prepare(&study(own, cut), &places(folder.path()), &mut |_| ()).unwrap_err()
    };
    let person = |person: Value| json!({"builtin": "run", "for": 20, "person": person});
    for (own, pointer, said) in [
        (person(json!({"level": 11})), "/person/level", "11; give 0 to 10"),
        (person(json!({"loads": {"back": -1}})), "/person/loads/back", "below 0"),
        (json!({"builtin": "run", "for": -1}), "/for", "-1"),
        (json!({"motion": "run.bvh", "for": 20}), "/motion", "run.bvh: "),
        (json!({"motion": "gone.bvh", "for": 20}), "/motion", "gone.bvh: "),
        (json!({"builtin": "run", "for": 20, "model": "model.json"}), "/model", "version"),
        (json!({"builtin": "run", "for": 20, "model": "gone.json"}), "/model", "gone.json"),
        (json!({"for": 20}), "", "exactly one of builtin and motion"),
    ] {
        let error = refused(&own, [0, 60]);
        assert_eq!(error.pointer, format!("/stimuli/captures/body/exertion{pointer}"), "{error}");
        assert!(error.message.contains(said), "{own}: {error}");
    }
    // 20 s at 60 Hz have 1201 frames.
    let own = json!({"builtin": "run", "for": 20});
    assert!(prepare(&study(&own, [0, 1201]), &places(folder.path()), &mut |_| ()).is_ok());
    let error = refused(&own, [0, 1202]);
    assert_eq!(error.pointer, "/stimuli/segments/0");
    assert!(error.message.contains("1201 frames"), "{error}");
}

#[test]
fn what_previews_draw_is_what_the_clip_plays() {
    let folder = tempfile::tempdir().unwrap();
    let places = places(folder.path());
    let bvh = built_in_bvh(&mimique_actor::Gait::RUN);
    std::fs::write(folder.path().join("run.bvh"), bvh).unwrap();
    let own = study(&json!({"motion": "run.bvh", "for": 120}), [6900, 7201]);
    let clip = own.clips().remove(0);
    let drawing = exertion_drawing(&own, &clip, Some(&places)).unwrap().unwrap();
    assert_eq!((drawing.span_s, drawing.window_s), (120.0, [115.0, 120.0]));
    assert_eq!(drawing.courses[0].lines[0].values.len(), 121);
    assert!(drawing.figure.is_some() && drawing.breath.len() == 2);
    let drawn = drawing.weights.iter().find(|line| line.name == "jawOpen").unwrap();
    let prepared = prepare(&own, &places, &mut |_| ()).unwrap();
    let played = weights(&prepared, folder.path(), "jawOpen");
    assert_eq!(drawn.values.len(), played.len());
    // Packs keep weights to a step, drawings to four digits.
    let apart = drawn.values.iter().zip(&played).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-3, "{apart}");

    // Without its folder a motion of a file is not looked for; a built-in one needs none.
    let error = exertion_drawing(&own, &clip, None).unwrap_err();
    assert_eq!(error.pointer, "/stimuli/captures/body/exertion");
    let built_in = study(&json!({"builtin": "walk", "for": 120}), [6900, 7201]);
    assert!(exertion_drawing(&built_in, &built_in.clips()[0], None).unwrap().is_some());
    let beyond = study(&json!({"builtin": "walk", "for": 120}), [6900, 9000]);
    let error = exertion_drawing(&beyond, &beyond.clips()[0], None).unwrap_err();
    assert_eq!(error.pointer, "/stimuli/segments/0");
}
