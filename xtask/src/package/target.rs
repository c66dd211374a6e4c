//! What packages are made for: a row per system and processor, with the name that each kind of package has for it.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Result, bail};

use super::facts::{NAME, VERSION};
use crate::install::{self, Found};
use crate::process::target;

/// A system and processor.
#[derive(Debug, PartialEq, Eq)]
pub struct Target {
    /// rustc's name.
    pub triple: &'static str,
    /// The kernel's name of the processor (`uname -m`).
    pub processor: &'static str,
    /// The name that Debian and container images have for the processor; of Linux alone.
    pub architecture: Option<&'static str>,
    /// The tags of a wheel: the static binary of Linux runs with either C library.
    pub wheel_tags: &'static [&'static str],
}

/// Every target, the two that Linux builds first.
pub const TARGETS: [Target; 5] = [
    Target {
        triple: "x86_64-unknown-linux-musl",
        processor: "x86_64",
        architecture: Some("amd64"),
        wheel_tags: &[
            "py3-none-manylinux2014_x86_64",
            "py3-none-manylinux_2_17_x86_64",
            "py3-none-musllinux_1_1_x86_64",
        ],
    },
    Target {
        triple: "aarch64-unknown-linux-musl",
        processor: "aarch64",
        architecture: Some("arm64"),
        wheel_tags: &[
            "py3-none-manylinux2014_aarch64",
            "py3-none-manylinux_2_17_aarch64",
            "py3-none-musllinux_1_1_aarch64",
        ],
    },
    Target {
        triple: "aarch64-apple-darwin",
        processor: "aarch64",
        architecture: None,
        wheel_tags: &["py3-none-macosx_11_0_arm64"],
    },
    Target {
        triple: "x86_64-apple-darwin",
        processor: "x86_64",
        architecture: None,
        wheel_tags: &["py3-none-macosx_10_12_x86_64"],
    },
    Target {
        triple: "x86_64-pc-windows-msvc",
        processor: "x86_64",
        architecture: None,
        wheel_tags: &["py3-none-win_amd64"],
    },
];

/// How a binary can be run on this machine.
pub enum Runner {
    /// As it is.
    Directly,
    /// By an emulator of its processor.
    By(String),
    /// It cannot: why.
    No(String),
}

impl Target {
    /// The target of this name.
    pub fn named(triple: &str) -> Result<&'static Self> {
        let found = TARGETS.iter().find(|target| target.triple == triple);
        let Some(found) = found else {
            let names: Vec<&str> = TARGETS.iter().map(|target| target.triple).collect();
            bail!(
                "--target: no packages are made for {triple}; choose one of: {}",
                names.join(", ")
            );
        };
        Ok(found)
    }

    /// What this machine builds when nothing else is said: on Linux both static binaries, elsewhere its own.
    pub fn of_this_machine() -> Result<Vec<&'static Self>> {
        let own: Vec<&Self> = if cfg!(target_os = "linux") {
            TARGETS.iter().filter(|target| target.is_linux()).collect()
        } else {
            TARGETS
                .iter()
                .filter(|target| target.is_of_this_system() && target.is_of_this_processor())
                .collect()
        };
        if own.is_empty() {
            bail!(
                "no packages are made for {} on {}; name another by --target",
                std::env::consts::OS,
                std::env::consts::ARCH
            );
        }
        Ok(own)
    }

    /// Whether it is a static binary of Linux.
    pub fn is_linux(&self) -> bool {
        self.triple.ends_with("-linux-musl")
    }

    /// Whether it is macOS.
    pub fn is_macos(&self) -> bool {
        self.triple.ends_with("-apple-darwin")
    }

    /// Whether it is Windows.
    pub fn is_windows(&self) -> bool {
        self.triple.contains("-windows-")
    }

    fn is_of_this_system(&self) -> bool {
        (cfg!(target_os = "linux") && self.is_linux())
            || (cfg!(target_os = "macos") && self.is_macos())
            || (cfg!(target_os = "windows") && self.is_windows())
    }

    fn is_of_this_processor(&self) -> bool {
        self.processor == std::env::consts::ARCH
    }

    /// The file name of the program.
    pub fn program(&self) -> &'static str {
        if self.is_windows() { "mimique.exe" } else { "mimique" }
    }

    /// Where cargo puts the program.
    pub fn binary(&self) -> PathBuf {
        target().join(self.triple).join("release").join(self.program())
    }

    /// Name of the archive and of the folder in it: as `crates/mimique/Cargo.toml` gives it to `cargo binstall`.
    pub fn archive_stem(&self) -> String {
        format!("{NAME}-{VERSION}-{}", self.triple)
    }

    /// File name of the archive.
    pub fn archive(&self) -> String {
        format!("{}.{}", self.archive_stem(), if self.is_windows() { "zip" } else { "tar.gz" })
    }

    /// How its program is run here; asks for an emulator where one is needed.
    pub fn runner(&self) -> Runner {
        if !self.is_of_this_system() {
            return Runner::No(format!(
                "a program of {} does not run on {}",
                self.triple,
                std::env::consts::OS
            ));
        }
        if self.is_of_this_processor() {
            return Runner::Directly;
        }
        if !self.is_linux() {
            return Runner::No(format!("this machine's processor is {}", std::env::consts::ARCH));
        }
        match install::QEMU.ensure() {
            Found::Yes => Runner::By(format!("qemu-{}", self.processor)),
            Found::No(remedy) => Runner::No(format!("no emulator of {}: {remedy}", self.processor)),
        }
    }
}

impl Runner {
    /// A command that runs this program, or why there is none.
    pub fn command(&self, program: &std::path::Path) -> std::result::Result<Command, &str> {
        match self {
            Self::Directly => Ok(Command::new(program)),
            Self::By(emulator) => {
                let mut command = Command::new(emulator);
                command.arg(program);
                Ok(command)
            }
            Self::No(why) => Err(why),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_target_has_names_of_its_own() {
        for target in &TARGETS {
            assert_eq!(Target::named(target.triple).unwrap(), target);
            assert_eq!(target.architecture.is_some(), target.is_linux(), "{}", target.triple);
            assert!(!target.wheel_tags.is_empty(), "{}", target.triple);
            assert!(target.archive().starts_with(&target.archive_stem()));
            assert!(target.triple.starts_with(target.processor));
        }
        let refused = Target::named("sparc-sun-solaris").unwrap_err().to_string();
        assert!(
            refused.contains("sparc-sun-solaris") && refused.contains("aarch64-apple-darwin"),
            "{refused}"
        );
    }

    /// What `cargo binstall` makes of its templates is the name of an archive.
    #[test]
    fn cargo_binstall_finds_the_archives() {
        let manifest = crate::process::root().join("crates/mimique/Cargo.toml");
        let text = std::fs::read_to_string(manifest).unwrap();
        let value = |key: &str| {
            let line =
                text.lines().find(|line| line.starts_with(&format!("{key} = "))).expect("the key");
            line.split('"').nth(1).expect("a text").to_owned()
        };
        for target in &TARGETS {
            let (suffix, ending) =
                if target.is_windows() { (".zip", ".exe") } else { (".tar.gz", "") };
            let filled = |template: String| {
                let values = [
                    ("{ repo }", super::super::facts::REPOSITORY),
                    ("{ name }", NAME),
                    ("{ version }", VERSION),
                    ("{ target }", target.triple),
                    // Of the format tgz it tries .tgz and .tar.gz.
                    ("{ archive-suffix }", suffix),
                    ("{ bin }", NAME),
                    ("{ binary-ext }", ending),
                ];
                values.iter().fold(template, |text, (name, value)| text.replace(name, value))
            };
            let address = super::super::facts::release_address(&target.archive());
            assert_eq!(filled(value("pkg-url")), address);
            assert_eq!(
                filled(value("bin-dir")),
                format!("{}/{}", target.archive_stem(), target.program())
            );
        }
    }
}
