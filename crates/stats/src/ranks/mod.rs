//! Midranks by counting: distinct values in ascending order, how often each occurs, and its midrank.
//!
//! With few distinct values (ratings) nothing of the length of the data is sorted.

pub(crate) mod grouped;
pub(crate) mod radix;
pub(crate) mod signed_rank;
pub(crate) mod tally;
pub(crate) mod two_way;

use std::sync::OnceLock;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use tally::Found;

/// Midranks of a sample without missing values.
#[derive(Debug, Clone)]
pub struct Ranks {
    /// Distinct values in ascending order.
    pub values: Vec<f64>,
    /// How often each distinct value occurs.
    pub counts: Vec<u64>,
    /// Twice the midrank of each distinct value: an integer, so that sums are exact.
    pub doubled: Vec<u64>,
    n: usize,
    /// Distinct value of each observation; of a sample that was sorted, once they are asked for.
    codes: OnceLock<Vec<u32>>,
    /// The observations in ascending order, where they were sorted.
    order: Option<Vec<u32>>,
}

impl Ranks {
    /// Ranks finite values; -0 and 0 are one value.
    pub fn of(sample: &[f64]) -> Self {
        let codes = OnceLock::new();
        let (values, counts, order) = match by_counting(sample) {
            Some((values, counts, found)) => {
                codes.get_or_init(|| found);
                (values, counts, None)
            }
            None => {
                let order = radix::places(sample);
                let (values, counts) = in_order(sample, &order);
                (values, counts, Some(order))
            }
        };
        let mut below = 0;
        let doubled = counts
            .iter()
            .map(|&count| {
                let twice_midrank = 2 * below + count + 1;
                below += count;
                twice_midrank
            })
            .collect();
        Self { values, counts, doubled, n: sample.len(), codes, order }
    }

    /// Number of observations.
    pub fn len(&self) -> usize {
        self.n
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.n == 0
    }

    /// Distinct value of each observation: a place in `values`.
    pub fn codes(&self) -> &[u32] {
        self.codes.get_or_init(|| {
            let mut codes = vec![0; self.n];
            for (code, tied) in (0..).zip(self.tied()) {
                tied.iter().for_each(|&observation| codes[observation as usize] = code);
            }
            codes
        })
    }

    /// Observations in ascending order, those of one value together; none where they were counted.
    fn tied(&self) -> impl Iterator<Item = &[u32]> {
        let mut rest = self.order.as_deref().unwrap_or_default();
        let counts = self.order.as_ref().map_or(&[][..], |_| &self.counts);
        counts.iter().map(move |&count| {
            let (tied, after) = rest.split_at(count as usize);
            rest = after;
            tied
        })
    }

    /// Whether the sample was sorted, since it has too many values to be counted.
    pub(crate) fn is_sorted(&self) -> bool {
        self.order.is_some()
    }

    /// Calls with value, doubled midrank and observation, in ascending order; not at all where the
    /// sample was counted.
    pub(crate) fn walk(&self, mut met: impl FnMut(f64, u64, usize)) {
        for ((tied, &value), &rank) in self.tied().zip(&self.values).zip(&self.doubled) {
            tied.iter().for_each(|&observation| met(value, rank, observation as usize));
        }
    }

    /// Distinct values of the observations (as [`Ranks::codes`]) in the ascending order of `other`'s;
    /// those that `other` ties come in their own order.
    pub(crate) fn codes_in_order_of(&self, other: &Ranks) -> Vec<u32> {
        let codes = self.codes();
        if let Some(order) = &other.order {
            return order.par_iter().map(|&observation| codes[observation as usize]).collect();
        }
        let mut starts: Vec<usize> = Vec::with_capacity(other.counts.len());
        let mut below = 0;
        for &count in &other.counts {
            starts.push(below);
            below += count as usize;
        }
        let mut in_order = vec![0; below];
        for (&place, &code) in other.codes().iter().zip(codes) {
            in_order[starts[place as usize]] = code;
            starts[place as usize] += 1;
        }
        in_order
    }

    /// Sums of the doubled midranks a cell, `cells` being each observation's.
    pub(crate) fn doubled_sums(&self, cells: &[u32], count: usize) -> Vec<u64> {
        let mut sums = vec![0; count];
        if self.is_sorted() {
            self.walk(|_, rank, observation| sums[cells[observation] as usize] += rank);
        } else {
            for (&cell, &code) in cells.iter().zip(self.codes()) {
                sums[cell as usize] += self.doubled[code as usize];
            }
        }
        sums
    }

    /// Midrank of an observation.
    pub fn rank(&self, observation: usize) -> f64 {
        self.doubled_rank(observation) as f64 / 2.0
    }

    /// Twice the midrank of an observation.
    pub fn doubled_rank(&self, observation: usize) -> u64 {
        self.doubled[self.codes()[observation] as usize]
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

/// Distinct values and how often each occurs, of a sample whose order is known.
fn in_order(sample: &[f64], order: &[u32]) -> (Vec<f64>, Vec<u64>) {
    // -0 becomes 0
    let values: Vec<f64> = order.par_iter().map(|&place| sample[place as usize] + 0.0).collect();
    if values.array_windows().all(|[a, b]| a != b) {
        let counts = vec![1; values.len()];
        return (values, counts);
    }
    values.chunk_by(|a, b| a == b).map(|tied| (tied[0], tied.len() as u64)).unzip()
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
        let (values, counts) = in_order(&sample, &order);
        let counted = Ranks::of(&sample);
        assert_eq!((&counted.values, &counted.counts), (&values, &counts));
        let sorted = Ranks {
            values,
            counts,
            doubled: counted.doubled.clone(),
            n: sample.len(),
            codes: OnceLock::new(),
            order: Some(order),
        };
        assert!(sorted.is_sorted() && !counted.is_sorted());
        assert_eq!(sorted.codes(), counted.codes());
        let cells: Vec<u32> = (0..500).map(|i| i * i % 7).collect();
        assert_eq!(sorted.doubled_sums(&cells, 7), counted.doubled_sums(&cells, 7));
    }
}
