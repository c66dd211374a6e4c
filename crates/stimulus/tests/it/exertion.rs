//! Captures of a study that are exertions: computed, repeatable, refused at their place.

use std::collections::BTreeSet;
use std::path::Path;

use mimique_clip::solve_packs;
use mimique_stimulus::{Places, Prepared, built_in_bvh, exertion_drawing, prepare};
use mimique_study::Study;
use serde_json::{Value, json};

use crate::support::study::study_of;

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

/// A ride of 150 W of so many seconds, the heart on request.
fn ride(seconds: usize, heart_rate: Option<f64>) -> String {
    let (name, value) = match heart_rate {
        Some(heart_rate) => (",heart_rate", format!(",{heart_rate}")),
        None => ("", String::new()),
    };
    let rows = (0..=seconds).map(|second| format!("{second},150{value}\n"));
    format!("time,power_w{name}\n{}", rows.collect::<String>())
}

#[test]
fn plans_and_recordings_are_exertions() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("ride.csv"), ride(60, Some(170.0))).unwrap();
    std::fs::write(folder.path().join("run.bvh"), built_in_bvh(&mimique_actor::Gait::RUN)).unwrap();
    let jaw = |own: Value, cut: [usize; 2]| {
        let prepared = prepare(&study(&own, cut), &places(folder.path()), &mut |_| ()).unwrap();
        mean(&weights(&prepared, folder.path(), "jawOpen"))
    };
    // A recorded heart of 170 opens the mouth at once, a law has to get there.
    let end = [3400, 3601];
    let recorded = jaw(json!({"activity": "ride.csv"}), end);
    let by_law = jaw(json!({"activity": "ride.csv", "heart": "thesis"}), end);
    assert!(recorded > 0.05 && recorded > 2.0 * by_law, "{recorded} {by_law}");
    // After the run's two minutes the rest closes it.
    let plan = json!({"plan": [{"for": 30}, {"motion": "run.bvh", "for": 120}, {"for": 120}, {"work": 5, "for": 10}]});
    let [rested, run, after] =
        [[0, 301], [8500, 8801], [15000, 15301]].map(|cut| jaw(plan.clone(), cut));
    assert!(run > 0.1 && rested < 0.02 && after < 0.6 * run, "{rested} {run} {after}");
    // The file says a quarter of its rate: the work is another.
    let slow = jaw(json!({"motion": "run.bvh", "for": 60, "motionRateHz": 15}), end);
    let right = jaw(json!({"motion": "run.bvh", "for": 60}), end);
    assert!(slow < 0.5 * right, "{slow} {right}");
}

#[test]
fn chest_and_skin_show_the_body() {
    let folder = tempfile::tempdir().unwrap();
    let body = |own: Value| {
        let study = study(&own, [10_500, 10_801]);
        let prepared = prepare(&study, &places(folder.path()), &mut |_| ()).unwrap();
        assert!(prepared.warnings.is_empty(), "{:?}", prepared.warnings);
        ["breath", "flush", "sweat"].map(|shape| weights(&prepared, folder.path(), shape))
    };
    let run = json!({"builtin": "run", "for": 180, "heart": "thesis"});
    let [breath, flush, sweat] = body(run.clone());
    let deepest = breath.iter().copied().fold(0.0, f64::max);
    assert!(deepest > 0.6 && deepest <= 1.0, "{deepest}");
    assert!(breath.iter().copied().fold(1.0, f64::min) < 0.05);
    assert!(flush.iter().chain(&sweat).all(|w| *w == 0.0), "off by default");
    let mut own = run;
    own["skin"] = json!(true);
    let [_, flush, sweat] = body(own.clone());
    assert!(mean(&flush) > 0.3 && mean(&flush) <= 1.0, "{}", mean(&flush));
    assert!(mean(&sweat) > 0.1 && mean(&sweat) < mean(&flush), "{}", mean(&sweat));
    own["breath"] = json!(false);
    assert!(body(own)[0].iter().all(|w| *w == 0.0));
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
        ("skin", json!(true)),
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
    std::fs::write(folder.path().join("own.bvh"), built_in_bvh(&mimique_actor::Gait::RUN)).unwrap();
    std::fs::write(folder.path().join("map.json"), "{\"leftEar\": \"Head\"}").unwrap();
    std::fs::write(folder.path().join("ride.csv"), ride(60, None)).unwrap();
    let refused = |own: &Value, cut: [usize; 2]| {
        prepare(&study(own, cut), &places(folder.path()), &mut |_| ()).unwrap_err().remove(0)
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
        (json!({"for": 20}), "", "exactly one source"),
        (json!({"plan": [{"builtin": "run"}, {}]}), "/plan/1/for", "need a length"),
        (
            json!({"plan": [{"activity": "ride.csv", "for": 99}]}),
            "/plan/0/activity",
            "is not repeated",
        ),
        (json!({"activity": "ride.csv", "heart": "recorded"}), "/heart", "heart"),
        (json!({"motion": "own.bvh", "joints": "map.json"}), "/joints", "map.json: "),
        (json!({"motion": "own.bvh", "motionUnit": "feet"}), "/motionUnit", "feet"),
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
