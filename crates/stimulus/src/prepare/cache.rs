//! The folder of packs: `HASH` holds the bytes, `keys/KEY` the hash of what was made of inputs.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use mimique_clip::{SOLVER_VERSION, sha256_hex};

use super::PrepareError;
use super::known::is_hash;
use crate::provenance::Provenance;

/// Changes when the same inputs give other packs: what was kept under old keys is not taken.
const LAYOUT: u32 = 6;

/// A pack that lies in the folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct StoredPack {
    pub hash: String,
    pub bytes: Vec<u8>,
}

/// The folder.
pub(super) struct Cache {
    folder: PathBuf,
}

impl Cache {
    pub fn open(folder: &Path) -> Result<Self, PrepareError> {
        let keys = folder.join("keys");
        fs::create_dir_all(&keys).map_err(|e| unusable(&keys, &e))?;
        Ok(Self { folder: folder.to_owned() })
    }

    /// The pack made of the inputs that `key` names; made and kept when it is not there, or not
    /// what it was.
    pub fn pack(
        &self,
        key: &Provenance,
        make: impl FnOnce() -> Result<Vec<u8>, PrepareError>,
    ) -> Result<StoredPack, PrepareError> {
        let key_file = self.key_file(key);
        if let Some(pack) = self.kept(&key_file) {
            return Ok(pack);
        }
        let pack = self.store(make()?)?;
        write(&key_file, pack.hash.as_bytes())?;
        Ok(pack)
    }

    /// A text that was kept under a key.
    pub fn note(&self, key: &Provenance) -> Option<String> {
        fs::read_to_string(self.key_file(key)).ok()
    }

    /// Keeps a text under a key.
    pub fn keep_note(&self, key: &Provenance, text: &str) -> Result<(), PrepareError> {
        write(&self.key_file(key), text.as_bytes())
    }

    /// Whether a pack is there, and what it was.
    pub fn holds(&self, hash: &str) -> bool {
        is_hash(hash) && fs::read(self.folder.join(hash)).is_ok_and(|b| sha256_hex(&b) == hash)
    }

    /// The file of a key.
    fn key_file(&self, key: &Provenance) -> PathBuf {
        let key = key.clone().json("layout", LAYOUT).json("solver", SOLVER_VERSION);
        self.folder.join("keys").join(key.hash())
    }

    /// Keeps a pack under its hash.
    pub fn store(&self, bytes: Vec<u8>) -> Result<StoredPack, PrepareError> {
        let hash = sha256_hex(&bytes);
        let path = self.folder.join(&hash);
        if fs::read(&path).ok().as_ref() != Some(&bytes) {
            write(&path, &bytes)?;
        }
        Ok(StoredPack { hash, bytes })
    }

    fn kept(&self, key_file: &Path) -> Option<StoredPack> {
        let hash = fs::read_to_string(key_file).ok()?;
        // A damaged key must not lead out of the folder.
        if !is_hash(&hash) {
            return None;
        }
        let bytes = fs::read(self.folder.join(&hash)).ok()?;
        (sha256_hex(&bytes) == hash).then_some(StoredPack { hash, bytes })
    }
}

/// Writes a file that is whole or absent: under a second name first, then renamed.
fn write(path: &Path, bytes: &[u8]) -> Result<(), PrepareError> {
    static NUMBER: AtomicU64 = AtomicU64::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let temporary = path.with_extension(format!("{}-{number}.part", std::process::id()));
    let written = fs::File::create(&temporary)
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.sync_all()
        })
        .and_then(|()| fs::rename(&temporary, path));
    written.map_err(|e| {
        let _ = fs::remove_file(&temporary);
        unusable(path, &e)
    })
}

fn unusable(path: &Path, error: &std::io::Error) -> PrepareError {
    PrepareError::new(
        "",
        format!("{}: {error}; give a data folder that can be written", path.display()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pack_is_made_once_and_again_when_it_is_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::open(folder.path()).unwrap();
        let mut made = 0;
        let mut get = || {
            cache
                .pack(&Provenance::default().json("a", "b"), || {
                    made += 1;
                    Ok(b"pack".to_vec())
                })
                .unwrap()
        };
        let first = get();
        assert_eq!(get(), first);
        assert_eq!(first.hash, sha256_hex(b"pack"));
        fs::write(folder.path().join(&first.hash), b"pakc").unwrap();
        assert_eq!(get(), first);
        assert_eq!(fs::read(folder.path().join(&first.hash)).unwrap(), b"pack");
        assert_eq!(made, 2);
        // Nothing is left beside packs and keys.
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn what_an_older_program_kept_is_not_taken() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::open(folder.path()).unwrap();
        let key = Provenance::default().json("a", "b");
        let old = cache.store(b"old".to_vec()).unwrap();
        let old_key = key.clone().json("layout", LAYOUT - 1).json("solver", SOLVER_VERSION);
        fs::write(folder.path().join("keys").join(old_key.hash()), old.hash.as_bytes()).unwrap();
        assert_eq!(cache.pack(&key, || Ok(b"new".to_vec())).unwrap().bytes, b"new");
        let same = key.json("layout", LAYOUT).json("solver", SOLVER_VERSION);
        assert!(folder.path().join("keys").join(same.hash()).is_file());
    }

    #[test]
    fn keys_do_not_run_together() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::open(folder.path()).unwrap();
        let key = |a: &str, b: &str| Provenance::default().json("a", a).json("b", b);
        cache.pack(&key("ab", "c"), || Ok(vec![1])).unwrap();
        assert_eq!(cache.pack(&key("a", "bc"), || Ok(vec![2])).unwrap().bytes, [2]);
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let error = Cache::open(file.path()).err().unwrap();
        assert!(error.message.contains("data folder"), "{error}");
    }
}
