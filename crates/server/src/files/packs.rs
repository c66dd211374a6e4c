//! Stimulus packs by the SHA-256 of their bytes, held in memory with their compressed forms.
//!
//! The compressed forms are made once and kept beside the pack (`HASH.br`, `HASH.gz`).

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use axum::body::Bytes;
use mimique_storage::{Storage, StorageError};
use sha2::{Digest, Sha256};

use super::compression;
use crate::export::sources::Version;
use crate::files::static_file::StaticFile;

/// Packs in memory, by hash.
#[derive(Debug, Clone, Default)]
pub struct PackStore {
    packs: BTreeMap<String, StaticFile>,
}

/// A pack cannot be served.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    /// The file cannot be read, or its compressed form not be written.
    #[error("{path}: {error}; see that the data folder can be read and written")]
    File {
        /// The file.
        path: String,
        /// What went wrong.
        error: io::Error,
    },
    /// The bytes are not those that the name promises.
    #[error(
        "{path}: the content has hash {found}; delete the file, it is made anew at the next start"
    )]
    Damaged {
        /// The file.
        path: String,
        /// Hash of what it holds.
        found: String,
    },
}

impl PackStore {
    /// Reads the pack `folder/{hash}` once; a pack that is there already is left.
    pub fn load(&mut self, folder: &Path, hash: &str) -> Result<(), PackError> {
        if self.packs.contains_key(hash) {
            return Ok(());
        }
        let path = folder.join(hash);
        let at = |path: &Path, error| PackError::File { path: path.display().to_string(), error };
        let raw = std::fs::read(&path).map_err(|error| at(&path, error))?;
        let found = hex::encode(Sha256::digest(&raw));
        if found != hash {
            return Err(PackError::Damaged { path: path.display().to_string(), found });
        }
        let packed = |suffix: &str, compress: fn(&[u8]) -> io::Result<Option<Vec<u8>>>| {
            let path = folder.join(format!("{hash}.{suffix}"));
            kept(&path, || Ok(compress(&raw)?.unwrap_or_default()))
                .map_err(|error| at(&path, error))
        };
        let brotli = packed("br", compression::brotli)?;
        let gzip = packed("gz", compression::gzip)?;
        let file = StaticFile {
            content_type: "application/octet-stream",
            raw: Bytes::from(raw),
            brotli: Some(Bytes::from(brotli)).filter(|bytes| !bytes.is_empty()),
            gzip: Some(Bytes::from(gzip)).filter(|bytes| !bytes.is_empty()),
        };
        self.packs.insert(hash.to_owned(), file);
        Ok(())
    }

    /// Reads the packs of every version of every study in the database as far as they are still in
    /// the folder, so that sessions which began under an earlier version can go on.
    pub async fn load_earlier_versions(
        &mut self,
        storage: &Storage,
        folder: &Path,
    ) -> Result<(), StorageError> {
        for version in storage.study_versions().await? {
            let version = Version::read(&version)?;
            for clip in version.clips.values() {
                for hash in clip.packs() {
                    if let Err(error) = self.load(folder, hash) {
                        tracing::warn!("a pack of an earlier version is gone: {error}");
                    }
                }
            }
        }
        Ok(())
    }

    /// Takes over what another store holds.
    pub(crate) fn join(&mut self, other: Self) {
        self.packs.extend(other.packs);
    }

    pub(crate) fn get(&self, hash: &str) -> Option<&StaticFile> {
        self.packs.get(hash)
    }

    /// How many packs there are.
    pub fn len(&self) -> usize {
        self.packs.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.packs.is_empty()
    }
}

/// The file's content, made and written (by way of a second name, so that it is whole or absent)
/// when it is not there. An empty file says that compressing is not worth it.
fn kept(path: &Path, make: impl FnOnce() -> io::Result<Vec<u8>>) -> io::Result<Vec<u8>> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(bytes),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let bytes = make()?;
            mimique_storage::durable_file::write(path, &bytes)?;
            Ok(bytes)
        }
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::secret;

    #[test]
    fn a_damaged_pack_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let hash = secret::hash("pack");
        std::fs::write(folder.path().join(&hash), "pakc").unwrap();
        let error = PackStore::default().load(folder.path(), &hash).unwrap_err();
        assert!(matches!(error, PackError::Damaged { .. }), "{error}");
    }

    #[test]
    fn compressed_forms_are_made_once_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let text = "pack ".repeat(1000);
        let hash = secret::hash(&text);
        std::fs::write(folder.path().join(&hash), &text).unwrap();
        for _ in 0..2 {
            let mut store = PackStore::default();
            store.load(folder.path(), &hash).unwrap();
            let file = store.get(&hash).unwrap();
            assert!(file.brotli.as_ref().unwrap().len() < 100);
            assert!(file.gzip.as_ref().unwrap().len() < 100);
        }
        assert!(folder.path().join(format!("{hash}.br")).exists());
    }
}
