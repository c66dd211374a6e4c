//! Files that are there whole or not at all.

use std::path::{Path, PathBuf};

use anyhow::anyhow;

/// Write a file beside its place, then move it there.
///
/// # Errors
/// What the operating system says, with the file's name and what to check.
pub fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let blame = |e: std::io::Error| {
        anyhow!("{}: write: {e}; check the folder and its permissions", path.display())
    };
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let part = PathBuf::from(name);
    let done = std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, path));
    done.map_err(|e| {
        let _ = std::fs::remove_file(&part);
        blame(e)
    })
}
