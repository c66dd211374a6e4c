//! Signed ranks of differences, and the distribution of their positive sum when signs are coin tosses.

use crate::distributions::tail::{Alternative, Tail, normal_tail};
use crate::ranks::tally::Tally;

/// What becomes of differences that are zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Zeros {
    /// Dropped before ranking (Wilcoxon 1945).
    Drop,
    /// Ranked with the others, then left out (Pratt 1959).
    Pratt,
    /// Ranked with the others, half of their ranks on each side.
    Split,
}

/// Differences of one absolute value.
#[derive(Debug, Clone, Copy)]
struct Magnitude {
    plus: u64,
    minus: u64,
}

/// Distinct absolute differences in ascending order, and how many differences are zero.
#[derive(Debug, Clone)]
pub(crate) struct Magnitudes {
    groups: Vec<Magnitude>,
    zeros: u64,
}

impl Magnitudes {
    pub(crate) fn of(differences: &Tally) -> Self {
        let Tally { values, counts } = differences;
        let mut below = values.partition_point(|&value| value < 0.0);
        let mut above = values.partition_point(|&value| value <= 0.0);
        let zeros = counts[below..above].iter().sum();
        let mut groups = Vec::with_capacity(values.len());
        while below > 0 || above < values.len() {
            let minus = if below > 0 { -values[below - 1] } else { f64::INFINITY };
            let plus = values.get(above).copied().unwrap_or(f64::INFINITY);
            let mut magnitude = Magnitude { plus: 0, minus: 0 };
            if minus <= plus {
                below -= 1;
                magnitude.minus = counts[below];
            }
            if plus <= minus {
                magnitude.plus = counts[above];
                above += 1;
            }
            groups.push(magnitude);
        }
        Self { groups, zeros }
    }

    /// Twice the midrank of each magnitude, with what has it; zeros have the lowest ranks.
    fn doubled_ranks(&self, ranked_zeros: u64) -> impl Iterator<Item = (u64, Magnitude)> {
        let mut below = ranked_zeros;
        self.groups.iter().map(move |&group| {
            let count = group.plus + group.minus;
            let rank = 2 * below + count + 1;
            below += count;
            (rank, group)
        })
    }
}

/// Midranks of absolute differences with their signs, doubled so that they are integers.
#[derive(Debug, Clone)]
pub(crate) struct SignedRanks<'a> {
    magnitudes: &'a Magnitudes,
    ranked_zeros: u64,
    ties: bool,
    doubled_plus: u64,
    doubled_minus: u64,
    mean: f64,
    variance: f64,
}

impl<'a> SignedRanks<'a> {
    /// At least one difference must be other than zero.
    pub(crate) fn of(magnitudes: &'a Magnitudes, zeros: Zeros) -> Self {
        let ranked_zeros = if zeros == Zeros::Drop { 0 } else { magnitudes.zeros };
        let tie = |count: u64| (count as f64) * ((count * count) as f64 - 1.0);
        let (mut plus, mut minus, mut n) = (0u64, 0u64, ranked_zeros);
        let (mut ties, mut tie_term, mut squares) = (false, tie(ranked_zeros), 0.0);
        for (rank, group) in magnitudes.doubled_ranks(ranked_zeros) {
            let count = group.plus + group.minus;
            n += count;
            ties |= count > 1;
            tie_term += tie(count);
            plus += group.plus * rank;
            minus += group.minus * rank;
            squares += (rank as f64 / 2.0).powi(2) * count as f64;
        }
        // Zeros that are split add the same to both sides; as other tools do, the variance then counts
        // their ranks as if they had a sign, and corrects for their tie.
        let (mean, variance) = if zeros == Zeros::Split {
            let of_zeros = ranked_zeros * (ranked_zeros + 1);
            plus += of_zeros / 2;
            minus += of_zeros / 2;
            let n = n as f64;
            let full = n * (n + 1.0) * (2.0 * n + 1.0);
            (n * (n + 1.0) / 4.0, (full - tie_term / 2.0) / 24.0)
        } else {
            ((plus + minus) as f64 / 4.0, squares / 4.0)
        };
        Self {
            magnitudes,
            ranked_zeros,
            ties,
            doubled_plus: plus,
            doubled_minus: minus,
            mean,
            variance,
        }
    }

    /// Doubled midranks one by one: those that a coin toss gives to one side or the other.
    fn each(&self) -> Vec<u64> {
        let ranks = self.magnitudes.doubled_ranks(self.ranked_zeros);
        ranks
            .flat_map(|(rank, group)| {
                std::iter::repeat_n(rank, (group.plus + group.minus) as usize)
            })
            .collect()
    }

    /// Whether any two differences other than zero have one absolute value.
    pub(crate) fn has_ties(&self) -> bool {
        self.ties
    }

    /// W+.
    pub(crate) fn plus(&self) -> f64 {
        self.doubled_plus as f64 / 2.0
    }

    /// W-.
    pub(crate) fn minus(&self) -> f64 {
        self.doubled_minus as f64 / 2.0
    }

    /// Normal approximation with the variance of the observed ranks, which is the tie correction.
    pub(crate) fn normal(&self, alternative: Alternative, continuity: bool) -> Tail {
        let distance = self.plus() - self.mean;
        let correction = match alternative {
            _ if !continuity => 0.0,
            Alternative::TwoSided if distance == 0.0 => 0.0,
            Alternative::TwoSided => 0.5 * distance.signum(),
            Alternative::Greater => 0.5,
            Alternative::Less => -0.5,
        };
        normal_tail((distance - correction) / self.variance.sqrt(), alternative)
    }

    /// Exact distribution of W+ over all signs, given the observed ranks with their ties.
    pub(crate) fn exact(&self, alternative: Alternative) -> Tail {
        let distribution = toss_distribution(&self.each());
        let observed = self.doubled_plus as usize;
        let at_most: f64 = distribution[..=observed].iter().sum();
        let at_least: f64 = distribution[observed..].iter().rev().sum();
        match alternative {
            Alternative::TwoSided => Tail::from_p(at_most.min(at_least)).doubled(),
            Alternative::Greater => Tail::from_p(at_least),
            Alternative::Less => Tail::from_p(at_most),
        }
    }
}

/// Probability of every sum of `ranks` where each is taken with probability 1/2.
pub(crate) fn toss_distribution(ranks: &[u64]) -> Vec<f64> {
    let total: u64 = ranks.iter().sum();
    let mut distribution = vec![0.0; total as usize + 1];
    distribution[0] = 1.0;
    let mut reach = 0;
    for &rank in ranks {
        let rank = rank as usize;
        reach += rank;
        for sum in (0..=reach).rev() {
            let without = distribution[sum];
            let with = if sum >= rank { distribution[sum - rank] } else { 0.0 };
            distribution[sum] = 0.5 * (without + with);
        }
    }
    distribution
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tails by trying every combination of signs.
    fn enumerated(differences: &[f64], zeros: Zeros) -> (f64, f64) {
        let magnitudes = Magnitudes::of(&Tally::of(differences));
        let ranks = SignedRanks::of(&magnitudes, zeros);
        let tossed = ranks.each();
        let n = tossed.len();
        let (mut at_most, mut at_least) = (0u64, 0u64);
        for signs in 0..1u64 << n {
            let sum: u64 = (0..n).filter(|i| signs >> i & 1 == 1).map(|i| tossed[i]).sum();
            at_most += u64::from(sum <= ranks.doubled_plus);
            at_least += u64::from(sum >= ranks.doubled_plus);
        }
        let all = (1u64 << n) as f64;
        (at_most as f64 / all, at_least as f64 / all)
    }

    #[test]
    fn exact_tails_are_those_of_enumeration() {
        let samples: [&[f64]; 5] = [
            &[1.0, -2.0, 3.0, 4.0, -5.0, 6.0],
            &[1.0, 1.0, -1.0, 2.0, 2.0, -3.0, 0.0, 0.0],
            &[0.0, 0.0, 0.0, 1.0],
            &[-1.0, -1.0, -1.0, -2.0, -2.0, 0.5, 0.5],
            &[2.0, 1.0, -1.0, 3.0, -4.0, 5.0, 5.0, 5.0, -2.0, 0.0, 7.0, -7.0, 8.0],
        ];
        for sample in samples {
            for zeros in [Zeros::Drop, Zeros::Pratt] {
                let magnitudes = Magnitudes::of(&Tally::of(sample));
                let ranks = SignedRanks::of(&magnitudes, zeros);
                let (at_most, at_least) = enumerated(sample, zeros);
                assert_eq!(ranks.exact(Alternative::Less).p, at_most);
                assert_eq!(ranks.exact(Alternative::Greater).p, at_least);
                assert_eq!(
                    ranks.exact(Alternative::TwoSided).p,
                    (2.0 * at_most.min(at_least)).min(1.0)
                );
            }
        }
    }
}
