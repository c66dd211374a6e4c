//! The module that browsers load gives the bits that the native program gives.
//!
//! Needs node and the module built by `cargo xtask web` (in `target/web-dist`, or where
//! `MIMIQUE_WEB_DIST` says).

use std::path::Path;
use std::process::Command;

use mimique_avatar::{Avatar, Mesh, Part, SparseShape};
use mimique_clip::{encode_operators, encode_take, solve_packs};
use mimique_geometry::Point;
use mimique_mocap::{Capture, LengthUnit, WeightsTable};
use mimique_solver::{MarkerSite, Method, MethodSpec};
use mimique_stimulus::{
    AvatarSkin, JoinedTake, MappedMarker, MarkerMap, MarkerPlace, TakeOptions, Training,
};
use mimique_test_support::{repository, web_module};
use serde_json::json;

/// A bulging sheet of skin whose eight shapes are bumps here and there; the last would turn the eyes.
fn avatar() -> Avatar {
    let (w, h, n) = (21u32, 25u32, 8usize);
    let at = |v: u32| (f64::from(v % w) / 20.0 - 0.5, f64::from(v / w) / 24.0 - 0.5);
    let positions = (0..w * h)
        .map(|v| {
            let (x, y) = at(v);
            [0.15 * x, 0.2 * y, 0.09 - 0.15 * (x * x + 0.6 * y * y)].map(|c| c as f32)
        })
        .collect();
    let triangles = (0..w * (h - 1))
        .filter(|v| v % w + 1 < w)
        .flat_map(|v| [[v, v + 1, v + w + 1], [v, v + w + 1, v + w]])
        .collect();
    let shapes = (0..n)
        .map(|k| {
            let centre = (0.3 * (k as f64 * 1.9).sin(), 0.35 * (k as f64 * 2.3).cos());
            let dense: Vec<[f32; 3]> = (0..w * h)
                .map(|v| {
                    let (x, y) = at(v);
                    let far = (x - centre.0).powi(2) + (y - centre.1).powi(2);
                    let d = if far > 0.08 { 0.0 } else { 0.012 * (-far / 0.02).exp() };
                    [0.4 * d, d * (k as f64).cos(), d * (k as f64 * 0.7).sin()].map(|c| c as f32)
                })
                .collect();
            SparseShape::from_dense(&dense)
        })
        .collect();
    Avatar {
        name: "sheet".into(),
        shape_names: (0..n)
            .map(|k| if k + 1 < n { format!("bump{k}") } else { "eyeLookUpLeft".to_owned() })
            .collect(),
        meshes: vec![Mesh { part: Part::Skin, positions, triangles, shapes, ..Mesh::default() }],
        ..Avatar::default()
    }
}

/// Weight of a shape in a frame.
fn weight(frame: usize, k: usize) -> f64 {
    if frame < 60 { 0.0 } else { (0.9 * (frame as f64 / 100.0 + k as f64).sin()).abs() }
}

/// 24 face markers and 4 head markers on a wider sheet that turns, moves and is now and then hidden.
fn capture(skin: &AvatarSkin, map: &MarkerMap) -> Capture {
    let mut labels: Vec<String> = map.face_labels().map(str::to_owned).collect();
    labels.extend(map.head.iter().cloned());
    let vertices: Vec<usize> = map.resolve(skin).unwrap().iter().map(MarkerSite::vertex).collect();
    let skull = [[0.1, 0.12, -0.05], [-0.1, 0.12, -0.05], [0.0, 0.16, 0.02], [0.0, 0.1, -0.12]];
    let mut positions = Vec::new();
    let mut noise = 12345u64;
    for frame in 0..300 {
        let t = frame as f64 / 100.0;
        let turn = 0.1 * (1.3 * t).sin();
        let weight = |k: usize| weight(frame, k);
        let face = vertices.iter().map(|&v| {
            let mut p = skin.mesh.positions[v];
            for (k, shape) in skin.mesh.shapes.iter().enumerate() {
                if let Ok(i) = shape.vertices.binary_search(&(v as u32)) {
                    (0..3).for_each(|a| p[a] += weight(k) * shape.deltas[i][a]);
                }
            }
            p
        });
        for (m, p) in face.chain(skull.map(Point::from)).enumerate() {
            let mut jitter = || {
                noise = noise.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                ((noise >> 40) as f64 / 16_777_216.0 - 0.5) * 0.3
            };
            let [x, y, z] = p.map(|c| c * 1080.0).to_array();
            let moved = [
                turn.cos() * x + turn.sin() * z + 10.0 * t + jitter(),
                y + 1200.0 + jitter(),
                turn.cos() * z - turn.sin() * x + jitter(),
            ];
            let hidden = m == 5 && (120..140).contains(&frame);
            positions.push(if hidden { Point::UNSEEN } else { moved.into() });
        }
    }
    let (unit, notes) = (LengthUnit::Millimetre, vec![]);
    Capture { labels, rate_hz: 100.0, first_frame: 0, unit, positions, notes }
}

/// Packs of one segment by every method, and the natively solved hashes.
fn write_cases(folder: &Path) {
    let skin = AvatarSkin::of(&avatar()).unwrap();
    let face = (0..24u32).map(|m| MappedMarker {
        label: format!("M{m:02}"),
        place: MarkerPlace::Vertex(22 + 21 * (m / 4 * 4) + 5 * (m % 4)),
    });
    let map = MarkerMap {
        face: face.collect(),
        head: ["H0", "H1", "H2", "H3"].map(str::to_owned).to_vec(),
        neutral: Some(0..60),
        ..MarkerMap::default()
    };
    let capture = capture(&skin, &map);
    let joined = JoinedTake::new(&skin, &capture, &map, &TakeOptions::default()).unwrap();
    // What the regression learns is what moved the sheet.
    let frames = capture.frames();
    let course = weight;
    let n = skin.shape_names.len();
    let weights = (0..frames * n).map(|at| course(at / n, at % n)).collect();
    let training = Training {
        weights: WeightsTable::at_rate(skin.shape_names.clone(), weights, 0, capture.rate_hz),
        capture: capture.clone(),
        neutral: Some(0..60),
        head: None,
    };
    let mut cases = Vec::new();
    for method in Method::ALL {
        let mut spec = MethodSpec::new(method);
        spec.head_lowpass_hz = Some(10.0);
        if method == Method::Recorded || spec.validate().is_err() {
            continue;
        }
        let learns = method == Method::Regression;
        let operators = joined.set_up(&spec, learns.then_some(&training)).unwrap().operators;
        let take = encode_take(&joined.segment(&operators, &spec, 80..290).unwrap());
        let operators = encode_operators(&operators);
        let solved = solve_packs(&operators, &take, &spec).unwrap();
        assert_eq!(solved.frames(), 210);
        // The forms of the papers as printed hardly listen to the markers; the others must.
        let literal = matches!(method, Method::ThesisLiteral | Method::ShortLiteral);
        let least = if literal { 1e-9 } else { 0.2 };
        assert!(solved.weights.iter().any(|w| *w > least), "{method}: nothing moves");
        let files = [format!("{method}.mmop"), format!("{method}.mmtk")];
        std::fs::write(folder.join(&files[0]), operators).unwrap();
        std::fs::write(folder.join(&files[1]), take).unwrap();
        cases.push(json!({
            "name": method,
            "operators": files[0],
            "take": files[1],
            "method": spec,
            "weightsHash": solved.weights_hash,
            "frames": solved.frames(),
        }));
    }
    assert!(cases.len() >= 14, "{} methods", cases.len());
    let text = serde_json::to_string(&cases).unwrap();
    std::fs::write(folder.join("cases.json"), text).unwrap();
}

#[test]
fn the_browser_s_module_gives_the_native_bits() {
    let folder = tempfile::tempdir().unwrap();
    write_cases(folder.path());
    let test = "the_browser_s_module_gives_the_native_bits";
    let Some(dist) = web_module(test, "solver") else { return };
    let output = Command::new("node")
        .arg(repository().join("tests/wasm/solver_bits.mjs"))
        .args([&dist, folder.path()])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    eprintln!("{said}");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "run cargo xtask web if it is old\n{said}{errors}");
}
