//! Brotli and gzip, made ahead: a file is compressed once and served many times. `cargo xtask web` compresses
//! the embedded pages more slowly and smaller.
//!
//! Browsers accept brotli only over TLS and from the same machine, gzip everywhere.

use std::io::{self, Write};

/// Past 9, brotli takes ten times as long; a server that starts has to wait for it.
const BROTLI_QUALITY: u32 = 9;
/// The window, as a power of two: 4 MiB, larger than most files here.
const BROTLI_WINDOW: u32 = 22;

/// The brotli form, or `None` where it saves less than a twentieth.
pub(crate) fn brotli(bytes: &[u8]) -> io::Result<Option<Vec<u8>>> {
    let mut packed = Vec::new();
    let mut writer =
        ::brotli::CompressorWriter::new(&mut packed, 1 << 16, BROTLI_QUALITY, BROTLI_WINDOW);
    writer.write_all(bytes)?;
    writer.flush()?;
    drop(writer);
    Ok(worth_it(bytes, packed))
}

/// The gzip form, or `None` where it saves less than a twentieth.
pub(crate) fn gzip(bytes: &[u8]) -> io::Result<Option<Vec<u8>>> {
    let mut writer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    writer.write_all(bytes)?;
    Ok(worth_it(bytes, writer.finish()?))
}

/// What was packed, unless it saves less than a twentieth.
pub(crate) fn worth_it(bytes: &[u8], packed: Vec<u8>) -> Option<Vec<u8>> {
    (packed.len() < bytes.len() - bytes.len() / 20).then_some(packed)
}
