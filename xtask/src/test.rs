//! `cargo xtask test`: every check and test there is, and one closing line.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, anyhow, bail};

use crate::install::{self, Found, Package};
use crate::process::{cargo, locked, output, root, say};
use crate::tally::Tally;
use crate::{budget, demo, web};

/// Options of `cargo xtask test`.
#[derive(clap::Args)]
pub struct Args {
    /// Leave out the browser tests
    #[arg(long)]
    no_browser: bool,
}

/// The crate of the canvas, which is empty unless it is compiled for a browser.
const CANVAS: &str = "mimique-web-stage";

/// Runs everything; an error when a test failed (or was skipped under `MIMIQUE_NO_SKIP`).
pub fn run(args: &Args) -> Result<()> {
    let no_skip = std::env::var_os("MIMIQUE_NO_SKIP").is_some_and(|v| v == "1");
    let mut tally = Tally::default();
    say(&format!("real data are looked for in {}", data().display()));
    let python = needed()?;
    tally.check("format", cargo().args(["fmt", "--all", "--check"]));
    // Linking a module of the pages occupies one core: everything else is checked and compiled alongside. When the pages are
    // finished, only what embeds them is compiled again.
    let others = std::thread::scope(|scope| {
        let others = scope.spawn(|| {
            let mut others = lints();
            for (name, packages) in SELECTIONS {
                let compiling = format!("compiling the tests, {name}");
                others.check(&compiling, nextest(packages).arg("--no-run"));
            }
            others
        });
        tally.done("pages", || web::all(true));
        others.join()
    });
    tally.add(others.map_err(|_| anyhow!("lints and compilation have stopped"))?);
    tally.done("size of the pages", budget::check);
    dependencies(&mut tally);
    native(&mut tally, python.as_deref())?;
    documentation(&mut tally);
    if !args.no_browser {
        browser(&mut tally)?;
    }
    if !tally.close(!no_skip) {
        bail!("not all is well");
    }
    Ok(())
}

/// Browser tests that compare the display's frames, a clip's sound or a press with a clock, or how many frames were drawn in
/// a time: they run alone.
const TIMED: [&str; 7] =
    ["keys", "mimicry", "pairs", "sound", "stage_element", "studio", "triggers"];

/// The longest of the other browser tests: they begin first, so that no worker is left with one of them at the end.
const LONGEST: [&str; 3] = ["study", "together", "conduct"];

/// Installs what tests need; the Python environment, where there can be one.
fn needed() -> Result<Option<PathBuf>> {
    install::nextest()?;
    for package in [
        &install::C_COMPILER,
        &install::LAVAPIPE,
        &install::POSTGRESQL,
        &install::NGINX,
        &install::R,
        &install::ORDINAL,
        &install::LMER_TEST,
    ] {
        need(package);
    }
    let requirements = root().join("tests/support/requirements.txt");
    let remedy = match install::python("python", &requirements) {
        Ok(Ok(interpreter)) => return Ok(Some(interpreter)),
        Ok(Err(remedy)) => remedy,
        Err(error) => format!("{error:#}"),
    };
    say(&format!("no Python environment; the tests that need it will skip: {remedy}"));
    Ok(None)
}

/// Clippy, natively and for the modules of the pages.
fn lints() -> Tally {
    let mut tally = Tally::default();
    for (name, packages) in SELECTIONS {
        let mut lint = cargo_with_pages();
        lint.arg("clippy").args(locked()).args(["--release", "--all-targets"]).args(packages);
        tally.check(&format!("clippy, {name}"), lint.args(DENY));
    }
    // The native call has checked the other modules: only these two are written for browsers alone. What differs between the
    // canvas of WebGPU and that of WebGL2 is in its dependencies.
    let mut lint = cargo();
    lint.arg("clippy").args(locked()).args(["--release", "--target", "wasm32-unknown-unknown"]);
    lint.args(["--package", "mimique-app", "--package", CANVAS, "--no-default-features"]);
    lint.args(["--features", &format!("{CANVAS}/webgl")]);
    tally.check("clippy, wasm32", lint.args(DENY));
    tally
}

/// What is compiled natively, in two selections: together with the workspace, xtask's dependencies would be compiled once
/// more, with the features that the workspace asks for.
const SELECTIONS: [(&str, &[&str]); 2] = [
    ("workspace", &["--workspace", "--exclude", CANVAS, "--exclude", "xtask"]),
    ("xtask", &["--package", "xtask"]),
];

/// Cargo with the folder of the pages: a command without it would rebuild what embeds them.
fn cargo_with_pages() -> Command {
    let mut command = cargo();
    command.env("MIMIQUE_WEB_DIST", web::dist());
    command
}

/// A warning fails.
const DENY: [&str; 3] = ["--", "-D", "warnings"];

/// Licences, sources and unwanted crates. Compiling cargo-deny takes longer than all of the tests, so that it
/// is not installed here; advisories need its database from the network.
fn dependencies(tally: &mut Tally) {
    if output(cargo().args(["deny", "--version"])).is_some() {
        let mut deny = cargo();
        tally.check("cargo deny", deny.args(["deny", "check", "bans", "licenses", "sources"]));
    } else {
        say(
            "cargo-deny is not installed: licences and sources are looked at by tests/support alone, \
             advisories not at all (cargo install --locked cargo-deny; cargo deny check)",
        );
    }
}

/// The test runner on a selection; the binary of the browser tests is compiled with the workspace.
fn nextest(packages: &[&str]) -> Command {
    let mut tests = cargo_with_pages();
    // Clippy has checked benchmarks and examples; nothing runs them here.
    tests.args(["nextest", "run"]).args(locked()).args(["--release", "--tests"]).args(packages);
    tests
}

/// Unit, property, golden and HTTP tests, and the examples of the documentation.
fn native(tally: &mut Tally, python: Option<&Path>) -> Result<()> {
    for (name, packages) in SELECTIONS {
        let mut tests = nextest(packages);
        tests.arg("--no-fail-fast");
        // Passed tests are shown too: one that skips says so there.
        tests.args(["--success-output", "immediate", "--status-level", "slow"]);
        tests.args(["--color", "never"]).env("MIMIQUE_DATA", data());
        if let Some(python) = python {
            tests.env("MIMIQUE_PYTHON", python);
        }
        tally.tests(&format!("unit, property, golden and http tests, {name}"), &mut tests)?;
    }
    let mut doc_tests = cargo_with_pages();
    // xtask is no library and has none.
    doc_tests.arg("test").args(locked()).args(["--release", "--doc"]).args(SELECTIONS[0].1);
    tally.check("doc tests", &mut doc_tests);
    Ok(())
}

/// The documentation of every public item, without a warning.
fn documentation(tally: &mut Tally) {
    let mut docs = cargo_with_pages();
    // xtask is no library: nothing of it is public.
    docs.arg("doc").args(locked()).args(["--no-deps", "--release"]).args(SELECTIONS[0].1);
    tally.check("documentation", docs.env("RUSTDOCFLAGS", "-D warnings"));
}

/// Pages are used as a person uses them: by click, by keyboard, on both graphics back ends.
fn browser(tally: &mut Tally) -> Result<()> {
    need(&install::CHROMIUM);
    need(&install::FIREFOX);
    need(&install::XVFB);
    let folder = root().join("tests/browser");
    if let Found::No(remedy) = install::npm(&folder)? {
        say(&format!("browser tests cannot run: {remedy}"));
    }
    // nextest has just built the binary for the command line's own tests. A build of that package
    // alone would compile half the dependencies again, for other features.
    let binary = demo::binary_path();
    if !binary.exists() {
        tally.fail(format!("browser tests: {} was not built", binary.display()));
        return Ok(());
    }
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder)?
        .filter_map(|e| Some(e.ok()?.path()))
        .filter(|p| p.to_string_lossy().ends_with(".test.mjs"))
        .collect();
    files.sort();
    let is_one_of = |path: &Path, names: &[&str]| {
        let name = path.file_name().map_or_else(Default::default, |name| name.to_string_lossy());
        names.contains(&name.trim_end_matches(".test.mjs"))
    };
    let (timed, mut others): (Vec<_>, Vec<_>) =
        files.into_iter().partition(|path| is_one_of(path, &TIMED));
    others.sort_by_key(|path| !is_one_of(path, &LONGEST));
    // `run.mjs` is `node --test` with browsers and prepared stimuli that all files share.
    let mut run = |name: &str, workers: u32, files: Vec<PathBuf>| {
        let mut tests = Command::new("node");
        tests.args(["run.mjs", &format!("--test-concurrency={workers}"), "--test-reporter=tap"]);
        tests.args(files).current_dir(&folder);
        tests.env("MIMIQUE_DATA", data()).env("MIMIQUE_BINARY", &binary);
        tally.tests(name, &mut tests)
    };
    // Most pages draw nothing and wait for clips to be played: three share two cores well.
    run("browser tests, three at a time", 3, others)?;
    run("browser tests of what is timed, one at a time", 1, timed)
}

fn need(package: &Package) {
    if let Found::No(remedy) = package.ensure() {
        say(&format!("{} not found; the tests that need it will skip: {remedy}", package.name));
    }
}

/// Where real data are looked for.
pub fn data() -> PathBuf {
    let given = std::env::var_os("MIMIQUE_DATA").unwrap_or_else(|| "../shared/data".into());
    let path = root().join(given);
    path.canonicalize().unwrap_or(path)
}
