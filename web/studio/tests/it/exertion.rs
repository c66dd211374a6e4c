//! Exertion as the page uses it: settings in; courses, the body, the face and files out.

use mimique_mocap::{LengthUnit, read_bytes};
use mimique_stimulus::built_in_bvh;
use mimique_web_studio::Workspace;
use serde_json::{Value, json};

fn settings(changes: Value) -> String {
    let mut all = json!({
        "source": "run", "seconds": 300, "person": {}, "heart": "thesis", "model": "rules", "breath": true,
        "skin": false, "seed": null, "window": [290, 300],
    });
    let (Value::Object(all_members), Value::Object(changes)) = (&mut all, changes) else {
        unreachable!("objects")
    };
    all_members.extend(changes);
    all.to_string()
}

fn told(workspace: &mut Workspace, changes: Value) -> Value {
    let told = workspace.exertion(&settings(changes)).unwrap();
    assert_eq!(told["problem"], Value::Null, "{told}");
    told
}

/// Place and words of what is wrong.
fn problem(workspace: &mut Workspace, changes: Value) -> (String, String) {
    let told = workspace.exertion(&settings(changes)).unwrap();
    let text = |key: &str| told["problem"][key].as_str().unwrap_or_default().to_owned();
    (text("place"), text("text"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn with_head() -> Workspace {
    let mut workspace = Workspace::new();
    workspace.built_in_avatar(1, 4_000).unwrap();
    workspace
}

/// The mean of a shape's weights.
fn mean(told: &Value, shape: &str) -> f64 {
    let lines = told["drawing"]["weights"].as_array().unwrap();
    let line = lines.iter().find(|line| line["name"] == shape).unwrap();
    let values = numbers(&line["values"]);
    values.iter().sum::<f64>() / values.len() as f64
}

const RIDE: &[u8] = b"time,power_w,heart_rate\n0,200,100\n1,200,104\n2,220,108\n3,220,112\n4,200,116\n5,200,118\n6,200,119\n";

#[test]
fn training_calms_heart_and_mouth_and_changes_no_work() {
    let mut workspace = with_head();
    let untrained = told(&mut workspace, json!({"person": {"level": 0}}));
    let trained = told(&mut workspace, json!({"person": {"level": 10}}));
    let end = |told: &Value| told["end"]["heartRate"].as_f64().unwrap();
    assert!(end(&trained) < end(&untrained) - 20.0, "{} {}", end(&trained), end(&untrained));
    assert!(mean(&trained, "jawOpen") < 0.7 * mean(&untrained, "jawOpen"));
    let work = |told: &Value| told["drawing"]["courses"][2]["lines"][0].clone();
    assert_eq!(work(&trained), work(&untrained), "the body does the same");
    // What is carried is lifted.
    let laden = told(&mut workspace, json!({"person": {"level": 10, "loads": {"back": 20}}}));
    let sum = |told: &Value| numbers(&work(told)["values"]).iter().sum::<f64>();
    assert!(sum(&laden) > 1.05 * sum(&trained), "{} {}", sum(&laden), sum(&trained));
}

#[test]
fn the_face_lies_in_its_slot_and_stays_when_takes_go() {
    let mut workspace = Workspace::new();
    let faceless = told(&mut workspace, json!({}));
    assert_eq!(faceless["face"], Value::Null, "courses need no avatar");
    assert!(workspace.weights("exertion").is_err());
    workspace.built_in_avatar(1, 4_000).unwrap();
    let face = &told(&mut workspace, json!({"window": [295, 300]}))["face"];
    let shapes = face["shapes"].as_array().unwrap().len();
    assert_eq!(face["frames"], 301);
    let weights = workspace.weights("exertion").unwrap();
    assert_eq!(weights.len(), 301 * shapes);
    assert!(weights.iter().any(|&weight| weight > 0.2));
    let warnings = face["warnings"].to_string();
    assert!(warnings.contains("held at 0") && warnings.contains("eyeLook"), "{warnings}");
    let glb = workspace.animated_glb("exertion", 0, 301).unwrap();
    assert_eq!(&glb[..4], b"glTF");
}

#[test]
fn the_chest_breathes_and_the_skin_reddens_on_request() {
    let mut workspace = Workspace::new();
    workspace.built_in_avatar(1, 4_000).unwrap();
    let mut most = |changes: Value, shape: &str| {
        let told = told(&mut workspace, changes);
        let shapes = told["face"]["shapes"].as_array().unwrap();
        let place = shapes.iter().position(|name| name == shape).unwrap();
        let weights = workspace.weights("exertion").unwrap();
        weights.iter().skip(place).step_by(shapes.len()).fold(0.0, |most: f32, w| most.max(*w))
    };
    assert!(most(json!({}), "breath") > 0.5);
    assert_eq!(most(json!({"breath": false}), "breath"), 0.0);
    assert_eq!(most(json!({}), "flush"), 0.0);
    assert!(most(json!({"skin": true}), "flush") > 0.3);
    assert!(most(json!({"skin": true}), "sweat") > 0.1);
}

#[test]
fn files_are_those_of_the_command() {
    let mut workspace = Workspace::new();
    told(&mut workspace, json!({"seed": 3}));
    let weights = workspace.exertion_weights_csv().unwrap();
    assert_eq!(weights.lines().count(), 602);
    assert!(weights.starts_with("frame,time,browDownLeft"), "{}", &weights[..60]);
    let series = workspace.exertion_series_csv().unwrap();
    assert_eq!(series.lines().count(), 302);
    assert!(series.starts_with("t,w,p,rcn,hr,"));
    let plot = workspace.exertion_plot().unwrap();
    assert!(plot.starts_with("<svg ") && plot.contains("EPOC, ml/kg"), "{plot}");
}

#[test]
fn a_study_file_takes_what_is_saved_for_it() {
    let mut workspace = Workspace::new();
    told(&mut workspace, json!({"person": {"level": 8, "loads": {"back": 5}}, "heart": "steady"}));
    let parts: Value = serde_json::from_str(&workspace.exertion_study().unwrap()).unwrap();
    let own = &parts["captures"]["run"]["exertion"];
    assert_eq!(
        (&own["builtin"], &own["for"], &own["heart"]),
        (&json!("run"), &json!(300.0), &json!("steady"))
    );
    assert_eq!(own["person"], json!({"level": 8.0, "loads": {"back": 5.0}}));
    assert_eq!(
        parts["segments"],
        json!([{"id": "run", "capture": "run", "first": 17400, "end": 18001}])
    );
    serde_json::from_value::<mimique_study::ExertionCapture>(own.clone()).unwrap();

    workspace.exertion_file("ride.csv", RIDE, None, None).unwrap();
    told(&mut workspace, json!({"source": "file", "seconds": null, "window": [0, 6]}));
    let parts: Value = serde_json::from_str(&workspace.exertion_study().unwrap()).unwrap();
    let own = &parts["captures"]["ride"]["exertion"];
    assert_eq!((&own["activity"], &own["motion"]), (&json!("ride.csv"), &Value::Null));
    assert_eq!(own["for"], Value::Null, "all of it");
    serde_json::from_value::<mimique_study::ExertionCapture>(own.clone()).unwrap();
}

#[test]
fn the_body_stands_on_its_floor_and_begins_again() {
    let mut workspace = Workspace::new();
    let figure = &told(&mut workspace, json!({"source": "walk"}))["drawing"]["figure"];
    let joints = figure["joints"].as_array().unwrap();
    let positions = numbers(&figure["millimetres"]);
    let width = 3 * joints.len();
    let last = positions.len() - width;
    assert_eq!(positions.len() % width, 0);
    let lowest = positions.iter().skip(1).step_by(3).copied().fold(f64::MAX, f64::min);
    assert!((0.0..20.0).contains(&lowest), "{lowest}");
    let place = |frame: usize, name: &str| {
        let joint = joints.iter().position(|own| own == name).unwrap();
        [0, 1, 2].map(|axis| positions[frame + 3 * joint + axis])
    };
    assert!((1600.0..1800.0).contains(&place(0, "headTop")[1]), "{:?}", place(0, "headTop"));
    assert!(place(0, "leftHip")[0] > 50.0 && place(0, "rightHip")[0] < -50.0, "left is left");
    // Toes point forwards.
    assert!(
        place(0, "leftToe")[2] > place(0, "leftAnkle")[2]
            && place(0, "rightToe")[2] > place(0, "rightAnkle")[2]
    );
    // After a period everything is where it was.
    let apart = (0..width).map(|i| (positions[i] - positions[last + i]).abs()).fold(0.0, f64::max);
    assert!(apart < 40.0, "{apart}");
    let period = figure["periodS"].as_f64().unwrap();
    let count = (positions.len() / width - 1) as f64;
    assert!((count / figure["rateHz"].as_f64().unwrap() - period).abs() < 1e-6);
}

#[test]
fn a_motion_of_a_file_and_one_without_joints() {
    let mut workspace = Workspace::new();
    let bvh = built_in_bvh(&mimique_actor::Gait::RUN);
    assert_eq!(read_bytes(bvh.as_bytes()).unwrap().unit, LengthUnit::Centimetre);
    workspace.exertion_file("run.bvh", bvh.as_bytes(), None, None).unwrap();
    let own = told(&mut workspace, json!({"source": "file"}));
    let built_in = told(&mut workspace, json!({}));
    assert_eq!(own["drawing"]["courses"], built_in["drawing"]["courses"]);
    assert!(own["remarks"].to_string().contains("repeated"));
    // The capture of the workspace is one, too.
    workspace.take_file("run.bvh", bvh.as_bytes(), None, None).unwrap();
    let take = told(&mut workspace, json!({"source": "take"}));
    assert_eq!(take["drawing"]["figure"], built_in["drawing"]["figure"]);

    workspace.built_in_take(1);
    let (place, text) = problem(&mut workspace, json!({"source": "take"}));
    assert_eq!(place, "source");
    assert!(
        text.contains("no joints of a body") && text.contains("CMU, Mixamo or Xsens"),
        "{text}"
    );
    assert!(workspace.exertion_weights_csv().is_err(), "nothing of before is saved for it");
}

#[test]
fn a_recording_has_a_heart_and_no_body() {
    let mut workspace = Workspace::new();
    let facts = workspace.exertion_file("ride.csv", RIDE, None, None).unwrap();
    assert_eq!(
        facts,
        json!({"file": "ride.csv", "isActivity": true, "hasHeart": true, "spanS": 6.0})
    );
    let ride = json!({"source": "file", "seconds": null, "window": [0, 6], "heart": "recorded"});
    let own = told(&mut workspace, ride);
    assert_eq!(own["drawing"]["figure"], Value::Null);
    assert_eq!(own["end"]["heartRate"], 119.0);
    let longer = json!({"source": "file", "seconds": 60, "window": [0, 6]});
    assert_eq!(problem(&mut workspace, longer).0, "seconds");
    let (place, text) = problem(&mut workspace, json!({"heart": "recorded"}));
    assert_eq!(place, "heart");
    assert!(text.contains("no heart rate"), "{text}");
}

#[test]
fn wrong_numbers_are_said_at_their_inputs() {
    let mut workspace = Workspace::new();
    for (changes, place, words) in [
        (json!({"person": {"level": 11}}), "person/level", "0 to 10"),
        (
            json!({"person": {"expressivity": {"eyes": -1}}}),
            "person/expressivity/eyes",
            "0 or more",
        ),
        (json!({"person": {"loads": {"back": -1}}}), "person/loads/back", "0 or more"),
        (json!({"seconds": -5}), "seconds", "above 0"),
        (json!({"seconds": 1e6, "window": [0, 5]}), "seconds", "86400"),
        (json!({"window": [290, 310]}), "window", "of 300 s"),
        (json!({"window": [5, 5]}), "window", "end after its beginning"),
        (json!({"seconds": 3000, "window": [0, 3000]}), "window", "at most 600 s"),
        (json!({"source": "file"}), "source", "open a motion"),
        (json!({"model": "file"}), "model", "open one"),
        (json!({"source": "take"}), "source", "open one first"),
    ] {
        let (at, said) = problem(&mut workspace, changes.clone());
        assert_eq!(at, place, "{changes}");
        assert!(said.contains(words), "{changes}: {said}");
    }
    assert!(workspace.exertion("{}").is_err());
    let broken = workspace.exertion_model("m.json", "{").unwrap_err().to_string();
    assert!(broken.starts_with("m.json: line 1"), "{broken}");
    let file = workspace.exertion_file("x.bin", b"\0\x01\x02", None, None).unwrap_err();
    assert!(file.to_string().starts_with("x.bin: "), "{file}");
}

#[test]
fn warnings_have_the_pages_own_remedies() {
    let mut workspace = Workspace::new();
    let run = told(&mut workspace, json!({"source": "sprint"}));
    let warnings = run["warnings"].to_string();
    assert!(warnings.contains("nine tenths") && warnings.contains("steady settles"), "{warnings}");
    assert!(!warnings.contains("--"), "{warnings}");
}
