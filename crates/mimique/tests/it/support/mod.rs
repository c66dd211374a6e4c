//! The binary, run to its end.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

/// What a run gives.
pub fn mimique<S: AsRef<std::ffi::OsStr>>(args: &[S]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mimique"));
    command.args(args).env_remove("MIMIQUE_DATA").output().expect("the binary starts")
}

/// Standard output of a command that must succeed.
pub fn ok<S: AsRef<std::ffi::OsStr>>(args: &[S]) -> String {
    let out = mimique(args);
    let err = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{err}");
    String::from_utf8(out.stdout).expect("UTF-8")
}

/// Standard error of a command that must refuse with exit code 2.
pub fn refused<S: AsRef<std::ffi::OsStr>>(args: &[S]) -> String {
    let out = mimique(args);
    let err = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(2), "{err}");
    assert!(err.contains("error: "), "{err}");
    assert!(!err.contains("panicked"), "{err}");
    err
}

/// A path as an argument.
pub fn text(path: &Path) -> String {
    path.to_str().expect("a path in UTF-8").to_owned()
}

/// A folder with the sample's files.
pub fn sample() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    ok(&["sample", "--out", &text(folder.path())]);
    folder
}

/// Arguments of `mimique exertion` from words and paths.
pub fn exertion_args(words: &[&str], paths: &[(&str, &Path)]) -> Vec<String> {
    let mut all: Vec<String> =
        std::iter::once("exertion").chain(words.iter().copied()).map(str::to_owned).collect();
    for (option, path) in paths {
        if !option.is_empty() {
            all.push((*option).to_owned());
        }
        all.push(text(path));
    }
    all
}

/// A folder with everything in it, elsewhere.
pub fn copied(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let there = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copied(&entry.path(), &there);
        } else {
            std::fs::copy(entry.path(), there).unwrap();
        }
    }
}

/// Every file below a folder: path with `/`, and bytes.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inside) = folders.pop() {
        for entry in std::fs::read_dir(inside).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_str().unwrap().replace('\\', "/");
                found.insert(name, std::fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// The sample's take solved onto its head by the method `box`: weights in `w.csv`, vertices in `v.npy`.
pub fn solved_sample(folder: &Path) {
    let at = |name: &str| text(&folder.join(name));
    ok(&[
        "solve",
        "--avatar",
        &at("head.glb"),
        "--mocap",
        &at("take.c3d"),
        "--markers",
        &at("markers.json"),
        "--method",
        "box",
        "--out",
        &at("w.csv"),
        "--vertices",
        &at("v.npy"),
    ]);
}
