//! The bytes of a CSV file as text: encoding and separator.

use encoding_rs::{Encoding, UTF_8, WINDOWS_1252};
use rayon::iter::ParallelIterator;
use rayon::slice::ParallelSlice;

/// UTF-8 of a file's bytes, and where the text starts behind a byte order mark: UTF-8 is kept, UTF-16
/// with a mark and else Windows-1252 are converted.
pub(crate) fn decode(bytes: Vec<u8>) -> (Vec<u8>, usize) {
    let converted = |encoding: &'static Encoding, start: usize| {
        let (text, _) = encoding.decode_without_bom_handling(&bytes[start..]);
        text.into_owned().into_bytes()
    };
    let (encoding, start) = Encoding::for_bom(&bytes).unwrap_or((UTF_8, 0));
    if encoding != UTF_8 {
        return (converted(encoding, start), 0);
    }
    if bytes.par_chunks(1 << 20).all(<[u8]>::is_ascii) || std::str::from_utf8(&bytes).is_ok() {
        return (bytes, start);
    }
    (converted(WINDOWS_1252, start), 0)
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
