//! The npm package `@mimique/stage`: the modules of canvas and solver from the finished pages, an index that exports
//! what `static/stage/host.js` exports, and its types. `npm pack` packs it.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail, ensure};
use serde_json::json;

use super::check::answer;
use super::contents::Terms;
use super::facts::{LICENCE, PUBLISHER, REPOSITORY, STAGE, VERSION};
use super::files::{self, File};
use crate::install::{self, Found};
use crate::process::root;
use crate::tally::Tried;
use crate::web;

/// Which of the pages' files belong to it: these, and what lies in these folders.
const MODULES: [&str; 11] = [
    "adaptive.js",
    "adaptive_bg.wasm",
    "adaptive/faces.js",
    "panics.js",
    "snippets/",
    "solver.js",
    "solver_bg.wasm",
    "sound/sound.js",
    "stage/",
    "stage_webgl",
    "stage_webgpu",
];
/// Belongs to the researchers' pages.
const LEFT_OUT: &str = "stage/player.js";

/// Packs it.
pub fn make(out: &Path, work: &Path) -> Result<PathBuf> {
    let mut whole = templates()?;
    for file in files::below(&web::dist())? {
        if MODULES.iter().any(|name| file.name.starts_with(name)) && file.name != LEFT_OUT {
            whole.push(file.within("modules"));
        }
    }
    imports_lead_somewhere(&whole)?;
    whole.push(File::text("package.json", manifest()));
    whole.extend(Terms::of_stage()?.files());
    let folder = work.join("npm");
    files::write_below(&folder, &whole)?;
    let mut pack = Command::new(install::NPM);
    pack.args(["pack", "--silent", "--ignore-scripts", "--pack-destination"])
        .arg(out)
        .current_dir(&folder);
    let name = answer(&mut pack)?;
    Ok(out.join(name.trim()))
}

/// Index, types and page.
fn templates() -> Result<Vec<File>> {
    let mut found = files::below(&root().join("xtask/package/npm"))?;
    for page in found.iter_mut().filter(|file| file.name == "README.md") {
        page.bytes =
            String::from_utf8_lossy(&page.bytes).replace("{repository}", REPOSITORY).into_bytes();
    }
    Ok(found)
}

fn manifest() -> String {
    let manifest = json!({
        "name": STAGE,
        "version": VERSION,
        "description": "Canvas and solver of Mimique: faces of avatars solved from captures and drawn in the browser",
        "author": PUBLISHER,
        "license": LICENCE,
        "repository": { "type": "git", "url": format!("git+{REPOSITORY}.git") },
        "type": "module",
        "exports": {
            ".": { "types": "./index.d.ts", "default": "./index.js" },
            "./modules/*": "./modules/*",
            "./package.json": "./package.json",
        },
        "types": "./index.d.ts",
        "files": ["index.js", "index.d.ts", "modules", "LICENSE-*", "THIRD-PARTY-LICENCES.txt", "sbom.cdx.json"],
        "sideEffects": ["./modules/stage/solver-worker.js"],
        "publishConfig": { "access": "public" },
    });
    format!("{manifest:#}\n")
}

/// Every file that a module names beside itself is in the package.
fn imports_lead_somewhere(whole: &[File]) -> Result<()> {
    let mut lost = Vec::new();
    for file in whole.iter().filter(|file| file.name.ends_with(".js")) {
        let text = String::from_utf8_lossy(&file.bytes);
        let folder = Path::new(&file.name).parent().unwrap_or(Path::new(""));
        for named in text.split(['"', '\'', '`']).filter(|text| is_neighbour(text)) {
            let path = resolved(folder, named);
            if !whole.iter().any(|other| other.name == path) {
                lost.push(format!("{}: {named}", file.name));
            }
        }
    }
    if !lost.is_empty() {
        bail!(
            "{STAGE}: these files are not in the package: {}; add them to MODULES",
            lost.join("; ")
        );
    }
    Ok(())
}

/// Whether a quoted text is the address of a neighbour; wasm-bindgen's modules call their own scripts `NAME_bg.js`.
fn is_neighbour(text: &str) -> bool {
    let is_below = text.starts_with("./") || text.starts_with("../");
    let is_module = text.ends_with(".js") && !text.ends_with("_bg.js");
    is_below && (is_module || text.ends_with(".wasm"))
}

fn resolved(folder: &Path, named: &str) -> String {
    let mut parts: Vec<&str> = folder.iter().filter_map(|part| part.to_str()).collect();
    for part in named.split('/') {
        match part {
            "." => {}
            ".." => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// Installs it by npm, imports it under node, compiles a program against its types, and draws a clip with it in a
/// browser, whose packs the demonstration's server has: the weights are the server's, bit by bit.
pub fn check(package: &Path, program: Option<&Path>, work: &Path) -> Result<Tried> {
    let folder = work.join("embedding");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("package.json"), r#"{ "private": true, "type": "module" }"#)?;
    let mut install = Command::new(install::NPM);
    install.args(["install", "--no-audit", "--no-fund", "--ignore-scripts", "--loglevel=error"]);
    answer(install.arg(package).arg("typescript@5.9.3").current_dir(&folder))?;
    let said = answer(
        Command::new("node")
            .args(["--input-type=module", "--eval"])
            .arg("console.log(Object.keys(await import('@mimique/stage')).sort().join(' '))")
            .current_dir(&folder),
    )?;
    let expected =
        exported(&String::from_utf8_lossy(&files::read(&root().join("static/stage/host.js"))?));
    ensure!(said.trim() == expected.join(" "), "it exports {said:?} instead of {expected:?}");
    std::fs::write(folder.join("embedding.ts"), EMBEDDING)?;
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
    draw.arg(tests.join("stage_package.mjs")).arg(folder.join("node_modules").join(STAGE));
    crate::process::say(answer(draw.env("MIMIQUE_BINARY", program))?.trim());
    Ok(Tried::Done)
}

/// A program that embeds the package, for its types.
const EMBEDDING: &str = r#"
import { openStage, prepareClip, type ClipSource, type PlayLog } from "@mimique/stage";
export async function shown(canvas: HTMLCanvasElement, source: ClipSource): Promise<PlayLog> {
  const { frames } = await prepareClip("clip", source, (part: number) => console.log(part));
  const stage = await openStage(canvas, { width: 320, height: 320 });
  stage.setView({ yaw: 0.1 * frames });
  return stage.play("clip", { heard: false });
}
"#;

/// The names that a script exports, sorted.
fn exported(script: &str) -> Vec<String> {
    let mut names = Vec::new();
    for line in script.lines() {
        if let Some(list) = line.strip_prefix("export {").and_then(|rest| rest.split('}').next()) {
            names.extend(list.split(',').map(|name| name.trim().to_owned()));
        }
        let function = line
            .trim_start_matches("export ")
            .trim_start_matches("async ")
            .strip_prefix("function ");
        if let (true, Some(function)) = (line.starts_with("export "), function) {
            names.extend(function.split('(').next().map(str::to_owned));
        }
    }
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The index passes on what the host script exports; its types name the same.
    #[test]
    fn types_name_what_the_host_script_exports() {
        let text =
            |path: &str| String::from_utf8(files::read(&root().join(path)).unwrap()).unwrap();
        let host = exported(&text("static/stage/host.js"));
        assert!(host.len() >= 8 && host.contains(&"openStage".to_owned()), "{host:?}");
        assert_eq!(host, exported(&text("xtask/package/npm/index.d.ts")));
        let page = templates().unwrap().into_iter().find(|file| file.name == "README.md").unwrap();
        assert!(
            String::from_utf8(page.bytes).unwrap().contains(REPOSITORY),
            "the package's page names no place"
        );
    }

    #[test]
    fn a_file_that_is_not_there_is_named() {
        let there = [
            File::text("modules/a/b.js", "import '../c.js'; import(\"./d.js\")"),
            File::text("modules/c.js", ""),
        ];
        let refused = imports_lead_somewhere(&there).unwrap_err().to_string();
        assert!(
            refused.contains("modules/a/b.js: ./d.js") && !refused.contains("c.js;"),
            "{refused}"
        );
    }

    #[test]
    fn the_manifest_is_of_this_version() {
        let manifest: serde_json::Value = serde_json::from_str(&manifest()).unwrap();
        assert_eq!((&manifest["name"], &manifest["version"]), (&json!(STAGE), &json!(VERSION)));
    }
}
