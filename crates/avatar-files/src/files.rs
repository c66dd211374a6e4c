//! The files of a folder or an archive (zip, tar, tar.gz, tar.xz), one after another, bounded.

use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use crate::ReadError;

/// Where files come from.
pub(crate) enum Files {
    /// A folder.
    Folder(PathBuf),
    /// Bytes of a zip archive.
    Zip(Vec<u8>),
    /// Bytes of a tar archive, and how they are compressed.
    Tar(Vec<u8>, Compression),
}

/// How a tar archive is compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Compression {
    None,
    Gzip,
    Xz,
}

/// Most files that are looked at.
const MOST_FILES: usize = 4096;
/// Most bytes of one file, unpacked; what lies past it in an archive is a bomb, not a head.
const MOST_BYTES: u64 = 256 << 20;
/// Most bytes of all files, unpacked.
const MOST_BYTES_IN_ALL: u64 = 2 << 30;
/// Most memory that an xz stream may ask for its dictionary, KiB.
const MOST_XZ_KIB: u32 = 256 << 10;

/// A file as it is offered: its name without folders, and its content on demand.
pub(crate) type Visit<'v> =
    dyn FnMut(&str, &mut dyn FnMut() -> Result<Vec<u8>, ReadError>) -> Result<(), ReadError> + 'v;

impl Files {
    /// The archive that bytes are, if they are one.
    pub fn of_archive(bytes: &[u8]) -> Option<fn(Vec<u8>) -> Self> {
        if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06") {
            Some(Self::Zip)
        } else if bytes.starts_with(&[0x1f, 0x8b]) {
            Some(|bytes| Self::Tar(bytes, Compression::Gzip))
        } else if bytes.starts_with(b"\xfd7zXZ\0") {
            Some(|bytes| Self::Tar(bytes, Compression::Xz))
        } else if bytes.get(257..262) == Some(b"ustar") {
            Some(|bytes| Self::Tar(bytes, Compression::None))
        } else {
            None
        }
    }

    /// Offers every file in turn; hidden ones and resource forks are passed over.
    pub fn each(&self, visit: &mut Visit<'_>) -> Result<(), ReadError> {
        let mut budget = Budget { files: 0, bytes: 0 };
        match self {
            Self::Folder(folder) => each_of_folder(folder, &mut budget, visit),
            Self::Zip(bytes) => each_of_zip(bytes, &mut budget, visit),
            Self::Tar(bytes, Compression::None) => each_of_tar(&bytes[..], &mut budget, visit),
            Self::Tar(bytes, Compression::Gzip) => {
                each_of_tar(flate2::read::MultiGzDecoder::new(&bytes[..]), &mut budget, visit)
            }
            Self::Tar(bytes, Compression::Xz) => {
                let reader = lzma_rust2::XzReader::new_mem_limit(&bytes[..], true, MOST_XZ_KIB);
                each_of_tar(reader, &mut budget, visit)
            }
        }
    }
}

/// What has been taken so far.
struct Budget {
    files: usize,
    bytes: u64,
}

impl Budget {
    fn count_file(&mut self, place: &str) -> Result<(), ReadError> {
        self.files += 1;
        if self.files > MOST_FILES {
            let what = format!("more than {MOST_FILES} files");
            return Err(ReadError::broken(place, what, "keep the poses alone in it"));
        }
        Ok(())
    }

    fn take(&mut self, reader: impl Read, name: &str) -> Result<Vec<u8>, ReadError> {
        let mut bytes = Vec::new();
        let most = MOST_BYTES.min(MOST_BYTES_IN_ALL.saturating_sub(self.bytes));
        reader.take(most + 1).read_to_end(&mut bytes).map_err(|source| io(name, source))?;
        self.bytes += bytes.len() as u64;
        if bytes.len() as u64 > most {
            let what = format!("more than {} MiB unpacked", most >> 20);
            return Err(ReadError::broken(name, what, "keep the poses alone in it"));
        }
        Ok(bytes)
    }
}

fn each_of_folder(
    folder: &Path,
    budget: &mut Budget,
    visit: &mut Visit<'_>,
) -> Result<(), ReadError> {
    let place = "the avatar's folder";
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|source| io(place, source))? {
        budget.count_file(place)?;
        paths.push(entry.map_err(|source| io(place, source))?.path());
    }
    paths.sort();
    for path in paths.iter().filter(|p| p.is_file()) {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if shown(&name) {
            visit(&name, &mut || {
                let file = std::fs::File::open(path).map_err(|source| io(&name, source))?;
                budget.take(file, &name)
            })?;
        }
    }
    Ok(())
}

fn each_of_zip(bytes: &[u8], budget: &mut Budget, visit: &mut Visit<'_>) -> Result<(), ReadError> {
    let damaged = |e: zip::result::ZipError| ReadError::damaged("zip archive", e.to_string());
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(damaged)?;
    for index in 0..archive.len() {
        budget.count_file("zip archive")?;
        let file = archive.by_index(index).map_err(damaged)?;
        let path = file.name().map_err(damaged)?.into_owned();
        let Some(name) = file_name(&path).filter(|_| file.is_file()) else { continue };
        let mut file = Some(file);
        visit(name, &mut || match file.take() {
            Some(file) => budget.take(file, name),
            None => Ok(Vec::new()),
        })?;
    }
    Ok(())
}

fn each_of_tar(
    reader: impl Read,
    budget: &mut Budget,
    visit: &mut Visit<'_>,
) -> Result<(), ReadError> {
    let place = "tar archive";
    // What is passed over is unpacked too: the whole stream has a bound.
    let mut archive = tar::Archive::new(reader.take(MOST_BYTES_IN_ALL + (64 << 20)));
    let entries = archive.entries().map_err(|e| ReadError::damaged(place, e.to_string()))?;
    for entry in entries {
        budget.count_file(place)?;
        let mut entry = entry.map_err(|e| ReadError::damaged(place, e.to_string()))?;
        if !entry.header().entry_type().is_file() {
            continue;
        }
        let path = String::from_utf8_lossy(&entry.path_bytes()).into_owned();
        let Some(name) = file_name(&path) else { continue };
        visit(name, &mut || budget.take(&mut entry, name))?;
    }
    Ok(())
}

/// The last part of a path inside an archive, unless it is hidden.
fn file_name(path: &str) -> Option<&str> {
    let name = path.rsplit(['/', '\\']).next()?;
    (shown(name) && !path.contains("__MACOSX")).then_some(name)
}

fn shown(name: &str) -> bool {
    !name.is_empty() && !name.starts_with('.')
}

fn io(place: &str, source: std::io::Error) -> ReadError {
    use std::io::ErrorKind::{InvalidData, InvalidInput, Other, OutOfMemory, UnexpectedEof};
    match source.kind() {
        InvalidData | InvalidInput | UnexpectedEof | Other | OutOfMemory => {
            ReadError::damaged(place, source.to_string())
        }
        _ => ReadError::Io { place: place.to_owned(), source },
    }
}
