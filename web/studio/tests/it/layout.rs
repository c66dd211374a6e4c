//! Layouts as the page uses them: made, opened, moved, thinned, taken back, saved.

use mimique_stimulus::MarkerMap;
use mimique_web_studio::Workspace;
use serde_json::{Value, json};

fn workspace() -> Workspace {
    let mut workspace = Workspace::new();
    workspace.built_in_avatar(1, 4_000).unwrap();
    workspace
}

fn made() -> (Workspace, Value) {
    let mut workspace = workspace();
    let state = workspace.make_layout("greedy", 24, 6, true).unwrap();
    (workspace, state)
}

fn markers(state: &Value) -> &Vec<Value> {
    state["markers"].as_array().unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn vertex(state: &Value, index: usize) -> usize {
    markers(state)[index]["vertex"].as_u64().unwrap() as usize
}

/// The index of the marker that mirrors another.
fn partner(state: &Value, index: usize) -> usize {
    let label = markers(state)[index]["label"].as_str().unwrap();
    let other =
        if label.contains("_L") { label.replace("_L", "_R") } else { label.replace("_R", "_L") };
    assert_ne!(other, label, "not in the middle");
    markers(state).iter().position(|marker| marker["label"] == other).unwrap()
}

/// The first marker of a pair.
fn of_a_pair(state: &Value) -> usize {
    let left = |marker: &Value| marker["label"].as_str().unwrap().contains("_L");
    markers(state).iter().position(left).unwrap()
}

#[test]
fn a_layout_is_made_with_its_curve_and_saved_as_a_map_that_solve_reads() {
    let (mut workspace, state) = made();
    assert_eq!(markers(&state).len(), 24);
    assert_eq!(state["head"].as_array().unwrap().len(), 6);
    assert_eq!(state["motion"]["source"], "independent-shapes");
    let curve = numbers(&state["curveMm"]);
    assert_eq!(curve.len(), 25);
    assert!(curve.windows(2).all(|pair| pair[1] <= pair[0]), "{curve:?}");
    assert_eq!(state["curveMm"], state["firstCurveMm"]);
    assert_eq!(state["near"], json!([]), "markers of a method keep their distance");
    assert!(markers(&state).iter().all(|marker| marker["allowed"] == true));

    let text = workspace.layout_json().unwrap();
    let map = MarkerMap::from_text(&text).unwrap();
    assert_eq!((map.face.len(), map.head.len()), (24, 6));
    let about: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(about["layout"]["method"], "greedy");
    assert_eq!(about["layout"]["head"].as_object().unwrap().len(), 6);
    // What was saved opens as it was, head markers and all.
    let mut other = self::workspace();
    let opened = other.layout_file("layout.json", &text).unwrap();
    for key in ["curveMm", "head"] {
        assert_eq!(opened[key], state[key], "{key}");
    }
    assert_eq!(opened["origin"], json!({"map": "layout.json"}));
}

#[test]
fn a_marker_that_moves_takes_its_partner_and_the_curve_along_and_comes_back() {
    let (mut workspace, state) = made();
    let index = of_a_pair(&state);
    let other = partner(&state, index);
    let to = free_vertex(&state, vertex(&state, index));
    let moved = workspace.move_layout_marker(index, to, true, true).unwrap();
    assert_eq!(vertex(&moved, index), to);
    assert_ne!(vertex(&moved, other), vertex(&state, other), "its partner went along");
    let mirrored = |state: &Value, i: usize| numbers(&markers(state)[i]["position"]);
    let (own, image) = (mirrored(&moved, index), mirrored(&moved, other));
    assert!(
        (own[0] + image[0]).abs() < 2e-3 && (own[1] - image[1]).abs() < 2e-3,
        "{own:?} {image:?}"
    );
    let (before, after) = (numbers(&state["curveMm"]), numbers(&moved["curveMm"]));
    assert_eq!(before[..=index], after[..=index], "markers before it tell what they told");
    assert_ne!(before[index + 1], after[index + 1]);
    assert_eq!(moved["firstCurveMm"], state["curveMm"]);

    // The rest of a drag is the same step; a partner may stay.
    let alone = workspace.move_layout_marker(index, vertex(&state, index), false, false).unwrap();
    assert_eq!(vertex(&alone, other), vertex(&moved, other));
    assert_eq!(alone["steps"], 1);
    let back = workspace.undo_layout().unwrap();
    assert_eq!(back["curveMm"], state["curveMm"]);
    assert_eq!(back["steps"], 0);

    // Where a marker is, no other goes.
    let same = workspace.move_layout_marker(index, vertex(&state, other), true, true).unwrap();
    assert_eq!(same["curveMm"], state["curveMm"]);
    assert_eq!(same["steps"], 0);
}

/// A vertex near another that has no marker.
fn free_vertex(state: &Value, near: usize) -> usize {
    let taken: Vec<usize> = (0..markers(state).len()).map(|i| vertex(state, i)).collect();
    (near + 1..).find(|v| !taken.contains(v)).unwrap()
}

#[test]
fn what_dropping_a_marker_costs_is_what_the_error_rises_by() {
    let (mut workspace, state) = made();
    let all = numbers(&state["curveMm"])[24];
    for index in [0, 5, 11, 17, 23] {
        let cost = markers(&state)[index]["expectedMm"].as_f64().unwrap();
        let dropped = workspace.drop_layout_marker(index).unwrap();
        let left = numbers(&dropped["curveMm"]);
        assert_eq!(left.len(), 24);
        assert!(
            (left[23] - all - cost).abs() < 1e-6 && cost > 0.0,
            "{index}: {cost} {}",
            left[23] - all
        );
        workspace.undo_layout().unwrap();
    }
}

#[test]
fn a_rehearsal_says_what_each_marker_is_worth_until_something_moves() {
    let (mut workspace, _) = made();
    let state = workspace.rehearse_layout().unwrap();
    let costs: Vec<f64> =
        markers(&state).iter().map(|marker| marker["rehearsedMm"].as_f64().unwrap()).collect();
    let all = state["rehearsedMm"].as_f64().unwrap();
    let cheapest = (0..costs.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap();
    workspace.drop_layout_marker(cheapest).unwrap();
    let without = workspace.rehearse_layout().unwrap()["rehearsedMm"].as_f64().unwrap();
    assert!((without - all - costs[cheapest]).abs() < 1e-9, "{without} {all}");
    let other = workspace.undo_layout().unwrap();
    assert_eq!(other["isRehearsed"], false);
    assert!(markers(&other).iter().all(|marker| marker["rehearsedMm"].is_null()));
}

#[test]
fn a_map_of_ones_own_keeps_what_is_not_moved() {
    let mut workspace = workspace();
    workspace.built_in_take(1);
    let own = workspace.map_json();
    let state = workspace.layout_from_map().unwrap();
    assert_eq!(markers(&state).len(), 40);
    let dropped = markers(&state)[3]["label"].clone();
    workspace.drop_layout_marker(3).unwrap();
    let (own, saved): (Value, Value) = (
        serde_json::from_str(&own).unwrap(),
        serde_json::from_str(&workspace.layout_json().unwrap()).unwrap(),
    );
    let mut expected = own["markers"].as_object().unwrap().clone();
    assert!(expected.remove(dropped.as_str().unwrap()).is_some());
    assert_eq!(saved["markers"], Value::Object(expected));
    assert_eq!((&saved["head"], &saved["neutral"]), (&own["head"], &own["neutral"]));
    assert_eq!(saved["layout"]["changed"], true);
}

#[test]
fn the_training_takes_weights_are_the_motion() {
    let (mut workspace, state) = made();
    workspace.built_in_training(1);
    let judged = workspace.layout_state().unwrap();
    assert_eq!(judged["motion"], json!({"source": "takes", "name": "built-in actor"}));
    assert_ne!(judged["curveMm"], state["curveMm"]);
}

#[test]
fn what_cannot_be_is_said_with_a_remedy() {
    let said = |result: Result<Value, mimique_web_studio::Problem>| result.unwrap_err().to_string();
    let mut empty = Workspace::new();
    assert!(said(empty.make_layout("greedy", 24, 6, true)).contains("open one first"));
    assert_eq!(empty.layout_state().unwrap(), json!({"markers": []}));
    let (mut workspace, _) = made();
    assert!(said(workspace.make_layout("greedy", 3, 6, true)).contains("at least 4"));
    assert!(said(workspace.make_layout("best", 24, 6, true)).contains("greedy"));
    assert!(said(workspace.make_layout("farthest", 900, 6, true)).contains("ask for fewer"));
    assert!(said(workspace.make_layout("greedy", 24, 2, true)).contains("head"));
    assert!(said(workspace.move_layout_marker(99, 0, true, true)).contains("99 of 24"));
    assert!(said(workspace.move_layout_marker(0, 99_999, true, true)).contains("on the face"));
    assert!(said(workspace.undo_layout()).contains("nothing"));
    assert!(said(workspace.layout_file("map.json", "{")).starts_with("map.json"));
    let few = r#"{"unit": "m", "markers": {"a": {"vertex": 1}, "b": {"vertex": 2}}}"#;
    assert!(said(workspace.layout_file("few.json", few)).contains("2 markers"));
    // The layout is as it was.
    assert_eq!(markers(&workspace.layout_state().unwrap()).len(), 24);
}
