//! Learning a model from annotated takes.

use super::classifier::{Classifier, LearntLabel, Material};
use super::{LearntFrom, LearntTake, Method, Model, VERSION};
use crate::evaluate::leave_out;
use crate::features::thinned;
use crate::labels::check;
use crate::{AnnotateError, Examples, Mark, Marked, Rows, Take, Temperature};

/// An annotated take.
#[derive(Debug, Clone, PartialEq)]
pub struct AnnotatedTake {
    /// Its name.
    pub name: String,
    /// Whose face it is.
    pub person: String,
    /// Its weights, the model's shapes in the model's order.
    pub take: Take,
    /// What the annotator has marked, in order of time. Frames without a mark are unlabelled.
    pub marked: Vec<Marked>,
}

/// What is learnt, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Lesson {
    /// Names of the labels, by index.
    pub labels: Vec<String>,
    /// Names of the shapes, by column.
    pub shapes: Vec<String>,
    /// The method.
    pub method: Method,
    /// Training frames a second: more say the same again. Sequences are not thinned.
    pub thinned_to_hz: f64,
}

impl Lesson {
    /// Learn a model. Its temperature is 1 until [`Lesson::temperature`] is asked.
    ///
    /// # Errors
    /// [`AnnotateError`]: takes of other rates or widths, intervals beyond a take, labels beyond the
    /// list, one label alone, and what the method refuses.
    pub fn learn(&self, takes: &[AnnotatedTake]) -> Result<Model, AnnotateError> {
        let all: Vec<&AnnotatedTake> = takes.iter().collect();
        let material = self.material(&all)?;
        let (classifier, hmm) = Classifier::learn(&self.method, &material)?;
        Ok(Model {
            version: VERSION,
            labels: self.labels.clone(),
            shapes: self.shapes.clone(),
            rate_hz: material.rate_hz,
            settings: self.method,
            temperature: Temperature::default(),
            learnt_from: self.learnt_from(takes, hmm),
            classifier,
        })
    }

    /// The temperature from held-out takes: each group of takes (their own names, persons) is scored
    /// by a model that has not seen it, and the temperature fits all these scores together.
    ///
    /// # Errors
    /// As [`Lesson::learn`]; [`AnnotateError::Count`] for fewer than two groups.
    pub fn temperature<G: Ord>(
        &self,
        takes: &[AnnotatedTake],
        groups: &[G],
    ) -> Result<Temperature, AnnotateError> {
        crate::error::as_many("groups of takes", groups.len(), takes.len())?;
        let (mut scores, mut truth) = (Vec::new(), Vec::new());
        for fold in leave_out(groups)? {
            let train: Vec<&AnnotatedTake> = fold.train.iter().map(|&take| &takes[take]).collect();
            let (classifier, _) = Classifier::learn(&self.method, &self.material(&train)?)?;
            for take in fold.test.iter().map(|&take| &takes[take]) {
                let (frames, labels) = self.stable_frames(take)?;
                if frames.is_empty() {
                    continue;
                }
                // Scored as the take is labelled: sequences as a whole.
                let found = classifier.scores(&take.take.weights)?;
                scores.extend_from_slice(found.select(frames).values());
                truth.extend(labels);
            }
        }
        Temperature::fit(&Rows::new(scores, self.labels.len())?, &truth)
    }

    /// Refuses a label that stands in fewer than two takes: what is learnt of it cannot be held
    /// against a take that has not been seen.
    ///
    /// # Errors
    /// [`AnnotateError::FewTakes`] with the first such label.
    pub fn check_takes(&self, takes: &[AnnotatedTake]) -> Result<(), AnnotateError> {
        for label in 0..self.labels.len() {
            let own = |marked: &Marked| marked.mark == Mark::Stable(label);
            let found = takes.iter().filter(|take| take.marked.iter().any(own)).count();
            if found < 2 {
                return Err(AnnotateError::FewTakes { label, takes: found });
            }
        }
        Ok(())
    }

    /// Thinned frames with a stable label, and those labels.
    fn stable_frames(
        &self,
        annotated: &AnnotatedTake,
    ) -> Result<(Vec<usize>, Vec<usize>), AnnotateError> {
        let AnnotatedTake { take, marked, .. } = annotated;
        check(marked, take.frames())?;
        let (mut frames, mut labels) = (Vec::new(), Vec::new());
        for (row, Marked { frames: own, mark }) in marked.iter().enumerate() {
            let Mark::Stable(label) = *mark else { continue };
            if label >= self.labels.len() {
                return Err(AnnotateError::Label { row, label, labels: self.labels.len() });
            }
            let own: Vec<usize> = own.clone().collect();
            let own = thinned(&own, take.rate_hz, self.thinned_to_hz);
            labels.extend(std::iter::repeat_n(label, own.len()));
            frames.extend(own);
        }
        Ok((frames, labels))
    }

    fn material(&self, takes: &[&AnnotatedTake]) -> Result<Material, AnnotateError> {
        crate::error::at_most("labels", self.labels.len(), 64)?;
        crate::error::above_zero("thinned to Hz", self.thinned_to_hz)?;
        let Some(first) = takes.first() else {
            return Err(AnnotateError::Count { what: "takes", found: 0, expected: 1 });
        };
        let (width, rate_hz) = (self.shapes.len(), first.take.rate_hz);
        let (mut values, mut labels) = (Vec::new(), Vec::new());
        let mut sequences = vec![Vec::new(); self.labels.len()];
        for annotated in takes {
            let take = &annotated.take;
            crate::error::as_many("shapes of a take", take.weights.width(), width)?;
            if take.rate_hz != rate_hz {
                return Err(AnnotateError::Rate { found: take.rate_hz, expected: rate_hz });
            }
            let (frames, own) = self.stable_frames(annotated)?;
            values.extend_from_slice(take.weights.select(frames).values());
            labels.extend(own);
            for Marked { frames, mark } in &annotated.marked {
                if let Mark::Stable(label) = *mark {
                    sequences[label].push(take.weights.select(frames.clone()));
                }
            }
        }
        let examples = Examples::new(Rows::new(values, width)?, labels, self.labels.len())?;
        Ok(Material { examples, sequences, rate_hz })
    }

    fn learnt_from(&self, takes: &[AnnotatedTake], hmm: Vec<LearntLabel>) -> LearntFrom {
        let mut seconds = vec![0.0; self.labels.len()];
        for annotated in takes {
            for Marked { frames, mark } in &annotated.marked {
                if let Mark::Stable(label) = *mark {
                    seconds[label] += frames.len() as f64 / annotated.take.rate_hz;
                }
            }
        }
        let take =
            |a: &AnnotatedTake| LearntTake { name: a.name.clone(), person: a.person.clone() };
        LearntFrom { takes: takes.iter().map(take).collect(), seconds, hmm }
    }
}
