//! A table laid out for distances: eight rows side by side, so that a processor computes eight distances
//! at a time and none needs a sum across a vector.

use mimique_solver::widest;

use crate::Rows;

/// Rows side by side.
const SIDE: usize = 8;
/// Rows that are asked together.
const ASKED: usize = 4;

/// A table, column by column in tiles of eight rows; the last tile is filled with its last row.
pub(crate) struct Tiles {
    values: Vec<f64>,
    width: usize,
    rows: usize,
}

impl Tiles {
    pub(crate) fn of(rows: &Rows) -> Self {
        let (count, width) = (rows.len(), rows.width());
        let mut values = Vec::with_capacity(count.next_multiple_of(SIDE) * width);
        for first in (0..count).step_by(SIDE) {
            for column in 0..width {
                let lane = |side: usize| rows.row((first + side).min(count - 1))[column];
                values.extend((0..SIDE).map(lane));
            }
        }
        Self { values, width, rows: count }
    }

    /// Rows of the table.
    pub(crate) fn len(&self) -> usize {
        self.rows
    }

    /// How many rows can be asked at once.
    pub(crate) const fn most() -> usize {
        ASKED
    }

    /// The squared distance of each asked row (at most [`Tiles::most`], one after the other) from each row
    /// of the table: those of the first, then those of the second. Squares are added column by column.
    pub(crate) fn distances(&self, asked: &[f64]) -> Vec<f64> {
        let count = asked.len() / self.width;
        let stride = self.rows.next_multiple_of(SIDE);
        // Fewer than a block: the last one again.
        let last = &asked[(count - 1) * self.width..];
        let mut block = asked.to_vec();
        (count..ASKED).for_each(|_| block.extend_from_slice(last));
        let mut out = vec![0.0; ASKED * stride];
        block_of_distances(&self.values, self.width, &block, &mut out);
        let rows = out.chunks_exact(stride).take(count);
        rows.flat_map(|row| row[..self.rows].iter().copied()).collect()
    }
}

widest! {
    ["avx512f", "avx"]
    /// The squared distances of [`ASKED`] rows from all rows of the tiles.
    fn block_of_distances(tiles: &[f64], width: usize, asked: &[f64], out: &mut [f64]) {
        let stride = out.len() / ASKED;
        for (place, tile) in tiles.chunks_exact(SIDE * width).enumerate() {
            let mut sums = [[0.0; SIDE]; ASKED];
            for (column, own) in tile.as_chunks::<SIDE>().0.iter().enumerate() {
                for a in 0..ASKED {
                    let x = asked[a * width + column];
                    for side in 0..SIDE {
                        let way = own[side] - x;
                        sums[a][side] += way * way;
                    }
                }
            }
            for (a, sums) in sums.iter().enumerate() {
                let from = a * stride + place * SIDE;
                out[from..from + SIDE].copy_from_slice(sums);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    #[test]
    fn distances_are_those_of_the_rows_whatever_their_number() {
        let mut random = Random::new(6);
        for (rows, asked) in [(1, 1), (7, 4), (8, 3), (21, 2)] {
            let mut table = |rows: usize| {
                Rows::new((0..rows * 5).map(|_| random.normal()).collect(), 5).unwrap()
            };
            let (own, asked) = (table(rows), table(asked));
            let found = Tiles::of(&own).distances(asked.values());
            assert_eq!(found.len(), rows * asked.len());
            for (a, found) in asked.iter().zip(found.chunks_exact(rows)) {
                for (row, found) in own.iter().zip(found) {
                    let square = |(x, y): (&f64, &f64)| (x - y) * (x - y);
                    let expected = row.iter().zip(a).map(square).fold(0.0, |sum, s| sum + s);
                    assert_eq!(expected.to_bits(), found.to_bits());
                }
            }
        }
    }
}
