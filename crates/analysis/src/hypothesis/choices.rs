//! Hypotheses about choices between two clips.

use mimique_stats::Labelled;
use mimique_study::{Hypothesis, Study};

use super::{ClipScope, HypothesisResult, Read, deciding_p, not_tested, with_words};
use crate::choices::preference::preference;
use crate::choices::{answers, reading, tested};
use crate::hypothesis::not_tested::NotTested;
use crate::hypothesis::other_clips::{self, OtherClipsTests};
use crate::hypothesis::reading::other_clips as words_of_clips;
use crate::hypothesis::trial_level::TrialLevel;
use crate::naming::Naming;
use crate::trials::export::Export;
use crate::trials::measure::MeasureKind;

/// Tests a hypothesis about choices between two clips.
pub(super) fn of_choices(
    naming: &Naming<'_>,
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    clips: OtherClipsTests,
) -> HypothesisResult {
    let language = naming.language;
    let asked = study.questions.iter().find(|question| question.id == hypothesis.response);
    let label = asked.map_or(hypothesis.response.as_str(), |question| {
        question.prompt.in_language(language.code())
    });
    let factor = hypothesis.factors.first().map_or("", String::as_str);
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    let order = naming.level_order(factor);
    let (mut preferred, mut other_clips) = (None, None);
    let read = match answers::with_segments(export, &hypothesis.response, factor, &order, &levels) {
        None if export.answers_to(&hypothesis.response).is_empty() => {
            let response = hypothesis.response.clone();
            not_tested(language, &NotTested::NoAnswers { response })
        }
        None => not_tested(language, &NotTested::TooFewLevels { factor: factor.to_owned() }),
        Some((data, segment)) => {
            let found = tested::tested(&hypothesis.response, factor, &data, 0);
            let mut reading = reading::choices(naming, &found, factor, label);
            preferred = preference(&found);
            let decides = hypothesis.is_about_other_clips();
            other_clips = other_clips::of_choices(&data, &segment, decides, clips);
            if let Some(found) = &other_clips {
                let factors = &hypothesis.factors[..1];
                let words = words_of_clips(naming, found, MeasureKind::Choice, factors);
                reading = with_words(language, &words, &reading, found.decides);
            }
            let tests = found.as_in_the_thesis.tests;
            Read { trials: tests, people: found.recommended, equivalence: None, reading }
        }
    };
    HypothesisResult {
        id: hypothesis.id.clone(),
        statement: hypothesis.statement.in_language(language.code()).to_owned(),
        test: hypothesis.test,
        measure: hypothesis.response.clone(),
        kind: MeasureKind::Choice,
        factors: hypothesis.factors.clone(),
        scope: match &other_clips {
            Some(found) if found.decides => ClipScope::Others,
            _ => ClipScope::These,
        },
        as_in_the_thesis: TrialLevel::new(read.trials),
        p: match &other_clips {
            Some(found) if found.decides => found.p(),
            _ => deciding_p(&read.people),
        },
        recommended: read.people,
        other_clips,
        equivalence: None,
        preference: preferred,
        matching: None,
        answer_distributions: Vec::new(),
        trials_without_level: 0,
        people_by_condition: Labelled::default(),
        p_holm_over_hypotheses: None,
        p_difference_holm_over_hypotheses: None,
        reading: read.reading,
    }
}
