//! `manifest-sha256.txt`: a line for each file, hash and path, as `sha256sum --check` reads it.

use crate::file::DepositFile;

/// The manifest of these files, by path.
pub(crate) fn manifest(files: &[DepositFile]) -> String {
    let mut lines: Vec<(&str, &str)> =
        files.iter().map(|file| (&*file.path, &*file.sha256)).collect();
    lines.sort_unstable();
    lines.into_iter().map(|(path, hash)| format!("{hash}  {path}\n")).collect()
}
