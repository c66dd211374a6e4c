//! Learning a hidden Markov model by expectation and maximisation: Baum-Welch on several sequences
//! (Rabiner 1989, eq. 40 and 52-54, 109-111), variances about the new means.

use mimique_solver::{exp_all, widest};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::forward::Lattice;
use super::{Emissions, Hmm, logs};
use crate::mixture::Mixture;
use crate::numbers::{highest_value, softmax};
use crate::{AnnotateError, Rows};

/// How a model is learnt.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BaumWelch {
    /// Most steps.
    pub steps: usize,
    /// Least variance of a component, squared units of the columns.
    pub variance_floor: f64,
    /// A component expected at fewer frames keeps its mean and variance.
    pub least_frames: f64,
    /// A step that raises the likelihood by less, per frame, is the last; 0 takes every step.
    pub tolerance: f64,
}

impl Default for BaumWelch {
    /// Weights are known to about 0.03: no component is narrower.
    fn default() -> Self {
        Self { steps: 50, variance_floor: 0.03 * 0.03, least_frames: 1e-8, tolerance: 1e-6 }
    }
}

/// A model that has learnt, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Learnt {
    /// The model.
    pub hmm: Hmm,
    /// ln of the density of all sequences, before each step and after the last.
    pub log_likelihood: Vec<f64>,
    /// Components that had too few frames at the last step: state, component.
    pub starved: Vec<(usize, usize)>,
}

/// Expected counts of one sequence, or of several together.
#[derive(Clone)]
struct Counts {
    log_likelihood: f64,
    start: Vec<f64>,
    /// S x S.
    transition: Vec<f64>,
    states: Vec<ComponentCounts>,
}

/// Expected frames of a state's components, and the sums of their distances to the old means.
#[derive(Clone)]
struct ComponentCounts {
    /// M.
    frames: Vec<f64>,
    /// M x D.
    first: Vec<f64>,
    /// M x D.
    second: Vec<f64>,
}

impl BaumWelch {
    /// Learn from sequences, beginning at a model. Zeros of starts and transitions stay zeros.
    ///
    /// # Errors
    /// [`AnnotateError::Impossible`] for a sequence that no path gives, [`AnnotateError::Count`]
    /// for another width or an empty list, [`AnnotateError::Setting`].
    pub fn learn(&self, begin: &Hmm, sequences: &[Rows]) -> Result<Learnt, AnnotateError> {
        crate::error::above_zero("variance floor", self.variance_floor)?;
        let sequences: Vec<&Rows> = sequences.iter().filter(|s| !s.is_empty()).collect();
        if sequences.is_empty() {
            return Err(AnnotateError::Count { what: "sequences", found: 0, expected: 1 });
        }
        let frames: usize = sequences.iter().map(|s| s.len()).sum();
        let mut learnt =
            Learnt { hmm: begin.clone(), log_likelihood: Vec::new(), starved: Vec::new() };
        for _ in 0..self.steps {
            let counts = expect(&learnt.hmm, &sequences)?;
            let before = learnt.log_likelihood.last().copied();
            learnt.log_likelihood.push(counts.log_likelihood);
            let gained = before.map(|b| counts.log_likelihood - b);
            if gained.is_some_and(|g| g < self.tolerance * frames as f64 && self.tolerance > 0.0) {
                return Ok(learnt);
            }
            self.maximise(&mut learnt, &counts);
        }
        let last: Vec<f64> = sequences
            .par_iter()
            .map(|s| learnt.hmm.log_likelihood(s))
            .collect::<Result<_, AnnotateError>>()?;
        learnt.log_likelihood.push(last.iter().sum());
        Ok(learnt)
    }

    /// The model under which the expected counts are most probable.
    fn maximise(&self, learnt: &mut Learnt, counts: &Counts) {
        learnt.starved.clear();
        let hmm = &mut learnt.hmm;
        shares(&counts.start, &mut hmm.start);
        let mut transition = hmm.transition.values().to_vec();
        let states = hmm.states.len();
        let rows = transition.chunks_exact_mut(states).zip(counts.transition.chunks_exact(states));
        rows.for_each(|(row, counts)| shares(counts, row));
        // Shares of finite counts are finite.
        if let Ok(rows) = Rows::new(transition, states) {
            hmm.transition = rows;
        }
        for (state, (mixture, counts)) in hmm.states.iter_mut().zip(&counts.states).enumerate() {
            let starved = self.maximise_mixture(mixture, counts);
            learnt.starved.extend(starved.into_iter().map(|component| (state, component)));
        }
    }

    /// The same of one state; its components that have too few frames come back.
    fn maximise_mixture(&self, mixture: &mut Mixture, counts: &ComponentCounts) -> Vec<usize> {
        shares(&counts.frames, &mut mixture.weight);
        let width = mixture.mean.width();
        let (mut mean, mut variance) =
            (mixture.mean.values().to_vec(), mixture.variance.values().to_vec());
        let mut starved = Vec::new();
        for (m, &frames) in counts.frames.iter().enumerate() {
            if frames < self.least_frames || frames <= 0.0 {
                starved.push(m);
                continue;
            }
            for at in m * width..(m + 1) * width {
                let shift = counts.first[at] / frames;
                mean[at] += shift;
                // About the new mean: the mean square about the old one less the shift's square.
                let square = counts.second[at] / frames - shift * shift;
                variance[at] = square.max(self.variance_floor);
            }
        }
        if let (Ok(mean), Ok(variance)) = (Rows::new(mean, width), Rows::new(variance, width)) {
            (mixture.mean, mixture.variance) = (mean, variance);
        }
        starved
    }
}

/// Counts over their sum; of no counts the old shares stay.
fn shares(counts: &[f64], out: &mut [f64]) {
    let sum: f64 = counts.iter().sum();
    if sum > 0.0 {
        out.iter_mut().zip(counts).for_each(|(out, count)| *out = count / sum);
    }
}

/// Expected counts of all sequences, added in their order.
fn expect(hmm: &Hmm, sequences: &[&Rows]) -> Result<Counts, AnnotateError> {
    let each: Vec<Counts> = sequences
        .par_iter()
        .enumerate()
        .map(|(place, sequence)| expect_one(hmm, sequence, place))
        .collect::<Result<_, AnnotateError>>()?;
    let mut all = Counts::none(hmm);
    each.iter().for_each(|counts| all.add(counts));
    Ok(all)
}

fn expect_one(hmm: &Hmm, sequence: &Rows, place: usize) -> Result<Counts, AnnotateError> {
    let states = hmm.states.len();
    let emissions = hmm.emissions_taken(sequence)?;
    let lattice = Lattice::whole(hmm, &emissions);
    if lattice.log_likelihood == f64::NEG_INFINITY {
        return Err(AnnotateError::Impossible { sequence: place });
    }
    let gamma = lattice.posterior(states);
    let mut counts = Counts::none(hmm);
    counts.log_likelihood = lattice.log_likelihood;
    counts.start.copy_from_slice(&gamma[..states]);
    counts.add_transitions(hmm, &lattice, &emissions);
    for (state, counts) in counts.states.iter_mut().enumerate() {
        counts.add_frames(&hmm.states[state], sequence, gamma[state..].iter().step_by(states));
    }
    Ok(counts)
}

impl Counts {
    fn none(hmm: &Hmm) -> Self {
        let states = hmm.states.len();
        let of = |mixture: &Mixture| ComponentCounts {
            frames: vec![0.0; mixture.weight.len()],
            first: vec![0.0; mixture.mean.values().len()],
            second: vec![0.0; mixture.mean.values().len()],
        };
        Self {
            log_likelihood: 0.0,
            start: vec![0.0; states],
            transition: vec![0.0; states * states],
            states: hmm.states.iter().map(of).collect(),
        }
    }

    fn add(&mut self, other: &Self) {
        let add = |own: &mut [f64], other: &[f64]| {
            own.iter_mut().zip(other).for_each(|(own, other)| *own += other);
        };
        self.log_likelihood += other.log_likelihood;
        add(&mut self.start, &other.start);
        add(&mut self.transition, &other.transition);
        for (own, other) in self.states.iter_mut().zip(&other.states) {
            add(&mut own.frames, &other.frames);
            add(&mut own.first, &other.first);
            add(&mut own.second, &other.second);
        }
    }

    /// Expected transitions (Rabiner's xi, eq. 37). Forward and what follows are scaled by their
    /// highest, unless the product of what was taken off might be large where both are small.
    fn add_transitions(&mut self, hmm: &Hmm, lattice: &Lattice, emissions: &Emissions) {
        let states = hmm.states.len();
        let log_transition = logs(hmm.transition.values());
        let (mut from, mut to) = (vec![0.0; states], vec![0.0; states]);
        for f in 0..lattice.scale.len().saturating_sub(1) {
            let (now, next) = (f * states..(f + 1) * states, (f + 1) * states..(f + 2) * states);
            from.copy_from_slice(&lattice.forward[now]);
            let after = lattice.backward[next.clone()].iter().zip(&emissions.taken[next]);
            to.iter_mut().zip(after).for_each(|(to, (beta, b))| {
                *to = beta + b - lattice.scale[f + 1];
            });
            let (high_from, high_to) = (highest_value(&from), highest_value(&to));
            let rows = self.transition.chunks_exact_mut(states);
            if high_from + high_to > LARGE {
                for ((row, logs), from) in rows.zip(log_transition.chunks_exact(states)).zip(&from)
                {
                    for ((count, a), to) in row.iter_mut().zip(logs).zip(&to) {
                        *count += libm::exp(from + a + to);
                    }
                }
                continue;
            }
            let both = libm::exp(high_from + high_to);
            from.iter_mut().for_each(|v| *v -= high_from);
            exp_all(&mut from);
            from.iter_mut().for_each(|v| *v *= both);
            to.iter_mut().for_each(|v| *v -= high_to);
            exp_all(&mut to);
            for ((row, own), from) in rows.zip(hmm.transition.iter()).zip(&from) {
                for ((count, a), to) in row.iter_mut().zip(own).zip(&to) {
                    *count += from * a * to;
                }
            }
        }
    }
}

/// Terms that vanish when scaled are below 1e-308 e^LARGE = 1e-134 frames.
const LARGE: f64 = 400.0;

impl ComponentCounts {
    /// Expected frames of each component (eq. 54), and sums about the old means.
    fn add_frames<'g>(
        &mut self,
        mixture: &Mixture,
        sequence: &Rows,
        gamma: impl Iterator<Item = &'g f64>,
    ) {
        let density = mixture.density();
        let width = sequence.width();
        let mut components = vec![0.0; mixture.weight.len()];
        for (row, &gamma) in sequence.iter().zip(gamma) {
            if gamma == 0.0 {
                continue;
            }
            density.components(row, &mut components);
            softmax(&mut components);
            for (m, share) in components.iter().enumerate() {
                let frames = gamma * share;
                if frames == 0.0 {
                    continue;
                }
                self.frames[m] += frames;
                let own = m * width..(m + 1) * width;
                let (first, second) = (&mut self.first[own.clone()], &mut self.second[own]);
                add_distances(frames, row, mixture.mean.row(m), first, second);
            }
        }
    }
}

widest! {
    /// Add a row's distances from a mean and their squares, that many times.
    fn add_distances(
        frames: f64,
        row: &[f64],
        mean: &[f64],
        first: &mut [f64],
        second: &mut [f64]
    ) {
        let n = row.len();
        let (mean, first, second) = (&mean[..n], &mut first[..n], &mut second[..n]);
        for k in 0..n {
            let away = row[k] - mean[k];
            first[k] += frames * away;
            second[k] += frames * away * away;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Beginning, Topology};
    use mimique_test_support::Random;

    /// Two states that stay 20 frames, at -1 and 1.
    fn sequences() -> Vec<Rows> {
        let mut random = Random::new(17);
        let mut one = |frames: usize| {
            let values = (0..frames).flat_map(|f| {
                let side = if f / 20 % 2 == 0 { -1.0 } else { 1.0 };
                [side + 0.2 * random.normal(), 0.5 * side + 0.2 * random.normal()]
            });
            Rows::new(values.collect(), 2).unwrap()
        };
        vec![one(200), one(160), one(120)]
    }

    fn begin(sequences: &[Rows]) -> Hmm {
        Beginning { topology: Topology::Ergodic, states: 2, components: 1, stay: 0.9 }
            .hmm(sequences, 1e-4)
            .unwrap()
    }

    #[test]
    fn a_planted_model_is_found_and_the_likelihood_never_falls() {
        let sequences = sequences();
        let options = BaumWelch { steps: 15, tolerance: 0.0, ..BaumWelch::default() };
        let learnt = options.learn(&begin(&sequences), &sequences).unwrap();
        assert_eq!(learnt.log_likelihood.len(), 16);
        assert!(learnt.log_likelihood.windows(2).all(|w| w[1] >= w[0] - 1e-9));
        let mut sides: Vec<f64> = learnt.hmm.states.iter().map(|s| s.mean.row(0)[0]).collect();
        sides.sort_by(f64::total_cmp);
        assert!((sides[0] + 1.0).abs() < 0.05 && (sides[1] - 1.0).abs() < 0.05, "{sides:?}");
        for state in 0..2 {
            assert!((learnt.hmm.transition.row(state)[state] - 0.95).abs() < 0.02);
            let variance = learnt.hmm.states[state].variance.row(0)[0];
            assert!((variance - 0.04).abs() < 0.015, "{variance}");
        }
        assert!(learnt.starved.is_empty());
    }

    #[test]
    fn threads_do_not_matter_and_the_tolerance_ends_the_steps() {
        let sequences = sequences();
        let start = begin(&sequences);
        let options = BaumWelch { steps: 40, tolerance: 1e-9, ..BaumWelch::default() };
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| options.learn(&start, &sequences).unwrap())
        };
        assert_eq!(on(1), on(3));
        assert!(on(1).log_likelihood.len() < 41);
    }

    #[test]
    fn what_cannot_be_learnt_is_refused() {
        let sequences = sequences();
        let start = begin(&sequences);
        let none = BaumWelch::default().learn(&start, &[]).unwrap_err();
        assert!(matches!(none, AnnotateError::Count { what: "sequences", .. }));
        let closed = Rows::new(vec![0.0; 4], 2).unwrap();
        let hmm = Hmm { transition: closed, ..start };
        let error = BaumWelch::default().learn(&hmm, &sequences).unwrap_err();
        assert_eq!(error, AnnotateError::Impossible { sequence: 0 });
    }
}
