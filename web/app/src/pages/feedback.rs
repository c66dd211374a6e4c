//! After a practice clip: which answers were right.

use mimique_session::flow::FeedbackView;

use super::{heading, main, next, progress_line};
use crate::dom::{Element, el, words};

/// Which answers were right.
pub fn feedback(feedback: &FeedbackView) -> Element {
    let mut card = el("div", "card").with(heading(&feedback.heading));
    for item in &feedback.items {
        let wrong = item.right.is_some();
        let given = el("p", "").text(if wrong { "✗ " } else { "✓ " }).text(&item.given);
        let notice = el("div", if wrong { "notice warn" } else { "notice good" })
            .with(el("p", "").with(words("strong", "", &item.prompt)))
            .with(given)
            .option(item.right.as_ref().map(|right| words("p", "", right)));
        card = card.with(notice);
    }
    let card = card
        .option(feedback.text.as_ref().map(|text| words("p", "", text)))
        .with(el("div", "actions").with(next(&feedback.button.label)));
    main("page", "feedback")
        .set("data-correct", if feedback.correct { "true" } else { "false" })
        .with(progress_line(feedback.progress))
        .with(card)
}
