//! Shaders without comments and indentation: they are downloaded with the canvas.

use std::fs;
use std::path::{Path, PathBuf};

const FOLDER: &str = "src/shaders";

fn main() {
    println!("cargo::rerun-if-changed={FOLDER}");
    println!("cargo::rerun-if-changed=build.rs");
    let into = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    for entry in fs::read_dir(FOLDER).expect("the shaders' folder") {
        let path = entry.expect("a shader").path();
        write_bare(&path, &into);
    }
}

/// Writes one shader into `into`. WGSL has no text in which `//` could be anything but a comment.
fn write_bare(path: &Path, into: &Path) {
    let text = fs::read_to_string(path).expect("a shader is text");
    assert!(!text.contains("/*"), "{}: write comments as `//`", path.display());
    let bare: Vec<&str> = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default().trim())
        .filter(|line| !line.is_empty())
        .collect();
    let name = path.file_name().expect("a file");
    fs::write(into.join(name), bare.join("\n") + "\n").expect("OUT_DIR can be written");
}
