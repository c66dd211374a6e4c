//! Midranks by counting: distinct values in ascending order, how often each occurs, and its midrank.
//!
//! With few distinct values (ratings) nothing of the length of the data is sorted.

use crate::radix;
use crate::tally::Found;

/// Midranks of a sample without missing values.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranks {
    /// Distinct values in ascending order.
    pub values: Vec<f64>,
    /// How often each distinct value occurs.
    pub counts: Vec<u64>,
    /// Twice the midrank of each distinct value: an integer, so that sums are exact.
    pub doubled: Vec<u64>,
    /// Distinct value of each observation.
    pub codes: Vec<u32>,
    /// The observations in ascending order, where they were sorted.
    pub(crate) order: Option<Vec<u32>>,
}

impl Ranks {
    /// Ranks finite values; -0 and 0 are one value.
    pub fn of(sample: &[f64]) -> Self {
        let (counted, order) = match by_counting(sample) {
            Some(counted) => (counted, None),
            None => {
                let order = radix::places(sample);
                (by_order(sample, &order), Some(order))
            }
        };
        let (values, counts, codes) = counted;
        let mut below = 0;
        let doubled = counts
            .iter()
            .map(|&count| {
                let twice_midrank = 2 * below + count + 1;
                below += count;
                twice_midrank
            })
            .collect();
        Self { values, counts, doubled, codes, order }
    }

    /// Number of observations.
    pub fn len(&self) -> usize {
        self.codes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.codes.is_empty()
    }

    /// Midrank of an observation.
    pub fn rank(&self, observation: usize) -> f64 {
        self.doubled_rank(observation) as f64 / 2.0
    }

    /// Twice the midrank of an observation.
    pub fn doubled_rank(&self, observation: usize) -> u64 {
        self.doubled[self.codes[observation] as usize]
    }

    /// All midranks, in the sample's order.
    pub fn to_vec(&self) -> Vec<f64> {
        (0..self.len()).map(|observation| self.rank(observation)).collect()
    }

    /// Sum over tie groups of t^3 - t.
    pub fn tie_term(&self) -> f64 {
        self.counts.iter().map(|&t| t as f64).map(|t| t * (t * t - 1.0)).sum()
    }

    /// Whether any two observations are equal.
    pub fn has_ties(&self) -> bool {
        self.values.len() < self.len()
    }

    /// Sum of squared deviations of the midranks from their mean: (n^3 - n - tie term) / 12.
    pub fn sum_of_squares(&self) -> f64 {
        let n = self.len() as f64;
        (n * (n * n - 1.0) - self.tie_term()) / 12.0
    }
}

/// Distinct values, how often each occurs, which of them each observation is.
type Counted = (Vec<f64>, Vec<u64>, Vec<u32>);

fn by_counting(sample: &[f64]) -> Option<Counted> {
    let mut found = Found::new();
    let mut codes = Vec::with_capacity(sample.len());
    for &value in sample {
        codes.push(found.code(value)?);
    }
    let order = found.order();
    let mut new_code = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        new_code[old as usize] = new as u32;
    }
    let mut counts = vec![0; order.len()];
    for code in &mut codes {
        *code = new_code[*code as usize];
        counts[*code as usize] += 1;
    }
    Some((order.iter().map(|&old| found.values[old as usize]).collect(), counts, codes))
}

fn by_order(sample: &[f64], order: &[u32]) -> Counted {
    let mut values: Vec<f64> = Vec::with_capacity(sample.len());
    let mut counts: Vec<u64> = Vec::with_capacity(sample.len());
    let mut codes = vec![0; sample.len()];
    for &place in order {
        let value = sample[place as usize] + 0.0; // -0 becomes 0
        match counts.last_mut() {
            Some(count) if values.last() == Some(&value) => *count += 1,
            _ => {
                values.push(value);
                counts.push(1);
            }
        }
        codes[place as usize] = values.len() as u32 - 1;
    }
    (values, counts, codes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_share_their_midrank() {
        let ranks = Ranks::of(&[3.0, 1.0, 3.0, -0.0, 0.0]);
        assert_eq!(ranks.to_vec(), [4.5, 3.0, 4.5, 1.5, 1.5]);
        assert_eq!(ranks.tie_term(), 12.0);
        let mean = 3.0;
        let direct: f64 = ranks.to_vec().iter().map(|r| (r - mean) * (r - mean)).sum();
        assert_eq!(ranks.sum_of_squares(), direct);
    }

    #[test]
    fn counting_and_sorting_agree() {
        let sample: Vec<f64> = (0..500).map(|i| f64::from(i * 7919 % 83) - 40.0).collect();
        let order = radix::places(&sample);
        assert_eq!(by_counting(&sample), Some(by_order(&sample, &order)));
    }
}
