//! Whether a likelihood of choices has a finite maximum, decided exactly.
//!
//! Each observed answer says that a linear function of the parameters, r·θ, is large. Along a direction d with
//! r·d >= 0 for all of them, and > 0 for one, the likelihood rises for ever: the answers are separated
//! (Albert and Anderson 1984; Konis 2007). By Stiemke's lemma there is no such direction exactly if weights
//! λ >= 1 exist with Σ λ r = 0. That is the first phase of a simplex, which is done in whole numbers
//! (Edmonds' pivots, Bland's rule), so that there is no tolerance.

/// What the directions of recession are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Recession {
    /// None: the maximum is finite.
    None,
    /// A direction along which no answer becomes less likely and at least one more likely.
    Along(Vec<i128>),
    /// The numbers grew beyond 128 bits; never seen.
    Unknown,
}

/// A direction d with r·d >= 0 for all rows and r·d > 0 for at least one.
pub(crate) fn recession(rows: &[Vec<i64>], parameters: usize) -> Recession {
    let mut distinct: Vec<&Vec<i64>> = rows.iter().filter(|r| r.iter().any(|x| *x != 0)).collect();
    distinct.sort_unstable();
    distinct.dedup();
    match Tableau::of(&distinct, parameters).and_then(Tableau::first_phase) {
        None => Recession::Unknown,
        Some(None) => Recession::None,
        Some(Some(direction)) => Recession::Along(direction),
    }
}

/// The rank of rows of whole numbers; none where the numbers grew beyond 128 bits.
pub(crate) fn rank(rows: &[Vec<i64>], parameters: usize) -> Option<usize> {
    let mut rows: Vec<Vec<i128>> =
        rows.iter().map(|row| row.iter().map(|x| i128::from(*x)).collect()).collect();
    rows.sort_unstable();
    rows.dedup();
    let (mut rank, mut denominator) = (0, 1);
    for column in 0..parameters {
        let Some(found) = (rank..rows.len()).find(|&row| rows[row][column] != 0) else { continue };
        rows.swap(rank, found);
        let (above, below) = rows.split_at_mut(rank + 1);
        let pivot = &above[rank];
        for row in below {
            eliminate(row, pivot, column, denominator)?;
        }
        denominator = pivot[column];
        rank += 1;
    }
    Some(rank)
}

/// row := (row x pivot's element - own element x pivot row) / denominator, exact in whole numbers.
fn eliminate(row: &mut [i128], pivot: &[i128], column: usize, denominator: i128) -> Option<()> {
    let (element, own) = (pivot[column], row[column]);
    for (x, p) in row.iter_mut().zip(pivot) {
        let scaled = x.checked_mul(element)?.checked_sub(own.checked_mul(*p)?)?;
        // Few matrices of choices ever have another denominator.
        *x = if denominator == 1 { scaled } else { scaled / denominator };
    }
    Some(())
}

/// Equations S Rᵀ μ + a = S b with b = -Rᵀ 1, all of b made positive by the signs S, and the sum of a to be
/// brought to 0.
struct Tableau {
    /// Parameters' rows, then the objective's: coefficients of μ, of a, right side.
    rows: Vec<Vec<i128>>,
    signs: Vec<i128>,
    basis: Vec<usize>,
    columns: usize,
    denominator: i128,
}

impl Tableau {
    fn of(distinct: &[&Vec<i64>], parameters: usize) -> Option<Self> {
        let columns = distinct.len();
        let mut rows = Vec::with_capacity(parameters + 1);
        let mut signs = Vec::with_capacity(parameters);
        for parameter in 0..parameters {
            let own = distinct.iter().map(|row| i128::from(row[parameter]));
            let right = -own.clone().sum::<i128>();
            let sign = if right < 0 { -1 } else { 1 };
            let mut row: Vec<i128> = own.map(|x| sign * x).collect();
            row.extend((0..parameters).map(|other| i128::from(other == parameter)));
            row.push(sign * right);
            rows.push(row);
            signs.push(sign);
        }
        // The reduced costs: those of a are 0 at the start, those of μ minus the sum of their column.
        let mut objective = vec![0; columns + parameters + 1];
        for row in &rows {
            for (place, x) in row.iter().enumerate() {
                if place < columns || place == columns + parameters {
                    objective[place] -= x;
                }
            }
        }
        rows.push(objective);
        let basis = (columns..columns + parameters).collect();
        Some(Self { rows, signs, basis, columns, denominator: 1 })
    }

    /// None inside where the sum of a reaches 0, else the direction that the prices name; none outside
    /// where numbers grew too large.
    fn first_phase(mut self) -> Option<Option<Vec<i128>>> {
        let parameters = self.basis.len();
        let last = self.columns + parameters;
        while let Some(entering) = (0..self.columns).find(|&c| self.rows[parameters][c] < 0) {
            // The smallest ratio, of several the first variable (Bland 1977).
            let mut leaving: Option<usize> = None;
            for row in (0..parameters).filter(|&row| self.rows[row][entering] > 0) {
                let smaller = match leaving {
                    None => true,
                    Some(best) => {
                        let own = self.rows[row][last].checked_mul(self.rows[best][entering])?;
                        let other = self.rows[best][last].checked_mul(self.rows[row][entering])?;
                        own < other || (own == other && self.basis[row] < self.basis[best])
                    }
                };
                if smaller {
                    leaving = Some(row);
                }
            }
            // The sum of a is bounded from below, so that some row always limits the entering variable.
            self.pivot(leaving?, entering)?;
        }
        if self.rows[parameters][last] == 0 {
            return Some(None);
        }
        // Reduced cost of a_i is 1 - y_i (in units of the denominator); the direction is -S y.
        let direction = (0..parameters)
            .map(|i| self.signs[i] * (self.rows[parameters][self.columns + i] - self.denominator))
            .collect();
        Some(Some(direction))
    }

    fn pivot(&mut self, row: usize, column: usize) -> Option<()> {
        let pivot = std::mem::take(&mut self.rows[row]);
        let denominator = self.denominator;
        for (place, other) in self.rows.iter_mut().enumerate() {
            if place != row {
                eliminate(other, &pivot, column, denominator)?;
            }
        }
        self.denominator = pivot[column];
        self.rows[row] = pivot;
        self.basis[row] = column;
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    fn holds(rows: &[Vec<i64>], direction: &[i128]) -> bool {
        let along = |row: &Vec<i64>| {
            row.iter().zip(direction).map(|(x, d)| i128::from(*x) * d).sum::<i128>()
        };
        rows.iter().all(|row| along(row) >= 0) && rows.iter().any(|row| along(row) > 0)
    }

    #[test]
    fn a_half_plane_recedes_and_a_whole_one_does_not() {
        let half = [vec![1, 0], vec![0, 1], vec![1, 1]];
        let Recession::Along(direction) = recession(&half, 2) else { panic!("separated") };
        assert!(holds(&half, &direction));
        // Three directions whose cone is the plane.
        assert_eq!(recession(&[vec![1, 0], vec![0, 1], vec![-1, -1]], 2), Recession::None);
        // Both ways of one line: quasi-separated in the other.
        let line = [vec![1, 0], vec![-1, 0], vec![0, 2]];
        let Recession::Along(direction) = recession(&line, 2) else { panic!("separated") };
        assert!(holds(&line, &direction));
        assert_eq!(recession(&[vec![1, -1], vec![-1, 1]], 2), Recession::None);
        assert_eq!(recession(&[], 3), Recession::None);
        assert_eq!(recession(&[vec![0, 0]], 2), Recession::None);
    }

    #[test]
    fn the_answer_is_that_of_a_search_over_all_directions() {
        // With coefficients of -1, 0, 1 in three dimensions the extreme rays are cross products of two rows.
        let mut random = Random::new(5);
        let (mut with, mut without) = (0, 0);
        for round in 0..3000 {
            let count = 2 + round % 7;
            let rows: Vec<Vec<i64>> = (0..count)
                .map(|_| (0..3).map(|_| (random.uniform() * 3.0) as i64 - 1).collect())
                .collect();
            let mut candidates: Vec<[i128; 3]> = Vec::new();
            for a in -4..=4i128 {
                for b in -4..=4i128 {
                    candidates.extend((-4..=4i128).map(|c| [a, b, c]));
                }
            }
            let expected = candidates.iter().any(|direction| holds(&rows, direction));
            match recession(&rows, 3) {
                Recession::Along(direction) => {
                    assert!(expected && holds(&rows, &direction), "{rows:?} {direction:?}");
                    with += 1;
                }
                Recession::None => {
                    assert!(!expected, "{rows:?}");
                    without += 1;
                }
                Recession::Unknown => panic!("{rows:?}"),
            }
        }
        assert!(with > 300 && without > 300, "{with} {without}");
    }

    #[test]
    fn ranks_are_exact() {
        let rows = [vec![2, 4, 6], vec![1, 2, 3], vec![0, 1, 1], vec![1, 3, 4]];
        assert_eq!(rank(&rows, 3), Some(2));
        assert_eq!(rank(&[vec![3, 0], vec![0, 5]], 2), Some(2));
        assert_eq!(rank(&[], 2), Some(0));
        // In floating point this determinant, 1, is easily 0.
        let near = [vec![1_000_000_007, 1_000_000_006], vec![1_000_000_008, 1_000_000_007]];
        assert_eq!(rank(&near, 2), Some(2));
    }
}
