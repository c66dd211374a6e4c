//! The ZIP archive of a capsule: its files by part, those that scripts need as scripts that hand them over, the same bytes
//! for the same files.

use std::collections::BTreeMap;
use std::io::{Cursor, Write as _};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::json;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// What a file is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Pages, scripts and modules.
    Program,
    /// Packs, pictures, sound.
    Stimuli,
    /// Study file and formats.
    Study,
    /// Tables of answers.
    Answers,
    /// Frames that were shown.
    Frames,
    /// Report with tables and figures.
    Report,
}

impl Part {
    /// Its word in the output.
    pub fn word(self) -> &'static str {
        match self {
            Self::Program => "program",
            Self::Stimuli => "stimuli",
            Self::Study => "study",
            Self::Answers => "answers",
            Self::Frames => "frames",
            Self::Report => "report",
        }
    }
}

/// Files by their path.
#[derive(Default)]
pub struct Files(BTreeMap<String, (Part, Vec<u8>)>);

/// A part of an archive.
#[derive(Default)]
pub struct Size {
    /// Files.
    pub files: usize,
    /// Bytes unpacked.
    pub bytes: u64,
    /// Bytes in the archive.
    pub packed: u64,
}

impl Files {
    /// Adds a file as it is.
    pub fn plain(&mut self, part: Part, path: &str, bytes: impl Into<Vec<u8>>) {
        self.0.insert(path.to_owned(), (part, bytes.into()));
    }

    /// Adds a text for the pages' scripts: `files/NAME.js`.
    pub fn text(&mut self, part: Part, name: &str, media_type: &str, text: &str) {
        let script =
            format!("capsule.text({}, {}, {});\n", json!(name), json!(media_type), json!(text));
        self.plain(part, &format!("files/{name}.js"), script);
    }

    /// Adds bytes for the pages' scripts, in gzip and base64.
    pub fn bytes(
        &mut self,
        part: Part,
        name: &str,
        media_type: &str,
        bytes: &[u8],
    ) -> std::io::Result<()> {
        let mut gzip = GzEncoder::new(Vec::new(), Compression::best());
        gzip.write_all(bytes)?;
        let text = STANDARD.encode(gzip.finish()?);
        let script =
            format!("capsule.bytes({}, {}, \"{text}\");\n", json!(name), json!(media_type));
        self.plain(part, &format!("files/{name}.js"), script);
        Ok(())
    }

    /// The archive, its files below a folder, and the size of each part.
    pub fn zipped(&self, folder: &str) -> anyhow::Result<(Vec<u8>, BTreeMap<Part, Size>)> {
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            // 1 January 1980: the same input gives the same bytes.
            .last_modified_time(zip::DateTime::default())
            .compression_level(Some(9));
        for (path, (_, bytes)) in &self.0 {
            writer.start_file(format!("{folder}/{path}"), options)?;
            writer.write_all(bytes)?;
        }
        let bytes = writer.finish()?.into_inner();
        let mut archive = ZipArchive::new(Cursor::new(&bytes[..]))?;
        let mut sizes: BTreeMap<Part, Size> = BTreeMap::new();
        for (path, (part, bytes)) in &self.0 {
            let size = sizes.entry(*part).or_default();
            size.files += 1;
            size.bytes += bytes.len() as u64;
            size.packed += archive.by_name(&format!("{folder}/{path}"))?.compressed_size();
        }
        Ok((bytes, sizes))
    }
}
