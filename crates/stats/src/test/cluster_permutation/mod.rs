//! Courses over time compared within people: the cluster-based permutation test (Maris and Oostenveld, Journal of
//! Neuroscience Methods 164(1), 2007).
//!
//! With d_it the difference of person i between two conditions at instant t, t_t is the paired t of the d_it. Instants
//! one after the other at which |t_t| is above its two-sided 5 % quantile, on one side, are a *cluster*; its *mass* is
//! the sum of their t. In each draw the differences of every person as a whole keep or change their sign, by a fair
//! coin, and the largest |mass| of any cluster is noted. The p of a cluster is (1 + draws whose largest |mass| reaches
//! its own) / (1 + draws), which is corrected over all instants: where the conditions do not differ, the probability of
//! any p <= 0.05 is 0.05 at most.
//!
//! A cluster says that the courses differ. When it begins and ends is not tested: its ends follow from the quantile
//! (Sassenhagen and Draschkow, Psychophysiology 56(6), 2019).

mod procedure;
#[cfg(test)]
mod tests;

use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;

use crate::distributions::tail::t_quantile_upper;
use crate::numerics::largest::{Largest, require_permutations};
use crate::numerics::random::Stream;
use crate::outcome::Outcome;
use crate::refusal::Refusal;
use crate::undefined::NoEstimate;
pub(crate) use procedure::PROCEDURE;

/// Least sum of squares about the mean, of the largest sum of squares of any instant: a spread below a thousandth of
/// the largest difference counts as that thousandth. Else t is infinite where everybody differs by the same, as happens
/// when a slider has moved by one step, and that one instant outweighs all others.
const LEAST_SPREAD: f64 = 1e-6;

/// How the draws are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClusterPermutationOptions {
    /// Draws, at least 19.
    pub permutations: usize,
    /// Seed of the draws.
    pub seed: u64,
}

/// Result of [`cluster_permutation`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClusterPermutation {
    /// Always `cluster-permutation`.
    pub test: &'static str,
    /// People.
    pub participants: usize,
    /// Instants that everybody has.
    pub instants: usize,
    /// Draws.
    pub permutations: usize,
    /// Their seed.
    pub seed: u64,
    /// Instants with a larger |t| are in a cluster.
    pub threshold_t: f64,
    /// Clusters with a larger |mass| are significant.
    pub critical_mass: f64,
    /// Paired t at each instant.
    pub t: Vec<f64>,
    /// Clusters in their order.
    pub clusters: Vec<TimeCluster>,
}

/// Instants one after the other that differ to one side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TimeCluster {
    /// First instant, from 0.
    pub first: usize,
    /// Last instant.
    pub last: usize,
    /// Sum of t.
    pub mass: f64,
    /// p, corrected over all instants.
    pub p: f64,
}

/// Differences of each person (people x instants) against 0; instants that somebody lacks are left out.
///
/// Refuses fewer draws than can give p <= 0.05. Undefined with fewer than two people, or where nobody has an instant.
///
/// ```
/// use mimique_stats::{ClusterPermutationOptions, Outcome, cluster_permutation};
///
/// // Ten people, who differ from the third instant on.
/// let person = |i: usize| (0..8).map(|t| (i % 3) as f64 - 1.0 + if t > 1 { 3.0 } else { 0.0 }).collect();
/// let differences: Vec<Vec<f64>> = (0..10).map(person).collect();
/// let options = ClusterPermutationOptions { permutations: 999, seed: 1 };
/// let Outcome::Ok(found) = cluster_permutation(&differences, options)? else { panic!() };
/// assert_eq!((found.clusters[0].first, found.clusters[0].last), (2, 7));
/// assert!(found.clusters[0].p < 0.01);
/// # Ok::<(), mimique_stats::Refusal>(())
/// ```
pub fn cluster_permutation(
    differences: &[Vec<f64>],
    options: ClusterPermutationOptions,
) -> Result<Outcome<ClusterPermutation>, Refusal> {
    require_permutations(options.permutations)?;
    let participants = differences.len();
    let instants = differences.iter().map(Vec::len).min().unwrap_or(0);
    if participants < 2 || instants == 0 {
        return Ok(Outcome::undefined(NoEstimate::NoSpreadOfPeople));
    }
    let threshold = t_quantile_upper(0.025, participants as f64 - 1.0);
    let squares: Vec<f64> =
        (0..instants).map(|t| differences.iter().map(|own| own[t] * own[t]).sum()).collect();
    let least = LEAST_SPREAD * squares.iter().fold(0.0, |most: f64, own| most.max(*own));
    let t_of = |sums: &[f64]| -> Vec<f64> {
        sums.iter()
            .zip(&squares)
            .map(|(sum, squares)| paired_t(*sum, *squares, least, participants))
            .collect()
    };
    let summed = |sums: &mut [f64], sign: &mut dyn FnMut() -> f64| {
        sums.fill(0.0);
        for own in differences {
            let sign = sign();
            sums.iter_mut().zip(own).for_each(|(sum, value)| *sum += sign * value);
        }
    };
    let mut sums = vec![0.0; instants];
    summed(&mut sums, &mut || 1.0);
    let t = t_of(&sums);
    let largest = |sums: &mut Vec<f64>, draw: usize| {
        // Each draw has a random stream of its own, so that neither threads nor their number matter.
        let mut stream = Stream::new(options.seed, draw as u64);
        summed(sums, &mut || if stream.below(2) == 0 { 1.0 } else { -1.0 });
        let clusters = clusters(&t_of(sums), threshold);
        clusters.iter().fold(0.0_f64, |most, (_, mass)| most.max(mass.abs()))
    };
    let drawn = (0..options.permutations)
        .into_par_iter()
        .map_init(|| vec![0.0; instants], largest)
        .collect();
    let largest = Largest::of(drawn);
    let clusters = clusters(&t, threshold).into_iter().map(|([first, last], mass)| TimeCluster {
        first,
        last,
        mass,
        p: largest.p(mass),
    });
    Ok(Outcome::Ok(ClusterPermutation {
        test: "cluster-permutation",
        participants,
        instants,
        permutations: options.permutations,
        seed: options.seed,
        threshold_t: threshold,
        critical_mass: largest.critical(),
        clusters: clusters.collect(),
        t,
    }))
}

/// t of differences from their sum and the sum of their squares, which no change of signs changes; the squares about
/// the mean are taken to be `least` at least.
fn paired_t(sum: f64, squares: f64, least: f64, people: usize) -> f64 {
    if squares == 0.0 {
        return 0.0;
    }
    let n = people as f64;
    let about = (squares - sum * sum / n).max(least);
    sum / (about / (n - 1.0) * n).sqrt()
}

/// First and last instant of each cluster, and its mass.
fn clusters(t: &[f64], threshold: f64) -> Vec<([usize; 2], f64)> {
    let side = |t: &f64| if t.abs() > threshold { t.signum() } else { 0.0 };
    let mut found = Vec::new();
    let mut first = 0;
    for run in t.chunk_by(|a, b| side(a) == side(b)) {
        if side(&run[0]) != 0.0 {
            found.push(([first, first + run.len() - 1], run.iter().sum()));
        }
        first += run.len();
    }
    found
}
