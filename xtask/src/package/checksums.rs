//! SHA256SUMS: the hash of every file of the release, as `sha256sum --check` reads it.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use sha2::{Digest, Sha256};

use super::files;
use crate::process::say;

const FILE: &str = "SHA256SUMS";

/// Hashes by file names.
#[derive(Debug, Default)]
pub struct Sums(BTreeMap<String, String>);

impl Sums {
    /// Of the files of a folder, but of the list itself.
    pub fn of(folder: &Path) -> Result<Self> {
        let mut sums = BTreeMap::new();
        for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            if entry.file_type()?.is_file() && name != FILE {
                sums.insert(name, hex::encode(Sha256::digest(files::read(&entry.path())?)));
            }
        }
        Ok(Self(sums))
    }

    /// The hash of a file.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    /// Writes the list into the folder.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let text: String = self.0.iter().map(|(name, sum)| format!("{sum}  {name}\n")).collect();
        std::fs::write(folder.join(FILE), text).context(FILE)
    }

    /// Prints the files and their sizes.
    pub fn list(&self, folder: &Path) -> Result<()> {
        say(&format!("{}:", folder.display()));
        for name in self.0.keys() {
            let bytes = std::fs::metadata(folder.join(name))?.len();
            say(&format!("  {:>7.1} MB  {name}", bytes as f64 / 1e6));
        }
        Ok(())
    }
}

impl FromIterator<(String, String)> for Sums {
    fn from_iter<I: IntoIterator<Item = (String, String)>>(pairs: I) -> Self {
        Self(pairs.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_as_sha256sum_reads_it() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a"), "abc").unwrap();
        std::fs::create_dir(folder.path().join("folder")).unwrap();
        Sums::of(folder.path()).unwrap().write(folder.path()).unwrap();
        let text = std::fs::read_to_string(folder.path().join(FILE)).unwrap();
        assert_eq!(text, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  a\n");
        let again = Sums::of(folder.path()).unwrap();
        assert_eq!(again.0.len(), 1, "the list itself is left out");
    }
}
