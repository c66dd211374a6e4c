//! A page of questions, and the list of questions that a trial has too.

use mimique_study::flow::{QuestionView, View};

use super::clock::clock;
use super::{form, heading, main, progress_line, submit};
use crate::controls::question;
use crate::dom::Element;
use crate::engine::Engine;

/// A page of questions.
pub fn questions(engine: &Engine, view: &View) -> Element {
    let View::Questions { step, title, text, questions, button, clock: left, progress } = view
    else {
        return super::opening();
    };
    let form = form()
        .with(heading(title))
        .paragraphs(text)
        .all(question_list(engine, step, questions))
        .with(submit(&button.label));
    main("page", "questions")
        .set("data-step", step)
        .with(progress_line(*progress))
        .option(left.as_ref().map(clock))
        .with(form)
}

/// Questions one below the other; each is built once and then changes in place.
pub fn question_list(engine: &Engine, step: &str, questions: &[QuestionView]) -> Vec<Element> {
    questions.iter().map(|each| question(engine, &[step, "/", &each.id].concat(), each)).collect()
}
