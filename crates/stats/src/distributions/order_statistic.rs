//! The k-th smallest of all pair values (Walsh averages, differences) without listing the pairs.
//!
//! The number of pairs at most some limit is counted in one pass along both samples. That count is
//! nearly linear between two limits, so a false-position search (Dowell and Jarratt 1971, "Illinois")
//! closes in on k in a few passes, from limits that few values standing for many have found; once few
//! pairs are left between the limits they are listed and the k-th is selected. Halving the bits of the limits is the fallback, so the search always ends, and
//! its answer is one of the pairs' own values, to the last bit.

/// Pair values in rows: within a row they ascend.
pub(crate) trait Pairs: Sync {
    /// Pairs whose value is at most a limit, and how many distinct pairs of distinct values they are.
    fn at_most(&self, limit: f64) -> Count;

    /// Calls with value and multiplicity of each pair above `low` and at most `high`.
    fn between(&self, low: f64, high: f64, found: impl FnMut(f64, u64));

    /// Smallest and largest value.
    fn range(&self) -> (f64, f64);

    /// All pairs.
    fn all(&self) -> Count;

    /// Limits that should lie closely on both sides of the value with this share of all pairs below
    /// it, where they cost less than a few passes.
    fn guess(&self, share: f64) -> Option<(f64, f64)>;
}

/// How many pairs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Count {
    /// With repetition.
    pub pairs: u64,
    /// Of distinct values.
    pub distinct: u64,
}

/// Distinct pairs that are listed at once.
const LISTED: u64 = 1 << 18;
/// Pairs that a limit is put beside the one sought.
const ASIDE: u64 = LISTED / 4;

/// The `k`-th and the next (`k` from 1) smallest; of the last one itself twice.
pub(crate) fn two_from(pairs: &impl Pairs, k: u64) -> (f64, f64) {
    let (smallest, largest) = pairs.range();
    let all = pairs.all();
    let mut bracket =
        Bracket { low: Limit::below(smallest), high: Limit { value: largest, count: all } };
    bracket.guess(pairs, k);
    bracket.narrow(pairs, k);
    let Bracket { low, high } = bracket;
    let mut listed: Vec<(f64, u64)> = Vec::new();
    pairs.between(low.value, high.value, |value, count| listed.push((value, count)));
    let mut below = low.count.pairs;
    if listed.iter().all(|(_, count)| *count == 1) {
        below += keep_two(&mut listed, (k - below + 1) as usize);
    }
    listed.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut first = None;
    for (value, count) in listed {
        below += count;
        if first.is_none() && below >= k {
            first = Some(value);
        }
        if let Some(first) = first
            && (below > k || k == all.pairs)
        {
            return (first, value);
        }
    }
    // The next one lies above `high`.
    let first = first.unwrap_or(high.value);
    let next = next_above(pairs, high.value, largest);
    (first, next.unwrap_or(first))
}

/// Keeps the first so many smallest, and of those the last two, which are not in order; gives back how
/// many smaller ones were dropped.
fn keep_two(listed: &mut Vec<(f64, u64)>, needed: usize) -> u64 {
    // What lies above the next one need not be in order.
    if needed < listed.len() {
        listed.select_nth_unstable_by(needed, |a, b| a.0.total_cmp(&b.0));
        listed.truncate(needed);
    }
    let last_two = listed.len().saturating_sub(2);
    if last_two > 0 {
        listed.select_nth_unstable_by(last_two, |a, b| a.0.total_cmp(&b.0));
        listed.drain(..last_two);
    }
    last_two as u64
}

/// The smallest pair value above a limit.
fn next_above(pairs: &impl Pairs, limit: f64, largest: f64) -> Option<f64> {
    let base = pairs.at_most(limit);
    let (mut low, mut high) = (limit, largest);
    if base.pairs == pairs.at_most(largest).pairs {
        return None;
    }
    while pairs.at_most(high).distinct - base.distinct > LISTED {
        let middle = halfway(low, high);
        if !(middle > low && middle < high) {
            return Some(high);
        }
        if pairs.at_most(middle).pairs > base.pairs { high = middle } else { low = middle }
    }
    let mut least = f64::INFINITY;
    pairs.between(limit, high, |value, _| least = least.min(value));
    Some(least)
}

/// Limits on both sides of the k-th value: fewer than k pairs at `low`, k or more at `high`.
struct Bracket {
    low: Limit,
    high: Limit,
}

impl Bracket {
    /// Moves the ends to the limits that the pairs guess.
    fn guess(&mut self, pairs: &impl Pairs, k: u64) {
        let all = self.high.count.pairs;
        if let Some((below, above)) = pairs.guess(k as f64 / all as f64) {
            for limit in [below, above].map(|value| Limit::at(value, pairs)) {
                if limit.count.pairs < k {
                    if limit.value > self.low.value {
                        self.low = limit;
                    }
                } else if limit.value < self.high.value {
                    self.high = limit;
                }
            }
        }
    }

    /// Moves the ends until few pairs are left between them, by false position.
    fn narrow(&mut self, pairs: &impl Pairs, k: u64) {
        let Self { low, high } = self;
        let (mut low_weight, mut high_weight) = (1.0f64, 1.0f64);
        let mut last_side = None;
        let mut step = 0;
        while high.count.distinct - low.count.distinct > LISTED {
            step += 1;
            // A little to the side of k where more pairs are left, so that k comes to lie between.
            let (under, over) = (k - low.count.pairs, high.count.pairs - k);
            let aside = (under.max(over) / 4).min(ASIDE) as f64;
            let target = k as f64 - 0.5 + if under > over { -aside } else { aside };
            let below = (low.count.pairs as f64 - target) * low_weight;
            let above = (high.count.pairs as f64 - target) * high_weight;
            let by_line = low.value + (high.value - low.value) * (-below / (above - below));
            // Every fourth step halves the bits, so that no shape of the counts can stall the search.
            let inside = by_line > low.value && by_line < high.value;
            let middle =
                if inside && step % 4 != 0 { by_line } else { halfway(low.value, high.value) };
            if !(middle > low.value && middle < high.value) {
                break;
            }
            let limit = Limit::at(middle, pairs);
            let is_low = limit.count.pairs < k;
            if is_low {
                *low = limit;
                low_weight = 1.0;
                high_weight = if last_side == Some(true) { high_weight / 2.0 } else { 1.0 };
            } else {
                *high = limit;
                high_weight = 1.0;
                low_weight = if last_side == Some(false) { low_weight / 2.0 } else { 1.0 };
            }
            last_side = Some(is_low);
        }
    }
}

struct Limit {
    value: f64,
    count: Count,
}

impl Limit {
    fn at(value: f64, pairs: &impl Pairs) -> Self {
        Self { value, count: pairs.at_most(value) }
    }

    /// Just below the smallest value: no pair.
    fn below(smallest: f64) -> Self {
        Self { value: smallest.next_down(), count: Count::default() }
    }
}

/// The double halfway between two in the order of all doubles.
fn halfway(low: f64, high: f64) -> f64 {
    let to_key = |value: f64| {
        let bits = (value + 0.0).to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    let (low, high) = (i128::from(to_key(low)), i128::from(to_key(high)));
    let key = (low + (high - low) / 2) as i64;
    f64::from_bits(if key < 0 { (i64::MIN - key) as u64 } else { key as u64 })
}
