//! The web pages that a command serves or exports.

use std::path::Path;

use mimique_server::{Assets, AssetsError, EmbeddedFile};

/// The pages of a folder (`--web-dir`), or else those embedded in the program.
pub fn assets(folder: Option<&Path>, embedded: &[EmbeddedFile]) -> Result<Assets, AssetsError> {
    match folder {
        Some(folder) => Assets::from_folder(folder),
        None => Assets::embedded(embedded),
    }
}
