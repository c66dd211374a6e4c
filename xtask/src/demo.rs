//! `cargo xtask demo`: from a fresh clone to a running study.

use std::process::Command;

use anyhow::{Context, Result, anyhow};

use crate::install::{self, Found};
use crate::process::{cargo, locked, output, root, run as run_program, say, target};
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
    alongside(|| web::all(false), libraries)?;
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

/// What the command line itself needs. Without them some of their dependencies would be compiled with fewer features now,
/// and again with all of them when the binary is built.
const OF_THE_COMMAND_LINE: [&str; 4] = ["clap", "indicatif", "tracing-subscriber", "ureq"];

/// Builds everything of the binary that does not need the pages.
fn libraries() -> Result<()> {
    say("building what mimique consists of");
    let names = library_names()?;
    let packages = names.iter().map(String::as_str).chain(OF_THE_COMMAND_LINE);
    let packages = packages.flat_map(|name| ["--package", name]);
    run_program(cargo().arg("build").args(locked()).arg("--release").args(packages))
}

/// The workspace's crates that the command line depends on, all but the one that embeds the pages.
fn library_names() -> Result<Vec<String>> {
    let metadata = output(cargo().args(["metadata", "--no-deps", "--format-version", "1"]))
        .context("cargo metadata failed")?;
    let metadata: serde_json::Value = serde_json::from_str(&metadata)?;
    let packages = metadata["packages"].as_array().context("cargo metadata lists no packages")?;
    let program = packages
        .iter()
        .find(|package| package["name"] == "mimique")
        .context("no package is called mimique")?;
    let dependencies = program["dependencies"].as_array().context("mimique has no dependencies")?;
    Ok(dependencies
        .iter()
        .filter(|dependency| dependency["path"].is_string() && dependency["kind"].is_null())
        .filter_map(|dependency| dependency["name"].as_str())
        // The solver comes with the features that the others ask for, not with its own default.
        .filter(|name| !["mimique-pages", "mimique-solver"].contains(name))
        .map(str::to_owned)
        .collect())
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
