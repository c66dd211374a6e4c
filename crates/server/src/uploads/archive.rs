//! An uploaded archive, unpacked into a folder: every name stays inside it, every byte is counted
//! while it is unpacked, whatever the archive declares.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Component, Path, PathBuf};

use zip::ZipArchive;

use crate::error::Error;

/// Bytes of an upload.
pub(super) const LARGEST_UPLOAD: u64 = 512 * 1024 * 1024;
/// Bytes of everything in it, unpacked.
const LARGEST_CONTENT: u64 = 2 * 1024 * 1024 * 1024;
/// Files and folders in it.
const MOST_ENTRIES: usize = 5000;
/// Bytes of a study file, alone or in an archive: a small archive must not become gigabytes of parsed JSON.
const LARGEST_STUDY: u64 = 8 * MIB;
/// Bytes of another file of JSON in an archive.
const LARGEST_JSON: u64 = 16 * MIB;
const MIB: u64 = 1024 * 1024;
/// Folders within folders.
const DEEPEST: usize = 12;
/// Bytes of a name.
const LONGEST_NAME: usize = 400;

/// The first bytes of a ZIP archive.
pub const ZIP_START: &[u8; 4] = b"PK\x03\x04";

/// Whether a file is a ZIP archive, by its first bytes.
///
/// # Errors
/// The file cannot be read.
pub fn is_archive(path: &Path) -> io::Result<bool> {
    let mut start = [0; ZIP_START.len()];
    let read = File::open(path)?.read(&mut start)?;
    Ok(&start[..read] == ZIP_START)
}

/// Unpacks an upload (a ZIP archive, or a study file alone) into an empty folder; gives the study file.
pub(super) fn unpack(upload: &Path, folder: &Path) -> Result<PathBuf, Error> {
    fs::create_dir_all(folder)?;
    if !is_archive(upload)? {
        return single_file(upload, folder);
    }
    let mut archive = ZipArchive::new(File::open(upload)?)
        .map_err(|error| Error::NotAnArchive { problem: error.to_string() })?;
    if archive.len() > MOST_ENTRIES {
        return Err(Error::TooManyEntries { entries: archive.len(), most: MOST_ENTRIES });
    }
    if let Some(entry) = repeated_name(upload, &archive)? {
        return Err(Error::EntryTwice { entry });
    }
    let mut left = LARGEST_CONTENT;
    let mut names = Names::default();
    for index in 0..archive.len() {
        let mut entry = archive
            .by_index(index)
            .map_err(|error| damaged(index.to_string(), error.to_string()))?;
        let name = match entry.name() {
            Ok(name) => name.into_owned(),
            Err(error) => return Err(damaged(index.to_string(), error.to_string())),
        };
        let inside = inside(&name).ok_or_else(|| Error::EntryOutside { entry: name.clone() })?;
        if entry.is_symlink() {
            return Err(Error::EntryLink { entry: name });
        }
        names.add(&inside, entry.is_dir(), &name)?;
        if entry.is_dir() {
            fs::create_dir_all(folder.join(inside))?;
            continue;
        }
        let path = folder.join(&inside);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        let is_json = inside.extension().is_some_and(|own| own.eq_ignore_ascii_case("json"));
        let most = if is_json { left.min(LARGEST_JSON) } else { left };
        left -= copy(&mut entry, &path, most, &name).map_err(|error| match error {
            Error::ContentTooLarge { entry } if most < left => {
                Error::JsonTooLarge { entry, most_mib: LARGEST_JSON / MIB }
            }
            error => error,
        })?;
    }
    let study = study_file(folder)?;
    if fs::metadata(&study)?.len() > LARGEST_STUDY {
        let entry = study.strip_prefix(folder).unwrap_or(&study).display().to_string();
        return Err(Error::JsonTooLarge { entry, most_mib: LARGEST_STUDY / MIB });
    }
    Ok(study)
}

/// Names of files and folders so far, in small letters: two names may be one on a disk that does not tell large letters
/// from small ones.
#[derive(Default)]
struct Names {
    files: BTreeSet<PathBuf>,
    folders: BTreeSet<PathBuf>,
}

impl Names {
    fn add(&mut self, inside: &Path, is_folder: bool, name: &str) -> Result<(), Error> {
        let entry = || name.to_owned();
        let inside = PathBuf::from(inside.to_string_lossy().to_lowercase());
        let above: Vec<PathBuf> = inside.ancestors().skip(1).map(Path::to_owned).collect();
        let others = if is_folder { &self.files } else { &self.folders };
        if others.contains(&inside) || above.iter().any(|folder| self.files.contains(folder)) {
            return Err(Error::EntryAndFolder { entry: entry() });
        }
        self.folders.extend(above);
        if is_folder {
            self.folders.insert(inside);
        } else if !self.files.insert(inside) {
            return Err(Error::EntryTwice { entry: entry() });
        }
        Ok(())
    }
}

/// A name that two entries of the archive's directory have: the reader of archives gives the last one alone.
fn repeated_name(upload: &Path, archive: &ZipArchive<File>) -> Result<Option<String>, Error> {
    /// A header of the directory, up to its name; the lengths of name, extra field and comment begin at 28.
    const HEADER: usize = 46;
    const SIGNATURE: &[u8; 4] = b"PK\x01\x02";
    let mut directory = BufReader::new(File::open(upload)?);
    directory.seek(SeekFrom::Start(archive.central_directory_start()))?;
    let mut names = BTreeSet::new();
    let mut header = [0; HEADER];
    while directory.read_exact(&mut header).is_ok() && header.starts_with(SIGNATURE) {
        let length = |at: usize| u16::from_le_bytes([header[at], header[at + 1]]);
        let mut name = vec![0; usize::from(length(28))];
        if directory.read_exact(&mut name).is_err() {
            break;
        }
        directory.seek_relative(i64::from(length(30)) + i64::from(length(32)))?;
        let text = String::from_utf8_lossy(&name).into_owned();
        if !names.insert(name) {
            return Ok(Some(text));
        }
        if names.len() > MOST_ENTRIES {
            return Err(Error::TooManyEntries { entries: names.len(), most: MOST_ENTRIES });
        }
    }
    Ok(None)
}

/// A path below the folder, or none.
fn inside(name: &str) -> Option<PathBuf> {
    if name.is_empty() || name.len() > LONGEST_NAME || name.contains(['\\', '\0', ':']) {
        return None;
    }
    let path = Path::new(name);
    let plain = path.components().all(|part| matches!(part, Component::Normal(_)));
    (plain && path.components().count() <= DEEPEST).then(|| path.to_owned())
}

/// Copies an entry, never more than is left; how many bytes it had.
fn copy(entry: &mut impl Read, path: &Path, left: u64, name: &str) -> Result<u64, Error> {
    let damaged = |error: io::Error| damaged(name.to_owned(), error.to_string());
    let mut file = File::options().write(true).create_new(true).open(path)?;
    let mut buffer = vec![0; 64 * 1024];
    let mut copied = 0;
    loop {
        let read = entry.read(&mut buffer).map_err(damaged)?;
        if read == 0 {
            return Ok(copied);
        }
        copied += read as u64;
        if copied > left {
            return Err(Error::ContentTooLarge { entry: name.to_owned() });
        }
        file.write_all(&buffer[..read])?;
    }
}

fn damaged(entry: String, problem: String) -> Error {
    Error::EntryDamaged { entry, problem }
}

fn single_file(upload: &Path, folder: &Path) -> Result<PathBuf, Error> {
    let size = fs::metadata(upload)?.len();
    let mut start = [0; 64];
    let read = File::open(upload)?.read(&mut start)?;
    let first = start[..read].iter().find(|byte| !byte.is_ascii_whitespace());
    // An object, or the comment before it.
    if size > LARGEST_STUDY || !matches!(first, Some(b'{' | b'/')) {
        return Err(Error::NotAnArchive { problem: "it begins like neither".to_owned() });
    }
    let path = folder.join("study.json");
    fs::copy(upload, &path)?;
    Ok(path)
}

/// `study.json`, or the only `.json` beside which no other could be it; at the top, or in the only
/// folder that stands there (as archives of a folder have it).
fn study_file(folder: &Path) -> Result<PathBuf, Error> {
    let mut files = Vec::new();
    let mut folders = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        // What archivers of macOS add.
        if name == "__MACOSX" || name.starts_with('.') {
            continue;
        }
        if entry.file_type()?.is_dir() {
            folders.push(entry.path());
        } else {
            files.push(entry.path());
        }
    }
    if let Some(named) =
        files.iter().find(|path| path.file_name().is_some_and(|n| n == "study.json"))
    {
        return Ok(named.clone());
    }
    let is_study = |path: &&PathBuf| {
        let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase());
        // `head.avatar.json`, `take.repair.json` are settings beside something else.
        name.is_some_and(|name| name.ends_with(".json") && name.matches('.').count() == 1)
    };
    let mut studies = files.iter().filter(is_study);
    match (studies.next(), studies.next()) {
        (Some(only), None) => Ok(only.clone()),
        (None, _) if files.is_empty() && folders.len() == 1 => study_file(&folders[0]),
        _ => Err(Error::NoStudyFile),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use mimique_locale::Language;
    use zip::write::SimpleFileOptions;

    use super::*;

    fn packed(entries: &[(&str, &[u8])]) -> Vec<u8> {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in entries {
            writer.start_file(*name, SimpleFileOptions::default()).unwrap();
            writer.write_all(bytes).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    fn unpacked(bytes: &[u8]) -> Result<String, String> {
        let folder = tempfile::tempdir().unwrap();
        let upload = folder.path().join("upload");
        fs::write(&upload, bytes).unwrap();
        let found = unpack(&upload, &folder.path().join("files"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "nothing is written elsewhere");
        let found = found.map_err(|error| error.sentence(Language::English))?;
        Ok(found.strip_prefix(folder.path().join("files")).unwrap().display().to_string())
    }

    #[test]
    fn the_study_file_is_found() {
        for (entries, expected) in [
            (vec!["study.json", "other.json"], "study.json"),
            (vec!["faces.json", "take.c3d", "take.repair.json"], "faces.json"),
            (
                vec!["faces/faces.json", "faces/heads/a.glb", "__MACOSX/faces.json"],
                "faces/faces.json",
            ),
        ] {
            let entries: Vec<_> = entries.iter().map(|name| (*name, b"{}".as_slice())).collect();
            assert_eq!(unpacked(&packed(&entries)).unwrap(), expected);
        }
        assert_eq!(unpacked(b" {\"id\": 1}").unwrap(), "study.json");
        for wrong in
            [packed(&[("a.json", b"{}"), ("b.json", b"{}")]), packed(&[("a/b/c.txt", b"")])]
        {
            assert!(unpacked(&wrong).unwrap_err().contains("no study file"));
        }
        assert!(unpacked(b"MZ").unwrap_err().contains("neither"));
    }

    #[test]
    fn names_stay_inside() {
        for name in ["../a", "/a", "a/../../b", "..\\a", "C:a", "a/\0b", "./../a", &"a/".repeat(20)]
        {
            assert_eq!(inside(name), None, "{name:?}");
        }
        assert!(inside("heads/a b.glb").is_some());
        for name in ["../evil.json", "/etc/evil.json", "a/../../evil.json"] {
            let error = unpacked(&packed(&[("study.json", b"{}"), (name, b"x")])).unwrap_err();
            assert!(error.contains("leads out"), "{name}: {error}");
        }
        let twice = packed(&[("study.json", b"{}"), ("STUDY.json", b"{}")]);
        assert!(unpacked(&twice).unwrap_err().contains("another entry"));
    }

    #[test]
    fn links_are_refused() {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        writer.add_symlink("study.json", "/etc/passwd", SimpleFileOptions::default()).unwrap();
        let bytes = writer.finish().unwrap().into_inner();
        assert!(unpacked(&bytes).unwrap_err().contains("a link"));
    }

    #[test]
    fn a_bomb_is_counted_while_it_unpacks() {
        let folder = tempfile::tempdir().unwrap();
        let mut endless = io::repeat(0);
        let error = copy(&mut endless, &folder.path().join("a"), 1_000_000, "a").unwrap_err();
        assert!(matches!(error, Error::ContentTooLarge { .. }), "{error:?}");
        assert!(fs::metadata(folder.path().join("a")).unwrap().len() <= 1_000_000);
        let entries: Vec<String> = (0..=MOST_ENTRIES).map(|index| format!("{index}")).collect();
        let entries: Vec<_> = entries.iter().map(|name| (name.as_str(), b"".as_slice())).collect();
        assert!(unpacked(&packed(&entries)).unwrap_err().contains("5001 entries"));
    }

    #[test]
    fn damaged_archives_are_refused() {
        let mut bytes = packed(&[("study.json", b"{}"), ("a.bin", &[7; 5000])]);
        for cut in [10, bytes.len() / 2, bytes.len() - 1] {
            assert!(unpacked(&bytes[..cut]).is_err(), "{cut}");
        }
        let middle = 60;
        bytes[middle] ^= 0xff;
        // Whatever the flipped byte was, nothing panics.
        let _ = unpacked(&bytes);
    }
}
