//! Draws of a simulation, the same on every machine: ChaCha streams and `libm`.

use mimique_study::{Chance, Stream};

/// Draws of one purpose.
pub(crate) struct Draws {
    stream: Stream,
}

impl Draws {
    /// The draws of a purpose; `participant` is `None` for what all people share.
    pub(crate) fn new(seed: u64, participant: Option<u64>, purpose: &str) -> Self {
        // What is simulated depends on seed, number and purpose alone: the order of trials has
        // streams of its own, so a change of the study's texts leaves the people as they are.
        Self { stream: Stream::new(seed, "simulate", participant, purpose) }
    }

    /// A number in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.stream.unit()
    }

    /// Whether something of this probability happens.
    pub(crate) fn happens(&mut self, probability: f64) -> bool {
        self.stream.unit() < probability
    }

    /// A whole number below `bound`.
    pub(crate) fn below(&mut self, bound: usize) -> usize {
        self.stream.below(bound)
    }

    /// Every order equally likely.
    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        self.stream.shuffle(items);
    }

    /// A standard normal number (Box and Muller 1958).
    pub(crate) fn normal(&mut self) -> f64 {
        self.stream.normal()
    }

    /// A log-normal number.
    pub(crate) fn log_normal(&mut self, median: f64, sigma: f64) -> f64 {
        median * libm::exp(sigma * self.normal())
    }

    /// A place, by relative weights; the last one where they are all zero.
    pub(crate) fn weighted(&mut self, weights: &[f64]) -> usize {
        let mut left = self.unit() * weights.iter().sum::<f64>();
        for (place, weight) in weights.iter().enumerate() {
            left -= weight;
            if left < 0.0 {
                return place;
            }
        }
        weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(weights.len().saturating_sub(1))
    }
}

impl Chance for Draws {
    fn below(&mut self, count: usize) -> usize {
        Self::below(self, count)
    }

    fn weighted(&mut self, weights: &[f64]) -> usize {
        Self::weighted(self, weights)
    }

    fn shuffle(&mut self, places: &mut [usize]) {
        Self::shuffle(self, places);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_has_the_moments_of_a_normal_variable() {
        let mut draws = Draws::new(3, None, "normal");
        let n = 200_000;
        let values: Vec<f64> = (0..n).map(|_| draws.normal()).collect();
        let moment = |power: i32| values.iter().map(|v| v.powi(power)).sum::<f64>() / f64::from(n);
        // Standard errors of the first four moments: sqrt of 1, 2, 15, 96 over sqrt of n.
        for (power, expected, error) in
            [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0f64)]
        {
            let bound = 3.5 * error.sqrt() / f64::from(n).sqrt();
            assert!((moment(power) - expected).abs() < bound, "moment {power}: {}", moment(power));
        }
    }

    #[test]
    fn weighted_draws_follow_their_weights() {
        let mut draws = Draws::new(5, Some(2), "weights");
        let mut counts = [0_u32; 4];
        for _ in 0..40_000 {
            counts[draws.weighted(&[1.0, 0.0, 2.0, 1.0])] += 1;
        }
        assert_eq!(counts[1], 0);
        for (count, expected) in
            [(counts[0], 10_000.0), (counts[2], 20_000.0), (counts[3], 10_000.0)]
        {
            assert!((f64::from(count) - expected).abs() < 400.0, "{counts:?}");
        }
    }
}
