//! Intervals of the threshold: by its profile, and by answers drawn from the fitted function, at the same levels or
//! through the adaptive rule that chose them.

use mimique_adaptive::{Psychometric, Track};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;

use super::likelihood::{Likelihood, Summit};
use super::{LevelCount, PsychometricOptions, checked, without_bound};
use crate::estimate::resampled::percentiles;
use crate::numerics::random::Stream;
use crate::refusal::Refusal;

/// Half of the 95 % quantile of chi-square with one degree of freedom.
const DROP: f64 = 1.920_729_410_347_062;

/// An interval by drawn answers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BootstrapInterval {
    /// The 2.5 % and 97.5 % quantiles of the threshold.
    pub level_at_half: [f64; 2],
    /// The same of m.
    pub location: [f64; 2],
    /// The same of s.
    pub scale_or_shape: [f64; 2],
    /// Draws.
    pub rounds: usize,
    /// Draws without a finite estimate: they count as thresholds beyond all levels on the side where they point, or
    /// not at all where they point to none.
    pub unbounded: usize,
}

/// The ends at which the profile of the threshold has fallen by [`DROP`]; an end that lies beyond the region that is
/// looked at is none.
pub(super) fn profile(likelihood: &Likelihood<'_>, summit: &Summit) -> [Option<f64>; 2] {
    let target = summit.height - DROP;
    let guess = likelihood.variance_of_half(summit.at).map_or(0.1, f64::sqrt);
    [-1.0, 1.0].map(|direction| {
        let bound = likelihood.bounds[0][usize::from(direction > 0.0)];
        let height = |half: f64, near: &Summit| {
            let start = [half, near.at[1], near.at[2]];
            likelihood.climb(start, true)
        };
        // Outwards in growing steps, each search from the last one's spread and lapse.
        let (mut inside, mut step) = (*summit, guess);
        let mut outside = loop {
            let half = inside.at[0] + direction * step;
            if direction * (half - bound) > 0.0 {
                return None;
            }
            let found = height(half, &inside);
            if found.height < target {
                break found;
            }
            inside = found;
            step *= 1.5;
        };
        for _ in 0..200 {
            let (near, far) = (inside.at[0], outside.at[0]);
            if (far - near).abs() <= 1e-12 * (1.0 + near.abs()) {
                break;
            }
            // Where a line between the two would meet the target, or the middle.
            let line = (inside.height - target) / (inside.height - outside.height);
            let share = line.clamp(0.05, 0.95);
            let found = height(near + share * (far - near), &inside);
            if found.height < target { outside = found } else { inside = found }
        }
        Some(likelihood.half(inside.at))
    })
}

/// Answers drawn from the fitted function at the levels and in the numbers of the data.
pub fn bootstrap(
    counts: &[LevelCount],
    options: &PsychometricOptions,
    fitted: &Psychometric,
    rounds: usize,
    seed: u64,
) -> Result<Option<BootstrapInterval>, Refusal> {
    let counts = checked(counts, options)?;
    let draw = |stream: &mut Stream| -> Vec<LevelCount> {
        let own = |own: &LevelCount| {
            let p = fitted.right(own.level);
            let correct = (0..own.n).filter(|_| stream.unit() < p).count() as u64;
            LevelCount { correct, ..*own }
        };
        counts.iter().map(own).collect()
    };
    Ok(drawn(options, rounds, seed, draw))
}

/// Answers drawn from the fitted function through the rules that chose the levels: each draw runs every track anew.
pub fn bootstrap_through(
    tracks: &[Track],
    options: &PsychometricOptions,
    fitted: &Psychometric,
    rounds: usize,
    seed: u64,
) -> Option<BootstrapInterval> {
    let draw = |stream: &mut Stream| -> Vec<LevelCount> {
        let mut counts = Vec::new();
        for track in tracks {
            let mut track = track.clone();
            while let Some(next) = track.next() {
                track.answer(stream.unit() < fitted.right(next.level));
            }
            counts.extend(track.answered().iter().map(|answered| LevelCount {
                level: answered.level,
                n: 1,
                correct: u64::from(answered.right),
            }));
        }
        counts
    };
    drawn(options, rounds, seed, draw)
}

fn drawn(
    options: &PsychometricOptions,
    rounds: usize,
    seed: u64,
    draw: impl Fn(&mut Stream) -> Vec<LevelCount> + Sync,
) -> Option<BootstrapInterval> {
    let fits: Vec<Option<([f64; 3], bool)>> = (0..rounds)
        .into_par_iter()
        .map(|round| {
            let counts = checked(&draw(&mut Stream::new(seed, round as u64)), options).ok()?;
            let likelihood = Likelihood::new(&counts, options.shape, options.guess, options.lapse);
            let summit = likelihood.highest();
            let function = likelihood.function(summit.at);
            let found = [likelihood.half(summit.at), function.location, function.spread];
            Some((found, without_bound(&likelihood, &summit).is_some()))
        })
        .collect();
    let unbounded = fits.iter().filter(|fit| fit.is_none_or(|(_, unbounded)| unbounded)).count();
    let found: Vec<[f64; 3]> = fits.into_iter().flatten().map(|(found, _)| found).collect();
    let ends = |which: usize| percentiles(found.iter().map(|own| own[which]).collect());
    Some(BootstrapInterval {
        level_at_half: ends(0)?,
        location: ends(1)?,
        scale_or_shape: ends(2)?,
        rounds,
        unbounded,
    })
}
