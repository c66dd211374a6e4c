//! The order of many doubles, in time linear in their number.
//!
//! A double is mapped to an integer of the same order, of which the 32 leading bits within the
//! sample's range are packed with its place into one word. The words are parted into as many ranges as
//! there are threads; in each, three passes over 11 bits (least significant first, stable) sort them.
//! The few that share all 32 bits are told apart afterwards by the whole value. No pass moves more than
//! 8 bytes a value.

use rayon::iter::{
    IndexedParallelIterator, IntoParallelIterator, IntoParallelRefIterator, ParallelIterator,
};
use rayon::slice::ParallelSlice;

/// Below this many a comparison sort is faster.
const FEW: usize = 1 << 14;
/// Words of which splitters between the ranges are chosen, for each range.
const TRIED: usize = 64;
/// Bits of a digit.
const DIGIT: u32 = 11;
const BUCKETS: usize = 1 << DIGIT;
/// Bits of a word that hold a place; the others hold the leading bits of the value.
const PLACE: u32 = 32;

/// An integer whose order is that of the doubles; -0 comes as 0.
fn key(value: f64) -> u64 {
    let bits = (value + 0.0).to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

fn value(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 1 { key & !(1 << 63) } else { !key })
}

/// Values in ascending order; -0 comes as 0.
pub(crate) fn sorted(sample: &[f64]) -> Vec<f64> {
    if sample.len() < FEW {
        let mut keys: Vec<u64> = sample.iter().map(|&value| key(value)).collect();
        keys.sort_unstable();
        return keys.into_iter().map(value).collect();
    }
    places(sample).par_iter().map(|&place| sample[place as usize] + 0.0).collect()
}

/// Places of the values in ascending order of value, places of equal values in ascending order. At
/// most 2^32 values.
pub(crate) fn places(sample: &[f64]) -> Vec<u32> {
    if sample.len() < FEW {
        let mut pairs: Vec<(u64, u32)> =
            sample.iter().enumerate().map(|(place, &value)| (key(value), place as u32)).collect();
        pairs.sort_unstable();
        return pairs.into_iter().map(|(_, place)| place).collect();
    }
    let (least, most) = sample
        .par_iter()
        .map(|&value| (key(value), key(value)))
        .reduce(|| (u64::MAX, 0), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    let shift = (u64::BITS - (most - least).leading_zeros()).saturating_sub(u64::BITS - PLACE);
    let leading = |value: f64| (key(value) - least) >> shift;
    let mut words: Vec<u64> = sample
        .par_iter()
        .enumerate()
        .map(|(place, &value)| leading(value) << PLACE | place as u64)
        .collect();
    sort(&mut words);
    let mut places: Vec<u32> = words.par_iter().map(|&word| word as u32).collect();
    if shift > 0 {
        let mut start = 0;
        for run in words.chunk_by(|a, b| a >> PLACE == b >> PLACE) {
            if run.len() > 1 {
                places[start..start + run.len()]
                    .sort_unstable_by_key(|&place| (key(sample[place as usize]), place));
            }
            start += run.len();
        }
    }
    places
}

/// Sorts words that all differ: parted into ranges, which are sorted at the same time.
fn sort(words: &mut [u64]) {
    let ranges = rayon::current_num_threads().min(words.len() / FEW).max(1);
    let mut other = vec![0u64; words.len()];
    let lengths = part(words, &mut other, ranges);
    let (mut own, mut buffers) = (Vec::with_capacity(ranges), Vec::with_capacity(ranges));
    let (mut rest, mut rest_of_other) = (words, other.as_mut_slice());
    for length in lengths {
        let (range, after) = rest.split_at_mut(length);
        let (buffer, after_in_other) = rest_of_other.split_at_mut(length);
        own.push(range);
        buffers.push(buffer);
        (rest, rest_of_other) = (after, after_in_other);
    }
    own.into_par_iter().zip(buffers).for_each(|(to, from)| sort_by_leading_bits(from, to));
}

/// Copies words into ranges of their order, each in the order that it had; returns their lengths.
fn part(words: &[u64], to: &mut [u64], ranges: usize) -> Vec<usize> {
    let step = (words.len() / (TRIED * ranges)).max(1);
    let mut tried: Vec<u64> = words.iter().step_by(step).copied().collect();
    tried.sort_unstable();
    let splitters: Vec<u64> =
        (1..ranges).map(|range| tried[range * tried.len() / ranges]).collect();
    let range_of = |word: u64| splitters.iter().filter(|&&splitter| splitter <= word).count();
    let stretch = words.len().div_ceil(ranges);
    let counts: Vec<Vec<usize>> = words
        .par_chunks(stretch)
        .map(|stretch| {
            let mut counts = vec![0; ranges];
            stretch.iter().for_each(|&word| counts[range_of(word)] += 1);
            counts
        })
        .collect();
    // The places of each stretch's words in each range.
    let mut places: Vec<Vec<&mut [u64]>> = counts.iter().map(|_| Vec::new()).collect();
    let mut rest = to;
    for range in 0..ranges {
        for (places, counts) in places.iter_mut().zip(&counts) {
            let (own, after) = std::mem::take(&mut rest).split_at_mut(counts[range]);
            places.push(own);
            rest = after;
        }
    }
    words.par_chunks(stretch).zip(places).for_each(|(stretch, places)| {
        let mut places: Vec<_> = places.into_iter().map(<[u64]>::iter_mut).collect();
        for &word in stretch {
            if let Some(place) = places[range_of(word)].next() {
                *place = word;
            }
        }
    });
    (0..ranges).map(|range| counts.iter().map(|counts| counts[range]).sum()).collect()
}

/// Sorts words by the bits above their place, words of equal bits in their order; what `from` holds
/// afterwards is of no use.
fn sort_by_leading_bits<'a>(mut from: &'a mut [u64], mut to: &'a mut [u64]) {
    const PASSES: usize = (u64::BITS - PLACE).div_ceil(DIGIT) as usize;
    let digit =
        |word: u64, pass: usize| (word >> (PLACE + pass as u32 * DIGIT)) as usize & (BUCKETS - 1);
    let mut counts = [[0u32; BUCKETS]; PASSES];
    for &word in from.iter() {
        for (pass, counts) in counts.iter_mut().enumerate() {
            counts[digit(word, pass)] += 1;
        }
    }
    let mut swapped = false;
    for (pass, counts) in counts.iter_mut().enumerate() {
        // A digit that all have in common moves nothing.
        if counts.contains(&(from.len() as u32)) {
            continue;
        }
        let mut start = 0;
        for count in counts.iter_mut() {
            start += std::mem::replace(count, start);
        }
        for &word in from.iter() {
            let place = &mut counts[digit(word, pass)];
            to[*place as usize] = word;
            *place += 1;
        }
        std::mem::swap(&mut from, &mut to);
        swapped = !swapped;
    }
    // What `from` names now is sorted; after an odd number of passes that is where it belongs.
    if !swapped {
        to.copy_from_slice(from);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pseudo_random(n: usize) -> impl Iterator<Item = f64> {
        let mut state = 1u64;
        (0..n).map(move |_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as f64 - 1e9
        })
    }

    fn is_sorted_as_few_are(sample: &[f64]) {
        let mut expected: Vec<(f64, u32)> =
            sample.iter().map(|v| v + 0.0).zip(0..sample.len() as u32).collect();
        expected.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (values, order): (Vec<f64>, Vec<u32>) = expected.into_iter().unzip();
        assert_eq!(sorted(sample), values);
        assert_eq!(places(sample), order);
    }

    #[test]
    fn many_doubles_are_sorted_as_few_are() {
        let every_size = pseudo_random(3 * FEW)
            .enumerate()
            .map(|(i, value)| value * 10f64.powi(i as i32 % 40 - 20));
        let extremes = [0.0, -0.0, 0.0, f64::MAX, f64::MIN, 5e-324, -5e-324, 1.0, 1.0];
        is_sorted_as_few_are(&every_size.chain(extremes).collect::<Vec<_>>());
    }

    /// Values that share their leading 32 bits because of one that is far away, and many ties.
    #[test]
    fn values_that_differ_late_are_told_apart() {
        let close = pseudo_random(2 * FEW).map(|value| 1.0 + value * 1e-16).chain([1e300, -1e300]);
        is_sorted_as_few_are(&close.collect::<Vec<_>>());
        let tied = pseudo_random(2 * FEW).map(|value| (value / 3e5).round());
        is_sorted_as_few_are(&tied.collect::<Vec<_>>());
        is_sorted_as_few_are(&vec![2.5; 2 * FEW]);
    }
}
