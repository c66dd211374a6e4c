//! The bytes of a CSV file as text: encoding and separator.

use rayon::iter::ParallelIterator;
use rayon::slice::ParallelSlice;

/// UTF-8 of a file's bytes, and where the text starts behind a byte order mark: UTF-8 is kept, UTF-16
/// with a mark and else Windows-1252 are converted.
pub(crate) fn decode(bytes: Vec<u8>) -> (Vec<u8>, usize) {
    if let Some(rest) = bytes.strip_prefix(b"\xff\xfe") {
        return (decode_utf16(rest, u16::from_le_bytes).into_bytes(), 0);
    }
    if let Some(rest) = bytes.strip_prefix(b"\xfe\xff") {
        return (decode_utf16(rest, u16::from_be_bytes).into_bytes(), 0);
    }
    let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    if bytes.par_chunks(1 << 20).all(<[u8]>::is_ascii) || std::str::from_utf8(&bytes).is_ok() {
        return (bytes, start);
    }
    let text: String = bytes[start..].iter().map(|&byte| windows_1252(byte)).collect();
    (text.into_bytes(), 0)
}

fn decode_utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
    String::from_utf16_lossy(&units)
}

fn windows_1252(byte: u8) -> char {
    const HIGH: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž',
        '\u{8f}', '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}',
        'ž', 'Ÿ',
    ];
    match byte {
        0x80..=0x9f => HIGH[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

/// The separator with which the first records have the same number of cells, and the most of them.
pub(crate) fn find_separator(text: &[u8]) -> char {
    let consistent_width = |separator: u8| {
        let widths = widths(text, separator, 50);
        let header = *widths.first()?;
        (header > 1).then_some((widths.iter().all(|&w| w == header), header))
    };
    [b',', b';', b'\t']
        .into_iter()
        .filter_map(|separator| Some((consistent_width(separator)?, separator)))
        // on a draw the earlier one stays
        .reduce(|best, next| if next.0 > best.0 { next } else { best })
        .map_or(
            // One column: with ';' a decimal comma is no separator.
            ';',
            |(_, separator)| char::from(separator),
        )
}

/// Cells in each of the first records.
fn widths(text: &[u8], separator: u8, records: usize) -> Vec<usize> {
    let mut widths = Vec::new();
    let (mut width, mut blank) = (1, true);
    // inside quotes; in a cell that began with a quote; at the start of a cell
    let (mut quoted, mut quoted_cell, mut at_start) = (false, false, true);
    for &byte in text {
        if quoted {
            quoted = byte != b'"';
        } else if byte == b'"' && (at_start || quoted_cell) {
            (quoted, quoted_cell, blank) = (true, true, false);
        } else if byte == separator {
            width += 1;
            (blank, quoted_cell, at_start) = (false, false, true);
            continue;
        } else if byte == b'\n' {
            if !blank {
                widths.push(width);
                if widths.len() == records {
                    return widths;
                }
            }
            (width, blank, quoted_cell, at_start) = (1, true, false, true);
            continue;
        } else if byte != b'\r' {
            blank = false;
        }
        at_start = false;
    }
    if !blank {
        widths.push(width);
    }
    widths
}
