//! Hashes of bytes, and the version of the arithmetic that weights come from.

use sha2::{Digest, Sha256};

/// Changes with every change of the solver or of the way to it that moves a bit of any weight.
pub const SOLVER_VERSION: &str =
    concat!("mimique-solver ", env!("CARGO_PKG_VERSION"), ", arithmetic 7");

/// SHA-256, lower-case hexadecimal.
pub fn sha256_hex(bytes: &[u8]) -> String {
    hex::encode(Sha256::digest(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_any_tool() {
        // printf abc | sha256sum
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256_hex(b"abc"), abc);
    }
}
