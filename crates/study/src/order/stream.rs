//! A stream of random numbers named by its purpose.

use chacha20::ChaCha20Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use sha2::{Digest, Sha256};

/// ChaCha20 whose key is the SHA-256 of seed, configuration, participant and purpose.
pub struct Stream {
    numbers: ChaCha20Rng,
    /// The second of two normal numbers that were made together.
    spare: Option<f64>,
}

impl Stream {
    /// The stream of one purpose; `participant` is `None` for what all participants share.
    pub fn new(seed: u64, config_hash: &str, participant: Option<u64>, purpose: &str) -> Self {
        let whose = participant.map_or_else(|| "everybody".to_owned(), |number| number.to_string());
        let name = format!("mimique 1\n{seed}\n{config_hash}\n{whose}\n{purpose}");
        let numbers = ChaCha20Rng::from_seed(Sha256::digest(name.as_bytes()).into());
        Self { numbers, spare: None }
    }

    /// A whole number below `bound` (above 0), each equally likely: draws that would favour the low
    /// ones are thrown away.
    pub fn below(&mut self, bound: usize) -> usize {
        let bound = bound.max(1) as u64;
        let fair = u64::MAX - u64::MAX % bound;
        loop {
            let draw = self.numbers.next_u64();
            if draw < fair {
                return (draw % bound) as usize;
            }
        }
    }

    /// A number in [0, 1), in steps of 2^-53, each equally likely.
    pub fn unit(&mut self) -> f64 {
        (self.numbers.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A standard normal number (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        // 1 - u is never 0.
        let radius = (-2.0 * libm::log(1.0 - self.unit())).sqrt();
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * self.unit());
        self.spare = Some(radius * sine);
        radius * cosine
    }

    /// Every order equally likely (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draws(participant: Option<u64>, purpose: &str) -> Vec<usize> {
        let mut stream = Stream::new(7, "abc", participant, purpose);
        (0..8).map(|_| stream.below(1000)).collect()
    }

    #[test]
    fn streams_of_other_purposes_and_people_differ() {
        assert_eq!(draws(Some(1), "order"), draws(Some(1), "order"));
        assert_ne!(draws(Some(1), "order"), draws(Some(2), "order"));
        assert_ne!(draws(Some(1), "order"), draws(Some(1), "options"));
        assert_ne!(draws(Some(1), "order"), draws(None, "order"));
    }

    #[test]
    fn unit_is_uniform() {
        let mut stream = Stream::new(1, "", None, "unit");
        let draws: Vec<f64> = (0..100_000).map(|_| stream.unit()).collect();
        assert!(draws.iter().all(|draw| (0.0..1.0).contains(draw)));
        let mean = draws.iter().sum::<f64>() / 1e5;
        let square = draws.iter().map(|draw| draw * draw).sum::<f64>() / 1e5;
        // Standard errors 0.0009; the seed is fixed.
        assert!(
            (mean - 0.5).abs() < 0.003 && (square - 1.0 / 3.0).abs() < 0.003,
            "{mean} {square}"
        );
    }

    #[test]
    fn below_is_uniform() {
        let mut stream = Stream::new(1, "", None, "test");
        let mut counts = [0_f64; 7];
        for _ in 0..70_000 {
            counts[stream.below(7)] += 1.0;
        }
        let chi_square: f64 = counts.iter().map(|n| (n - 10_000.0).powi(2) / 10_000.0).sum();
        // 6 degrees of freedom: 22.46 is the 0.999 quantile; the seed is fixed.
        assert!(chi_square < 22.46, "chi-square {chi_square}, counts {counts:?}");
    }
}
