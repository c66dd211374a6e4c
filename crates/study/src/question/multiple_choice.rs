//! Any of several options: check boxes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::kind::{KindOfQuestion, Summary, labels, pick};
use super::simulation::Simulated;
use super::view::{QuestionKindView, Showing};
use super::{Choice, OptionOrder, accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::{Issues, Problem};

/// Any of several. The answer is an array of values in the order of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct MultipleChoice {
    /// The options.
    pub options: Vec<Choice>,
    /// In which order they are shown.
    #[serde(default)]
    pub option_order: OptionOrder,
    /// Fewest that must be chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum: Option<usize>,
    /// Most that may be chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum: Option<usize>,
}

impl KindOfQuestion for MultipleChoice {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::options(&self.options, place, "options", 1, issues);
        let options = self.options.len();
        let (least, most) = (self.minimum.unwrap_or(0), self.maximum.unwrap_or(options));
        if least > most || most > options {
            issues.error(place, Problem::ChoiceCount { least, most, options });
        }
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        let chosen = accepting::several_of(&self.options, answer)?;
        match (self.minimum, self.maximum) {
            (Some(fewest), _) if chosen < fewest => Err(AnswerProblem::TooFew(fewest)),
            (_, Some(most)) if chosen > most => Err(AnswerProblem::TooMany(most)),
            _ => Ok(()),
        }
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        QuestionKindView::MultipleChoice { options: showing.options(), maximum: self.maximum }
    }

    fn described(&self, language: &str) -> String {
        let options = labels(&self.options, language);
        pick(language, format!("any of {options}"), format!("plusieurs choix parmi {options}"))
    }

    fn simulated(&self) -> Simulated<'_> {
        let most = self.maximum.unwrap_or(self.options.len());
        Simulated::SeveralOptions { fewest: self.minimum, most }
    }

    fn options(&self) -> &[Choice] {
        &self.options
    }

    fn option_order(&self) -> OptionOrder {
        self.option_order
    }

    fn takes_several(&self) -> bool {
        true
    }

    fn summary(&self) -> Summary {
        Summary::Options
    }
}
