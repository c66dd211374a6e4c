//! The Debian package: a static program needs no other package, so that one file serves every Debian and Ubuntu.
//! `dpkg-deb` packs it.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, anyhow, ensure};

use super::Program;
use super::check::{self, Placed, answer};
use super::contents::{DEMO, readme_and_demo};
use super::facts::{LICENCE, MAINTAINER_MAIL, NAME, PUBLISHER, REPOSITORY, SUMMARY, VERSION};
use super::files::{self, File};
use crate::install::{self, Found};
use crate::tally::Tried;

const DOCUMENTS: &str = "usr/share/doc/mimique";

/// Packs it.
pub fn make(program: &Program, out: &Path, work: &Path) -> Result<PathBuf> {
    if let Found::No(remedy) = install::DPKG.ensure() {
        return Err(anyhow!("no dpkg-deb: {remedy}"));
    }
    let architecture = program.target.architecture.context("Debian packages are of Linux alone")?;
    let mut whole = vec![File::program(format!("usr/bin/{NAME}"), program.bytes.clone())];
    for file in readme_and_demo()? {
        let folder =
            if file.name == DEMO { format!("usr/share/{NAME}") } else { DOCUMENTS.to_owned() };
        whole.push(file.within(&folder));
    }
    whole.extend(program.terms.files().into_iter().map(|file| file.within(DOCUMENTS)));
    whole.push(File::text(format!("{DOCUMENTS}/copyright"), copyright()));
    let unit = File::of_repository("mimique.service", "docs/guide/deployment/mimique.service")?;
    whole.push(unit.within(&format!("{DOCUMENTS}/examples")));
    let bytes: usize = whole.iter().map(|file| file.bytes.len()).sum();
    whole.push(File::text("DEBIAN/control", control(architecture, bytes.div_ceil(1024))));
    let folder = work.join("debian");
    files::write_below(&folder, &whole)?;
    let path = out.join(format!("{NAME}_{VERSION}_{architecture}.deb"));
    let mut pack = Command::new("dpkg-deb");
    pack.args(["--root-owner-group", "--build"]).arg(&folder).arg(&path);
    answer(pack.env("SOURCE_DATE_EPOCH", files::epoch().to_string()))?;
    Ok(path)
}

fn control(architecture: &str, kilobytes: usize) -> String {
    format!(
        "Package: {NAME}\nVersion: {VERSION}\nArchitecture: {architecture}\nMaintainer: {PUBLISHER} <{MAINTAINER_MAIL}>\n\
         Installed-Size: {kilobytes}\nSection: science\nPriority: optional\nHomepage: {REPOSITORY}\n\
         Description: {SUMMARY}\n Mimique turns motion capture of a face into animation of an avatar, shows it live in the\n \
         browser, asks people about it, keeps every answer, and computes the statistics.\n"
    )
}

fn copyright() -> String {
    let licence = LICENCE.replace(" OR ", " or ");
    format!(
        "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: {NAME}\n\
         Source: {REPOSITORY}\n\nFiles: *\nCopyright: {PUBLISHER}\nLicense: {licence}\n \
         The texts are in LICENSE-MIT and LICENSE-APACHE beside this file; those of what the program is made of are in\n \
         THIRD-PARTY-LICENCES.txt.\n"
    )
}

/// Installs it by dpkg below a folder that stands for the whole system, and runs the program.
pub fn check(program: &Program, package: &Path, work: &Path) -> Result<Tried> {
    let architecture = program.target.architecture.context("Debian packages are of Linux alone")?;
    let said = answer(Command::new("dpkg-deb").arg("--field").arg(package).args([
        "Package",
        "Version",
        "Architecture",
    ]))?;
    let expected = format!("Package: {NAME}\nVersion: {VERSION}\nArchitecture: {architecture}\n");
    ensure!(said == expected, "{}: {said:?} instead of {expected:?}", package.display());
    let system = work.join("system");
    for folder in ["var/lib/dpkg/info", "var/lib/dpkg/updates"] {
        std::fs::create_dir_all(system.join(folder))?;
    }
    std::fs::write(system.join("var/lib/dpkg/status"), "")?;
    let mut install = Command::new("dpkg");
    install
        .arg(format!("--root={}", system.display()))
        .args(["--force-not-root", "--force-architecture"]);
    answer(install.arg("--install").arg(package))?;
    let study = system.join("usr/share").join(NAME).join(DEMO);
    check::placed(&Placed { program, path: &system.join("usr/bin").join(NAME), study: &study })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_control_file_has_what_dpkg_asks_for() {
        let text = control("arm64", 7);
        for line in
            ["Package: mimique", "Architecture: arm64", "Installed-Size: 7", "Priority: optional"]
        {
            assert!(text.lines().any(|found| found == line), "{line}: {text}");
        }
        assert!(
            text.contains(&format!("\nVersion: {VERSION}\n")) && text.ends_with('\n'),
            "{text}"
        );
        // Lines that go on begin with a space.
        let after = text.split_once("\nDescription: ").unwrap().1;
        assert!(after.lines().skip(1).all(|line| line.starts_with(' ')), "{after}");
    }
}
