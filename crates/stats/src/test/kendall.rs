//! Kendall's tau-b in n log n (Knight 1966).

use crate::ranks::Ranks;

/// Whether the combinations of values are few enough to be counted.
pub(crate) fn is_small_table(x: &Ranks, y: &Ranks) -> bool {
    x.values.len() * y.values.len() <= TABLE
}

/// tau-b of two rankings of the same observations, neither of them constant; `order` is y's
/// [`Ranks::codes_in_order_of`] x.
pub(crate) fn by_sorting(x: &Ranks, y: &Ranks, mut order: Vec<u32>) -> f64 {
    let choose_two = |count: u64| (count as f64) * (count as f64 - 1.0) / 2.0;
    let tied = |ranks: &Ranks| ranks.counts.iter().map(|&count| choose_two(count)).sum::<f64>();
    let (tied_x, tied_y) = (tied(x), tied(y));
    let (mut tied_both, mut rest) = (0.0, order.as_mut_slice());
    for &count in &x.counts {
        let (group, after) = rest.split_at_mut(count as usize);
        rest = after;
        if count > 1 {
            group.sort_unstable();
            let both = group.chunk_by(|a, b| a == b).map(|same| choose_two(same.len() as u64));
            tied_both += both.sum::<f64>();
        }
    }
    let all = choose_two(x.len() as u64);
    let mut buffer = order.clone();
    let discordant = inversions(&mut order, &mut buffer) as f64;
    let concordant = all - tied_x - tied_y + tied_both - discordant;
    (concordant - discordant) / ((all - tied_x) * (all - tied_y)).sqrt()
}

/// Cells of a table of counts up to which it replaces sorting.
const TABLE: usize = 1 << 16;

/// tau-b from the counts of each combination of values: a cell is concordant with all cells below and to the
/// right of it, discordant with all below and to the left.
pub(crate) fn by_table(x: &Ranks, y: &Ranks) -> f64 {
    let width = y.values.len();
    let mut counts = vec![0u64; x.values.len() * width];
    for (&a, &b) in x.codes().iter().zip(y.codes()) {
        counts[a as usize * width + b as usize] += 1;
    }
    // Counts of each column in all rows below.
    let mut below = vec![0u64; width];
    let (mut concordant, mut discordant) = (0u128, 0u128);
    for row in counts.chunks_exact(width).rev() {
        let (mut left, mut right) = (0u64, below.iter().sum::<u64>());
        for (&count, &under) in row.iter().zip(&below) {
            right -= under;
            concordant += u128::from(count) * u128::from(right);
            discordant += u128::from(count) * u128::from(left);
            left += under;
        }
        for (under, count) in below.iter_mut().zip(row) {
            *under += count;
        }
    }
    let choose_two = |count: u64| (count as f64) * (count as f64 - 1.0) / 2.0;
    let tied = |ranks: &Ranks| ranks.counts.iter().map(|&count| choose_two(count)).sum::<f64>();
    let all = choose_two(x.len() as u64);
    (concordant as f64 - discordant as f64) / ((all - tied(x)) * (all - tied(y))).sqrt()
}

/// Below this many, values are sorted by insertion.
const FEW: usize = 24;
/// From this many on, both halves are sorted at the same time.
const MANY: usize = 1 << 14;

/// Sorts and counts the pairs that were in descending order.
fn inversions(values: &mut [u32], buffer: &mut [u32]) -> u64 {
    let n = values.len();
    if n < FEW {
        return inversions_of_few(values);
    }
    let (left, right) = values.split_at_mut(n / 2);
    let (left_buffer, right_buffer) = buffer.split_at_mut(n / 2);
    let (in_left, in_right) = if n < MANY {
        (inversions(left, left_buffer), inversions(right, right_buffer))
    } else {
        rayon::join(|| inversions(left, left_buffer), || inversions(right, right_buffer))
    };
    let (mut i, mut j, mut between) = (0, 0, 0);
    let mut places = buffer.iter_mut();
    while i < left.len() && j < right.len() {
        let (a, b) = (left[i], right[j]);
        // Without a branch: which side is next is a coin toss.
        let from_right = usize::from(b < a);
        if let Some(place) = places.next() {
            *place = a.min(b);
        }
        between += from_right * (left.len() - i);
        i += 1 - from_right;
        j += from_right;
    }
    for (place, value) in places.zip(left[i..].iter().chain(&right[j..])) {
        *place = *value;
    }
    values.copy_from_slice(buffer);
    in_left + in_right + between as u64
}

fn inversions_of_few(values: &mut [u32]) -> u64 {
    let mut count = 0;
    for end in 1..values.len() {
        let mut at = end;
        while at > 0 && values[at - 1] > values[at] {
            values.swap(at - 1, at);
            at -= 1;
        }
        count += end - at;
    }
    count as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Few and many, with ties and without.
    #[test]
    fn agrees_with_counting_all_pairs() {
        agrees(60, 11, 7);
        agrees(700, 1009, 31);
        agrees(700, 1009, 997);
    }

    #[test]
    fn inversions_of_many_are_those_of_few() {
        let mut values: Vec<u32> = (0..5000u32).map(|i| i * 7919 % 4001).collect();
        let (mut same, mut buffer) = (values.clone(), values.clone());
        assert_eq!(inversions(&mut values, &mut buffer), inversions_of_few(&mut same));
        assert_eq!(values, same);
    }

    fn agrees(n: usize, x_levels: usize, y_levels: usize) {
        let x: Vec<f64> = (0..n).map(|i| (i * 37 % x_levels) as f64).collect();
        let y: Vec<f64> = (0..n).map(|i| (i * 53 % y_levels) as f64).collect();
        let (mut sum, mut untied_x, mut untied_y) = (0.0f64, 0.0f64, 0.0f64);
        for i in 0..n {
            for j in 0..i {
                let (dx, dy) = (x[i] - x[j], y[i] - y[j]);
                sum += dx.signum() * dy.signum() * f64::from(u8::from(dx != 0.0 && dy != 0.0));
                untied_x += f64::from(u8::from(dx != 0.0));
                untied_y += f64::from(u8::from(dy != 0.0));
            }
        }
        let direct = sum / (untied_x * untied_y).sqrt();
        assert!((by_table(&Ranks::of(&x), &Ranks::of(&y)) - direct).abs() < 1e-14);
        let (x, y) = (Ranks::of(&x), Ranks::of(&y));
        assert!((by_sorting(&x, &y, y.codes_in_order_of(&x)) - direct).abs() < 1e-14);
    }
}
