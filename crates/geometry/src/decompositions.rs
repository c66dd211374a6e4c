//! Decompositions of small dense matrices by nalgebra, on row-major slices as the solver keeps them.

use glam::{DMat3, DVec3};
use nalgebra::{DMatrix, Matrix3, SymmetricEigen};

/// Unit eigenvectors of a symmetric 3 x 3 matrix, that of the smallest eigenvalue first.
pub fn eigenvectors(symmetric: &DMat3) -> [DVec3; 3] {
    let eigen = SymmetricEigen::new(Matrix3::from(symmetric.to_cols_array_2d()));
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    order.map(|k| {
        let v = eigen.eigenvectors.column(k);
        DVec3::new(v[0], v[1], v[2])
    })
}

/// Q and R of M = Q R by Householder's reflections; R is upper triangular.
///
/// M: `rows` x n, row-major. Returns Q^T (r x rows) and R (r x n), r the smaller of both, row-major. A
/// matrix without full rank has zeros, or rounding, on the diagonal of R.
pub fn orthogonal_triangular(m: &[f64], rows: usize, n: usize) -> (Vec<f64>, Vec<f64>) {
    let qr = DMatrix::from_row_slice(rows, n, m).qr();
    // The columns of Q one after the other are the rows of its transpose.
    (qr.q().as_slice().to_vec(), row_major(&qr.r()))
}

/// Solves A X = B by LU with partial pivoting: A n x n, B n x m, both row-major; X takes the place of B.
/// None where A is singular to working precision.
pub fn solve_linear(a: &[f64], b: &mut [f64], n: usize) -> Option<()> {
    let lu = DMatrix::from_row_slice(n, n, a).lu();
    let largest = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    // A pivot that is NaN is not above anything.
    if !lu.u().diagonal().iter().all(|pivot| pivot.abs() > largest * 1e-15) {
        return None;
    }
    let mut right = DMatrix::from_row_slice(n, b.len() / n, b);
    lu.solve_mut(&mut right).then(|| b.copy_from_slice(&row_major(&right)))
}

/// The Moore-Penrose inverse of a row-major `rows` x `n` matrix: n x rows, row-major.
///
/// Singular values below `rows` x unit round-off of the largest count as 0, so that a shape that no
/// marker sees gets weight 0.
pub fn pseudo_inverse(m: &[f64], rows: usize, n: usize) -> Vec<f64> {
    let svd = DMatrix::from_row_slice(rows, n, m).svd(true, true);
    let smallest = svd.singular_values.max() * rows as f64 * f64::EPSILON;
    // It refuses negative limits alone, and has computed both factors.
    svd.pseudo_inverse(smallest).map_or_else(|_| vec![0.0; n * rows], |inverse| row_major(&inverse))
}

fn row_major(m: &DMatrix<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers without a pattern.
    fn numbers(count: usize, seed: f64) -> Vec<f64> {
        (0..count).map(|i| (1e4 * libm::sin(seed + 1.3 * i as f64)).fract()).collect()
    }

    /// A times B, row-major, A with `inner` columns.
    fn product(a: &[f64], b: &[f64], inner: usize) -> Vec<f64> {
        let m = b.len() / inner;
        let row = |row: &[f64]| -> Vec<f64> {
            (0..m).map(|j| (0..inner).map(|k| row[k] * b[k * m + j]).sum()).collect()
        };
        a.chunks_exact(inner).flat_map(row).collect()
    }

    fn transposed(m: &[f64], n: usize) -> Vec<f64> {
        (0..n).flat_map(|j| m.iter().skip(j).step_by(n).copied()).collect()
    }

    fn assert_near(a: &[f64], b: &[f64], tolerance: f64) {
        assert_eq!(a.len(), b.len());
        for (x, y) in a.iter().zip(b) {
            assert!((x - y).abs() < tolerance, "{x} {y}");
        }
    }

    #[test]
    fn eigenvectors_diagonalise_smallest_first() {
        let (x, y) = (numbers(9, 0.4), DVec3::new(3.0, -1.0, 0.25));
        let random = DMat3::from_cols_slice(&x);
        let m = random * DMat3::from_diagonal(y) * random.transpose();
        let found = eigenvectors(&m);
        let values = found.map(|v| v.dot(m * v));
        assert!(values[0] <= values[1] && values[1] <= values[2], "{values:?}");
        for (v, value) in found.iter().zip(values) {
            assert!((v.length() - 1.0).abs() < 1e-14);
            assert!((m * *v - *v * value).length() < 1e-13);
        }
        let flat = eigenvectors(&DMat3::from_diagonal(DVec3::new(2.0, 0.0, 5.0)));
        assert_eq!(flat.map(DVec3::abs), [DVec3::Y, DVec3::X, DVec3::Z]);
    }

    #[test]
    fn a_matrix_is_split_into_orthogonal_and_triangular() {
        for (rows, n) in [(7, 4), (4, 7), (1, 1), (120, 53)] {
            let m = numbers(rows * n, 0.7);
            let (qt, r) = orthogonal_triangular(&m, rows, n);
            let rank = rows.min(n);
            assert_near(&product(&transposed(&qt, rows), &r, rank), &m, 1e-13);
            let identity: Vec<f64> =
                (0..rank * rank).map(|k| if k / rank == k % rank { 1.0 } else { 0.0 }).collect();
            assert_near(&product(&qt, &transposed(&qt, rows), rows), &identity, 1e-13);
            for (i, row) in r.chunks_exact(n).enumerate() {
                assert!(row[..i.min(n)].iter().all(|&x| x == 0.0));
            }
        }
    }

    #[test]
    fn linear_systems_are_solved_or_said_to_be_singular() {
        let (a, x) = (numbers(25, 0.2), numbers(10, 5.0));
        let mut b = product(&a, &x, 5);
        assert!(solve_linear(&a, &mut b, 5).is_some());
        assert_near(&b, &x, 1e-9);
        assert!(solve_linear(&[1.0, 2.0, 2.0, 4.0], &mut [1.0, 1.0], 2).is_none());
        assert!(solve_linear(&[f64::NAN, 2.0, 2.0, 4.0], &mut [1.0, 1.0], 2).is_none());
    }

    #[test]
    fn the_pseudo_inverse_has_the_four_properties_of_penrose() {
        for (rows, n, rank) in [(6, 6, 6), (9, 4, 4), (4, 9, 4), (9, 5, 3), (30, 12, 12)] {
            let m = product(&numbers(rows * rank, 0.3), &numbers(rank * n, 2.1), rank);
            let inverse = pseudo_inverse(&m, rows, n);
            let (left, right) = (product(&m, &inverse, n), product(&inverse, &m, rows));
            assert_near(&product(&left, &m, rows), &m, 1e-10);
            assert_near(&product(&right, &inverse, n), &inverse, 1e-10);
            assert_near(&left, &transposed(&left, rows), 1e-10);
            assert_near(&right, &transposed(&right, n), 1e-10);
        }
        // A column of zeros: its shape gets weight 0 exactly.
        let m = [1.0, 0.0, 2.0, 0.0, 3.0, 0.0];
        assert_eq!(pseudo_inverse(&m, 3, 2)[3..], [0.0; 3]);
    }
}
