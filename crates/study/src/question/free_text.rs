//! Text that people write: what a line of it and several lines have in common.

use serde_json::Value;

use super::kind::{KindOfQuestion, Summary, pick};
use super::simulation::{Chance, Simulated};
use super::view::{QuestionKindView, Showing};
use super::{accepting, defining};
use crate::answer::AnswerProblem;
use crate::check::Issues;

/// A kind of question whose answer is a text.
pub trait FreeText {
    /// Whether the text may have several lines.
    const LONG: bool;
    /// Most characters, if the study does not say.
    const MOST: usize;

    /// Most characters, as the study says.
    fn max_length(&self) -> Option<usize>;

    /// Most characters.
    fn most(&self) -> usize {
        self.max_length().unwrap_or(Self::MOST)
    }
}

impl<T: FreeText> KindOfQuestion for T {
    fn check(&self, place: &str, issues: &mut Issues) {
        defining::max_length(self.max_length(), place, issues);
    }

    fn accept(&self, answer: &Value) -> Result<(), AnswerProblem> {
        accepting::no_longer(answer, self.most())
    }

    fn view(&self, _showing: &Showing<'_>) -> QuestionKindView {
        QuestionKindView::Text { long: Self::LONG, max_length: self.most() }
    }

    fn described(&self, language: &str) -> String {
        pick(language, "text, not analysed", "texte, non analysé").to_owned()
    }

    fn simulated(&self) -> Simulated<'_> {
        Simulated::Drawn { by_shares: false }
    }

    fn drawn(&self, _weights: &[f64], _chance: &mut dyn Chance) -> Value {
        "simulated answer".into()
    }

    fn is_free_text(&self) -> bool {
        true
    }

    fn summary(&self) -> Summary {
        Summary::Texts
    }
}
