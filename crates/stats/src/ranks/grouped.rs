//! The layout that tests of groups share: a ranked response, the group of each observation, and what is
//! counted a group. Each pass over the data is made once.

use std::borrow::Cow;

use crate::outcome::Outcome;
use crate::ranks::Ranks;
use crate::ranks::tally::Tally;
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::undefined::Undefined;

/// Groups times distinct values up to which a table of counts is kept.
const TABLE: usize = 1 << 22;

/// A ranked response in groups.
pub(crate) struct Grouped<'a> {
    pub ranks: Ranks,
    pub group: Cow<'a, Factor>,
    pub dropped: usize,
    /// Observations a group.
    pub sizes: Vec<usize>,
    /// Twice the sum of the midranks a group.
    pub doubled_sums: Vec<u64>,
    values: Cow<'a, [f64]>,
    /// Count of each distinct value, group after group; none where there are too many.
    counts: Option<Vec<u64>>,
    /// Median response of each group, where it was met on the way.
    medians: Option<Vec<f64>>,
}

impl<'a> Grouped<'a> {
    /// Refuses a group column with one level; undefined if all responses are equal.
    pub(crate) fn of(response: &'a Numbers, group: &'a Factor) -> Result<Outcome<Self>, Refusal> {
        let rows = complete_rows(&[response], &[group])?;
        let group = rows.factor(group);
        group.require_levels(2)?;
        let values = rows.numbers(response);
        let ranks = Ranks::of(&values);
        if let [only] = ranks.values[..] {
            return Ok(Outcome::undefined(Undefined::EqualValues {
                column: response.name.clone(),
                n: values.len(),
                value: only,
            }));
        }
        let (k, distinct) = (group.levels.len(), ranks.values.len());
        let (mut sizes, mut doubled_sums) = (vec![0usize; k], vec![0u64; k]);
        // What was sorted has too many values to be counted quickly.
        let counts = (!ranks.is_sorted() && k * distinct <= TABLE).then(|| {
            let mut counts = vec![0u64; k * distinct];
            for (&code, &value) in group.codes.iter().zip(ranks.codes()) {
                counts[code as usize * distinct + value as usize] += 1;
            }
            counts
        });
        let mut medians = None;
        if let Some(counts) = &counts {
            for (code, own) in counts.chunks_exact(distinct).enumerate() {
                sizes[code] = own.iter().sum::<u64>() as usize;
                doubled_sums[code] = own.iter().zip(&ranks.doubled).map(|(n, r)| n * r).sum();
            }
        } else {
            for &code in &group.codes {
                sizes[code as usize] += 1;
            }
            if ranks.is_sorted() {
                medians = Some(in_order(&ranks, &group.codes, &sizes, &mut doubled_sums));
            } else {
                doubled_sums = ranks.doubled_sums(&group.codes, k);
            }
        }
        let dropped = rows.dropped();
        Ok(Outcome::Ok(Self {
            ranks,
            group,
            dropped,
            sizes,
            doubled_sums,
            values,
            counts,
            medians,
        }))
    }

    /// Distinct responses of one group with their counts.
    pub(crate) fn tally(&self, group: usize) -> Tally {
        let Some(counts) = &self.counts else {
            let own: Vec<f64> = (0..self.values.len())
                .filter(|&i| self.group.codes[i] as usize == group)
                .map(|i| self.values[i])
                .collect();
            return Tally::of(&own);
        };
        let distinct = self.ranks.values.len();
        let own = &counts[group * distinct..(group + 1) * distinct];
        let found = || self.ranks.values.iter().zip(own).filter(|(_, count)| **count > 0);
        Tally {
            values: found().map(|(value, _)| *value).collect(),
            counts: found().map(|(_, count)| *count).collect(),
        }
    }

    /// Median response of each group.
    pub(crate) fn medians(&self) -> Vec<f64> {
        if let Some(medians) = &self.medians {
            return medians.clone();
        }
        if self.counts.is_some() {
            return (0..self.sizes.len()).map(|group| self.tally(group).median()).collect();
        }
        let mut by_group: Vec<Vec<f64>> =
            self.sizes.iter().map(|&n| Vec::with_capacity(n)).collect();
        for (&code, &value) in self.group.codes.iter().zip(self.values.iter()) {
            by_group[code as usize].push(value);
        }
        by_group.iter_mut().map(|values| middle(values)).collect()
    }
}

/// Walks the observations in ascending order: adds up the doubled ranks of each group, and meets the
/// middle of each.
fn in_order(ranks: &Ranks, groups: &[u32], sizes: &[usize], doubled_sums: &mut [u64]) -> Vec<f64> {
    // Observations of the group so far; how many there are at its lower and its upper middle.
    let mut walks: Vec<(usize, usize, usize)> =
        sizes.iter().map(|&n| (0, n.saturating_sub(1) / 2 + 1, n / 2 + 1)).collect();
    let mut middles = vec![(0.0, 0.0); sizes.len()];
    ranks.walk(|value, rank, observation| {
        let group = groups[observation] as usize;
        doubled_sums[group] += rank;
        let (met, lower, upper) = &mut walks[group];
        *met += 1;
        if *met == *lower {
            middles[group].0 = value;
        }
        if *met == *upper {
            middles[group].1 = value;
        }
    });
    middles.into_iter().map(|(low, high)| low + 0.5 * (high - low)).collect()
}

impl Tally {
    /// Median; zero for no values.
    pub(crate) fn median(&self) -> f64 {
        let total = self.total();
        let at = |place: u64| {
            let mut below = 0;
            let found = self.values.iter().zip(&self.counts).find(|(_, count)| {
                below += **count;
                below > place
            });
            found.map_or(0.0, |(value, _)| *value)
        };
        let (low, high) = (at(total.saturating_sub(1) / 2), at(total / 2));
        low + 0.5 * (high - low)
    }
}

/// Median by selection; the order of the values is lost.
fn middle(values: &mut [f64]) -> f64 {
    let n = values.len();
    if n == 0 {
        return 0.0;
    }
    let (below, &mut high, _) = values.select_nth_unstable_by(n / 2, f64::total_cmp);
    if n % 2 == 1 {
        return high;
    }
    let low = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    low + 0.5 * (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sorted, not counted: rank sums, sizes and medians are those of looking at each group alone.
    #[test]
    fn many_values_are_walked_in_order() {
        let n = 3 * crate::ranks::tally::COUNTED;
        let value = |i: usize| ((i * 7919 % 10_007) as f64).sqrt() - 40.0;
        let response = Numbers { name: "y".to_owned(), values: (0..n).map(value).collect() };
        let labels: Vec<String> = (0..n).map(|i| format!("g{}", i * i % 5)).collect();
        let group = Factor::from_cells("g", labels.iter().map(|l| Some(l.as_str())), |_| None);
        let grouped = Grouped::of(&response, &group).unwrap().ok().unwrap();
        assert!(grouped.ranks.is_sorted() && grouped.counts.is_none());
        let medians = grouped.medians();
        for (code, &median) in medians.iter().enumerate() {
            let own = || (0..n).filter(|&i| group.codes[i] as usize == code);
            assert_eq!(grouped.sizes[code], own().count());
            let sum: u64 = own().map(|i| grouped.ranks.doubled_rank(i)).sum();
            assert_eq!(grouped.doubled_sums[code], sum);
            let mut values: Vec<f64> = own().map(|i| response.values[i]).collect();
            assert_eq!(median, middle(&mut values));
            assert_eq!(grouped.tally(code).total() as usize, grouped.sizes[code]);
        }
    }
}
