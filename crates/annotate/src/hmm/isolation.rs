//! A take of one expression, cut without labels: neutral face, way, peak (short paper, 2.3).
//!
//! A hidden Markov model of three states is learnt from the take itself; the states of its most
//! probable path are named by how far the face is from the neutral in them.

use std::ops::Range;

use super::{BaumWelch, Beginning, Topology};
use crate::features::{level, mean};
use crate::{AnnotateError, Take, runs};

/// States of the model: neutral, way, peak.
const STATES: usize = 3;

/// What a take of one expression falls into.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Isolated {
    /// Stretches of the state nearest to the neutral.
    pub neutral: Vec<Range<usize>>,
    /// Stretches of the state farthest from it.
    pub peaks: Vec<Range<usize>>,
}

/// Cut a take. The neutral face is the mean of `neutral`, or the face at which all weights are 0 where
/// no frame is named; `stay` is the probability that a state follows itself at the beginning.
///
/// # Errors
/// As [`BaumWelch::learn`].
pub(crate) fn isolated(
    take: &Take,
    neutral: &[usize],
    components: usize,
    learning: &BaumWelch,
    stay: f64,
) -> Result<Isolated, AnnotateError> {
    let sequence = std::slice::from_ref(&take.weights);
    let beginning = Beginning { topology: Topology::Ergodic, states: STATES, components, stay };
    let hmm = learning.learn(&beginning.hmm(sequence, learning.variance_floor)?, sequence)?.hmm;
    let states = hmm.best_path(&take.weights)?.states;
    let away = level(&take.weights, &mean(&take.weights, neutral.iter().copied()));
    let distance = |state: usize| {
        let own: Vec<f64> =
            states.iter().zip(&away).filter(|(s, _)| **s == state).map(|(_, a)| *a).collect();
        (!own.is_empty()).then(|| (own.iter().sum::<f64>() / own.len() as f64, state))
    };
    let mut visited: Vec<(f64, usize)> = (0..STATES).filter_map(distance).collect();
    visited.sort_by(|a, b| a.0.total_cmp(&b.0));
    let of = |named: Option<&(f64, usize)>| -> Vec<Range<usize>> {
        let runs = runs(&states).into_iter();
        runs.filter(|run| named.is_some_and(|n| n.1 == run.label)).map(|run| run.frames).collect()
    };
    let farthest = visited.last().filter(|_| visited.len() > 1);
    Ok(Isolated { neutral: of(visited.first()), peaks: of(farthest) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    #[test]
    fn planted_peaks_and_rests_are_found_without_labels() {
        // Five times rest, way up, peak, way down; 60 Hz.
        let mut random = Random::new(31);
        let height = |f: usize| match f % 120 {
            f @ 40..60 => (f - 40) as f64 / 20.0,
            60..98 => 1.0,
            f @ 98..118 => (118 - f) as f64 / 20.0,
            _ => 0.0,
        };
        let values = (0..600).flat_map(|f| {
            let h = height(f);
            [0.9 * h, 0.4 * h, 0.1].map(|w| w + 0.02 * random.normal())
        });
        let take = Take::new(values.collect(), 3, 60.0).unwrap();
        let learning = BaumWelch { steps: 20, ..BaumWelch::default() };
        let found = isolated(&take, &[], 2, &learning, 0.95).unwrap();
        let longest = |of: &[Range<usize>]| of.iter().filter(|r| r.len() > 20).count();
        assert_eq!((longest(&found.peaks), longest(&found.neutral)), (5, 5), "{found:?}");
        for peak in found.peaks.iter().filter(|r| r.len() > 20) {
            assert!(height((peak.start + peak.end) / 2) > 0.9, "{peak:?}");
        }
        assert!(found.neutral.iter().all(|r| height((r.start + r.end) / 2) < 0.3));
    }

    #[test]
    fn a_still_take_has_no_peak() {
        let take = Take::new(vec![0.1; 300], 1, 60.0).unwrap();
        let found = isolated(&take, &[], 2, &BaumWelch::default(), 0.9).unwrap();
        assert_eq!((found.peaks, found.neutral), (vec![], vec![Range { start: 0, end: 300 }]));
    }
}
