//! What the answers of a study can be: scales, factors and their levels.

use std::collections::BTreeMap;

use mimique_stats::Factor;
use mimique_study::columns::ASSIGNED_CONDITION;
use mimique_study::{Clip, KindOfQuestion as _, Scale, Study};

/// Every scale of the study by its response, in the order of the file.
pub(crate) fn all_scales(study: &Study) -> Vec<(String, Scale)> {
    study
        .all_questions()
        .filter_map(|question| Some((question, question.kind.scale()?)))
        .flat_map(|(question, scale)| {
            question.response_ids().into_iter().map(move |id| (id, scale))
        })
        .collect()
}

/// The segment of each clip, by its place among the segments in the order of their first clips.
pub(crate) fn segment_places(clips: &[Clip]) -> Vec<usize> {
    let mut names: Vec<&str> = Vec::new();
    clips
        .iter()
        .map(|clip| {
            names.iter().position(|name| *name == clip.segment).unwrap_or_else(|| {
                names.push(&clip.segment);
                names.len() - 1
            })
        })
        .collect()
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
        .map(|question| (question.id.clone(), question.kind.few_answers()))
        .filter(|(_, levels)| !levels.is_empty())
        .chain(assigned.then_some((ASSIGNED_CONDITION.to_owned(), conditions)))
        .collect()
}
