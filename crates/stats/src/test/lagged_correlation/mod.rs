//! Lagged cross-correlation of what people saw with what their faces did, over many plays of clips whose courses are known.
//!
//! In each play a person sees a clip whose K courses x_k(t) are known, and is measured by K courses y_k(t) on the same
//! clock; instants at which the person was not measured are gaps. For a lag L:
//!
//! - *of a shape*: r_k(L), Pearson's correlation of x_k(t) and y_k(t + L) over the instants at which both are there. A
//!   positive lag says that the person follows. A course that stands still in these instants has no correlation;
//! - *of a play*: z(L), the mean of Fisher's atanh r_k(L) over the shapes that have one (Boker, Xu, Rotondo and King,
//!   Psychological Methods 7(3), 2002, have the lagged correlation in windows; here the window is the clip);
//! - *of a person*: the mean of z(L) over the plays; *of the group*: the mean over people, with a 95 % interval by t over
//!   people at each lag by itself. Told is r = tanh z.
//!
//! The test asks whether the highest value of the group's curve over all lags is higher than without coupling. Surrogates
//! tell how high it is then (Moulder, Boker, Ramseyer and Tschacher, Psychological Methods 23(4), 2018; their participant
//! shuffling and their data sliding):
//!
//! - [`Surrogates::OtherClips`]: what a person did is held against the clips that the same person saw, dealt anew over
//!   that person's plays. Every course keeps its own smoothness, and what a person does in every play alike, whatever is
//!   shown, is in the surrogates as well. Where what people do does not depend on which clip they see, the observed deal
//!   is one among equals, so that p is uniform;
//! - [`Surrogates::Shifted`]: what a person did is turned round in time against its own clip, by an offset of its own in
//!   each play. For people who have seen one clip alone. A course that is turned round has a step where its ends meet,
//!   and other parts of it overlap, so that p is uniform only about.
//!
//! The corrected p is (1 + surrogates whose highest value reaches the observed one) / (1 + surrogates): the maximum is
//! taken over lags in the surrogates, too, and nothing else is to be corrected for (Westfall and Young 1993; Nichols and
//! Holmes 2002).

mod curves;
mod surrogates;
#[cfg(test)]
mod tests;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;

use crate::distributions::tail::t_quantile_upper;
use crate::numerics::largest::require_permutations;
use crate::refusal::Refusal;
use crate::summary::describe::{median, quantile_sorted};
use curves::{Curve, curve, highest, mean_curve};
pub use curves::{LagWindow, resampled_course};
use surrogates::surrogate_curves;

/// Courses by shape, each with a value per instant; a gap is `NaN`. A shape without a course has an empty list.
pub type Courses = Vec<Vec<f64>>;

/// What people saw and what they did, all courses at one rate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Couplings {
    /// Names of the people.
    pub people: Vec<String>,
    /// The courses of each clip.
    pub clips: Vec<Courses>,
    /// Each play.
    pub plays: Vec<CoupledPlay>,
}

/// One play of a clip.
#[derive(Debug, Clone, PartialEq)]
pub struct CoupledPlay {
    /// Place in [`Couplings::people`].
    pub person: usize,
    /// Place in [`Couplings::clips`].
    pub clip: usize,
    /// What the person did, by the clips' shapes, from the first frame on.
    pub track: Courses,
}

/// How it is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaggedCorrelationOptions {
    /// The lags, and the rate of all courses.
    pub window: LagWindow,
    /// Surrogates, at least 19.
    pub surrogates: usize,
    /// What they are.
    pub kind: Surrogates,
    /// Seed of their draws.
    pub seed: u64,
}

/// What is held against what where there is no coupling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Surrogates {
    /// The clips that a person saw, dealt anew over the person's plays.
    OtherClips,
    /// The person's course turned round in time.
    Shifted,
}

/// Result of [`lagged_correlation`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LaggedCorrelation {
    /// Always `lagged-correlation`.
    pub test: &'static str,
    /// People who have a curve.
    pub participants: usize,
    /// Plays that have one.
    pub n: usize,
    /// Plays without: too few instants, or nothing that moved.
    pub dropped: usize,
    /// Lags, seconds; positive where the person follows.
    pub lags_s: Vec<f64>,
    /// Mean correlation at each lag.
    pub r: Vec<f64>,
    /// Its 95 % interval by t over people; none of one person.
    pub interval_95: Option<Vec<[f64; 2]>>,
    /// The middle 95 % of the surrogates at each lag by itself.
    pub surrogates_95: Vec<[f64; 2]>,
    /// The highest mean correlation.
    pub highest_r: f64,
    /// At which lag, seconds.
    pub lag_s: f64,
    /// The highest value of a curve is above this in 5 % of the surrogates.
    pub critical_r: f64,
    /// p of the highest value, corrected over lags.
    pub p_value: f64,
    /// Surrogates.
    pub surrogates: usize,
    /// What they are.
    pub kind: Surrogates,
    /// Their seed.
    pub seed: u64,
    /// The middle of the people's own lags, seconds.
    pub median_lag_s: f64,
    /// Each person.
    pub each: Vec<PersonCoupling>,
}

/// A person's own curve, in short.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PersonCoupling {
    /// The person.
    pub participant: String,
    /// Plays.
    pub plays: usize,
    /// Mean correlation at the group's lag; none where no play has one there.
    pub r_at_lag: Option<f64>,
    /// The highest of this person.
    pub highest_r: f64,
    /// At which lag, seconds.
    pub lag_s: f64,
}

/// The plays of a person that have a curve, as places among all.
struct PersonPlays {
    person: usize,
    plays: Vec<usize>,
    curve: Curve,
}

/// Lagged cross-correlation of what was shown and what people did; none where no play has a curve.
///
/// # Errors
/// [`Refusal`]: fewer than 19 surrogates.
pub fn lagged_correlation(
    given: &Couplings,
    options: LaggedCorrelationOptions,
) -> Result<Option<LaggedCorrelation>, Refusal> {
    require_permutations(options.surrogates)?;
    let LaggedCorrelationOptions { window, surrogates, kind, seed } = options;
    let curves: Vec<Option<Curve>> =
        given.plays.par_iter().map(|play| curve(given.shown(play), &play.track, &window)).collect();
    let people = people_of(given, &curves);
    let n: usize = people.iter().map(|own| own.plays.len()).sum();
    let group = mean_curve(people.iter().map(|own| &own.curve), window.lags());
    let Some((place, highest_z)) = highest(&group) else { return Ok(None) };
    let drawn = surrogate_curves(given, &people, &options);
    let maxima: Vec<f64> =
        drawn.iter().map(|own| highest(own).map_or(f64::NAN, |it| it.1)).collect();
    let reached = maxima.iter().filter(|own| **own >= highest_z - 1e-12).count();
    let mut sorted: Vec<f64> = maxima.into_iter().filter(|own| own.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let lag_of = |place: usize| window.lag_s(place);
    let each: Vec<PersonCoupling> = people
        .iter()
        .filter_map(|own| {
            let (at, z) = highest(&own.curve)?;
            let here = own.curve[place];
            Some(PersonCoupling {
                participant: given.people[own.person].clone(),
                plays: own.plays.len(),
                r_at_lag: here.is_finite().then(|| here.tanh()),
                highest_r: z.tanh(),
                lag_s: lag_of(at),
            })
        })
        .collect();
    let mut lags: Vec<f64> = each.iter().map(|own| own.lag_s).collect();
    Ok(Some(LaggedCorrelation {
        test: "lagged-correlation",
        participants: people.len(),
        n,
        dropped: given.plays.len() - n,
        lags_s: (0..window.lags()).map(lag_of).collect(),
        r: group.iter().map(|z| z.tanh()).collect(),
        interval_95: intervals(&people, &group),
        surrogates_95: middle(&drawn, window.lags()),
        highest_r: highest_z.tanh(),
        lag_s: lag_of(place),
        critical_r: quantile_sorted(&sorted, 0.95).tanh(),
        p_value: (1 + reached) as f64 / (1 + surrogates) as f64,
        surrogates,
        kind,
        seed,
        median_lag_s: median(&mut lags),
        each,
    }))
}

impl Couplings {
    /// The courses of a play's clip.
    fn shown(&self, play: &CoupledPlay) -> &Courses {
        &self.clips[play.clip]
    }
}

/// The people who have a curve, in their order.
fn people_of(given: &Couplings, curves: &[Option<Curve>]) -> Vec<PersonPlays> {
    let of = |person: usize| {
        let own = |play: &usize| given.plays[*play].person == person && curves[*play].is_some();
        let plays: Vec<usize> = (0..given.plays.len()).filter(own).collect();
        let lags = plays.first().and_then(|first| curves[*first].as_ref()).map(Vec::len)?;
        let curve = mean_curve(plays.iter().filter_map(|play| curves[*play].as_ref()), lags);
        Some(PersonPlays { person, plays, curve })
    };
    (0..given.people.len()).filter_map(of).collect()
}

/// 95 % intervals by t over people at each lag, of r; none of one person.
fn intervals(people: &[PersonPlays], group: &[f64]) -> Option<Vec<[f64; 2]>> {
    if people.len() < 2 {
        return None;
    }
    let at = |(lag, mean): (usize, &f64)| {
        let own: Vec<f64> =
            people.iter().map(|person| person.curve[lag]).filter(|z| z.is_finite()).collect();
        let n = own.len() as f64;
        if own.len() < 2 {
            return [f64::NAN; 2];
        }
        let squares: f64 = own.iter().map(|z| (z - mean).powi(2)).sum();
        let half = t_quantile_upper(0.025, n - 1.0) * (squares / (n - 1.0) / n).sqrt();
        [(mean - half).tanh(), (mean + half).tanh()]
    };
    Some(group.iter().enumerate().map(at).collect())
}

/// The middle 95 % of curves at each lag, of r.
fn middle(drawn: &[Curve], lags: usize) -> Vec<[f64; 2]> {
    let at = |lag: usize| {
        let mut own: Vec<f64> = drawn.iter().map(|z| z[lag]).filter(|z| z.is_finite()).collect();
        own.sort_unstable_by(f64::total_cmp);
        match own.is_empty() {
            true => [f64::NAN; 2],
            false => [quantile_sorted(&own, 0.025).tanh(), quantile_sorted(&own, 0.975).tanh()],
        }
    };
    (0..lags).map(at).collect()
}
