//! The pages: wasm modules and static files, gathered in `target/web-dist`, ready to be embedded.
//!
//! | module | crate | what for |
//! |---|---|---|
//! | `app` | `web/app` | the participant's pages |
//! | `stage_webgpu` | `web/stage` | the canvas, WebGPU alone |
//! | `stage_webgl` | `web/stage` | the canvas, WebGL2 |
//! | `adaptive` | `web/adaptive` | the levels of adaptive blocks; only studies with such a block load it |
//! | `studio` | `web/studio` | the studio's worker |
//! | `report` | `web/report` | the report of a study, for the pages of a capsule |
//! | `solver` | `web/solver` | the solver's worker |
//! | `bits` | `web/bits` | orders and numbers of exertion, for a test; not a part of the pages |
//! | `panicking` | `web/panicking` | a solver that panics, for a test; not a part of the pages |
//!
//! All of them are built with the profile `web`, whose packages have optimisation levels of their own (`Cargo.toml`), so
//! that every dependency compiles once.
//!
//! `wasm-bindgen` runs as a library of the same version as the crates use; `wasm-opt` (npm's
//! binaryen) and `esbuild` make the files smaller where node is there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, anyhow, bail};
use sha2::{Digest, Sha256};

use crate::install::{self, Found};
use crate::packed;
use crate::process::{cargo, locked, root, run as run_program, say, target};

/// Options of `cargo xtask web`.
#[derive(clap::Args)]
pub struct Args {
    /// Build only these modules (adaptive, app, bits, panicking, report, stage_webgpu, stage_webgl, solver, studio);
    /// static files always
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Leave out wasm-opt and esbuild: a quicker build of larger files
    #[arg(long)]
    no_opt: bool,
}

struct Module {
    name: &'static str,
    package: &'static str,
    library: &'static str,
    /// Whether only tests load it: it is built as the pages are, and not gathered with them.
    is_for_tests: bool,
    features: Option<&'static str>,
    opt_level: &'static str,
}

/// The largest come first: they are made small while the others compile.
const MODULES: [Module; 9] = [
    Module {
        name: "studio",
        package: "mimique-web-studio",
        library: "mimique_web_studio",
        is_for_tests: false,
        features: None,
        opt_level: "-O3",
    },
    Module {
        name: "report",
        package: "mimique-web-report",
        library: "mimique_web_report",
        is_for_tests: false,
        features: None,
        opt_level: "-O3",
    },
    Module {
        name: "solver",
        package: "mimique-web-solver",
        library: "mimique_web_solver",
        is_for_tests: false,
        features: None,
        opt_level: "-O3",
    },
    Module {
        name: "adaptive",
        package: "mimique-web-adaptive",
        library: "mimique_web_adaptive",
        is_for_tests: false,
        features: None,
        opt_level: "-O3",
    },
    Module {
        name: "app",
        package: "mimique-app",
        library: "mimique_app",
        is_for_tests: false,
        features: None,
        opt_level: "-Oz",
    },
    Module {
        name: "stage_webgl",
        package: "mimique-web-stage",
        library: "mimique_web_stage",
        is_for_tests: false,
        features: Some("webgl"),
        opt_level: "-Oz",
    },
    Module {
        name: "stage_webgpu",
        package: "mimique-web-stage",
        library: "mimique_web_stage",
        is_for_tests: false,
        features: Some("webgpu"),
        opt_level: "-Oz",
    },
    Module {
        name: "bits",
        package: "mimique-web-bits",
        library: "mimique_web_bits",
        is_for_tests: true,
        features: None,
        opt_level: "-O3",
    },
    Module {
        name: "panicking",
        package: "mimique-web-panicking",
        library: "mimique_web_panicking",
        is_for_tests: true,
        features: None,
        opt_level: "-Oz",
    },
];

/// Where linked modules wait for `wasm-bindgen` and `wasm-opt`.
fn unfinished() -> PathBuf {
    target().join("web-modules/linked")
}

/// What `wasm-opt` may read and write.
const FEATURES: [&str; 4] = [
    "--all-features",
    "--disable-gc",
    "--disable-custom-descriptors",
    // No browser reads them yet.
    "--disable-compact-imports",
];

/// How `wasm-opt` makes every module small: what counts is the size after compression. Functions put into
/// their callers (LLVM has done it where it pays) make the file smaller by a tenth and its gzip larger by a
/// tenth; folding code, sharing locals and sorting functions by their use, too, save bytes that the gzip
/// does not have.
const WASM_OPT: [&str; 14] = [
    "--always-inline-max-function-size",
    "0",
    "--flexible-inline-max-function-size",
    "0",
    "--one-caller-inline-max-function-size",
    "0",
    "--skip-pass=reorder-functions",
    "--skip-pass=merge-locals",
    "--skip-pass=local-cse",
    "--skip-pass=code-folding",
    "--skip-pass=coalesce-locals",
    "--coalesce-locals-learning",
    "--strip-producers",
    "--strip-target-features",
];

/// A script that is always loaded together with what it imports becomes one file: fewer requests, and a
/// quarter fewer bytes. The files that nothing else imports are left out then.
const BUNDLED: (&str, [&str; 8]) = (
    "stage/host.js",
    [
        "stage/backend.js",
        "stage/clips.js",
        "stage/clock.js",
        "stage/failure.js",
        "stage/packs.js",
        "stage/pictures.js",
        "stage/playback.js",
        "stage/video.js",
    ],
);

/// Where the pages are gathered.
pub fn dist() -> PathBuf {
    target().join("web-dist")
}

/// Builds the modules asked for and gathers everything.
pub fn run(args: &Args) -> Result<()> {
    for name in &args.only {
        if !MODULES.iter().any(|m| m.name == name) {
            let names: Vec<&str> = MODULES.iter().map(|module| module.name).collect();
            bail!("no module is called {name}; there are: {}", names.join(", "));
        }
    }
    build(|m| args.only.is_empty() || args.only.iter().any(|name| name == m.name), !args.no_opt)
}

/// Builds every module of the pages, and with `tests` those that only tests load.
pub fn all(tests: bool) -> Result<()> {
    build(|module| tests || !module.is_for_tests, true)
}

fn build(wanted: impl Fn(&Module) -> bool, optimise: bool) -> Result<()> {
    install::wasm_target()?;
    let tools = if optimise { tools()? } else { None };
    let wasm_opt = tools.as_ref().map(|folder| folder.join("binaryen/bin/wasm-opt"));
    let wanted: Vec<&Module> = MODULES.iter().filter(|module| wanted(module)).collect();
    // Compiling and linking a module keeps cargo's lock; it is made smaller while the next one compiles.
    std::thread::scope(|scope| -> Result<()> {
        let mut finishing = Vec::new();
        for module in wanted {
            module.compile()?;
            let wasm_opt = wasm_opt.as_deref();
            finishing.push(scope.spawn(move || module.finish(wasm_opt)));
        }
        for finished in finishing {
            finished.join().map_err(|_| anyhow!("a module was not finished"))??;
        }
        Ok(())
    })?;
    gather(tools.map(|folder| folder.join("esbuild/bin/esbuild")).as_deref())
}

/// The folder of the npm packages that make files smaller, or nothing where node is not.
fn tools() -> Result<Option<PathBuf>> {
    let folder = root().join("xtask/npm");
    match install::npm(&folder)? {
        Found::Yes => Ok(Some(folder.join("node_modules"))),
        Found::No(remedy) => {
            say(&format!("wasm-opt and esbuild left out, the pages will be larger: {remedy}"));
            Ok(None)
        }
    }
}

impl Module {
    /// Where the finished module lies until it is gathered.
    fn out(&self) -> PathBuf {
        target().join("web-modules").join(self.name)
    }

    /// Where the compiler writes the module.
    fn raw(&self) -> PathBuf {
        target().join("wasm32-unknown-unknown/web").join(format!("{}.wasm", self.library))
    }

    /// Compiles and links the module, to where [`Module::finish`] finds it.
    fn compile(&self) -> Result<()> {
        say(&format!("building {}", self.name));
        let mut command = cargo();
        command.arg("rustc").args(locked()).args(["--target", "wasm32-unknown-unknown"]);
        // cargo leaves link-time optimisation out where an rlib is built along, and an example would have all dependencies
        // compiled once more, for both.
        command.args(["--lib", "--crate-type", "cdylib"]);
        command.args(["--package", self.package, "--profile", "web"]);
        if let Some(features) = self.features {
            command.args(["--no-default-features", "--features", features]);
        }
        run_program(&mut command)?;
        // The canvas is built twice from one library: the next build replaces the file.
        let raw = self.raw();
        fs::create_dir_all(unfinished())?;
        fs::copy(&raw, self.unfinished()).with_context(|| raw.display().to_string())?;
        Ok(())
    }

    /// The linked module, under its own name.
    fn unfinished(&self) -> PathBuf {
        unfinished().join(format!("{}.wasm", self.name))
    }

    /// Gives the linked module its script and, unless only tests load it, makes it small.
    fn finish(&self, optimiser: Option<&Path>) -> Result<()> {
        let raw = self.unfinished();
        let optimiser = optimiser.filter(|_| !self.is_for_tests);
        let out = self.out();
        let stamp = out.join("stamp");
        let mark = self.mark(&raw, optimiser)?;
        if fs::read_to_string(&stamp).ok().as_deref() == Some(&mark) {
            return Ok(());
        }
        if out.exists() {
            fs::remove_dir_all(&out)?;
        }
        fs::create_dir_all(&out)?;
        wasm_bindgen_cli_support::Bindgen::new()
            .input_path(&raw)
            .out_name(self.name)
            .web(true)?
            .typescript(false)
            .omit_default_module_path(false)
            .generate(&out)
            .with_context(|| format!("wasm-bindgen of {}", self.name))?;
        if let Some(script) = optimiser {
            let wasm = out.join(format!("{}_bg.wasm", self.name));
            let mut command = Command::new("node");
            command.arg(script).args(FEATURES).arg(self.opt_level).args(WASM_OPT);
            run_program(command.arg(&wasm).arg("-o").arg(&wasm))?;
        }
        fs::write(&stamp, mark)?;
        Ok(())
    }

    /// What the finished files depend on.
    fn mark(&self, raw: &Path, optimiser: Option<&Path>) -> Result<String> {
        let mut hash = Sha256::new();
        hash.update(fs::read(raw).with_context(|| raw.display().to_string())?);
        hash.update([u8::from(optimiser.is_some())]);
        hash.update(wasm_bindgen_cli_support_version());
        hash.update(self.opt_level);
        FEATURES.iter().chain(&WASM_OPT).for_each(|option| hash.update(option));
        Ok(hex::encode(hash.finalize()))
    }
}

fn wasm_bindgen_cli_support_version() -> String {
    let lock = fs::read_to_string(root().join("Cargo.lock")).unwrap_or_default();
    lock.lines()
        .skip_while(|l| *l != "name = \"wasm-bindgen-cli-support\"")
        .nth(1)
        .unwrap_or_default()
        .to_owned()
}

/// Copies modules and static files into [`dist`], scripts and styles made small on the way, unchanged
/// files untouched, so that a build that changed nothing embeds nothing anew; then prints the sizes.
fn gather(esbuild: Option<&Path>) -> Result<()> {
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    for module in MODULES.iter().filter(|module| !module.is_for_tests) {
        for suffix in [".js", "_bg.wasm"] {
            let name = format!("{}{suffix}", module.name);
            if let Ok(bytes) = fs::read(module.out().join(&name)) {
                files.push((name, bytes));
            }
        }
        collect(&module.out().join("snippets"), "snippets", &mut files)?;
    }
    collect(&root().join("static"), "", &mut files)?;
    files.sort();
    if let Some(esbuild) = esbuild {
        minify(esbuild, &mut files)?;
    }

    let dist = dist();
    fs::create_dir_all(&dist)?;
    let mut earlier = Vec::new();
    collect(&dist, "", &mut earlier)?;

    say("the pages, in bytes, with gzip and with brotli:");
    // The program may be compiled at the same time, with the pages that were there before.
    let mut stems: Vec<String> = earlier.iter().map(|(_, bytes)| packed::stem(bytes)).collect();
    for (name, bytes) in &files {
        let small = packed::pack(name, bytes)?;
        say(&format!("  {name:32} {:>9} {:>9} {:>9}", bytes.len(), small.gzip, small.brotli));
        stems.push(small.stem);
    }
    packed::remove_all_but(&stems)?;

    for (name, _) in earlier.iter().filter(|(n, _)| !files.iter().any(|(f, _)| f == n)) {
        fs::remove_file(dist.join(name))?;
    }
    for (name, bytes) in &files {
        let path = dist.join(name);
        if fs::read(&path).ok().as_deref() != Some(bytes) {
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::write(&path, bytes)?;
        }
    }
    Ok(())
}

/// Scripts and styles without comments, spaces and long names of their own; [`BUNDLED`] as one.
fn minify(esbuild: &Path, files: &mut Vec<(String, Vec<u8>)>) -> Result<()> {
    let (from, to) = (target().join("web-plain"), target().join("web-small"));
    for folder in [&from, &to] {
        if folder.exists() {
            fs::remove_dir_all(folder)?;
        }
        fs::create_dir_all(folder)?;
    }
    let small = |name: &str| name.ends_with(".js") || name.ends_with(".css");
    let mut command = Command::new("node");
    command.arg(esbuild).args(["--minify", "--charset=utf8", "--legal-comments=none"]);
    command.args(["--log-level=error", &format!("--outbase={}", from.display())]);
    command.arg(format!("--outdir={}", to.display()));
    for (name, bytes) in files.iter().filter(|(name, _)| small(name)) {
        let path = from.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(&path, bytes)?;
        command.arg(path);
    }
    run_program(&mut command)?;
    let (joined, parts) = BUNDLED;
    let mut command = Command::new("node");
    command.arg(esbuild).args(["--bundle", "--format=esm", "--minify", "--charset=utf8"]);
    command.args(["--legal-comments=none", "--log-level=error", "--allow-overwrite"]);
    // Loaded by studies with sound, and by those whose faces are drawn, alone.
    command.args(["--external:../sound/*", "--external:../adaptive/*"]);
    command.arg(format!("--outfile={}", to.join(joined).display())).arg(from.join(joined));
    run_program(&mut command)?;
    files.retain(|(name, _)| !parts.contains(&name.as_str()));
    for (name, bytes) in files.iter_mut().filter(|(name, _)| small(name)) {
        *bytes = fs::read(to.join(&*name)).with_context(|| name.clone())?;
    }
    Ok(())
}

fn collect(folder: &Path, prefix: &str, files: &mut Vec<(String, Vec<u8>)>) -> Result<()> {
    let Ok(entries) = fs::read_dir(folder) else { return Ok(()) };
    for entry in entries {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let name = if prefix.is_empty() { name } else { format!("{prefix}/{name}") };
        if entry.file_type()?.is_dir() {
            collect(&entry.path(), &name, files)?;
        } else {
            files.push((name, fs::read(entry.path())?));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::process::output;

    /// The packages that a module is built of, by name and version, with their features.
    fn packages(module: &Module) -> BTreeMap<String, String> {
        let mut tree = cargo();
        tree.args(["tree", "--locked", "--target", "wasm32-unknown-unknown", "--prefix", "none"]);
        tree.args([
            "--edges",
            "normal,no-proc-macro",
            "--format",
            "{p}|{f}",
            "--package",
            module.package,
        ]);
        if let Some(features) = module.features {
            tree.args(["--no-default-features", "--features", features]);
        }
        let tree = output(&mut tree).unwrap_or_else(|| panic!("cargo tree of {}", module.package));
        let lines = tree.lines().filter_map(|line| line.trim_end_matches(" (*)").split_once('|'));
        lines.map(|(package, features)| (package.to_owned(), features.to_owned())).collect()
    }

    #[test]
    fn a_dependency_has_the_same_features_in_all_modules() {
        // The participants' solver has no use for what these features of the solver bring, and the canvas of wgpu asks for
        // other features of four small packages.
        let may_differ =
            ["mimique-solver ", "bitflags ", "hashbrown ", "indexmap ", "num-integer "];
        let studio = packages(MODULES.iter().find(|module| module.name == "studio").unwrap());
        assert!(studio.len() > 100, "{studio:?}");
        for module in &MODULES {
            for (package, features) in packages(module) {
                let Some(of_the_studio) = studio.get(&package) else { continue };
                assert!(
                    *of_the_studio == features
                        || may_differ.iter().any(|name| package.starts_with(name)),
                    "{package} has the features {features:?} in {}, {of_the_studio:?} in the studio: it compiles twice; \
                     add what is missing to web/unified/Cargo.toml",
                    module.name
                );
            }
        }
    }
}
