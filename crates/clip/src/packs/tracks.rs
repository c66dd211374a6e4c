//! Columns of numbers over time, in a pack: integers in steps, stored as how far each lies from what
//! the frames before it promise, at the length that its frequency deserves.

use mimique_avatar::pack::{
    IntegerReader, IntegerWriter, Integers, Model, PackError, PackReader, PackWriter,
};

/// Guesses from the last four values, the latest first: factors in sixths. A guess at rest, along the
/// last step, along a line through the last three or four, and between.
const GUESSES: [[i64; 4]; 7] = [
    [6, 0, 0, 0],
    [12, -6, 0, 0],
    [18, -18, 6, 0],
    [9, -3, 0, 0],
    [8, 2, -4, 0],
    [6, 3, 0, -3],
    [3, 2, 1, 0],
];
/// Sizes of what is left that are told apart: two each power of two.
const SIZES: usize = 48;
/// Most numbers for each byte of the pack: what a damaged count promises beyond is not made room for.
const MOST_A_BYTE: usize = 4096;

/// What has been learnt of the columns so far.
struct Models {
    shape: Model,
    runs: Model,
    left: Model,
}

impl Models {
    fn new() -> Self {
        Self { shape: Model::new(1), runs: Model::new(2), left: Model::new(SIZES) }
    }
}

/// Writes frames x columns, frame-major, NaN where a value is missing; a step for each column.
pub(crate) fn tracks_to(w: &mut PackWriter, values: &[f64], steps: &[f64]) {
    let columns = steps.len();
    let frames = values.len() / columns.max(1);
    w.varint(frames as u32);
    let mut coder = IntegerWriter::new();
    let mut models = Models::new();
    for (column, step) in steps.iter().enumerate() {
        let track = || (0..frames).map(move |f| values[f * columns + column]);
        let mut runs = Vec::new();
        let (mut length, mut present) = (0i32, false);
        for value in track() {
            if value.is_finite() != present {
                runs.push(length);
                (length, present) = (0, !present);
            }
            length += 1;
        }
        runs.push(length);
        coder.integer(&mut models.runs, 0, runs.len() as i32);
        runs.into_iter().for_each(|run| _ = coder.integer(&mut models.runs, 1, run));

        let mut seen: Vec<i32> =
            track().filter(|v| v.is_finite()).map(|v| (v / step).round() as i32).collect();
        let cost = |guess: &usize| -> u64 {
            let mut past = Past::new(*guess);
            seen.iter().map(|&q| u64::from(past.step(|promised| q.wrapping_sub(promised)).1)).sum()
        };
        let guess = (0..GUESSES.len()).min_by_key(cost).unwrap_or(0);
        coder.integer(&mut models.shape, 0, guess as i32);
        column_through(&mut coder, &mut models, guess, &mut seen);
    }
    let coded = coder.into_bytes();
    w.varint(coded.len() as u32);
    w.raw(&coded);
}

/// How far a column typically is, for reasons of its own, from where the frames before it promise: the
/// median over the columns of the median distance, in the unit of the values; 0 where there are too
/// few frames to tell.
pub(crate) fn noise(values: &[f64], columns: usize) -> f64 {
    let frames = values.len() / columns.max(1);
    let of_column = |column: usize| {
        let track: Vec<f64> = (0..frames)
            .map(|f| values[f * columns + column])
            .filter(|value| value.is_finite())
            .collect();
        let of_guess = |factors: &[i64; 4]| {
            let off = track.windows(5).map(|w| {
                let promised = w[..4].iter().rev().zip(factors).map(|(v, f)| v * *f as f64);
                (w[4] - promised.sum::<f64>() / 6.0).abs()
            });
            median(off.collect())
        };
        GUESSES.iter().filter_map(of_guess).min_by(f64::total_cmp)
    };
    median((0..columns).filter_map(of_column).collect()).unwrap_or(0.0)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Reads what [`tracks_to`] wrote.
pub(crate) fn tracks_from(r: &mut PackReader<'_>, steps: &[f64]) -> Result<Vec<f64>, PackError> {
    let columns = steps.len();
    let frames = r.varint()? as usize;
    let most = r.left().saturating_mul(MOST_A_BYTE);
    if columns == 0 || frames.saturating_mul(columns) > most {
        return r.refuse(format!("{frames} frames of {columns} columns"));
    }
    let length = r.count(1)?;
    let mut coder = IntegerReader::new(r.raw(length)?);
    let mut models = Models::new();
    let mut values = vec![f64::NAN; frames * columns];
    for (column, step) in steps.iter().enumerate() {
        let runs = coder.integer(&mut models.runs, 0, 0);
        let mut at = 0usize;
        let mut present = Vec::new();
        for i in 0..runs.max(0) {
            let run = coder.integer(&mut models.runs, 1, 0);
            let end = usize::try_from(run).ok().and_then(|run| at.checked_add(run));
            let Some(end) = end.filter(|end| *end <= frames && !coder.spent()) else {
                return r.refuse(format!("a run of {run} from frame {at} of {frames}"));
            };
            if i % 2 == 1 {
                present.extend(at..end);
            }
            at = end;
        }
        let guess = coder.integer(&mut models.shape, 0, 0);
        let Some(guess) = usize::try_from(guess).ok().filter(|g| *g < GUESSES.len()) else {
            return r.refuse(format!("guess {guess} of {}", GUESSES.len()));
        };
        let mut seen = vec![0i32; present.len()];
        column_through(&mut coder, &mut models, guess, &mut seen);
        if coder.spent() {
            return r.refuse(format!("column {column} ends after {length} bytes"));
        }
        for (frame, q) in present.into_iter().zip(seen) {
            values[frame * columns + column] = f64::from(q) * step;
        }
    }
    Ok(values)
}

/// Writes the values of a column, or fills them in.
fn column_through(coder: &mut impl Integers, models: &mut Models, guess: usize, seen: &mut [i32]) {
    let mut past = Past::new(guess);
    for q in seen {
        if coder.spent() {
            return;
        }
        let size = past.size();
        let step = |promised: i32| coder.integer(&mut models.left, size, q.wrapping_sub(promised));
        *q = past.step(step).0;
    }
}

/// The last values of a column, and how far the guesses lay off of late.
struct Past {
    factors: [i64; 4],
    last: Option<[i32; 4]>,
    /// Mean of what was left of late, in 256ths.
    mean: u64,
}

impl Past {
    fn new(guess: usize) -> Self {
        Self { factors: GUESSES[guess], last: None, mean: 256 << 6 }
    }

    /// Which of [`SIZES`] is to be expected.
    fn size(&self) -> usize {
        let bits = 64 - self.mean.leading_zeros();
        let half = (self.mean << 1 >> bits.max(1)) & 1;
        (2 * bits as usize + half as usize).min(SIZES - 1)
    }

    /// Guesses the next value, has what is left of it written or read, and learns it. Answers the
    /// value and about how many bits it took.
    fn step(&mut self, left: impl FnOnce(i32) -> i32) -> (i32, u32) {
        let promised = self.last.map_or(0, |last| {
            let sum: i64 = last.iter().zip(self.factors).map(|(v, f)| i64::from(*v) * f).sum();
            (sum + 3).div_euclid(6) as i32
        });
        let left = left(promised);
        let value = promised.wrapping_add(left);
        let size = u64::from(left.unsigned_abs());
        // The first value is a place, no error: it says nothing of those to come.
        if let Some([a, b, c, _]) = self.last {
            self.mean = (15 * self.mean + 256 * size) / 16;
            self.last = Some([value, a, b, c]);
        } else {
            self.last = Some([value; 4]);
        }
        (value, 64 - (4 * size + 1).leading_zeros())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through(values: &[f64], steps: &[f64]) -> (usize, Vec<f64>) {
        let mut w = PackWriter::new();
        tracks_to(&mut w, values, steps);
        let bytes = w.into_bytes();
        let mut r = PackReader::new("MMTK", &bytes);
        let back = tracks_from(&mut r, steps).expect("what was written is read");
        r.finish().expect("all of it");
        (bytes.len(), back)
    }

    #[test]
    fn columns_come_back_to_half_a_step_with_their_gaps() {
        let steps = [1e-5, 1e-4, 0.25];
        let mut values = Vec::new();
        for f in 0..300 {
            let t = f64::from(f) / 60.0;
            let gap = (40..55).contains(&f) || f == 299;
            values.push(if gap { f64::NAN } else { 1.2 + 0.01 * (5.0 * t).sin() });
            values.push((0.3 * t).min(0.7));
            values.push(if f % 97 == 0 { -4e8 } else { 4e8 });
        }
        let (_, back) = through(&values, &steps);
        for (i, (a, b)) in values.iter().zip(&back).enumerate() {
            let step = steps[i % 3];
            assert!((a.is_nan() && b.is_nan()) || (a - b).abs() <= 0.5001 * step, "{i}: {a} {b}");
        }
    }

    #[test]
    fn rest_and_lines_cost_next_to_nothing() {
        let line: Vec<f64> = (0..2000).map(|f| 0.001 * f64::from(f % 1000)).collect();
        let (bytes, _) = through(&line, &[1e-4]);
        assert!(bytes < 200, "{bytes}");
        let (bytes, _) = through(&vec![0.0; 240 * 51], &[1e-4; 51]);
        assert!(bytes < 160, "{bytes}");
    }
}
