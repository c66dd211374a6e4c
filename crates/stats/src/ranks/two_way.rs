//! Sums of squares of a two-way layout from its cell counts and cell sums alone.

/// Counts and sums of a response a cell, row after row. Sums are of deviations from the grand mean.
#[derive(Debug, Clone)]
pub(crate) struct Cells {
    pub rows: usize,
    pub columns: usize,
    pub counts: Vec<u64>,
    pub sums: Vec<f64>,
}

impl Cells {
    /// Cells without an observation.
    pub(crate) fn empty(&self) -> usize {
        self.counts.iter().filter(|&&count| count == 0).count()
    }

    fn transposed(&self) -> Self {
        let place = |i: usize| (i % self.rows) * self.columns + i / self.rows;
        let length = self.counts.len();
        Self {
            rows: self.columns,
            columns: self.rows,
            counts: (0..length).map(|i| self.counts[place(i)]).collect(),
            sums: (0..length).map(|i| self.sums[place(i)]).collect(),
        }
    }

    /// Sum of squares between rows, ignoring columns.
    fn between_rows(&self) -> f64 {
        (0..self.rows)
            .map(|row| {
                let range = row * self.columns..(row + 1) * self.columns;
                let count: u64 = self.counts[range.clone()].iter().sum();
                let sum: f64 = self.sums[range].iter().sum();
                sum * sum / count as f64
            })
            .sum()
    }

    /// Sum of squares between columns adjusted for rows, and its degrees of freedom. Eliminating the
    /// rows leaves C t = q with C = diag(n_j) - N' diag(1/n_i) N (Searle 1987, 4.4); then SS = t'q.
    fn columns_after_rows(&self) -> (f64, usize) {
        let (a, b) = (self.rows, self.columns);
        let mut matrix = vec![0.0; b * b];
        let mut right = vec![0.0; b];
        for row in 0..a {
            let counts = &self.counts[row * b..(row + 1) * b];
            let sums = &self.sums[row * b..(row + 1) * b];
            let n = counts.iter().sum::<u64>() as f64;
            let mean = sums.iter().sum::<f64>() / n;
            for j in 0..b {
                let count = counts[j] as f64;
                matrix[j * b + j] += count;
                right[j] += sums[j] - count * mean;
                for (l, &other) in counts.iter().enumerate() {
                    matrix[j * b + l] -= count * other as f64 / n;
                }
            }
        }
        quadratic_form_of_solution(matrix, right)
    }

    /// Yates's weighted squares of means: are the unweighted row means equal? Needs every cell.
    fn weighted_squares_of_row_means(&self) -> f64 {
        let b = self.columns as f64;
        let (mut weights, mut means) = (Vec::new(), Vec::new());
        for row in 0..self.rows {
            let range = row * self.columns..(row + 1) * self.columns;
            let (mut mean, mut variance) = (0.0, 0.0);
            for (&count, &sum) in self.counts[range.clone()].iter().zip(&self.sums[range]) {
                mean += sum / count as f64 / b;
                variance += 1.0 / (count as f64 * b * b);
            }
            weights.push(1.0 / variance);
            means.push(mean);
        }
        let all: f64 = weights.iter().sum();
        let centre = weights.iter().zip(&means).map(|(w, m)| w * m).sum::<f64>() / all;
        weights.iter().zip(&means).map(|(w, m)| w * (m - centre).powi(2)).sum()
    }
}

/// t'q for a solution of C t = q, C symmetric and positive semidefinite, and the rank of C. Gaussian
/// elimination with the largest remaining diagonal as pivot.
fn quadratic_form_of_solution(mut matrix: Vec<f64>, mut right: Vec<f64>) -> (f64, usize) {
    let size = right.len();
    let scale = (0..size).map(|i| matrix[i * size + i]).fold(0.0, f64::max);
    let mut left: Vec<usize> = (0..size).collect();
    let (mut form, mut rank) = (0.0, 0);
    while let Some(at) = (0..left.len()).max_by(|&i, &j| {
        let diagonal = |i: usize| matrix[left[i] * size + left[i]];
        diagonal(i).total_cmp(&diagonal(j))
    }) {
        let pivot = left.swap_remove(at);
        let diagonal = matrix[pivot * size + pivot];
        // Counts are integers, so what should vanish is rounding of the largest of them.
        if diagonal <= scale * 1e-10 {
            break;
        }
        rank += 1;
        form += right[pivot] * right[pivot] / diagonal;
        for &row in &left {
            let factor = matrix[row * size + pivot] / diagonal;
            if factor != 0.0 {
                for &column in &left {
                    matrix[row * size + column] -= factor * matrix[pivot * size + column];
                }
                right[row] -= factor * right[pivot];
            }
        }
    }
    (form, rank)
}

/// All sums of squares that the three types need.
#[derive(Debug, Clone)]
pub(crate) struct TwoWaySums {
    pub total: f64,
    rows: f64,
    rows_after_columns: f64,
    columns_after_rows: f64,
    interaction: f64,
    between_cells: f64,
    unweighted: Option<[f64; 2]>,
    df_rows: usize,
    df_columns: usize,
    df_cells: usize,
}

impl TwoWaySums {
    /// Every row and column must have an observation.
    pub(crate) fn of(cells: &Cells, total: f64) -> Self {
        let transposed = cells.transposed();
        let between_cells: f64 = cells
            .counts
            .iter()
            .zip(&cells.sums)
            .filter(|(count, _)| **count > 0)
            .map(|(&count, &sum)| sum * sum / count as f64)
            .sum();
        // Differences below the rounding of their terms are zero.
        let settled = |ss: f64| if ss < total * 1e-13 { 0.0 } else { ss };
        let rows = cells.between_rows();
        let (columns_after_rows, df_columns) = cells.columns_after_rows();
        let (rows_after_columns, _) = transposed.columns_after_rows();
        let complete = cells.empty() == 0;
        Self {
            total,
            rows: settled(rows),
            rows_after_columns: settled(rows_after_columns),
            columns_after_rows: settled(columns_after_rows),
            interaction: settled(between_cells - rows - columns_after_rows),
            between_cells,
            unweighted: complete.then(|| {
                [
                    settled(cells.weighted_squares_of_row_means()),
                    settled(transposed.weighted_squares_of_row_means()),
                ]
            }),
            df_rows: cells.rows - 1,
            df_columns,
            df_cells: cells.counts.len() - cells.empty() - 1,
        }
    }

    pub(crate) fn type1(&self) -> [f64; 3] {
        [self.rows, self.columns_after_rows, self.interaction]
    }

    pub(crate) fn type2(&self) -> [f64; 3] {
        [self.rows_after_columns, self.columns_after_rows, self.interaction]
    }

    pub(crate) fn type3(&self) -> Option<[f64; 3]> {
        self.unweighted.map(|[rows, columns]| [rows, columns, self.interaction])
    }

    pub(crate) fn residual(&self) -> f64 {
        let residual = self.total - self.between_cells;
        if residual < self.total * 1e-13 { 0.0 } else { residual }
    }

    /// Degrees of freedom: factor 1, factor 2, interaction, residual.
    pub(crate) fn df(&self, n: usize) -> [usize; 4] {
        [
            self.df_rows,
            self.df_columns,
            self.df_cells - self.df_rows - self.df_columns,
            n - 1 - self.df_cells,
        ]
    }
}
