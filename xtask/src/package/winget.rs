//! The three manifests of winget: the version, its installer (the zip of the release, by its SHA-256) and its texts.

use std::path::Path;

use anyhow::{Context, Result};

use super::checksums::Sums;
use super::facts::{LICENCE, PUBLISHER, REPOSITORY, SUMMARY, VERSION, release_address};
use super::target::{TARGETS, Target};
use crate::tally::Tried;

const IDENTIFIER: &str = "Mimique.Mimique";
const FORM: &str = "1.6.0";

/// Writes the manifests, where the archive of Windows is there.
pub fn make(out: &Path) -> Result<Tried> {
    let target = windows()?;
    let Some(sum) = Sums::of(out)?.get(&target.archive()).map(str::to_owned) else {
        return Ok(Tried::Not(format!(
            "{} is not in {}; the release workflow builds it on Windows",
            target.archive(),
            out.display()
        )));
    };
    let folder = out.join("winget");
    std::fs::create_dir_all(&folder)?;
    for (name, text) in manifests(target, &sum) {
        std::fs::write(folder.join(&name), text).context(name)?;
    }
    Ok(Tried::Done)
}

fn windows() -> Result<&'static Target> {
    TARGETS.iter().find(|target| target.is_windows()).context("no target is Windows")
}

/// File names and texts.
fn manifests(target: &Target, sum: &str) -> [(String, String); 3] {
    let head = |kind: &str, text: String| {
        format!(
            "PackageIdentifier: {IDENTIFIER}\nPackageVersion: {VERSION}\n{text}ManifestType: {kind}\n\
             ManifestVersion: {FORM}\n"
        )
    };
    let installer = format!(
        "InstallerType: zip\nNestedInstallerType: portable\nNestedInstallerFiles:\n  \
         - RelativeFilePath: {}\\{}\n    PortableCommandAlias: mimique\nInstallers:\n  - Architecture: x64\n    \
         InstallerUrl: {}\n    InstallerSha256: {}\n",
        target.archive_stem(),
        target.program(),
        release_address(&target.archive()),
        sum.to_uppercase()
    );
    let texts = format!(
        "PackageLocale: en-US\nPublisher: {PUBLISHER}\nPackageName: Mimique\nPackageUrl: {REPOSITORY}\n\
         License: {LICENCE}\nShortDescription: \"{SUMMARY}\"\n"
    );
    [
        (format!("{IDENTIFIER}.yaml"), head("version", "DefaultLocale: en-US\n".to_owned())),
        (format!("{IDENTIFIER}.installer.yaml"), head("installer", installer)),
        (format!("{IDENTIFIER}.locale.en-US.yaml"), head("defaultLocale", texts)),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::yaml;
    use super::*;

    #[test]
    fn manifests_are_yaml_with_version_address_and_hash() {
        let target = windows().unwrap();
        let [version, installer, texts] =
            manifests(target, &"ab".repeat(32)).map(|(_, text)| yaml::read(&text));
        for (manifest, kind) in
            [(&version, "version"), (&installer, "installer"), (&texts, "defaultLocale")]
        {
            assert_eq!(manifest["PackageVersion"].as_str(), Some(VERSION));
            assert_eq!(manifest["ManifestType"].as_str(), Some(kind));
        }
        let download = &installer["Installers"][0];
        assert_eq!(
            download["InstallerUrl"].as_str(),
            Some(release_address(&target.archive()).as_str())
        );
        assert_eq!(download["InstallerSha256"].as_str(), Some("AB".repeat(32).as_str()));
        let file = format!("{}\\mimique.exe", target.archive_stem());
        assert_eq!(
            installer["NestedInstallerFiles"][0]["RelativeFilePath"].as_str(),
            Some(file.as_str())
        );
        assert_eq!(texts["ShortDescription"].as_str(), Some(SUMMARY));
    }
}
