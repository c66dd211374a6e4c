//! Courses at one rate, and their correlation by lag.

/// Fisher's z by lag; `NaN` where there is none.
pub(super) type Curve = Vec<f64>;

/// A correlation of one has no finite z: further ones count as this, which is z = 8.
const HIGHEST_R: f64 = 0.999_999_8;
/// A course whose variance is below this stands still: what is left of it is rounding.
const STILL: f64 = 1e-10;

/// The lags at which courses are held against each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LagWindow {
    /// Rate of the courses, Hz.
    pub rate_hz: f64,
    /// The first lag, instants; below 0 where what people did comes first.
    pub first: isize,
    /// The last lag, instants.
    pub last: isize,
    /// Instants that must be there on both sides for a correlation, at least 3.
    pub least: usize,
}

impl LagWindow {
    /// Lags from and to these seconds, with so many seconds of overlap.
    pub fn of_seconds(rate_hz: f64, [first_s, last_s]: [f64; 2], least_s: f64) -> Self {
        let instants = |seconds: f64| (seconds * rate_hz).round();
        let least = instants(least_s).max(3.0) as usize;
        Self { rate_hz, first: instants(first_s) as isize, last: instants(last_s) as isize, least }
    }

    /// How many lags there are.
    pub(super) fn lags(&self) -> usize {
        (self.last - self.first + 1).max(0) as usize
    }

    /// The lag at a place, seconds.
    pub(super) fn lag_s(&self, place: usize) -> f64 {
        (self.first + place as isize) as f64 / self.rate_hz
    }
}

/// A course at `rate_hz` from 0 s on, `instants` long, of samples at any times in ascending order (seconds, value; none
/// where nothing was measured): linear between two samples that follow each other within `longest_gap_s`, else a gap.
///
/// ```
/// let seen = [(0.0, Some(0.0)), (0.2, Some(1.0)), (0.3, None), (0.4, Some(0.0))];
/// let course = mimique_stats::resampled_course(&seen, 10.0, 5, 0.25);
/// assert_eq!(course[..3], [0.0, 0.5, 1.0]);
/// assert!(course[3].is_nan() && course[4] == 0.0);
/// ```
pub fn resampled_course(
    samples: &[(f64, Option<f64>)],
    rate_hz: f64,
    instants: usize,
    longest_gap_s: f64,
) -> Vec<f64> {
    let mut next = 0;
    let at = |instant: usize| {
        let time = instant as f64 / rate_hz;
        // Clocks are told in thousandths of a millisecond.
        const SAME_S: f64 = 1e-6;
        while next < samples.len() && samples[next].0 < time - SAME_S {
            next += 1;
        }
        let (after_s, after) = *samples.get(next)?;
        if after_s <= time + SAME_S {
            return after;
        }
        let (before_s, before) = *samples.get(next.checked_sub(1)?)?;
        let (before, after) = (before?, after?);
        let gap = after_s - before_s;
        (gap <= longest_gap_s).then(|| before + (after - before) * (time - before_s) / gap)
    };
    (0..instants).map(at).map(|value| value.unwrap_or(f64::NAN)).collect()
}

/// The curve of a play; none where no lag has a correlation.
pub(super) fn curve(shown: &[Vec<f64>], track: &[Vec<f64>], window: &LagWindow) -> Option<Curve> {
    let of = |lag: isize| {
        let found =
            shown.iter().zip(track).filter_map(|(x, y)| correlation(x, y, lag, window.least));
        let (sum, count) = found.fold((0.0, 0.0), |(sum, count), r| {
            (sum + libm::atanh(r.clamp(-HIGHEST_R, HIGHEST_R)), count + 1.0)
        });
        if count > 0.0 { sum / count } else { f64::NAN }
    };
    let curve: Curve = (window.first..=window.last).map(of).collect();
    curve.iter().any(|z| z.is_finite()).then_some(curve)
}

/// Pearson's correlation of x(t) and y(t + lag); none where too few instants have both, or one stands still.
fn correlation(x: &[f64], y: &[f64], lag: isize, least: usize) -> Option<f64> {
    let (from_x, from_y) = (lag.min(0).unsigned_abs(), lag.max(0).unsigned_abs());
    let pairs = x.get(from_x..)?.iter().zip(y.get(from_y..)?);
    let both = || pairs.clone().filter(|(x, y)| x.is_finite() && y.is_finite());
    let (mut n, mut sum_x, mut sum_y) = (0.0, 0.0, 0.0);
    for (x, y) in both() {
        n += 1.0;
        sum_x += x;
        sum_y += y;
    }
    if (n as usize) < least {
        return None;
    }
    let (mean_x, mean_y) = (sum_x / n, sum_y / n);
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for (x, y) in both() {
        let (x, y) = (x - mean_x, y - mean_y);
        xx += x * x;
        yy += y * y;
        xy += x * y;
    }
    (xx.min(yy) / n > STILL).then(|| xy / (xx * yy).sqrt())
}

/// The mean of curves at each lag, over those that have a value there.
pub(super) fn mean_curve<'c>(curves: impl Iterator<Item = &'c Curve>, lags: usize) -> Curve {
    let mut sums = vec![(0.0, 0.0); lags];
    for curve in curves {
        for ((sum, count), z) in sums.iter_mut().zip(curve).filter(|(_, z)| z.is_finite()) {
            *sum += z;
            *count += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| if count > 0.0 { sum / count } else { f64::NAN }).collect()
}

/// Place and value of the highest point; none of a curve without any.
pub(super) fn highest(curve: &[f64]) -> Option<(usize, f64)> {
    let points = curve.iter().copied().enumerate().filter(|(_, z)| z.is_finite());
    points.max_by(|a, b| a.1.total_cmp(&b.1))
}
