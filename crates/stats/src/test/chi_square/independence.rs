//! A contingency table against the counts that independence of its rows and columns lets expect.

use crate::table::contingency::Contingency;

/// The model of independence, fitted to a table.
pub(super) struct Independence<'t> {
    table: &'t Contingency,
    row_sums: Vec<f64>,
    column_sums: Vec<f64>,
    /// Observations.
    pub total: f64,
}

impl<'t> Independence<'t> {
    /// The model of a table's margins.
    pub(super) fn of(table: &'t Contingency) -> Self {
        let counts = &table.counts;
        let n: u64 = counts.iter().flatten().sum();
        Self {
            table,
            row_sums: counts.iter().map(|row| row.iter().sum::<u64>() as f64).collect(),
            column_sums: (0..table.columns.len())
                .map(|j| counts.iter().map(|row| row[j]).sum::<u64>() as f64)
                .collect(),
            total: n as f64,
        }
    }

    /// Degrees of freedom.
    pub(super) fn df(&self) -> usize {
        (self.table.rows.len() - 1) * (self.table.columns.len() - 1)
    }

    /// The count expected in a cell.
    pub(super) fn expected(&self, i: usize, j: usize) -> f64 {
        self.row_sums[i] * self.column_sums[j] / self.total
    }

    fn observed(&self, i: usize, j: usize) -> f64 {
        self.table.counts[i][j] as f64
    }

    fn cells(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (rows, columns) = (self.table.rows.len(), self.table.columns.len());
        (0..rows).flat_map(move |i| (0..columns).map(move |j| (i, j)))
    }

    /// The smallest expected count.
    pub(super) fn min_expected(&self) -> f64 {
        self.cells().map(|(i, j)| self.expected(i, j)).fold(f64::INFINITY, f64::min)
    }

    /// How many expected counts are below a limit.
    pub(super) fn cells_below(&self, limit: f64) -> usize {
        self.cells().filter(|&(i, j)| self.expected(i, j) < limit).count()
    }

    /// Pearson's statistic, each |O - E| less by `shrink`.
    pub(super) fn statistic(&self, shrink: f64) -> f64 {
        self.cells()
            .map(|(i, j)| {
                let e = self.expected(i, j);
                ((self.observed(i, j) - e).abs() - shrink).max(0.0).powi(2) / e
            })
            .sum()
    }

    /// Yates's correction of a 2x2 table, where all |O - E| are equal.
    pub(super) fn yates(&self) -> f64 {
        (self.observed(0, 0) - self.expected(0, 0)).abs().min(0.5)
    }

    /// 2 sum O ln(O/E).
    pub(super) fn likelihood_ratio(&self) -> f64 {
        2.0 * self
            .cells()
            .filter(|&(i, j)| self.observed(i, j) > 0.0)
            .map(|(i, j)| self.observed(i, j) * (self.observed(i, j) / self.expected(i, j)).ln())
            .sum::<f64>()
    }

    /// (O - E) / sqrt(E (1 - row share) (1 - column share)).
    pub(super) fn standardised_residual(&self, i: usize, j: usize) -> f64 {
        let e = self.expected(i, j);
        let (row_share, column_share) =
            (self.row_sums[i] / self.total, self.column_sums[j] / self.total);
        let spread = e * (1.0 - row_share) * (1.0 - column_share);
        (self.observed(i, j) - e) / spread.sqrt()
    }

    /// Cramer's V of chi-square / n.
    pub(super) fn cramers_v(&self, phi_squared: f64) -> f64 {
        let smaller = (self.table.rows.len().min(self.table.columns.len()) - 1) as f64;
        (phi_squared / smaller).sqrt()
    }

    /// Its correction for bias (Bergsma 2013); none where it does not exist.
    pub(super) fn bias_corrected_v(&self, phi_squared: f64) -> Option<f64> {
        let n = self.total;
        if n < 2.0 {
            return None;
        }
        let [r1, c1] =
            [&self.table.rows, &self.table.columns].map(|levels| (levels.len() - 1) as f64);
        let corrected = (phi_squared - r1 * c1 / (n - 1.0)).max(0.0);
        let smaller = (r1 - r1 * r1 / (n - 1.0)).min(c1 - c1 * c1 / (n - 1.0));
        (smaller > 0.0).then(|| (corrected / smaller).sqrt())
    }
}
