//! Weights of other programs in and out, animations of a GLB, and sequences of vertices.

use std::path::{Path, PathBuf};

use mimique_mocap::{
    Format, WeightOptions, WeightsTable, formats, npy_header, read_vertex_array, read_weights_file,
};
use mimique_test_support::real_file;
use serde_json::Value;

use crate::support::{ok, refused, sample, solved_sample, text};

fn table(file: &Path) -> WeightsTable {
    read_weights_file(file, &WeightOptions::default()).expect("weights")
}

/// A seed of the format in the fuzzer's corpus.
fn seeds(format: &Format) -> Vec<PathBuf> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(format.id);
    let files = std::fs::read_dir(corpus).expect("a corpus").map(|file| file.unwrap().path());
    files.filter(|file| text(file).contains("seed-")).collect()
}

/// Arguments of `solve --method recorded`.
fn recorded<'a>(avatar: &'a str, mocap: &'a str, out: &'a str) -> Vec<&'a str> {
    vec![
        "solve",
        "--method",
        "recorded",
        "--avatar",
        avatar,
        "--mocap",
        mocap,
        "--mocap-rate",
        "60",
        "--out",
        out,
    ]
}

#[test]
fn every_format_of_weights_drives_the_built_in_head() {
    let folder = sample();
    let at = |name: &str| text(&folder.path().join(name));
    let (head, out) = (at("head.glb"), at("out.csv"));
    let expected = [
        ("mediapipe-csv", "jawOpen", "MediaPipe hardly ever raises noseSneerLeft"),
        ("mediapipe-json", "jawOpen", "read as MediaPipe JSON"),
        ("openface-csv", "mouthSmileLeft", "read as OpenFace 2 CSV"),
        ("py-feat-csv", "mouthSmileRight", "read as Py-Feat CSV"),
        ("audio2face-json", "mouthSmileLeft", "read as Audio2Face JSON"),
        ("arkit-json", "jawOpen", "read as ARKit JSON"),
        ("npz", "mouthClose", "read as NumPy archive"),
    ];
    for (id, shape, said) in expected {
        let format = Format::by_id(id).expect("a format");
        for seed in seeds(format) {
            let told = ok(&recorded(&head, &text(&seed), &out));
            assert!(told.contains(said) || seeds(format).len() > 1, "{id}: {told}");
            let weights = table(Path::new(&out));
            let k = weights.shape_names.iter().position(|name| name == shape).expect("a shape");
            let moves = (0..weights.frames.len()).any(|row| weights.row(row)[k] != 0.0);
            assert!(moves, "{id}: {shape} rests: {told}");
            let told = ok(&["inspect", "--mocap-rate", "60", &text(&seed)]);
            assert!(told.contains(&format!("format: {}", format.name)), "{id}: {told}");
        }
    }
    // None of the formats of weights is left out here but those that are tested elsewhere.
    let elsewhere = ["npy", "live-link-csv", "weights-csv"];
    for format in formats().iter().filter(|format| format.holds_weights()) {
        let here = expected.iter().any(|(id, _, _)| *id == format.id);
        assert!(here != elsewhere.contains(&format.id), "{format:?}");
    }
}

#[test]
fn names_of_metahuman_and_vrm_drive_arkits_shapes_and_the_rest_is_said() {
    let folder = sample();
    let at = |name: &str| text(&folder.path().join(name));
    let csv = "frame,time,CTRL_expressions_jawOpen,CTRL_expressions_mouthFunnelUL,CTRL_expressions_browLateralL,blink,aa\n\
               0,0,0.5,1,1,0.25,1\n1,0.02,0.5,1,1,0.25,1\n";
    std::fs::write(folder.path().join("in.csv"), csv).unwrap();
    let told = ok(&recorded(&at("head.glb"), &at("in.csv"), &at("out.csv")));
    assert!(
        told.contains("the avatar has no shape CTRL_expressions_browLateralL, aa: left out"),
        "{told}"
    );
    let weights = table(&folder.path().join("out.csv"));
    let weight = |name: &str| {
        let k = weights.shape_names.iter().position(|n| n == name).expect("a shape");
        weights.row(0)[k]
    };
    assert_eq!(weight("jawOpen"), 0.5);
    assert_eq!(weight("mouthFunnel"), 0.25, "a quarter of the lips");
    assert_eq!((weight("eyeBlinkLeft"), weight("eyeBlinkRight")), (0.25, 0.25));
}

/// The header of what is written is that of the application's own files.
#[test]
fn live_link_arkit_json_and_npy_are_written_and_read_back() {
    let folder = sample();
    let at = |name: &str| text(&folder.path().join(name));
    let solve = |out: &str| ok(&recorded(&at("head.glb"), &at("weights.csv"), &at(out)));
    solve("own.csv");
    let own = table(&folder.path().join("own.csv"));
    for (name, precision) in [("a.livelink.csv", 0.6e-10), ("a.json", 0.0), ("a.npy", 0.0)] {
        let told = solve(name);
        let back = table(&folder.path().join(name));
        assert_eq!(back.frames.len(), own.frames.len(), "{name}");
        let rate = back.rate_hz().unwrap() / own.rate_hz().unwrap();
        assert!((rate - 1.0).abs() < 1e-3, "{name}: {rate}");
        for (k, shape) in own.shape_names.iter().enumerate() {
            let column = back.shape_names.iter().position(|n| n.eq_ignore_ascii_case(shape));
            let Some(column) = column else {
                assert!(told.contains(shape.as_str()) && !name.ends_with("npy"), "{name}: {shape}");
                continue;
            };
            for row in 0..own.frames.len() {
                let off = (own.row(row)[k] - back.row(row)[column]).abs();
                assert!(off <= precision, "{name}, {shape}, row {row}: {off}");
            }
        }
    }
    let Some(real) =
        real_file("live_link_arkit_json_and_npy_are_written_and_read_back", "livelink")
    else {
        return;
    };
    let header = |file: &Path| {
        let text = std::fs::read_to_string(file).unwrap();
        text.lines().next().unwrap().to_owned()
    };
    let written = header(&folder.path().join("a.livelink.csv"));
    for name in ["alex_rom_3.csv", "facial.csv"] {
        let theirs = header(&real.join(name));
        assert!(theirs.eq_ignore_ascii_case(&written), "{name}:\n{theirs}\n{written}");
    }
    // A file of the application goes through and comes back as it was, but for the rotations.
    let real = real.join("facial.csv");
    ok(&recorded(&at("head.glb"), &text(&real), &at("b.livelink.csv")));
    let (theirs, ours) = (table(&real), table(&folder.path().join("b.livelink.csv")));
    assert_eq!(theirs.frames.len(), ours.frames.len());
    let tongue = theirs.shape_names.iter().position(|name| name == "TongueOut").unwrap();
    let head = table(&folder.path().join("own.csv")).shape_names;
    for (k, name) in theirs.shape_names.iter().take(52).enumerate() {
        if k == tongue && !head.iter().any(|own| own.eq_ignore_ascii_case("tongueOut")) {
            continue;
        }
        assert_eq!(*name, ours.shape_names[k]);
        for row in 0..theirs.frames.len() {
            assert!((theirs.row(row)[k] - ours.row(row)[k]).abs() < 1e-9, "{name}, {row}");
        }
    }
}

/// Leaves every fortieth frame of an array of vertices.
fn every_fortieth_frame(file: &Path) {
    let array = read_vertex_array(file).expect("vertices");
    let frames: Vec<&[f32]> = array.positions.chunks(3 * array.vertices).step_by(40).collect();
    let mut bytes = npy_header("<f4", &[frames.len(), array.vertices, 3]);
    bytes.extend(frames.concat().iter().flat_map(|x| x.to_le_bytes()));
    std::fs::write(file, bytes).expect("an array");
}

/// A take's moved skin, compressed: what is played of it is the take, by GLB and by weights.
#[test]
fn vertices_become_an_avatar_that_plays_them() {
    let folder = sample();
    let at = |name: &str| text(&folder.path().join(name));
    solved_sample(folder.path());
    every_fortieth_frame(&folder.path().join("v.npy"));
    let vertices = ["vertices", &at("v.npy"), "--template", &at("head.glb"), "--rate", "60"];
    let files = ["--out", &at("bank.glb"), "--weights", &at("bank.csv")];
    let told = ok(&[&vertices[..], &files, &["--json"]].concat());
    let told: Value = serde_json::from_str(&told).expect("JSON");
    let number = |key: &str| told[key].as_f64().expect("a number");
    assert!(number("largest_error_mm") <= 0.1 && told["within_tolerance"] == true, "{told}");
    assert!((1.0..52.0).contains(&number("shapes")), "{told}");
    // By the weights, and by the animation of the GLB itself.
    ok(&recorded(&at("bank.glb"), &at("bank.csv"), &at("a.csv")));
    let said = ok(&recorded(&at("bank.glb"), &at("bank.glb"), &at("b.csv")));
    assert!(said.contains("read as animation of a glTF file"), "{said}");
    let (a, b) = (table(&folder.path().join("a.csv")), table(&folder.path().join("b.csv")));
    assert_eq!((a.frames.len(), a.shape_names.len()), (b.frames.len(), b.shape_names.len()));
    for (x, y) in a.weights.iter().zip(&b.weights) {
        assert!((x - y).abs() < 1e-4, "{x} {y}");
    }
    let facts = ok(&["inspect", &at("bank.glb")]);
    assert!(facts.contains("animation:") && facts.contains("component1"), "{facts}");
    let still = refused(&recorded(&at("head.glb"), &at("head.glb"), &at("c.csv")));
    assert!(still.contains("animations: none moves morph targets"), "{still}");
    // Few shapes: the error is said, and that it is larger than was asked for.
    let few = ok(&[&vertices[..], &files, &["--shapes", "2"]].concat());
    assert!(few.contains("warning: 2 shapes do not reach 0.1 mm"), "{few}");
    let other = ["vertices", &at("v.npy"), "--template", &at("take.c3d"), "--rate", "60"];
    refused(&[&other[..], &files].concat());
}

/// Vertices of one face drive another through vertices that correspond.
#[test]
fn vertices_are_solved_onto_another_bank_through_corresponding_vertices() {
    let (one, two) = (sample(), tempfile::tempdir().unwrap());
    let at = |name: &str| text(&one.path().join(name));
    ok(&["sample", "--avatar", "2", "--out", &text(two.path())]);
    solved_sample(one.path());
    // Both heads have one topology, which a pair of scans or FLAME and a bank would need a fit for: the
    // markers' vertices, and those around them.
    let map: Value =
        serde_json::from_str(&std::fs::read_to_string(one.path().join("markers.json")).unwrap())
            .unwrap();
    let mut markers = serde_json::Map::new();
    for marker in map["markers"].as_object().unwrap().values() {
        let vertex = marker["vertex"].as_u64().unwrap();
        markers.insert(format!("v{vertex}"), serde_json::json!({ "vertex": vertex }));
    }
    let face = markers.len();
    assert!(face > 20, "{face}");
    let correspondence = serde_json::json!({ "markers": markers, "neutral": map["neutral"] });
    std::fs::write(one.path().join("pairs.json"), correspondence.to_string()).unwrap();
    let head = text(&two.path().join("head.glb"));
    ok(&[
        "solve",
        "--avatar",
        &head,
        "--mocap",
        &at("v.npy"),
        "--mocap-rate",
        "100",
        "--mocap-unit",
        "m",
        "--markers",
        &at("pairs.json"),
        "--method",
        "box",
        "--out",
        &at("onto.csv"),
    ]);
    let (from, onto) = (table(&one.path().join("w.csv")), table(&one.path().join("onto.csv")));
    assert_eq!((from.frames.len(), &from.shape_names), (onto.frames.len(), &onto.shape_names));
    for shape in ["jawOpen", "browInnerUp"] {
        let k = from.shape_names.iter().position(|name| name == shape).unwrap();
        let column = |table: &WeightsTable| -> Vec<f64> {
            (0..table.frames.len()).map(|row| table.row(row)[k]).collect()
        };
        let (a, b) = (column(&from), column(&onto));
        let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
        let (ma, mb) = (mean(&a), mean(&b));
        let products = |x: &[f64], mx: f64, y: &[f64], my: f64| -> f64 {
            x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum()
        };
        let r =
            products(&a, ma, &b, mb) / (products(&a, ma, &a, ma) * products(&b, mb, &b, mb)).sqrt();
        assert!(r > 0.95, "{shape}: correlation {r}");
    }
}
