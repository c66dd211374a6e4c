//! A number or a text that is typed. The answer is given when the field is left, not at every key.

use leptos::prelude::*;
use serde_json::{Value, json};

use super::{Answering, plain};

/// What a screen reader hears of a field beside its value.
struct Spoken {
    label: Option<String>,
    required: Option<&'static str>,
    described: Signal<Option<String>, LocalStorage>,
    invalid: Signal<Option<&'static str>, LocalStorage>,
}

fn spoken(answering: &Answering) -> Spoken {
    let (label, required) = answering.now.with_untracked(|now| {
        now.as_ref().map_or((None, false), |q| (Some(q.prompt.clone()), q.required))
    });
    let (of, wrong) = (answering.clone(), answering.clone());
    Spoken {
        label,
        required: required.then_some("true"),
        described: Signal::derive_local(move || of.described()),
        invalid: Signal::derive_local(move || wrong.invalid()),
    }
}

/// A number.
pub fn number(
    answering: Answering,
    minimum: Option<f64>,
    maximum: Option<f64>,
    integer: bool,
    unit: Option<String>,
) -> impl IntoView {
    let id = answering.element("number");
    let Spoken { label, required, described, invalid } = spoken(&answering);
    let shown = {
        let answering = answering.clone();
        move || match answering.value() {
            Some(Value::Number(number)) => number.to_string(),
            Some(Value::String(text)) => text,
            _ => String::new(),
        }
    };
    view! {
        <div class="row">
            <input type="number" id=id aria-label=label inputmode=if integer { "numeric" } else { "decimal" }
                min=minimum.map(|m| m.to_string()) max=maximum.map(|m| m.to_string())
                step=if integer { "1" } else { "any" } autocomplete="off" prop:value=shown
                aria-required=required aria-describedby=described aria-invalid=invalid
                on:change=move |event| {
                    let text = event_target_value(&event);
                    answering.give(match (text.trim(), text.trim().parse::<f64>()) {
                        ("", _) => Value::Null,
                        (_, Ok(number)) => plain(number),
                        // The flow says what is wrong with it.
                        (other, Err(_)) => json!(other),
                    });
                }/>
            {unit.map(|unit| view! { <span class="soft">{unit}</span> })}
        </div>
    }
}

/// A line of text, or several.
pub fn text(answering: Answering, long: bool, max_length: usize) -> impl IntoView {
    let id = answering.element("text");
    let Spoken { label, required, described, invalid } = spoken(&answering);
    let shown = {
        let answering = answering.clone();
        move || {
            let value = answering.value().unwrap_or_default();
            value.as_str().unwrap_or_default().to_owned()
        }
    };
    let give = move |text: String| {
        answering.give(if text.trim().is_empty() { Value::Null } else { json!(text) });
    };
    if long {
        view! {
            <textarea id=id aria-label=label aria-required=required aria-describedby=described
                aria-invalid=invalid maxlength=max_length.to_string() prop:value=shown
                on:change=move |event| give(event_target_value(&event))></textarea>
        }
        .into_any()
    } else {
        view! {
            <input type="text" id=id aria-label=label aria-required=required
                aria-describedby=described aria-invalid=invalid maxlength=max_length.to_string() autocomplete="off"
                prop:value=shown on:change=move |event| give(event_target_value(&event))/>
        }
        .into_any()
    }
}
