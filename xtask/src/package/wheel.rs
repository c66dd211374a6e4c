//! The wheel: `pip install mimique` and `uvx mimique` put the program on the path. It holds the program as a script and
//! no line of Python; `wheel pack` writes the record and the file's name.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, anyhow};

use super::check::{self, Placed, answer};
use super::contents::{DEMO, readme_and_demo};
use super::facts::{LICENCE, NAME, PUBLISHER, REPOSITORY, SUMMARY, VERSION};
use super::files::{self, File};
use super::target::{Runner, Target};
use super::{Program, build};
use crate::tally::Tried;

/// Packs the wheel.
pub fn make(program: &Program, out: &Path, work: &Path) -> Result<PathBuf> {
    let python = build::python()?.map_err(|remedy| anyhow!("no Python: {remedy}"))?;
    let folder = work.join(format!("{NAME}-{VERSION}"));
    files::write_below(&folder, &whole(program)?)?;
    let mut pack = Command::new(python);
    pack.args(["-m", "wheel", "pack"]).arg(&folder).arg("--dest-dir").arg(out);
    answer(pack.env("SOURCE_DATE_EPOCH", files::epoch().to_string()))?;
    let path = out.join(name(program.target));
    anyhow::ensure!(path.exists(), "{}: `wheel pack` has written another name", path.display());
    Ok(path)
}

/// The file's name: all tags of the target as one.
fn name(target: &Target) -> String {
    let platform = |tag: &&str| tag.trim_start_matches("py3-none-").to_owned();
    let mut platforms: Vec<String> = target.wheel_tags.iter().map(platform).collect();
    platforms.sort();
    format!("{NAME}-{VERSION}-py3-none-{}.whl", platforms.join("."))
}

/// Everything in the wheel but its record.
fn whole(program: &Program) -> Result<Vec<File>> {
    let target = program.target;
    let information = format!("{NAME}-{VERSION}.dist-info");
    let [readme, demo] =
        <[File; 2]>::try_from(readme_and_demo()?).map_err(|_| anyhow!("a page and a study"))?;
    let licences: Vec<&str> =
        program.terms.licences.iter().map(|file| file.name.as_str()).collect();
    let metadata = metadata(&licences, &String::from_utf8_lossy(&readme.bytes));
    let mut whole = vec![
        File::program(
            format!("{NAME}-{VERSION}.data/scripts/{}", target.program()),
            program.bytes.clone(),
        ),
        demo.within(&format!("{NAME}-{VERSION}.data/data/share/{NAME}")),
        File::text(format!("{information}/METADATA"), metadata),
        File::text(format!("{information}/WHEEL"), tags(target)),
    ];
    for licence in &program.terms.licences {
        whole.push(licence.clone().within(&format!("{information}/licenses")));
    }
    // Where PEP 770 wants bills of materials.
    whole.push(program.terms.bill.clone().within(&format!("{information}/sboms")));
    Ok(whole)
}

fn metadata(licences: &[&str], description: &str) -> String {
    let files: String = licences.iter().map(|name| format!("License-File: {name}\n")).collect();
    format!(
        "Metadata-Version: 2.4\nName: {NAME}\nVersion: {VERSION}\nSummary: {SUMMARY}\nAuthor: {PUBLISHER}\n\
         License-Expression: {LICENCE}\n{files}Project-URL: Repository, {REPOSITORY}\nRequires-Python: >=3.8\n\
         Description-Content-Type: text/markdown\n\n{description}"
    )
}

fn tags(target: &Target) -> String {
    let tags: String = target.wheel_tags.iter().map(|tag| format!("Tag: {tag}\n")).collect();
    format!(
        "Wheel-Version: 1.0\nGenerator: cargo-xtask-package {VERSION}\nRoot-Is-Purelib: false\n{tags}"
    )
}

/// Installs it by pip into a fresh environment and by uv, and runs it; a wheel of another processor is unpacked.
pub fn check(program: &Program, wheel: &Path, work: &Path) -> Result<Tried> {
    let python = build::python()?.map_err(|remedy| anyhow!("no Python: {remedy}"))?;
    let target = program.target;
    std::fs::create_dir_all(work)?;
    if !matches!(target.runner(), Runner::Directly) {
        answer(
            Command::new(&python)
                .args(["-m", "wheel", "unpack"])
                .arg(wheel)
                .arg("--dest")
                .arg(work),
        )?;
        let data = work.join(format!("{NAME}-{VERSION}/{NAME}-{VERSION}.data"));
        let (path, study) = (
            data.join("scripts").join(target.program()),
            data.join("data/share").join(NAME).join(DEMO),
        );
        let ran = check::placed(&Placed { program, path: &path, study: &study })?;
        let Tried::InPart(why) = ran else { return Ok(ran) };
        return Ok(Tried::InPart(format!(
            "unpacked, since pip takes wheels of its own processor alone; {why}"
        )));
    }
    let environment = work.join("environment");
    answer(Command::new(&python).args(["-m", "venv"]).arg(&environment))?;
    let programs = environment.join(if cfg!(windows) { "Scripts" } else { "bin" });
    let mut pip = Command::new(programs.join("python"));
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-index"]);
    answer(pip.arg(wheel))?;
    let study = environment.join("share").join(NAME).join(DEMO);
    check::placed(&Placed { program, path: &programs.join(target.program()), study: &study })?;

    let mut uv =
        Command::new(python.parent().context("an interpreter lies in a folder")?.join("uv"));
    uv.args(["tool", "run", "--offline", "--no-config", "--from"])
        .arg(wheel)
        .args([NAME, "--version"]);
    uv.env("UV_CACHE_DIR", work.join("uv-cache")).env("UV_TOOL_DIR", work.join("uv-tools"));
    let said = answer(&mut uv)?;
    anyhow::ensure!(said.trim() == format!("{NAME} {VERSION}"), "uv tool run: {said:?}");
    Ok(Tried::Done)
}

#[cfg(test)]
mod tests {
    use super::super::target::TARGETS;
    use super::*;

    #[test]
    fn names_and_metadata_are_as_pip_reads_them() {
        let linux = &TARGETS[0];
        assert_eq!(
            name(linux),
            format!(
                "mimique-{VERSION}-py3-none-manylinux2014_x86_64.manylinux_2_17_x86_64.musllinux_1_1_x86_64.whl"
            )
        );
        let tags = tags(linux);
        assert!(
            tags.contains("\nTag: py3-none-musllinux_1_1_x86_64\n")
                && tags.starts_with("Wheel-Version: 1.0\n")
        );
        let metadata = metadata(&["LICENSE-MIT"], "# Words");
        let (head, body) = metadata.split_once("\n\n").unwrap();
        assert!(head.lines().all(|line| line.contains(": ")), "{head}");
        assert!(
            head.contains(&format!("\nVersion: {VERSION}\n"))
                && head.contains("\nLicense-File: LICENSE-MIT\n")
        );
        assert_eq!(body, "# Words");
    }
}
