//! Files in one ZIP archive, which is made while they come.

use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};

use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, StreamWriter, ZipWriter};

use super::error::ExportError;
use super::parts::Part;

/// An archive in the making; the same bytes for the same parts.
pub(crate) struct Zipped {
    folder: String,
    writer: ZipWriter<StreamWriter<Shared>>,
    made: Shared,
}

/// What the archive's writer has written and nobody has taken yet.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Zipped {
    /// An archive whose files stand below one folder.
    pub fn below(folder: &str) -> Self {
        let made = Shared::default();
        let writer = ZipWriter::new_stream(made.clone());
        Self { folder: folder.to_owned(), writer, made }
    }

    /// Adds a part.
    pub fn take(&mut self, part: Part) -> Result<(), ExportError> {
        let form = |error: &dyn ToString| ExportError::Form(error.to_string());
        match part {
            Part::File(path) => {
                // How large it will be is not known yet.
                let options = SimpleFileOptions::default()
                    .compression_method(CompressionMethod::Deflated)
                    .large_file(true);
                let path = format!("{}/{path}", self.folder);
                self.writer.start_file(path, options).map_err(|error| form(&error))
            }
            Part::Bytes(bytes) => self.writer.write_all(&bytes).map_err(|error| form(&error)),
        }
    }

    /// What of the archive has been made since this was last asked.
    pub fn made(&self) -> Vec<u8> {
        std::mem::take(&mut *self.made.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The rest of it.
    pub fn finish(self) -> Result<Vec<u8>, ExportError> {
        let Self { writer, made, .. } = self;
        writer.finish().map_err(|error| ExportError::Form(error.to_string()))?;
        let mut made = made.0.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(std::mem::take(&mut *made))
    }
}

/// Files that are in memory, below one folder.
pub(crate) fn zip(folder: &str, files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, ExportError> {
    let mut zipped = Zipped::below(folder);
    for (path, bytes) in files {
        zipped.take(Part::File(path.clone()))?;
        zipped.take(Part::Bytes(bytes.clone()))?;
    }
    zipped.finish()
}
