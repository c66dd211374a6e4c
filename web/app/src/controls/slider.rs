//! A number on a line. Until it is touched it has no value, and neither shows nor says one.

use mimique_session::flow::Input;
use serde_json::Value;

use super::{Answering, ends, plain};
use crate::act::Act;
use crate::dom::{Element, FieldEvent, el, words};

/// The line from minimum to maximum by steps, its ends named above it.
pub fn slider(
    answering: &Answering,
    [minimum, maximum, step]: [f64; 3],
    [left, right]: [&str; 2],
) -> Vec<Element> {
    let value = answering.value();
    let middle = (minimum + maximum) / 2.0;
    let question = answering.question.id.clone();
    let touch = move |field: FieldEvent| {
        let value = plain(field.number()?);
        Some(Act::Input(Input::Answer { question: question.clone(), value }))
    };
    let field = el("input", if value.is_none() { "untouched" } else { "" })
        .key("line")
        .set("type", "range")
        .set("min", &minimum.to_string())
        .set("max", &maximum.to_string())
        .set("step", &step.to_string())
        // Where the knob stands is no answer, for those who hear it either.
        .maybe("aria-valuetext", value.is_none().then(|| answering.engine.words().not_answered()))
        .value(&value.and_then(Value::as_f64).unwrap_or(middle).to_string())
        .handles("change", touch.clone())
        .handles("click", touch);
    let shown = value.map_or_else(|| "\u{2013}".to_owned(), ToString::to_string);
    vec![
        ends(left, right),
        answering.spoken(field),
        words("p", "slider-value number", &shown).key("value").set("aria-hidden", "true"),
    ]
}
