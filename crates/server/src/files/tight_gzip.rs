//! Gzip as small as it gets, for files that are compressed once, when the server is built: Zopfli's
//! search for the shortest code, a twentieth smaller than gzip's best level and a hundred times slower.

use std::io;
use std::num::NonZeroU64;

/// After five rounds, more gain less than one part in ten thousand.
const ROUNDS: NonZeroU64 = NonZeroU64::new(5).unwrap();

/// The gzip form.
pub(crate) fn gzip(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut packed = Vec::new();
    let options = zopfli::Options { iteration_count: ROUNDS, ..zopfli::Options::default() };
    zopfli::compress(options, zopfli::Format::Gzip, bytes, &mut packed)?;
    Ok(packed)
}
