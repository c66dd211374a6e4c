//! Embeds the pages: every file of `target/web-dist` (or of `MIMIQUE_WEB_DIST`) with its brotli and
//! gzip forms, as a table of `include_bytes!` that `src/files/assets.rs` reads.
//!
//! Without the folder the table is empty, and `mimique serve` says how to build the pages.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

#[path = "src/files/compression.rs"]
#[allow(dead_code)]
mod compression;
#[path = "src/files/folder.rs"]
mod folder;
#[path = "src/files/tight_brotli.rs"]
mod tight_brotli;
#[path = "src/files/tight_gzip.rs"]
mod tight_gzip;

fn main() -> io::Result<()> {
    for variable in ["MIMIQUE_WEB_DIST", "CARGO_TARGET_DIR"] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
    for source in [
        "build.rs",
        "src/files/compression.rs",
        "src/files/folder.rs",
        "src/files/tight_brotli.rs",
        "src/files/tight_gzip.rs",
    ] {
        println!("cargo::rerun-if-changed={source}");
    }
    let dist = dist();
    // Cargo takes a watched path that is absent for a changed one and would build anew each time.
    fs::create_dir_all(&dist)?;
    println!("cargo::rerun-if-changed={}", dist.display());

    let out = variable("OUT_DIR");
    let mut table = String::from("&[\n");
    for (name, path) in folder::files(&dist)? {
        // A page that is being replaced comes with the next build, which its change starts.
        let bytes = match fs::read(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            read => read?,
        };
        let brotli = packed(&out, &bytes, "br11", brotli)?;
        let gzip = packed(&out, &bytes, "gz", gzip)?;
        let _ = writeln!(
            table,
            "    EmbeddedFile {{ name: {name:?}, raw: include_bytes!({path:?}), \
             brotli: {brotli}, gzip: {gzip} }},"
        );
    }
    table.push_str("]\n");
    fs::write(out.join("embedded_files.rs"), table)
}

/// The brotli form, or `None` where it saves less than a twentieth.
fn brotli(bytes: &[u8]) -> io::Result<Option<Vec<u8>>> {
    Ok(compression::worth_it(bytes, tight_brotli::brotli(bytes)?))
}

/// The gzip form, or `None` where it saves less than a twentieth.
fn gzip(bytes: &[u8]) -> io::Result<Option<Vec<u8>>> {
    Ok(compression::worth_it(bytes, tight_gzip::gzip(bytes)?))
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

/// Compresses into a file named by the content's hash, so that unchanged files are not compressed
/// again; gives the Rust expression that includes it.
fn packed(
    out: &Path,
    bytes: &[u8],
    suffix: &str,
    compress: fn(&[u8]) -> io::Result<Option<Vec<u8>>>,
) -> io::Result<String> {
    let stem = hex::encode(Sha256::digest(bytes));
    let path = out.join(format!("{stem}.{suffix}"));
    if !path.exists() {
        // An empty file stands for "not worth compressing".
        fs::write(&path, compress(bytes)?.unwrap_or_default())?;
    }
    if fs::metadata(&path)?.len() == 0 {
        return Ok("None".into());
    }
    Ok(format!("Some(include_bytes!({path:?}))"))
}
