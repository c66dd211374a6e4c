//! The static demonstration: the demo study as plain files for any web host (`mimique export-site`), with the report of
//! simulated participants beside it, and a first page that leads to both.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::check::answer;
use super::contents::DEMO;
use super::facts::{NAME, VERSION};
use super::files;
use crate::process::root;

/// People who are simulated.
const PEOPLE: &str = "40";

/// Writes the folder `demonstration` and its archive.
pub fn make(program: &Path, out: &Path, work: &Path) -> Result<PathBuf> {
    let folder = out.join("demonstration");
    for old in [folder.as_path(), work] {
        if old.exists() {
            std::fs::remove_dir_all(old).with_context(|| old.display().to_string())?;
        }
    }
    std::fs::create_dir_all(work)?;
    let mimique = || {
        let mut command = Command::new(program);
        command.current_dir(root());
        command
    };
    let mut export = mimique();
    export
        .args(["export-site", DEMO, "--out"])
        .arg(folder.join("study"))
        .arg("--packs")
        .arg(work.join("packs"));
    answer(&mut export)?;
    let answers = work.join("answers");
    answer(mimique().args(["simulate", DEMO, "--participants", PEOPLE, "--out"]).arg(&answers))?;
    let mut analyze = mimique();
    analyze
        .arg("analyze")
        .arg(export_of(&answers)?)
        .args(["--study", DEMO, "--out"])
        .arg(folder.join("report"));
    answer(&mut analyze)?;
    let report = folder.join("report/report.html");
    ensure!(report.exists(), "{}: was not written", report.display());
    std::fs::write(folder.join("index.html"), first_page())?;
    let whole: Vec<_> =
        files::below(&folder)?.into_iter().map(|file| file.within("demonstration")).collect();
    let archive = out.join(format!("{NAME}-{VERSION}-demonstration.tar.gz"));
    std::fs::write(&archive, files::gzip(&files::tar(&[], &whole)?)?)
        .with_context(|| archive.display().to_string())?;
    Ok(archive)
}

/// The export that `mimique simulate` has written into a folder.
fn export_of(folder: &Path) -> Result<PathBuf> {
    let mut entries = std::fs::read_dir(folder)?.filter_map(|entry| Some(entry.ok()?.path()));
    let found = entries.find(|path| path.extension().is_some_and(|ending| ending == "csv"));
    found.with_context(|| format!("{}: no export as CSV", folder.display()))
}

fn first_page() -> String {
    format!(
        r#"<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Mimique: demonstration</title>
<style>
  body {{ max-width: 36rem; margin: 3rem auto; padding: 0 1rem; font: 1.1rem/1.5 system-ui, sans-serif; }}
  li {{ margin: 0.6rem 0; }}
</style>
<h1>Mimique {VERSION}: demonstration</h1>
<p>Mimique turns motion capture of a face into animation of an avatar, shows it live in the browser, asks people about
it, and computes the statistics.</p>
<ul>
  <li><a href="study/index.html">Take part in the demonstration study</a>. Your answers stay in this browser.</li>
  <li><a href="report/report.html">Read the report</a> of {PEOPLE} participants who were simulated: nobody has answered
  these questions.</li>
</ul>
</html>
"#
    )
}

/// Every link of the first page leads to a file, and the study has its pages, its stimuli and its description.
pub fn check(out: &Path) -> Result<()> {
    let folder = out.join("demonstration");
    let page = String::from_utf8(files::read(&folder.join("index.html"))?)?;
    for link in page.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
        ensure!(folder.join(link).is_file(), "index.html: {link} is not there");
    }
    for part in ["study/site.json", "study/assets", "study/packs"] {
        ensure!(folder.join(part).exists(), "{part} is not there");
    }
    Ok(())
}
