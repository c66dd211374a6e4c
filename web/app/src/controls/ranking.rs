//! Options put in order: a list whose items move up and down by buttons (no dragging needed). The
//! list is an answer only once something in it was moved or it was confirmed as it stands.

use std::rc::Rc;

use mimique_session::flow::ChoiceView;
use serde_json::Value;

use super::choice::{label, texts, video_of};
use super::{Answering, change};
use crate::dom::{Element, el, words};

/// The list, from first to last. It stands once; each place shows what is in it, so that the
/// keyboard's place stays.
pub fn ranking(answering: &Answering, options: &[ChoiceView]) -> Vec<Element> {
    let engine = answering.engine;
    let fixed = engine.words();
    let initial: Rc<[String]> = options.iter().map(|option| option.value.clone()).collect();
    let order = order_of(answering.value(), &initial);
    let mover = |verb: &str, sign: &str, option: &ChoiceView, at: usize, with: usize| {
        let (question, initial) = (answering.question.id.clone(), Rc::clone(&initial));
        let there = with < options.len() && at != with;
        words("button", "", sign)
            .key(sign)
            .set("type", "button")
            .set("aria-label", &[verb, &option.label].join(" "))
            .flag("disabled", !there)
            .on("click", move |_| {
                let initial = Rc::clone(&initial);
                change(&question, move |answer| {
                    let mut now = order_of(answer, &initial);
                    if at < now.len() && with < now.len() {
                        now.swap(at, with);
                    }
                    Value::from(now)
                })
            })
    };
    let places = order.iter().enumerate().map(|(at, value)| {
        let place = el("li", "row");
        let Some(option) = options.iter().find(|option| option.value == *value) else {
            return place;
        };
        let what = el("span", "what").option(video_of(engine, option)).all(label(engine, option));
        place
            .with(what)
            .with(mover(fixed.move_up(), "\u{2191}", option, at, at.saturating_sub(1)))
            .with(mover(fixed.move_down(), "\u{2193}", option, at, at + 1))
    });
    let list = el("ol", "ranking").all(places.collect());
    let question = answering.question.id.clone();
    let confirm = words("button", "", fixed.confirm_order())
        .key("confirm-order")
        .set("type", "button")
        .set("data-action", "confirm-order")
        .set("aria-pressed", if answering.value().is_some() { "true" } else { "false" })
        .on("click", move |_| {
            let initial = Rc::clone(&initial);
            change(&question, move |answer| Value::from(order_of(answer, &initial)))
        });
    vec![list, confirm]
}

/// The order given; that of the file where there is none.
fn order_of(answer: Option<&Value>, initial: &[String]) -> Vec<String> {
    let given = texts(answer);
    if given.len() == initial.len() { given } else { initial.to_vec() }
}
