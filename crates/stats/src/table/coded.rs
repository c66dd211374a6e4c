//! Cells as codes: which of the distinct ones each is.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use crate::table::factor::Factor;

/// Distinct cells and which of them each row has.
pub(crate) struct Coded<'a> {
    /// In the order of their first row.
    distinct: Vec<&'a [u8]>,
    /// Place among the distinct cells, [`Factor::MISSING`] where there is none.
    pub codes: Vec<u32>,
    places: HashMap<&'a [u8], u32, BuildHasherDefault<Words>>,
}

impl<'a> Coded<'a> {
    pub(crate) fn of(cells: impl Iterator<Item = Option<&'a [u8]>>) -> Self {
        let mut coded = Self {
            distinct: Vec::new(),
            codes: Vec::with_capacity(cells.size_hint().0),
            places: HashMap::default(),
        };
        for cell in cells {
            let code = cell.map_or(Factor::MISSING, |cell| coded.place(cell));
            coded.codes.push(code);
        }
        coded
    }

    fn place(&mut self, cell: &'a [u8]) -> u32 {
        *self.places.entry(cell).or_insert_with(|| {
            self.distinct.push(cell);
            self.distinct.len() as u32 - 1
        })
    }

    /// Rows of several pieces one after another.
    pub(crate) fn joined(pieces: Vec<Self>) -> Self {
        let mut pieces = pieces.into_iter();
        let Some(mut all) = pieces.next() else { return Self::of(std::iter::empty()) };
        for piece in pieces {
            let codes: Vec<u32> = piece.distinct.iter().map(|cell| all.place(cell)).collect();
            all.codes.extend(
                piece
                    .codes
                    .iter()
                    .map(|&code| codes.get(code as usize).copied().unwrap_or(Factor::MISSING)),
            );
        }
        all
    }

    /// The distinct cells as text.
    pub(crate) fn labels(&self, text: impl Fn(&'a [u8]) -> &'a str) -> Vec<&'a str> {
        self.distinct.iter().map(|cell| text(cell)).collect()
    }
}

/// A hash of eight bytes at a time by rotation and multiplication (as in Firefox and rustc): cells are
/// short, and nobody gains by choosing their own.
#[derive(Default)]
struct Words(u64);

impl Hasher for Words {
    #[inline]
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let word = chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
            self.write_u64(word);
        }
    }

    #[inline]
    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x517c_c1b7_2722_0a95);
    }

    #[inline]
    fn write_usize(&mut self, length: usize) {
        self.write_u64(length as u64);
    }

    fn finish(&self) -> u64 {
        // The top bits are the well mixed ones; the table looks at the lowest too.
        self.0.rotate_left(26)
    }
}
