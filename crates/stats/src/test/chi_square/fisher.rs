//! Fisher's exact test of a table of two rows and two columns.

/// Fisher's exact test, two-sided: the tables with the same margins that are no more probable.
pub(super) fn fisher_two_sided(counts: [[u64; 2]; 2]) -> f64 {
    let [[a, b], [c, d]] = counts;
    let (row, other, column) = (a + b, c + d, a + c);
    let low = column.saturating_sub(other);
    let high = row.min(column);
    // Probabilities relative to that of the observed table, by the ratio of neighbours.
    let ratio = |x: u64| {
        // P(x + 1) / P(x)
        (row - x) as f64 * (column - x) as f64 / ((x + 1) as f64 * (other + x + 1 - column) as f64)
    };
    // Equal probabilities must count as equal.
    let limit = 1.0 + 1e-7;
    let (mut all, mut extreme) = (1.0, 1.0);
    let mut add = |relative: f64| {
        all += relative;
        if relative <= limit {
            extreme += relative;
        }
    };
    let mut relative = 1.0;
    for x in a..high {
        relative *= ratio(x);
        add(relative);
    }
    relative = 1.0;
    for x in (low..a).rev() {
        relative /= ratio(x);
        add(relative);
    }
    (extreme / all).min(1.0)
}
