//! One of several options: radio buttons. With `truth`, a forced choice.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::kind::{KindOfQuestion, Summary, labels, pick};
use super::simulation::Simulated;
use super::view::{QuestionKindView, Showing};
use super::{Choice, OptionOrder, accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::Issues;

/// One of several. The answer is the option's value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct SingleChoice {
    /// The options, two at least.
    pub options: Vec<Choice>,
    /// In which order they are shown.
    #[serde(default)]
    pub option_order: OptionOrder,
    /// The factor of the clip that holds the right answer (`expression`); the export then has
    /// `truth` and `correct`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub truth: Option<String>,
}

impl KindOfQuestion for SingleChoice {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::options(&self.options, place, "options", 2, issues);
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        accepting::one_of(&self.options, answer)
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        QuestionKindView::SingleChoice { options: showing.options() }
    }

    fn described(&self, language: &str) -> String {
        let options = labels(&self.options, language);
        match &self.truth {
            Some(truth) => pick(
                language,
                format!("forced choice of {options}; right is the clip’s `{truth}`"),
                format!(
                    "choix forcé parmi {options} ; la bonne réponse est `{truth}` de l’extrait"
                ),
            ),
            None => {
                pick(language, format!("one of {options}"), format!("un choix parmi {options}"))
            }
        }
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::OneOption
    }

    fn options(&self) -> &[Choice] {
        &self.options
    }

    fn option_order(&self) -> OptionOrder {
        self.option_order
    }

    fn truth(&self) -> Option<&str> {
        self.truth.as_deref()
    }

    fn levels(&self) -> &[Choice] {
        &self.options
    }

    fn few_answers(&self) -> Vec<String> {
        self.options.iter().map(|option| option.value.clone()).collect()
    }

    fn summary(&self) -> Summary {
        Summary::Options
    }
}
