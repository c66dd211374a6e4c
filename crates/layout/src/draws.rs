//! Random numbers of a layout: each purpose has a ChaCha stream of the seed, so that neither threads nor the
//! order in which things are asked for change one of them.

use mimique_study::Stream;

/// The draws of one purpose.
pub(crate) fn draws(seed: u64, purpose: &str) -> Stream {
    Stream::new(seed, "layout", None, purpose)
}
