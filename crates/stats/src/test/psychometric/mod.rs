//! Psychometric functions by maximum likelihood: threshold, spread, lapse, with intervals.
//!
//! P(right) = γ + (1 - γ - λ) F(level); the guess γ is known, the lapse λ fixed, or free from 0 to 0.2 with the
//! prior Beta(1, 10) (Wichmann and Hill 2001). The threshold is the level where F = 1/2. Slopes from levels that
//! an adaptive rule chose are biased upwards (Kaernbach 2001); thresholds hardly.

mod interval;
mod likelihood;
mod procedure;

use mimique_adaptive::{Psychometric, Shape};
use serde::Serialize;

use crate::outcome::Outcome;
use crate::refusal::{Refusal, Unfit};
use crate::undefined::NoEstimate;
pub use interval::{BootstrapInterval, bootstrap, bootstrap_through};
use likelihood::{Likelihood, Summit};
pub(crate) use procedure::PROCEDURE;

/// Levels that a function needs at least.
const LEVELS_NEEDED: usize = 3;

/// Answers at a level.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LevelCount {
    /// The level.
    pub level: f64,
    /// Answers.
    pub n: u64,
    /// Right ones.
    pub correct: u64,
}

impl LevelCount {
    /// Log probability of the answers, without the number of their orders.
    fn log_likelihood(&self, p: f64) -> f64 {
        let part = |count: u64, ln_p: f64| if count == 0 { 0.0 } else { count as f64 * ln_p };
        part(self.correct, libm::log(p)) + part(self.n - self.correct, libm::log1p(-p))
    }
}

/// The lapse of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Lapse {
    /// Held.
    Fixed(f64),
    /// From 0 to 0.2, with the prior Beta(1, 10).
    Free,
}

/// What is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PsychometricOptions {
    /// The form of F.
    pub shape: Shape,
    /// The share of right answers by chance.
    pub guess: f64,
    /// The lapse.
    pub lapse: Lapse,
}

/// Where the threshold lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ThresholdPlace {
    /// Within the levels.
    Within,
    /// Below the lowest one.
    Below,
    /// Above the highest one.
    Above,
}

/// A fitted psychometric function.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PsychometricFit {
    /// The form of F.
    pub function: &'static str,
    /// γ.
    pub guess: f64,
    /// m.
    pub location: f64,
    /// s; of Weibull the slope.
    pub scale_or_shape: f64,
    /// λ.
    pub lapse_estimate: f64,
    /// The threshold: the level where F = 1/2.
    pub level_at_half: f64,
    /// Its standard error from the information; none where that is singular.
    pub se_level_at_half: Option<f64>,
    /// Where it lies among the levels.
    pub place: ThresholdPlace,
    /// Log likelihood, without the binomial coefficients.
    pub loglik: f64,
    /// Log likelihood and log prior of a free lapse.
    pub objective: f64,
    /// Against a share of its own for every level.
    pub deviance: f64,
    /// Levels less parameters.
    pub df: usize,
    /// Profile interval of the threshold at 95 %; an end is none where the answers do not bound it.
    pub profile_95: [Option<f64>; 2],
}

impl PsychometricFit {
    /// The function.
    pub fn psychometric(&self) -> Psychometric {
        Psychometric {
            shape: Shape::from_name(self.function).unwrap_or(Shape::Normal),
            location: self.location,
            spread: self.scale_or_shape,
            guess: self.guess,
            lapse: self.lapse_estimate,
        }
    }
}

/// Sorted levels, those alike joined. Refuses levels that are no numbers, more right answers than answers, fewer
/// than three levels, and for Weibull levels below 0.
fn checked(
    counts: &[LevelCount],
    options: &PsychometricOptions,
) -> Result<Vec<LevelCount>, Refusal> {
    let mut sorted: Vec<LevelCount> = counts.iter().copied().filter(|own| own.n > 0).collect();
    if let Some((row, own)) =
        counts.iter().enumerate().find(|(_, own)| !own.level.is_finite() || own.correct > own.n)
    {
        let LevelCount { level, n, correct } = *own;
        return Err(Unfit::CountsOfLevel { row: row + 1, level, n, correct }.into());
    }
    sorted.sort_by(|one, other| one.level.total_cmp(&other.level));
    sorted.dedup_by(|next, kept| {
        let same = next.level == kept.level;
        if same {
            kept.n += next.n;
            kept.correct += next.correct;
        }
        same
    });
    let levels = sorted.len();
    if levels < LEVELS_NEEDED {
        return Err(Unfit::TooFewStimulusLevels { levels, needed: LEVELS_NEEDED }.into());
    }
    if options.shape == Shape::Weibull && sorted[0].level < 0.0 {
        return Err(Unfit::LevelNotPositive { level: sorted[0].level }.into());
    }
    let lapse = if let Lapse::Fixed(lapse) = options.lapse { lapse } else { 0.0 };
    let inside = |share: f64| (0.0..1.0).contains(&share);
    if !inside(options.guess) || !inside(lapse) || options.guess + lapse >= 1.0 {
        return Err(Unfit::GuessAndLapse { guess: options.guess, lapse }.into());
    }
    Ok(sorted)
}

/// Fits a psychometric function. Undefined where the answers leave threshold or spread without bound: they are the
/// same at all levels, or step from one share to the other between two levels.
pub fn psychometric(
    counts: &[LevelCount],
    options: &PsychometricOptions,
) -> Result<Outcome<PsychometricFit>, Refusal> {
    let counts = checked(counts, options)?;
    let likelihood = Likelihood::new(&counts, options.shape, options.guess, options.lapse);
    let summit = likelihood.highest();
    if let Some(why) = without_bound(&likelihood, &summit) {
        return Ok(Outcome::undefined(why));
    }
    Ok(Outcome::Ok(fit_at(&likelihood, &summit)))
}

/// Why a maximum at a bound is none; that of lapse is one.
fn without_bound(likelihood: &Likelihood<'_>, summit: &Summit) -> Option<NoEstimate> {
    let near = |i: usize, bound: f64| (summit.at[i] - bound).abs() <= 1e-6 * (1.0 + bound.abs());
    let [[lowest, highest], [narrowest, widest], _] = likelihood.bounds;
    let steep = if likelihood.shape == Shape::Weibull { widest } else { narrowest };
    let shallow = if likelihood.shape == Shape::Weibull { narrowest } else { widest };
    if near(1, steep) {
        let half = likelihood.half(summit.at);
        let below = likelihood.counts.iter().rev().find(|own| own.level <= half);
        let above = likelihood.counts.iter().find(|own| own.level >= half);
        let [low, high] = [below, above].map(|own| own.map_or(half, |own| own.level));
        return Some(NoEstimate::StepBetweenLevels { low, high });
    }
    (near(0, lowest) || near(0, highest) || near(1, shallow)).then_some(NoEstimate::NoRise)
}

fn fit_at(likelihood: &Likelihood<'_>, summit: &Summit) -> PsychometricFit {
    let counts = likelihood.counts;
    let function = likelihood.function(summit.at);
    let loglik = summit.height - likelihood.ln_prior(summit.at[2]);
    let saturated: f64 =
        counts.iter().map(|own| own.log_likelihood(own.correct as f64 / own.n as f64)).sum();
    let half = likelihood.half(summit.at);
    let variance = likelihood.variance_of_half(summit.at);
    // Of a logarithm: the level's own by the delta method.
    let scale = if likelihood.shape == Shape::Weibull { half } else { 1.0 };
    let parameters = if likelihood.lapse == Lapse::Free { 3 } else { 2 };
    PsychometricFit {
        function: likelihood.shape.name(),
        guess: likelihood.guess,
        location: function.location,
        scale_or_shape: function.spread,
        lapse_estimate: function.lapse,
        level_at_half: half,
        se_level_at_half: variance.map(|variance| scale * variance.sqrt()),
        place: if half < counts[0].level {
            ThresholdPlace::Below
        } else if half > counts[counts.len() - 1].level {
            ThresholdPlace::Above
        } else {
            ThresholdPlace::Within
        },
        loglik,
        objective: summit.height,
        deviance: 2.0 * (saturated - loglik),
        df: counts.len().saturating_sub(parameters),
        profile_95: interval::profile(likelihood, summit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers that step between two levels, where threshold and spread have no information: SciPy 1.17.1 (L-BFGS-B,
    /// gradient 1e-11) finds the lapse 1/16 and this height.
    #[test]
    fn the_lapse_of_a_step_is_at_its_maximum() {
        let counts = [(3, 2), (4, 1), (5, 5), (6, 5), (7, 6), (4, 4), (1, 1)];
        let counts = counts.into_iter().enumerate();
        let counts: Vec<LevelCount> = counts
            .map(|(place, (n, correct))| LevelCount {
                level: -8.5 + place as f64 / 2.0,
                n,
                correct,
            })
            .collect();
        let options =
            PsychometricOptions { shape: Shape::Logistic, guess: 0.5, lapse: Lapse::Free };
        let likelihood = Likelihood::new(&counts, options.shape, options.guess, options.lapse);
        let summit = likelihood.highest();
        let scipy = -11.752_516_651_8 + 9.0 * f64::ln_1p(-0.0625);
        assert!((summit.height - scipy).abs() < 1e-6, "{}, SciPy has {scipy}", summit.height);
        assert!((summit.at[2] - 0.0625).abs() < 1e-4, "{:?}", summit.at);
    }
}
