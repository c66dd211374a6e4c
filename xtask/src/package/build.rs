//! The program of a target: what every package of that target holds, the same bytes in each.
//!
//! Programs of Linux are linked statically against musl by cargo-zigbuild, whose zig is the C compiler of SQLite, too;
//! those of macOS and Windows are built on their own system.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::facts::NAME;
use super::target::Target;
use crate::install::{self, Found};
use crate::process::{cargo, locked, root, run, say};

/// The Python environment with cargo-zigbuild, zig, and what packs wheels and looks through them: its interpreter, or
/// what to do.
pub fn python() -> Result<std::result::Result<PathBuf, String>> {
    install::python("package-tools", &root().join("xtask/package/requirements.txt"))
}

/// Builds the program of a target, or takes the one that is built; where it lies, or why it cannot be built here.
pub fn program(target: &Target, is_built: bool) -> Result<std::result::Result<PathBuf, String>> {
    let binary = target.binary();
    if is_built {
        let why = || format!("{} is not there; leave --built out", binary.display());
        return Ok(binary.exists().then_some(binary.clone()).ok_or_else(why));
    }
    install::rust_target(target.triple)?;
    say(&format!("building {NAME} for {}", target.triple));
    let mut command = cargo();
    if target.is_linux() {
        let tools = match python()? {
            Ok(interpreter) => {
                interpreter.parent().context("an interpreter lies in a folder")?.to_owned()
            }
            Err(remedy) => return Ok(Err(format!("no zig: {remedy}"))),
        };
        command.arg("zigbuild").env("PATH", with_first(&tools)?);
    } else {
        if let Found::No(remedy) = install::C_COMPILER.ensure() {
            return Ok(Err(format!("no C compiler: {remedy}")));
        }
        command.arg("build");
    }
    command.args(locked()).args(["--release", "--package", NAME, "--target", target.triple]);
    // Names of functions are a quarter of the file; panics have message and place without them.
    command.env("CARGO_PROFILE_RELEASE_STRIP", "symbols");
    run(&mut command)?;
    if !binary.exists() {
        bail!("{}: was not built", binary.display());
    }
    Ok(Ok(binary))
}

/// The search path with this folder before all others.
pub fn with_first(folder: &Path) -> Result<OsString> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(folder.to_owned()).chain(std::env::split_paths(&path));
    Ok(std::env::join_paths(folders)?)
}
