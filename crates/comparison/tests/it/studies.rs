//! Clips of a study that differ in more than the method are found, and those that do not are not.

use mimique_comparison::{Disagreement, StudyComparison, compare_clips};
use mimique_stimulus::{Places, prepare};
use mimique_study::Study;
use serde_json::{Value, json};

/// A study of the given stimuli and nothing else.
fn study(stimuli: Value) -> Study {
    let template = concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/demo.json");
    let mut file = mimique_study::parse(&std::fs::read_to_string(template).unwrap()).unwrap();
    file["stimuli"] = stimuli;
    serde_json::from_value(file).unwrap()
}

fn compared(stimuli: Value) -> StudyComparison {
    let study = study(stimuli);
    let packs = tempfile::tempdir().unwrap();
    let places = Places { study: packs.path().into(), data: None, packs: packs.path().into() };
    let prepared = prepare(&study, &places, &mut |_| ()).unwrap();
    let read = |hash: &str| std::fs::read(packs.path().join(hash));
    let comparison = compare_clips(&study, &prepared.clips, &read).unwrap();
    // It goes through JSON, as servers keep it.
    let text = serde_json::to_string(&comparison).unwrap();
    assert_eq!(serde_json::from_str::<StudyComparison>(&text).unwrap(), comparison);
    comparison
}

fn stimuli(gaze: Value, methods: Value) -> Value {
    json!({
        "avatars": {"own": {"builtin": {"actor": 1, "vertices": 2000}}},
        "captures": {"actor": {"builtin": {"actor": 1}, "rateHz": 60, "gaze": gaze}},
        "segments": [{"id": "joy2", "capture": "actor",
                      "performance": {"expression": "joy", "intensity": 2}}],
        "methods": methods,
    })
}

#[test]
fn methods_are_compared_in_millimetres_and_are_else_the_same() {
    let methods = json!({"lsts": {"method": "lsts", "alpha": 0.7}, "box": {"method": "box"},
                         "surface": {"method": "thin-shell-surface"}});
    let told = compared(stimuli(Value::Null, methods));
    let rests =
        |unlike: &&mimique_comparison::Unlike| !matches!(unlike.what, Disagreement::Blink { .. });
    assert_eq!(told.unlike.iter().filter(rests).count(), 0, "{:?}", told.unlike);
    assert_eq!(told.differences.len(), 3, "a surface has the avatar's vertices");
    for each in &told.differences {
        assert_eq!((each.segment.as_str(), each.avatar.as_str()), ("joy2", "own"));
        assert!(each.difference.parts.len() > 5);
        let whole = each.difference.parts.last().unwrap();
        assert!(whole.rms_mm > 0.01 && whole.rms_mm < 5.0 && whole.largest_mm > whole.rms_mm);
    }
    // A moved surface goes through the markers.
    let surface = value(&told, "joy2.surface", "obj_marker_correlation").unwrap();
    assert!(surface > 0.9999, "{surface}");
    let [lsts, plain] = ["joy2.lsts", "joy2.box"].map(|clip| {
        ["obj_residual_mm", "obj_marker_correlation"].map(|name| value(&told, clip, name).unwrap())
    });
    // The box comes nearest to the markers: nothing else draws it.
    assert!(
        plain[0] < lsts[0] && plain[1] >= lsts[1] - 1e-6 && plain[1] > 0.9,
        "{plain:?} {lsts:?}"
    );
    assert_eq!(value(&told, "joy2.box", "obj_recorded_rmse_mm"), None, "nothing was recorded");
}

/// What is measured of a clip.
fn value(told: &StudyComparison, clip: &str, name: &str) -> Option<f64> {
    let of_clip = told.measures.iter().find(|each| each.clip == clip).unwrap();
    of_clip.values.iter().find(|(own, _)| own == name).map(|(_, value)| *value)
}

#[test]
fn eyes_that_look_elsewhere_in_the_performance_itself_are_found_until_a_gaze_is_given() {
    let methods = json!({"lsts": {"method": "lsts", "alpha": 0.3}, "real": {"method": "recorded"}});
    let told = compared(stimuli(Value::Null, methods.clone()));
    let degrees = told.unlike.iter().find_map(|unlike| match unlike.what {
        Disagreement::Gaze { degrees, .. } => Some(degrees),
        _ => None,
    });
    assert!(degrees.is_some_and(|degrees| degrees > 1.0), "{:?}", told.unlike);
    let (what, remedy) = told.unlike[0].words();
    assert!(
        what.contains("joy2.lsts and joy2.real") && remedy.contains("gaze"),
        "{what}; {remedy}"
    );
    let told = compared(stimuli(json!({"performed": true}), methods));
    let gaze =
        |unlike: &mimique_comparison::Unlike| matches!(unlike.what, Disagreement::Gaze { .. });
    assert!(!told.unlike.iter().any(gaze), "{:?}", told.unlike);
    // What is told of the clip is what is told of the two.
    let apart = &told.differences[0];
    let whole = apart.difference.parts.last().unwrap();
    assert_eq!(value(&told, "joy2.lsts", "obj_recorded_rmse_mm"), Some(whole.rms_mm));
    assert_eq!(value(&told, "joy2.real", "obj_recorded_rmse_mm"), None);
    assert_eq!(value(&told, "joy2.real", "obj_residual_mm"), None);
    assert!(value(&told, "joy2.real", "obj_range_mm_face").unwrap() > 0.1);
}

#[test]
fn clips_that_differ_by_their_sound_alone_have_the_same_measures() {
    let mut told = stimuli(Value::Null, json!({"box": {"method": "box"}}));
    told["sounds"] = json!({"silent": {"silent": true}, "mute": {"silent": true}});
    let told = compared(told);
    assert!(told.differences.is_empty(), "{:?}", told.differences);
    let [a, b] = &told.measures[..] else { panic!("{:?}", told.measures) };
    assert!(a.clip != b.clip && a.values == b.values && !a.values.is_empty(), "{a:?} {b:?}");
}
