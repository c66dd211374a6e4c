//! The npm packages installed and used: imported, compiled against, drawn with.

use std::path::Path;
use std::process::Command;

use anyhow::{Result, ensure};

use super::{Packages, exported};
use crate::install::{self, Found};
use crate::package::check::answer;
use crate::package::files;
use crate::process::root;
use crate::tally::Tried;

/// What pages install beside them.
const BESIDE: [&str; 2] = ["jspsych@8.3.0", "typescript@5.9.3"];

/// Installs both by npm into a clean folder, imports the stage under node, compiles a program against their types, and opens
/// pages on a host of that folder in a browser: a clip of the demonstration's server, whose weights are the server's bit by
/// bit, and the packages' own examples.
pub fn check(packages: &Packages, program: Option<&Path>, work: &Path) -> Result<Tried> {
    let folder = work.join("embedding");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("package.json"), r#"{ "private": true, "type": "module" }"#)?;
    let mut install = Command::new(install::NPM);
    install.args(["install", "--no-audit", "--no-fund", "--ignore-scripts", "--loglevel=error"]);
    install.arg(&packages.stage).arg(&packages.jspsych_plugin).args(BESIDE);
    answer(install.current_dir(&folder))?;
    let said = answer(
        Command::new("node")
            .args(["--input-type=module", "--eval"])
            .arg("console.log(Object.keys(await import('@mimique/stage')).sort().join(' '))")
            .current_dir(&folder),
    )?;
    let expected =
        exported(&String::from_utf8_lossy(&files::read(&root().join("static/stage/host.js"))?));
    ensure!(said.trim() == expected.join(" "), "it exports {said:?} instead of {expected:?}");
    std::fs::copy(root().join("tests/browser/lib/embedding.ts"), folder.join("embedding.ts"))?;
    let mut compile = Command::new("node");
    compile.args([
        "node_modules/typescript/bin/tsc",
        "--noEmit",
        "--strict",
        "--module",
        "nodenext",
    ]);
    answer(
        compile
            .args(["--target", "es2022", "--lib", "es2022,dom", "embedding.ts"])
            .current_dir(&folder),
    )?;
    let Some(program) = program else {
        return Ok(Tried::InPart(
            "imported and compiled against, not drawn with: no program of this machine was built"
                .into(),
        ));
    };
    let tests = root().join("tests/browser");
    for found in [install::CHROMIUM.ensure(), install::npm(&tests)?] {
        if let Found::No(remedy) = found {
            return Ok(Tried::InPart(format!(
                "imported and compiled against, not drawn with: {remedy}"
            )));
        }
    }
    let mut draw = Command::new("node");
    draw.arg(tests.join("stage_package.mjs")).arg(folder.join("node_modules"));
    crate::process::say(answer(draw.env("MIMIQUE_BINARY", program))?.trim());
    Ok(Tried::Done)
}
