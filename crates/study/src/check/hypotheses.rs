//! Hypotheses: that the test fits the response and the factors that it names.

use std::collections::BTreeSet;

use super::issue::{Issues, below};
use super::nearest::suggestion;
use super::{Subject, assigned, responses};
use crate::responses::ASSIGNED_CONDITION;
use crate::study_file::{Hypothesis, Measure, Question, QuestionKind, TestName};

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    let hypotheses = &subject.study.hypotheses;
    for (index, hypothesis) in hypotheses.iter().enumerate() {
        let pointer = below("/hypotheses", index);
        if hypotheses[..index].iter().any(|each| each.id == hypothesis.id) {
            let message = format!("two hypotheses \"{}\"", hypothesis.id);
            issues.error(below(&pointer, "id"), "duplicate", message, "give it another name");
        }
        response(subject, hypothesis, &pointer, issues);
        assigned::hypothesis(subject, hypothesis, &pointer, issues);
        factors(subject, hypothesis, &pointer, issues);
        levels(subject, hypothesis, &pointer, issues);
    }
}

fn response(subject: &Subject<'_>, hypothesis: &Hypothesis, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "response");
    let of_conditions = hypothesis.factors.iter().any(|factor| factor == ASSIGNED_CONDITION);
    let response = hypothesis.response.as_str();
    let Some(question) = responses::tested(subject, response, place, of_conditions, issues) else {
        return;
    };
    let has_truth =
        matches!(&question.kind, QuestionKind::SingleChoice(choice) if choice.truth.is_some());
    if hypothesis.measure == Measure::Correct && !has_truth {
        let message = format!("\"{}\" has no right answer", question.id);
        let hint = "give the question \"truth\", or test another measure";
        issues.error(below(pointer, "measure"), "no-truth", message, hint);
    }
    let wants_numbers = !matches!(hypothesis.test, TestName::ChiSquare);
    if hypothesis.measure == Measure::Answer && wants_numbers && !is_number(question) {
        let message = format!("the answers to \"{}\" are not numbers", question.id);
        let hint = "test \"measure\": \"correct\" or \"rt\", or take chi-square";
        issues.error(below(pointer, "response"), "not-a-number", message, hint);
    }
}

/// Whether the answers are numbers: of a matrix those whose options are, of a ranking the places.
fn is_number(question: &Question) -> bool {
    match &question.kind {
        QuestionKind::Likert(_)
        | QuestionKind::Slider(_)
        | QuestionKind::Number(_)
        | QuestionKind::ValenceArousal(_)
        | QuestionKind::Ranking(_) => true,
        QuestionKind::Matrix(matrix) => {
            matrix.options.iter().all(|option| option.value.parse::<f64>().is_ok())
        }
        _ => false,
    }
}

/// What an analysis can group by.
pub(super) fn factor_names(subject: &Subject<'_>) -> BTreeSet<String> {
    let mut names: BTreeSet<String> = subject.study.factor_names().into_iter().collect();
    // People differ by what they say of themselves.
    names.extend(
        subject.study.demographics.iter().flat_map(|page| &page.questions).map(|q| q.id.clone()),
    );
    names.extend(["avatar", "segment"].map(str::to_owned));
    if !subject.study.conditions().is_empty() {
        names.insert(ASSIGNED_CONDITION.to_owned());
    }
    names
}

fn factors(subject: &Subject<'_>, hypothesis: &Hypothesis, pointer: &str, issues: &mut Issues) {
    let place = below(pointer, "factors");
    let wanted = match hypothesis.test {
        TestName::ScheirerRayHare => 2..=2,
        TestName::AlignedRankTransform => 2..=3,
        _ => 1..=1,
    };
    if !wanted.contains(&hypothesis.factors.len()) {
        let message = format!("{} factors for this test", hypothesis.factors.len());
        let hint = if wanted.start() == wanted.end() {
            format!("name {}", wanted.start())
        } else {
            format!("name {} to {}", wanted.start(), wanted.end())
        };
        issues.error(&place, "wrong-length", message, hint);
    }
    for (index, factor) in hypothesis.factors.iter().enumerate() {
        assigned::factor(subject, factor, below(&place, index), issues);
    }
}

fn levels(subject: &Subject<'_>, hypothesis: &Hypothesis, pointer: &str, issues: &mut Issues) {
    let Some(factor) = hypothesis.factors.first() else { return };
    let assigned = factor == ASSIGNED_CONDITION;
    let values: BTreeSet<String> = match assigned {
        true => subject.study.conditions().into_iter().map(str::to_owned).collect(),
        false => subject.clips.iter().filter_map(|clip| clip.factor_text(factor)).collect(),
    };
    if values.is_empty() {
        return;
    }
    let known: Vec<&str> = values.iter().map(String::as_str).collect();
    let place = below(pointer, "levels");
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    for (index, level) in levels.iter().enumerate() {
        let place = below(&place, index);
        if !known.contains(&level.as_str()) {
            let message = match assigned {
                true => format!("there is no condition \"{level}\""),
                false => format!("no clip has {factor} \"{level}\""),
            };
            issues.error(place, "unknown-reference", message, suggestion(level, &known));
        } else if levels[..index].contains(level) {
            let message = format!("the level \"{level}\" stands here twice");
            issues.error(place, "duplicate", message, "name each level once");
        }
    }
    let count = if levels.is_empty() { values.len() } else { levels.len() };
    let two = matches!(hypothesis.test, TestName::Wilcoxon | TestName::MannWhitney);
    if (two && count != 2) || count < 2 {
        let message = format!("{count} levels of \"{factor}\" to compare");
        let hint = if two { "name two in \"levels\"" } else { "compare at least two" };
        issues.error(place, "wrong-length", message, hint);
    }
}
