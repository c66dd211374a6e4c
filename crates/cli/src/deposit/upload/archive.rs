//! The folder of a deposit as one ZIP archive, the same bytes each time; and the MD5 that repositories hold files by.

use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::path::Path;

use anyhow::Context as _;
use md5::{Digest as _, Md5};
use mimique_deposit::DepositFile;
use zip::write::{SimpleFileOptions, ZipWriter};
use zip::{CompressionMethod, DateTime};

/// Writes the files of a folder into an archive, below a folder of this name.
pub(super) fn zip(
    folder: &Path,
    files: &[DepositFile],
    name: &str,
    to: &mut File,
) -> anyhow::Result<()> {
    let mut writer = ZipWriter::new(to);
    for file in files {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644)
            .large_file(file.bytes >= u64::from(u32::MAX));
        writer.start_file(format!("{name}/{}", file.path), options)?;
        let path = folder.join(&file.path);
        let mut from = File::open(&path).with_context(|| path.display().to_string())?;
        io::copy(&mut from, &mut writer).with_context(|| path.display().to_string())?;
    }
    writer.finish()?.flush()?;
    Ok(())
}

/// MD5 of a file, hexadecimal.
pub(super) fn md5(path: &Path) -> anyhow::Result<String> {
    let mut file = File::open(path).with_context(|| path.display().to_string())?;
    let (mut digest, mut buffer) = (Md5::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut buffer).with_context(|| path.display().to_string())? {
            0 => return Ok(hex::encode(digest.finalize())),
            count => digest.update(&buffer[..count]),
        }
    }
}
