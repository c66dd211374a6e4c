//! How far people agree about clips: intraclass correlation and Krippendorff's alpha of each rating; and whether the
//! questions of a scale measure one thing: Cronbach's alpha.

pub(crate) mod answers;
mod section;

use mimique_stats::{
    AlphaEstimate, Cronbach, Factor, IntraclassCorrelation, MeasurementLevel, Numbers, Outcome,
    Refusal, Undefined, UnitValues, cronbach, intraclass_correlation, krippendorff,
};
use mimique_study::{CompositeScale, Question, Study};
use serde::Serialize;

use crate::trials::asked_question::AskedQuestion;
use crate::trials::export::Export;
use crate::trials::measure::Measure;

/// Draws of clips for the interval of Krippendorff's alpha.
const ROUNDS: usize = 1000;
/// Their seed: the same answers give the same interval.
const SEED: u64 = 1;

/// Agreement about the answers to one question.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Agreement {
    pub response: String,
    /// Of ratings alone: names have no mean.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub icc: Option<Outcome<IntraclassCorrelation>>,
    /// Level of measurement that the question has.
    pub level: MeasurementLevel,
    pub krippendorff: Outcome<AlphaEstimate>,
    /// Clips with two answers or more, of all.
    pub clips: [usize; 2],
    /// Answers to a clip that its person had answered before: the first one counts for alpha.
    pub repeated: usize,
}

/// Whether the questions of a scale measure one thing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ScaleConsistency {
    pub scale: String,
    pub items: Vec<String>,
    pub reversed: Vec<String>,
    /// Whether the items are asked in trials, so that a person's answers to one are averaged.
    pub of_means: bool,
    pub cronbach: Outcome<Cronbach>,
}

/// Agreement about a question that is answered by numbers, or by a choice with a right answer.
pub(crate) fn agreement(
    export: &Export,
    asked: &AskedQuestion<'_>,
    measure: &Measure,
) -> Agreement {
    let recognition = asked.is_recognition();
    let level = match (recognition, asked.scale()) {
        (true, _) => MeasurementLevel::Nominal,
        (false, Some(_)) => MeasurementLevel::Ordinal,
        (false, None) => MeasurementLevel::Interval,
    };
    let first = answers::first_answers(export, &asked.id);
    let (clips, krippendorff) = alpha(&first, level);
    let icc =
        (!recognition).then(|| or_why(intraclass_correlation(&answers::by_clip(export, measure))));
    Agreement {
        response: asked.id.clone(),
        icc,
        level,
        krippendorff,
        clips,
        repeated: first.repeated,
    }
}

/// Krippendorff's alpha of the first answer of each person to each clip, and clips with two answers or more, of all.
fn alpha(
    first: &answers::FirstAnswers<'_>,
    level: MeasurementLevel,
) -> ([usize; 2], Outcome<AlphaEstimate>) {
    let factor = |name: &str, cells: &[&str]| {
        Factor::from_cells(name, cells.iter().map(|cell| Some(*cell)), |cell| cell.parse().ok())
    };
    let units = UnitValues::of(
        &factor("clip", &first.clips),
        &factor("participant", &first.people),
        &factor("answer", &first.given),
    );
    let found = units.and_then(|units| krippendorff(&units, &[level], ROUNDS, SEED));
    match found {
        Err(refusal) => ([0, 0], undefined(refusal)),
        Ok(found) => {
            let alpha = found.levels.0.into_iter().next().map(|(_, alpha)| alpha);
            let none = || Outcome::undefined(mimique_stats::NoEstimate::NoDisagreementPossible);
            ([found.units_with_two_or_more, found.units], alpha.unwrap_or_else(none))
        }
    }
}

/// Cronbach's alpha of each scale of the study, one row a person.
pub(crate) fn consistencies(export: &Export, study: &Study) -> Vec<ScaleConsistency> {
    study.scales.iter().map(|(name, scale)| consistency(export, study, name, scale)).collect()
}

fn consistency(
    export: &Export,
    study: &Study,
    name: &str,
    scale: &CompositeScale,
) -> ScaleConsistency {
    let of_means = scale.items.iter().any(|item| !export.answers_to(item).is_empty());
    let columns: Vec<Numbers> = scale
        .items
        .iter()
        .map(|item| {
            let mut values = answers::of_people(export, item);
            if scale.reversed.contains(item)
                && let Some([low, high]) = asked(study, item).and_then(Study::answer_range)
            {
                values.iter_mut().for_each(|value| *value = low + high - *value);
            }
            Numbers { name: item.clone(), values }
        })
        .collect();
    ScaleConsistency {
        scale: name.to_owned(),
        items: scale.items.clone(),
        reversed: scale.reversed.clone(),
        of_means,
        cronbach: or_why(cronbach(&columns, None)),
    }
}

/// The question that gives an answer of this name.
fn asked<'s>(study: &'s Study, response: &str) -> Option<&'s Question> {
    study.all_questions().find(|question| question.response_ids().iter().any(|id| id == response))
}

fn or_why<T>(found: Result<Outcome<T>, Refusal>) -> Outcome<T> {
    found.unwrap_or_else(undefined)
}

fn undefined<T>(refusal: Refusal) -> Outcome<T> {
    Outcome::undefined(Undefined::from(refusal))
}
