//! The most probable path (Viterbi; Rabiner 1989, eq. 32-35), in the log domain.

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
        self.path_through(&self.emissions_taken(sequence)?)
    }

    pub(super) fn path_through(&self, emissions: &Emissions) -> Result<BestPath, AnnotateError> {
        best_path(&logs(&self.start), &logs(self.transition.values()), emissions)
            .ok_or(AnnotateError::Impossible { sequence: 0 })
    }
}

/// The best path, of logarithms: S starts, S x S transitions, T x S emissions.
pub(crate) fn best_path(
    start: &[f64],
    transition: &[f64],
    emissions: &Emissions,
) -> Option<BestPath> {
    let states = start.len();
    let frames = emissions.taken.len() / states.max(1);
    if frames == 0 {
        return Some(BestPath { states: Vec::new(), log_probability: 0.0 });
    }
    let mut from = vec![0u16; frames * states];
    let mut best: Vec<f64> = start.iter().zip(&emissions.taken).map(|(s, b)| s + b).collect();
    let mut next = vec![0.0; states];
    for f in 1..frames {
        let from = &mut from[f * states..(f + 1) * states];
        next.fill(f64::NEG_INFINITY);
        for ((i, &own), row) in (0u16..).zip(&best).zip(transition.chunks_exact(states)) {
            for ((next, from), a) in next.iter_mut().zip(from.iter_mut()).zip(row) {
                let score = own + a;
                if score > *next {
                    (*next, *from) = (score, i);
                }
            }
        }
        let emitted = &emissions.taken[f * states..];
        next.iter_mut().zip(emitted).for_each(|(next, b)| *next += b);
        std::mem::swap(&mut best, &mut next);
    }
    let mut state = crate::numbers::highest(&best);
    let score = best[state];
    if score == f64::NEG_INFINITY {
        return None;
    }
    let mut path = vec![state; frames];
    for f in (1..frames).rev() {
        state = usize::from(from[f * states + state]);
        path[f - 1] = state;
    }
    Some(BestPath { states: path, log_probability: score + emissions.off })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_equal_predecessors_the_lowest_and_of_no_path_none() {
        let emissions = Emissions::of(vec![0.0; 6], 2);
        let even = (0.5f64).ln();
        let path = best_path(&[even; 2], &[even; 4], &emissions).unwrap();
        assert_eq!(path.states, [0, 0, 0]);
        let never = f64::NEG_INFINITY;
        assert_eq!(best_path(&[0.0, never], &[never; 4], &emissions), None);
        let nothing = best_path(&[0.0, never], &[never; 4], &Emissions::of(Vec::new(), 2));
        assert_eq!(nothing.unwrap().log_probability, 0.0);
    }
}
