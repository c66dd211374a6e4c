//! Kendall's tau-b in n log n (Knight 1966).

use crate::ranks::Ranks;

/// tau-b of two rankings of the same observations, neither of them constant.
pub(crate) fn kendall_tau_b(x: &Ranks, y: &Ranks) -> f64 {
    if x.values.len() * y.values.len() <= TABLE { by_table(x, y) } else { by_sorting(x, y) }
}

fn by_sorting(x: &Ranks, y: &Ranks) -> f64 {
    let mut pairs: Vec<(u32, u32)> = x.codes.iter().copied().zip(y.codes.iter().copied()).collect();
    pairs.sort_unstable();
    let choose_two = |count: u64| (count as f64) * (count as f64 - 1.0) / 2.0;
    let tied = |ranks: &Ranks| ranks.counts.iter().map(|&count| choose_two(count)).sum::<f64>();
    let (tied_x, tied_y) = (tied(x), tied(y));
    let tied_both: f64 =
        pairs.chunk_by(|a, b| a == b).map(|group| choose_two(group.len() as u64)).sum();
    let all = choose_two(pairs.len() as u64);
    let mut order: Vec<u32> = pairs.into_iter().map(|(_, y)| y).collect();
    let mut buffer = order.clone();
    let discordant = inversions(&mut order, &mut buffer) as f64;
    let concordant = all - tied_x - tied_y + tied_both - discordant;
    (concordant - discordant) / ((all - tied_x) * (all - tied_y)).sqrt()
}

/// Cells of a table of counts up to which it replaces sorting.
const TABLE: usize = 1 << 16;

/// From the counts of each combination of values: a cell is concordant with all cells below and to the
/// right of it, discordant with all below and to the left.
fn by_table(x: &Ranks, y: &Ranks) -> f64 {
    let width = y.values.len();
    let mut counts = vec![0u64; x.values.len() * width];
    for (&a, &b) in x.codes.iter().zip(&y.codes) {
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

/// Sorts and counts the pairs that were in descending order.
fn inversions(values: &mut [u32], buffer: &mut [u32]) -> u64 {
    let n = values.len();
    if n < 2 {
        return 0;
    }
    let middle = n / 2;
    let (left, right) = values.split_at_mut(middle);
    let (left_buffer, right_buffer) = buffer.split_at_mut(middle);
    let mut count = inversions(left, left_buffer) + inversions(right, right_buffer);
    let (mut i, mut j) = (0, 0);
    for place in buffer.iter_mut() {
        if j >= right.len() || (i < left.len() && left[i] <= right[j]) {
            *place = left[i];
            i += 1;
        } else {
            count += (left.len() - i) as u64;
            *place = right[j];
            j += 1;
        }
    }
    values.copy_from_slice(buffer);
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_counting_all_pairs() {
        let x: Vec<f64> = (0..60).map(|i| f64::from(i * 37 % 11)).collect();
        let y: Vec<f64> = (0..60).map(|i| f64::from(i * 53 % 7)).collect();
        let (mut sum, mut untied_x, mut untied_y) = (0.0f64, 0.0f64, 0.0f64);
        for i in 0..60 {
            for j in 0..i {
                let (dx, dy) = (x[i] - x[j], y[i] - y[j]);
                sum += dx.signum() * dy.signum() * f64::from(u8::from(dx != 0.0 && dy != 0.0));
                untied_x += f64::from(u8::from(dx != 0.0));
                untied_y += f64::from(u8::from(dy != 0.0));
            }
        }
        let direct = sum / (untied_x * untied_y).sqrt();
        assert!((by_table(&Ranks::of(&x), &Ranks::of(&y)) - direct).abs() < 1e-14);
        assert!((by_sorting(&Ranks::of(&x), &Ranks::of(&y)) - direct).abs() < 1e-14);
    }
}
