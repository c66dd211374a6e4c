//! The npm packages: `@mimique/stage`, the modules of canvas, solver and studio from the finished pages with the element
//! `<mimique-stage>`, an index that exports what `static/stage/host.js` exports, and types; and `@mimique/jspsych-plugin`.
//! `npm pack` packs them.

mod check;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail};
use serde_json::json;

use super::check::answer;
use super::contents::Terms;
use super::facts::{JSPSYCH_PLUGIN, LICENCE, PUBLISHER, REPOSITORY, STAGE, VERSION};
use super::files::{self, File};
use crate::install;
use crate::process::root;
use crate::web;

pub use self::check::check;

/// Which of the pages' files belong to the stage: these, and what lies in these folders.
const MODULES: [&str; 15] = [
    "adaptive.js",
    "adaptive_bg.wasm",
    "adaptive/faces.js",
    "module-worker.js",
    "panics.js",
    "snippets/",
    "solver.js",
    "solver_bg.wasm",
    "sound/sound.js",
    "stage/",
    "stage_webgl",
    "stage_webgpu",
    "studio.js",
    "studio/worker",
    "studio_bg.wasm",
];
/// Belongs to the researchers' pages.
const LEFT_OUT: &str = "stage/player.js";

/// The packed packages.
pub struct Packages {
    /// `@mimique/stage`.
    pub stage: PathBuf,
    /// `@mimique/jspsych-plugin`.
    pub jspsych_plugin: PathBuf,
}

/// Packs both.
pub fn make(out: &Path, work: &Path) -> Result<Packages> {
    let mut stage = templates("xtask/package/npm")?;
    for file in files::below(&web::dist())? {
        if is_of_stage(&file.name) {
            stage.push(file.within("modules"));
        }
    }
    imports_lead_somewhere(&stage)?;
    stage.push(File::text("package.json", stage_manifest()));
    stage.extend(Terms::of_stage()?.files());
    let mut plugin = templates("xtask/package/jspsych")?;
    plugin.push(File::text("package.json", plugin_manifest()));
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        plugin.push(File::of_repository(licence, licence)?);
    }
    Ok(Packages {
        stage: packed(&stage, out, &work.join("npm"))?,
        jspsych_plugin: packed(&plugin, out, &work.join("jspsych"))?,
    })
}

/// Whether a file of the pages belongs to the stage.
fn is_of_stage(name: &str) -> bool {
    MODULES.iter().any(|module| name.starts_with(module)) && name != LEFT_OUT
}

fn packed(whole: &[File], out: &Path, folder: &Path) -> Result<PathBuf> {
    files::write_below(folder, whole)?;
    let mut pack = Command::new(install::NPM);
    pack.args(["pack", "--silent", "--ignore-scripts", "--pack-destination"])
        .arg(out)
        .current_dir(folder);
    let name = answer(&mut pack)?;
    Ok(out.join(name.trim()))
}

/// What of a package is written by hand: its scripts, types, example and page.
fn templates(folder: &str) -> Result<Vec<File>> {
    let mut found = files::below(&root().join(folder))?;
    for page in found.iter_mut().filter(|file| file.name == "README.md") {
        page.bytes =
            String::from_utf8_lossy(&page.bytes).replace("{repository}", REPOSITORY).into_bytes();
    }
    Ok(found)
}

fn stage_manifest() -> String {
    let manifest = json!({
        "name": STAGE,
        "version": VERSION,
        "description": "Faces of avatars solved from captures and drawn in the browser: an element, canvas and solver of Mimique",
        "author": PUBLISHER,
        "license": LICENCE,
        "repository": { "type": "git", "url": format!("git+{REPOSITORY}.git") },
        "type": "module",
        "exports": {
            ".": { "types": "./index.d.ts", "default": "./index.js" },
            "./element.js": { "types": "./element.d.ts", "default": "./element.js" },
            "./modules/*": "./modules/*",
            "./package.json": "./package.json",
        },
        "types": "./index.d.ts",
        "files": ["*.js", "*.d.ts", "example", "modules", "LICENSE-*", "THIRD-PARTY-LICENCES.txt", "sbom.cdx.json"],
        "sideEffects": ["./element.js", "./modules/stage/solver-worker.js", "./modules/studio/worker.js"],
        "publishConfig": { "access": "public" },
    });
    format!("{manifest:#}\n")
}

fn plugin_manifest() -> String {
    let manifest = json!({
        "name": JSPSYCH_PLUGIN,
        "version": VERSION,
        "description": "plugin-mimique: jsPsych trials with one to nine clips of avatar faces and a question",
        "keywords": ["jspsych", "jspsych-plugin", "avatar", "facial-animation"],
        "author": PUBLISHER,
        "license": LICENCE,
        "repository": { "type": "git", "url": format!("git+{REPOSITORY}.git") },
        "type": "module",
        "exports": {
            ".": { "types": "./index.d.ts", "default": "./index.js" },
            "./browser.js": { "types": "./index.d.ts", "default": "./browser.js" },
            "./package.json": "./package.json",
        },
        "types": "./index.d.ts",
        "files": ["*.js", "*.d.ts", "example", "LICENSE-*"],
        "sideEffects": ["./browser.js", "./index.js"],
        "peerDependencies": { "jspsych": ">=8.0.0", STAGE: VERSION },
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
    }

    #[test]
    fn pages_of_packages_name_the_repository() {
        for folder in ["xtask/package/npm", "xtask/package/jspsych"] {
            let page = templates(folder).unwrap().into_iter().find(|file| file.name == "README.md");
            let page = String::from_utf8(page.unwrap().bytes).unwrap();
            assert!(page.contains(REPOSITORY) && !page.contains("{repository}"), "{folder}");
        }
    }

    /// Before anything is built: whatever the package's scripts import is one of them, or a module that is built.
    #[test]
    fn scripts_of_the_stage_import_nothing_else() {
        let scripts = files::below(&root().join("static")).unwrap();
        let scripts = scripts.into_iter().filter(|file| is_of_stage(&file.name));
        let mut whole: Vec<File> = scripts.map(|file| file.within("modules")).collect();
        assert!(whole.len() > 10, "{}", whole.len());
        for module in ["adaptive", "solver", "stage_webgl", "stage_webgpu", "studio"] {
            for built in [format!("{module}.js"), format!("{module}_bg.wasm")] {
                whole.push(File::text(format!("modules/{built}"), ""));
            }
        }
        whole.extend(templates("xtask/package/npm").unwrap());
        imports_lead_somewhere(&whole).unwrap();
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

    /// Scripts cannot read the manifest beside them in every browser: they say the version themselves.
    #[test]
    fn manifests_and_scripts_are_of_this_version() {
        for (manifest, name) in [(stage_manifest(), STAGE), (plugin_manifest(), JSPSYCH_PLUGIN)] {
            let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
            assert_eq!((&manifest["name"], &manifest["version"]), (&json!(name), &json!(VERSION)));
        }
        for (folder, script, line) in [
            ("xtask/package/npm", "version.js", "export const VERSION = "),
            ("xtask/package/jspsych", "info.js", "export const version = "),
        ] {
            let script = files::read(&root().join(folder).join(script)).unwrap();
            let script = String::from_utf8(script).unwrap();
            assert!(script.contains(&format!("{line}\"{VERSION}\";")), "{folder}: {script}");
        }
    }
}
