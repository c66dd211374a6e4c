//! The archive of a program: what one unpacks and runs, what Homebrew, winget and `cargo binstall` download.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::Program;
use super::check::{self, Placed};
use super::contents::{DEMO, readme_and_demo};
use super::files::{self, File};
use crate::tally::Tried;

/// Writes the archive: a folder with the program, its study, licences and bill of materials.
pub fn make(program: &Program, out: &Path) -> Result<PathBuf> {
    let target = program.target;
    let mut whole = vec![File::program(target.program(), program.bytes.clone())];
    whole.extend(readme_and_demo()?);
    whole.extend(program.terms.files());
    let whole: Vec<File> =
        whole.into_iter().map(|file| file.within(&target.archive_stem())).collect();
    let bytes = if target.is_windows() {
        files::zip(&whole)?
    } else {
        files::gzip(&files::tar(&[], &whole)?)?
    };
    let path = out.join(target.archive());
    std::fs::write(&path, bytes).with_context(|| path.display().to_string())?;
    Ok(path)
}

/// Unpacks it with the system's tar, which reads zip on Windows, and runs the program.
pub fn check(program: &Program, archive: &Path, work: &Path) -> Result<Tried> {
    std::fs::create_dir_all(work)?;
    check::answer(std::process::Command::new("tar").arg("-xf").arg(archive).current_dir(work))?;
    let folder = work.join(program.target.archive_stem());
    check::placed(&Placed {
        program,
        path: &folder.join(program.target.program()),
        study: &folder.join(DEMO),
    })
}
