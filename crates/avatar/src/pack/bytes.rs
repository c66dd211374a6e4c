//! Little-endian bytes of packs: a writer, and a reader that refuses instead of panicking.

/// A pack that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("byte {at} of the {pack} pack: {what}; load or prepare the pack again")]
pub struct PackError {
    /// Four letters of the pack.
    pub pack: &'static str,
    /// Offset into the unpacked bytes.
    pub at: usize,
    /// What is wrong there.
    pub what: String,
}

/// Appends numbers and texts to a byte vector.
#[derive(Debug, Default)]
pub struct PackWriter {
    bytes: Vec<u8>,
}

impl PackWriter {
    /// An empty one.
    pub fn new() -> Self {
        Self::default()
    }

    /// What has been written.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// One byte.
    pub fn u8(&mut self, value: u8) {
        self.bytes.push(value);
    }

    /// Bytes as they are.
    pub fn raw(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// 32 bits.
    pub fn u32(&mut self, value: u32) {
        self.raw(&value.to_le_bytes());
    }

    /// 64 bits.
    pub fn u64(&mut self, value: u64) {
        self.raw(&value.to_le_bytes());
    }

    /// A single-precision number.
    pub fn f32(&mut self, value: f32) {
        self.raw(&value.to_le_bytes());
    }

    /// A double-precision number.
    pub fn f64(&mut self, value: f64) {
        self.raw(&value.to_le_bytes());
    }

    /// Seven bits a byte, the lowest first; the top bit says that more follow.
    pub fn varint(&mut self, mut value: u32) {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
    }

    /// Length, then UTF-8.
    pub fn text(&mut self, text: &str) {
        self.varint(text.len() as u32);
        self.raw(text.as_bytes());
    }

    /// Count, then texts.
    pub fn texts(&mut self, texts: &[String]) {
        self.varint(texts.len() as u32);
        texts.iter().for_each(|t| self.text(t));
    }
}

/// Takes numbers and texts from a byte slice.
#[derive(Debug)]
pub struct PackReader<'a> {
    pack: &'static str,
    bytes: &'a [u8],
    at: usize,
}

impl<'a> PackReader<'a> {
    /// Reads `bytes`; `pack` names the kind of pack in errors.
    pub fn new(pack: &'static str, bytes: &'a [u8]) -> Self {
        Self { pack, bytes, at: 0 }
    }

    /// A refusal at the present place.
    pub fn refuse<T>(&self, what: impl Into<String>) -> Result<T, PackError> {
        Err(PackError { pack: self.pack, at: self.at, what: what.into() })
    }

    /// How many bytes are left.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The next bytes as they are.
    pub fn raw(&mut self, count: usize) -> Result<&'a [u8], PackError> {
        let Some(end) = self.at.checked_add(count).filter(|end| *end <= self.bytes.len()) else {
            return self.refuse(format!("{count} bytes expected, {} left", self.left()));
        };
        let bytes = &self.bytes[self.at..end];
        self.at = end;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], PackError> {
        let mut out = [0; N];
        out.copy_from_slice(self.raw(N)?);
        Ok(out)
    }

    /// One byte.
    pub fn u8(&mut self) -> Result<u8, PackError> {
        Ok(self.array::<1>()?[0])
    }

    /// 32 bits.
    pub fn u32(&mut self) -> Result<u32, PackError> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    /// 64 bits.
    pub fn u64(&mut self) -> Result<u64, PackError> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    /// A single-precision number, finite.
    pub fn f32(&mut self) -> Result<f32, PackError> {
        let value = f32::from_le_bytes(self.array()?);
        if value.is_finite() { Ok(value) } else { self.refuse("a number that is not finite") }
    }

    /// A double-precision number, of any kind (NaN stands for a missing marker).
    pub fn f64(&mut self) -> Result<f64, PackError> {
        Ok(f64::from_le_bytes(self.array()?))
    }

    /// See [`PackWriter::varint`].
    pub fn varint(&mut self) -> Result<u32, PackError> {
        let mut value = 0u32;
        for shift in (0..35).step_by(7) {
            let byte = self.u8()?;
            let part = u64::from(byte & 0x7f) << shift;
            match u32::try_from(part) {
                Ok(part) => value |= part,
                Err(_) => break,
            }
            if byte < 0x80 {
                return Ok(value);
            }
        }
        self.refuse("a number of more than 32 bits")
    }

    /// A count of things that take at least `each` bytes, so that no damaged count allocates more
    /// than the pack could fill.
    pub fn count(&mut self, each: usize) -> Result<usize, PackError> {
        let count = self.varint()? as usize;
        if count.saturating_mul(each) > self.left() {
            return self.refuse(format!("{count} elements, {} bytes left", self.left()));
        }
        Ok(count)
    }

    /// See [`PackWriter::text`].
    pub fn text(&mut self) -> Result<String, PackError> {
        let count = self.count(1)?;
        match String::from_utf8(self.raw(count)?.to_vec()) {
            Ok(text) => Ok(text),
            Err(_) => self.refuse("a text that is not UTF-8"),
        }
    }

    /// See [`PackWriter::texts`].
    pub fn texts(&mut self) -> Result<Vec<String>, PackError> {
        let count = self.count(1)?;
        (0..count).map(|_| self.text()).collect()
    }

    /// Refuses bytes that nothing has read.
    pub fn finish(self) -> Result<(), PackError> {
        match self.left() {
            0 => Ok(()),
            left => self.refuse(format!("{left} bytes too many")),
        }
    }
}
