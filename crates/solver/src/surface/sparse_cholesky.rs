//! Sparse symmetric systems that live on a surface: faer's Cholesky, in the order of approximate
//! minimum degree (Amestoy, Davis and Duff 1996).
//!
//! Its simplicial form takes one number after the other, on one thread, without vectors and without
//! fused multiply-adds; the supernodal form would choose its kernels by the processor. So every
//! processor gets the same bits.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// A symmetric sparse matrix, every row in full, columns ascending.
#[derive(Debug, Clone, Default)]
pub(crate) struct SymmetricRows {
    /// Row i is `starts[i]..starts[i + 1]` of `columns` and `values`.
    pub(crate) starts: Vec<usize>,
    pub(crate) columns: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

/// L of P A P^T = L L^T.
#[derive(Debug)]
pub(crate) struct SparseCholesky {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

/// Why there is no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoFactor {
    /// The pivot of this unknown is not positive: the matrix is not positive definite.
    Pivot(usize),
    /// Memory does not suffice.
    Memory,
}

/// A pivot below this part of its diagonal entry is rounding.
const VANISHED_PIVOT: f64 = 1e-13;

impl SymmetricRows {
    pub(crate) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    pub(crate) fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        (self.starts[i]..self.starts[i + 1]).map(|k| (self.columns[k], self.values[k]))
    }
}

impl SparseCholesky {
    /// The factor.
    ///
    /// # Errors
    /// [`NoFactor`] for a matrix that is not positive definite, or too large.
    pub(crate) fn new(a: &SymmetricRows) -> Result<SparseCholesky, NoFactor> {
        let n = a.len();
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &a.starts, None, &a.columns);
        let symbolic = factorize_symbolic_cholesky(
            pattern,
            Side::Upper,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
                ..CholeskySymbolicParams::default()
            },
        )
        .map_err(|_| NoFactor::Memory)?;
        let needed = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(needed).map_err(|_| NoFactor::Memory)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let factored = symbolic.factorize_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, &a.values),
            Side::Upper,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        // Unknown at each place of the elimination.
        let unknown = |place: usize| symbolic.perm().map_or(place, |p| p.arrays().0[place]);
        if let Err(LltError::NonPositivePivot { index }) = factored {
            // Counted from 1.
            return Err(NoFactor::Pivot(unknown(index.saturating_sub(1))));
        }
        if let SymbolicCholeskyRaw::Simplicial(columns) = symbolic.raw() {
            // The diagonal is the first entry of each column.
            for (place, &start) in columns.col_ptr()[..n].iter().enumerate() {
                let i = unknown(place);
                let own = a.row(i).find(|(j, _)| *j == i).map_or(0.0, |(_, x)| x);
                let pivot = values[start] * values[start];
                if !(pivot > VANISHED_PIVOT * own && pivot.is_finite()) {
                    return Err(NoFactor::Pivot(i));
                }
            }
        }
        Ok(SparseCholesky { symbolic, values })
    }

    /// X := A^-1 X, n x `width`, row-major.
    ///
    /// # Errors
    /// [`NoFactor::Memory`].
    pub(crate) fn solve(&self, x: &mut [f64], width: usize) -> Result<(), NoFactor> {
        let needed = self.symbolic.solve_in_place_scratch::<f64>(width, Par::Seq);
        let mut memory = MemBuffer::try_new(needed).map_err(|_| NoFactor::Memory)?;
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_row_major_slice_mut(x, self.symbolic.nrows(), width),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        Ok(())
    }

    /// Entries of L.
    #[cfg(test)]
    pub(crate) fn entries(&self) -> usize {
        self.values.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five-point differences on a sheet, plus 1 on the diagonal of one corner.
    fn sheet(width: usize) -> SymmetricRows {
        let mut a = SymmetricRows { starts: vec![0], ..SymmetricRows::default() };
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
        }
        a
    }

    #[test]
    fn planted_solutions_come_back_for_several_right_sides() {
        let a = sheet(31);
        let n = a.len();
        let factor = SparseCholesky::new(&a).unwrap();
        let planted: Vec<f64> = (0..3 * n).map(|i| (0.37 * i as f64).sin()).collect();
        let mut x: Vec<f64> = (0..3 * n)
            .map(|at| a.row(at / 3).map(|(j, v)| v * planted[3 * j + at % 3]).sum())
            .collect();
        factor.solve(&mut x, 3).unwrap();
        let worst = x.iter().zip(&planted).fold(0.0_f64, |w, (a, b)| w.max((a - b).abs()));
        assert!(worst < 1e-11, "{worst:e}");
    }

    #[test]
    fn the_order_keeps_the_factor_sparse() {
        // n log n entries: four times the unknowns make less than six times the factor; a band's
        // factor would be eight times as large.
        let entries = |width| {
            let a = sheet(width);
            SparseCholesky::new(&a).unwrap().entries()
        };
        let (small, large) = (entries(40), entries(80));
        assert!(large < 6 * small, "{small} {large}");
        assert!(large < 6400 * 40, "{large}");
    }

    #[test]
    fn matrices_that_are_not_positive_definite_are_said() {
        let mut a = sheet(9);
        a.values[0] -= 1.0;
        let said = SparseCholesky::new(&a).unwrap_err();
        assert!(matches!(said, NoFactor::Pivot(i) if i < 81), "constants have no energy: {said:?}");
    }
}
