//! Pairs of values of one sample (Walsh averages) or two (differences), as order statistics are found
//! among them.

use std::ops::Range;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::distributions::order_statistic::{Count, Pairs, two_from};
use crate::ranks::tally::Tally;

/// The number of pairs of `n` values, each with itself too.
pub(super) fn pairs_of(n: u64) -> u64 {
    n * (n + 1) / 2
}

/// Values of a sample for each of those that stand for all of them.
const STOOD_FOR: usize = 8;
/// Distinct values from which on a search begins with stand-ins.
const MANY: usize = 1 << 16;
/// Distinct values a thread counts at a time.
const STRETCH: usize = 1 << 17;

/// Values at evenly spaced ranks.
fn stand_ins(tally: &Tally, before: &[u64]) -> Tally {
    let few = tally.values.len() / STOOD_FOR;
    let step = tally.total() as f64 / few as f64;
    let mut place = 0;
    let at = |i: usize| {
        let rank = ((i as f64 + 0.5) * step) as u64;
        while before[place + 1] <= rank {
            place += 1;
        }
        tally.values[place]
    };
    let values: Vec<f64> = (0..few).map(at).collect();
    let counts = vec![1; values.len()];
    Tally { values, counts }
}

/// Averages of a sample's values with each other and with themselves.
pub(super) struct WalshAverages<'a> {
    values: &'a [f64],
    counts: &'a [u64],
    /// Values with repetition before each place.
    before: Vec<u64>,
    stand_ins: Option<Tally>,
}

impl<'a> WalshAverages<'a> {
    /// Of a sample.
    pub(super) fn of(tally: &'a Tally) -> Self {
        let before = before(&tally.counts);
        let stand_ins = (tally.values.len() >= MANY).then(|| stand_ins(tally, &before));
        Self { values: &tally.values, counts: &tally.counts, before, stand_ins }
    }

    /// Pairs at most a limit whose first value stands in a range of places.
    fn at_most_from(&self, places: Range<usize>, limit: f64) -> Count {
        let Some(&start) = self.values.get(places.start) else { return Count::default() };
        // As i grows, fewer j satisfy the limit.
        let mut end = self.values.partition_point(|&other| 0.5 * (start + other) <= limit);
        let mut count = Count::default();
        for i in places {
            let first = self.values[i];
            while end > i && 0.5 * (first + self.values[end - 1]) > limit {
                end -= 1;
            }
            if end <= i {
                break;
            }
            let own = self.counts[i];
            count.distinct += (end - i) as u64;
            count.pairs += own * (own + 1) / 2 + own * (self.before[end] - self.before[i + 1]);
        }
        count
    }
}

fn before(counts: &[u64]) -> Vec<u64> {
    let mut sum = 0;
    let mut before = Vec::with_capacity(counts.len() + 1);
    before.push(0);
    before.extend(counts.iter().map(|count| {
        sum += count;
        sum
    }));
    before
}

/// The sum over stretches of the places below `n`, several at the same time.
fn over_stretches(n: usize, count: impl Fn(Range<usize>) -> Count + Sync) -> Count {
    if n <= STRETCH {
        return count(0..n);
    }
    let stretches = (0..n.div_ceil(STRETCH)).into_par_iter();
    stretches.map(|s| count(s * STRETCH..n.min((s + 1) * STRETCH))).reduce(
        Count::default,
        |a, b| Count { pairs: a.pairs + b.pairs, distinct: a.distinct + b.distinct },
    )
}

impl Pairs for WalshAverages<'_> {
    fn at_most(&self, limit: f64) -> Count {
        over_stretches(self.values.len(), |places| self.at_most_from(places, limit))
    }

    fn between(&self, low: f64, high: f64, mut found: impl FnMut(f64, u64)) {
        let (mut start, mut end) = (self.values.len(), self.values.len());
        for (i, &first) in self.values.iter().enumerate() {
            let average = |j: usize| 0.5 * (first + self.values[j]);
            while end > i && average(end - 1) > high {
                end -= 1;
            }
            if end <= i {
                break;
            }
            while start > i && average(start - 1) > low {
                start -= 1;
            }
            for j in start.max(i)..end {
                let own = self.counts[i];
                let count = if i == j { own * (own + 1) / 2 } else { own * self.counts[j] };
                found(average(j), count);
            }
        }
    }

    fn range(&self) -> (f64, f64) {
        (self.values[0], self.values[self.values.len() - 1])
    }

    fn all(&self) -> Count {
        let distinct = self.values.len() as u64;
        Count { pairs: pairs_of(self.before[self.values.len()]), distinct: pairs_of(distinct) }
    }

    fn guess(&self, share: f64) -> Option<(f64, f64)> {
        let few = self.stand_ins.as_ref()?;
        Some(around(&WalshAverages::of(few), pairs_of(few.total()), few.values.len(), share))
    }
}

/// Differences x - y of two samples.
pub(super) struct Differences<'a> {
    x: &'a Tally,
    y: &'a Tally,
    y_before: Vec<u64>,
    stand_ins: Option<[Tally; 2]>,
}

impl<'a> Differences<'a> {
    /// Of two samples.
    pub(super) fn of(x: &'a Tally, y: &'a Tally) -> Self {
        let y_before = before(&y.counts);
        let many = x.values.len() >= MANY && y.values.len() >= MANY;
        let stand_ins = many.then(|| [stand_ins(x, &before(&x.counts)), stand_ins(y, &y_before)]);
        Self { x, y, y_before, stand_ins }
    }

    /// Pairs at most a limit whose first value stands in a range of places.
    fn at_most_from(&self, places: Range<usize>, limit: f64) -> Count {
        let Some(&least) = self.x.values.get(places.start) else { return Count::default() };
        let (ys, all) = (&self.y.values, self.y_before[self.y.values.len()]);
        // As x grows, y must be larger.
        let mut start = ys.partition_point(|&y| least - y > limit);
        let mut count = Count::default();
        for (&first, &own) in self.x.values[places.clone()].iter().zip(&self.x.counts[places]) {
            while start < ys.len() && first - ys[start] > limit {
                start += 1;
            }
            count.distinct += (ys.len() - start) as u64;
            count.pairs += own * (all - self.y_before[start]);
        }
        count
    }
}

/// Limits that should lie on both sides of what has this share of the pairs below it, from pairs of
/// stand-ins. Each stands at a rank that is wrong by up to half a step; over all of them such errors
/// leave about the root of their number.
fn around(few: &impl Pairs, pairs: u64, stand_ins: usize, share: f64) -> (f64, f64) {
    let reach = 4.0 * (stand_ins as f64).sqrt();
    let at = |k: f64| two_from(few, (k.round().max(1.0) as u64).min(pairs)).0;
    (at(share * pairs as f64 - reach), at(share * pairs as f64 + reach))
}

impl Pairs for Differences<'_> {
    fn at_most(&self, limit: f64) -> Count {
        over_stretches(self.x.values.len(), |places| self.at_most_from(places, limit))
    }

    fn between(&self, low: f64, high: f64, mut found: impl FnMut(f64, u64)) {
        let (mut start, mut end) = (0, 0);
        let ys = &self.y.values;
        for (&first, &own) in self.x.values.iter().zip(&self.x.counts) {
            while start < ys.len() && first - ys[start] > high {
                start += 1;
            }
            while end < ys.len() && first - ys[end] > low {
                end += 1;
            }
            for (&second, &count) in ys[start..end].iter().zip(&self.y.counts[start..end]) {
                found(first - second, own * count);
            }
        }
    }

    fn range(&self) -> (f64, f64) {
        let (x, y) = (&self.x.values, &self.y.values);
        (x[0] - y[y.len() - 1], x[x.len() - 1] - y[0])
    }

    fn all(&self) -> Count {
        let (x, y) = (self.x.values.len() as u64, self.y.values.len() as u64);
        Count { pairs: self.x.total() * self.y_before[self.y.values.len()], distinct: x * y }
    }

    fn guess(&self, share: f64) -> Option<(f64, f64)> {
        let [x, y] = self.stand_ins.as_ref()?;
        let few = x.values.len().min(y.values.len());
        Some(around(&Differences::of(x, y), x.total() * y.total(), few, share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::hodges_lehmann::two_sample_location;

    fn pseudo_random(n: usize, levels: u64) -> Vec<f64> {
        let mut state = n as u64 ^ levels;
        (0..n)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                ((state >> 33) % levels) as f64 / 7.0 - levels as f64 / 20.0
            })
            .collect()
    }

    /// Each order statistic against the sorted list, for few and many pairs, with and without ties.
    #[test]
    fn order_statistics_are_those_of_the_list() {
        for (n, levels) in
            [(1, 3), (2, 3), (7, 4), (30, 5), (60, 1 << 30), (700, 900), (900, 1 << 30)]
        {
            let (sample, y) = (pseudo_random(n, levels), pseudo_random(n / 2 + 1, levels + 1));
            let mut walsh: Vec<f64> = (0..n)
                .flat_map(|i| (i..n).map(move |j| (i, j)))
                .map(|(i, j)| 0.5 * (sample[i] + sample[j]))
                .collect();
            walsh.sort_by(f64::total_cmp);
            let mut differences: Vec<f64> =
                sample.iter().flat_map(|x| y.iter().map(move |y| x - y)).collect();
            differences.sort_by(f64::total_cmp);
            let (x, y) = (Tally::of(&sample), Tally::of(&y));
            let (averages, shifts) = (WalshAverages::of(&x), Differences::of(&x, &y));
            let step = (walsh.len() / 97).max(1);
            for k in (0..walsh.len()).step_by(step).chain([walsh.len() - 1]) {
                let next = walsh[(k + 1).min(walsh.len() - 1)];
                assert_eq!(two_from(&averages, k as u64 + 1), (walsh[k], next), "{n} {levels} {k}");
            }
            for k in (0..differences.len()).step_by(step).chain([differences.len() - 1]) {
                let next = differences[(k + 1).min(differences.len() - 1)];
                assert_eq!(two_from(&shifts, k as u64 + 1), (differences[k], next), "{n} {k}");
            }
            let half = differences.len() / 2;
            let median = if differences.len() % 2 == 1 {
                differences[half]
            } else {
                0.5 * (differences[half - 1] + differences[half])
            };
            assert_eq!(two_sample_location(&x, &y), median);
        }
    }

    /// Too many pairs to list: the k-th has k at or below it and fewer below it, the next one k + 1.
    fn is_kth(pairs: &impl Pairs, k: u64) {
        let (value, next) = two_from(pairs, k);
        let at_most = |limit: f64| pairs.at_most(limit).pairs;
        assert!(at_most(value) >= k && at_most(value.next_down()) < k, "{k}: {value}");
        assert!(at_most(next) > k && at_most(next.next_down()) <= k, "{k}: {next}");
    }

    /// Stand-ins only say where to begin: many values, with ties and with some far away.
    #[test]
    fn order_statistics_of_many_values_have_as_many_below() {
        let many = 3 * MANY / 2;
        let even = pseudo_random(many, 1 << 30);
        // So many that stand-ins have stand-ins.
        let more = pseudo_random(STOOD_FOR * MANY + 1000, 1 << 30);
        let tied: Vec<f64> = pseudo_random(2 * many, 1 << 17).iter().map(|x| x.round()).collect();
        let tied: Vec<f64> = tied.iter().chain(&even).copied().collect();
        let skewed: Vec<f64> = even.iter().map(|x| (x / 3e6).exp() * x.signum()).collect();
        for sample in [even, more, tied, skewed] {
            let tally = Tally::of(&sample);
            assert!(tally.values.len() >= MANY);
            let averages = WalshAverages::of(&tally);
            assert!(averages.stand_ins.is_some());
            let pairs = pairs_of(tally.total());
            for k in [1, 2, pairs / 1000, pairs / 2, pairs / 2 + 1, pairs - pairs / 50, pairs - 1] {
                is_kth(&averages, k);
            }
            let other = Tally::of(&sample.iter().rev().map(|x| x * 1.5 + 1.0).collect::<Vec<_>>());
            let shifts = Differences::of(&tally, &other);
            assert!(shifts.stand_ins.is_some());
            let pairs = tally.total() * other.total();
            for k in [1, pairs / 40, pairs / 2, pairs - 1] {
                is_kth(&shifts, k);
            }
        }
    }
}
