//! Files of a package before they are packed: names, bytes, whether they are run; and the two forms of archives. The
//! same files give the same bytes.

use std::io::{Cursor, Write as _};
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};
use zip::CompressionMethod;
use zip::write::SimpleFileOptions;

use crate::process::{output, root};

/// One file.
#[derive(Debug, Clone)]
pub struct File {
    /// Its path in the package, with `/`.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
    /// Whether it is a program.
    pub is_program: bool,
}

impl File {
    /// A file that is read.
    pub fn text(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), bytes: bytes.into(), is_program: false }
    }

    /// A program.
    pub fn program(name: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self { name: name.into(), bytes, is_program: true }
    }

    /// A copy of a file of the repository.
    pub fn of_repository(name: impl Into<String>, path: &str) -> Result<Self> {
        Ok(Self::text(name, read(&root().join(path))?))
    }

    /// The same file in a folder.
    pub fn within(mut self, folder: &str) -> Self {
        self.name = format!("{folder}/{}", self.name);
        self
    }

    /// Mode of the file.
    pub fn mode(&self) -> u32 {
        if self.is_program { 0o755 } else { 0o644 }
    }
}

/// The bytes of a file, or an error that names it.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).with_context(|| path.display().to_string())
}

/// Every file below a folder, in the order of their names.
pub fn below(folder: &Path) -> Result<Vec<File>> {
    let mut found = Vec::new();
    let mut open = vec![(folder.to_owned(), String::new())];
    while let Some((place, prefix)) = open.pop() {
        for entry in std::fs::read_dir(&place).with_context(|| place.display().to_string())? {
            let entry = entry?;
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.file_type()?.is_dir() {
                open.push((entry.path(), format!("{name}/")));
            } else {
                found.push(File::text(name, read(&entry.path())?));
            }
        }
    }
    found.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(found)
}

/// Writes files below a folder, which is made anew.
pub fn write_below(folder: &Path, files: &[File]) -> Result<()> {
    if folder.exists() {
        std::fs::remove_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    for file in files {
        let path = folder.join(&file.name);
        let parent = path.parent().context("a file lies in a folder")?;
        std::fs::create_dir_all(parent).with_context(|| parent.display().to_string())?;
        std::fs::write(&path, &file.bytes).with_context(|| path.display().to_string())?;
        set_mode(&path, file.mode())?;
    }
    Ok(())
}

#[cfg(unix)]
fn set_mode(path: &Path, mode: u32) -> Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    Ok(std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode))?)
}

/// Windows knows programs by their names.
#[cfg(not(unix))]
fn set_mode(_: &Path, _: u32) -> Result<()> {
    Ok(())
}

/// The time of every file in a package, seconds since 1970: `SOURCE_DATE_EPOCH`, else that of the commit, else 1980,
/// the first year of zip.
pub fn epoch() -> u64 {
    let commit =
        || output(Command::new("git").args(["log", "-1", "--format=%ct"]).current_dir(root()));
    let text = std::env::var("SOURCE_DATE_EPOCH").ok().or_else(commit);
    text.and_then(|text| text.trim().parse().ok()).unwrap_or(315_532_800)
}

/// An entry of a tar archive without names of people or times of the build.
fn header(mode: u32, size: u64, kind: tar::EntryType) -> tar::Header {
    let mut header = tar::Header::new_gnu();
    header.set_entry_type(kind);
    header.set_mode(mode);
    header.set_size(size);
    header.set_mtime(epoch());
    header.set_uid(0);
    header.set_gid(0);
    header
}

/// A folder of a tar archive that belongs to somebody.
pub struct Folder {
    /// Its path.
    pub name: &'static str,
    /// Its mode.
    pub mode: u32,
    /// User and group.
    pub owner: u64,
}

/// A tar archive of these folders and files.
pub fn tar(folders: &[Folder], files: &[File]) -> Result<Vec<u8>> {
    let mut archive = tar::Builder::new(Vec::new());
    for folder in folders {
        let mut header = header(folder.mode, 0, tar::EntryType::Directory);
        header.set_uid(folder.owner);
        header.set_gid(folder.owner);
        archive.append_data(&mut header, format!("{}/", folder.name), std::io::empty())?;
    }
    for file in files {
        let mut header = header(file.mode(), file.bytes.len() as u64, tar::EntryType::Regular);
        archive
            .append_data(&mut header, &file.name, file.bytes.as_slice())
            .with_context(|| file.name.clone())?;
    }
    Ok(archive.into_inner()?)
}

/// Bytes gzipped, without a time.
pub fn gzip(bytes: &[u8]) -> Result<Vec<u8>> {
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    gzip.write_all(bytes)?;
    Ok(gzip.finish()?)
}

/// A zip archive of these files.
pub fn zip(files: &[File]) -> Result<Vec<u8>> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for file in files {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(zip::DateTime::default())
            .unix_permissions(file.mode());
        archive.start_file(&file.name, options).with_context(|| file.name.clone())?;
        archive.write_all(&file.bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use super::*;

    #[test]
    fn archives_give_back_what_was_put_in() {
        let files = [File::program("a/run", b"#!".to_vec()), File::text("a/b/read", "words")];
        let folders = [Folder { name: "data", mode: 0o750, owner: 7 }];
        let packed = tar(&folders, &files).unwrap();
        assert_eq!(packed, tar(&folders, &files).unwrap());
        let mut archive = tar::Archive::new(packed.as_slice());
        let found: Vec<_> = archive
            .entries()
            .unwrap()
            .map(|entry| {
                let mut entry = entry.unwrap();
                let mut text = String::new();
                entry.read_to_string(&mut text).unwrap();
                let header = entry.header();
                let path = entry.path().unwrap().display().to_string();
                (path, header.mode().unwrap(), header.uid().unwrap(), text)
            })
            .collect();
        let expected =
            [("data/", 0o750, 7, ""), ("a/run", 0o755, 0, "#!"), ("a/b/read", 0o644, 0, "words")];
        let expected = expected
            .map(|(path, mode, owner, text)| (path.to_owned(), mode, owner, text.to_owned()));
        assert_eq!(found, expected);

        let packed = zip(&files).unwrap();
        let mut archive = zip::ZipArchive::new(Cursor::new(packed)).unwrap();
        assert_eq!(archive.len(), 2);
        assert_eq!(archive.by_name("a/run").unwrap().unix_mode().unwrap() & 0o777, 0o755);
    }

    #[test]
    fn a_folder_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("package");
        let files = [File::text("z", "1"), File::text("a/b", "2")];
        write_below(&place, &files).unwrap();
        let names: Vec<String> = below(&place).unwrap().into_iter().map(|file| file.name).collect();
        assert_eq!(names, ["a/b", "z"]);
    }
}
