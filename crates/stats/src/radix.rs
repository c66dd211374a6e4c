//! Sorting of many doubles by their bits: least significant digit first, stable, linear in their number.

/// Below this many a comparison sort is faster.
const FEW: usize = 1 << 15;
/// Bits of a digit.
const DIGIT: u32 = 11;
const BUCKETS: usize = 1 << DIGIT;
const PASSES: usize = 6;

/// An integer whose order is that of the doubles; -0 comes as 0.
fn key(value: f64) -> u64 {
    let bits = (value + 0.0).to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

fn value(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 1 { key & !(1 << 63) } else { !key })
}

/// Values in ascending order.
pub(crate) fn sorted(sample: &[f64]) -> Vec<f64> {
    let mut keys: Vec<u64> = sample.iter().map(|&value| key(value)).collect();
    if keys.len() < FEW {
        keys.sort_unstable();
    } else {
        sort_by_digits(&mut keys, |key| *key);
    }
    keys.into_iter().map(value).collect()
}

/// Values in ascending order, each with its place in the sample.
pub(crate) fn sorted_with_places(sample: &[f64]) -> Vec<(f64, u32)> {
    let mut pairs: Vec<(u64, u32)> =
        sample.iter().enumerate().map(|(place, &value)| (key(value), place as u32)).collect();
    if pairs.len() < FEW {
        pairs.sort_unstable();
    } else {
        sort_by_digits(&mut pairs, |pair| pair.0);
    }
    pairs.into_iter().map(|(key, place)| (value(key), place)).collect()
}

fn sort_by_digits<T: Copy + Default>(items: &mut Vec<T>, key: impl Fn(&T) -> u64) {
    let digit = |key: u64, pass: usize| (key >> (pass as u32 * DIGIT)) as usize & (BUCKETS - 1);
    let mut counts = vec![[0usize; BUCKETS]; PASSES];
    for item in items.iter() {
        let key = key(item);
        for (pass, counts) in counts.iter_mut().enumerate() {
            counts[digit(key, pass)] += 1;
        }
    }
    let mut other = vec![T::default(); items.len()];
    for (pass, counts) in counts.iter_mut().enumerate() {
        // A digit that all have in common moves nothing.
        if counts.contains(&items.len()) {
            continue;
        }
        let mut start = 0;
        for count in counts.iter_mut() {
            start += std::mem::replace(count, start);
        }
        for item in items.iter() {
            let place = &mut counts[digit(key(item), pass)];
            other[*place] = *item;
            *place += 1;
        }
        std::mem::swap(items, &mut other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_doubles_are_sorted_as_few_are() {
        let mut state = 1u64;
        let mut sample: Vec<f64> = (0..3 * FEW)
            .map(|i| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                ((state >> 33) as f64 - 1e9) * 10f64.powi(i as i32 % 40 - 20)
            })
            .collect();
        sample.extend([0.0, f64::MAX, f64::MIN, 5e-324, -5e-324, 1.0, 1.0]);
        let mut expected = sample.clone();
        expected.sort_by(f64::total_cmp);
        assert_eq!(sorted(&sample), expected);
        let with_places = sorted_with_places(&sample);
        assert!(with_places.iter().all(|&(value, place)| sample[place as usize] == value));
        assert!(with_places.windows(2).all(|w| (w[0].0, w[0].1) <= (w[1].0, w[1].1)));
    }
}
