//! A page of questions, and the list of questions that a trial has too.

use mimique_session::flow::{FailedView, Input, QuestionView, View};

use super::clock::clock;
use super::{button, form, heading, main, progress_line, sends, submit};
use crate::controls::question;
use crate::dom::{Element, el, words};
use crate::engine::Engine;

/// A page of questions.
pub fn questions(engine: &Engine, view: &View) -> Element {
    let View::Questions {
        title, text, questions, failed, button: on, clock: left, progress, ..
    } = view
    else {
        return super::opening();
    };
    let form = form()
        .with(heading(title))
        .paragraphs(text)
        .option(failed.as_ref().map(media_failed))
        .all(question_list(engine, questions))
        .with(submit(&on.label));
    main("page", "questions")
        .with(progress_line(*progress))
        .option(left.as_ref().map(clock))
        .with(form)
}

/// What is said of a picture or a video that could not be had, and the button that tries again.
fn media_failed(failed: &FailedView) -> Element {
    let retry = button("", "retry", &failed.retry).on("click", sends(|| Input::Retry));
    el("div", "notice bad")
        .key("failed")
        .set("role", "status")
        .with(words("p", "", &failed.message))
        .with(words("p", "", &failed.reason))
        .with(retry)
}

/// Questions one below the other; each is built once and then changes in place.
pub fn question_list(engine: &Engine, questions: &[QuestionView]) -> Vec<Element> {
    let mark = super::mark(engine);
    let name = |each: &QuestionView| [mark.as_str(), "/", &each.id].concat();
    questions.iter().map(|each| question(engine, &name(each), each)).collect()
}
