//! `cargo xtask package`: everything that people install, made into `target/package`, and with `--check` installed into
//! a temporary place and run.
//!
//! | kind | what |
//! |---|---|
//! | `archive` | program, study, licences, bill of materials; what Homebrew, winget and `cargo binstall` download |
//! | `wheel` | `mimique` for pip and uvx |
//! | `debian` | the Debian package |
//! | `image` | the container image |
//! | `npm` | `@mimique/stage`: element, canvas and solver for other pages; `@mimique/jspsych-plugin` |
//! | `site` | the demonstration as plain files, with the report of simulated participants |
//! | `homebrew`, `winget` | manifests that name the archives by their SHA-256 |
//!
//! What cannot be made or run here is named at the end, with the reason; `MIMIQUE_NO_SKIP=1` makes it a failure.

mod archive;
mod build;
mod check;
mod checksums;
mod contents;
mod debian;
mod dependencies;
mod facts;
mod files;
mod homebrew;
mod image;
mod licences;
mod npm;
mod sbom;
mod site;
mod target;
mod wheel;
mod winget;
#[cfg(test)]
mod yaml;

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use self::checksums::Sums;
use self::contents::Terms;
use self::target::{Runner, Target};
use crate::process::{say, target};
use crate::tally::{Tally, Tried};
use crate::web;

/// Options of `cargo xtask package`.
#[derive(clap::Args)]
pub struct Args {
    /// Make only these
    #[arg(long, value_enum, value_delimiter = ',')]
    only: Vec<Kind>,
    /// Make packages of these targets; without it on Linux both static ones, elsewhere this machine's own
    #[arg(long, value_delimiter = ',')]
    target: Vec<String>,
    /// Take pages and programs as they were built last
    #[arg(long)]
    built: bool,
    /// Install each package into a temporary place and run what it holds
    #[arg(long)]
    check: bool,
}

/// A kind of package.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Kind {
    Archive,
    Wheel,
    Debian,
    Image,
    Npm,
    Site,
    Homebrew,
    Winget,
}

impl Kind {
    /// Those that hold a target's program.
    const OF_PROGRAMS: [Self; 4] = [Self::Archive, Self::Wheel, Self::Debian, Self::Image];

    fn name(self) -> &'static str {
        match self {
            Self::Archive => "archive",
            Self::Wheel => "wheel",
            Self::Debian => "Debian package",
            Self::Image => "container image",
            Self::Npm => "npm packages",
            Self::Site => "demonstration",
            Self::Homebrew => "formula of Homebrew",
            Self::Winget => "manifests of winget",
        }
    }

    fn make(self, program: &Program, out: &Path, work: &Path) -> Result<PathBuf> {
        match self {
            Self::Wheel => wheel::make(program, out, work),
            Self::Debian => debian::make(program, out, work),
            Self::Image => image::make(program, out),
            _ => archive::make(program, out),
        }
    }

    fn check(self, program: &Program, package: &Path, work: &Path) -> Result<Tried> {
        match self {
            Self::Wheel => wheel::check(program, package, work),
            Self::Debian => debian::check(program, package, work),
            Self::Image => image::check(program, package, work),
            _ => archive::check(program, package, work),
        }
    }
}

/// A program that was built, and its terms.
pub struct Program {
    /// What it was built for.
    pub target: &'static Target,
    /// Where it lies.
    pub path: PathBuf,
    /// What packages hold.
    pub bytes: Vec<u8>,
    /// Licences and bill of materials.
    pub terms: Terms,
}

/// Makes, checks, and says what was not.
pub fn run(args: &Args) -> Result<()> {
    let targets = match args.target.as_slice() {
        [] => Target::of_this_machine()?,
        named => named.iter().map(|triple| Target::named(triple)).collect::<Result<_>>()?,
    };
    let out = target().join("package");
    std::fs::create_dir_all(&out).with_context(|| out.display().to_string())?;
    let mut packaging = Packaging { args, out, tally: Tally::default(), programs: Vec::new() };
    packaging.all(&targets)?;
    if !packaging.tally.close(std::env::var_os("MIMIQUE_NO_SKIP").is_none_or(|value| value != "1"))
    {
        bail!("not every package is there and runs");
    }
    Ok(())
}

struct Packaging<'a> {
    args: &'a Args,
    out: PathBuf,
    tally: Tally,
    programs: Vec<Program>,
}

impl Packaging<'_> {
    fn all(&mut self, targets: &[&'static Target]) -> Result<()> {
        let of_programs = Kind::OF_PROGRAMS.iter().any(|kind| self.wants(*kind));
        let needs_pages = of_programs || self.wants(Kind::Npm) || self.wants(Kind::Site);
        if needs_pages && !self.args.built {
            self.tally.done("pages", || web::all(false));
        }
        if of_programs || self.wants(Kind::Site) {
            for target in targets {
                self.program(target);
            }
        }
        for kind in Kind::OF_PROGRAMS {
            if self.wants(kind) {
                self.of_programs(kind)?;
            }
        }
        if self.wants(Kind::Npm) {
            self.npm()?;
        }
        if self.wants(Kind::Site) {
            self.site();
        }
        if self.wants(Kind::Homebrew) {
            self.tally.tried(Kind::Homebrew.name(), || homebrew::make(&self.out));
            if self.args.check && homebrew::path(&self.out).exists() {
                self.tally.tried(&checked(Kind::Homebrew.name()), || homebrew::check(&self.out));
            }
        }
        if self.wants(Kind::Winget) {
            self.tally.tried(Kind::Winget.name(), || winget::make(&self.out));
        }
        let sums = Sums::of(&self.out)?;
        sums.write(&self.out)?;
        sums.list(&self.out)
    }

    fn wants(&self, kind: Kind) -> bool {
        self.args.only.is_empty() || self.args.only.contains(&kind)
    }

    /// Builds a target's program, and writes its bill of materials beside the packages, too.
    fn program(&mut self, target: &'static Target) {
        let (out, check, is_built) = (&self.out, self.args.check, self.args.built);
        let mut built = None;
        self.tally.tried(&format!("program, {}", target.triple), || {
            let path = match build::program(target, is_built)? {
                Ok(path) => path,
                Err(why) => return Ok(Tried::Not(why)),
            };
            let (bytes, terms) = (files::read(&path)?, Terms::of_program(target)?);
            let bill = out.join(format!("{}.{}", target.archive_stem(), contents::BILL));
            std::fs::write(&bill, &terms.bill.bytes).with_context(|| bill.display().to_string())?;
            built = Some((Program { target, path, bytes, terms }, bill));
            Ok(Tried::Done)
        });
        let Some((program, bill)) = built else { return };
        self.programs.push(program);
        if check {
            self.tally
                .tried(&checked(&format!("bill of materials, {}", target.triple)), || valid(&bill));
        }
    }

    fn of_programs(&mut self, kind: Kind) -> Result<()> {
        for program in &self.programs {
            if program.target.architecture.is_none() && matches!(kind, Kind::Debian | Kind::Image) {
                // Said once more by name where it was asked for by name.
                if !self.args.only.is_empty() {
                    let why = format!("{} is not Linux", program.target.triple);
                    self.tally.tried(kind.name(), || Ok(Tried::Not(why)));
                }
                continue;
            }
            let work = tempfile::tempdir()?;
            let name = format!("{}, {}", kind.name(), program.target.triple);
            let mut package = None;
            self.tally.tried(&name, || {
                package = Some(kind.make(program, &self.out, &work.path().join("make"))?);
                Ok(Tried::Done)
            });
            if let (Some(package), true) = (package, self.args.check) {
                self.tally.tried(&checked(&name), || {
                    kind.check(program, &package, &work.path().join("check"))
                });
            }
        }
        Ok(())
    }

    /// The program that this machine runs as it is.
    fn own_program(&self) -> Option<&Path> {
        let own = self
            .programs
            .iter()
            .find(|program| matches!(program.target.runner(), Runner::Directly));
        own.map(|program| program.path.as_path())
    }

    fn npm(&mut self) -> Result<()> {
        let work = tempfile::tempdir()?;
        let mut packages = None;
        self.tally.tried(Kind::Npm.name(), || {
            packages = Some(npm::make(&self.out, work.path())?);
            Ok(Tried::Done)
        });
        if let (Some(packages), true) = (packages, self.args.check) {
            // Asked for alone there is no static program: what `cargo build` left draws as well.
            let built =
                || Some(target().join("release").join(facts::NAME)).filter(|path| path.exists());
            let program = self.own_program().map(Path::to_owned).or_else(built);
            let check = || npm::check(&packages, program.as_deref(), work.path());
            self.tally.tried(&checked(Kind::Npm.name()), check);
        }
        Ok(())
    }

    fn site(&mut self) {
        let program = self.own_program().map(Path::to_owned);
        let (out, check) = (&self.out, self.args.check);
        self.tally.tried(Kind::Site.name(), || {
            let Some(program) = program else {
                return Ok(Tried::Not("no program was built that this machine runs".into()));
            };
            site::make(&program, out, &target().join("package-site"))?;
            if check {
                site::check(out)?;
            }
            Ok(Tried::Done)
        });
    }
}

fn checked(name: &str) -> String {
    format!("{name}: installed and run")
}

/// Holds a bill of materials against the schema of CycloneDX.
fn valid(bill: &Path) -> Result<Tried> {
    let python = match build::python()? {
        Ok(python) => python,
        Err(remedy) => return Ok(Tried::Not(format!("no Python: {remedy}"))),
    };
    let script = "import sys; from cyclonedx.schema import SchemaVersion; \
                  from cyclonedx.validation.json import JsonStrictValidator; \
                  sys.exit(str(JsonStrictValidator(SchemaVersion.V1_5).validate_str(open(sys.argv[1]).read()) or '') or 0)";
    check::answer(Command::new(python).args(["-c", script]).arg(bill))?;
    say("it is valid CycloneDX 1.5");
    Ok(Tried::Done)
}
