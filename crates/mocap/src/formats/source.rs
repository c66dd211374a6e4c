//! Where the bytes of a file come from: a stream that can be read again from any place.

use crate::ReadError;
use std::io::{BufRead, BufReader, Cursor, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

/// Least number of bytes read at a time of a beginning.
const BLOCK: usize = 4096;
/// Bytes read at a time of the rest.
pub(crate) const CHUNK: usize = 1 << 18;

/// A file or bytes in memory.
pub(crate) trait Source: BufRead + Seek {}

impl<T: BufRead + Seek> Source for T {}

/// Open a file. What cannot be read twice (a pipe) is taken into memory.
///
/// # Errors
/// [`ReadError::Open`].
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let failed = |source| ReadError::Open { path: path.to_path_buf(), source };
    let mut file = std::fs::File::open(path).map_err(failed)?;
    if file.metadata().map_err(failed)?.is_file() {
        return Ok(Box::new(BufReader::with_capacity(CHUNK, file)));
    }
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(failed)?;
    Ok(Box::new(Cursor::new(bytes)))
}

/// Bytes from the beginning to the end.
pub(crate) fn length(source: &mut dyn Source) -> Result<u64, ReadError> {
    source.seek(SeekFrom::End(0)).map_err(ReadError::Read)
}

/// The first bytes, at most `most` of them; fewer where the source is shorter.
pub(crate) fn beginning(source: &mut dyn Source, most: u64) -> Result<Vec<u8>, ReadError> {
    source.rewind().map_err(ReadError::Read)?;
    let mut bytes = Vec::new();
    source.take(most).read_to_end(&mut bytes).map_err(ReadError::Read)?;
    Ok(bytes)
}

/// The first bytes of a source, fit to print.
pub(crate) fn shown_beginning(source: &mut dyn Source) -> Result<String, ReadError> {
    let bytes = beginning(source, 24)?;
    if bytes.is_empty() {
        return Ok("the file is empty".to_owned());
    }
    let head: String = bytes.iter().flat_map(|b| b.escape_ascii()).map(char::from).collect();
    Ok(format!("it starts with \"{head}\""))
}

/// The first bytes of a source, read as far as they were asked for.
pub(crate) struct Prefix<'s> {
    source: &'s mut dyn Source,
    bytes: Vec<u8>,
    length: u64,
}

impl<'s> Prefix<'s> {
    /// Nothing read yet, of a source of `length` bytes.
    pub(crate) fn new(source: &'s mut dyn Source, length: u64) -> Self {
        Self { source, bytes: Vec::new(), length }
    }

    /// Bytes of the source.
    pub(crate) fn length(&self) -> u64 {
        self.length
    }

    /// The bytes of a range; `None` where it goes past the end of the source.
    pub(crate) fn get(
        &mut self,
        range: std::ops::Range<usize>,
    ) -> Result<Option<&[u8]>, ReadError> {
        if range.end as u64 > self.length || range.start > range.end {
            return Ok(None);
        }
        if range.end > self.bytes.len() {
            let more = (range.end - self.bytes.len()).max(BLOCK);
            self.source.seek(SeekFrom::Start(self.bytes.len() as u64)).map_err(ReadError::Read)?;
            // Memory grows with the bytes that come, not with those that are asked for.
            let read = (&mut *self.source).take(more as u64).read_to_end(&mut self.bytes);
            read.map_err(ReadError::Read)?;
        }
        Ok(self.bytes.get(range))
    }

    /// The bytes read so far.
    pub(crate) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

/// Fill `to` as far as there are bytes; the number of bytes read.
pub(crate) fn fill(source: &mut dyn Source, to: &mut [u8]) -> Result<usize, ReadError> {
    let mut filled = 0;
    while filled < to.len() {
        match source.read(&mut to[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(e) if e.kind() == ErrorKind::Interrupted => {}
            Err(e) => return Err(ReadError::Read(e)),
        }
    }
    Ok(filled)
}
