//! Likelihood of a sequence and the probability of every state at every frame: forward and backward
//! (Rabiner 1989, eq. 19-27), in the log domain.
//!
//! A sum over predecessors is computed on numbers scaled by the highest, which needs an exponential
//! a state; where that sum is so small that terms may have been lost, it is computed again in the
//! log domain, which needs one a pair of states.

use mimique_solver::{exp_all, widest};

use super::{Emissions, Hmm, logs};
use crate::numbers::{dots, log_sum, softmax};
use crate::{AnnotateError, Rows};

/// What a model says of a sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Posterior {
    /// ln of the density of the sequence.
    pub log_likelihood: f64,
    /// Probability of each state, given the whole sequence: a frame a row.
    pub states: Rows,
}

/// Sums below this may lack terms that matter: scaled terms vanish below 1e-308.
const SURE: f64 = 1e-200;

/// Forward and backward of a sequence.
pub(super) struct Lattice {
    /// ln P(state at t | frames up to t), frame after frame.
    pub forward: Vec<f64>,
    /// ln P(frames after t | state at t) - ln P(frames after t | frames up to t).
    pub backward: Vec<f64>,
    /// What was taken off each frame of `forward`.
    pub scale: Vec<f64>,
    /// ln of the density of the sequence.
    pub log_likelihood: f64,
}

/// Sums over the states that lead to, or follow, a state.
struct Sums<'a> {
    hmm: &'a Hmm,
    log_transition: Vec<f64>,
    scaled: Vec<f64>,
    sums: Vec<f64>,
    terms: Vec<f64>,
}

impl<'a> Sums<'a> {
    fn of(hmm: &'a Hmm) -> Self {
        let states = hmm.states.len();
        let log_transition = logs(hmm.transition.values());
        let none = || vec![0.0; states];
        Self { hmm, log_transition, scaled: none(), sums: none(), terms: none() }
    }

    /// Scale by the highest, which comes back; none when all are minus infinity.
    fn scale(&mut self, values: &[f64]) -> Option<f64> {
        let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if highest == f64::NEG_INFINITY {
            return None;
        }
        for (scaled, value) in self.scaled.iter_mut().zip(values) {
            *scaled = value - highest;
        }
        exp_all(&mut self.scaled);
        Some(highest)
    }

    /// ln sum_i e^(from_i) a_ij for every j.
    fn leading(&mut self, from: &[f64], out: &mut [f64]) {
        let Some(highest) = self.scale(from) else { return out.fill(f64::NEG_INFINITY) };
        weighted_rows(self.hmm.transition.values(), &self.scaled, &mut self.sums);
        let states = out.len();
        for (j, out) in out.iter_mut().enumerate() {
            *out = if self.sums[j] > SURE {
                highest + libm::log(self.sums[j])
            } else {
                for (i, term) in self.terms.iter_mut().enumerate() {
                    *term = from[i] + self.log_transition[i * states + j];
                }
                log_sum(&mut self.terms)
            };
        }
    }

    /// ln sum_j a_ij e^(to_j) for every i.
    fn following(&mut self, to: &[f64], out: &mut [f64]) {
        let Some(highest) = self.scale(to) else { return out.fill(f64::NEG_INFINITY) };
        let states = out.len();
        dots(self.hmm.transition.values(), &self.scaled, &mut self.sums);
        for (i, out) in out.iter_mut().enumerate() {
            let sum = self.sums[i];
            *out = if sum > SURE {
                highest + libm::log(sum)
            } else {
                let own = &self.log_transition[i * states..(i + 1) * states];
                self.terms.iter_mut().zip(to).zip(own).for_each(|((t, to), a)| *t = to + a);
                log_sum(&mut self.terms)
            };
        }
    }
}

widest! {
    /// The sum of the rows of a square table, each times its weight.
    fn weighted_rows(rows: &[f64], weights: &[f64], sums: &mut [f64]) {
        let n = sums.len();
        for sum in sums.iter_mut() {
            *sum = 0.0;
        }
        for i in 0..n {
            let (weight, row) = (weights[i], &rows[i * n..(i + 1) * n]);
            for j in 0..n {
                sums[j] += weight * row[j];
            }
        }
    }
}

impl Lattice {
    /// Forward alone: `backward` stays empty.
    pub(super) fn forward(hmm: &Hmm, emissions: &Emissions) -> Self {
        let states = hmm.states.len();
        let frames = emissions.taken.len() / states;
        let mut sums = Sums::of(hmm);
        let mut forward = vec![0.0; frames * states];
        let mut scale = Vec::with_capacity(frames);
        for f in 0..frames {
            let (before, rest) = forward.split_at_mut(f * states);
            let own = &mut rest[..states];
            if f == 0 {
                own.iter_mut().zip(&hmm.start).for_each(|(o, s)| *o = libm::log(*s));
            } else {
                sums.leading(&before[(f - 1) * states..], own);
            }
            let emitted = &emissions.taken[f * states..(f + 1) * states];
            own.iter_mut().zip(emitted).for_each(|(o, b)| *o += b);
            sums.terms.copy_from_slice(own);
            let sum = log_sum(&mut sums.terms);
            if sum.is_finite() {
                own.iter_mut().for_each(|o| *o -= sum);
            }
            scale.push(sum);
        }
        let log_likelihood = scale.iter().sum::<f64>() + emissions.off;
        Self { forward, backward: Vec::new(), scale, log_likelihood }
    }

    /// Forward and backward of a sequence that the model can give.
    pub(super) fn whole(hmm: &Hmm, emissions: &Emissions) -> Self {
        let mut lattice = Self::forward(hmm, emissions);
        let states = hmm.states.len();
        let frames = lattice.scale.len();
        let mut sums = Sums::of(hmm);
        lattice.backward = vec![0.0; frames * states];
        let mut to = vec![0.0; states];
        for f in (0..frames.saturating_sub(1)).rev() {
            let next = (f + 1) * states..(f + 2) * states;
            let after = lattice.backward[next.clone()].iter().zip(&emissions.taken[next]);
            to.iter_mut().zip(after).for_each(|(to, (beta, b))| *to = beta + b);
            let own = &mut lattice.backward[f * states..(f + 1) * states];
            sums.following(&to, own);
            own.iter_mut().for_each(|o| *o -= lattice.scale[f + 1]);
        }
        lattice
    }

    /// Probability of every state at every frame.
    pub(super) fn posterior(&self, states: usize) -> Vec<f64> {
        let pairs = self.forward.iter().zip(&self.backward);
        let mut gamma: Vec<f64> = pairs.map(|(a, b)| a + b).collect();
        gamma.chunks_exact_mut(states).for_each(softmax);
        gamma
    }
}

impl Hmm {
    /// ln of the density of a sequence; minus infinity when no path gives it; 0 of no frames.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the sequence has another width.
    pub fn log_likelihood(&self, sequence: &Rows) -> Result<f64, AnnotateError> {
        Ok(Lattice::forward(self, &self.emissions_taken(sequence)?).log_likelihood)
    }

    /// Likelihood, and the probability of every state at every frame.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] when the sequence has another width, [`AnnotateError::Impossible`]
    /// when no path gives it.
    pub fn posterior(&self, sequence: &Rows) -> Result<Posterior, AnnotateError> {
        self.posterior_of(&self.emissions_taken(sequence)?)
    }

    pub(super) fn posterior_of(&self, emissions: &Emissions) -> Result<Posterior, AnnotateError> {
        let lattice = Lattice::whole(self, emissions);
        if lattice.log_likelihood == f64::NEG_INFINITY {
            return Err(AnnotateError::Impossible { sequence: 0 });
        }
        let states = Rows::new(lattice.posterior(self.states.len()), self.states.len())?;
        Ok(Posterior { log_likelihood: lattice.log_likelihood, states })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mixture::Mixture;
    use mimique_test_support::Random;

    fn random_hmm(states: usize, random: &mut Random) -> Hmm {
        let mut shares = || {
            let raw: Vec<f64> = (0..states).map(|_| random.uniform() + 0.05).collect();
            let sum: f64 = raw.iter().sum();
            raw.into_iter().map(|r| r / sum).collect::<Vec<f64>>()
        };
        let start = shares();
        let transition = Rows::new((0..states).flat_map(|_| shares()).collect(), states).unwrap();
        let mixtures = (0..states).map(|s| {
            let mean = Rows::new(vec![s as f64], 1).unwrap();
            Mixture::new(vec![1.0], mean, Rows::new(vec![0.5], 1).unwrap()).unwrap()
        });
        Hmm::new(start, transition, mixtures.collect()).unwrap()
    }

    /// Every path of a short sequence: its states and its density.
    fn paths(hmm: &Hmm, sequence: &Rows) -> Vec<(Vec<usize>, f64)> {
        let (states, frames) = (hmm.states.len(), sequence.len());
        let emissions = hmm.emissions(sequence).unwrap();
        (0..states.pow(frames as u32))
            .map(|code| {
                let path: Vec<usize> =
                    (0..frames).map(|f| code / states.pow(f as u32) % states).collect();
                let mut density = hmm.start[path[0]];
                for f in 0..frames {
                    density *= emissions[f * states + path[f]].exp();
                    if f > 0 {
                        density *= hmm.transition.row(path[f - 1])[path[f]];
                    }
                }
                (path, density)
            })
            .collect()
    }

    #[test]
    fn likelihood_posterior_and_best_path_equal_the_enumeration_of_all_paths() {
        let mut random = Random::new(21);
        let hmm = random_hmm(3, &mut random);
        let sequence = Rows::new((0..7).map(|_| 3.0 * random.uniform()).collect(), 1).unwrap();
        let all = paths(&hmm, &sequence);
        let total: f64 = all.iter().map(|(_, d)| d).sum();
        let found = hmm.posterior(&sequence).unwrap();
        assert!((found.log_likelihood - total.ln()).abs() < 1e-12);
        assert_eq!(hmm.log_likelihood(&sequence).unwrap(), found.log_likelihood);
        for f in 0..7 {
            for s in 0..3 {
                let through = all.iter().filter(|(p, _)| p[f] == s).map(|(_, d)| d);
                let share = through.sum::<f64>() / total;
                assert!((found.states.row(f)[s] - share).abs() < 1e-12, "{f} {s}");
            }
        }
        let best = all.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        let path = hmm.best_path(&sequence).unwrap();
        assert_eq!(path.states, best.0);
        assert!((path.log_probability - best.1.ln()).abs() < 1e-12);
    }

    #[test]
    fn the_order_of_the_states_does_not_matter() {
        let mut random = Random::new(4);
        let hmm = random_hmm(4, &mut random);
        let sequence = Rows::new((0..50).map(|_| 4.0 * random.uniform()).collect(), 1).unwrap();
        let order = [2, 0, 3, 1];
        let turned = Hmm::new(
            order.map(|s| hmm.start[s]).to_vec(),
            Rows::new(
                order.iter().flat_map(|&s| order.map(|t| hmm.transition.row(s)[t])).collect(),
                4,
            )
            .unwrap(),
            order.map(|s| hmm.states[s].clone()).to_vec(),
        )
        .unwrap();
        let (one, other) =
            (hmm.posterior(&sequence).unwrap(), turned.posterior(&sequence).unwrap());
        assert!((one.log_likelihood - other.log_likelihood).abs() < 1e-10);
        for (a, b) in one.states.iter().zip(other.states.iter()) {
            (0..4).for_each(|i| assert!((a[order[i]] - b[i]).abs() < 1e-12));
        }
    }

    #[test]
    fn a_far_emission_of_the_only_state_that_can_be_there_is_not_lost() {
        // Left to right: at frame 0 only state 0 can be, yet state 1 fits 20,000 e-folds better.
        let gauss = |mean: f64| {
            let mean = Rows::new(vec![mean], 1).unwrap();
            Mixture::new(vec![1.0], mean, Rows::new(vec![1.0], 1).unwrap()).unwrap()
        };
        let transition = Rows::new(vec![0.5, 0.5, 0.0, 1.0], 2).unwrap();
        let hmm = Hmm::new(vec![1.0, 0.0], transition, vec![gauss(0.0), gauss(200.0)]).unwrap();
        let sequence = Rows::new(vec![200.0, 0.0, 200.0], 1).unwrap();
        let found = hmm.posterior(&sequence).unwrap();
        assert_eq!(found.states.row(0), [1.0, 0.0]);
        assert!(found.log_likelihood < -19_000.0 && found.log_likelihood.is_finite());
        let end = Rows::new(vec![0.0, 1.0, 0.0, 1.0], 2).unwrap();
        let closed = Hmm::new(vec![0.0, 1.0], end, vec![gauss(0.0), gauss(200.0)]).unwrap();
        assert!(closed.posterior(&sequence).unwrap().states.row(1)[1] == 1.0);
    }
}
