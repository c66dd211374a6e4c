//! Dynamic reverse correlation: which action units at which times make people give which answer.
//!
//! In each trial a person is shown random courses of action units ([`Trajectory`]) and answers with a category, and
//! perhaps an intensity. With a_t the activation of a unit in a time bin of trial t (its height at the bin's middle),
//! n_c of the person's N trials answered with category c, S_c the sum of a_t over these and ā its mean over all:
//!
//! - *difference*: S_c / n_c - (S - S_c) / (N - n_c), the mean of the trials answered with the category less that of
//!   all others: the classification image (Ahumada 2002; Murray 2011), here of units by times;
//! - *z* of a person: (S_c - n_c ā) / √(n_c (N - n_c) / (N (N - 1)) Σ (a_t - ā)²). Mean and standard deviation are
//!   exact over all orders of the person's answers; z = r √(N - 1), r being Pearson's correlation of activation and
//!   answer. The same of a unit's *presence* (0 or 1) is the statistic of Jack, Garrod, Yu, Caldara and Schyns
//!   (PNAS 109(19), 2012);
//! - *intensity*: the slope of a person's linear regression of intensity on the unit's peak amplitude, over the m trials
//!   that show the unit and were answered with the category, and z = r √(m - 1);
//! - *group*: the mean of difference, r or slope over people; t, the mean over its standard error, which describes how
//!   alike people are; and z = Σ z_p / √P over the P people who have one, of which all cells have variance 1 where
//!   answers do not depend on what is shown.
//!
//! The test: each person's answers (or the intensities of one category) are dealt anew over that person's trials; the largest |z| over all units and times
//! is noted (Westfall and Young 1993; Nichols and Holmes 2002). The corrected p of a cell is (1 + the number of draws
//! whose largest |z| reaches the cell's) / (1 + draws): in data without any dependence the probability of any p <= 0.05
//! in an image is 0.05. Images of presence, of intensity and of each person are corrected in the same way, each by
//! itself; categories are not corrected for one another. The null hypothesis is that nobody's answers depend on what is
//! shown, so that a small p says that some do; how many is told by the images of the people.

mod image;
mod permutation;
mod procedure;
#[cfg(test)]
mod tests;
mod trials;

use serde::Serialize;

use crate::numerics::largest::require_permutations;
use crate::outcome::Outcome;
use crate::refusal::Refusal;
use crate::undefined::NoEstimate;
pub(crate) use procedure::PROCEDURE;
pub use trials::{ReverseTrial, ReverseTrials};

/// How images are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReverseCorrelationOptions {
    /// Time bins.
    pub bins: usize,
    /// Duration that they divide evenly, seconds.
    pub duration_s: f64,
    /// Draws, at least 19.
    pub permutations: usize,
    /// Seed of the draws.
    pub seed: u64,
}

/// Result of [`reverse_correlation`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReverseCorrelation {
    /// Always `reverse-correlation`.
    pub test: &'static str,
    /// People.
    pub participants: usize,
    /// Trials.
    pub n: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// Draws.
    pub permutations: usize,
    /// Their seed.
    pub seed: u64,
    /// Middle of each time bin, seconds.
    pub times_s: Vec<f64>,
    /// Each category that was answered.
    pub categories: Vec<CategoryImages>,
}

/// A category's images.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CategoryImages {
    /// The category.
    pub category: String,
    /// Trials answered with it.
    pub answers: usize,
    /// People who answered so in some of their trials and not in all: who have an image.
    pub people: usize,
    /// The group's image; undefined where nobody has one.
    pub group: Outcome<GroupImage>,
    /// The image of each of these people.
    pub each: Vec<PersonImage>,
}

/// The image of a group.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupImage {
    /// Each unit.
    pub units: Vec<UnitImage>,
    /// A cell of units by times is significant where its |z| is above this.
    pub critical_z: f64,
    /// The same of presence.
    pub critical_z_presence: f64,
    /// The same of slopes of intensity; none without intensities.
    pub critical_z_intensity: Option<f64>,
    /// The face that the group has in mind: of each unit whose presence is significantly more frequent, its mean
    /// activation in each bin over the trials that show it and were answered with the category.
    pub face: Vec<UnitCourse>,
}

/// A unit in the image of a group. Lists have a value for each time bin.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnitImage {
    /// The unit.
    pub unit: String,
    /// Mean difference of activations.
    pub difference: Vec<f64>,
    /// Mean correlation.
    pub r: Vec<f64>,
    /// Mean difference over its standard error; none where people are fewer than two or do not differ.
    pub t: Vec<Option<f64>>,
    /// What is tested.
    pub z: Vec<f64>,
    /// p, corrected over units and times.
    pub p: Vec<f64>,
    /// Whether it is there at all.
    pub presence: UnitTest,
    /// Mutual information of presence and answer, bits: mean over people, less its bias (Panzeri and Treves 1996).
    pub information_bits: f64,
    /// People of whom this unit's presence is significant.
    pub people: usize,
    /// Slope of the intensity on the amplitude; none where nobody has one.
    pub intensity: Option<UnitTest>,
}

/// A number of a unit, tested over people.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct UnitTest {
    /// Presence: mean difference of shares. Intensity: mean slope, steps of intensity per whole amplitude.
    pub effect: f64,
    /// Mean correlation.
    pub r: f64,
    /// Mean effect over its standard error; none where people are fewer than two or do not differ.
    pub t: Option<f64>,
    /// What is tested.
    pub z: f64,
    /// p, corrected over units.
    pub p: f64,
}

/// The course of a unit over the time bins.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UnitCourse {
    /// The unit.
    pub unit: String,
    /// Its activation in each bin, 0 to 1.
    pub activation: Vec<f64>,
}

/// The image of one person. Its cells, units by bins, are not in the JSON of `mimique test`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PersonImage {
    /// The person.
    pub participant: String,
    /// Trials.
    pub n: usize,
    /// Trials answered with the category.
    pub answers: usize,
    /// A cell is significant where its |z| is above this.
    pub critical_z: f64,
    /// Units whose presence is significantly more frequent in trials answered with the category.
    pub units: Vec<String>,
    /// Differences of activations, units x bins.
    #[serde(skip)]
    pub difference: Vec<f64>,
    /// z of each, units x bins; 0 where activations do not vary.
    #[serde(skip)]
    pub z: Vec<f64>,
}

/// Images of every category that was answered. Refuses fewer than two categories, and fewer draws than can give
/// p <= 0.05.
pub fn reverse_correlation(
    trials: &ReverseTrials,
    options: ReverseCorrelationOptions,
) -> Result<ReverseCorrelation, Refusal> {
    trials.require_two_categories()?;
    require_permutations(options.permutations)?;
    let images = image::Images::of(trials, options);
    let draws = permutation::draws(&images, options);
    let intensities = image::Intensities::of(trials);
    let drawn_intensities =
        intensities.as_ref().map(|found| permutation::intensity_draws(found, options));
    let category = |place: usize| {
        let people: Vec<usize> = images.people_of(place).collect();
        let group = if people.is_empty() {
            Outcome::undefined(NoEstimate::NoVariance)
        } else {
            let intensity = intensities.as_ref().zip(drawn_intensities.as_ref());
            Outcome::Ok(images.group(trials, &draws, intensity, place))
        };
        CategoryImages {
            category: trials.categories[place].clone(),
            answers: trials.trials.iter().filter(|trial| trial.answer == place).count(),
            people: people.len(),
            group,
            each: images.each(trials, &draws, place),
        }
    };
    Ok(ReverseCorrelation {
        test: "reverse-correlation",
        participants: trials.people.len(),
        n: trials.trials.len(),
        dropped: trials.dropped,
        permutations: options.permutations,
        seed: options.seed,
        times_s: image::middles(options).collect(),
        categories: (0..trials.categories.len()).map(category).collect(),
    })
}
