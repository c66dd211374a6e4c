//! A study file's stimuli to packs: built-in ones and real ones, reuse, refusals.

use std::path::{Path, PathBuf};

use mimique_avatar::pack::decode_pack;
use mimique_clip::{sha256_hex, solve_packs};
use mimique_solver::Method;
use mimique_stimulus::{Places, Prepared, prepare};
use mimique_study::Study;
use mimique_test_support::real_data;
use serde_json::{Value, json};

use crate::support::study::study_of;

fn repository() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// A study of the given stimuli and nothing else.
fn study(stimuli: Value) -> Study {
    study_of(&stimuli)
}

fn builtin() -> Value {
    json!({
        "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
        "captures": {"actor": {"builtin": {"actor": 1}}},
        "segments": [
            {"id": "joy2", "capture": "actor",
             "performance": {"expression": "joy", "intensity": 2}},
            {"id": "fear3", "capture": "actor",
             "performance": {"expression": "fear", "intensity": 3}},
        ],
        "methods": {"lsts30": {"method": "lsts", "alpha": 0.3}, "box": {"method": "box"}},
    })
}

fn places(packs: &Path, data: Option<PathBuf>) -> Places {
    Places { study: repository().join("study-config"), data, packs: packs.to_owned() }
}

/// What a browser does with a clip: fetch, unpack, solve; returns how far the face moves, metres.
fn played(prepared: &Prepared, packs: &Path, clip: &str) -> f64 {
    let source = &prepared.clips[clip];
    let fetch = |hash: &str| {
        let bytes = std::fs::read(packs.join(hash)).unwrap();
        assert_eq!(sha256_hex(&bytes), hash);
        bytes
    };
    let avatar = decode_pack(&fetch(&source.avatar)).unwrap();
    let solved =
        solve_packs(&fetch(&source.operators), &fetch(&source.take), &source.method).unwrap();
    assert_eq!(solved.weights_hash, source.weights_hash);
    let shapes = if source.method.method == Method::Recorded {
        &avatar.shape_names[..]
    } else {
        avatar.face_shapes()
    };
    assert!(avatar.shape_names.starts_with(&solved.shape_names));
    assert!(solved.shape_names.starts_with(shapes));
    let duration = solved.frames() as f64 / solved.rate_hz * 1e3;
    assert!((duration - source.duration_ms).abs() < 1e-6);
    let n = solved.shape_names.len();
    let skin = avatar.skin().unwrap();
    solved
        .weights
        .chunks_exact(n)
        .step_by(20)
        .flat_map(|weights| skin.posed(weights).into_iter().zip(&skin.positions))
        .map(|(p, q)| (0..3).map(|a| f64::from(p[a] - q[a]).powi(2)).sum::<f64>().sqrt())
        .fold(0.0, f64::max)
}

#[test]
fn built_in_stimuli_are_prepared_once_and_play() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(builtin());
    let mut steps = Vec::new();
    let places = places(folder.path(), None);
    let prepared =
        prepare(&study, &places, &mut |p| steps.push((p.done, p.what.to_owned()))).unwrap();
    assert_eq!(steps.len(), 5);
    assert_eq!(steps[4], (4, "packs".to_owned()));
    assert_eq!(prepared.clips.len(), 4);
    for (id, source) in &prepared.clips {
        let moved = played(&prepared, folder.path(), id);
        eprintln!("{id}: {moved:.4} m, {} bytes", source.bytes);
        assert!((0.002..0.08).contains(&moved), "{id} moves by {moved} m");
        assert_eq!(source.duration_ms, 4000.0);
        assert_eq!(source.method.head_lowpass_hz, Some(10.0));
    }
    // One avatar, one set of operators (both methods ask for the same), one take a performance.
    let packs = |of: fn(&mimique_study::ClipSource) -> &String| {
        prepared.clips.values().map(of).collect::<std::collections::BTreeSet<_>>().len()
    };
    assert_eq!((packs(|c| &c.avatar), packs(|c| &c.operators), packs(|c| &c.take)), (1, 1, 2));
    assert_eq!(packs(|c| &c.provenance), 4);

    // Again: everything is there, nothing changes, not even a file.
    let files = |folder: &Path| {
        let mut files: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap())
            .map(|e| (e.file_name(), e.metadata().unwrap().modified().unwrap()))
            .collect();
        files.sort();
        files
    };
    let before = files(folder.path());
    assert_eq!(prepare(&study, &places, &mut |_| {}).unwrap(), prepared);
    assert_eq!(files(folder.path()), before);
}

#[test]
fn a_rate_without_room_for_the_low_pass_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut stimuli = builtin();
    stimuli["captures"]["actor"]["rateHz"] = json!(20.0);
    let prepared = prepare(&study(stimuli), &places(folder.path(), None), &mut |_| {}).unwrap();
    assert!(prepared.clips.values().all(|clip| clip.method.head_lowpass_hz == Some(0.0)));
    let said =
        "the head is not filtered: 20 frames per second leave no room for a low-pass of 10 Hz";
    let of_capture = prepared.warnings.iter().filter(|(at, _)| at == "/stimuli/captures/actor");
    assert_eq!(of_capture.filter(|(_, what)| what.starts_with(said)).count(), 1);
}

/// A capture of 200 Hz shown at 60 has the frames of 60 Hz, the same motion, and a third of the
/// weight; so has what the actor recorded.
#[test]
fn a_capture_is_shown_at_a_lower_rate() {
    let mut stimuli = builtin();
    stimuli["captures"] = json!({
        "whole": {"builtin": {"actor": 1, "noiseMm": 0.0}},
        "shown": {"builtin": {"actor": 1, "noiseMm": 0.0}, "rateHz": 60.0},
        "noisy": {"builtin": {"actor": 1}},
        "noisy_shown": {"builtin": {"actor": 1}, "rateHz": 60.0},
    });
    let segments = ["whole", "shown", "noisy", "noisy_shown"].map(|capture| {
        json!({"id": capture, "capture": capture,
            "performance": {"expression": "fear", "intensity": 3}})
    });
    stimuli["segments"] = json!(segments);
    stimuli["methods"] =
        json!({"norm": {"method": "lsts-norm", "alpha": 0.3}, "own": {"method": "recorded"}});
    let folder = tempfile::tempdir().unwrap();
    let prepared = prepare(&study(stimuli), &places(folder.path(), None), &mut |_| {}).unwrap();
    let read = |hash: &str| std::fs::read(folder.path().join(hash)).unwrap();
    let solved = |clip: &str| {
        let source = &prepared.clips[clip];
        solve_packs(&read(&source.operators), &read(&source.take), &source.method).unwrap()
    };
    for method in ["norm", "own"] {
        let whole = solved(&format!("whole.{method}"));
        let shown = solved(&format!("shown.{method}"));
        assert_eq!((whole.rate_hz, shown.rate_hz), (200.0, 60.0));
        assert_eq!((whole.frames(), shown.frames()), (800, 240));
        assert_eq!(prepared.clips[&format!("shown.{method}")].duration_ms, 4000.0);
        let n = whole.shape_names.len();
        let (mut worst, mut largest) = (0f64, 0f64);
        for frame in 0..shown.frames() {
            let at = frame as f64 * 200.0 / 60.0;
            let (low, part) = (at as usize, at.fract());
            for k in 0..n {
                let of = |f: usize| whole.weights[f.min(799) * n + k];
                let between = of(low) + part * (of(low + 1) - of(low));
                worst = worst.max((between - shown.weights[frame * n + k]).abs());
                largest = largest.max(between.abs());
            }
        }
        eprintln!("{method}: {worst:.4} off of {largest:.3}");
        assert!(largest > 0.5 && worst < 0.02, "{method}: {worst} off of {largest}");
    }
    let bytes = |clip: &str| read(&prepared.clips[&format!("{clip}.norm")].take).len();
    eprintln!("noisy: {} bytes, shown {}", bytes("noisy"), bytes("noisy_shown"));
    assert!(3 * bytes("noisy_shown") < bytes("noisy"));
}

#[test]
fn rates_and_frames_that_were_not_recorded_are_refused() {
    let refused = |captures: Value, segments: Value| {
        let mut stimuli = builtin();
        stimuli["captures"] = captures;
        stimuli["segments"] = segments;
        let folder = tempfile::tempdir().unwrap();
        prepare(&study(stimuli), &places(folder.path(), None), &mut |_| {}).unwrap_err().remove(0)
    };
    let fear = json!([{"id": "fear", "capture": "actor",
        "performance": {"expression": "fear", "intensity": 3}}]);
    let error = refused(json!({"actor": {"builtin": {"actor": 1}, "rateHz": 250.0}}), fear);
    assert_eq!(error.pointer, "/stimuli/captures/actor/rateHz");
    assert!(error.message.contains("250") && error.message.contains("200"), "{error}");

    // Frames are said as the file counts them, whatever is shown.
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..50).map(|f| format!("{f},{},0.5\n", f as f64 / 50.0)).collect();
    std::fs::write(folder.path().join("w.csv"), format!("frame,time,jawOpen\n{rows}")).unwrap();
    let places = Places { study: folder.path().into(), data: None, packs: folder.path().into() };
    let recorded = |rate: Value, end: usize| {
        let study = study(json!({
            "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
            "captures": {"phone": {"file": "w.csv", "rateHz": rate}},
            "segments": [{"id": "s", "capture": "phone", "first": 10, "end": end}],
            "methods": {"phone": {"method": "recorded"}},
        }));
        prepare(&study, &places, &mut |_| {}).map(|p| p.clips["s.phone"].duration_ms)
    };
    for rate in [Value::Null, json!(20.0)] {
        assert!((recorded(rate.clone(), 50).unwrap() - 800.0).abs() < 1e-6);
        let error = recorded(rate, 51).unwrap_err().remove(0);
        assert_eq!(error.pointer, "/stimuli/segments/0");
        assert!(error.message.contains("50"), "{error}");
    }
}

#[test]
fn recorded_weights_are_played_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let mut csv = "frame,time,jawOpen,mouthSmileLeft,noSuchShape\n".to_owned();
    for f in 0..30 {
        csv += &format!("{f},{},{},0.25,1\n", f as f64 / 30.0, f as f64 / 30.0);
    }
    std::fs::write(folder.path().join("weights.csv"), csv).unwrap();
    let study = study(json!({
        "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
        "captures": {"phone": {"file": "weights.csv"}},
        "segments": [{"id": "s", "capture": "phone", "first": 10, "end": 20}],
        "methods": {"phone": {"method": "recorded"}},
    }));
    let places = Places { study: folder.path().into(), data: None, packs: folder.path().into() };
    let prepared = prepare(&study, &places, &mut |_| {}).unwrap();
    assert_eq!(prepared.warnings.len(), 2);
    assert!(prepared.warnings[0].1.contains("noSuchShape"), "{:?}", prepared.warnings);
    assert!(prepared.warnings[1].1.contains("mouthSmileRight"), "{:?}", prepared.warnings);
    let clip = &prepared.clips["s.phone"];
    assert!(played(&prepared, folder.path(), "s.phone") > 0.005);
    let take = std::fs::read(folder.path().join(&clip.take)).unwrap();
    let solved = solve_packs(&take, &take, &clip.method).unwrap();
    let jaw = solved.shape_names.iter().position(|n| n == "jawOpen").unwrap();
    assert_eq!(solved.frames(), 10);
    assert!((solved.rate_hz - 30.0).abs() < 1e-9);
    assert!((solved.weights[jaw] - 10.0 / 30.0).abs() <= 0.5e-4);
}

/// The weights of a clip as a browser solves them, and its shapes.
fn weights(prepared: &Prepared, packs: &Path, clip: &str) -> (Vec<String>, Vec<f64>) {
    let source = &prepared.clips[clip];
    let read = |hash: &str| std::fs::read(packs.join(hash)).unwrap();
    let solved =
        solve_packs(&read(&source.operators), &read(&source.take), &source.method).unwrap();
    (solved.shape_names, solved.weights)
}

#[test]
fn locked_shapes_bounds_and_importance_of_the_study_file_are_obeyed() {
    let folder = tempfile::tempdir().unwrap();
    let mut stimuli = builtin();
    stimuli["segments"] = json!([{"id": "joy3", "capture": "actor",
        "performance": {"expression": "joy", "intensity": 3}}]);
    stimuli["methods"] = json!({
        "plain": {"method": "box"},
        "locked": {"method": "box", "locked": ["mouthSmileLeft"]},
        "bounded": {"method": "box", "bounds": {"mouthSmileLeft": [0.0, 0.2]}},
        "weighed": {"method": "box", "importance": {"MARKER": 0.0}},
    });
    let places = places(folder.path(), None);
    let wrong = prepare(&study(stimuli.clone()), &places, &mut |_| {}).unwrap_err().remove(0);
    assert_eq!(wrong.pointer, "/stimuli/methods/weighed/importance/MARKER");
    assert!(wrong.message.contains("no marker 'MARKER'"), "{wrong}");
    let label = wrong.message.split("use names of ").nth(1).unwrap().split(',').next().unwrap();
    stimuli["methods"]["weighed"]["importance"] = json!({ label: 0.0 });
    let prepared = prepare(&study(stimuli), &places, &mut |_| {}).unwrap();
    let smile = |method: &str| -> (f64, Vec<f64>) {
        let (names, weights) = weights(&prepared, folder.path(), &format!("joy3.{method}"));
        let at = names.iter().position(|n| n == "mouthSmileLeft").unwrap();
        let most = weights.chunks_exact(names.len()).map(|row| row[at]).fold(0.0, f64::max);
        (most, weights)
    };
    let plain = smile("plain");
    assert!(plain.0 > 0.4, "{}", plain.0);
    assert_eq!(smile("locked").0, 0.0);
    assert_eq!(smile("bounded").0, 0.2);
    assert_ne!(smile("weighed").1, plain.1);
}

#[test]
fn a_surface_and_a_regression_are_prepared_and_play() {
    let folder = tempfile::tempdir().unwrap();
    let mut stimuli = builtin();
    stimuli["captures"]["trainer"] = json!({"builtin": {"actor": 1}});
    stimuli["segments"] = json!([{"id": "joy3", "capture": "actor",
        "performance": {"expression": "joy", "intensity": 3}}]);
    stimuli["methods"] = json!({
        "lsts": {"method": "lsts"},
        "surface": {"method": "thin-shell-surface"},
        "soft": {"method": "thin-shell-surface", "stiffness": 0.05},
        "free": {"method": "thin-shell-surface", "hold": "nothing"},
        "learnt": {"method": "regression", "basisVectors": 60, "training": {"capture": "trainer"}},
    });
    let places = places(folder.path(), None);
    let study_of = |stimuli: &Value| study(stimuli.clone());
    let prepared = prepare(&study_of(&stimuli), &places, &mut |_| {}).unwrap();
    for (id, source) in &prepared.clips {
        let moved = played(&prepared, folder.path(), id);
        eprintln!("{id}: {moved:.4} m, {} bytes", source.bytes);
        assert!((0.002..0.08).contains(&moved), "{id} moves by {moved} m");
    }
    let pack = |clip: &str, of: fn(&mimique_study::ClipSource) -> &String| {
        of(&prepared.clips[&format!("joy3.{clip}")]).clone()
    };
    // A surface has an avatar of its own; how hard the markers pull changes none of the packs.
    assert_ne!(pack("surface", |c| &c.avatar), pack("lsts", |c| &c.avatar));
    assert_eq!(pack("surface", |c| &c.avatar), pack("soft", |c| &c.avatar));
    assert_eq!(pack("surface", |c| &c.operators), pack("soft", |c| &c.operators));
    assert_ne!(pack("surface", |c| &c.weights_hash), pack("soft", |c| &c.weights_hash));
    assert_ne!(pack("surface", |c| &c.avatar), pack("free", |c| &c.avatar));
    assert_eq!(pack("learnt", |c| &c.avatar), pack("lsts", |c| &c.avatar));
    assert_eq!(pack("learnt", |c| &c.take), pack("lsts", |c| &c.take));
    // What was learnt plays like what was fitted: the smile is there.
    let (names, fitted) = weights(&prepared, folder.path(), "joy3.lsts");
    let (_, learnt) = weights(&prepared, folder.path(), "joy3.learnt");
    let smile = names.iter().position(|n| n == "mouthSmileLeft").unwrap();
    let most = |w: &[f64]| w.chunks_exact(names.len()).map(|r| r[smile]).fold(0.0, f64::max);
    eprintln!("smile: fitted {:.2}, learnt {:.2}", most(&fitted), most(&learnt));
    assert!(most(&learnt) > 0.5 * most(&fitted));
    // Again: nothing is made anew, and nothing changes.
    assert_eq!(prepare(&study_of(&stimuli), &places, &mut |_| {}).unwrap(), prepared);

    // Bad training, at its place.
    stimuli["methods"]["learnt"]["training"] = Value::Null;
    stimuli["methods"]["learnt"].as_object_mut().unwrap().remove("training");
    let error = prepare(&study_of(&stimuli), &places, &mut |_| {}).unwrap_err().remove(0);
    assert_eq!(error.pointer, "/stimuli/methods/learnt/training");
    std::fs::write(folder.path().join("rom.csv"), "frame,time,jawOpen\n0,0,0\n1,0.01,1\n").unwrap();
    stimuli["methods"]["learnt"]["training"] =
        json!({"capture": "trainer", "weights": folder.path().join("rom.csv")});
    let error = prepare(&study_of(&stimuli), &places, &mut |_| {}).unwrap_err().remove(0);
    assert_eq!(error.pointer, "/stimuli/methods/learnt/training");
    assert!(error.message.contains("built-in actor"), "{error}");
}

#[test]
fn what_is_wrong_is_named_with_its_pointer() {
    type Change = fn(&mut Value);
    let cases: [(&str, &str, Change); 9] = [
        ("/stimuli/avatars/ada/file", "absent.glb", |s| {
            s["avatars"]["ada"] = json!({"file": "absent.glb"});
        }),
        ("/stimuli/avatars/ada/file", "demo.json: byte 0", |s| {
            s["avatars"]["ada"] = json!({"file": "demo.json"});
        }),
        ("/stimuli/avatars/ada/file", "MIMIQUE_DATA is not set", |s| {
            s["avatars"]["ada"] = json!({"file": "${MIMIQUE_DATA}/a.glb"});
        }),
        ("/stimuli/avatars/ada", "exactly one", |s| s["avatars"]["ada"] = json!({})),
        ("/stimuli/captures/actor/file", "absent.c3d", |s| {
            s["captures"]["actor"] = json!({"file": "absent.c3d"});
            s["segments"] = json!([{"id": "a", "capture": "actor", "first": 0, "end": 9}]);
        }),
        ("/stimuli/segments/0", "performance for a built-in", |s| {
            s["segments"] = json!([{"id": "a", "capture": "actor", "first": 0, "end": 9}]);
        }),
        ("/stimuli/captures/actor/head", "no_such_marker", |s| {
            s["captures"]["actor"]["head"] = json!(["no_such_marker"]);
        }),
        ("/stimuli/captures/actor/headLowpassHz", "500", |s| {
            s["captures"]["actor"]["headLowpassHz"] = json!(500);
        }),
        ("/stimuli/methods/box", "alpha", |s| {
            s["methods"] = json!({"box": {"method": "box", "alpha": 0.3}});
        }),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (pointer, says, change) in cases {
        let mut stimuli = builtin();
        change(&mut stimuli);
        let places = places(folder.path(), None);
        let error = prepare(&study(stimuli), &places, &mut |_| {}).unwrap_err().remove(0);
        assert_eq!(error.pointer, pointer, "{error}");
        assert!(error.message.contains(says), "{error}");
    }
}

#[test]
fn the_study_of_real_motion_capture_is_prepared() {
    let Some(data) = real_data("the_study_of_real_motion_capture_is_prepared") else { return };
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(repository().join("study-config/animface.json")).unwrap();
    let study = Study::from_text(&text).unwrap();
    let prepared = prepare(&study, &places(folder.path(), Some(data)), &mut |_| {}).unwrap();
    assert_eq!(prepared.clips.len(), 8);
    for (id, source) in &prepared.clips {
        let moved = played(&prepared, folder.path(), id);
        eprintln!("{id}: {moved:.4} m, {} bytes", source.bytes);
        assert!((0.004..0.08).contains(&moved), "{id} moves by {moved} m");
        assert!(source.bytes < 2_500_000);
    }
}

#[test]
fn the_actor_s_own_head_shows_the_performance_that_a_solve_recovers() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(json!({
        "avatars": {"self": {"builtin": {"actor": 1}, "look": "reference"}},
        "captures": {"actor": {"builtin": {"actor": 1, "noiseMm": 0.0}}},
        "segments": [{"id": "joy3", "capture": "actor",
                      "performance": {"expression": "joy", "intensity": 3}}],
        "methods": {"real": {"method": "recorded"}, "lsts": {"method": "lsts", "alpha": 0.02}},
    }));
    let prepared = prepare(&study, &places(folder.path(), None), &mut |_| {}).unwrap();
    let weights = |clip: &str| {
        let source = &prepared.clips[clip];
        assert_eq!((source.look.as_str(), source.duration_ms), ("reference", 4000.0));
        let pack = |hash: &str| std::fs::read(folder.path().join(hash)).unwrap();
        let solved =
            solve_packs(&pack(&source.operators), &pack(&source.take), &source.method).unwrap();
        (solved.shape_names, solved.weights)
    };
    let (names, planted) = weights("joy3.real");
    let (face, found) = weights("joy3.lsts");
    // What was performed has the shapes of the body behind those of the face.
    assert_eq!(names[..face.len()], face);
    assert_eq!(planted.len() / names.len(), found.len() / face.len());
    // The shapes of the smile itself, over the whole clip.
    for name in ["mouthSmileLeft", "mouthSmileRight", "mouthSmile_L", "mouthSmile_R"] {
        let Some(k) = names.iter().position(|each| each == name) else { continue };
        let column =
            |w: &[f64], n: usize| -> Vec<f64> { w.iter().skip(k).step_by(n).copied().collect() };
        let (planted, found) = (column(&planted, names.len()), column(&found, face.len()));
        let top = planted.iter().copied().fold(0.0, f64::max);
        assert!(top > 0.5, "{name} reaches {top}");
        let worst = planted.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        eprintln!("{name}: planted up to {top:.2}, found within {worst:.3}");
        assert!(worst < 0.1, "{name}: {worst}");
    }
    assert!(names.iter().any(|name| name.starts_with("mouthSmile")));
}

/// A capture file of somebody who acts, its labels `[a, b]` exchanged in some frames, and its map.
fn labelled_take(folder: &Path, swapped: std::ops::Range<usize>) -> [String; 2] {
    use mimique_actor::{
        Clip, Density, Emotion, HeadSpec, Identity, build_head, marker_sites, synthetic_take,
    };
    let head =
        |seed| HeadSpec { identity: Identity::from_seed(seed), density: Density::nearest(2000) };
    let (avatar, actor) = (head(3), head(77));
    let clip = |emotion| Clip { emotion, intensity: 3, seed: 5 };
    let clips = [clip(Emotion::Joy), clip(Emotion::Surprise)];
    let take = synthetic_take(&build_head(&actor), &marker_sites(&actor), &clips, 9, 0.1);
    let sites = marker_sites(&avatar);
    let mut map = "marker,role,vertex\n".to_owned();
    for (label, vertex) in sites.face_labels().iter().zip(&sites.vertices) {
        map += &format!("{label},face,{vertex}\n");
    }
    for label in take.head_labels.iter().filter(|l| !sites.face_labels().contains(l)) {
        map += &format!("{label},head,\n");
    }
    std::fs::write(folder.join("map.csv"), map).unwrap();
    let mut capture = mimique_mocap::Capture::new(
        take.labels,
        take.rate_hz,
        mimique_mocap::LengthUnit::Millimetre,
        take.positions,
    );
    // Two neighbours: the first face marker and the one nearest to it.
    let labels = capture.labels.clone();
    let place = |m: usize| capture.positions[m];
    let away =
        |a: usize, b: usize| -> f64 { (0..3).map(|k| (place(a)[k] - place(b)[k]).powi(2)).sum() };
    let face: Vec<usize> = (sites.face_labels().iter())
        .filter(|l| !take.head_labels.contains(l))
        .filter_map(|l| labels.iter().position(|m| m == l))
        .collect();
    let a = face[0];
    let b = face[1..].iter().copied().min_by(|&x, &y| away(a, x).total_cmp(&away(a, y))).unwrap();
    let p = labels.len();
    for frame in swapped {
        capture.positions.swap(frame * p + a, frame * p + b);
    }
    std::fs::write(folder.join("take.csv"), mimique_mocap::write_csv(&capture).unwrap()).unwrap();
    [labels[a].clone(), labels[b].clone()]
}

#[test]
fn swapped_labels_of_a_capture_are_said_once_at_their_capture() {
    let stimuli = json!({
        "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
        "captures": {"take": {"file": "take.csv", "markers": "map.csv", "neutral": [0, 60]}},
        "segments": [{"id": "a", "capture": "take", "first": 100, "end": 200},
                     {"id": "b", "capture": "take", "first": 500, "end": 600}],
        "methods": {"surface": {"method": "thin-shell-surface"}, "lsts": {"method": "lsts"},
                    "box": {"method": "box"}},
    });
    let said = |swapped: std::ops::Range<usize>| {
        let folder = tempfile::tempdir().unwrap();
        let labels = labelled_take(folder.path(), swapped);
        let here = Places {
            study: folder.path().to_owned(),
            data: None,
            packs: folder.path().join("packs"),
        };
        let prepared = prepare(&study(stimuli.clone()), &here, &mut |_| {}).unwrap();
        assert_eq!(prepared.clips.len(), 6);
        let mut swaps = prepared.warnings;
        swaps.retain(|(_, w)| w.contains("look swapped"));
        (labels, swaps)
    };
    assert_eq!(said(0..0).1, []);
    let (labels, swaps) = said(300..420);
    assert_eq!(swaps.len(), 1, "{swaps:?}");
    let (pointer, sentence) = &swaps[0];
    assert_eq!(pointer, "/stimuli/captures/take");
    assert!(labels.iter().all(|l| sentence.contains(l)), "{labels:?}: {sentence}");
    assert!(sentence.contains("300:420"), "{sentence}");
}

#[test]
fn another_face_is_advised_to_be_smoothed_with_the_gain_on_its_take() {
    let stimuli = |methods: Value| {
        json!({
            "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
            "captures": {"take": {"file": "take.csv", "markers": "map.csv", "neutral": [0, 60]}},
            "segments": [{"id": "a", "capture": "take", "first": 100, "end": 200},
                         {"id": "b", "capture": "take", "first": 500, "end": 600}],
            "methods": methods,
        })
    };
    let folder = tempfile::tempdir().unwrap();
    labelled_take(folder.path(), 0..0);
    let packs = folder.path().join("packs");
    let here = Places { study: folder.path().to_owned(), data: None, packs };
    let advised = |methods| mimique_stimulus::advised_methods(&study(stimuli(methods)), &here);
    let methods = json!({"lsts": {"method": "lsts"}, "said": {"method": "box", "rbfSmoothing": 0},
                         "surface": {"method": "thin-shell-surface"}});
    let found = advised(methods.clone());
    assert_eq!(found.len(), 1, "{found:?}");
    let (only, advice) = (&found[0], found[0].advice);
    assert_eq!((only.pointer.as_str(), only.capture.as_str()), ("/stimuli/methods/lsts", "take"));
    assert!(matches!(advice.reason, mimique_stimulus::SmoothingReason::OtherFace { distance_mm }
        if distance_mm > 1.0));
    assert!(advice.smoothed_mm < 0.98 * advice.residual_mm, "{advice:?}");
    // The preparation says the same, once, at the capture.
    let prepared = prepare(&study(stimuli(methods)), &here, &mut |_| {}).unwrap();
    let said: Vec<_> =
        prepared.warnings.iter().filter(|(_, w)| w.contains("rbfSmoothing 0.1 lowers")).collect();
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].1.starts_with(&advice.reason.to_string()), "{said:?}");
    // Whoever has chosen is not asked again; files that are not there say nothing here.
    assert_eq!(advised(json!({"lsts": {"method": "lsts", "rbfSmoothing": 0.1}})), []);
    let gone = Places { study: folder.path().join("nowhere"), ..here.clone() };
    let all = stimuli(json!({"lsts": {"method": "lsts"}}));
    assert_eq!(mimique_stimulus::advised_methods(&study(all), &gone), []);
}

#[test]
fn a_video_is_served_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let video = b"not looked into: browsers judge videos".to_vec();
    std::fs::write(folder.path().join("joy2.webm"), &video).unwrap();
    let mut stimuli = builtin();
    stimuli["avatars"]["person"] = json!({"videos": {"joy2": "joy2.webm"}});
    stimuli["methods"]["real"] = json!({"method": "recorded"});
    stimuli["clips"] = json!({"list": [
        {"avatar": "ada", "segment": "joy2", "method": "box"},
        {"avatar": "person", "segment": "joy2", "method": "real"},
    ]});
    let packs = folder.path().join("packs");
    let here = Places { study: folder.path().to_owned(), data: None, packs: packs.clone() };
    let prepared = prepare(&study(stimuli.clone()), &here, &mut |_| {}).unwrap();
    let source = &prepared.clips["joy2.real.person"];
    assert_eq!(source.video.as_deref(), Some("video/webm"));
    assert_eq!(std::fs::read(packs.join(&source.avatar)).unwrap(), video);
    assert_eq!(source.packs().collect::<Vec<_>>(), [source.avatar.as_str()]);
    assert_eq!(prepared.clips["joy2.box.ada"].packs().count(), 3);

    stimuli["avatars"]["person"] = json!({"videos": {"joy2": "gone.webm"}});
    let error = prepare(&study(stimuli), &here, &mut |_| {}).unwrap_err().remove(0);
    assert_eq!(error.pointer, "/stimuli/avatars/person/videos/joy2");
    assert!(error.message.contains("gone.webm"), "{error}");
}
