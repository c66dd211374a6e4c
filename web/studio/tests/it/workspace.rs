//! The studio's workspace as the page uses it.

use mimique_actor::{Density, HeadSpec, Identity, build_head, marker_sites, range_of_motion_take};
use mimique_mocap::{Capture, LengthUnit, WeightsTable};
use mimique_test_support::real_data;
use mimique_web_studio::Workspace;
use serde_json::Value;

fn built_in() -> Workspace {
    let mut workspace = Workspace::new();
    workspace.built_in_avatar(1, 2_000).unwrap();
    workspace.built_in_take(1);
    workspace
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn the_built_in_actor_is_solved_without_any_file() {
    let mut workspace = built_in();
    let state = workspace.map_state().unwrap();
    let placed = state["markers"].as_array().unwrap().iter().filter(|m| !m["vertex"].is_null());
    assert_eq!(placed.count(), 40);
    let facts = workspace.solve("a", r#"{"method": "lsts", "alpha": 0.3}"#).unwrap();
    let frames = facts["frames"].as_u64().unwrap() as usize;
    assert_eq!(workspace.weights("a").unwrap().len(), frames * 51);
    for series in ["residual", "kkt", "iterations"] {
        assert_eq!(workspace.series("a", series).unwrap().len(), frames);
    }
    assert!(number(&facts["summary"]["residual_rms_mm"]) < 3.0, "{facts}");
    assert_eq!(facts["head_lowpass_hz"], 10.0);
    // No gaze is given: the eyes rest unless one asks for them.
    assert_eq!(facts["gaze_at_rest"].as_array().unwrap().len(), 8, "{facts}");
    let told = facts["shapes_told"].as_array().unwrap();
    let state = |name: &str| &told.iter().find(|row| row["shape"] == name).unwrap()["state"];
    assert_eq!(
        (told.len(), state("eyeLookInLeft"), state("jawOpen")),
        (51, &"atRest".into(), &"solved".into())
    );
    assert_eq!(state("mouthLeft"), "shared", "mouthRight does the same the other way");
    // Another person acts than the avatar shows: smoothing is advised with what it gains, until it is chosen.
    let warnings = facts["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(
        warnings[0]["text"].as_str().unwrap().contains("rbfSmoothing 0.1 lowers"),
        "{warnings:?}"
    );
    for smoothing in ["0", "0.1"] {
        let chosen = format!(r#"{{"method": "lsts", "alpha": 0.3, "rbfSmoothing": {smoothing}}}"#);
        let chosen = workspace.solve("b", &chosen).unwrap();
        assert_eq!(chosen["warnings"], serde_json::json!([]), "{smoothing}");
        assert_eq!(chosen["weights_hash"] == facts["weights_hash"], smoothing == "0");
    }
    let resting = workspace.solve("b", r#"{"method": "lsts", "alpha": 0.3}"#).unwrap();
    assert_eq!(resting["weights_hash"], facts["weights_hash"]);
    let asked = r#"{"method": "lsts", "alpha": 0.3, "gaze": "markers"}"#;
    let free = workspace.solve("b", asked).unwrap();
    assert_eq!(free["gaze_at_rest"], serde_json::json!([]));
    let names = |warning: &Value| warning["text"].as_str().unwrap().contains("eyeLookInLeft");
    assert!(free["warnings"].as_array().unwrap().iter().any(names), "{free}");

    // Where the skin is and where it is asked to be agree with the residual.
    let frame = frames / 2;
    let points = workspace.marker_frame("a", frame).unwrap();
    assert_eq!(points.len(), 6 * 40);
    let square: f64 = points
        .chunks_exact(6)
        .map(|p| (0..3).map(|a| (1e3 * f64::from(p[a] - p[3 + a])).powi(2)).sum::<f64>())
        .sum();
    let residual = f64::from(workspace.series("a", "residual").unwrap()[frame]);
    let rms = (square / 40.0).sqrt();
    assert!((rms - residual).abs() < 0.01 * residual + 1e-3, "{rms} {residual}");
}

#[test]
fn two_methods_differ_where_the_heat_map_says_so() {
    let mut workspace = built_in();
    workspace.solve("a", r#"{"method": "lsts"}"#).unwrap();
    workspace.solve("b", r#"{"method": "box"}"#).unwrap();
    let frame = 500;
    let same = workspace.difference("a", "a", frame).unwrap();
    assert_eq!((same.rms_mm, same.worst_mm), (0.0, 0.0));
    let found = workspace.difference("a", "b", frame).unwrap();
    assert!(found.worst_mm > found.rms_mm && found.rms_mm > 0.0, "{found:?}");
    // Straight on, 0.36 m high: the head fills much of the picture.
    let s = 1.0 / 0.18;
    let camera = [s, 0., 0., 0., 0., s, 0., 0., 0., 0., -0.5, 0., 0., 0., 0.5, 1.0];
    let picture = workspace.heat_map(["b", "a"], frame, &camera, [64, 64], 3.0).unwrap();
    let drawn = picture.rgba.chunks_exact(4).filter(|p| p[3] == 255).count();
    assert!((400..3_500).contains(&drawn), "{drawn}");
    assert!(workspace.heat_map(["b", "a"], frame, &camera[..3], [64, 64], 3.0).is_err());
    let vertex = workspace.pick(&camera, [64, 64], [32.0, 32.0]).unwrap().unwrap();
    let state = workspace.place("chin", Some(vertex), false).unwrap();
    let chin = state["markers"].as_array().unwrap().iter().find(|m| m["label"] == "chin").unwrap();
    assert_eq!(chin["vertex"], vertex);
    assert!(number(&chin["position"][2]) > 0.0, "a click finds the front: {chin}");
}

#[test]
fn the_map_goes_out_and_comes_back() {
    let mut workspace = built_in();
    workspace.place("nose_tip", None, false).unwrap();
    workspace.set_neutral(5, 65).unwrap();
    let text = workspace.map_json();
    let state = workspace.map_file("markers.json", &text).unwrap();
    assert_eq!(state["neutral"], serde_json::json!([5, 65]));
    assert_eq!(workspace.map_json(), text);
    for (problem, part) in [
        (
            workspace.place("no such", None, false).unwrap_err(),
            "no such: the capture has no such marker",
        ),
        (workspace.place("chin", Some(9_999_999), false).unwrap_err(), "vertex 9999999 of"),
        (workspace.set_neutral(9, 9).unwrap_err(), "9:9 of"),
        (workspace.map_file("broken.json", "{").unwrap_err(), "broken.json: JSON"),
        (
            workspace.solve("a", r#"{"method": "regression"}"#).unwrap_err(),
            "training: open a range of motion and its weights",
        ),
        (workspace.solve("a", r#"{"method": "lasso"}"#).unwrap_err(), "method: "),
        (workspace.weights("c").unwrap_err(), "c: nothing is solved"),
    ] {
        assert!(problem.to_string().contains(part), "{problem}");
    }
    let mut empty = Workspace::new();
    assert!(
        empty
            .solve("a", r#"{"method": "lsts"}"#)
            .unwrap_err()
            .to_string()
            .contains("no avatar yet")
    );
    let problem = empty.avatar_file("head.glb", b"glTF".to_vec(), None).unwrap_err();
    assert!(problem.to_string().starts_with("head.glb: "), "{problem}");
    let problem = empty.take_file("take.c3d", b"", None, None).unwrap_err();
    assert!(problem.to_string().starts_with("take.c3d: "), "{problem}");
}

#[test]
fn the_capture_stands_beside_the_head_as_the_head_does() {
    let mut workspace = built_in();
    let points = workspace.capture_points().unwrap();
    let state = workspace.map_state().unwrap();
    let (points, markers) = (points.as_array().unwrap(), state["markers"].as_array().unwrap());
    assert_eq!(points.len(), markers.len());
    // The actor's own proportions are left: within two centimetres of where the markers sit on the avatar.
    for (point, marker) in points.iter().zip(markers).filter(|(_, m)| !m["vertex"].is_null()) {
        let apart = (0..3).map(|a| (number(&point[a]) - number(&marker["position"][a])).powi(2));
        assert!(apart.sum::<f64>().sqrt() < 0.02, "{marker} {point}");
    }
    // The mirror of a mirrored vertex is the vertex, on the built-in head, whose halves are alike.
    let left = markers.iter().find(|m| m["label"] == "brow_inner_left").unwrap();
    let right = markers.iter().find(|m| m["label"] == "brow_inner_right").unwrap();
    let vertex = |m: &Value| m["vertex"].as_u64().unwrap() as usize;
    let there = workspace.mirrored_vertex(vertex(left)).unwrap();
    assert_eq!(workspace.mirrored_vertex(there).unwrap(), vertex(left));
    let side = |marker: &Value| number(&marker["position"][0]);
    let found = workspace.place("brow_inner_right", Some(there), false).unwrap();
    let moved = found["markers"].as_array().unwrap();
    let moved = moved.iter().find(|m| m["label"] == "brow_inner_right").unwrap();
    assert!(side(moved) * side(left) < 0.0 && side(moved) * side(right) > 0.0, "{moved}");
    assert!(workspace.mirrored_vertex(usize::MAX).is_err());
}

#[test]
fn methods_are_held_against_each_other_part_by_part() {
    let mut workspace = built_in();
    workspace.solve("a", r#"{"method": "lsts"}"#).unwrap();
    workspace.solve("b", r#"{"method": "box"}"#).unwrap();
    let table = workspace.difference_over("b", "a").unwrap();
    let names: Vec<&str> = table.iter().map(|row| row.part.as_str()).collect();
    assert_eq!(names.last(), Some(&"Face"));
    assert!(names.contains(&"Mouth") && names.contains(&"Brow"), "{names:?}");
    let face = table.last().unwrap();
    let largest = table.iter().fold(0.0, |most: f64, row| most.max(row.largest_mm));
    assert_eq!(face.largest_mm, largest, "the face's largest is one of its parts'");
    assert!(face.rms_mm > 0.0 && face.rms_mm < face.largest_mm, "{face:?}");
    let there = workspace.difference("b", "a", face.largest_frame).unwrap();
    let near = there.vertices_mm.iter().any(|&mm| (f64::from(mm) - face.largest_mm).abs() < 1e-9);
    assert!(near, "a vertex of that frame is as far: {face:?}");
    assert!(workspace.difference_over("a", "a").unwrap().iter().all(|row| row.largest_mm == 0.0));
    assert!(workspace.difference_over("a", "c").is_err());
}

#[test]
fn expressions_are_suggested_mended_and_carried() {
    let mut workspace = built_in();
    workspace.solve("a", r#"{"method": "lsts"}"#).unwrap();
    let found = workspace.suggest_expressions("a", "one, two", 1.0).unwrap();
    let segments = found["segments"].as_array().unwrap();
    // Eighteen are played; what is suggested beyond them is a blink's length.
    let seconds = |s: &&Value| number(&s["expression_s"][1]) - number(&s["expression_s"][0]);
    assert_eq!(segments.iter().filter(|s| seconds(s) > 0.8).count(), 18, "{found}");
    assert!(segments.len() <= 20, "{found}");
    // Of a third of the sensitivity the strong ones are left.
    let fewer = workspace.suggest_expressions("a", "", 0.3).unwrap();
    let left = fewer["segments"].as_array().unwrap().len();
    assert!(left > 0 && left < segments.len(), "{fewer}");
    let found = workspace.suggest_expressions("a", "one, two", 1.0).unwrap();
    let segments = found["segments"].as_array().unwrap();
    assert_eq!((&segments[0]["label"], &segments[1]["label"]), (&"one".into(), &"two".into()));
    let edited = r#"[{"label": "joy", "expression": [100, 300]}, {"label": "fear", "expression": [600, 900]}]"#;
    workspace.set_expressions(edited).unwrap();
    let csv = workspace.expressions_csv().unwrap();
    let eaf = workspace.expressions_eaf(None, "2026-01-01T00:00:00+00:00").unwrap();
    for (file, text) in [("segments.csv", csv), ("segments.eaf", eaf)] {
        workspace.set_expressions("[]").unwrap();
        let back = workspace.expressions_file(file, &text).unwrap();
        assert_eq!(back["segments"][1]["label"], "fear", "{file}: {text}");
        assert_eq!(back["segments"][0]["expression"], serde_json::json!([100, 300]), "{file}");
    }
    let eaf = workspace.expressions_eaf(None, "2026-01-01T00:00:00+00:00").unwrap();
    let neutral = workspace.expressions_file("n.eaf", &eaf.replace(">fear<", ">neutral<")).unwrap();
    assert_eq!(neutral["segments"].as_array().unwrap().len(), 1);
    assert_eq!(neutral["leftOut"], "annotations left out: 1 of the neutral face");
    let problem =
        workspace.set_expressions(r#"[{"label": "x", "expression": [5, 5]}]"#).unwrap_err();
    assert!(problem.to_string().contains("x: frames 5:5 of"), "{problem}");
}

#[test]
fn what_is_exported_is_what_was_solved() {
    let mut workspace = built_in();
    workspace.solve("a", r#"{"method": "box"}"#).unwrap();
    let csv = workspace.weights_csv("a").unwrap();
    let glb = workspace.animated_glb("a", 60, 160).unwrap();
    let mut again = Workspace::new();
    let facts = again.avatar_file("animated.glb", glb, None).unwrap();
    assert_eq!(facts["shapes"].as_array().unwrap().len(), 57);
    again.take_file("weights.csv", csv.as_bytes(), None, None).unwrap();
    let facts = again.solve("a", r#"{"method": "recorded"}"#).unwrap();
    assert_eq!(facts["warnings"], serde_json::json!([]));
    let (a, b) = (workspace.weights("a").unwrap(), again.weights("a").unwrap());
    // Recorded weights have the shapes of the body, too, which rest.
    assert_eq!(a.len() / 51, b.len() / 57);
    for (a, b) in a.chunks_exact(51).zip(b.chunks_exact(57)) {
        assert!(a.iter().chain(&[0.0; 6]).zip(b).all(|(x, y)| (x - y).abs() < 1e-6));
    }
}

#[test]
fn bounds_locks_and_importance_are_solved_and_come_back_as_settings() {
    let mut workspace = built_in();
    let plain = workspace.solve("a", r#"{"method": "lsts"}"#).unwrap();
    let shapes: Vec<&str> =
        plain["shapes"].as_array().unwrap().iter().map(|s| s.as_str().unwrap()).collect();
    let column = |weights: &[f32], name: &str| -> Vec<f32> {
        let k = shapes.iter().position(|s| *s == name).unwrap();
        weights.iter().skip(k).step_by(shapes.len()).copied().collect()
    };
    let before = column(&workspace.weights("a").unwrap(), "jawOpen");
    assert!(before.iter().any(|&w| w > 0.3) && before.iter().any(|&w| w < 0.1));

    // No gaze is given, but the bounds of one of its shapes are: it is not held.
    let method = r#"{"method": "lsts", "locked": ["mouthPucker"], "importance": {"chin": 0.0},
        "bounds": {"jawOpen": [0.1, 0.2], "eyeLookInLeft": [0.25, 0.25]}}"#;
    let facts = workspace.solve("b", method).unwrap();
    let weights = workspace.weights("b").unwrap();
    assert!(column(&weights, "jawOpen").iter().all(|w| (0.1..=0.2).contains(w)));
    assert!(column(&weights, "mouthPucker").iter().all(|&w| w == 0.0));
    assert!(column(&weights, "eyeLookInLeft").iter().all(|&w| w == 0.25));
    let settings = &facts["settings"];
    assert_eq!(settings["locked"], serde_json::json!(["mouthPucker"]));
    // They are the whole method: what is held follows from it.
    let again = workspace.solve("c", &settings.to_string()).unwrap();
    assert_eq!(again["weights_hash"], facts["weights_hash"]);
    assert_ne!(again["weights_hash"], plain["weights_hash"]);

    // A pattern is the names that it matches here.
    let named = workspace
        .named_method(r#"{"method": "lsts", "locked": ["brow*Left"], "importance": {"nose_*": 2}}"#)
        .unwrap();
    assert_eq!(named["locked"], serde_json::json!(["browDownLeft", "browOuterUpLeft"]));
    assert!(named["importance"]["nose_tip"] == 2.0, "{named}");

    for (method, part) in [
        (
            r#"{"method": "lsts", "bounds": {"jawOpen": [1, 0]}}"#,
            "method: bounds.jawOpen: is [1, 0]",
        ),
        (r#"{"method": "lsts", "importance": {"chin": -1}}"#, "method: importance.chin: is -1"),
        (r#"{"method": "lsts", "bounds": {"jaw": [0, 1]}}"#, "jaw"),
    ] {
        let problem = workspace.solve("a", method).unwrap_err();
        assert!(problem.to_string().contains(part), "{problem}");
    }
}

#[test]
fn regression_learns_from_files_what_it_learns_from_the_built_in_actor() {
    let mut workspace = built_in();
    let method = r#"{"method": "regression", "basisVectors": 40}"#;
    let missing = &workspace.training_state()["missing"];
    assert_eq!(missing["text"], "open a range of motion and its weights");
    assert_eq!(missing["is"]["code"], "no-training");
    let state = workspace.built_in_training(1);
    assert_eq!(state["missing"], Value::Null);
    let facts = workspace.solve("a", method).unwrap();
    let built_in_weights = workspace.weights("a").unwrap();
    assert!(number(&facts["summary"]["residual_rms_mm"]) < 5.0, "{}", facts["summary"]);

    // The same actor's range of motion as files.
    let spec = HeadSpec {
        identity: Identity::from_seed(1 ^ 0x6163_746f_7273_0000),
        density: Density::default(),
    };
    let sites = marker_sites(&spec);
    let take = range_of_motion_take(&build_head(&spec), &sites, 1 ^ 0x726f_6d00_0000_0000, 0.1);
    let frames = take.frames();
    let table = WeightsTable::at_rate(take.shape_names, take.truth, 0, take.rate_hz);
    let capture = Capture::new(take.labels, take.rate_hz, LengthUnit::Millimetre, take.positions);
    let text = mimique_mocap::write_csv(&capture).unwrap();
    let mut workspace = built_in();
    let short: String = table.to_csv().lines().take(100).map(|line| format!("{line}\n")).collect();
    let state = workspace.training_weights("rom-weights.csv", short.as_bytes()).unwrap();
    assert_eq!(state["missing"]["text"], "open the capture that these weights belong to");
    let state = workspace.training_take("rom.csv", text.as_bytes(), None, None).unwrap();
    let missing = format!("rom.csv has {frames} frames, rom-weights.csv 99; give a row");
    assert!(state["missing"]["text"].as_str().unwrap().starts_with(&missing), "{state}");
    assert!(workspace.solve("a", method).unwrap_err().to_string().contains("rom-weights.csv 99"));
    let state = workspace.training_weights("rom-weights.csv", table.to_csv().as_bytes()).unwrap();
    assert_eq!((&state["missing"], &state["neutral"]), (&Value::Null, &serde_json::json!([0, 60])));
    workspace.set_training_neutral(take.neutral[0], take.neutral[1]).unwrap();
    workspace.solve("a", method).unwrap();
    let weights = workspace.weights("a").unwrap();
    assert_eq!(weights, built_in_weights);
    assert!(weights.iter().any(|&w| w > 0.3));

    for (problem, part) in [
        (workspace.set_training_neutral(5, 5).unwrap_err(), "rom.csv: neutral frames 5:5 of"),
        (workspace.training_weights("w.csv", b"frame,time\n").unwrap_err(), "w.csv: "),
        (workspace.training_take("t.c3d", b"", None, None).unwrap_err(), "t.c3d: "),
    ] {
        assert!(problem.to_string().contains(part), "{problem}");
    }
}

#[test]
fn a_real_capture_is_matched_and_solved_without_help() {
    let Some(data) = real_data("a_real_capture_is_matched_and_solved_without_help") else { return };
    let read = |path: &str| std::fs::read(data.join(path)).unwrap();
    let mut workspace = Workspace::new();
    workspace.avatar_file("ict-facekit.glb", read("ict-facekit/ict-facekit.glb"), None).unwrap();
    workspace.take_file("JawMoCap.c3d", &read("animface/JawMoCap.c3d"), None, None).unwrap();
    let state = workspace.suggest_map().unwrap();
    assert!(state["suggestion"]["notes"].is_array());
    let facts = workspace.solve("a", r#"{"method": "lsts"}"#).unwrap();
    assert!(number(&facts["summary"]["residual_rms_mm"]) < 3.0, "{}", facts["summary"]);
}

#[test]
fn the_eyes_look_where_they_are_told_to() {
    let mut workspace = built_in();
    let method = r#"{"method": "box"}"#;
    let solve = |workspace: &mut Workspace| workspace.solve("a", method).unwrap();
    let looks_left = |workspace: &Workspace| -> f64 {
        let names: Vec<String> = mimique_actor::SHAPE_NAMES.map(str::to_owned).to_vec();
        let weights = workspace.weights("a").unwrap();
        let row: Vec<f64> = weights[..names.len()].iter().map(|w| f64::from(*w)).collect();
        mimique_avatar::GazeShapes::of(&names).eyes(&row).gaze().unwrap().azimuth
    };
    solve(&mut workspace);
    assert_eq!(looks_left(&workspace), 0.0);
    assert_eq!(workspace.hold_gaze(12.0, 0.0, 0.0).unwrap()["kind"], "held");
    let facts = solve(&mut workspace);
    assert!((looks_left(&workspace) - 12.0).abs() < 1e-4);
    assert_eq!(facts["gaze_at_rest"], serde_json::json!([]));
    let track = b"frame,time,azimuth,elevation,vergence\n0,0,-8,0,0\n1,90,-8,0,0\n";
    assert_eq!(workspace.gaze_file("gaze.csv", track).unwrap()["kind"], "file");
    solve(&mut workspace);
    assert!((looks_left(&workspace) + 8.0).abs() < 1e-4);
    // A marker of the capture; what is none is refused with its name, and so are angles that eyes do not turn by.
    let marker = workspace.gaze_state()["markers"][0].as_str().unwrap().to_owned();
    assert_eq!(workspace.gaze_at_marker(&marker).unwrap()["kind"], "marker");
    let refused = workspace.gaze_at_marker("moon").unwrap_err().to_string();
    assert_eq!(refused, "gaze: no marker moon; choose one of the capture");
    let refused = workspace.hold_gaze(0.0, 60.0, 0.0).unwrap_err().to_string();
    assert_eq!(refused, "gaze, elevation: 60 degrees; write -45 to 45");
    let refused = workspace.gaze_file("x.csv", b"a,b\n1,2\n").unwrap_err().to_string();
    assert!(refused.starts_with("x.csv: "), "{refused}");
    // The eyes rest again, and with another take.
    assert_eq!(workspace.rest_gaze()["kind"], "rest");
    workspace.hold_gaze(12.0, 0.0, 0.0).unwrap();
    workspace.built_in_take(2);
    assert_eq!(workspace.gaze_state()["kind"], "rest");
}
