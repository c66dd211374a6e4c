//! Whether an answer fits its question, and whether a question is asked at all.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::question::{Condition, KindOfQuestion as _, Question};

/// Answers by question identifier.
pub type Answers = BTreeMap<String, Value>;

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
pub fn alike(left: &Value, right: &Value) -> bool {
    match (left.as_f64(), right.as_f64()) {
        (Some(left), Some(right)) => left == right,
        _ => left == right,
    }
}
