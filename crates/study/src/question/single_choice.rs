//! One of several options: radio buttons. With `truth`, a forced choice; with `keys`, a speeded one, answered while the
//! clip plays.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::kind::{KindOfQuestion, Summary, labels, pick};
use super::simulation::Simulated;
use super::view::{ChoiceView, QuestionKindView, Showing};
use super::{Choice, OptionOrder, accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::{Issues, Problem, below};

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
    /// With `truth`: another of the study's `questions`, a rating (`likert` or `slider`) that says how sure the answer is
    /// and is asked in the same trials, higher is surer. The report then has the ROC curve of each option.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence: Option<String>,
    /// The key of each option, by its value: a letter, a digit, or `Space`. The first press from the clip's first frame
    /// on is the answer, and no other is taken. One option may be without: it is the answer where the clip has ended
    /// and nothing was pressed.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub keys: BTreeMap<String, String>,
}

/// The name of the space bar among [`SingleChoice::keys`].
pub const SPACE_KEY: &str = "Space";

impl SingleChoice {
    /// Every key is one that keyboards have and stands for one option; at most one option has none.
    fn check_keys(&self, place: &str, issues: &mut Issues) {
        if self.keys.is_empty() {
            return;
        }
        let place = below(place, "keys");
        let values: Vec<&str> = self.options.iter().map(|option| option.value.as_str()).collect();
        let mut taken: Vec<String> = Vec::new();
        for (value, key) in &self.keys {
            let at = below(&place, value);
            if !values.contains(&value.as_str()) {
                issues.error(&at, Problem::unknown("option", value, &values));
            }
            let mut letters = key.chars();
            let is_one =
                letters.next().is_some_and(char::is_alphanumeric) && letters.next().is_none();
            if !is_one && key != SPACE_KEY {
                issues.error(at, Problem::NoKey { key: key.clone() });
            } else if taken.contains(&key.to_lowercase()) {
                issues.error(at, Problem::KeyTwice { key: key.clone() });
            } else {
                taken.push(key.to_lowercase());
            }
        }
        if values.iter().filter(|value| !self.keys.contains_key(**value)).count() > 1 {
            issues.error(place, Problem::SeveralWithoutKey);
        }
    }
}

impl KindOfQuestion for SingleChoice {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::options(&self.options, place, "options", 2, issues);
        self.check_keys(place, issues);
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        accepting::one_of(&self.options, answer)
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        let options = showing.options();
        if self.keys.is_empty() {
            return QuestionKindView::SingleChoice { options };
        }
        let key = |option: &ChoiceView| self.keys.get(&option.value).cloned();
        QuestionKindView::Keys { keys: options.iter().map(key).collect(), options }
    }

    fn described(&self, language: &str) -> String {
        let options = labels(&self.options, language);
        let options = match self.keys.is_empty() {
            true => options,
            false => pick(
                language,
                format!("{options} (the first key that is pressed while the clip plays)"),
                format!("{options} (la première touche pressée pendant l’extrait)"),
            ),
        };
        match &self.truth {
            Some(truth) => {
                let sure = self.confidence.as_ref().map_or_else(String::new, |rating| {
                    pick(
                        language,
                        format!("; how sure the answer is, `{rating}`, gives an ROC curve of each option against all others, and the area below it"),
                        format!(" ; la certitude de la réponse, `{rating}`, donne une courbe ROC de chaque option contre toutes les autres, et l’aire sous elle"),
                    )
                });
                pick(
                    language,
                    format!("forced choice of {options}; right is the clip’s `{truth}`{sure}"),
                    format!(
                        "choix forcé parmi {options} ; la bonne réponse est `{truth}` de l’extrait{sure}"
                    ),
                )
            }
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

    fn keys(&self) -> Option<&BTreeMap<String, String>> {
        (!self.keys.is_empty()).then_some(&self.keys)
    }

    fn option_order(&self) -> OptionOrder {
        self.option_order
    }

    fn truth(&self) -> Option<&str> {
        self.truth.as_deref()
    }

    fn confidence(&self) -> Option<&str> {
        self.confidence.as_deref()
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
