//! Whether an answer fits: what several kinds of questions ask.

use serde_json::Value;

use super::Choice;
use crate::answer::AnswerProblem;

/// One of the options.
pub(super) fn one_of(options: &[Choice], value: &Value) -> Result<(), AnswerProblem> {
    let known = value.as_str().is_some_and(|word| options.iter().any(|each| each.value == word));
    if known { Ok(()) } else { Err(AnswerProblem::NotAnOption) }
}

/// How many different options are chosen.
pub(super) fn several_of(options: &[Choice], value: &Value) -> Result<usize, AnswerProblem> {
    let chosen = value.as_array().ok_or(AnswerProblem::NotAnOption)?;
    for (index, each) in chosen.iter().enumerate() {
        one_of(options, each)?;
        if chosen[..index].contains(each) {
            return Err(AnswerProblem::NotAnOption);
        }
    }
    Ok(chosen.len())
}

/// A number that is not outside of its bounds.
pub(super) fn within(
    value: &Value,
    minimum: Option<f64>,
    maximum: Option<f64>,
) -> Result<(), AnswerProblem> {
    let number = value.as_f64().ok_or(AnswerProblem::NotANumber)?;
    match (minimum, maximum) {
        (Some(least), _) if number < least => Err(AnswerProblem::TooLow(least)),
        (_, Some(most)) if number > most => Err(AnswerProblem::TooHigh(most)),
        _ => Ok(()),
    }
}

/// A text of at most so many characters.
pub(super) fn no_longer(value: &Value, most: usize) -> Result<(), AnswerProblem> {
    let text = value.as_str().ok_or(AnswerProblem::NotAnOption)?;
    if text.chars().count() > most { Err(AnswerProblem::TooLong(most)) } else { Ok(()) }
}
