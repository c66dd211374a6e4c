//! The formula of Homebrew, for macOS and Linux: it downloads the archives of the release, which it names by their
//! SHA-256. Which archives there are is seen in the folder of the packages.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use super::check::answer;
use super::checksums::Sums;
use super::facts::{REPOSITORY, SUMMARY, VERSION, release_address};
use super::target::{TARGETS, Target};
use crate::install::{self, Found};
use crate::tally::Tried;

const FILE: &str = "mimique.rb";

/// Writes the formula; in part where an archive of a system is not there.
pub fn make(out: &Path) -> Result<Tried> {
    let sums = Sums::of(out)?;
    std::fs::write(path(out), formula(&sums)?).context(FILE)?;
    let missing: Vec<String> =
        of_homebrew().map(Target::archive).filter(|name| sums.get(name).is_none()).collect();
    if missing.is_empty() {
        return Ok(Tried::Done);
    }
    Ok(Tried::InPart(format!(
        "the formula leaves these out, which are not in {}: {}; the release workflow builds them on their own system",
        out.display(),
        missing.join(", ")
    )))
}

/// Where the formula lies.
pub fn path(out: &Path) -> PathBuf {
    out.join(FILE)
}

fn of_homebrew() -> impl Iterator<Item = &'static Target> {
    TARGETS.iter().filter(|target| !target.is_windows())
}

fn formula(sums: &Sums) -> Result<String> {
    let mut downloads = String::new();
    for (system, is_of_system) in
        [("macos", Target::is_macos as fn(&Target) -> bool), ("linux", Target::is_linux)]
    {
        let mut of_system = String::new();
        for target in of_homebrew().filter(|target| is_of_system(target)) {
            let archive = target.archive();
            let Some(sum) = sums.get(&archive) else { continue };
            let processor = if target.processor == "aarch64" { "arm" } else { "intel" };
            let address = release_address(&archive);
            write!(
                of_system,
                "    on_{processor} do\n      url \"{address}\"\n      sha256 \"{sum}\"\n    end\n"
            )?;
        }
        if !of_system.is_empty() {
            write!(downloads, "  on_{system} do\n{of_system}  end\n\n")?;
        }
    }
    if downloads.is_empty() {
        bail!(
            "{FILE}: no archive is there; make them first (`cargo xtask package --only archive,homebrew`)"
        );
    }
    Ok(format!(
        r##"class Mimique < Formula
  desc "{SUMMARY}"
  homepage "{REPOSITORY}"
  version "{VERSION}"
  license any_of: ["MIT", "Apache-2.0"]

{downloads}  def install
    bin.install "mimique"
    pkgshare.install "study-config"
    doc.install "README.md", "LICENSE-APACHE", "LICENSE-MIT", "THIRD-PARTY-LICENCES.txt", "sbom.cdx.json"
  end

  test do
    assert_match version.to_s, shell_output("#{{bin}}/mimique --version")
    system bin/"mimique", "check", pkgshare/"study-config/demo.json"
  end
end
"##
    ))
}

/// Has Ruby read the formula: Homebrew itself is not installed for it.
pub fn check(out: &Path) -> Result<Tried> {
    if let Found::No(remedy) = install::RUBY.ensure() {
        return Ok(Tried::Not(format!("no Ruby: {remedy}")));
    }
    answer(Command::new("ruby").args(["-wc"]).arg(path(out)))?;
    Ok(Tried::InPart("Ruby reads it; Homebrew is not installed for it".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_formula_names_every_archive_that_is_there() {
        let archives: Vec<String> = of_homebrew().map(Target::archive).collect();
        let sums = Sums::from_iter(
            archives.iter().enumerate().map(|(k, name)| (name.clone(), format!("{k:064}"))),
        );
        let text = formula(&sums).unwrap();
        for (k, name) in archives.iter().enumerate() {
            let pair = format!("url \"{}\"\n      sha256 \"{k:064}\"", release_address(name));
            assert!(text.contains(&pair), "{pair}\n{text}");
        }
        assert!(
            text.contains(&format!("version \"{VERSION}\""))
                && text.contains("#{bin}/mimique --version")
        );
        assert_eq!(
            text.matches(" do\n").count() + text.matches("def ").count() + 1,
            text.matches("end\n").count()
        );
    }

    #[test]
    fn a_system_without_an_archive_is_left_out() {
        let linux = TARGETS[0].archive();
        let text = formula(&Sums::from_iter([(linux, "0".repeat(64))])).unwrap();
        assert!(text.contains("on_linux") && !text.contains("on_macos"), "{text}");
        let refused = formula(&Sums::from_iter([])).unwrap_err().to_string();
        assert!(refused.contains("no archive is there"), "{refused}");
    }
}
