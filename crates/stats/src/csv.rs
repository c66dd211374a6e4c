//! The bytes of a CSV file as text and cells: encoding, separator, quotes.

use crate::table::TableError;

/// Text with the place of every cell, header included.
pub(crate) struct RawCells {
    /// The text; quoted cells are unescaped in place.
    pub text: String,
    /// Start and end of each cell.
    pub cells: Vec<(u32, u32)>,
    /// Line of the file where each record starts, from 1.
    pub lines: Vec<u32>,
    /// Cells a record.
    pub width: usize,
}

/// Bytes as text: UTF-8, or UTF-16 with a byte order mark, else Windows-1252.
pub(crate) fn decode(bytes: &[u8]) -> String {
    if let Some(rest) = bytes.strip_prefix(b"\xff\xfe") {
        return decode_utf16(rest, u16::from_le_bytes);
    }
    if let Some(rest) = bytes.strip_prefix(b"\xfe\xff") {
        return decode_utf16(rest, u16::from_be_bytes);
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| windows_1252(byte)).collect(),
    }
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
pub(crate) fn find_separator(text: &str) -> char {
    let consistent_width = |separator: u8| {
        let widths = widths(text.as_bytes(), separator, 50);
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

/// Splits text into cells. Blank lines are skipped.
pub(crate) fn split(text: String, separator: char) -> Result<RawCells, TableError> {
    let separator = separator as u8;
    let mut bytes = text.into_bytes();
    let mut cells: Vec<(u32, u32)> = Vec::new();
    let mut lines: Vec<u32> = Vec::new();
    let (mut width, mut line, mut at) = (0, 1u32, 0);
    while at < bytes.len() {
        let (record, first_line) = (cells.len(), line);
        loop {
            let (cell, next) = if bytes.get(at) == Some(&b'"') {
                quoted_cell(&mut bytes, at, separator, &mut line)?
            } else {
                let rest = &bytes[at..];
                let length = rest
                    .iter()
                    .position(|&byte| byte == separator || byte == b'\n')
                    .unwrap_or(rest.len());
                ((at, at + length), at + length)
            };
            cells.push((cell.0 as u32, cell.1 as u32));
            at = next + 1;
            if bytes.get(next) != Some(&separator) {
                line += 1;
                break;
            }
        }
        if let Some(last) = cells.last_mut()
            && last.1 > last.0
            && bytes[last.1 as usize - 1] == b'\r'
        {
            last.1 -= 1;
        }
        let found = cells.len() - record;
        let (start, end) = cells[record];
        if found == 1 && bytes[start as usize..end as usize].iter().all(u8::is_ascii_whitespace) {
            // A blank line is no row, except where a single column makes it a missing cell.
            if width != 1 || at >= bytes.len() {
                cells.truncate(record);
                continue;
            }
        }
        if lines.is_empty() {
            width = found;
        } else if found != width {
            return Err(TableError::Ragged { line: first_line as usize, found, expected: width });
        }
        lines.push(first_line);
    }
    let text = String::from_utf8(bytes).unwrap_or_else(|e| decode(e.as_bytes()));
    Ok(RawCells { text, cells, lines, width })
}

/// The place of a quoted cell, unescaped in place, and of the separator or line end behind it.
fn quoted_cell(
    bytes: &mut [u8],
    open: usize,
    separator: u8,
    line: &mut u32,
) -> Result<((usize, usize), usize), TableError> {
    let first_line = *line;
    let (mut read, mut write) = (open + 1, open + 1);
    loop {
        match bytes.get(read) {
            None => return Err(TableError::OpenQuote { line: first_line as usize }),
            Some(b'"') if bytes.get(read + 1) == Some(&b'"') => {
                bytes[write] = b'"';
                read += 2;
                write += 1;
            }
            Some(b'"') => {
                read += 1;
                break;
            }
            Some(&byte) => {
                *line += u32::from(byte == b'\n');
                bytes[write] = byte;
                read += 1;
                write += 1;
            }
        }
    }
    // Whatever follows the closing quote up to the separator belongs to the cell (`"a" b`).
    let cell_end = write;
    let mut end = cell_end;
    while let Some(&byte) = bytes.get(read) {
        if byte == separator || byte == b'\n' {
            break;
        }
        if byte != b'\r' {
            bytes[end] = byte;
            end += 1;
        }
        read += 1;
    }
    Ok(((open + 1, end), read))
}

/// A finite number; with `decimal_comma` also `1,5`.
pub(crate) fn parse_number(cell: &str, decimal_comma: bool) -> Option<f64> {
    let parsed = cell.parse::<f64>().ok().or_else(|| {
        let with_point = decimal_comma
            && cell.bytes().filter(|&byte| byte == b',').count() == 1
            && !cell.contains('.');
        if with_point { cell.replace(',', ".").parse().ok() } else { None }
    })?;
    parsed.is_finite().then_some(parsed)
}
