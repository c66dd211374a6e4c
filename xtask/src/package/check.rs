//! An installed program is used as a newcomer does: it says its version, checks a study, and serves it.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};

use super::Program;
use super::facts::{NAME, VERSION};
use super::target::Runner;
use crate::process::show;
use crate::server::Server;
use crate::tally::Tried;

/// A program in the place where its package puts it.
pub struct Placed<'a> {
    /// What was packed.
    pub program: &'a Program,
    /// Where it lies.
    pub path: &'a Path,
    /// Where the demonstration's study lies.
    pub study: &'a Path,
}

/// Holds the program against the one that was packed, and runs it: wholly where this machine's processor can, else
/// by an emulator, version and check alone.
pub fn placed(placed: &Placed) -> Result<Tried> {
    let found = super::files::read(placed.path)?;
    ensure!(
        found == placed.program.bytes,
        "{}: another program than was packed",
        placed.path.display()
    );
    let runner = placed.program.target.runner();
    let start = || runner.command(placed.path).map_err(|why| anyhow::anyhow!("{why}"));
    let study = placed.study.to_string_lossy();
    match &runner {
        Runner::Directly => {
            let data = tempfile::tempdir()?;
            says_version_and_checks(&start, &study)?;
            serves(&mut start()?, &study, &data.path().to_string_lossy())?;
            Ok(Tried::Done)
        }
        Runner::By(emulator) => {
            says_version_and_checks(&start, &study)?;
            Ok(Tried::InPart(format!("run by {emulator}: version and check, not the server")))
        }
        Runner::No(why) => {
            Ok(Tried::InPart(format!("it holds the right program, which was not run: {why}")))
        }
    }
}

/// `mimique --version` and `mimique check`.
pub fn says_version_and_checks(start: &dyn Fn() -> Result<Command>, study: &str) -> Result<()> {
    let said = answer(start()?.arg("--version"))?;
    ensure!(
        said.trim() == format!("{NAME} {VERSION}"),
        "--version: {said:?} instead of {NAME} {VERSION}"
    );
    answer(start()?.args(["check", study]))?;
    Ok(())
}

/// `mimique serve` on loopback, asked whether it lives and for the participant's page, which is embedded in it.
pub fn serves(serve: &mut Command, study: &str, data: &str) -> Result<()> {
    serve.args([
        "serve",
        study,
        "--database",
        &format!("sqlite:{data}/answers.sqlite"),
        "--data-dir",
        data,
    ]);
    let (server, _) = Server::start(serve)?;
    let (_, page) = server.read("/s/demo/")?;
    ensure!(page.contains("<html"), "/s/demo/: no page: {page}");
    Ok(())
}

/// The standard output of a command, or an error with what it said.
pub fn answer(command: &mut Command) -> Result<String> {
    let shown = show(command);
    let done = command.output().with_context(|| format!("could not start: {shown}"))?;
    if !done.status.success() {
        bail!(
            "failed ({}): {shown}\n{}{}",
            done.status,
            String::from_utf8_lossy(&done.stdout),
            String::from_utf8_lossy(&done.stderr)
        );
    }
    Ok(String::from_utf8_lossy(&done.stdout).into_owned())
}
