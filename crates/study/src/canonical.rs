//! Canonical JSON and the hash of a study file.
//!
//! Objects have their keys sorted by UTF-16 code units, nothing stands between the tokens, numbers
//! that are whole are written without point or exponent, as RFC 8785 asks; so that comments, spacing
//! and the order of keys do not change the hash.

use std::fmt::Write as _;

use serde_json::Value;
use sha2::{Digest, Sha256};

/// The canonical text of a JSON value.
pub fn canonical(value: &Value) -> String {
    let mut text = String::new();
    write_value(&mut text, value);
    text
}

/// SHA-256 of the canonical text, hexadecimal.
pub fn config_hash(study: &Value) -> String {
    hex::encode(Sha256::digest(canonical(study)))
}

fn write_value(text: &mut String, value: &Value) {
    match value {
        Value::Object(map) => {
            let mut keys: Vec<&String> = map.keys().collect();
            keys.sort_by(|left, right| left.encode_utf16().cmp(right.encode_utf16()));
            text.push('{');
            for (index, key) in keys.into_iter().enumerate() {
                if index > 0 {
                    text.push(',');
                }
                let _ = write!(text, "{}:", Value::from(key.as_str()));
                write_value(text, &map[key]);
            }
            text.push('}');
        }
        Value::Array(items) => {
            text.push('[');
            for (index, item) in items.iter().enumerate() {
                if index > 0 {
                    text.push(',');
                }
                write_value(text, item);
            }
            text.push(']');
        }
        Value::Number(number) => match number.as_f64() {
            // Below 2^53 every whole number is exact, written as an integer or not.
            Some(float) if float.fract() == 0.0 && float.abs() < 9_007_199_254_740_992.0 => {
                let _ = write!(text, "{}", float as i64);
            }
            _ => {
                let _ = write!(text, "{number}");
            }
        },
        other => {
            let _ = write!(text, "{other}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn canonical_json_knows_no_spacing_and_no_key_order() {
        let left = crate::parse("{ b: 1.0, /* why */ a: [true, null, 'x\\n'], }").unwrap();
        let right = crate::parse(r#"{"a":[true,null,"x\n"],"b":1}"#).unwrap();
        assert_eq!(canonical(&left), r#"{"a":[true,null,"x\n"],"b":1}"#);
        assert_eq!(config_hash(&left), config_hash(&right));
    }

    #[test]
    fn canonical_json_keeps_what_differs() {
        let hash = |text| config_hash(&crate::parse(text).unwrap());
        assert_ne!(hash(r#"{"a":0.3}"#), hash(r#"{"a":0.30000000000000004}"#));
        assert_ne!(hash(r#"{"a":"1"}"#), hash(r#"{"a":1}"#));
        // SHA-256 of the two bytes `{}`, as any tool gives it.
        assert_eq!(hash("{}"), "44136fa355b3678a1146ad16f7e8649e94fb4fc21fe77e8310c060f61caaff8a");
    }
}
