//! The most probable path (Viterbi; Rabiner 1989, eq. 32-35), in the log domain.

use mimique_solver::widest;

use super::{Emissions, Hmm, logs};
use crate::{AnnotateError, Rows};

/// The most probable path through the states.
#[derive(Debug, Clone, PartialEq)]
pub struct BestPath {
    /// State of each frame.
    pub states: Vec<usize>,
    /// ln of the joint density of path and sequence.
    pub log_probability: f64,
}

impl Hmm {
    /// The most probable path; of equal predecessors the lowest state.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the sequence has another width, [`AnnotateError::Impossible`]
    /// when no path gives it.
    pub fn best_path(&self, sequence: &Rows) -> Result<BestPath, AnnotateError> {
        self.path_through(self.emissions_taken(sequence)?)
    }

    pub(super) fn path_through(&self, emissions: Emissions) -> Result<BestPath, AnnotateError> {
        best_path(&logs(&self.start), &logs(self.transition.values()), emissions)
            .ok_or(AnnotateError::Impossible { sequence: 0 })
    }
}

/// The best path, of logarithms: S starts, S x S transitions, T x S emissions. The score of the best path
/// to each state takes the place of its emission; predecessors are found on the way back, a state a
/// frame.
pub(crate) fn best_path(
    start: &[f64],
    transition: &[f64],
    emissions: Emissions,
) -> Option<BestPath> {
    let states = start.len();
    let Emissions { taken: mut scores, off } = emissions;
    let frames = scores.len() / states.max(1);
    if frames == 0 {
        return Some(BestPath { states: Vec::new(), log_probability: 0.0 });
    }
    scores.iter_mut().zip(start).for_each(|(score, start)| *score += start);
    let mut next = vec![0.0; states];
    for f in 1..frames {
        let (before, rest) = scores.split_at_mut(f * states);
        best_of_each(&before[(f - 1) * states..], transition, &mut next);
        rest.iter_mut().zip(&next).for_each(|(score, best)| *score += best);
    }
    let mut state = crate::numbers::highest(&scores[(frames - 1) * states..]);
    let score = scores[(frames - 1) * states + state];
    if score == f64::NEG_INFINITY {
        return None;
    }
    let mut path = vec![state; frames];
    let mut leading = vec![0.0; states];
    for f in (1..frames).rev() {
        let before = &scores[(f - 1) * states..f * states];
        for (i, leading) in leading.iter_mut().enumerate() {
            *leading = before[i] + transition[i * states + state];
        }
        state = crate::numbers::highest(&leading);
        path[f - 1] = state;
    }
    Some(BestPath { states: path, log_probability: score + off })
}

widest! {
    /// The highest of from_i + a_ij over i, for every j.
    fn best_of_each(from: &[f64], transition: &[f64], best: &mut [f64]) {
        let states = best.len();
        for b in best.iter_mut() {
            *b = f64::NEG_INFINITY;
        }
        for i in 0..states {
            let (own, row) = (from[i], &transition[i * states..(i + 1) * states]);
            for j in 0..states {
                let score = own + row[j];
                best[j] = if score > best[j] { score } else { best[j] };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_equal_predecessors_the_lowest_and_of_no_path_none() {
        let emissions = || Emissions::of(vec![0.0; 6], 2);
        let even = (0.5f64).ln();
        let path = best_path(&[even; 2], &[even; 4], emissions()).unwrap();
        assert_eq!(path.states, [0, 0, 0]);
        let never = f64::NEG_INFINITY;
        assert_eq!(best_path(&[0.0, never], &[never; 4], emissions()), None);
        let nothing = best_path(&[0.0, never], &[never; 4], Emissions::of(Vec::new(), 2));
        assert_eq!(nothing.unwrap().log_probability, 0.0);
    }
}
