//! Hashes: of weights, and of everything that a stimulus is made of.
//!
//! The provenance of a stimulus is SHA-256 over a canonical form: named entries sorted by name,
//! each as name, kind and length-prefixed content, numbers as little-endian f64.

use std::collections::BTreeMap;

use mimique_solver::MethodSpec;
use serde_json::Value;
use sha2::{Digest, Sha256};

/// Changes with every change of the solver or of the way to it that moves a bit of any weight.
pub const SOLVER_VERSION: &str =
    concat!("mimique-solver ", env!("CARGO_PKG_VERSION"), ", arithmetic 3");

/// SHA-256, lower-case hexadecimal.
pub fn sha256_hex(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// SHA-256 of a file's bytes, lower-case hexadecimal; the file is read as a stream.
///
/// # Errors
/// What the system says.
pub fn sha256_of_file(path: &std::path::Path) -> std::io::Result<String> {
    let mut file = std::fs::File::open(path)?;
    let (mut hash, mut chunk) = (Sha256::new(), vec![0; 1 << 18]);
    loop {
        match std::io::Read::read(&mut file, &mut chunk) {
            Ok(0) => return Ok(hexadecimal(&hash.finalize())),
            Ok(read) => hash.update(&chunk[..read]),
            Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
}

/// SHA-256 of the numbers as little-endian f64, lower-case hexadecimal.
pub fn weights_hash(weights: &[f64]) -> String {
    let mut hash = Sha256::new();
    weights.iter().for_each(|w| hash.update(w.to_le_bytes()));
    hexadecimal(&hash.finalize())
}

/// What a stimulus is made of, entry by entry.
#[derive(Debug, Clone, Default)]
pub struct Provenance {
    entries: BTreeMap<String, Vec<u8>>,
}

impl Provenance {
    /// Nothing yet, except the solver's version.
    pub fn new() -> Self {
        Self::default().text("solver", SOLVER_VERSION)
    }

    /// An entry that is a text (such as another hash).
    pub fn text(mut self, name: &str, text: &str) -> Self {
        self.entries.insert(name.to_owned(), entry(b't', text.as_bytes()));
        self
    }

    /// An entry of numbers.
    pub fn numbers(mut self, name: &str, numbers: &[f64]) -> Self {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.entries.insert(name.to_owned(), entry(b'n', &bytes));
        self
    }

    /// The method and every parameter that it uses, defaults written out.
    pub fn method(mut self, spec: &MethodSpec) -> Self {
        let mut bytes = Vec::new();
        canonical(&serde_json::to_value(spec.resolved()).unwrap_or(Value::Null), &mut bytes);
        self.entries.insert("method".to_owned(), entry(b'j', &bytes));
        self
    }

    /// The hash, lower-case hexadecimal.
    pub fn hash(&self) -> String {
        let mut hash = Sha256::new();
        for (name, content) in &self.entries {
            hash.update((name.len() as u64).to_le_bytes());
            hash.update(name.as_bytes());
            hash.update(content);
        }
        hexadecimal(&hash.finalize())
    }
}

fn entry(kind: u8, content: &[u8]) -> Vec<u8> {
    let mut out = vec![kind];
    out.extend((content.len() as u64).to_le_bytes());
    out.extend(content);
    out
}

/// JSON with sorted keys and numbers as f64: a letter for the kind, counts as u64.
fn canonical(value: &Value, out: &mut Vec<u8>) {
    match value {
        Value::Null => out.push(b'0'),
        Value::Bool(b) => out.extend([b'b', u8::from(*b)]),
        Value::Number(n) => {
            out.push(b'n');
            out.extend(n.as_f64().unwrap_or(f64::NAN).to_le_bytes());
        }
        Value::String(text) => out.extend(entry(b't', text.as_bytes())),
        Value::Array(items) => {
            out.push(b'a');
            out.extend((items.len() as u64).to_le_bytes());
            items.iter().for_each(|item| canonical(item, out));
        }
        Value::Object(map) => {
            let sorted: BTreeMap<&String, &Value> = map.iter().collect();
            out.push(b'o');
            out.extend((sorted.len() as u64).to_le_bytes());
            for (key, item) in sorted {
                out.extend(entry(b't', key.as_bytes()));
                canonical(item, out);
            }
        }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    bytes
        .iter()
        .flat_map(|b| [DIGITS[usize::from(b >> 4)], DIGITS[usize::from(b & 15)]])
        .map(char::from)
        .collect()
}

#[cfg(test)]
mod tests {
    use mimique_solver::Method;

    use super::*;

    #[test]
    fn hashes_are_those_of_any_tool() {
        // printf abc | sha256sum
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256_hex(b"abc"), abc);
        assert_eq!(weights_hash(&[1.0]), sha256_hex(&1f64.to_le_bytes()));
    }

    #[test]
    fn provenance_knows_no_order_and_every_difference() {
        let spec = |alpha| MethodSpec { alpha, ..MethodSpec::new(Method::Lsts) };
        let hash = |alpha, avatar: &str| {
            Provenance::new()
                .text("avatar", avatar)
                .numbers("neutral", &[0.0, 60.0])
                .method(&spec(alpha))
                .hash()
        };
        let turned = Provenance::new()
            .method(&spec(Some(0.3)))
            .numbers("neutral", &[0.0, 60.0])
            .text("avatar", "a");
        assert_eq!(hash(Some(0.3), "a"), turned.hash());
        // A default that is written out is the same stimulus.
        assert_eq!(hash(None, "a"), turned.hash());
        assert_ne!(hash(Some(0.31), "a"), turned.hash());
        assert_ne!(hash(Some(0.3), "b"), turned.hash());
    }
}
