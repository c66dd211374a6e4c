//! Intervals by resampling whole takes, or persons (Efron and Tibshirani 1993, section 13.3).

use mimique_stats::{Stream, quantile_sorted};

use super::{Counts, Score};
use crate::AnnotateError;
use crate::error::above_zero;

/// Fewest takes (or persons) whose resamples say something.
pub const FEWEST: usize = 5;

/// Resamples: for each, which of the `takes` are drawn, with replacement, as many as there are. One
/// ChaCha stream a resample.
///
/// # Errors
/// [`AnnotateError::Count`] for fewer than [`FEWEST`].
pub fn draws(takes: usize, resamples: usize, seed: u64) -> Result<Vec<Vec<usize>>, AnnotateError> {
    if takes < FEWEST {
        let what = "takes to resample";
        return Err(AnnotateError::Count { what, found: takes, expected: FEWEST });
    }
    let draw = |number: usize| {
        let mut stream = Stream::new(seed, number as u64);
        (0..takes).map(|_| stream.below(takes)).collect()
    };
    Ok((0..resamples).map(draw).collect())
}

/// The percentile intervals of scores at a level (0.95), all of them over the same resamples, each of
/// those in which it is defined; none where it is in none. `takes` are the counts of each take, or of
/// each person.
///
/// # Errors
/// [`AnnotateError::Setting`] for a level outside 0 to 1, [`AnnotateError::Label`] for a draw that
/// names no take.
pub fn intervals(
    takes: &[Counts],
    draws: &[Vec<usize>],
    level: f64,
    scores: &[Score],
) -> Result<Vec<Option<[f64; 2]>>, AnnotateError> {
    above_zero("level", level)?;
    above_zero("1 - level", 1.0 - level)?;
    let mut values = vec![Vec::with_capacity(draws.len()); scores.len()];
    for (row, draw) in draws.iter().enumerate() {
        if let Some(&label) = draw.iter().find(|&&take| take >= takes.len()) {
            return Err(AnnotateError::Label { row, label, labels: takes.len() });
        }
        let Some(pooled) = Counts::pooled(draw.iter().map(|&take| &takes[take])) else { continue };
        let pooled = pooled.scores();
        for (values, score) in values.iter_mut().zip(scores) {
            values.extend(score.of(&pooled));
        }
    }
    let tail = (1.0 - level) / 2.0;
    let of = |mut values: Vec<f64>| {
        values.sort_unstable_by(f64::total_cmp);
        let ends = [tail, 1.0 - tail].map(|share| quantile_sorted(&values, share));
        (!values.is_empty()).then_some(ends)
    };
    Ok(values.into_iter().map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_the_seeds_and_of_few_takes_none() {
        let found = draws(6, 100, 7).unwrap();
        assert_eq!(found, draws(6, 100, 7).unwrap());
        assert_ne!(found, draws(6, 100, 8).unwrap());
        assert!(found.iter().all(|d| d.len() == 6 && d.iter().all(|&t| t < 6)));
        assert_eq!(found[..50], draws(6, 50, 7).unwrap());
        assert!(draws(4, 10, 7).is_err());
    }
}
