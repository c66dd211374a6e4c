//! What stands beside the program in each of its packages: licences, the bill of materials, the demonstration's study.

use anyhow::Result;

use super::dependencies::{self, Components, PAGES, Root, STAGE, WASM};
use super::facts::{NAME, STAGE as STAGE_PACKAGE};
use super::files::File;
use super::target::Target;
use super::{licences, sbom};

/// Name of the texts of all licences.
pub const LICENCES: &str = "THIRD-PARTY-LICENCES.txt";
/// Name of the bill of materials.
pub const BILL: &str = "sbom.cdx.json";
/// The demonstration's study, as packages have it.
pub const DEMO: &str = "study-config/demo.json";

/// What says under which terms a package is passed on: three licence files and the bill of materials.
pub struct Terms {
    /// The two licences of Mimique, and those of what it is made of.
    pub licences: Vec<File>,
    /// The bill of materials.
    pub bill: File,
}

impl Terms {
    /// Of the program of a target.
    pub fn of_program(target: &Target) -> Result<Self> {
        let roots: Vec<Root> =
            PAGES.iter().map(|name| (*name, WASM)).chain([(NAME, target.triple)]).collect();
        Self::of(NAME, target.triple, &dependencies::of(&roots)?)
    }

    /// Of the npm package.
    pub fn of_stage() -> Result<Self> {
        let roots: Vec<Root> = STAGE.iter().map(|name| (*name, WASM)).collect();
        Self::of(STAGE_PACKAGE, WASM, &dependencies::of(&roots)?)
    }

    fn of(name: &str, target: &str, components: &Components) -> Result<Self> {
        let licences = vec![
            File::of_repository("LICENSE-APACHE", "LICENSE-APACHE")?,
            File::of_repository("LICENSE-MIT", "LICENSE-MIT")?,
            File::text(LICENCES, licences::texts(components)?),
        ];
        let bill = File::text(BILL, sbom::cyclonedx(name, target, components)?);
        Ok(Self { licences, bill })
    }

    /// All of them.
    pub fn files(&self) -> Vec<File> {
        self.licences.iter().chain([&self.bill]).cloned().collect()
    }
}

/// The page that a package opens with, and the demonstration's study.
pub fn readme_and_demo() -> Result<Vec<File>> {
    Ok(vec![
        File::of_repository("README.md", "xtask/package/README.md")?,
        File::of_repository(DEMO, DEMO)?,
    ])
}
