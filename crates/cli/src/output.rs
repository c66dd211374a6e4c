//! Files and folders that are there whole or not at all.

use std::fmt::Display;
use std::io::Write;
use std::path::Path;

use anyhow::{Context as _, anyhow};
use mimique_storage::durable_file;

/// Writes a file.
///
/// # Errors
/// What the operating system says, with the file's name and what to check.
pub fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    write_with(path, |file| file.write_all(bytes))
}

/// Writes a file as `fill` does.
///
/// # Errors
/// Those of [`write()`], and of `fill`.
pub fn write_with(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Result<()> {
    durable_file::write_with(path, fill).map_err(|error| {
        anyhow!(
            "{}: cannot be written ({error}); check the folder and its permissions",
            path.display()
        )
    })
}

/// Makes a folder, where it is not there.
///
/// # Errors
/// What the operating system says, with the folder's name and what to check.
pub fn make_folder(folder: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(folder).with_context(|| {
        format!("{}: make the folder; check its parent's permissions", folder.display())
    })
}

/// Writes files into a folder, each by its name, its bytes, and what is in it; each is told of on standard output, unless
/// that is to be JSON.
///
/// # Errors
/// Those of [`write()`].
pub fn write_all(
    folder: &Path,
    files: &[(String, Vec<u8>, impl Display)],
    json: bool,
) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    for (name, bytes, what) in files {
        let path = folder.join(name);
        write(&path, bytes)?;
        if !json {
            writeln!(out, "{}: {what}", path.display())?;
        }
    }
    Ok(())
}
