//! UTF-16 as a stream of UTF-8.

use crate::formats::source::CHUNK;
use std::io::{BufRead, Read, Result};

/// UTF-8 of the UTF-16 that a reader gives, in either byte order. A surrogate alone becomes
/// U+FFFD; an odd last byte is dropped.
pub(super) struct Utf16<R> {
    inner: R,
    unit: fn([u8; 2]) -> u16,
    /// Bytes not decoded yet: an odd one, or the first half of a pair of surrogates.
    raw: Vec<u8>,
    text: String,
    /// Bytes of `text` that are given.
    given: usize,
}

impl<R: BufRead> Utf16<R> {
    pub(super) fn new(inner: R, unit: fn([u8; 2]) -> u16) -> Self {
        Self { inner, unit, raw: Vec::new(), text: String::new(), given: 0 }
    }

    /// Decode what the reader has at hand; `false` at its end.
    fn decode(&mut self) -> Result<bool> {
        let chunk = self.inner.fill_buf()?;
        let chunk = &chunk[..chunk.len().min(CHUNK)];
        let (length, at_end) = (chunk.len(), chunk.is_empty());
        self.raw.extend(chunk);
        self.inner.consume(length);
        let mut whole = self.raw.len() & !1;
        if !at_end
            && let [.., a, b] = self.raw[..whole]
            && (0xd800..0xdc00).contains(&(self.unit)([a, b]))
        {
            whole -= 2;
        }
        let units = self.raw[..whole].as_chunks::<2>().0.iter().map(|pair| (self.unit)(*pair));
        self.text.clear();
        self.given = 0;
        let decoded = char::decode_utf16(units);
        self.text.extend(decoded.map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)));
        self.raw.drain(..whole);
        Ok(!at_end || !self.text.is_empty())
    }
}

impl<R: BufRead> Read for Utf16<R> {
    fn read(&mut self, to: &mut [u8]) -> Result<usize> {
        while self.given == self.text.len() {
            if !self.decode()? {
                return Ok(0);
            }
        }
        let rest = &self.text.as_bytes()[self.given..];
        let length = rest.len().min(to.len());
        to[..length].copy_from_slice(&rest[..length]);
        self.given += length;
        Ok(length)
    }
}
