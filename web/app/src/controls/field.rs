//! A number or a text that is typed. The answer is given when the field is left, not at every key.

use mimique_study::{json_text, number_text};
use serde_json::Value;

use super::{Answering, plain};
use crate::dom::{Element, el, words};
use crate::json;

/// A number.
pub fn number(
    answering: &Answering,
    minimum: Option<f64>,
    maximum: Option<f64>,
    integer: bool,
    unit: Option<&str>,
) -> Vec<Element> {
    let shown = match answering.value() {
        Some(number @ Value::Number(_)) => json_text::write(number),
        Some(Value::String(text)) => text.clone(),
        _ => String::new(),
    };
    let give = answering.give.clone();
    let field = typed(answering, el("input", "").set("type", "number"), "number")
        .set("inputmode", if integer { "numeric" } else { "decimal" })
        .maybe("min", minimum.map(number_text).as_deref())
        .maybe("max", maximum.map(number_text).as_deref())
        .set("step", if integer { "1" } else { "any" })
        .set("autocomplete", "off")
        .set(".value", &shown)
        .on("change", move |given| {
            let text = given.value.trim();
            give.give(match (text, json::number(text)) {
                ("", _) => Value::Null,
                (_, Some(number)) => plain(number),
                // The flow says what is wrong with it.
                (other, None) => Value::from(other),
            });
        });
    let unit = unit.map(|unit| words("span", "soft", unit));
    vec![el("div", "row").with(field).option(unit)]
}

/// A line of text, or several.
pub fn text(answering: &Answering, long: bool, max_length: usize) -> Vec<Element> {
    let field = match long {
        true => el("textarea", ""),
        false => el("input", "").set("type", "text").set("autocomplete", "off"),
    };
    let give = answering.give.clone();
    let field = typed(answering, field, "text")
        .set("maxlength", &max_length.to_string())
        .set(".value", answering.value().and_then(Value::as_str).unwrap_or_default())
        .on("change", move |given| {
            let empty = given.value.trim().is_empty();
            give.give(if empty { Value::Null } else { Value::from(given.value) });
        });
    vec![field]
}

fn typed(answering: &Answering, field: Element, part: &str) -> Element {
    answering
        .spoken(field.key(part))
        .set("id", &answering.element(part))
        .flag("aria-required", answering.question.required)
}
