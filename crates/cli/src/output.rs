//! Files and folders that are there whole or not at all.

use std::io::Write;
use std::path::Path;

use anyhow::anyhow;
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
