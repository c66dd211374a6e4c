//! Whether an answer fits its question, and whether a question is asked at all.

use serde_json::Value;

use crate::event::Answers;
use crate::study_file::{Choice, Condition, Question, QuestionKind};

/// Why an answer cannot be taken.
#[derive(Debug, Clone, PartialEq)]
pub enum AnswerProblem {
    /// A required answer is missing.
    Missing,
    /// The answer has the wrong shape, or names an option that is not there.
    NotAnOption,
    /// Not a number.
    NotANumber,
    /// Not a whole number.
    NotWhole,
    /// Below the minimum.
    TooLow(f64),
    /// Above the maximum.
    TooHigh(f64),
    /// More characters than this.
    TooLong(usize),
    /// Fewer choices than this.
    TooFew(usize),
    /// More choices than this.
    TooMany(usize),
    /// A row, or a place in the ranking, is missing.
    Incomplete,
}

/// Most characters of a line of text, if the study does not say.
pub const SHORT_TEXT: usize = 200;
/// Most characters of several lines of text, if the study does not say.
pub const LONG_TEXT: usize = 5_000;

impl Question {
    /// Whether the page may go on with this answer (`None`: none given).
    pub fn accept(&self, answer: Option<&Value>) -> Result<(), AnswerProblem> {
        let empty = match answer {
            None | Some(Value::Null) => true,
            Some(Value::String(text)) => text.trim().is_empty(),
            Some(Value::Array(items)) => items.is_empty(),
            Some(Value::Object(map)) => map.is_empty(),
            Some(_) => false,
        };
        match answer {
            Some(value) if !empty => self.kind.accept(value),
            _ if self.required => Err(AnswerProblem::Missing),
            _ => Ok(()),
        }
    }

    /// Whether it is asked, given the answers of this page and, behind them, of earlier ones.
    pub fn is_shown(&self, page: &Answers, earlier: &Answers) -> bool {
        self.show_if.as_ref().is_none_or(|condition| {
            let answer = page.get(&condition.question).or_else(|| earlier.get(&condition.question));
            condition.holds(answer)
        })
    }
}

impl Condition {
    /// Whether it holds for this answer; an answer that is not there fits no condition.
    pub fn holds(&self, answer: Option<&Value>) -> bool {
        let Some(answer) = answer.filter(|value| !value.is_null()) else { return false };
        let among = |wanted: &Value| match answer {
            Value::Array(chosen) => chosen.iter().any(|each| alike(each, wanted)),
            single => alike(single, wanted),
        };
        self.equals.as_ref().is_none_or(|wanted| alike(answer, wanted))
            && (self.one_of.is_empty() || self.one_of.iter().any(among))
            && self.at_least.is_none_or(|least| answer.as_f64().is_some_and(|n| n >= least))
            && self.at_most.is_none_or(|most| answer.as_f64().is_some_and(|n| n <= most))
    }
}

/// Equal as answers: 3 and 3.0 are the same.
pub(crate) fn alike(left: &Value, right: &Value) -> bool {
    match (left.as_f64(), right.as_f64()) {
        (Some(left), Some(right)) => left == right,
        _ => left == right,
    }
}

impl QuestionKind {
    fn accept(&self, value: &Value) -> Result<(), AnswerProblem> {
        match self {
            Self::SingleChoice(question) => one_of(&question.options, value),
            Self::MultipleChoice(question) => {
                let chosen = several_of(&question.options, value)?;
                let fewest = question.minimum.unwrap_or(0);
                let most = question.maximum.unwrap_or(usize::MAX);
                if chosen < fewest {
                    Err(AnswerProblem::TooFew(fewest))
                } else if chosen > most {
                    Err(AnswerProblem::TooMany(most))
                } else {
                    Ok(())
                }
            }
            Self::Likert(scale) => {
                let number = value.as_i64().ok_or(AnswerProblem::NotAnOption)?;
                if (scale.start..=scale.end()).contains(&number) {
                    Ok(())
                } else {
                    Err(AnswerProblem::NotAnOption)
                }
            }
            Self::Slider(slider) => within(value, Some(slider.minimum), Some(slider.maximum)),
            Self::Number(field) => {
                within(value, field.minimum, field.maximum)?;
                if field.integer && value.as_f64().is_some_and(|number| number.fract() != 0.0) {
                    Err(AnswerProblem::NotWhole)
                } else {
                    Ok(())
                }
            }
            Self::ShortText(field) => no_longer(value, field.max_length.unwrap_or(SHORT_TEXT)),
            Self::LongText(field) => no_longer(value, field.max_length.unwrap_or(LONG_TEXT)),
            Self::Matrix(matrix) => {
                let map = value.as_object().ok_or(AnswerProblem::NotAnOption)?;
                for (row, chosen) in map {
                    if !matrix.rows.iter().any(|each| each.value == *row) {
                        return Err(AnswerProblem::NotAnOption);
                    }
                    one_of(&matrix.options, chosen)?;
                }
                if map.len() < matrix.rows.len() {
                    return Err(AnswerProblem::Incomplete);
                }
                Ok(())
            }
            Self::Ranking(ranking) => {
                if several_of(&ranking.options, value)? < ranking.options.len() {
                    return Err(AnswerProblem::Incomplete);
                }
                Ok(())
            }
            Self::Comparison(comparison) => match value.as_str() {
                Some("left" | "right") => Ok(()),
                Some("same") if comparison.allow_same => Ok(()),
                _ => Err(AnswerProblem::NotAnOption),
            },
            Self::ValenceArousal(grid) => {
                for axis in ["valence", "arousal"] {
                    let number = value.get(axis).and_then(Value::as_i64);
                    let number = number.ok_or(AnswerProblem::Incomplete)?;
                    if !(1..=i64::from(grid.num_items)).contains(&number) {
                        return Err(AnswerProblem::NotAnOption);
                    }
                }
                Ok(())
            }
        }
    }
}

fn one_of(options: &[Choice], value: &Value) -> Result<(), AnswerProblem> {
    let known = value.as_str().is_some_and(|word| options.iter().any(|each| each.value == word));
    if known { Ok(()) } else { Err(AnswerProblem::NotAnOption) }
}

/// How many different options are chosen.
fn several_of(options: &[Choice], value: &Value) -> Result<usize, AnswerProblem> {
    let chosen = value.as_array().ok_or(AnswerProblem::NotAnOption)?;
    for (index, each) in chosen.iter().enumerate() {
        one_of(options, each)?;
        if chosen[..index].contains(each) {
            return Err(AnswerProblem::NotAnOption);
        }
    }
    Ok(chosen.len())
}

fn within(value: &Value, minimum: Option<f64>, maximum: Option<f64>) -> Result<(), AnswerProblem> {
    let number = value.as_f64().ok_or(AnswerProblem::NotANumber)?;
    match (minimum, maximum) {
        (Some(least), _) if number < least => Err(AnswerProblem::TooLow(least)),
        (_, Some(most)) if number > most => Err(AnswerProblem::TooHigh(most)),
        _ => Ok(()),
    }
}

fn no_longer(value: &Value, most: usize) -> Result<(), AnswerProblem> {
    let text = value.as_str().ok_or(AnswerProblem::NotAnOption)?;
    if text.chars().count() > most { Err(AnswerProblem::TooLong(most)) } else { Ok(()) }
}
