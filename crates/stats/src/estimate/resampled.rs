//! Intervals by drawing units with replacement: participants, clips, performances.

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::numerics::random::Stream;
use crate::summary::describe::quantile_sorted;

/// The percentile interval at 95 % of a statistic of `units` units, over `rounds` draws of as many of them with
/// replacement (Efron and Tibshirani 1993, chapter 13). `statistic` is given the drawn units, each by its number from
/// 0, in the order in which they were drawn; draws of which it has none do not count. None where none counts.
///
/// Each draw has a random stream of its own, so that neither threads nor their number matter.
///
/// ```
/// let heights = [4.0, 5.0, 7.0, 8.0, 11.0, 6.0, 5.5, 7.5];
/// let mean = |drawn: &[usize]| Some(drawn.iter().map(|&i| heights[i]).sum::<f64>() / drawn.len() as f64);
/// let [low, high] = mimique_stats::resampled_interval(heights.len(), 2000, 1, mean).unwrap();
/// assert!(5.0 < low && low < 6.75 && 6.75 < high && high < 9.0);
/// ```
pub fn resampled_interval(
    units: usize,
    rounds: usize,
    seed: u64,
    statistic: impl Fn(&[usize]) -> Option<f64> + Sync,
) -> Option<[f64; 2]> {
    let draw = |round: usize| {
        let mut stream = Stream::new(seed, round as u64);
        let drawn: Vec<usize> = (0..units).map(|_| stream.below(units)).collect();
        statistic(&drawn)
    };
    percentiles((0..rounds).into_par_iter().filter_map(draw).collect())
}

/// The 2.5 % and 97.5 % quantiles; none of no values.
pub(crate) fn percentiles(mut values: Vec<f64>) -> Option<[f64; 2]> {
    values.sort_unstable_by(f64::total_cmp);
    (!values.is_empty()).then(|| [quantile_sorted(&values, 0.025), quantile_sorted(&values, 0.975)])
}
