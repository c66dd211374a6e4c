//! Learning a model from annotated takes.

use mimique_clip::weights_hash;

use super::classifier::{Classifier, Material};
use super::{Decoding, LearntFrom, LearntLabel, LearntTake, Method, Model};
use crate::evaluate::{folds, leave_out};
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
    /// What was performed: posed expressions, sentences.
    pub kind: String,
    /// Its weights, the model's shapes in the model's order.
    pub take: Take,
    /// What the annotator has marked, in order of time. Frames without a mark are unlabelled.
    pub marked: Vec<Marked>,
}

impl AnnotatedTake {
    /// Whether some frames have this label.
    pub fn shows(&self, label: usize) -> bool {
        self.marked.iter().any(|marked| marked.mark == Mark::Stable(label))
    }

    /// What a model says of a take that it learnt from.
    pub fn learnt(&self) -> LearntTake {
        LearntTake {
            name: self.name.clone(),
            person: self.person.clone(),
            kind: self.kind.clone(),
            weights: weights_hash(self.take.weights.values()),
        }
    }
}

/// What is learnt, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Lesson {
    /// What the labels are of: the name of the annotators' tier.
    pub channel: String,
    /// Names of the labels, by index.
    pub labels: Vec<String>,
    /// Names of the shapes, by column.
    pub shapes: Vec<String>,
    /// The method.
    pub method: Method,
    /// Training frames a second: more say the same again; all where none is given. Sequences are
    /// never thinned.
    pub thinned_to_hz: Option<f64>,
    /// How a model's labels of frames become segments where nothing else is asked for.
    pub decoding: Decoding,
}

/// Groups of takes that are held out in turn for the temperature.
const HELD_OUT: usize = 5;
/// Seed of those groups, where there are more takes.
const SEED: u64 = 1;

impl Lesson {
    /// Learn a model. Its temperature is 1.
    ///
    /// # Errors
    /// [`AnnotateError`]: takes of other rates or widths, intervals beyond a take, labels beyond the
    /// list, one label alone, and what the method refuses.
    pub fn learn(&self, takes: &[AnnotatedTake]) -> Result<Model, AnnotateError> {
        let all: Vec<&AnnotatedTake> = takes.iter().collect();
        self.learn_of(&all)
    }

    /// Learn a model, and its temperature from takes held out: each take in turn, or, where there are
    /// more than five, each of five groups. What is learnt without a group scores it, and the
    /// temperature fits all these scores together. It is 1 where nothing can be held out.
    ///
    /// # Errors
    /// As [`Lesson::learn`].
    pub fn learn_calibrated(&self, takes: &[AnnotatedTake]) -> Result<Model, AnnotateError> {
        let all: Vec<&AnnotatedTake> = takes.iter().collect();
        self.learn_calibrated_of(&all)
    }

    pub(crate) fn learn_calibrated_of(
        &self,
        takes: &[&AnnotatedTake],
    ) -> Result<Model, AnnotateError> {
        let mut model = self.learn_of(takes)?;
        (model.temperature, model.learnt_from.held_out) = self.temperature(takes)?;
        Ok(model)
    }

    pub(crate) fn learn_of(&self, takes: &[&AnnotatedTake]) -> Result<Model, AnnotateError> {
        let (classifier, hmm) = self.classifier(takes)?;
        Ok(Model {
            channel: self.channel.clone(),
            labels: self.labels.clone(),
            shapes: self.shapes.clone(),
            rate_hz: takes[0].take.rate_hz,
            settings: self.method,
            thinned_to_hz: self.thinned_to_hz,
            decoding: self.decoding.clone(),
            temperature: Temperature::default(),
            holds_frames: classifier.holds_frames(),
            learnt_from: self.learnt_from(takes, hmm),
            classifier,
        })
    }

    /// The temperature, and how many takes were held out for it. Groups without which a label has
    /// nothing left to be learnt from stay in.
    fn temperature(&self, takes: &[&AnnotatedTake]) -> Result<(Temperature, usize), AnnotateError> {
        let numbers: Vec<usize> = (0..takes.len()).collect();
        let groups = match takes.len() {
            0 | 1 => return Ok((Temperature::default(), 0)),
            2..=HELD_OUT => leave_out(&numbers)?,
            _ => folds(takes.len(), HELD_OUT, SEED)?,
        };
        let (mut scores, mut truth) = (Vec::new(), Vec::new());
        let mut held_out = 0;
        for fold in groups {
            let train: Vec<&AnnotatedTake> = fold.train.iter().map(|&take| takes[take]).collect();
            let (classifier, _) = match self.classifier(&train) {
                Err(
                    AnnotateError::OneLabel { .. }
                    | AnnotateError::NoExamples { .. }
                    | AnnotateError::NoneIsolated,
                ) => continue,
                learnt => learnt?,
            };
            for take in fold.test.iter().map(|&take| takes[take]) {
                let (frames, labels) = self.stable_frames(take)?;
                if frames.is_empty() {
                    continue;
                }
                // Scored as the take is labelled: sequences as a whole.
                let found = classifier.scores(&take.take.weights)?;
                scores.extend_from_slice(found.select(frames).values());
                truth.extend(labels);
                held_out += 1;
            }
        }
        if truth.is_empty() {
            return Ok((Temperature::default(), 0));
        }
        Ok((Temperature::fit(&Rows::new(scores, self.labels.len())?, &truth)?, held_out))
    }

    /// Refuses a label that stands in fewer than two takes: what is learnt of it cannot be held
    /// against a take that has not been seen.
    ///
    /// # Errors
    /// [`AnnotateError::FewTakes`] with the first such label.
    pub fn check_takes(&self, takes: &[AnnotatedTake]) -> Result<(), AnnotateError> {
        for label in 0..self.labels.len() {
            let found = takes.iter().filter(|take| take.shows(label)).count();
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
            let own = match self.thinned_to_hz {
                Some(rate_hz) => thinned(&own, take.rate_hz, rate_hz),
                None => own,
            };
            labels.extend(std::iter::repeat_n(label, own.len()));
            frames.extend(own);
        }
        Ok((frames, labels))
    }

    /// What the method learns of some takes.
    fn classifier(
        &self,
        takes: &[&AnnotatedTake],
    ) -> Result<(Classifier, Vec<LearntLabel>), AnnotateError> {
        crate::error::at_most("labels", self.labels.len(), 64)?;
        if let Some(rate_hz) = self.thinned_to_hz {
            crate::error::above_zero("training frames per second", rate_hz)?;
        }
        let Some(first) = takes.first() else {
            return Err(AnnotateError::Count { what: "takes", found: 0, expected: 1 });
        };
        let (width, rate_hz) = (self.shapes.len(), first.take.rate_hz);
        let (mut values, mut labels) = (Vec::new(), Vec::new());
        for annotated in takes {
            let take = &annotated.take;
            crate::error::as_many("shapes of a take", take.weights.width(), width)?;
            crate::error::same_rate(take.rate_hz, rate_hz)?;
            let (frames, own) = self.stable_frames(annotated)?;
            values.extend_from_slice(take.weights.select(frames).values());
            labels.extend(own);
        }
        let examples = Examples::new(Rows::new(values, width)?, labels, self.labels.len())?;
        Classifier::learn(&self.method, &Material { examples, takes })
    }

    fn learnt_from(&self, takes: &[&AnnotatedTake], hmm: Vec<LearntLabel>) -> LearntFrom {
        let mut seconds = vec![0.0; self.labels.len()];
        for annotated in takes {
            for Marked { frames, mark } in &annotated.marked {
                if let Mark::Stable(label) = *mark {
                    seconds[label] += frames.len() as f64 / annotated.take.rate_hz;
                }
            }
        }
        let takes = takes.iter().map(|annotated| annotated.learnt()).collect();
        LearntFrom { takes, seconds, held_out: 0, hmm }
    }
}
