//! What a frame or a stretch of a take looks like, in numbers (thesis 4.6).

use std::ops::Range;

use mimique_stats::quantile_sorted;

use crate::{AnnotateError, Rows, Take};

/// Mean of the rows of some frames; zeros of none.
pub fn mean(rows: &Rows, frames: impl IntoIterator<Item = usize>) -> Vec<f64> {
    let mut sum = vec![0.0; rows.width()];
    let mut count = 0.0f64;
    for frame in frames {
        sum.iter_mut().zip(rows.row(frame)).for_each(|(s, v)| *s += v);
        count += 1.0;
    }
    sum.iter_mut().for_each(|s| *s /= count.max(1.0));
    sum
}

/// Change of each column a second: central differences, one-sided at the ends.
pub fn velocity(rows: &Rows, rate_hz: f64) -> Result<Rows, AnnotateError> {
    let frames = rows.len();
    let mut values = Vec::with_capacity(rows.values().len());
    for f in 0..frames {
        let (before, after) = (f.saturating_sub(1), (f + 1).min(frames - 1));
        let per_second = rate_hz / (after - before).max(1) as f64;
        let pairs = rows.row(after).iter().zip(rows.row(before));
        values.extend(pairs.map(|(a, b)| (a - b) * per_second));
    }
    Rows::new(values, rows.width())
}

/// Distance of every frame from a face: sum over the columns of |w - face|.
pub fn level(rows: &Rows, face: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| row.iter().zip(face).map(|(w, n)| (w - n).abs()).sum()).collect()
}

/// The frames of a stretch in which the face is held: those whose root of energy is at most halfway
/// from the stretch's lowest to the higher of its two ends.
pub fn calm_frames(root: &[f64], stretch: Range<usize>) -> Vec<usize> {
    let Some(own) = root.get(stretch.clone()).filter(|own| !own.is_empty()) else {
        return Vec::new();
    };
    let lowest = own.iter().copied().fold(f64::INFINITY, f64::min);
    let limit = lowest + (own[0].max(own[own.len() - 1]) - lowest) / 2.0;
    stretch.filter(|&f| root[f] <= limit).collect()
}

/// A stretch of a take in numbers, a number a shape each.
#[derive(Debug, Clone, PartialEq)]
pub struct StretchFeatures {
    /// Mean of the weights (eq. 4.6).
    pub mean: Vec<f64>,
    /// Their median.
    pub median: Vec<f64>,
    /// Their standard deviation, divisor n.
    pub deviation: Vec<f64>,
    /// Mean of |velocity| of the smoothed weights, a second.
    pub speed: Vec<f64>,
    /// The calm frames.
    pub calm: Vec<usize>,
    /// Mean of the weights over the calm frames.
    pub calm_mean: Vec<f64>,
}

impl StretchFeatures {
    /// Measure a stretch: `velocity` of the smoothed weights, `root` of the energy that the
    /// stretches were found by.
    ///
    /// # Errors
    /// [`AnnotateError::Interval`] when the stretch is empty or not inside the take.
    pub fn of(
        take: &Take,
        velocity: &Rows,
        root: &[f64],
        stretch: Range<usize>,
    ) -> Result<Self, AnnotateError> {
        let frames = take.frames().min(velocity.len()).min(root.len());
        if stretch.is_empty() || stretch.end > frames {
            let Range { start: first, end } = stretch;
            return Err(AnnotateError::Interval { first, end, frames });
        }
        let weights = &take.weights;
        let mean = mean(weights, stretch.clone());
        let count = stretch.len() as f64;
        let mut median = Vec::with_capacity(mean.len());
        let mut deviation = Vec::with_capacity(mean.len());
        let mut speed = Vec::with_capacity(mean.len());
        let mut own = Vec::with_capacity(stretch.len());
        for (column, mean) in mean.iter().enumerate() {
            own.clear();
            own.extend(stretch.clone().map(|f| weights.row(f)[column]));
            let squares: f64 = own.iter().map(|v| (v - mean) * (v - mean)).sum();
            deviation.push((squares / count).sqrt());
            own.sort_unstable_by(f64::total_cmp);
            median.push(quantile_sorted(&own, 0.5));
            let way: f64 = stretch.clone().map(|f| velocity.row(f)[column].abs()).sum();
            speed.push(way / count);
        }
        let calm = calm_frames(root, stretch);
        let calm_mean = self::mean(weights, calm.iter().copied());
        Ok(Self { mean, median, deviation, speed, calm, calm_mean })
    }
}

/// Every n-th of some frames, so that about `rate_hz` of the take's `take_hz` a second are left.
pub fn thinned(frames: &[usize], take_hz: f64, rate_hz: f64) -> Vec<usize> {
    let step = (take_hz / rate_hz).round().max(1.0) as usize;
    frames.iter().copied().step_by(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planted_ramp_has_its_mean_its_slope_and_its_spread() {
        let values: Vec<f64> = (0..11).flat_map(|f| [0.1 * f64::from(f), 2.0]).collect();
        let take = Take::new(values, 2, 50.0).unwrap();
        let speed = velocity(&take.weights, 50.0).unwrap();
        let root: Vec<f64> = (0..11).map(|f: i32| f64::from((f - 5).abs())).collect();
        let found = StretchFeatures::of(&take, &speed, &root, 0..11).unwrap();
        assert!((found.mean[0] - 0.5).abs() < 1e-12 && found.mean[1] == 2.0);
        assert!((found.median[0] - 0.5).abs() < 1e-12);
        assert!((found.deviation[0] - 0.1f64 * 10f64.sqrt()).abs() < 1e-12);
        assert!((found.speed[0] - 5.0).abs() < 1e-9 && found.speed[1] == 0.0);
        assert_eq!(found.calm, [3, 4, 5, 6, 7]);
        assert_eq!(level(&take.weights, &[0.0, 1.0])[10], 2.0);
        assert_eq!(thinned(&[0, 1, 2, 3, 4, 5], 60.0, 30.0), [0, 2, 4]);
        let beyond = StretchFeatures::of(&take, &speed, &root, 5..12).unwrap_err();
        assert_eq!(beyond, AnnotateError::Interval { first: 5, end: 12, frames: 11 });
    }
}
