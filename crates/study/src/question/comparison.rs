//! Which of the two clips that are shown side by side.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::Question;
use super::kind::{KindOfQuestion, Summary, Told, pick};
use super::simulation::Simulated;
use super::view::{ChoiceView, QuestionKindView, Showing};
use crate::answer::AnswerProblem;
use crate::check::Issues;
use crate::text::{Words, words};

/// Which of the two clips that are shown side by side: `"left"`, `"right"` or `"same"`. The export names
/// the clip that was chosen in its column `chosen`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct Comparison {
    /// Whether "no difference" can be answered.
    #[serde(default)]
    pub allow_same: bool,
}

impl Comparison {
    /// The answers, from left to right.
    fn sides(&self) -> Vec<&'static str> {
        let same = self.allow_same.then_some("same");
        ["left"].into_iter().chain(same).chain(["right"]).collect()
    }
}

impl KindOfQuestion for Comparison {
    fn check(&self, _place: &str, _issues: &mut Issues) {}

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        match answer.as_str() {
            Some(side) if self.sides().contains(&side) => Ok(()),
            _ => Err(AnswerProblem::NotAnOption),
        }
    }

    fn view(&self, showing: &Showing<'_>) -> QuestionKindView {
        let option = |side: &str| match showing.question.sign(side) {
            Some(sign) => showing.choice(sign),
            None => ChoiceView {
                value: side.to_owned(),
                label: in_words(side, showing.words).to_owned(),
                image: None,
                video: None,
            },
        };
        QuestionKindView::SingleChoice { options: self.sides().into_iter().map(option).collect() }
    }

    fn described(&self, language: &str) -> String {
        let english = "left or right of two clips in step";
        pick(language, english, "gauche ou droite de deux extraits synchrones").to_owned()
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Compared { same: self.allow_same }
    }

    fn compares_clips(&self) -> bool {
        true
    }

    fn summary(&self) -> Summary {
        Summary::Sides(self.sides())
    }

    fn answer_in_words(&self, asked: &Question, answer: &str, language: &str) -> String {
        match asked.sign(answer) {
            Some(own) => own.label.in_language(language).to_owned(),
            None => in_words(answer, words(language)).to_owned(),
        }
    }

    fn sign_values(&self) -> Option<Vec<&'static str>> {
        let same = self.allow_same.then_some("same");
        Some(["left", "right"].into_iter().chain(same).collect())
    }

    fn told(&self, asked: &Question, answer: &Value, language: &str, words: &Words) -> Told {
        let Some(side) = answer.as_str() else { return Vec::new() };
        vec![match asked.sign(side) {
            Some(own) => vec![own.label.in_language(language).to_owned()],
            None => ways_to_say(side, words),
        }]
    }
}

/// What the page's own button for a side says.
fn in_words<'w>(side: &str, words: &'w Words) -> &'w str {
    match side {
        "left" => words.left_one(),
        "right" => words.right_one(),
        _ => words.both_alike(),
    }
}

/// The words for a side: those of its button that the other side's has not ("left", "gauche").
fn ways_to_say(side: &str, words: &Words) -> Vec<String> {
    let mine = in_words(side, words);
    let other = match side {
        "left" => words.right_one(),
        "right" => words.left_one(),
        _ => return vec![mine.to_owned()],
    };
    let plain = |text: &str| -> Vec<String> {
        let words = text.split(|letter: char| !letter.is_alphanumeric());
        words.filter(|word| !word.is_empty()).map(str::to_lowercase).collect()
    };
    let other = plain(other);
    let mut ways = plain(mine);
    ways.retain(|word| !other.contains(word));
    if ways.is_empty() { vec![mine.to_owned()] } else { ways }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_is_told_by_the_words_that_differ() {
        assert!(ways_to_say("left", words("en")).contains(&"left".to_owned()));
        assert!(ways_to_say("left", words("fr")).contains(&"gauche".to_owned()));
        assert!(ways_to_say("right", words("fr")).contains(&"droite".to_owned()));
        assert!(!ways_to_say("right", words("fr")).contains(&"gauche".to_owned()));
        assert_eq!(ways_to_say("same", words("en")), ["No difference"]);
    }
}
