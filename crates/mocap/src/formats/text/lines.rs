//! A text file as lines, read as a stream: encodings and line ends.
//!
//! A first pass over the file decides both; the second gives the lines, one at a time. Of a file
//! of any length one line and one buffer are in memory.

use super::utf16::Utf16;
use crate::ReadError;
use crate::formats::source::{CHUNK, Source, beginning};
use std::io::{BufRead, BufReader, Read, SeekFrom};

/// Longest line, in bytes: a row of 65,535 markers has a tenth of it.
const LONGEST: u64 = 64 << 20;

/// How the bytes of a text file are to be read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct TextForm {
    encoding: Encoding,
    /// Bytes of the byte order mark.
    mark: u64,
    /// What ends a line: `\n` (a `\r` before it goes too) or, in a file without any, `\r`.
    end: u8,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Encoding {
    #[default]
    Utf8,
    Latin1,
    Utf16Little,
    Utf16Big,
}

impl TextForm {
    /// UTF-16 by its byte order mark, else UTF-8 where the whole file is, else Latin-1.
    ///
    /// # Errors
    /// [`ReadError::Read`].
    pub(crate) fn of(source: &mut dyn Source) -> Result<Self, ReadError> {
        let (encoding, mark) = match beginning(source, 3)?[..] {
            [0xff, 0xfe, ..] => (Encoding::Utf16Little, 2),
            [0xfe, 0xff, ..] => (Encoding::Utf16Big, 2),
            [0xef, 0xbb, 0xbf] => (Encoding::Utf8, 3),
            _ => (Encoding::Utf8, 0),
        };
        let form = Self { encoding, mark, end: b'\n' };
        let found = scan(&mut *form.decoded(source)?)?;
        Ok(Self {
            encoding: if found.utf8 { encoding } else { Encoding::Latin1 },
            mark,
            end: if found.newline { b'\n' } else { b'\r' },
        })
    }

    /// The text from its beginning, as UTF-8 or Latin-1.
    fn decoded<'s>(self, source: &'s mut dyn Source) -> Result<Box<dyn BufRead + 's>, ReadError> {
        source.seek(SeekFrom::Start(self.mark)).map_err(ReadError::Read)?;
        Ok(match self.encoding {
            Encoding::Utf8 | Encoding::Latin1 => Box::new(source),
            Encoding::Utf16Little => {
                Box::new(BufReader::with_capacity(CHUNK, Utf16::new(source, u16::from_le_bytes)))
            }
            Encoding::Utf16Big => {
                Box::new(BufReader::with_capacity(CHUNK, Utf16::new(source, u16::from_be_bytes)))
            }
        })
    }
}

/// What a pass over a text finds.
struct Scan {
    utf8: bool,
    newline: bool,
}

/// Whether a text is UTF-8, and whether it has a `\n`; stops as soon as both are known.
fn scan(text: &mut dyn BufRead) -> Result<Scan, ReadError> {
    let mut found = Scan { utf8: true, newline: false };
    // The first bytes of a character that the end of a chunk cuts.
    let mut cut: Vec<u8> = Vec::with_capacity(4);
    while found.utf8 || !found.newline {
        let chunk = match text.fill_buf() {
            Ok([]) => break,
            Ok(chunk) => chunk,
            Err(e) if e.kind() == std::io::ErrorKind::Interrupted => continue,
            Err(e) => return Err(ReadError::Read(e)),
        };
        found.newline = found.newline || chunk.contains(&b'\n');
        let mut rest = chunk;
        while !cut.is_empty()
            && let Some((first, after)) = rest.split_first()
        {
            cut.push(*first);
            rest = after;
            match std::str::from_utf8(&cut) {
                Ok(_) => cut.clear(),
                Err(e) if e.error_len().is_none() => {}
                Err(_) => {
                    found.utf8 = false;
                    cut.clear();
                }
            }
        }
        if let Err(e) = std::str::from_utf8(rest) {
            match e.error_len() {
                None => cut.extend(&rest[e.valid_up_to()..]),
                Some(_) => found.utf8 = false,
            }
        }
        let length = chunk.len();
        text.consume(length);
    }
    found.utf8 &= cut.is_empty();
    Ok(found)
}

/// The lines of a text file, one at a time, without their ends.
pub(crate) struct Lines<'s> {
    reader: Box<dyn BufRead + 's>,
    form: TextForm,
    length: u64,
    line: String,
    number: usize,
    more: bool,
}

impl<'s> Lines<'s> {
    /// From the first line of a source on.
    ///
    /// # Errors
    /// [`ReadError::Read`].
    pub(crate) fn new(source: &'s mut dyn Source, form: TextForm) -> Result<Self, ReadError> {
        let length = crate::formats::source::length(source)?;
        let reader = form.decoded(source)?;
        Ok(Self { reader, form, length, line: String::new(), number: 0, more: true })
    }

    /// Bytes of the file.
    pub(crate) fn length(&self) -> u64 {
        self.length
    }

    /// The next line with its number (1 = the first). A file that ends with a line end has an
    /// empty line after it.
    ///
    /// # Errors
    /// [`ReadError::Read`]; [`ReadError::Text`] for a line too long to be one.
    pub(crate) fn next(&mut self) -> Result<Option<(usize, &str)>, ReadError> {
        Ok(self.advance()?.then_some((self.number, &self.line)))
    }

    /// The next line that is not blank.
    ///
    /// # Errors
    /// As [`Lines::next`].
    pub(crate) fn next_filled(&mut self) -> Result<Option<(usize, &str)>, ReadError> {
        loop {
            if !self.advance()? {
                return Ok(None);
            }
            if !self.line.trim().is_empty() {
                return Ok(Some((self.number, &self.line)));
            }
        }
    }

    /// The next `N` lines, kept; where the file ends before, empty ones of number `number`.
    ///
    /// # Errors
    /// As [`Lines::next`].
    pub(crate) fn header<const N: usize>(
        &mut self,
        number: usize,
    ) -> Result<[(usize, String); N], ReadError> {
        let mut header = std::array::from_fn(|_| (number, String::new()));
        for kept in &mut header {
            if let Some((number, line)) = self.next()? {
                *kept = (number, line.to_owned());
            }
        }
        Ok(header)
    }

    /// Go to the next line; `false` where there is none.
    fn advance(&mut self) -> Result<bool, ReadError> {
        if !self.more {
            return Ok(false);
        }
        let mut bytes = std::mem::take(&mut self.line).into_bytes();
        bytes.clear();
        let mut limited = (&mut self.reader).take(LONGEST);
        limited.read_until(self.form.end, &mut bytes).map_err(ReadError::Read)?;
        self.number += 1;
        self.more = bytes.last() == Some(&self.form.end);
        if self.more {
            bytes.pop();
        } else if bytes.len() as u64 == LONGEST {
            return Err(ReadError::at_line(
                self.number,
                "line",
                format!("longer than {LONGEST} bytes"),
                "give a capture; this is no text of lines",
            ));
        }
        if bytes.last() == Some(&b'\r') {
            bytes.pop();
        }
        self.line = match self.form.encoding {
            Encoding::Latin1 => latin1(&bytes),
            // Latin-1 for a file that has changed since it was looked through.
            _ => String::from_utf8(bytes).unwrap_or_else(|e| latin1(e.as_bytes())),
        };
        Ok(true)
    }
}

fn latin1(bytes: &[u8]) -> String {
    bytes.iter().map(|&b| char::from(b)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufReader, Cursor};

    fn lines_of(source: &mut dyn Source) -> Vec<(usize, String)> {
        let form = TextForm::of(source).unwrap();
        let mut lines = Lines::new(source, form).unwrap();
        let mut all = Vec::new();
        while let Some((number, line)) = lines.next().unwrap() {
            all.push((number, line.to_owned()));
        }
        all
    }

    /// The lines of bytes in memory, which must be those of a stream cut anywhere.
    fn lines(bytes: &[u8]) -> Vec<(usize, String)> {
        let whole = lines_of(&mut Cursor::new(bytes));
        for capacity in [1, 2, 3, 7] {
            let stream = &mut BufReader::with_capacity(capacity, Cursor::new(bytes));
            assert_eq!(lines_of(stream), whole, "in pieces of {capacity}");
        }
        whole
    }

    fn texts(bytes: &[u8]) -> Vec<String> {
        lines(bytes).into_iter().map(|(_, line)| line).collect()
    }

    #[test]
    fn every_encoding_and_line_end_gives_the_same_lines() {
        let text = "a,\u{e9}\u{20ac}\u{1f600}\r\n1,2\r\n";
        let utf16 = |mark: [u8; 2], unit: fn(u16) -> [u8; 2]| -> Vec<u8> {
            mark.into_iter().chain(text.encode_utf16().flat_map(unit)).collect()
        };
        let marked: Vec<u8> = [0xef, 0xbb, 0xbf].into_iter().chain(text.bytes()).collect();
        for bytes in [
            text.as_bytes(),
            &marked,
            &utf16([0xff, 0xfe], u16::to_le_bytes),
            &utf16([0xfe, 0xff], u16::to_be_bytes),
            text.replace("\r\n", "\r").as_bytes(),
            text.replace("\r\n", "\n").as_bytes(),
        ] {
            let want = [(1, "a,\u{e9}\u{20ac}\u{1f600}"), (2, "1,2"), (3, "")];
            assert_eq!(lines(bytes), want.map(|(n, l)| (n, l.to_owned())));
        }
    }

    #[test]
    fn what_is_not_utf_8_anywhere_is_latin_1_everywhere() {
        assert_eq!(texts(b"caf\xc3\xa9\ncaf\xe9"), ["caf\u{c3}\u{a9}", "caf\u{e9}"]);
        assert_eq!(texts(b"caf\xc3\xa9\ncaf\xc3"), ["caf\u{c3}\u{a9}", "caf\u{c3}"], "cut short");
        assert_eq!(texts(b"caf\xc3\xa9\ncafe"), ["caf\u{e9}", "cafe"]);
    }

    #[test]
    fn a_carriage_return_ends_lines_only_where_nothing_else_does() {
        assert_eq!(texts(b"a\rb\nc"), ["a\rb", "c"]);
        assert_eq!(texts(b"a\rb"), ["a", "b"]);
        assert_eq!(texts(b""), [""]);
        assert_eq!(texts(b"\n\n"), ["", "", ""]);
    }
}
