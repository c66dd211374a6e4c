//! Blocks of reverse correlation: units that are drawn from, how they move, and the questions that tell categories and
//! intensity.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::sequence::read_block;
use super::{Subject, compared};
use crate::columns::{TRAJECTORIES_COLUMN, WEIGHTS_EXPECTED_COLUMN};
use crate::question::{KindOfQuestion as _, Question, QuestionKind};
use crate::study_file::{Component, ReverseCorrelationBlock, ReverseCorrelationComponent};

/// Most trials of a block: more than anybody answers in a day.
const MOST_TRIALS: f64 = 5000.0;
/// Longest clip, seconds.
const LONGEST_S: f64 = 60.0;

pub(super) fn examine(
    subject: &Subject<'_>,
    block: &ReverseCorrelationBlock,
    pointer: &str,
    issues: &mut Issues,
) {
    let Some(block) = read_block(block.read(), pointer, issues) else { return };
    let before = issues.count();
    let mut range = |key: &str, value: f64, unit, least: f64, most: f64| {
        if !(least..=most).contains(&value) {
            let problem = Problem::OutOfRange { value, unit, least, most };
            issues.error(below(pointer, key), problem);
        }
    };
    range("trials", f64::from(block.trials), "trials", 1.0, MOST_TRIALS);
    range("durationSeconds", block.duration_seconds, "s", 0.2, LONGEST_S);
    units(&block, pointer, issues);
    if issues.count() == before
        && let Err(error) = block.design().check()
    {
        issues.error(pointer, Problem::NoTrajectories { what: error.to_string() });
    }
    avatar(subject, &block, pointer, issues);
    questions(subject, &block, pointer, issues);
    let columns = [TRAJECTORIES_COLUMN, WEIGHTS_EXPECTED_COLUMN];
    compared::columns(subject, &columns, pointer, issues);
}

/// The avatar is there, and drawn.
fn avatar(
    subject: &Subject<'_>,
    block: &ReverseCorrelationComponent,
    pointer: &str,
    issues: &mut Issues,
) {
    let avatars = &subject.study.stimuli.avatars;
    match (subject.study.avatar_of_faces(block), &block.avatar) {
        (Some((_, avatar)), _) => {
            if !avatar.videos.is_empty() {
                issues.error(pointer, Problem::FacesOfVideos);
            }
        }
        (None, Some(named)) => {
            let problem = Problem::unknown("avatar", named, avatars.keys());
            issues.error(below(pointer, "avatar"), problem);
        }
        (None, None) => issues.error(pointer, Problem::MissingKey { key: "avatar".to_owned() }),
    }
}

/// Every unit has a name of FACS.
fn units(block: &ReverseCorrelationComponent, pointer: &str, issues: &mut Issues) {
    let list = below(pointer, "units");
    for (index, unit) in block.units.iter().enumerate() {
        if !is_unit(unit) {
            issues.error(below(&list, index), Problem::NoActionUnit { unit: unit.clone() });
        } else if block.units[..index].contains(unit) {
            issues.error(below(&list, index), Problem::NamedTwice { name: unit.clone() });
        }
    }
}

/// `AU04`, of one side `AU04_L`: whether an avatar shows it is known once the avatar is read.
fn is_unit(name: &str) -> bool {
    let number = name.strip_suffix("_L").or_else(|| name.strip_suffix("_R")).unwrap_or(name);
    number.strip_prefix("AU").is_some_and(|digits| {
        digits.len() == 2 && digits.bytes().all(|digit| digit.is_ascii_digit())
    })
}

fn questions(
    subject: &Subject<'_>,
    block: &ReverseCorrelationComponent,
    pointer: &str,
    issues: &mut Issues,
) {
    let is_own = |component: &Component| matches!(component, Component::ReverseCorrelation(_));
    let place = below(pointer, "question");
    if let Some(question) = shared(subject, &block.question, &place, issues) {
        let is_choice = matches!(question.kind, QuestionKind::SingleChoice(_));
        let is_whole = question.required && question.show_if.is_none();
        let is_plain = question.kind.truth().is_none() && question.attention_check.is_none();
        if !(is_choice && is_whole && is_plain) {
            issues.error(&place, Problem::NoCategories { question: question.id.clone() });
        }
        asked_elsewhere(subject, question, is_own, &place, issues);
    }
    let Some(intensity) = &block.intensity else { return };
    let place = below(pointer, "intensity");
    if let Some(question) = shared(subject, intensity, &place, issues) {
        let is_scale = match &question.kind {
            QuestionKind::Likert(_) => true,
            QuestionKind::Slider(line) => !line.while_playing,
            _ => false,
        };
        if !is_scale || question.attention_check.is_some() {
            issues.error(&place, Problem::NoIntensity { question: question.id.clone() });
        }
        asked_elsewhere(subject, question, is_own, &place, issues);
    }
}

/// One of the study's questions.
pub(super) fn shared<'s>(
    subject: &Subject<'s>,
    id: &str,
    place: &str,
    issues: &mut Issues,
) -> Option<&'s Question> {
    let all = &subject.study.questions;
    let found = all.iter().find(|each| each.id == id);
    if found.is_none() {
        let known = all.iter().map(|each| &each.id);
        issues.error(place, Problem::unknown("question", id, known));
    }
    found
}

/// Answers of blocks of one type are not mixed with those of others.
pub(super) fn asked_elsewhere(
    subject: &Subject<'_>,
    question: &Question,
    is_own: impl Fn(&Component) -> bool,
    place: &str,
    issues: &mut Issues,
) {
    let is_asked = |(name, component): (&String, &Component)| {
        !is_own(component)
            && subject.study.questions_of(name).iter().any(|asked| asked.id == question.id)
    };
    if let Some((name, _)) = subject.study.components.iter().find(|each| is_asked(*each)) {
        let (question, component) = (question.id.clone(), name.clone());
        issues.error(place, Problem::AskedOfClipsToo { question, component });
    }
}
