//! Lids follow their markers: planted on the built-in head, recovered natively and through packs.

use mimique_actor::{HeadSpec, build_head};
use mimique_clip::{encode_operators, encode_take, solve_packs};
use mimique_mocap::{Capture, LengthUnit};
use mimique_solver::{Method, MethodSpec};
use mimique_stimulus::{AvatarSkin, JoinedTake, MarkerMap, TakeOptions, solve_take};

/// A map of vertices on the skin: a grid over the face, and the vertex that each lid moves most.
fn map(skin: &AvatarSkin) -> (MarkerMap, Vec<usize>) {
    let shape = |name: &str| skin.shape_names.iter().position(|n| n == name).unwrap();
    let mut vertices: Vec<usize> = Vec::new();
    for side in ["Left", "Right"] {
        let blink = &skin.mesh.shapes[shape(&format!("eyeBlink{side}"))];
        let lowest = (0..blink.vertices.len())
            .min_by(|&a, &b| blink.deltas[a][1].total_cmp(&blink.deltas[b][1]))
            .unwrap();
        vertices.push(blink.vertices[lowest] as usize);
    }
    // Markers that jaw, brows and mouth move, not the lids.
    for name in [
        "jawOpen",
        "browDownLeft",
        "browDownRight",
        "mouthSmileLeft",
        "mouthSmileRight",
        "mouthPucker",
        "browInnerUp",
        "mouthFrownLeft",
        "mouthFrownRight",
        "noseSneerLeft",
        "noseSneerRight",
        "cheekPuff",
    ] {
        let moved = &skin.mesh.shapes[shape(name)];
        let length = |i: usize| moved.deltas[i].length_squared();
        let most = (0..moved.vertices.len())
            .filter(|&i| !vertices.contains(&(moved.vertices[i] as usize)))
            .max_by(|&a, &b| length(a).total_cmp(&length(b)))
            .unwrap();
        vertices.push(moved.vertices[most] as usize);
    }
    let place = |v: usize| skin.mesh.positions[v].to_array();
    let markers: Vec<String> = vertices
        .iter()
        .enumerate()
        .map(|(i, &v)| format!("\"m{i}\": {{\"position\": {:?}}}", place(v)))
        .collect();
    let text = format!(
        "{{\"markers\": {{{}}}, \"neutral\": [0, 60], \"lids\": [\
         {{\"marker\": \"m0\", \"edge\": \"upper\", \"closed\": \"eyeBlinkLeft\", \"wide\": \"eyeWideLeft\"}},\
         {{\"marker\": \"m1\", \"edge\": \"upper\", \"closed\": \"eyeBlinkRight\"}}]}}",
        markers.join(", ")
    );
    (MarkerMap::from_text(&text).unwrap(), vertices)
}

#[test]
fn planted_blinks_and_a_jaw_are_recovered_natively_and_through_packs() {
    let avatar = build_head(&HeadSpec::default());
    let skin = AvatarSkin::of(&avatar).unwrap();
    let (map, vertices) = map(&skin);
    let n = skin.shape_names.len();
    let shape = |name: &str| skin.shape_names.iter().position(|s| s == name).unwrap();
    let [left, right, wide, jaw] =
        ["eyeBlinkLeft", "eyeBlinkRight", "eyeWideLeft", "jawOpen"].map(shape);
    let bump = |f: usize, at: usize, half: usize| {
        let t = (f as f64 - at as f64).abs() / half as f64;
        if t < 1.0 { 0.5 + 0.5 * (std::f64::consts::PI * t).cos() } else { 0.0 }
    };
    let frames = 400;
    let mut truth = vec![0.0; frames * n];
    let mut positions = Vec::new();
    for f in 0..frames {
        let row = &mut truth[f * n..(f + 1) * n];
        // Full blinks, half a blink of one eye, one eye wide, the mouth open meanwhile.
        row[left] = bump(f, 100, 20) + 0.5 * bump(f, 180, 20) + bump(f, 320, 20);
        row[right] = bump(f, 100, 20) + bump(f, 320, 20);
        row[wide] = bump(f, 250, 20);
        row[jaw] = 0.6 * bump(f, 200, 100);
        for &v in &vertices {
            let mut p = skin.mesh.positions[v];
            for (k, w) in row.iter().enumerate().filter(|(_, w)| **w != 0.0) {
                let moved = &skin.mesh.shapes[k];
                if let Some(i) = moved.vertices.iter().position(|m| *m as usize == v) {
                    (0..3).for_each(|a| p[a] += w * moved.deltas[i][a]);
                }
            }
            positions.push(p);
        }
    }
    let capture = Capture {
        labels: (0..vertices.len()).map(|i| format!("m{i}")).collect(),
        rate_hz: 100.0,
        first_frame: 0,
        unit: LengthUnit::Metre,
        positions,
        notes: Vec::new(),
    };
    let spec = MethodSpec::new(Method::Box);
    let options = TakeOptions::default();
    let native = solve_take(&skin, &capture, &map, &spec, &options, &mut || 0.0).unwrap();
    let error = |weights: &[f64], k: usize| {
        (0..frames).map(|f| (weights[f * n + k] - truth[f * n + k]).abs()).fold(0.0, f64::max)
    };
    for (name, k) in [("left", left), ("right", right), ("wide", wide)] {
        let off = error(&native.table.weights, k);
        assert!(off < 0.06, "{name}: {off}");
    }
    assert!(error(&native.table.weights, jaw) < 0.05);
    assert!(native.report.method.locked.contains(&"eyeBlinkLeft".to_owned()));

    // The same through packs, as the server and the browser do.
    let joined = JoinedTake::new(&skin, &capture, &map, &options).unwrap();
    let spec = joined.with_shapes_held(&spec);
    let operators = joined.operators(&spec).unwrap();
    let take = joined.segment(&operators, &spec, 80..340).unwrap();
    let solved = solve_packs(&encode_operators(&operators), &encode_take(&take), &spec).unwrap();
    for f in 0..260 {
        for k in [left, right, wide] {
            let (a, b) = (solved.weights[f * n + k], native.table.weights[(80 + f) * n + k]);
            assert!((a - b).abs() <= 0.5001e-4, "{f} {k}: {a} {b}");
        }
    }
}
