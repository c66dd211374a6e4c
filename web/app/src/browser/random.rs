//! Random numbers of the browser.

/// A number from 0 to 1, for waits.
pub fn fraction() -> f64 {
    js_sys::Math::random()
}

/// As many random bytes from the browser's cryptographic source, hexadecimal.
pub fn nonce(bytes: usize) -> Result<String, getrandom::Error> {
    let mut drawn = vec![0_u8; bytes];
    getrandom::fill(&mut drawn)?;
    Ok(hex::encode(drawn))
}
