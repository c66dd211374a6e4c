//! Hidden Markov models, one a label, learnt from the stretches of each and joined into one.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{AnnotatedTake, HmmOptions, Isolation};
use crate::hmm::{Isolated, isolated};
use crate::{
    AnnotateError, BaumWelch, Beginning, Composite, Hmm, Learnt, Mark, Marked, Rows, Topology,
};

/// What one of the joined models learns from: stretches of a label; in the short paper's reading the
/// peaks of a label's takes, or what is neutral in these.
struct Class {
    label: usize,
    /// The label whose takes the neutral stretches are from.
    neutral_of: Option<usize>,
    sequences: Vec<Rows>,
}

/// How one of the joined models was learnt.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct LearntLabel {
    /// Index of its label.
    pub label: usize,
    /// Of a model of the neutral face in takes of one expression: the index of that expression.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub neutral_of: Option<usize>,
    /// ln of the density of its sequences, before each step and after the last.
    pub log_likelihood: Vec<f64>,
    /// Components that had too few frames at the last step: state, component.
    pub starved: Vec<(usize, usize)>,
}

/// A model a class, joined; and how each was learnt.
pub(super) fn joined(
    options: &HmmOptions,
    takes: &[&AnnotatedTake],
    labels: usize,
) -> Result<(Composite, Vec<LearntLabel>), AnnotateError> {
    crate::error::above_zero("mean stay in seconds", options.mean_stay_s)?;
    crate::error::above_zero("temper", options.temper)?;
    let rate_hz = takes.first().map_or(1.0, |annotated| annotated.take.rate_hz);
    let stay = libm::exp(-1.0 / (options.mean_stay_s * rate_hz));
    let classes = match &options.isolation {
        Some(isolation) => isolated_classes(isolation, &options.learning, takes, labels, stay)?,
        None => classes_of_labels(takes, labels),
    };
    let HmmOptions { topology, states, components, .. } = *options;
    let beginning = Beginning { topology, states, components, stay };
    let learn = |class: &Class| -> Result<Learnt, AnnotateError> {
        // A chain is not gone through in fewer frames than states.
        let least = if topology == Topology::LeftRight { states } else { 1 };
        let own: Vec<Rows> = class.sequences.iter().filter(|s| s.len() >= least).cloned().collect();
        if own.is_empty() {
            return Err(AnnotateError::NoExamples { label: class.label });
        }
        let begin = beginning.hmm(&own, options.learning.variance_floor)?;
        options.learning.learn(&begin, &own)
    };
    let learnt: Vec<Learnt> =
        classes.par_iter().map(learn).collect::<Result<_, AnnotateError>>()?;
    let models: Vec<Hmm> = learnt.iter().map(|learnt| learnt.hmm.clone()).collect();
    let p_out = Composite::p_out(options.mean_stay_s, rate_hz);
    let names: Vec<usize> = classes.iter().map(|class| class.label).collect();
    let joined =
        Composite::join(&models, p_out)?.labelled(names, labels)?.tempered(options.temper)?;
    let report = classes.iter().zip(learnt).map(|(class, learnt)| LearntLabel {
        label: class.label,
        neutral_of: class.neutral_of,
        log_likelihood: learnt.log_likelihood,
        starved: learnt.starved,
    });
    Ok((joined, report.collect()))
}

/// The annotators' stretches of each label; labels without any are no class.
fn classes_of_labels(takes: &[&AnnotatedTake], labels: usize) -> Vec<Class> {
    let of = |label: usize| {
        let own = takes.iter().flat_map(|annotated| {
            let own = annotated.marked.iter().filter(move |m| m.mark == Mark::Stable(label));
            own.map(|marked| annotated.take.weights.select(marked.frames.clone()))
        });
        Class { label, neutral_of: None, sequences: own.collect() }
    };
    (0..labels).map(of).filter(|class| !class.sequences.is_empty()).collect()
}

/// The one label beside the neutral that a take shows.
fn only_expression(annotated: &AnnotatedTake, neutral: usize) -> Option<usize> {
    let stable = annotated.marked.iter().filter_map(|Marked { mark, .. }| match *mark {
        Mark::Stable(label) if label != neutral => Some(label),
        _ => None,
    });
    let mut labels: Vec<usize> = stable.collect();
    labels.dedup();
    match labels[..] {
        [label] => Some(label),
        _ => None,
    }
}

/// Peaks and neutral stretches of the takes of one expression, a class each (short paper, 2.3).
fn isolated_classes(
    isolation: &Isolation,
    learning: &BaumWelch,
    takes: &[&AnnotatedTake],
    labels: usize,
    stay: f64,
) -> Result<Vec<Class>, AnnotateError> {
    let neutral = isolation.neutral;
    let own: Vec<(usize, &AnnotatedTake)> =
        takes.iter().filter_map(|take| Some((only_expression(take, neutral)?, *take))).collect();
    let cut = |(_, annotated): &(usize, &AnnotatedTake)| -> Result<Isolated, AnnotateError> {
        let marked = annotated.marked.iter().filter(|m| m.mark == Mark::Stable(neutral));
        let frames: Vec<usize> = marked.flat_map(|marked| marked.frames.clone()).collect();
        isolated(&annotated.take, &frames, isolation.components, learning, stay)
    };
    let cuts: Vec<Isolated> = own.par_iter().map(cut).collect::<Result<_, AnnotateError>>()?;
    let mut classes = Vec::new();
    for label in (0..labels).filter(|label| *label != neutral) {
        let of = |found: fn(&Isolated) -> &[std::ops::Range<usize>]| -> Vec<Rows> {
            let here = own.iter().zip(&cuts).filter(|((own, _), _)| *own == label);
            let rows = here.flat_map(|((_, annotated), cut)| {
                found(cut).iter().map(|frames| annotated.take.weights.select(frames.clone()))
            });
            rows.collect()
        };
        let (peaks, rest) = (of(|cut| &cut.peaks), of(|cut| &cut.neutral));
        if !peaks.is_empty() {
            classes.push(Class { label, neutral_of: None, sequences: peaks });
            classes.push(Class { label: neutral, neutral_of: Some(label), sequences: rest });
        }
    }
    classes.retain(|class| !class.sequences.is_empty());
    if classes.is_empty() { Err(AnnotateError::NoneIsolated) } else { Ok(classes) }
}
