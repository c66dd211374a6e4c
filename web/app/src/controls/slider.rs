//! A number on a line. Until it is touched it has no value, and shows none.

use leptos::prelude::*;

use super::{Answering, plain};

/// The line, its ends named above it.
pub fn slider(
    answering: Answering,
    minimum: f64,
    maximum: f64,
    step: f64,
    left: String,
    right: String,
) -> impl IntoView {
    let label = answering.now.with_untracked(|now| now.as_ref().map(|q| q.prompt.clone()));
    let (read, shown, said) = (answering.clone(), answering.clone(), answering.clone());
    let (of, wrong, give) = (answering.clone(), answering.clone(), answering);
    let middle = (minimum + maximum) / 2.0;
    let touch = move |text: String| {
        if let Ok(number) = text.parse::<f64>() {
            give.give(plain(number));
        }
    };
    let touched = touch.clone();
    view! {
        <div class="likert-ends" aria-hidden="true"><span>{left}</span><span>{right}</span></div>
        <input type="range" aria-label=label min=minimum.to_string() max=maximum.to_string()
            step=step.to_string() class:untouched=move || read.value().is_none()
            aria-describedby=move || of.described() aria-invalid=move || wrong.invalid()
            prop:value=move || shown.value().and_then(|v| v.as_f64()).unwrap_or(middle).to_string()
            on:change=move |event| touch(event_target_value(&event))
            on:click=move |event| touched(event_target_value(&event))/>
        <p class="slider-value number" aria-hidden="true">
            {move || said.value().map_or_else(|| "\u{2013}".to_owned(), |value| value.to_string())}
        </p>
    }
}
