//! The header of a NumPy array, read and written.
//!
//! It is a Python literal with three keys, read here in fifty lines. `npyz` and `ndarray-npy` read it by a
//! grammar of all literals of Python, whose parser and big numbers the studio's module would carry.

use crate::ReadError;
use crate::formats::source::{self, Source};

/// What every array begins with.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";
/// Longest header: names and sizes of three keys take a hundred bytes.
const LONGEST_HEADER: u64 = 1 << 16;

/// The header of an array of R dimensions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header<const R: usize> {
    /// Bytes of a number: 4 or 8.
    pub(super) width: usize,
    pub(super) big_endian: bool,
    pub(super) fortran_order: bool,
    pub(super) shape: [usize; R],
    /// Where the numbers begin, bytes from the start of the file.
    pub(super) data: u64,
}

/// Read and check the header; `remedy` is what to do about an array that is none of R dimensions.
pub(super) fn header<const R: usize>(
    file: &mut dyn Source,
    length: u64,
    remedy: &'static str,
) -> Result<Header<R>, ReadError> {
    let Description { keys, text_at, data } = description(file, length, remedy)?;
    let wrong = |what: String| ReadError::at_byte(text_at, "header", what, remedy);
    let (width, big_endian) = match &keys.descr[..] {
        "<f4" => (4, false),
        ">f4" => (4, true),
        "<f8" => (8, false),
        ">f8" => (8, true),
        other => return Err(wrong(format!("numbers of type {other:?}"))),
    };
    let other = || wrong(format!("an array of shape {:?}", keys.shape));
    let shape: [usize; R] = keys.shape[..].try_into().map_err(|_| other())?;
    if shape.get(1..).is_some_and(|rest| rest.contains(&0)) {
        return Err(other());
    }
    held_against(&keys.shape, width, length - data, data)?;
    Ok(Header { width, big_endian, fortran_order: keys.fortran_order, shape, data })
}

/// Refuses an array that does not fill its file.
pub(super) fn held_against(
    shape: &[usize],
    width: usize,
    bytes: u64,
    data: u64,
) -> Result<(), ReadError> {
    let numbers = shape.iter().try_fold(1_usize, |all, n| all.checked_mul(*n));
    let wanted = numbers.and_then(|n| n.checked_mul(width)).map(|n| n as u64);
    if wanted == Some(bytes) {
        return Ok(());
    }
    let counts: Vec<String> = shape.iter().map(ToString::to_string).collect();
    let what = format!(
        "{bytes} bytes of numbers, {} of them at {width} bytes are {}",
        counts.join(" x "),
        wanted.map_or("beyond memory".to_owned(), |n| n.to_string())
    );
    Err(ReadError::at_byte(data, "data", what, "copy the file again, or save one array per file"))
}

/// What a header says, and where it and the numbers stand.
pub(super) struct Description {
    pub(super) keys: Keys,
    /// Where its text begins, bytes from the start of the file.
    text_at: u64,
    /// Where the numbers begin.
    pub(super) data: u64,
}

/// Reads what the header says of an array of any type and shape.
pub(super) fn description(
    file: &mut dyn Source,
    length: u64,
    remedy: &'static str,
) -> Result<Description, ReadError> {
    let wrong = |at: u64, what: String| ReadError::at_byte(at, "header", what, remedy);
    let start = source::beginning(file, 12)?;
    let [_, _, _, _, _, _, major, minor, a, b, c, d] = start[..] else {
        return Err(wrong(length, format!("the file ends after {length} bytes")));
    };
    let (size, text_at) = match (major, minor) {
        (1, 0) => (u64::from(u16::from_le_bytes([a, b])), 10),
        (2 | 3, 0) => (u64::from(u32::from_le_bytes([a, b, c, d])), 12),
        _ => return Err(wrong(6, format!("format {major}.{minor}, not 1.0, 2.0 or 3.0"))),
    };
    let data = text_at + size;
    if size > LONGEST_HEADER || data > length {
        let what = format!("a header of {size} bytes in a file of {length}");
        return Err(wrong(8, what));
    }
    let bytes = source::beginning(file, data)?;
    let text = String::from_utf8_lossy(bytes.get(text_at as usize..).unwrap_or_default());
    let keys = literal(&text).ok_or_else(|| {
        wrong(text_at, format!("{:?} is not the dictionary of an array", text.trim()))
    })?;
    Ok(Description { keys, text_at, data })
}

/// The shape in the first bytes of a file, where the header is whole there.
pub(super) fn shape_at_the_beginning(bytes: &[u8]) -> Option<Vec<usize>> {
    let text = bytes.strip_prefix(MAGIC)?;
    let start = text.iter().position(|b| *b == b'{')?;
    let end = text.iter().position(|b| *b == b'}')?;
    let text = std::str::from_utf8(text.get(start..=end)?).ok()?;
    literal(text).map(|keys| keys.shape)
}

/// The values of the header's three keys.
pub(super) struct Keys {
    pub(super) descr: String,
    pub(super) fortran_order: bool,
    pub(super) shape: Vec<usize>,
}

/// A dictionary as NumPy writes it; `None` for anything else.
fn literal(text: &str) -> Option<Keys> {
    let mut rest = text.trim().strip_prefix('{')?.strip_suffix('}')?.trim();
    let (mut descr, mut fortran_order, mut shape) = (None, None, None);
    while !rest.is_empty() {
        let (key, after) = quoted(rest)?;
        rest = after.trim_start().strip_prefix(':')?.trim_start();
        rest = match key {
            "descr" => {
                let (value, after) = quoted(rest)?;
                descr = Some(value.to_owned());
                after
            }
            "fortran_order" => {
                let (value, after) = rest
                    .strip_prefix("True")
                    .map(|after| (true, after))
                    .or_else(|| rest.strip_prefix("False").map(|after| (false, after)))?;
                fortran_order = Some(value);
                after
            }
            "shape" => {
                let (inside, after) = rest.strip_prefix('(')?.split_once(')')?;
                // One number has a comma after it, and several may.
                let inside = inside.trim();
                let numbers = inside.strip_suffix(',').unwrap_or(inside).split(',').map(str::trim);
                shape = Some(match inside {
                    "" => Vec::new(),
                    _ => numbers.map(|n| n.parse().ok()).collect::<Option<Vec<usize>>>()?,
                });
                after
            }
            _ => return None,
        };
        rest = rest.trim_start();
        rest = rest.strip_prefix(',').or(rest.is_empty().then_some(rest))?.trim_start();
    }
    Some(Keys { descr: descr?, fortran_order: fortran_order?, shape: shape? })
}

/// A quoted string without escapes at the start of a text, and what follows it.
fn quoted(text: &str) -> Option<(&str, &str)> {
    let quote = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    text[1..].split_once(quote)
}

/// The header of an array in C order, format 1.0, with the numbers' type, e.g. `<f8`.
///
/// Magic, version, length and text fill whole lines of 64 bytes.
pub fn npy_header(descr: &str, shape: &[usize]) -> Vec<u8> {
    let shape: Vec<String> = shape.iter().map(ToString::to_string).collect();
    let comma = if shape.len() == 1 { "," } else { "" };
    let text = format!(
        "{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}{comma}), }}",
        shape.join(", ")
    );
    let padded = (10 + text.len() + 1).next_multiple_of(64) - 11;
    let mut header = [MAGIC, &[1, 0], &((padded + 1) as u16).to_le_bytes()].concat();
    header.extend(format!("{text:padded$}\n").into_bytes());
    header
}
