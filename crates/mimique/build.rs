//! Writes the table of `include_bytes!` that `src/main.rs` includes: every file of `target/web-dist` (or of the folder in
//! `MIMIQUE_WEB_DIST`) with the compressed forms that `cargo xtask web` put into the folder `web-packed` next to it.
//!
//! If the folder is absent or empty, the table is empty, and `mimique serve` reports how to build the pages.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use sha2::{Digest, Sha256};

fn main() -> io::Result<()> {
    for variable in ["MIMIQUE_WEB_DIST", "CARGO_TARGET_DIR"] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
    println!("cargo::rerun-if-changed=build.rs");
    let dist = dist();
    let packed = dist.with_file_name("web-packed");
    for folder in [&dist, &packed] {
        // Cargo treats a watched path that does not exist as changed and would rebuild every time.
        fs::create_dir_all(folder)?;
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    let mut files = Vec::new();
    collect(&dist, "", &mut files)?;
    files.sort();
    let mut table = String::from("&[\n");
    for (name, path) in files {
        // A file that is being replaced comes with the next build, which its change starts.
        let bytes = match fs::read(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            read => read?,
        };
        let hash = hex::encode(Sha256::digest(&bytes));
        let brotli = form(packed.join(format!("{hash}.br")));
        let gzip = form(packed.join(format!("{hash}.gz")));
        // A file with a gzip form is unpacked when the program starts, and not embedded twice.
        let raw = if gzip.is_some() { None } else { Some(path) };
        let _ = writeln!(
            table,
            "    EmbeddedFile {{ name: {name:?}, raw: {}, brotli: {}, gzip: {} }},",
            included(raw),
            included(brotli),
            included(gzip)
        );
    }
    table.push_str("]\n");
    fs::write(variable("OUT_DIR").join("embedded_files.rs"), table)
}

/// A compressed form, if there is one: `cargo xtask web` leaves the file empty if compression does not pay.
fn form(path: PathBuf) -> Option<PathBuf> {
    fs::metadata(&path).is_ok_and(|found| found.len() > 0).then_some(path)
}

/// The Rust expression of a file's content.
fn included(path: Option<PathBuf>) -> String {
    path.map_or_else(|| "None".into(), |path| format!("Some(include_bytes!({path:?}))"))
}

/// The folder of the finished pages, as `cargo xtask web` chooses it.
fn dist() -> PathBuf {
    if let Some(dist) = std::env::var_os("MIMIQUE_WEB_DIST") {
        return dist.into();
    }
    let root = variable("CARGO_MANIFEST_DIR").join("../..");
    let target = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    root.join(target).join("web-dist")
}

fn variable(name: &str) -> PathBuf {
    std::env::var_os(name).map(PathBuf::from).unwrap_or_else(|| panic!("cargo sets {name}"))
}

/// Adds every file of a folder and its subfolders as (`sub/folder/name`, path).
fn collect(folder: &Path, prefix: &str, files: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            collect(&entry.path(), &format!("{name}/"), files)?;
        } else {
            files.push((name, entry.path()));
        }
    }
    Ok(())
}
