//! `cargo xtask demo`: from a fresh clone to a running study.

use std::process::Command;

use anyhow::{Context, Result, anyhow};

use crate::install::{self, Found};
use crate::process::{cargo, locked, root, run as run_program, say, target};
use crate::web;

/// Options of `cargo xtask demo`.
#[derive(clap::Args)]
pub struct Args {
    /// Stop before starting the server
    #[arg(long)]
    no_serve: bool,
    /// Address to listen on
    #[arg(long, default_value = "127.0.0.1:8080")]
    listen: String,
    /// Study files to host
    #[arg(default_value = "study-config/demo.json")]
    studies: Vec<String>,
}

/// Installs, builds, starts.
pub fn run(args: &Args) -> Result<()> {
    if let Found::No(remedy) = install::C_COMPILER.ensure() {
        say(&format!("no C compiler, the build may fail: {remedy}"));
    }
    alongside(|| web::all(false), commands)?;
    binary()?;
    let binary = binary_path();
    if args.no_serve {
        say(&format!("built: {}", binary.strip_prefix(root()).unwrap_or(&binary).display()));
        say("start the study with: cargo xtask demo");
        return Ok(());
    }
    let mut serve = Command::new(&binary);
    serve.current_dir(root()).arg("serve").args(&args.studies).args(["--listen", &args.listen]);
    // Whoever tries it out sees the stimuli before there is an account.
    serve.arg("--open-preview");
    serve.status().with_context(|| binary.display().to_string())?;
    Ok(())
}

/// Runs `pages` and, at the same time, `other`: linking a module of the pages occupies one core only.
fn alongside(
    pages: impl FnOnce() -> Result<()>,
    other: impl FnOnce() -> Result<()> + Send,
) -> Result<()> {
    std::thread::scope(|scope| {
        let other = scope.spawn(other);
        let pages = pages();
        other.join().map_err(|_| anyhow!("a build has stopped"))??;
        pages
    })
}

/// Builds all of the binary that does not need the pages.
fn commands() -> Result<()> {
    say("building the commands");
    run_program(cargo().arg("build").args(locked()).args(["--release", "--package", "mimique-cli"]))
}

/// Builds the release binary.
pub fn binary() -> Result<()> {
    say("building mimique");
    run_program(cargo().arg("build").args(locked()).args(["--release", "--package", "mimique"]))
}

/// Where the release binary is.
pub fn binary_path() -> std::path::PathBuf {
    target().join("release").join(if cfg!(windows) { "mimique.exe" } else { "mimique" })
}
