//! Integers at the length that their frequency deserves: an adaptive binary range coder.
//!
//! An integer is coded as the length of its magnitude in bits (a one a bit, then a zero), its sign,
//! and what follows its leading bit. Every bit but the lowest ones of large numbers has a
//! probability of its own in the [`Model`], which learns from what went before: encoder and decoder
//! learn the same. All arithmetic is of integers, the same on every machine. The coder is that of
//! LZMA (Igor Pavlov), with probabilities of 16 bits.

/// Bits of a probability.
const PRECISION: u32 = 16;
/// A probability learns from at most about so many bits.
const MEMORY: u16 = 80;
/// No probability falls below this: no bit costs nothing, none more than 10.
const LEAST: u16 = 1 << (PRECISION - 10);
/// Bits after the leading one that are learnt.
const LEARNT: u32 = 2;
/// Lengths of magnitudes: 0 to 32.
const LENGTHS: usize = 33;

/// Writes or reads integers; one function can be both halves of a format.
pub trait Integers {
    /// Writes `value` and answers it, or answers what is read and ignores `value`. `context` below
    /// the model's number; a greater one counts as the last.
    fn integer(&mut self, model: &mut Model, context: usize, value: i32) -> i32;

    /// Whether more was read than was ever written: damage.
    fn spent(&self) -> bool;

    /// Whether values go in and not out.
    fn writes(&self) -> bool;
}

/// The probability that a bit is 0.
#[derive(Debug, Clone, Copy)]
struct Bit {
    zero: u16,
    seen: u16,
}

impl Bit {
    const EVEN: Self = Self { zero: 1 << (PRECISION - 1), seen: 0 };

    fn learn(&mut self, bit: bool) {
        let rate = i32::from(self.seen) + 2;
        let aim = if bit { i32::from(LEAST) } else { i32::from(u16::MAX - LEAST) };
        let zero = i32::from(self.zero);
        self.zero = (zero + (aim - zero) / rate) as u16;
        self.seen = (self.seen + 1).min(MEMORY);
    }
}

/// What has been learnt about one kind of integer, context by context.
#[derive(Debug, Clone)]
pub struct Model {
    contexts: Vec<Context>,
}

#[derive(Debug, Clone)]
struct Context {
    lengths: [Bit; LENGTHS],
    sign: Bit,
    /// By length, then the bits after the leading one as a tree.
    tops: [[Bit; 1 << LEARNT]; LENGTHS],
}

impl Model {
    /// A model of so many contexts, at least one, that knows nothing.
    pub fn new(contexts: usize) -> Self {
        let context = Context {
            lengths: [Bit::EVEN; LENGTHS],
            sign: Bit::EVEN,
            tops: [[Bit::EVEN; 1 << LEARNT]; LENGTHS],
        };
        Self { contexts: vec![context; contexts.max(1)] }
    }
}

/// How long the magnitude of a value is, bits.
pub fn magnitude_bits(value: i32) -> u32 {
    32 - value.unsigned_abs().leading_zeros()
}

/// One bit in, the bit out: both halves of the coder.
trait Bits {
    fn bit(&mut self, zero: u32, bit: bool) -> bool;
}

fn learnt_bit(coder: &mut impl Bits, bit: &mut Bit, value: bool) -> bool {
    let value = coder.bit(u32::from(bit.zero), value);
    bit.learn(value);
    value
}

fn integer(coder: &mut impl Bits, model: &mut Model, context: usize, value: i32) -> i32 {
    let last = model.contexts.len() - 1;
    let context = &mut model.contexts[context.min(last)];
    let (length, magnitude) = (magnitude_bits(value), value.unsigned_abs());
    let mut n = 0u32;
    while n < 32 && learnt_bit(coder, &mut context.lengths[n as usize], n < length) {
        n += 1;
    }
    if n == 0 {
        return 0;
    }
    let negative = learnt_bit(coder, &mut context.sign, value < 0);
    let (mut out, mut node) = (1u32, 1usize);
    for place in (0..n - 1).rev() {
        let bit = magnitude >> place & 1 == 1;
        let bit = if node < 1 << LEARNT {
            let bit = learnt_bit(coder, &mut context.tops[n as usize][node], bit);
            node = 2 * node + usize::from(bit);
            bit
        } else {
            coder.bit(1 << (PRECISION - 1), bit)
        };
        out = out << 1 | u32::from(bit);
    }
    if negative { (out as i32).wrapping_neg() } else { out as i32 }
}

/// Writes integers.
#[derive(Debug)]
pub struct IntegerWriter {
    low: u64,
    range: u32,
    /// The last byte that a carry may still change, and how many 255 follow it.
    held: Option<u8>,
    full: usize,
    out: Vec<u8>,
}

impl Default for IntegerWriter {
    fn default() -> Self {
        Self { low: 0, range: u32::MAX, held: None, full: 0, out: Vec::new() }
    }
}

impl IntegerWriter {
    /// One that has written nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// All that was written.
    pub fn into_bytes(mut self) -> Vec<u8> {
        for _ in 0..5 {
            self.shift();
        }
        // The reader takes what is missing at the end for zeros.
        let least = self.out.len().saturating_sub(4);
        while self.out.len() > least && self.out.last() == Some(&0) {
            self.out.pop();
        }
        self.out
    }

    fn shift(&mut self) {
        if self.low < 0xff00_0000 || self.low > 0xffff_ffff {
            let carry = (self.low >> 32) as u8;
            if let Some(held) = self.held {
                self.out.push(held.wrapping_add(carry));
            }
            self.out.extend(std::iter::repeat_n(255u8.wrapping_add(carry), self.full));
            self.full = 0;
            self.held = Some((self.low >> 24) as u8);
        } else {
            self.full += 1;
        }
        self.low = (self.low & 0x00ff_ffff) << 8;
    }
}

impl Bits for IntegerWriter {
    fn bit(&mut self, zero: u32, bit: bool) -> bool {
        let bound = (self.range >> PRECISION) * zero;
        if bit {
            self.low += u64::from(bound);
            self.range -= bound;
        } else {
            self.range = bound;
        }
        while self.range < 1 << 24 {
            self.range <<= 8;
            self.shift();
        }
        bit
    }
}

impl Integers for IntegerWriter {
    fn integer(&mut self, model: &mut Model, context: usize, value: i32) -> i32 {
        integer(self, model, context, value)
    }

    fn spent(&self) -> bool {
        false
    }

    fn writes(&self) -> bool {
        true
    }
}

/// Reads what an [`IntegerWriter`] wrote.
#[derive(Debug)]
pub struct IntegerReader<'a> {
    bytes: &'a [u8],
    at: usize,
    code: u32,
    range: u32,
}

impl<'a> IntegerReader<'a> {
    /// Reads from the first byte.
    pub fn new(bytes: &'a [u8]) -> Self {
        let mut reader = Self { bytes, at: 0, code: 0, range: u32::MAX };
        for _ in 0..4 {
            reader.code = reader.code << 8 | reader.next();
        }
        reader
    }

    fn next(&mut self) -> u32 {
        let byte = self.bytes.get(self.at).copied().unwrap_or(0);
        self.at += 1;
        u32::from(byte)
    }
}

impl Bits for IntegerReader<'_> {
    fn bit(&mut self, zero: u32, _: bool) -> bool {
        let bound = (self.range >> PRECISION) * zero;
        let bit = self.code >= bound;
        if bit {
            self.code -= bound;
            self.range -= bound;
        } else {
            self.range = bound;
        }
        while self.range < 1 << 24 {
            self.range <<= 8;
            self.code = self.code << 8 | self.next();
        }
        bit
    }
}

impl Integers for IntegerReader<'_> {
    fn integer(&mut self, model: &mut Model, context: usize, value: i32) -> i32 {
        let _ = value;
        integer(self, model, context, 0)
    }

    fn writes(&self) -> bool {
        false
    }

    fn spent(&self) -> bool {
        // The writer leaves up to four zeros out; the reader is four bytes ahead.
        self.at > self.bytes.len() + 8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(seed: &mut u64) -> u64 {
        *seed ^= *seed << 13;
        *seed ^= *seed >> 7;
        *seed ^= *seed << 17;
        *seed
    }

    fn written(values: &[i32], contexts: usize) -> Vec<u8> {
        let (mut writer, mut model) = (IntegerWriter::new(), Model::new(contexts));
        for (i, &value) in values.iter().enumerate() {
            assert_eq!(writer.integer(&mut model, i % contexts, value), value);
        }
        writer.into_bytes()
    }

    #[test]
    fn every_integer_comes_back() {
        let mut seed = 7;
        let mut values = vec![0, 1, -1, i32::MAX, i32::MIN, i32::MIN + 1, 255, -256];
        for _ in 0..20_000 {
            let shift = noise(&mut seed) % 33;
            values.push(((noise(&mut seed) as u32).checked_shr(shift as u32).unwrap_or(0)) as i32);
        }
        values.extend([0; 5000]);
        values.push(-3);
        values.extend([i32::MIN; 40]);
        let bytes = written(&values, 3);
        let (mut reader, mut model) = (IntegerReader::new(&bytes), Model::new(3));
        for (i, &value) in values.iter().enumerate() {
            assert_eq!(reader.integer(&mut model, i % 3, 0), value, "integer {i}");
        }
        assert!(!reader.spent());
        let mut surplus = 0;
        while !reader.spent() {
            reader.integer(&mut model, 0, 0);
            surplus += 1;
        }
        assert!(surplus < 2_000_000, "{surplus} integers out of nothing");
    }

    #[test]
    fn what_is_frequent_is_short() {
        // -3 to 3 with the same frequency: 2.807 bits of entropy each.
        let mut seed = 99;
        let flat: Vec<i32> = (0..40_000).map(|_| (noise(&mut seed) >> 20) as i32 % 7).collect();
        let centred: Vec<i32> = flat.iter().map(|v| v.abs() - 3).collect();
        let bits = 8.0 * written(&centred, 1).len() as f64 / 40_000.0;
        assert!((2.8..2.84).contains(&bits), "{bits} bits a value");
        let zeros = written(&vec![0; 40_000], 1);
        assert!(zeros.len() < 100, "{}", zeros.len());
        let (mut reader, mut model) = (IntegerReader::new(&zeros), Model::new(1));
        assert!((0..40_000).all(|_| reader.integer(&mut model, 0, 0) == 0) && !reader.spent());
    }
}
