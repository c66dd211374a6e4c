//! One model of several: a hidden Markov model a label, joined (short paper, eq. 6-8).
//!
//! With K models, p_out the probability that a frame leaves its model:
//! - start of state j of model k: its start / K (6);
//! - from state i to state j of the same model: (1 - p_out) a_ij; to state j of another model:
//!   p_out / (K - 1) times the start of j, which the printed (7) leaves out;
//! - emissions as they are (8).

use serde::{Deserialize, Serialize};

use super::Hmm;
use crate::{AnnotateError, Rows};

/// Models joined, a class each; the states of the first come first. Several classes may have one label.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Composite {
    hmm: Hmm,
    class_of_state: Vec<usize>,
    label_of_class: Vec<usize>,
    labels: usize,
    temper: f64,
}

impl Composite {
    /// Join a model a class; each class is its own label.
    ///
    /// # Errors
    /// [`AnnotateError::Count`] without models or with other widths, [`AnnotateError::Setting`] for
    /// a `p_out` outside 0 to 1.
    pub fn join(models: &[Hmm], p_out: f64) -> Result<Self, AnnotateError> {
        if !(0.0..=1.0).contains(&p_out) {
            let range = "from 0 to 1";
            return Err(AnnotateError::Setting { setting: "p_out", value: p_out, range });
        }
        if models.is_empty() {
            return Err(AnnotateError::Count { what: "models", found: 0, expected: 1 });
        }
        let count = models.len() as f64;
        let start: Vec<f64> =
            models.iter().flat_map(|m| m.start.iter().map(|s| s / count)).collect();
        let states = start.len();
        let mut transition = Vec::with_capacity(states * states);
        for (from, model) in models.iter().enumerate() {
            for own in model.transition.iter() {
                for (to, other) in models.iter().enumerate() {
                    match (from == to, models.len()) {
                        // Nowhere else to go.
                        (true, 1) => transition.extend_from_slice(own),
                        (true, _) => transition.extend(own.iter().map(|a| (1.0 - p_out) * a)),
                        (false, _) => {
                            let leave = p_out / (count - 1.0);
                            transition.extend(other.start.iter().map(|s| leave * s));
                        }
                    }
                }
            }
        }
        let mixtures = models.iter().flat_map(|m| m.states.iter().cloned()).collect();
        let classes = models.iter().enumerate();
        let class_of_state = classes.flat_map(|(k, m)| m.states.iter().map(move |_| k)).collect();
        let hmm = Hmm::new(start, Rows::new(transition, states)?, mixtures)?;
        let labels = models.len();
        let label_of_class = (0..labels).collect();
        Ok(Self { hmm, class_of_state, label_of_class, labels, temper: 1.0 })
    }

    /// The same with a label for each class, an index below `labels`; a label may have several classes
    /// or none.
    ///
    /// # Errors
    /// [`AnnotateError::Count`], [`AnnotateError::Label`].
    pub fn labelled(self, of_class: Vec<usize>, labels: usize) -> Result<Self, AnnotateError> {
        crate::error::as_many("labels of classes", of_class.len(), self.label_of_class.len())?;
        if let Some(row) = of_class.iter().position(|&label| label >= labels) {
            return Err(AnnotateError::Label { row, label: of_class[row], labels });
        }
        Ok(Self { label_of_class: of_class, labels, ..self })
    }

    /// The same with the logarithms of its emissions times a factor.
    ///
    /// # Errors
    /// [`AnnotateError::Setting`] for a factor that is not above 0.
    pub fn tempered(self, temper: f64) -> Result<Self, AnnotateError> {
        crate::error::above_zero("temper", temper)?;
        Ok(Self { temper, ..self })
    }

    /// The probability of leaving a model at a frame, of a mean stay in seconds:
    /// 1 - exp(-1 / (stay rate)).
    pub fn p_out(mean_stay_s: f64, rate_hz: f64) -> f64 {
        -libm::expm1(-1.0 / (mean_stay_s * rate_hz))
    }

    /// The joined model.
    pub fn hmm(&self) -> &Hmm {
        &self.hmm
    }

    /// Class of each state.
    pub fn class_of_state(&self) -> &[usize] {
        &self.class_of_state
    }

    /// How many labels there are.
    pub fn labels(&self) -> usize {
        self.labels
    }

    fn label_of_state(&self, state: usize) -> usize {
        self.label_of_class[self.class_of_state[state]]
    }

    /// The label of every frame on the most probable path.
    ///
    /// # Errors
    /// As [`Hmm::best_path`].
    pub fn path(&self, sequence: &Rows) -> Result<Vec<usize>, AnnotateError> {
        let path = self.hmm.path_through(self.hmm.tempered(sequence, self.temper)?)?;
        Ok(path.states.into_iter().map(|state| self.label_of_state(state)).collect())
    }

    /// Probability of each label at every frame: a frame a row.
    ///
    /// # Errors
    /// As [`Hmm::posterior`].
    pub fn posterior(&self, sequence: &Rows) -> Result<Rows, AnnotateError> {
        let states = self.hmm.posterior_of(&self.hmm.tempered(sequence, self.temper)?)?.states;
        let mut sums = vec![0.0; sequence.len() * self.labels];
        for (sum, row) in sums.chunks_exact_mut(self.labels).zip(states.iter()) {
            row.iter().enumerate().for_each(|(state, p)| sum[self.label_of_state(state)] += p);
        }
        Rows::new(sums, self.labels)
    }

    /// Whether what was read is a model of that many labels.
    pub(crate) fn fits(&self, labels: usize) -> bool {
        let states = self.class_of_state.len() == self.hmm.states.len();
        let classes = self.class_of_state.iter().all(|&class| class < self.label_of_class.len());
        let named = self.label_of_class.iter().all(|&label| label < labels);
        let temper = self.temper > 0.0 && self.temper.is_finite();
        self.labels == labels && states && classes && named && temper
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mixture::Mixture;

    #[test]
    fn one_model_stays_itself_and_p_out_is_checked() {
        let row = |v: f64| Rows::new(vec![v], 1).unwrap();
        let state = Mixture::new(vec![1.0], row(0.0), row(1.0)).unwrap();
        let hmm = Hmm::new(vec![1.0], row(1.0), vec![state]).unwrap();
        let joined = Composite::join(std::slice::from_ref(&hmm), 0.3).unwrap();
        assert_eq!(joined.hmm(), &hmm);
        assert!(Composite::join(std::slice::from_ref(&hmm), 1.5).is_err());
        assert!(Composite::join(&[], 0.1).is_err());
        let joined = Composite::join(&[hmm.clone(), hmm.clone(), hmm], 0.2).unwrap();
        assert!(
            joined.hmm().transition().iter().all(|r| (r.iter().sum::<f64>() - 1.0).abs() < 1e-12)
        );
        assert!((Composite::p_out(0.5, 200.0) - 0.00995016625).abs() < 1e-10);
    }

    #[test]
    fn classes_of_one_label_are_one_and_temper_softens() {
        let row = |v: f64| Rows::new(vec![v], 1).unwrap();
        let model = |mean: f64| {
            let state = Mixture::new(vec![1.0], row(mean), row(1.0)).unwrap();
            Hmm::new(vec![1.0], row(1.0), vec![state]).unwrap()
        };
        let joined = Composite::join(&[model(0.0), model(4.0), model(0.5)], 0.1).unwrap();
        let two = joined.clone().labelled(vec![1, 0, 1], 2).unwrap();
        let sequence = Rows::new(vec![0.2, 0.3, 4.1, 3.9, 0.4], 1).unwrap();
        assert_eq!(two.path(&sequence).unwrap(), [1, 1, 0, 0, 1]);
        let (whole, parts) =
            (two.posterior(&sequence).unwrap(), joined.posterior(&sequence).unwrap());
        for (sum, own) in whole.iter().zip(parts.iter()) {
            assert!((sum[1] - own[0] - own[2]).abs() < 1e-15 && (sum[0] - own[1]).abs() < 1e-15);
        }
        let soft = two.clone().tempered(0.1).unwrap().posterior(&sequence).unwrap();
        assert!(soft.row(2)[0] < whole.row(2)[0]);
        assert!(two.clone().labelled(vec![0, 2, 0], 2).is_err() && two.tempered(0.0).is_err());
    }
}
