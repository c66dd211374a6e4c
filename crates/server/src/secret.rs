//! Secrets: made, derived, hashed and compared.

use hmac::{Hmac, KeyInit, Mac};
use sha2::{Digest, Sha256};
use subtle::ConstantTimeEq;

/// `BYTES` random bytes from the operating system, hexadecimal.
///
/// # Errors
/// The operating system has no randomness to give.
pub(crate) fn random<const BYTES: usize>() -> Result<String, getrandom::Error> {
    let mut bytes = [0; BYTES];
    getrandom::fill(&mut bytes)?;
    Ok(hex::encode(bytes))
}

/// SHA-256 of a secret, hexadecimal: what the database keeps of it.
pub(crate) fn hash(secret: &str) -> String {
    hex::encode(Sha256::digest(secret.as_bytes()))
}

/// HMAC-SHA-256 over the parts, each preceded by its length so that no two lists of parts collide.
pub(crate) fn derive(key: &[u8], parts: &[&str]) -> [u8; 32] {
    let mut mac = keyed(key);
    for part in parts {
        mac.update(&(part.len() as u64).to_le_bytes());
        mac.update(part.as_bytes());
    }
    mac.finalize().into_bytes().into()
}

/// An HMAC ready to be fed.
pub(crate) fn keyed(key: &[u8]) -> Hmac<Sha256> {
    Hmac::new_from_slice(key).expect("HMAC takes keys of every length")
}

/// Compares without telling by the time taken where two secrets differ.
pub(crate) fn same(left: &str, right: &str) -> bool {
    left.as_bytes().ct_eq(right.as_bytes()).into()
}

/// Whether this is `digits` lower-case hexadecimal digits.
pub(crate) fn is_hex(text: &str, digits: usize) -> bool {
    text.len() == digits && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'))
}

/// Bytes as Crockford's base 32 (no I, L, O, U), five bits a character, in groups of four.
pub(crate) fn spoken(bytes: &[u8; 10]) -> String {
    const LETTERS: &[u8; 32] = b"0123456789ABCDEFGHJKMNPQRSTVWXYZ";
    let value = bytes.iter().fold(0_u128, |value, byte| value << 8 | u128::from(*byte));
    let mut text = String::with_capacity(19);
    for index in 0..16 {
        if index > 0 && index % 4 == 0 {
            text.push('-');
        }
        text.push(char::from(LETTERS[(value >> (75 - 5 * index) & 31) as usize]));
    }
    text
}

/// A code as a person types it, brought to the form of [`spoken`] without its dashes.
pub(crate) fn heard(text: &str) -> String {
    text.chars()
        .filter(char::is_ascii_alphanumeric)
        .map(|letter| match letter.to_ascii_uppercase() {
            'I' | 'L' => '1',
            'O' => '0',
            other => other,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_is_sha_256() {
        // FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(hash("abc"), expected);
    }

    #[test]
    fn derived_secrets_depend_on_where_the_parts_are_cut() {
        assert_ne!(derive(b"key", &["ab", "c"]), derive(b"key", &["a", "bc"]));
    }

    #[test]
    fn a_code_read_aloud_is_recognised() {
        let code = spoken(&[0, 17, 34, 51, 68, 85, 102, 119, 136, 153]);
        assert_eq!(code, "008J-4CT4-ANK7-F24S");
        let typed = "oo8j 4ct4 ank7 f24s";
        assert_eq!(heard(typed), heard(&code));
        assert!(same(&heard(typed), "008J4CT4ANK7F24S"));
    }

    #[test]
    fn hexadecimal_tokens_are_told_from_other_text() {
        assert!(is_hex("00ff", 4));
        for wrong in ["00fF", "00f", "00fg", "../."] {
            assert!(!is_hex(wrong, 4), "{wrong}");
        }
    }
}
