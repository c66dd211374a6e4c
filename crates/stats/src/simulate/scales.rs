//! What the answers of a study can be: scales, factors and their levels.

use std::collections::BTreeMap;

use mimique_study::responses::ASSIGNED_CONDITION;
use mimique_study::{Clip, Question, QuestionKind, Study};

use crate::factor::Factor;

/// A scale: `points` values from `start`, `step` apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    pub start: f64,
    pub step: f64,
    pub points: usize,
}

impl Scale {
    /// The value of a point, from 0.
    pub(crate) fn value(&self, point: usize) -> f64 {
        self.start + self.step * point as f64
    }

    /// From the lowest to the highest value.
    pub(crate) fn span(&self) -> f64 {
        self.step * (self.points.max(1) - 1) as f64
    }

    /// The borders half-way between neighbouring values.
    pub(crate) fn borders(&self) -> Vec<f64> {
        (1..self.points).map(|point| self.value(point) - self.step / 2.0).collect()
    }
}

/// The scales of a question: one, or two of a grid, each with its suffix in the export.
pub(crate) fn scales_of(question: &Question) -> Vec<(&'static str, Scale)> {
    match &question.kind {
        QuestionKind::Likert(likert) => {
            let start = likert.start as f64;
            vec![("", Scale { start, step: 1.0, points: likert.num_items as usize })]
        }
        QuestionKind::Slider(slider) => {
            let step = if slider.step > 0.0 { slider.step } else { 1.0 };
            let points = ((slider.maximum - slider.minimum) / step + 1e-9).floor().max(0.0);
            vec![("", Scale { start: slider.minimum, step, points: points as usize + 1 })]
        }
        QuestionKind::ValenceArousal(grid) => {
            let scale = Scale { start: 1.0, step: 1.0, points: grid.num_items as usize };
            vec![(".valence", scale), (".arousal", scale)]
        }
        _ => Vec::new(),
    }
}

/// Every scale of the study by its response, in the order of the file.
pub(crate) fn all_scales(study: &Study) -> Vec<(String, Scale)> {
    study
        .all_questions()
        .flat_map(|question| {
            scales_of(question)
                .into_iter()
                .map(|(suffix, scale)| (format!("{}{suffix}", question.id), scale))
        })
        .collect()
}

/// The factor that holds the right answer of a question, if it is asked in trials.
pub(crate) fn truth_of(question: &Question) -> Option<&str> {
    match &question.kind {
        QuestionKind::SingleChoice(choice) => choice.truth.as_deref(),
        _ => None,
    }
}

/// The levels of each factor of the clips, of each question about the participant that has few answers,
/// and of the assigned condition, in the order of the analysis.
pub(crate) fn factor_levels(study: &Study, clips: &[Clip]) -> BTreeMap<String, Vec<String>> {
    let mut levels = BTreeMap::new();
    for name in study.factor_names() {
        let cells: Vec<Option<String>> = clips.iter().map(|clip| clip.factor_text(&name)).collect();
        let cells = cells.iter().map(Option::as_deref);
        let factor = Factor::from_cells(&name, cells, |level| level.parse().ok());
        levels.insert(name, factor.levels);
    }
    for (name, values) in traits(study) {
        levels.entry(name).or_insert(values);
    }
    levels
}

/// What can be a factor between participants: questions about the participant with their answers, and the
/// assigned condition with the study's conditions.
pub(crate) fn traits(study: &Study) -> BTreeMap<String, Vec<String>> {
    let questions = study.demographics.iter().flat_map(|page| &page.questions);
    let conditions: Vec<String> = study.conditions().into_iter().map(str::to_owned).collect();
    let assigned = !conditions.is_empty();
    questions
        .filter_map(|question| {
            let levels: Vec<String> = match &question.kind {
                QuestionKind::SingleChoice(choice) => {
                    choice.options.iter().map(|option| option.value.clone()).collect()
                }
                QuestionKind::Likert(likert) => {
                    (likert.start..=likert.end()).map(|value| value.to_string()).collect()
                }
                _ => return None,
            };
            Some((question.id.clone(), levels))
        })
        .chain(assigned.then_some((ASSIGNED_CONDITION.to_owned(), conditions)))
        .collect()
}
