//! A number or a text that is typed. The answer is given when the field is left, not at every key.

use serde_json::Value;

use super::{Answering, plain};
use crate::dom::{Element, FieldEvent, el, words};

/// A number.
pub fn number(
    answering: &Answering,
    minimum: Option<f64>,
    maximum: Option<f64>,
    integer: bool,
    unit: Option<&str>,
) -> Vec<Element> {
    let shown = match answering.value() {
        Some(number @ Value::Number(_)) => number.to_string(),
        Some(Value::String(text)) => text.clone(),
        _ => String::new(),
    };
    let answer = |field: FieldEvent| match (field.value.trim(), field.number()) {
        ("", _) => Value::Null,
        (_, Some(number)) => plain(number),
        // The flow says what is wrong with it.
        (other, None) => Value::from(other),
    };
    let field = typed(answering, el("input", "").set("type", "number"), "number")
        .set("inputmode", if integer { "numeric" } else { "decimal" })
        .maybe("min", minimum.map(|number| number.to_string()).as_deref())
        .maybe("max", maximum.map(|number| number.to_string()).as_deref())
        .set("step", if integer { "1" } else { "any" })
        .set("autocomplete", "off")
        .value(&shown)
        .on("change", answering.gives(answer));
    let unit = unit.map(|unit| words("span", "soft", unit));
    vec![el("div", "row").with(field).option(unit)]
}

/// A line of text, or several.
pub fn text(answering: &Answering, long: bool, max_length: usize) -> Vec<Element> {
    let field = match long {
        true => el("textarea", ""),
        false => el("input", "").set("type", "text").set("autocomplete", "off"),
    };
    let answer = |field: FieldEvent| match field.value.trim() {
        "" => Value::Null,
        _ => Value::from(field.value),
    };
    let field = typed(answering, field, "text")
        .set("maxlength", &max_length.to_string())
        .value(answering.value().and_then(Value::as_str).unwrap_or_default())
        .on("change", answering.gives(answer));
    vec![field]
}

fn typed(answering: &Answering, field: Element, part: &str) -> Element {
    answering
        .spoken(field.key(part))
        .set("id", &answering.element(part))
        .flag("aria-required", answering.question.required)
}
