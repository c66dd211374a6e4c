//! Blocks of reverse correlation in the report: which action units at which times go with which answer.

mod figure;
mod played;
mod section;

use std::collections::HashMap;

use mimique_adaptive::Trajectory;
use mimique_stats::{
    ReverseCorrelation, ReverseCorrelationOptions, ReverseTrial, ReverseTrials, UnitImage,
    reverse_correlation,
};
use mimique_study::{KindOfQuestion as _, ReverseCorrelationComponent, ShownCourse, Study};
use serde::Serialize;

use crate::trials::export::{Export, ShownFace};

/// Time bins of an image.
pub(crate) const BINS: usize = 30;
/// Draws of the permutation test.
pub(crate) const PERMUTATIONS: usize = 1000;

/// A corrected p up to which a cell is called significant.
const LEVEL: f64 = 0.05;

/// Whether a unit is significantly more often there.
pub(crate) fn is_present(unit: &UnitImage) -> bool {
    unit.presence.p <= LEVEL && unit.presence.z > 0.0
}

/// The images of a block.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct BlockImages {
    /// Name of the component.
    pub block: String,
    /// Its question.
    #[serde(skip)]
    pub question: String,
    /// Duration of a clip, seconds.
    #[serde(skip)]
    pub duration_s: f64,
    /// Trials left out because the weights that were shown are not those that the seed gives.
    pub not_replayed: usize,
    /// What the answers give.
    #[serde(flatten)]
    pub images: ReverseCorrelation,
}

/// The images of a block; none where all answers are of one category.
pub(crate) struct FoundImages {
    pub block: String,
    pub found: Option<BlockImages>,
}

/// The images of every block of reverse correlation whose question was answered, tested by so many permutations.
pub(crate) fn images(export: &Export, study: &Study, permutations: usize) -> Vec<FoundImages> {
    let of = |(name, block): (&str, ReverseCorrelationComponent)| {
        let (trials, not_replayed) = trials(export, study, name, &block);
        let options = ReverseCorrelationOptions {
            bins: BINS,
            duration_s: block.duration_seconds,
            permutations,
            seed: study.seed,
        };
        let is_there = !trials.trials.is_empty() || not_replayed > 0;
        is_there.then(|| FoundImages {
            block: name.to_owned(),
            found: reverse_correlation(&trials, options).ok().map(|images| BlockImages {
                block: name.to_owned(),
                question: block.question.clone(),
                duration_s: block.duration_seconds,
                not_replayed,
                images,
            }),
        })
    };
    study.reverse_correlations().filter_map(of).collect()
}

/// The trials of a block, and how many were left out because they cannot be drawn again.
fn trials(
    export: &Export,
    study: &Study,
    name: &str,
    block: &ReverseCorrelationComponent,
) -> (ReverseTrials, usize) {
    let intensities: HashMap<usize, f64> = block
        .intensity
        .iter()
        .flat_map(|question| export.answers_to(question))
        .filter_map(|answer| Some((answer.trial, answer.number?)))
        .collect();
    let options = study.questions.iter().find(|question| question.id == block.question);
    let options = options.map_or(&[][..], |question| question.kind.options());
    let mut found = ReverseTrials {
        people: Vec::new(),
        categories: options.iter().map(|option| option.value.clone()).collect(),
        units: block.units.clone(),
        trials: Vec::new(),
        dropped: 0,
        answer_column: block.question.clone(),
    };
    let mut places: HashMap<usize, usize> = HashMap::new();
    let mut not_replayed = 0;
    for answer in export.answers_to(&block.question) {
        let face = export.trials[answer.trial].face.as_ref();
        let Some(ShownFace { courses, replayed, .. }) = face.filter(|face| &*face.block == name)
        else {
            continue;
        };
        let category = found.categories.iter().position(|own| **own == *answer.text);
        let Some(category) = category else { continue };
        if !replayed {
            not_replayed += 1;
            continue;
        }
        let person = *places.entry(answer.person).or_insert_with(|| {
            found.people.push(export.people[answer.person].id.clone());
            found.people.len() - 1
        });
        found.trials.push(ReverseTrial {
            person,
            answer: category,
            intensity: intensities.get(&answer.trial).copied(),
            courses: courses.iter().filter_map(|course| trajectory(course, block)).collect(),
        });
    }
    (found, not_replayed)
}

/// A course by the place of its unit; none of a unit that this version of the study does not draw.
fn trajectory(course: &ShownCourse, block: &ReverseCorrelationComponent) -> Option<Trajectory> {
    Some(Trajectory {
        unit: block.units.iter().position(|unit| *unit == course.unit)?,
        onset_s: course.onset_s,
        peak_s: course.peak_s,
        offset_s: course.offset_s,
        amplitude: course.amplitude,
        acceleration: course.acceleration,
        deceleration: course.deceleration,
    })
}
