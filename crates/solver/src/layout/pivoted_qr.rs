//! Sensors by QR with pivoting (Manohar, Brunton, Kutz & Brunton, "Data-Driven Sparse Sensor Placement",
//! 2018): the place with the largest rows of the modes is taken, what it tells is projected out of all, and
//! so on.

use crate::linear_algebra::dense::{axpy, dot};

/// A row is told by those before it where less than this share of its square is left: rounding.
const TOLD: f64 = 1e-24;

/// One coordinate of a unit, and what was left of its row when it was chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PivotedRow {
    /// The place of the candidate.
    pub candidate: usize,
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// The diagonal of R, without sign.
    pub diagonal: f64,
}

/// QR with pivoting over rows of modes, whole units at a time.
#[derive(Debug, Clone)]
pub struct PivotedQr {
    width: usize,
    /// The rows as given, and what is left of them.
    whole: Vec<Vec<f64>>,
    left: Vec<Vec<f64>>,
    chosen: Vec<bool>,
    /// Modes that rows were projected out of since the rows were whole.
    used: usize,
}

impl PivotedQr {
    /// Of units that are chosen together: the rows of each (3 for a vertex, 6 for a pair), `modes` numbers a
    /// row.
    pub fn new(units: Vec<Vec<f64>>, modes: usize) -> Self {
        let chosen = vec![false; units.len()];
        Self { width: modes, left: units.clone(), whole: units, chosen, used: 0 }
    }

    /// The unit whose rows have the largest sum of squares left, among those that `may` be taken (ties: the
    /// earlier one). When fewer modes are left than a unit has rows, the rows of those not chosen are whole
    /// again first. None where nothing may be taken.
    pub fn largest(&mut self, may: &dyn Fn(usize) -> bool) -> Option<usize> {
        let rows = |unit: &Vec<f64>| unit.len() / self.width.max(1);
        let least = (0..self.whole.len()).filter(|&u| !self.chosen[u] && may(u));
        let least = least.map(|u| rows(&self.whole[u])).min()?;
        if self.used + least > self.width && self.used > 0 {
            self.used = 0;
            self.left.clone_from(&self.whole);
        }
        let sum = |u: usize| dot(&self.left[u], &self.left[u]);
        (0..self.whole.len())
            .filter(|&u| !self.chosen[u] && may(u))
            .filter(|&u| self.used + rows(&self.whole[u]) <= self.width || self.used == 0)
            .map(|u| (u, sum(u)))
            .reduce(|best, next| if next.1 > best.1 { next } else { best })
            .map(|(u, _)| u)
    }

    /// Takes a unit: its rows, in order, are projected out of all (modified Gram-Schmidt).
    pub fn take(&mut self, unit: usize) {
        self.chosen[unit] = true;
        for row in 0..self.whole[unit].len() / self.width.max(1) {
            self.project_out(unit, row);
        }
    }

    /// The largest rows one by one (Businger & Golub 1965) until `count` are taken or nothing is left.
    pub fn by_row(mut self, count: usize) -> Vec<PivotedRow> {
        let mut found: Vec<PivotedRow> = Vec::new();
        while found.len() < count.min(self.width) {
            let mut best: Option<(f64, usize, usize)> = None;
            for (u, rows) in self.left.iter().enumerate() {
                for (axis, row) in rows.chunks_exact(self.width).enumerate() {
                    let taken = found.iter().any(|f| (f.candidate, f.axis) == (u, axis));
                    let square = dot(row, row);
                    if !taken && best.is_none_or(|(most, ..)| square > most) {
                        best = Some((square, u, axis));
                    }
                }
            }
            let Some((square, candidate, axis)) = best.filter(|(square, ..)| *square > 0.0) else {
                break;
            };
            found.push(PivotedRow { candidate, axis, diagonal: square.sqrt() });
            self.project_out(candidate, axis);
        }
        found
    }

    /// Projects what is left of one row out of all rows.
    fn project_out(&mut self, unit: usize, row: usize) {
        let n = self.width;
        let direction = self.left[unit][row * n..(row + 1) * n].to_vec();
        let whole = &self.whole[unit][row * n..(row + 1) * n];
        let square = dot(&direction, &direction);
        self.used += 1;
        if !(square > TOLD * dot(whole, whole)) {
            return;
        }
        for rows in &mut self.left {
            for other in rows.chunks_exact_mut(n) {
                let share = dot(other, &direction) / square;
                axpy(-share, &direction, other);
            }
        }
    }
}
