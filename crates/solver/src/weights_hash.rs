//! What weights are known by.

use sha2::{Digest, Sha256};

/// SHA-256 of the numbers as little-endian f64, lower-case hexadecimal.
pub fn weights_hash(weights: &[f64]) -> String {
    let mut hash = Sha256::new();
    weights.iter().for_each(|w| hash.update(w.to_le_bytes()));
    hex::encode(hash.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_hash_of_any_tool_over_the_bytes() {
        // printf '\0\0\0\0\0\0\360\77' | sha256sum
        let one = "6c3c396ed6b5c36dcae172271f462051b1266b851e92df3deea8ac65478fd712";
        assert_eq!(weights_hash(&[1.0]), one);
        assert_ne!(weights_hash(&[1.0, 0.0]), one);
    }
}
