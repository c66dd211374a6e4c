//! Marker layouts as a researcher makes, checks and solves with them.

use std::path::Path;

use mimique_avatar_files::read_avatar;
use mimique_geometry::Point;
use mimique_mocap::{WeightOptions, read_weights_file};
use mimique_stimulus::AvatarSkin;
use serde_json::Value;

use crate::support::{ok, refused, text};

/// The files of `mimique sample`.
fn sample(folder: &Path) {
    ok(&["sample", "--out", &text(folder)]);
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

fn place(value: &Value) -> Point {
    let axis = |axis: usize| value["position"][axis].as_f64().expect("a number");
    Point::new(axis(0), axis(1), axis(2))
}

/// Labels and places of a layout: the face's, then the head's.
fn places(map: &Value) -> Vec<(String, Point)> {
    let of = |value: &Value| -> Vec<(String, Point)> {
        let members = value.as_object().expect("members");
        members.iter().map(|(label, value)| (label.clone(), place(value))).collect()
    };
    [of(&map["markers"]), of(&map["layout"]["head"])].concat()
}

/// Rows of weights in the order of the avatar's shapes: a second of rest, then every 20th frame of a file.
fn performed(skin: &AvatarSkin, file: &Path) -> Vec<Vec<f64>> {
    let options = WeightOptions { rate_hz: None, shape_names: &skin.shape_names, animation: None };
    let table = read_weights_file(file, &options).expect("weights");
    let of = |row: &[f64], name: &String| {
        let column = table.shape_names.iter().position(|own| own == name);
        column.map_or(0.0, |column| row[column])
    };
    let rest = std::iter::repeat_n(vec![0.0; skin.shape_names.len()], 20);
    let rows = table.weights.chunks_exact(table.shape_names.len()).step_by(20);
    let frames = rows.map(|row| skin.shape_names.iter().map(|name| of(row, name)).collect());
    rest.chain(frames).collect()
}

/// Every vertex at some weights.
fn moved(skin: &AvatarSkin, weights: &[f64]) -> Vec<Point> {
    let mut positions = skin.mesh.positions.clone();
    for (shape, &weight) in skin.mesh.shapes.iter().zip(weights) {
        for (&v, &delta) in shape.vertices.iter().zip(&shape.deltas) {
            positions[v as usize] += delta * weight;
        }
    }
    positions
}

fn nearest(skin: &AvatarSkin, at: Point) -> usize {
    let away = |v: &usize| (skin.mesh.positions[*v] - at).length();
    (0..skin.mesh.positions.len()).min_by(|a, b| away(a).total_cmp(&away(b))).expect("a vertex")
}

#[test]
fn solve_reads_a_layout_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    sample(folder.path());
    let (avatar, rom) = (text(&at("head.glb")), text(&at("weights.csv")));
    let out = text(&at("layout.json"));
    let common = ["layout", "--avatar", &avatar, "--rom", &rom, "--method", "greedy"];
    let rest =
        ["--markers", "40", "--out", &out, "--sheet", &text(&at("sheet.svg"))].map(str::to_owned);
    let args: Vec<String> = common.into_iter().map(str::to_owned).chain(rest).collect();
    let said = ok(&args);
    assert!(said.contains("40 face markers and 6 head markers by greedy"), "{said}");
    assert!(std::fs::read_to_string(at("sheet.svg")).expect("a sheet").contains("<svg"));
    let map = json(&at("layout.json"));
    let places = places(&map);
    assert_eq!(places.len(), 46);

    // The layout is worn by the avatar itself; what is solved must be what was played.
    let read = read_avatar(&at("head.glb")).expect("the avatar").avatar;
    let skin = AvatarSkin::of(&read).expect("a skin");
    let truth = performed(&skin, &at("weights.csv"));
    let vertices: Vec<usize> = places.iter().map(|(_, p)| nearest(&skin, *p)).collect();
    let mut csv = String::from("frame,time");
    for (label, _) in &places {
        csv += &format!(",{label}_x,{label}_y,{label}_z");
    }
    for (frame, weights) in truth.iter().enumerate() {
        let skin = moved(&skin, weights);
        csv += &format!("\n{frame},{}", frame as f64 / 20.0);
        for &v in &vertices {
            csv += &format!(",{},{},{}", 1e3 * skin[v].x, 1e3 * skin[v].y, 1e3 * skin[v].z);
        }
    }
    std::fs::write(at("take.csv"), csv + "\n").expect("a take");
    let [take, solved] = ["take.csv", "solved.csv"].map(|name| text(&at(name)));
    ok(&[
        "solve",
        "--avatar",
        &avatar,
        "--mocap",
        &take,
        "--markers",
        &out,
        "--method",
        "lsts",
        "--neutral",
        "0:20",
        "--head-lowpass",
        "none",
        "--out",
        &solved,
    ]);
    let options =
        WeightOptions { rate_hz: Some(20.0), shape_names: &skin.shape_names, animation: None };
    let table = read_weights_file(&at("solved.csv"), &options).expect("weights");
    let (mut square, mut motion) = (0.0, 0.0);
    let rows = table.weights.chunks_exact(table.shape_names.len());
    assert_eq!(rows.len(), truth.len());
    for (row, truth) in rows.zip(&truth) {
        let own: Vec<f64> = skin
            .shape_names
            .iter()
            .map(|name| {
                let column = table.shape_names.iter().position(|own| own == name);
                column.map_or(0.0, |column| row[column])
            })
            .collect();
        let pairs = moved(&skin, &own).into_iter().zip(moved(&skin, truth));
        for ((got, wanted), rest) in pairs.zip(&skin.mesh.positions) {
            square += (got - wanted).length_squared();
            motion += (wanted - *rest).length_squared();
        }
    }
    let left = (square / motion).sqrt();
    assert!(left < 0.25, "{left} of the motion is left");
}

#[test]
fn a_check_says_what_a_map_cannot_see() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| text(&folder.path().join(name));
    sample(folder.path());
    let (avatar, whole) = (at("head.glb"), at("markers.json"));
    let mut map = json(Path::new(&whole));
    let upper = ["brow", "forehead", "lid", "glabella"];
    let markers = map["markers"].as_object_mut().expect("markers");
    markers.retain(|label, _| !upper.iter().any(|part| label.starts_with(part)));
    std::fs::write(at("lower.json"), map.to_string()).expect("a map");
    let check = |map: &str| -> Value {
        let said = ok(&["layout", "check", map, "--avatar", &avatar, "--json"]);
        serde_json::from_str(&said).expect("JSON")
    };
    let (whole, lower) = (check(&whole), check(&at("lower.json")));
    let unknown = |value: &Value| value["unknownMm"].as_f64().expect("millimetres");
    assert!(unknown(&lower) > 1.2 * unknown(&whole), "{} {}", unknown(&lower), unknown(&whole));
    let hardly = lower["hardlyTold"].to_string();
    assert!(hardly.contains("browInnerUp") || lower["bank"].to_string().contains("browInnerUp"));
}

#[test]
fn layout_refuses_and_writes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| text(&folder.path().join(name));
    sample(folder.path());
    let (avatar, out) = (at("head.glb"), at("layout.json"));
    std::fs::write(at("region.json"), r#"{"vertices": [99999999]}"#).expect("a region");
    std::fs::write(at("notes.txt"), "mine").expect("a file");
    let folder_of_others = text(folder.path());
    let region = at("region.json");
    let sheet = at("sheet.doc");
    for (more, named) in [
        (vec!["--markers", "400"], "of 400 fit at 8 mm"),
        (vec!["--markers", "40", "--head", "2"], "head"),
        (vec!["--markers", "40", "--region", &region], "99999999"),
        (vec!["--markers", "40", "--rom", "nope.csv"], "nope.csv"),
        (vec!["--markers", "40", "--solve", "magic"], "magic"),
        (vec!["--markers", "40", "--sheet", &sheet], "sheet.doc"),
        (vec!["--markers", "40", "--report", &folder_of_others], "something else"),
        (vec!["--markers", "60..10"], "60..10"),
        (vec!["--markers", "40", "--exclude", "nose"], "nose"),
    ] {
        let fixed = ["layout", "--avatar", &avatar, "--method", "greedy", "--out", &out];
        let err = refused(&[&fixed[..], &more[..]].concat());
        assert!(err.contains(named), "{named}: {err}");
        assert!(!Path::new(&out).exists(), "nothing is written: {err}");
    }
}
