//! Distinct values of a sample and how often each occurs.
//!
//! With few distinct values (ratings) nothing of the length of the data is sorted.

use crate::ranks::radix;

/// Distinct values beyond which sorting replaces counting.
pub(crate) const COUNTED: usize = 4096;

/// Distinct values in ascending order with their counts.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tally {
    pub values: Vec<f64>,
    pub counts: Vec<u64>,
}

impl Tally {
    /// Of finite values; -0 and 0 are one value.
    pub(crate) fn of(sample: &[f64]) -> Self {
        if let Some(tally) = Self::by_counting(sample) {
            return tally;
        }
        let mut tally = Self { values: Vec::new(), counts: Vec::new() };
        for group in radix::sorted(sample).chunk_by(|a, b| a == b) {
            tally.values.push(group[0]);
            tally.counts.push(group.len() as u64);
        }
        tally
    }

    fn by_counting(sample: &[f64]) -> Option<Self> {
        let mut found = Found::new();
        let mut counts = vec![0u64; COUNTED + 1];
        for &value in sample {
            counts[found.code(value)? as usize] += 1;
        }
        let order = found.order();
        Some(Self {
            values: order.iter().map(|&old| found.values[old as usize]).collect(),
            counts: order.iter().map(|&old| counts[old as usize]).collect(),
        })
    }

    /// Values with repetition.
    pub(crate) fn total(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Whether a value occurs.
    pub(crate) fn has(&self, value: f64) -> bool {
        self.values.binary_search_by(|other| other.total_cmp(&(value + 0.0))).is_ok()
    }

    /// Without one value.
    pub(crate) fn without(&self, value: f64) -> Self {
        let kept = || self.values.iter().zip(&self.counts).filter(move |(v, _)| **v != value);
        Self {
            values: kept().map(|(value, _)| *value).collect(),
            counts: kept().map(|(_, count)| *count).collect(),
        }
    }

    /// Sum over groups of equal values of t^3 - t.
    pub(crate) fn tie_term(&self) -> f64 {
        self.counts.iter().map(|&t| t as f64).map(|t| t * (t * t - 1.0)).sum()
    }
}

/// Distinct values in the order of their first occurrence: an open table of their bits.
pub(crate) struct Found {
    pub values: Vec<f64>,
    /// One more than the place in `values`; 0 is free. Four times as long as values are counted.
    table: Vec<u32>,
}

const TABLE_BITS: u32 = 14;

impl Found {
    pub(crate) fn new() -> Self {
        Self { values: Vec::new(), table: vec![0; 1 << TABLE_BITS] }
    }

    /// Place of a value among those found, itself included; none for one too many.
    #[inline]
    pub(crate) fn code(&mut self, value: f64) -> Option<u32> {
        let value = value + 0.0; // -0 becomes 0
        // Fibonacci hashing (Knuth, vol. 3, 6.4): the top bits of the product are well mixed.
        let hash = value.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut slot = (hash >> (64 - TABLE_BITS)) as usize;
        loop {
            match self.table[slot] {
                0 => break,
                code if self.values[code as usize - 1] == value => return Some(code - 1),
                _ => slot = (slot + 1) & ((1 << TABLE_BITS) - 1),
            }
        }
        if self.values.len() == COUNTED {
            return None;
        }
        self.values.push(value);
        self.table[slot] = self.values.len() as u32;
        Some(self.values.len() as u32 - 1)
    }

    /// Places of the values in ascending order.
    pub(crate) fn order(&self) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.values.len() as u32).collect();
        order.sort_by(|&a, &b| self.values[a as usize].total_cmp(&self.values[b as usize]));
        order
    }
}
