//! The file to be inspected, read no further than is needed.

use std::borrow::Cow;
use std::io::Read as _;
use std::path::Path;

use mimique_mocap::CaptureFile;

/// The file to be inspected: what it begins with tells how much of it is read at a time.
pub(super) struct Opened<'a> {
    pub(super) file: &'a Path,
    /// The first 512 bytes.
    pub(super) head: Vec<u8>,
    pub(super) length: u64,
    /// All of it, where it is a pipe and can be read only once.
    piped: Option<Vec<u8>>,
}

impl<'a> Opened<'a> {
    /// Looks at the beginning of a file.
    pub(super) fn new(file: &'a Path) -> std::io::Result<Self> {
        let metadata = std::fs::metadata(file)?;
        let piped = match metadata.is_file() || metadata.is_dir() {
            true => None,
            false => Some(std::fs::read(file)?),
        };
        let mut head = Vec::new();
        match &piped {
            Some(bytes) => head.extend(bytes.iter().take(512)),
            None if metadata.is_dir() => {}
            None => _ = std::fs::File::open(file)?.take(512).read_to_end(&mut head)?,
        }
        let length = match (&piped, metadata.is_dir()) {
            (Some(bytes), _) => bytes.len() as u64,
            (None, true) => 0,
            (None, false) => metadata.len(),
        };
        Ok(Self { file, head, length, piped })
    }

    /// As a capture, to be read as a stream.
    pub(super) fn capture(&self) -> Result<CaptureFile<'_>, mimique_mocap::ReadError> {
        match &self.piped {
            Some(bytes) => CaptureFile::of_bytes(bytes),
            None => CaptureFile::open(self.file),
        }
    }

    /// All its bytes; none of a folder.
    pub(super) fn bytes(&self) -> anyhow::Result<Cow<'_, [u8]>> {
        match &self.piped {
            Some(bytes) => Ok(Cow::Borrowed(bytes)),
            None if self.file.is_dir() => Ok(Cow::Borrowed(&[])),
            None => Ok(Cow::Owned(std::fs::read(self.file)?)),
        }
    }
}
