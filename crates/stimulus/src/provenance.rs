//! The hash of everything that something is made of: stimuli, packs in the cache, training takes.
//!
//! A provenance is a JSON object of named entries; its hash is SHA-256 of the object's canonical text
//! ([`mimique_study::canonical`]: keys sorted, nothing between the tokens). Long lists of numbers stand
//! in it as their count and the SHA-256 of their bytes (f64, little-endian), pictures by their hash. No
//! entry depends on how a type is named or written in the program.

use std::path::Path;

use mimique_clip::{SOLVER_VERSION, sha256_hex, weights_hash};
use mimique_solver::MethodSpec;
use mimique_study::canonical;
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};

/// What something is made of, entry by entry.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Provenance {
    entries: Map<String, Value>,
}

impl Provenance {
    /// Nothing yet, except the solver's version.
    pub fn new() -> Self {
        Self::default().json("solver", SOLVER_VERSION)
    }

    /// An entry that is JSON: a text (such as another hash), a number, an object.
    pub fn json(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.entries.insert(name.to_owned(), value.into());
        self
    }

    /// An entry of many numbers.
    pub fn numbers(self, name: &str, numbers: &[f64]) -> Self {
        self.json(name, numbers_of(numbers))
    }

    /// The method and every parameter that it uses, defaults written out.
    pub fn method(self, spec: &MethodSpec) -> Self {
        // A method is words, numbers and lists: it can always be written.
        self.json("method", serde_json::to_value(spec.resolved()).unwrap_or(Value::Null))
    }

    /// The hash, lower-case hexadecimal.
    pub fn hash(&self) -> String {
        sha256_hex(canonical(&Value::Object(self.entries.clone())).as_bytes())
    }
}

/// Many numbers as an entry: how many there are, and the hash of their bits.
pub(crate) fn numbers_of(numbers: &[f64]) -> Value {
    json!({ "count": numbers.len(), "sha256": weights_hash(numbers) })
}

/// SHA-256 of a file's bytes, lower-case hexadecimal; the file is read as a stream.
///
/// # Errors
/// What the system says.
pub fn sha256_of_file(path: &Path) -> std::io::Result<String> {
    let mut file = std::fs::File::open(path)?;
    let mut hash = Sha256::new();
    std::io::copy(&mut file, &mut HashWriter(&mut hash))?;
    Ok(hex::encode(hash.finalize()))
}

/// What is written into it is hashed.
struct HashWriter<'a>(&'a mut Sha256);

impl std::io::Write for HashWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use mimique_solver::Method;

    use super::*;

    #[test]
    fn provenance_knows_no_order_and_every_difference() {
        let spec = |alpha| MethodSpec { alpha, ..MethodSpec::new(Method::Lsts) };
        let hash = |alpha, avatar: &str| {
            Provenance::new()
                .json("avatar", avatar)
                .numbers("neutral", &[0.0, 60.0])
                .method(&spec(alpha))
                .hash()
        };
        let turned = Provenance::new()
            .method(&spec(Some(0.3)))
            .numbers("neutral", &[0.0, 60.0])
            .json("avatar", "a");
        assert_eq!(hash(Some(0.3), "a"), turned.hash());
        // A default that is written out is the same stimulus.
        assert_eq!(hash(None, "a"), turned.hash());
        assert_ne!(hash(Some(0.31), "a"), turned.hash());
        assert_ne!(hash(Some(0.3), "b"), turned.hash());
    }

    #[test]
    fn the_hash_is_that_of_a_text_that_any_tool_can_write() {
        let made =
            Provenance::default().json("b", json!({"y": 0.5, "x": [1, null]})).json("a", "é");
        // printf '{"a":"é","b":{"x":[1,null],"y":0.5}}' | sha256sum
        assert_eq!(made.hash(), "93fc7b12f7cd07f9a838f8da9eb73feab2213570dde5928dafceb3f1fdc44844");
        let spec = MethodSpec { head_lowpass_hz: Some(10.0), ..MethodSpec::new(Method::Lsts) };
        let text = r#"{"method":{"alpha":0.3,"gain":1,"gaze":"rest","headLowpassHz":10,"kB":1,"kS":1,"kappa":0.1,"laplacian":"uniform","method":"lsts","rbfSmoothing":0,"untold":"hold"}}"#;
        assert_eq!(Provenance::default().method(&spec).hash(), sha256_hex(text.as_bytes()));
        let numbers = Provenance::default().numbers("n", &[1.0, f64::NAN]);
        let bytes = [1f64.to_le_bytes(), f64::NAN.to_le_bytes()].concat();
        let text = format!(r#"{{"n":{{"count":2,"sha256":"{}"}}}}"#, sha256_hex(&bytes));
        assert_eq!(numbers.hash(), sha256_hex(text.as_bytes()));
    }
}
