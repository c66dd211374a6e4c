//! Cuts bytes into records and cells, from a given place on.

use super::{Mistake, Records};

/// The bytes of a file and what separates its cells.
pub(super) struct Cutter<'a> {
    bytes: &'a [u8],
    separator: u8,
    /// The separator in each byte of a word.
    separators: u64,
}

const ONES: u64 = 0x0101_0101_0101_0101;
const LINE_ENDS: u64 = b'\n' as u64 * ONES;

/// The lowest of the marked bytes is the lowest that is zero (Mycroft 1987).
fn zero_bytes(word: u64) -> u64 {
    word.wrapping_sub(ONES) & !word & (ONES << 7)
}

impl<'a> Cutter<'a> {
    /// Of a file.
    pub(super) fn of(bytes: &'a [u8], separator: u8) -> Self {
        Self { bytes, separator, separators: u64::from(separator) * ONES }
    }

    /// The first record that is not blank, its cells, and where the next one starts.
    pub(super) fn header(&self, first: usize) -> Result<(Records, usize, usize), Mistake> {
        let (mut records, mut at) = (Records::default(), first);
        while at < self.bytes.len() {
            let (next, found) = self.record(at, &mut records)?;
            if found > 1 || !self.blank(&records) {
                return Ok((records, found, next));
            }
            records = Records::default();
            at = next;
        }
        Ok((Records::default(), 0, at))
    }

    /// The records that start in `at..stop`, and where the one after them starts.
    pub(super) fn records(
        &self,
        mut at: usize,
        stop: usize,
        width: usize,
    ) -> Result<(Records, usize), Mistake> {
        let mut records = Records::default();
        // A guess that is seldom too small: some eight bytes a cell.
        records.offsets.reserve(stop.saturating_sub(at) / 8);
        while at < stop {
            let start = records.offsets.len();
            let (next, found) = self.record(at, &mut records)?;
            // A blank line is no record, except where a single column makes it a missing cell.
            let no_cell = width != 1 || next >= self.bytes.len();
            if found == 1 && no_cell && self.blank(&records) {
                records.offsets.truncate(start);
            } else if found != width {
                return Err(Mistake::Ragged { at, found });
            }
            at = next;
        }
        Ok((records, at))
    }

    /// Adds the record that starts at `at`; where the next one starts, and how many cells there are.
    fn record(&self, mut at: usize, records: &mut Records) -> Result<(usize, usize), Mistake> {
        let first = records.offsets.len();
        records.offsets.push(at as u32);
        loop {
            let quoted = self.bytes.get(at) == Some(&b'"');
            let (mut end, odd) =
                if quoted { self.quoted(at)? } else { (self.end_of_cell(at), false) };
            let (next, more) = (end + 1, self.bytes.get(end) == Some(&self.separator));
            if !more && end > at && self.bytes[end - 1] == b'\r' {
                end -= 1;
            }
            records.offsets.push(end as u32);
            if odd {
                records.odd.push((at as u32, end as u32));
            }
            at = next;
            if !more {
                return Ok((at, records.offsets.len() - first - 1));
            }
        }
    }

    /// The place of the first separator or line end.
    #[inline]
    fn end_of_cell(&self, mut at: usize) -> usize {
        while let Some(word) = self.bytes[at..].first_chunk() {
            let word = u64::from_le_bytes(*word);
            let found = zero_bytes(word ^ self.separators) | zero_bytes(word ^ LINE_ENDS);
            if found != 0 {
                return at + found.trailing_zeros() as usize / 8;
            }
            at += 8;
        }
        let rest = &self.bytes[at..];
        let found = rest.iter().position(|&byte| byte == self.separator || byte == b'\n');
        at + found.unwrap_or(rest.len())
    }

    /// The end of a cell that opens with a quote, and whether it is more than text between two quotes.
    fn quoted(&self, open: usize) -> Result<(usize, bool), Mistake> {
        let (mut at, mut odd) = (open + 1, false);
        loop {
            let rest = &self.bytes[at.min(self.bytes.len())..];
            let Some(more) = rest.iter().position(|&byte| byte == b'"') else {
                return Err(Mistake::OpenQuote { at: open });
            };
            at += more + 1;
            if self.bytes.get(at) != Some(&b'"') {
                break;
            }
            (at, odd) = (at + 1, true);
        }
        let end = self.end_of_cell(at);
        // The carriage return of the line end is no part of the cell.
        let behind = &self.bytes[at..end];
        let at_line_end = self.bytes.get(end) != Some(&self.separator);
        Ok((end, odd || !(behind.is_empty() || at_line_end && behind == b"\r")))
    }

    /// Whether nothing is written in the only cell of the last record.
    fn blank(&self, records: &Records) -> bool {
        let [.., start, end] = records.offsets[..] else { return false };
        let cell = &self.bytes[start as usize..end as usize];
        let blank = |text: &[u8]| text.iter().all(u8::is_ascii_whitespace);
        match cell {
            // Two quotes with blanks between and behind.
            [b'"', rest @ ..] => rest
                .iter()
                .position(|&byte| byte == b'"')
                .is_some_and(|close| blank(&rest[..close]) && blank(&rest[close + 1..])),
            text => blank(text),
        }
    }
}
