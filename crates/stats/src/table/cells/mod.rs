//! The bytes of a CSV file cut into cells, several pieces of the file at the same time.
//!
//! Each piece begins after a line end. Whether that line end stood inside quotes is known only once the
//! piece before has been cut: then the piece is cut again from where the last record really ended. So
//! the cells, and the first mistake, are those of reading from the first byte to the last.

mod cutter;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use cutter::Cutter;

/// Bytes of a piece.
pub(crate) const PIECE: usize = 1 << 21;

/// Where the cells of a file are.
pub(crate) struct Cells {
    /// Cells a record.
    pub width: usize,
    /// The first record.
    pub header: Records,
    /// The others, piece after piece.
    pub pieces: Vec<Records>,
}

/// Records one after another.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Records {
    /// Start of each record and the ends of its cells: `width + 1` numbers a record.
    offsets: Vec<u32>,
    /// Start and end of quoted cells that are more than text between two quotes.
    odd: Vec<(u32, u32)>,
}

/// What cannot be cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mistake {
    /// The record that starts here has another number of cells than the header.
    Ragged { at: usize, found: usize },
    /// The quote here is never closed.
    OpenQuote { at: usize },
}

impl Records {
    /// Number of records.
    pub(crate) fn len(&self, width: usize) -> usize {
        self.offsets.len() / (width + 1)
    }

    /// Start and end of a cell, quotes included.
    pub(crate) fn place(&self, record: usize, column: usize, width: usize) -> (usize, usize) {
        let own = &self.offsets[record * (width + 1)..][..width + 1];
        let start = if column == 0 { own[0] } else { own[column] + 1 };
        (start as usize, own[column + 1] as usize)
    }

    /// Start of a record.
    pub(crate) fn start(&self, record: usize, width: usize) -> usize {
        self.offsets[record * (width + 1)] as usize
    }
}

/// Cuts a file of less than 4 GiB from `first` on. Blank lines are skipped, but between the records of a
/// single column they are missing cells. No record at all gives a width of 0. A mistake comes with the
/// width.
pub(crate) fn cut(
    bytes: &mut [u8],
    first: usize,
    separator: u8,
    piece: usize,
) -> Result<Cells, (Mistake, usize)> {
    let cutter = Cutter::of(bytes, separator);
    let (header, width, body) = cutter.header(first).map_err(|mistake| (mistake, 0))?;
    // Starts of the pieces, as far as line ends tell.
    let mut starts = vec![body];
    while let Some(from) = starts.last().map(|last| last + piece).filter(|&from| from < bytes.len())
    {
        match bytes[from..].iter().position(|&byte| byte == b'\n') {
            Some(more) if from + more + 1 < bytes.len() => starts.push(from + more + 1),
            _ => break,
        }
    }
    starts.push(bytes.len());
    let supposed: Vec<_> = (0..starts.len() - 1)
        .into_par_iter()
        .map(|k| cutter.records(starts[k], starts[k + 1], width))
        .collect();
    let mut pieces = Vec::with_capacity(supposed.len());
    let mut at = body;
    for (k, supposed) in supposed.into_iter().enumerate() {
        let found =
            if at == starts[k] { supposed } else { cutter.records(at, starts[k + 1], width) };
        let (records, end) = found.map_err(|mistake| (mistake, width))?;
        pieces.push(records);
        at = end;
    }
    for records in std::iter::once(&header).chain(&pieces) {
        for &(start, end) in &records.odd {
            unescape(&mut bytes[start as usize..end as usize]);
        }
    }
    Ok(Cells { width, header, pieces })
}

/// What is written in a cell: without its quotes.
pub(crate) fn unquoted(cell: &[u8]) -> &[u8] {
    let [b'"', rest @ ..] = cell else { return cell };
    let end = rest.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    rest[..end].strip_suffix(b"\"").unwrap_or(&rest[..end])
}

/// Rewrites a quoted cell in place as its text between two quotes, then zeros: quotes written twice
/// become one, what follows the closing quote (`"a" b`) belongs to the text.
fn unescape(cell: &mut [u8]) {
    let (mut read, mut write) = (1, 1);
    while let Some(&byte) = cell.get(read) {
        if byte == b'"' {
            read += 1;
            if cell.get(read) != Some(&b'"') {
                break;
            }
        }
        cell[write] = byte;
        read += 1;
        write += 1;
    }
    while let Some(&byte) = cell.get(read) {
        if byte != b'\r' {
            cell[write] = byte;
            write += 1;
        }
        read += 1;
    }
    cell[write] = b'"';
    cell[write + 1..].fill(0);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Records of cells as one reads them, a byte at a time; or the mistake.
    fn slowly(text: &[u8], separator: u8) -> Result<Vec<Vec<Vec<u8>>>, Mistake> {
        let (mut records, mut at): (Vec<Vec<Vec<u8>>>, usize) = (Vec::new(), 0);
        while at < text.len() {
            let (start, mut record) = (at, Vec::new());
            loop {
                let (open, mut cell) = (at, Vec::new());
                if text.get(at) == Some(&b'"') {
                    at += 1;
                    loop {
                        match text[at..] {
                            [] => return Err(Mistake::OpenQuote { at: open }),
                            [b'"', b'"', ..] => {
                                cell.push(b'"');
                                at += 2;
                            }
                            [b'"', ..] => {
                                at += 1;
                                break;
                            }
                            [byte, ..] => {
                                cell.push(byte);
                                at += 1;
                            }
                        }
                    }
                    while at < text.len() && text[at] != separator && text[at] != b'\n' {
                        if text[at] != b'\r' {
                            cell.push(text[at]);
                        }
                        at += 1;
                    }
                } else {
                    while at < text.len() && text[at] != separator && text[at] != b'\n' {
                        cell.push(text[at]);
                        at += 1;
                    }
                    if text.get(at) != Some(&separator) && cell.last() == Some(&b'\r') {
                        cell.pop();
                    }
                }
                record.push(cell);
                at += 1;
                if text.get(at - 1) != Some(&separator) {
                    break;
                }
            }
            let width = records.first().map_or(0, Vec::len);
            let blank = record.len() == 1 && record[0].iter().all(u8::is_ascii_whitespace);
            if blank && (width != 1 || at >= text.len()) {
                continue;
            }
            if width > 0 && record.len() != width {
                return Err(Mistake::Ragged { at: start, found: record.len() });
            }
            records.push(record);
        }
        Ok(records)
    }

    fn quickly(text: &[u8], piece: usize) -> Result<Vec<Vec<Vec<u8>>>, Mistake> {
        let mut bytes = text.to_vec();
        let cells = cut(&mut bytes, 0, b',', piece).map_err(|(mistake, _)| mistake)?;
        let width = cells.width;
        let records = std::iter::once(&cells.header).chain(&cells.pieces).flat_map(|records| {
            (0..records.len(width)).map(|record| {
                (0..width)
                    .map(|column| {
                        let (start, end) = records.place(record, column, width);
                        unquoted(&bytes[start..end]).to_vec()
                    })
                    .collect()
            })
        });
        Ok(records.collect())
    }

    fn agree(text: &[u8], piece: usize) {
        let shown = String::from_utf8_lossy(text);
        assert_eq!(quickly(text, piece), slowly(text, b','), "{shown:?} in pieces of {piece}");
    }

    #[test]
    fn cells_of_every_kind_are_cut() {
        for text in [
            "",
            "\n",
            "a",
            "a\n",
            "a,b\n1,2",
            "a,b\r\n1,2\r\n",
            "a\n\n1\n\n",
            "\n\na,b\n\n1,2\n",
            "\"a\",b\n\"x\ny\",2\n",
            "\"a\"\"b\",c\n\"\"\"\",\"\"\n",
            "a,b\n\"x\" y,\"z\"\r\n",
            "a,b\n1,\"2\n",
            "a,b\n1,2,3\n",
            "a\n\"\"\n\" \"\n1\n",
            "a,b\n5\" disc,2\n",
            "a,b\n\"x\"\r,\"y\r\"\r\n",
            "a,b\n,\n,\n",
            "a\n\"",
        ] {
            for piece in [1, 2, 5, 1000] {
                agree(text.as_bytes(), piece);
            }
        }
    }

    proptest! {
        /// Any text of the bytes that mean something, in pieces of any size.
        #[test]
        fn any_text_is_cut_as_if_read_slowly(
            text in proptest::collection::vec(
                prop_oneof![
                    4 => Just(b"1".as_slice()), 3 => Just(b",".as_slice()), 2 => Just(b"\n".as_slice()),
                    1 => Just(b"\r\n".as_slice()), 2 => Just(b"\"".as_slice()),
                    1 => Just(b"\"x\ny\"".as_slice()), 1 => Just(b" ".as_slice()),
                    1 => Just(b"\r".as_slice()), 1 => Just("é".as_bytes()),
                ],
                0..60,
            ),
            piece in 1usize..40,
        ) {
            agree(&text.concat(), piece);
        }

        /// Whole tables, some cells quoted for no reason, line ends inside them.
        #[test]
        fn any_table_is_cut_as_if_read_slowly(
            rows in (1usize..5).prop_flat_map(|width| proptest::collection::vec(
                proptest::collection::vec(("[a-c0-9 .\"\n,é]{0,12}", any::<bool>()), width), 1..30)),
            carriage in any::<bool>(),
            piece in 1usize..200,
        ) {
            let line_end = if carriage { "\r\n" } else { "\n" };
            let text: String = rows.iter().map(|row| {
                let cells: Vec<String> = row.iter().map(|(cell, quoted)| {
                    if *quoted || cell.contains([',', '\n', '"']) {
                        format!("\"{}\"", cell.replace('"', "\"\""))
                    } else {
                        cell.clone()
                    }
                }).collect();
                cells.join(",") + line_end
            }).collect();
            agree(text.as_bytes(), piece);
        }
    }
}
