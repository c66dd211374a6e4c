//! The rules that a bank of expressions should keep (Kouadio 4.4), as he puts them for the matrix
//! of the bank (5.6): independent columns, no zero column, no zero row, more rows than columns.

use crate::linear_algebra::dense::{axpy, dot};

/// What is left of a shape, after the best combination of others, below which it counts as one of
/// them: Kouadio's artists retouched such combinations by hand, so that few are exact.
pub const DEPENDENT_SHARE: f64 = 0.01;

/// A shape that is a combination of others (rule 1).
#[derive(Debug, Clone, PartialEq)]
pub struct Combination {
    /// The shape that can go.
    pub shape: usize,
    /// The others with their weights, by their share of the shape, largest first.
    pub of: Vec<(usize, f64)>,
    /// What the combination leaves of the shape, as a share of its size.
    pub left: f64,
}

/// The columns of a bank's matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct BankColumns {
    /// How many columns are independent, to [`DEPENDENT_SHARE`].
    pub rank: usize,
    /// The shapes that follow from others.
    pub dependent: Vec<Combination>,
    /// The shapes that move nothing: the neutral face, or one that no row sees (rules 2 and 4).
    pub zero: Vec<usize>,
    /// Smallest share of itself that an independent shape keeps when the others are taken out in
    /// the order of the factorisation: near 0 = nearly dependent.
    pub least_share: f64,
}

/// Look at the columns of `bank`: rows x n, row-major (D of 3P rows, or the whole face's 3S), in
/// metres. `least` is the size (norm) of a column that counts as zero.
///
/// Householder's factorisation with the column that is furthest from those before it taken next
/// (Businger and Golub 1965), each column in units of its size.
///
/// # Panics
/// If `bank` is not whole rows.
pub fn bank_columns(bank: &[f64], n: usize, least: f64) -> BankColumns {
    assert!(n > 0 && bank.len().is_multiple_of(n), "whole rows of n numbers");
    let rows = bank.len() / n;
    let mut columns: Vec<Vec<f64>> =
        (0..n).map(|j| (0..rows).map(|i| bank[i * n + j]).collect()).collect();
    let sizes: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
    let (zero, mut open): (Vec<usize>, Vec<usize>) = (0..n).partition(|&j| !(sizes[j] > least));
    for &j in &open {
        columns[j].iter_mut().for_each(|x| *x /= sizes[j]);
    }
    // `open` columns keep their part outside the span of `taken` below row `taken.len()`.
    let mut taken: Vec<usize> = Vec::new();
    let mut least_share = 1.0_f64;
    while !open.is_empty() && taken.len() < rows {
        let k = taken.len();
        let outside = |j: usize| dot(&columns[j][k..], &columns[j][k..]).sqrt();
        let mut best = 0;
        for at in 1..open.len() {
            // A little more than rounding, so that the order of equals is that of the bank.
            if outside(open[at]) > outside(open[best]) * (1.0 + 1e-12) {
                best = at;
            }
        }
        let share = outside(open[best]);
        if share < DEPENDENT_SHARE {
            break;
        }
        least_share = least_share.min(share);
        let pivot = open.remove(best);
        let mut v = columns[pivot][k..].to_vec();
        v[0] += if v[0] < 0.0 { -share } else { share };
        let square = dot(&v, &v);
        for &j in open.iter().chain([&pivot]) {
            let column = &mut columns[j][k..];
            let factor = -2.0 * dot(&v, column) / square;
            axpy(factor, &v, column);
        }
        taken.push(pivot);
    }
    let mut dependent: Vec<Combination> =
        open.iter().map(|&j| combination(&columns, &taken, &sizes, j)).collect();
    dependent.sort_by_key(|c| c.shape);
    BankColumns { rank: taken.len(), dependent, zero, least_share }
}

/// Column j in terms of the taken ones, and which of them all is best called the combination: the
/// one whose weights are all positive, as a face is made.
fn combination(columns: &[Vec<f64>], taken: &[usize], sizes: &[f64], j: usize) -> Combination {
    let rank = taken.len();
    // R a = the column's first rows.
    let mut a = columns[j][..rank].to_vec();
    for k in (0..rank).rev() {
        a[k] /= columns[taken[k]][k];
        let x = a[k];
        axpy(-x, &columns[taken[k]][..k], &mut a[..k]);
    }
    let left = dot(&columns[j][rank..], &columns[j][rank..]).sqrt();
    // Parts in units of the column's size; those below the tolerance are no part of it.
    let parts: Vec<(usize, f64)> =
        taken.iter().copied().zip(a).filter(|(_, x)| x.abs() > DEPENDENT_SHARE).collect();
    let negative: Vec<usize> = (0..parts.len()).filter(|&i| parts[i].1 < 0.0).collect();
    let (shape, mut of, left) = match negative[..] {
        // x = a - b with one b: a is better called x + b.
        [_, ..] if parts.len() - negative.len() == 1 => {
            let whole = parts.iter().position(|p| p.1 > 0.0).unwrap_or(0);
            let (shape, weight) = parts[whole];
            let mut of: Vec<(usize, f64)> = (parts.iter().enumerate())
                .filter(|(i, _)| *i != whole)
                .map(|(_, &(k, x))| (k, -x / weight))
                .collect();
            of.push((j, 1.0 / weight));
            (shape, of, left / weight)
        }
        _ => (j, parts, left),
    };
    of.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(a.0.cmp(&b.0)));
    // Back to weights of the shapes as they are.
    let of = of.into_iter().map(|(k, x)| (k, x * sizes[shape] / sizes[k])).collect();
    Combination { shape, of, left }
}

/// The rows (marker and axis) that no shape moves by `least` metres at weight 1 (rule 3): those of
/// D, 3P x n.
pub fn dead_rows(bank: &[f64], n: usize, least: f64) -> Vec<(usize, usize)> {
    (bank.chunks_exact(n.max(1)).enumerate())
        .filter(|(_, row)| row.iter().all(|x| x.abs() < least))
        .map(|(row, _)| (row / 3, row % 3))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Row-major matrix of some columns.
    fn bank(columns: &[Vec<f64>]) -> Vec<f64> {
        (0..columns[0].len()).flat_map(|i| columns.iter().map(move |c| c[i])).collect()
    }

    #[test]
    fn planted_combinations_are_named_with_their_weights() {
        let rows = 30;
        let base: Vec<Vec<f64>> = (0..5)
            .map(|k| crate::linear_algebra::dense::numbers(rows, 0.7 + 1.9 * f64::from(k)))
            .collect();
        let mix = |parts: &[(usize, f64)]| -> Vec<f64> {
            (0..rows).map(|i| parts.iter().map(|&(k, x)| x * base[k][i]).sum()).collect()
        };
        let mut columns = base.clone();
        columns.push(mix(&[(0, 0.5), (3, 2.0)]));
        columns.push(vec![0.0; rows]);
        columns.push(mix(&[(1, 3.0)]));
        let found = bank_columns(&bank(&columns), 8, 1e-9);
        assert_eq!((found.rank, &found.zero[..]), (5, &[6][..]));
        assert_eq!(found.dependent.len(), 2);
        for c in &found.dependent {
            assert!(c.left < 1e-12);
            let made: Vec<f64> =
                (0..rows).map(|i| c.of.iter().map(|&(k, x)| x * columns[k][i]).sum()).collect();
            for (a, b) in made.iter().zip(&columns[c.shape]) {
                assert!((a - b).abs() < 1e-11);
            }
        }
        // The sum of two is named, never one of its parts.
        let sum = found.dependent.iter().find(|c| c.of.len() == 2).unwrap();
        assert_eq!(sum.shape, 5);
        let mut of = sum.of.clone();
        of.sort_by_key(|p| p.0);
        assert!((of[0].1 - 0.5).abs() < 1e-12 && (of[1].1 - 2.0).abs() < 1e-12, "{of:?}");
        // A copy and its original can each be called the other.
        let copy = found.dependent.iter().find(|c| c.of.len() == 1).unwrap();
        assert!([1, 7].contains(&copy.shape) && [1, 7].contains(&copy.of[0].0));
    }

    #[test]
    fn retouched_combinations_count_and_more_unknowns_than_rows_do_too() {
        let base: Vec<Vec<f64>> =
            (0..3).map(|k| crate::linear_algebra::dense::numbers(24, 2.0 + f64::from(k))).collect();
        let touch = crate::linear_algebra::dense::numbers(24, 9.0);
        let near = |share: f64| -> Vec<f64> {
            (0..24).map(|i| base[0][i] + base[1][i] + share * touch[i]).collect()
        };
        let with = |column: Vec<f64>| {
            let mut columns = base.clone();
            columns.push(column);
            bank_columns(&bank(&columns), 4, 1e-9)
        };
        let touched = with(near(0.004));
        assert_eq!((touched.rank, touched.dependent.len()), (3, 1));
        assert!(touched.dependent[0].left > 1e-4 && touched.dependent[0].left < 0.01);
        assert_eq!(with(near(0.3)).rank, 4);
        // Three rows hold three independent columns at most.
        let few = bank_columns(&crate::linear_algebra::dense::numbers(3 * 5, 0.3), 5, 1e-9);
        assert_eq!((few.rank, few.dependent.len()), (3, 2));
    }

    #[test]
    fn rows_that_nothing_moves_are_found() {
        let mut d = vec![0.0; 6 * 2];
        d[2] = 0.002;
        d[9] = -0.0005;
        assert_eq!(dead_rows(&d, 2, 1e-4), [(0, 0), (0, 2), (1, 0), (1, 2)]);
    }
}
