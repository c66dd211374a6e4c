//! What Mimique's tests and benchmarks share: real data, Python and R outside the repository, random
//! numbers, a clock.
//!
//! Each finder gives its find, or says that the test is skipped and gives `None`. With
//! `MIMIQUE_NO_SKIP=1` a test that would skip fails instead.

mod clock;
mod random;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

pub use clock::Clock;
pub use random::Random;

/// The folder of the real data: `MIMIQUE_DATA`, else `../shared/data` beside the repository.
///
/// # Panics
/// Under `MIMIQUE_NO_SKIP=1` when it is absent.
pub fn real_data(test: &str) -> Option<PathBuf> {
    real_file(test, "")
}

/// A file or folder of the real data, by its path inside.
///
/// # Panics
/// Under `MIMIQUE_NO_SKIP=1` when it is absent.
pub fn real_file(test: &str, inside: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("MIMIQUE_DATA")
        .map_or_else(|| repository().join("../shared/data"), PathBuf::from);
    let path = if inside.is_empty() { folder } else { folder.join(inside) };
    if path.exists() {
        return Some(path);
    }
    skip(test, &format!("real data not found at {}; set MIMIQUE_DATA", path.display()));
    None
}

/// A Python that has the packages of `tests/support/requirements.txt`: `MIMIQUE_PYTHON`, else the
/// environment that `cargo xtask test` makes in `target/python`.
///
/// # Panics
/// Under `MIMIQUE_NO_SKIP=1` when there is none.
pub fn python(test: &str) -> Option<PathBuf> {
    let path = std::env::var_os("MIMIQUE_PYTHON")
        .map_or_else(|| repository().join("target/python/bin/python"), PathBuf::from);
    if runs(&path, &["-c", "import numpy, scipy, ezc3d"]) {
        return Some(path);
    }
    skip(
        test,
        &format!(
            "no Python with numpy, scipy and ezc3d at {}; run cargo xtask test, or set MIMIQUE_PYTHON",
            path.display()
        ),
    );
    None
}

/// R's script runner.
///
/// # Panics
/// Under `MIMIQUE_NO_SKIP=1` when there is none.
pub fn rscript(test: &str) -> Option<PathBuf> {
    let path = PathBuf::from("Rscript");
    if runs(&path, &["--version"]) {
        return Some(path);
    }
    skip(test, "Rscript not found; install the package r-base-core");
    None
}

/// The folder of a module of the pages, for node: what `cargo xtask web` has built, or
/// `MIMIQUE_WEB_DIST`.
///
/// # Panics
/// Under `MIMIQUE_NO_SKIP=1` when node or the module is absent.
pub fn web_module(test: &str, name: &str) -> Option<PathBuf> {
    let target = std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| repository().join("target"), PathBuf::from);
    let dist =
        std::env::var_os("MIMIQUE_WEB_DIST").map_or_else(|| target.join("web-dist"), PathBuf::from);
    let file = format!("{name}_bg.wasm");
    if !runs(Path::new("node"), &["--version"]) {
        skip(test, "node is not installed");
    } else if !dist.join(&file).is_file() {
        skip(test, &format!("no {file} in {}; run cargo xtask web", dist.display()));
    } else {
        return Some(dist);
    }
    None
}

/// Says that a test is skipped and why.
///
/// # Panics
/// Under `MIMIQUE_NO_SKIP=1`.
pub fn skip(test: &str, why: &str) {
    let text = format!("SKIPPED {test}: {why}");
    assert!(std::env::var_os("MIMIQUE_NO_SKIP").is_none_or(|v| v != "1"), "{text}");
    eprintln!("{text}");
}

/// The repository's root.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Where the studies of the repository are.
pub fn study_folder() -> PathBuf {
    repository().join("study-config")
}

/// The text of a study of the repository, by its path inside `study-config`.
///
/// # Panics
/// When there is no such file.
pub fn study_text(name: &str) -> String {
    let path = study_folder().join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn runs(program: &Path, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|s| s.success())
}
