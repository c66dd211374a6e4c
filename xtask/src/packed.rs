//! The compressed forms of the pages, made once, when the pages are built: the program embeds them.
//!
//! `target/web-packed` holds `HASH.br` and `HASH.gz` for the content with that SHA-256. A file is empty if compression
//! saves less than a twentieth. Browsers accept brotli only over TLS and from the same machine, gzip everywhere.

use std::fs;
use std::io::{self, Write as _};
use std::num::NonZeroU64;
use std::path::PathBuf;

use anyhow::Result;
use brotli::enc::BrotliEncoderParams;
use sha2::{Digest, Sha256};

use crate::web::dist;

/// What only researchers load: packed quickly. What participants wait for is packed as small as it gets.
const RESEARCHERS: [&str; 2] = ["studio_bg.wasm", "report_bg.wasm"];

/// Zopfli's rounds: after five of them, more gain less than one part in ten thousand.
const ZOPFLI_ROUNDS: NonZeroU64 = NonZeroU64::new(5).unwrap();

/// The brotli window, as a power of two: 4 MiB, larger than most files here.
const BROTLI_WINDOW: i32 = 22;

/// The sizes of a page's compressed forms; the raw size where compression does not pay.
pub struct Packed {
    /// The hash that names the forms.
    pub stem: String,
    /// Bytes with gzip.
    pub gzip: usize,
    /// Bytes with brotli.
    pub brotli: usize,
}

/// Where the compressed forms are: next to the pages.
pub fn folder() -> PathBuf {
    dist().with_file_name("web-packed")
}

/// The name of a page's forms, without their ending.
pub fn stem(bytes: &[u8]) -> String {
    hex::encode(Sha256::digest(bytes))
}

/// Compresses a page, unless the same content has been compressed before.
pub fn pack(name: &str, bytes: &[u8]) -> Result<Packed> {
    let stem = stem(bytes);
    let for_participants = !RESEARCHERS.contains(&name);
    let form = |ending: &str, compress: &dyn Fn() -> io::Result<Vec<u8>>| -> io::Result<usize> {
        let path = folder().join(format!("{stem}.{ending}"));
        if !path.exists() {
            let small = compress()?;
            let pays = small.len() < bytes.len() - bytes.len() / 20;
            // Written under another name first: an interrupted build leaves no half form.
            let partial = path.with_extension("partial");
            fs::write(&partial, if pays { &small } else { &[][..] })?;
            fs::rename(&partial, &path)?;
        }
        match fs::metadata(&path)?.len() {
            0 => Ok(bytes.len()),
            length => Ok(usize::try_from(length).unwrap_or(usize::MAX)),
        }
    };
    fs::create_dir_all(folder())?;
    let gzip = form("gz", &|| if for_participants { zopfli(bytes) } else { gzip(bytes) })?;
    let brotli = form("br", &|| brotli(bytes, if for_participants { 11 } else { 9 }))?;
    Ok(Packed { stem, gzip, brotli })
}

/// Removes the forms of all pages but those named by `stems`.
pub fn remove_all_but(stems: &[String]) -> Result<()> {
    for entry in fs::read_dir(folder())? {
        let path = entry?.path();
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        if !stem.is_some_and(|stem| stems.contains(&stem)) {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Gzip by Zopfli's search for the shortest code: a twentieth smaller than gzip's best level and a hundred times slower.
fn zopfli(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut packed = Vec::new();
    let options = zopfli::Options { iteration_count: ZOPFLI_ROUNDS, ..zopfli::Options::default() };
    zopfli::compress(options, zopfli::Format::Gzip, bytes, &mut packed)?;
    Ok(packed)
}

fn gzip(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut writer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    writer.write_all(bytes)?;
    writer.finish()
}

/// Brotli; quality 11 is a tenth smaller than 9 and as slow as Zopfli (1.5 seconds per megabyte).
fn brotli(bytes: &[u8], quality: i32) -> io::Result<Vec<u8>> {
    let mut packed = Vec::new();
    let parameters = BrotliEncoderParams {
        quality,
        lgwin: BROTLI_WINDOW,
        size_hint: bytes.len(),
        ..BrotliEncoderParams::default()
    };
    ::brotli::BrotliCompress(&mut &*bytes, &mut packed, &parameters)?;
    Ok(packed)
}
