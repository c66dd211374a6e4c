//! Brotli as small as it gets, for files that are compressed once, when the server is built: a tenth smaller
//! than the quality at which packs are compressed, and as slow as Zopfli (1.5 seconds per megabyte).

use std::io;

use brotli::enc::BrotliEncoderParams;

/// The window, as a power of two: 4 MiB, larger than every file of the pages.
const WINDOW: i32 = 22;

/// The brotli form.
pub(crate) fn brotli(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut packed = Vec::new();
    let parameters = BrotliEncoderParams {
        quality: 11,
        lgwin: WINDOW,
        size_hint: bytes.len(),
        ..BrotliEncoderParams::default()
    };
    ::brotli::BrotliCompress(&mut &*bytes, &mut packed, &parameters)?;
    Ok(packed)
}
