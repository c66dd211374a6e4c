//! What is round every pack: four letters, a version, the length of the body, the body: deflated
//! (zlib, RFC 1950, which browsers inflate themselves), or as it is where hardly anything would come of it.

use super::bytes::{PackError, PackReader, PackWriter};

/// Bodies longer than this are taken for damage.
const LONGEST_BODY: usize = 1 << 29;

/// Deflates a body and puts the four letters of its kind, a version and its length in front.
pub fn seal_pack(kind: &'static str, version: u32, body: &[u8]) -> Vec<u8> {
    sealed(kind, version, body.len(), &miniz_oxide::deflate::compress_to_vec_zlib(body, 9))
}

/// The same with the body as it is.
pub fn seal_plain(kind: &'static str, version: u32, body: &[u8]) -> Vec<u8> {
    sealed(kind, version, body.len(), body)
}

fn sealed(kind: &'static str, version: u32, length: usize, stored: &[u8]) -> Vec<u8> {
    let mut pack = PackWriter::new();
    pack.raw(kind.as_bytes());
    pack.u32(version);
    pack.u32(length as u32);
    pack.raw(stored);
    pack.into_bytes()
}

/// The body of a pack of that kind and version.
///
/// # Errors
/// [`PackError`]: another kind or version, damaged, truncated.
pub fn open_pack(kind: &'static str, version: u32, bytes: &[u8]) -> Result<Vec<u8>, PackError> {
    let mut header = check_header(kind, version, bytes)?;
    let length = header.u32()? as usize;
    if length > LONGEST_BODY {
        return header.refuse(format!("a body of {length} bytes"));
    }
    let left = header.left();
    match miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(header.raw(left)?, length) {
        Ok(body) if body.len() == length => Ok(body),
        Ok(body) => header.refuse(format!("a body of {} bytes, {length} declared", body.len())),
        Err(e) => header.refuse(format!("the body cannot be inflated: {e}")),
    }
}

/// The body of a pack of that kind and version, made by [`seal_plain`] or inflated by somebody else.
///
/// # Errors
/// [`PackError`]: another kind or version, truncated, something behind its end.
pub fn open_plain<'b>(
    kind: &'static str,
    version: u32,
    bytes: &'b [u8],
) -> Result<&'b [u8], PackError> {
    let mut header = check_header(kind, version, bytes)?;
    let (length, left) = (header.u32()? as usize, header.left());
    if length != left {
        return header.refuse(format!("a body of {left} bytes, {length} declared"));
    }
    header.raw(left)
}

/// Refuses what is not of that kind and version; otherwise reads on behind them.
pub(super) fn check_header<'b>(
    kind: &'static str,
    version: u32,
    bytes: &'b [u8],
) -> Result<PackReader<'b>, PackError> {
    let mut header = PackReader::new(kind, bytes);
    let letters = header.raw(4)?;
    if letters != kind.as_bytes() {
        return header.refuse(format!("it opens with '{}'", String::from_utf8_lossy(letters)));
    }
    let found = header.u32()?;
    if found != version {
        return header.refuse(format!("version {found}, {version} expected"));
    }
    Ok(header)
}

/// The four letters that a file opens with, if it is a pack of any kind.
pub fn pack_kind(bytes: &[u8]) -> Option<&'static str> {
    ["MMAV", "MMOP", "MMTK"].into_iter().find(|kind| bytes.starts_with(kind.as_bytes()))
}
