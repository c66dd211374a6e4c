//! A rating scale: equal steps, coded as shown. Digits answer it when it has the focus.

use leptos::prelude::*;
use serde_json::json;
use wasm_bindgen::JsCast as _;
use web_sys::{Element, HtmlElement};

use super::Answering;

/// The points from the lowest to the highest, the ends named above them.
pub fn likert(
    answering: Answering,
    points: Vec<(i64, String)>,
    left: String,
    right: String,
) -> impl IntoView {
    let name = answering.element("point");
    let count = points.len();
    let (lowest, highest) = (points.first().map(|p| p.0), points.last().map(|p| p.0));
    let by_digit = {
        let answering = answering.clone();
        let values: Vec<i64> = points.iter().map(|point| point.0).collect();
        move |event: leptos::ev::KeyboardEvent| {
            let digit = event.key().parse::<i64>().ok().filter(|digit| values.contains(digit));
            if let Some(digit) = digit
                && !event.ctrl_key()
                && !event.alt_key()
                && !event.meta_key()
            {
                answering.give(json!(digit));
                let scale =
                    event.current_target().and_then(|scale| scale.dyn_into::<Element>().ok());
                let point = scale.and_then(|scale| {
                    scale.query_selector(&format!("input[value='{digit}']")).ok().flatten()
                });
                if let Some(point) = point.and_then(|point| point.dyn_into::<HtmlElement>().ok()) {
                    // The arrows go on from the point that was chosen.
                    let _ = point.focus();
                }
            }
        }
    };
    let tiles = points.into_iter().map(|(number, label)| {
        let (is, give) = (answering.clone(), answering.clone());
        // The ends stand above the scale; a screen reader hears them with the point itself.
        let meaning = match number {
            _ if !label.is_empty() => label.clone(),
            _ if Some(number) == lowest => left.clone(),
            _ if Some(number) == highest => right.clone(),
            _ => String::new(),
        };
        let spoken = if meaning.is_empty() { number.to_string() } else { format!("{number}, {meaning}") };
        view! {
            <label class="point">
                <input type="radio" name=name.clone() value=number.to_string() aria-label=spoken
                    prop:checked=move || is.value().and_then(|value| value.as_i64()) == Some(number)
                    on:change=move |_| give.give(json!(number))/>
                <span aria-hidden="true">{number}</span>
                {(!label.is_empty()).then(|| view! { <span class="label" aria-hidden="true">{label.clone()}</span> })}
            </label>
        }
    });
    let tiles = tiles.collect_view();
    view! {
        <div class="likert-ends" aria-hidden="true"><span>{left}</span><span>{right}</span></div>
        <div class="likert" style=("--points", count.to_string()) on:keydown=by_digit>{tiles}</div>
    }
}
