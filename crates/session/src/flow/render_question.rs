//! From state to screen: questions, their options, what of them is in sign language.

use mimique_study::{KindOfQuestion as _, Question, Showing};

use super::allowed::shown_questions;
use super::render::Screen;
use super::view_question::QuestionView;
use crate::plan::Step;

impl Screen<'_> {
    pub(super) fn questions(&self, step: &Step) -> Vec<QuestionView> {
        shown_questions(step, self.state).map(|question| self.question(question)).collect()
    }

    fn question(&self, question: &Question) -> QuestionView {
        let value = self.state.record.draft(&question.id).cloned();
        let problem = question.accept(value.as_ref()).err();
        let problem = problem.filter(|_| self.state.live.show_problems);
        let showing = Showing {
            question,
            language: &self.state.record.language,
            words: self.words,
            order: self.plan.option_orders.get(&question.id).map(Vec::as_slice),
        };
        let signs = match question.kind.sign_values() {
            // They stand among the options.
            Some(_) => Vec::new(),
            None => showing.choices(&question.signs),
        };
        QuestionView {
            id: question.id.clone(),
            prompt: self.text(&question.prompt),
            help: question.help.as_ref().map(|help| self.text(help)),
            video: question.video.as_ref().map(|path| self.path(path)),
            signs,
            required: question.required,
            optional_mark: (!question.required).then(|| self.words.optional().to_owned()),
            kind: question.kind.view(&showing),
            value,
            problem: problem.map(|problem| self.words.problem(&problem)),
        }
    }
}
