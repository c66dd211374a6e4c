//! Where the files of a site are put: a folder, or the archive that JATOS imports.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, StreamWriter, ZipWriter};

/// Takes the files of a site, one after the other, by their path below the site.
pub(super) trait Files {
    /// Takes a file.
    fn put(&mut self, name: &str, bytes: &[u8]) -> anyhow::Result<()>;
}

/// A folder that is being written, with what it holds so far.
pub(super) struct Folder {
    path: PathBuf,
    pub(super) written: Written,
}

/// How much was written.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Written {
    pub(super) files: usize,
    pub(super) bytes: u64,
}

impl Written {
    fn add(&mut self, bytes: &[u8]) {
        self.files += 1;
        self.bytes += bytes.len() as u64;
    }
}

impl Folder {
    /// A folder that is there.
    pub(super) fn new(path: &Path) -> Self {
        Self { path: path.to_owned(), written: Written::default() }
    }
}

impl Files for Folder {
    /// Writes a file, and makes its folder where it is not there.
    fn put(&mut self, name: &str, bytes: &[u8]) -> anyhow::Result<()> {
        let path = self.path.join(name);
        let place = || path.display().to_string();
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).with_context(place)?;
        }
        std::fs::write(&path, bytes).with_context(place)?;
        self.written.add(bytes);
        Ok(())
    }
}

/// A ZIP archive that is being written; the same bytes for the same files.
pub(super) struct Archive<'a> {
    writer: ZipWriter<StreamWriter<&'a mut dyn std::io::Write>>,
    /// The folder of the archive that files are put into; empty for its root.
    folder: String,
    pub(super) written: Written,
}

impl<'a> Archive<'a> {
    /// An archive that is written to `out`, its files below `folder`.
    pub(super) fn begin(out: &'a mut dyn std::io::Write, folder: &str) -> Self {
        let written = Written::default();
        Self { writer: ZipWriter::new_stream(out), folder: format!("{folder}/"), written }
    }

    /// From here on, files are put beside the folder.
    pub(super) fn beside(&mut self) {
        self.folder.clear();
    }

    /// Writes what closes the archive.
    pub(super) fn finish(self) -> anyhow::Result<Written> {
        self.writer.finish()?;
        Ok(self.written)
    }
}

impl Files for Archive<'_> {
    fn put(&mut self, name: &str, bytes: &[u8]) -> anyhow::Result<()> {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        self.writer.start_file(format!("{}{name}", self.folder), options)?;
        self.writer.write_all(bytes)?;
        self.written.add(bytes);
        Ok(())
    }
}
