//! Hidden Markov models with mixtures of Gaussians (Rabiner, Proc. IEEE 1989; short paper, section
//! 2.3).
//!
//! | symbol | here |
//! |---|---|
//! | pi_i (S) | `start` |
//! | a_ij (S x S), from i to j | `transition`, a row per i |
//! | b_j(o) (eq. 8) | `states`, a [`Mixture`] each |

mod baum_welch;
mod composite;
mod forward;
mod isolation;
mod topology;
pub(crate) mod viterbi;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

pub use baum_welch::{BaumWelch, Learnt};
pub use composite::Composite;
pub use forward::Posterior;
pub(crate) use isolation::{Isolated, isolated};
pub use topology::{Beginning, Topology};
pub use viterbi::BestPath;

use crate::error::as_many;
use crate::mixture::{Mixture, probabilities};
use crate::numbers::{BLOCK, log_sum};
use crate::{AnnotateError, Rows};

/// A hidden Markov model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Hmm {
    pub(crate) start: Vec<f64>,
    pub(crate) transition: Rows,
    pub(crate) states: Vec<Mixture>,
}

/// A model as a file has it.
#[derive(Deserialize)]
struct Unchecked {
    start: Vec<f64>,
    transition: Rows,
    states: Vec<Mixture>,
}

impl TryFrom<Unchecked> for Hmm {
    type Error = AnnotateError;

    fn try_from(of: Unchecked) -> Result<Self, AnnotateError> {
        Self::new(of.start, of.transition, of.states)
    }
}

/// Emissions of a sequence: ln b_j(o_t), each frame's highest taken off, so that what is added up
/// over the frames stays small beside what tells states apart.
pub(crate) struct Emissions {
    /// Frame after frame, a state each.
    pub taken: Vec<f64>,
    /// Sum of what was taken off.
    pub off: f64,
}

impl Hmm {
    /// S starts, S x S transitions (a row the state that is left), S mixtures.
    ///
    /// # Errors
    /// [`AnnotateError::Count`], [`AnnotateError::Setting`] for probabilities that do not add to 1,
    /// [`AnnotateError::Limit`] above 65,535 states.
    pub fn new(
        start: Vec<f64>,
        transition: Rows,
        states: Vec<Mixture>,
    ) -> Result<Self, AnnotateError> {
        crate::error::at_most("states", states.len(), usize::from(u16::MAX))?;
        crate::error::above_zero("states", states.len() as f64)?;
        as_many("starts", start.len(), states.len())?;
        as_many("rows of transitions", transition.len(), states.len())?;
        as_many("columns of transitions", transition.width(), states.len())?;
        probabilities("starts", &start)?;
        transition.iter().try_for_each(|row| probabilities("transitions of a state", row))?;
        for state in &states {
            as_many("columns of a mixture", state.mean.width(), states[0].mean.width())?;
        }
        Ok(Self { start, transition, states })
    }

    /// Probability of each state at the first frame.
    pub fn start(&self) -> &[f64] {
        &self.start
    }

    /// Probability of each next state, a row the state that is left.
    pub fn transition(&self) -> &Rows {
        &self.transition
    }

    /// What each state emits.
    pub fn states(&self) -> &[Mixture] {
        &self.states
    }

    /// Columns of a sequence.
    pub fn width(&self) -> usize {
        self.states[0].mean.width()
    }

    /// ln of the density of every frame in every state, a frame a row's worth: T x S numbers, minus
    /// infinity where a state cannot emit a frame.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the sequence has another width.
    pub fn emissions(&self, sequence: &Rows) -> Result<Vec<f64>, AnnotateError> {
        as_many("columns of a sequence", sequence.width(), self.width())?;
        let densities: Vec<_> = self.states.iter().map(Mixture::density).collect();
        let most = densities.iter().map(|d| d.len()).max().unwrap_or(0);
        let (states, width) = (densities.len(), sequence.width());
        let mut emissions = vec![0.0; sequence.len() * states];
        let blocks = emissions.par_chunks_mut(BLOCK * states);
        let frames = sequence.values().par_chunks(BLOCK * width);
        blocks.zip(frames).for_each_init(
            || vec![0.0; BLOCK * most],
            |components, (out, frames)| {
                for (state, density) in densities.iter().enumerate() {
                    let own = &mut components[..density.len() * (frames.len() / width)];
                    density.components(frames, own);
                    for (f, own) in own.chunks_exact_mut(density.len()).enumerate() {
                        out[f * states + state] = log_sum(own);
                    }
                }
            },
        );
        Ok(emissions)
    }

    pub(crate) fn emissions_taken(&self, sequence: &Rows) -> Result<Emissions, AnnotateError> {
        Ok(Emissions::of(self.emissions(sequence)?, self.states.len()))
    }

    /// The same, their logarithms times a factor.
    pub(crate) fn tempered(&self, sequence: &Rows, by: f64) -> Result<Emissions, AnnotateError> {
        let mut emissions = self.emissions(sequence)?;
        if by != 1.0 {
            emissions.iter_mut().for_each(|b| *b *= by);
        }
        Ok(Emissions::of(emissions, self.states.len()))
    }
}

impl Emissions {
    /// Take each frame's highest off.
    pub(crate) fn of(mut taken: Vec<f64>, states: usize) -> Self {
        let mut off = 0.0;
        for frame in taken.chunks_exact_mut(states.max(1)) {
            let highest = frame.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if highest.is_finite() {
                frame.iter_mut().for_each(|b| *b -= highest);
                off += highest;
            }
        }
        Self { taken, off }
    }
}

/// ln of every number; minus infinity of 0.
pub(crate) fn logs(values: &[f64]) -> Vec<f64> {
    values.iter().map(|&v| libm::log(v)).collect()
}
