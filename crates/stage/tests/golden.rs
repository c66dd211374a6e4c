//! The picture stays what it was. Tolerance: mean difference of a colour byte at most 0.75 of 255,
//! at most 0.5 % of the pixels off by more than 12 (edges, between rasterisers).
//!
//! `MIMIQUE_UPDATE_GOLDEN=1` writes the golden pictures anew; look at them before committing.

#[path = "support/sheet.rs"]
mod sheet;
mod support;

use std::path::{Path, PathBuf};

use mimique_face::Avatar;
use mimique_stage::offscreen::{Offscreen, Picture};
use mimique_stage::{Look, View};

const MOST_MEAN: f64 = 0.75;
const MOST_OUTLIERS: f64 = 0.005;
const MOST_BYTES: usize = 60_000;
/// The contact sheet has 42 heads.
const MOST_SHEET_BYTES: usize = 900_000;

#[test]
fn golden_egg_neutral() {
    check("egg-neutral", Look::STIMULUS, View::FRONT, [0.0, 0.0, 0.0]);
}

#[test]
fn golden_egg_posed_three_quarter() {
    check("egg-posed", Look::STIMULUS, View::THREE_QUARTER, [1.0, 0.8, 1.0]);
}

#[test]
fn golden_egg_reference_look() {
    check("egg-reference", Look::REFERENCE, View::FRONT, [0.5, 0.0, -1.0]);
}

#[test]
fn golden_egg_with_a_picture() {
    let egg = support::pictured_egg();
    check_avatar("egg-picture", &egg, Look::STIMULUS, View::FRONT, [0.3, 0.2, 0.0]);
    // What the browser draws came through the pack: tests/browser/pictures.test.mjs has it draw this
    // file and compares with the same golden picture.
    let file =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join("egg-picture.mmav");
    if update() {
        let packed = mimique_face::pack::encode_pack(&egg).bytes;
        std::fs::write(&file, packed).expect("the pack is written");
    }
    let packed = std::fs::read(&file).expect("the pack is there");
    let unpacked = mimique_face::pack::decode_pack(&packed).expect("the pack opens");
    check_avatar("egg-picture", &unpacked, Look::STIMULUS, View::FRONT, [0.3, 0.2, 0.0]);
}

fn update() -> bool {
    std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some_and(|v| v == "1")
}

/// The contact sheet of the README: every emotion of the built-in head.
#[test]
fn golden_emotions() {
    let Some(stage) = support::adapter("golden_emotions") else { return };
    let picture = sheet::emotions(&stage, 104).expect("the sheet is drawn");
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/emotions.png");
    compare("emotions", &picture, &path, MOST_SHEET_BYTES, &stage);
}

fn check(name: &str, look: Look, view: View, weights: [f32; 3]) {
    check_avatar(name, &support::egg(), look, view, weights);
}

fn check_avatar(name: &str, egg: &Avatar, look: Look, view: View, weights: [f32; 3]) {
    let Some(stage) = support::adapter(name) else { return };
    let picture = stage.render(egg, look, view, &weights, [192, 240]).expect("the egg is drawn");
    let path =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{name}.png"));
    compare(name, &picture, &path, MOST_BYTES, &stage);
}

fn compare(name: &str, picture: &Picture, path: &Path, most_bytes: usize, stage: &Offscreen) {
    if update() {
        let png = picture.png();
        assert!(png.len() <= most_bytes, "{name}: {} bytes, at most {most_bytes}", png.len());
        std::fs::write(path, png).expect("golden picture is written");
        return;
    }
    let golden = read(path);
    let found = support::difference(picture, &golden);
    if found.mean > MOST_MEAN || found.outliers > MOST_OUTLIERS {
        let actual = std::env::temp_dir().join(format!("{name}-actual.png"));
        std::fs::write(&actual, picture.png()).expect("actual picture is written");
        panic!("{name}: {found:?} on {}; see {}", stage.adapter(), actual.display());
    }
}

fn read(path: &Path) -> Picture {
    let file = std::fs::File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG file");
    let mut rgba = vec![0; reader.output_buffer_size().expect("a small picture")];
    let info = reader.next_frame(&mut rgba).expect("a whole picture");
    Picture { width: info.width, height: info.height, rgba }
}
