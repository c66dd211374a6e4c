//! Sparse symmetric systems that live on a surface: nested dissection by place, Cholesky's factor row
//! by row (the up-looking form of Davis, *Direct Methods for Sparse Linear Systems*, 2006, ch. 4).
//!
//! Order and operations are written here, so that every processor gets the same bits.

/// A symmetric sparse matrix, every row in full, columns ascending.
#[derive(Debug, Clone, Default)]
pub(crate) struct SymmetricRows {
    /// Row i is `starts[i]..starts[i + 1]` of `columns` and `values`.
    pub(crate) starts: Vec<usize>,
    pub(crate) columns: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

/// L of P A P^T = L L^T.
#[derive(Debug, Clone)]
pub(crate) struct SparseCholesky {
    /// Unknown at each place of the elimination.
    order: Vec<usize>,
    /// Column k of L is `starts[k]..starts[k + 1]`; the diagonal comes first.
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

/// Sets this small are not divided further: their factor is all but dense.
const SMALLEST_PART: usize = 48;
/// A pivot below this part of its diagonal entry is rounding.
const VANISHED_PIVOT: f64 = 1e-13;
const NONE: usize = usize::MAX;

impl SymmetricRows {
    pub(crate) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    pub(crate) fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        (self.starts[i]..self.starts[i + 1]).map(|k| (self.columns[k], self.values[k]))
    }
}

impl SparseCholesky {
    /// The factor of a matrix whose unknowns sit at `places`; the unknown whose pivot is not
    /// positive, where the matrix is not positive definite.
    pub(crate) fn new(a: &SymmetricRows, places: &[[f64; 3]]) -> Result<SparseCholesky, usize> {
        let n = a.len();
        let mut order = Vec::with_capacity(n);
        dissect(a, places, (0..n).collect(), &mut vec![0; n], &mut 0, &mut order);
        let mut place_of = vec![0; n];
        order.iter().enumerate().for_each(|(place, &unknown)| place_of[unknown] = place);
        // Entries of column k of the permuted upper triangle.
        let upper =
            |k: usize| a.row(order[k]).map(|(j, x)| (place_of[j], x)).filter(move |(i, _)| *i <= k);

        let mut parents = vec![NONE; n];
        let mut ancestors = vec![NONE; n];
        for k in 0..n {
            for (mut i, _) in upper(k) {
                while i < k && i != NONE {
                    let next = std::mem::replace(&mut ancestors[i], k);
                    if next == NONE {
                        parents[i] = k;
                    }
                    i = next;
                }
            }
        }
        let mut seen_by = vec![NONE; n];
        let mut columns = Vec::new();
        let mut starts = vec![0; n + 1];
        for k in 0..n {
            reach(upper(k).map(|(i, _)| i), k, &parents, &mut seen_by, &mut columns);
            starts[k + 1] += 1;
            columns.iter().for_each(|&j| starts[j + 1] += 1);
        }
        for k in 0..n {
            starts[k + 1] += starts[k];
        }

        let mut rows = vec![0; starts[n]];
        let mut values = vec![0.0; starts[n]];
        let mut next = starts.clone();
        let mut x = vec![0.0; n];
        seen_by.fill(NONE);
        for k in 0..n {
            upper(k).for_each(|(i, value)| x[i] = value);
            reach(upper(k).map(|(i, _)| i), k, &parents, &mut seen_by, &mut columns);
            let own = x[k];
            let mut pivot = own;
            x[k] = 0.0;
            for &j in &columns {
                let l = x[j] / values[starts[j]];
                x[j] = 0.0;
                for at in starts[j] + 1..next[j] {
                    x[rows[at]] -= values[at] * l;
                }
                pivot -= l * l;
                rows[next[j]] = k;
                values[next[j]] = l;
                next[j] += 1;
            }
            if !(pivot > VANISHED_PIVOT * own && pivot.is_finite()) {
                return Err(order[k]);
            }
            rows[next[k]] = k;
            values[next[k]] = pivot.sqrt();
            next[k] += 1;
        }
        Ok(SparseCholesky { order, starts, rows, values })
    }

    /// X := A^-1 X, n x `width`, row-major.
    pub(crate) fn solve(&self, x: &mut [f64], width: usize) {
        let n = self.order.len();
        let mut y = vec![0.0; x.len()];
        for (row, &unknown) in y.chunks_exact_mut(width).zip(&self.order) {
            row.copy_from_slice(&x[unknown * width..(unknown + 1) * width]);
        }
        for k in 0..n {
            let (above, below) = y.split_at_mut((k + 1) * width);
            let row = &mut above[k * width..];
            let diagonal = self.values[self.starts[k]];
            row.iter_mut().for_each(|v| *v /= diagonal);
            for at in self.starts[k] + 1..self.starts[k + 1] {
                let target = (self.rows[at] - k - 1) * width;
                let l = self.values[at];
                for (t, v) in below[target..target + width].iter_mut().zip(row.iter()) {
                    *t -= l * v;
                }
            }
        }
        for k in (0..n).rev() {
            let (above, below) = y.split_at_mut((k + 1) * width);
            let row = &mut above[k * width..];
            for at in self.starts[k] + 1..self.starts[k + 1] {
                let source = (self.rows[at] - k - 1) * width;
                let l = self.values[at];
                for (v, s) in row.iter_mut().zip(&below[source..source + width]) {
                    *v -= l * s;
                }
            }
            let diagonal = self.values[self.starts[k]];
            row.iter_mut().for_each(|v| *v /= diagonal);
        }
        for (row, &unknown) in y.chunks_exact(width).zip(&self.order) {
            x[unknown * width..(unknown + 1) * width].copy_from_slice(row);
        }
    }

    /// Entries of L.
    #[cfg(test)]
    pub(crate) fn entries(&self) -> usize {
        self.values.len()
    }
}

/// The columns that row k of L meets, ascending, which is an order of elimination: from each entry
/// of the matrix up the elimination tree.
fn reach(
    entries: impl Iterator<Item = usize>,
    k: usize,
    parents: &[usize],
    seen_by: &mut [usize],
    columns: &mut Vec<usize>,
) {
    columns.clear();
    seen_by[k] = k;
    for mut i in entries {
        while seen_by[i] != k {
            seen_by[i] = k;
            columns.push(i);
            i = parents[i];
        }
    }
    columns.sort_unstable();
}

/// Nested dissection (George 1973): a set is cut at the median of its longest extent; what of one
/// half touches the other is eliminated last.
fn dissect(
    a: &SymmetricRows,
    places: &[[f64; 3]],
    mut part: Vec<usize>,
    side: &mut Vec<usize>,
    number: &mut usize,
    order: &mut Vec<usize>,
) {
    if part.len() <= SMALLEST_PART {
        order.extend(part);
        return;
    }
    let extent = |axis: usize| {
        let ends = part.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &v| {
            [low.min(places[v][axis]), high.max(places[v][axis])]
        });
        ends[1] - ends[0]
    };
    let mut axis = 0;
    for other in 1..3 {
        if extent(other) > extent(axis) {
            axis = other;
        }
    }
    part.sort_unstable_by(|&v, &w| places[v][axis].total_cmp(&places[w][axis]).then(v.cmp(&w)));
    let mut low = part;
    let high = low.split_off(low.len() / 2);
    *number += 1;
    let mark = *number;
    high.iter().for_each(|&v| side[v] = mark);
    let touches = |v: usize| a.row(v).any(|(j, _)| side[j] == mark);
    let (between, low): (Vec<usize>, Vec<usize>) = low.into_iter().partition(|&v| touches(v));
    dissect(a, places, low, side, number, order);
    dissect(a, places, high, side, number, order);
    order.extend(between);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five-point differences on a sheet, plus 1 on the diagonal of one corner.
    fn sheet(width: usize) -> (SymmetricRows, Vec<[f64; 3]>) {
        let mut a = SymmetricRows { starts: vec![0], ..SymmetricRows::default() };
        let mut places = Vec::new();
        for i in 0..width * width {
            let (x, y) = (i % width, i / width);
            let mut row = Vec::new();
            for (dx, dy) in [(0, -1), (-1, 0), (1, 0), (0, 1)] {
                let (u, v) = (x as i64 + dx, y as i64 + dy);
                if (0..width as i64).contains(&u) && (0..width as i64).contains(&v) {
                    row.push(((v as usize) * width + u as usize, -1.0));
                }
            }
            row.push((i, row.len() as f64 + if i == 0 { 1.0 } else { 0.0 }));
            row.sort_unstable_by_key(|e| e.0);
            a.columns.extend(row.iter().map(|e| e.0));
            a.values.extend(row.iter().map(|e| e.1));
            a.starts.push(a.columns.len());
            places.push([x as f64, y as f64, 0.0]);
        }
        (a, places)
    }

    #[test]
    fn planted_solutions_come_back_for_several_right_sides() {
        let (a, places) = sheet(31);
        let n = a.len();
        let factor = SparseCholesky::new(&a, &places).unwrap();
        let planted: Vec<f64> = (0..3 * n).map(|i| (0.37 * i as f64).sin()).collect();
        let mut x: Vec<f64> = (0..3 * n)
            .map(|at| a.row(at / 3).map(|(j, v)| v * planted[3 * j + at % 3]).sum())
            .collect();
        factor.solve(&mut x, 3);
        let worst = x.iter().zip(&planted).fold(0.0_f64, |w, (a, b)| w.max((a - b).abs()));
        assert!(worst < 1e-11, "{worst:e}");
        let mut order = factor.order.clone();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..n));
    }

    #[test]
    fn dissection_keeps_the_factor_sparse() {
        // n log n entries: four times the unknowns make less than six times the factor; a band's
        // factor would be eight times as large.
        let entries = |width| {
            let (a, places) = sheet(width);
            SparseCholesky::new(&a, &places).unwrap().entries()
        };
        let (small, large) = (entries(40), entries(80));
        assert!(large < 6 * small, "{small} {large}");
        assert!(large < 6400 * 40, "{large}");
    }

    #[test]
    fn matrices_that_are_not_positive_definite_are_said() {
        let (mut a, places) = sheet(9);
        a.values[0] -= 1.0;
        assert!(SparseCholesky::new(&a, &places).is_err(), "constants have no energy");
    }
}
