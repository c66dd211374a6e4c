//! Random numbers that depend on a seed and a purpose alone.

use chacha20::ChaCha20Rng;
use chacha20::rand_core::{Rng, SeedableRng};

/// A ChaCha20 stream: the key is the seed, the stream number names the purpose (a tree, a draw).
pub struct Stream(ChaCha20Rng);

impl Stream {
    /// The stream of a purpose.
    pub fn new(seed: u64, number: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut stream = ChaCha20Rng::from_seed(key);
        stream.set_stream(number);
        Self(stream)
    }

    /// A whole number below `bound` (above 0), each equally likely: draws that would favour the low
    /// ones are thrown away.
    pub fn below(&mut self, bound: usize) -> usize {
        let bound = bound.max(1) as u64;
        let fair = u64::MAX - u64::MAX % bound;
        loop {
            let draw = self.0.next_u64();
            if draw < fair {
                return (draw % bound) as usize;
            }
        }
    }

    /// A number in [0, 1), in steps of 2^-53, each equally likely.
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The first `count` of a random order of the items, swapped to the front.
    pub fn draw_first<T>(&mut self, items: &mut [T], count: usize) {
        for place in 0..count.min(items.len()) {
            let other = place + self.below(items.len() - place);
            items.swap(place, other);
        }
    }
}
