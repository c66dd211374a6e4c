//! One choice in each of several rows; on a narrow screen the rows stand below each other.

use leptos::prelude::*;
use mimique_study::flow::ChoiceView;
use serde_json::{Map, Value, json};

use super::Answering;
use super::choice::{OptionLabel, video_of};

/// The rows, each a group of radio buttons. The answer is an object from row to option.
pub fn matrix(
    answering: Answering,
    rows: Vec<ChoiceView>,
    options: Vec<ChoiceView>,
) -> impl IntoView {
    rows.into_iter()
        .map(|row| {
            let name = answering.element(&row.value);
            let tiles = options.iter().cloned().map(|option| {
                let (read, give) = (answering.clone(), answering.clone());
                let (of_row, wanted) = (row.value.clone(), option.value.clone());
                let (in_row, value) = (row.value.clone(), option.value.clone());
                let video = video_of(&option);
                view! {
                    <div class="option-box">
                    {video}
                    <label class="choice">
                        <input type="radio" name=name.clone() value=option.value.clone()
                            prop:checked=move || {
                                let now = read.value().unwrap_or_default();
                                now.get(&of_row).and_then(Value::as_str) == Some(wanted.as_str())
                            }
                            on:change=move |_| {
                                let now = untrack(|| give.value()).unwrap_or_default();
                                let mut now: Map<_, _> = now.as_object().cloned().unwrap_or_default();
                                now.insert(in_row.clone(), json!(value));
                                give.give(Value::Object(now));
                            }/>
                        <OptionLabel option/>
                    </label>
                    </div>
                }
            });
            let tiles = tiles.collect_view();
            view! {
                <div class="matrix-row" role="radiogroup" aria-label=row.label.clone()>
                    <p class="row-label">{row.label.clone()}</p>
                    {video_of(&row)}
                    <div class="choices">{tiles}</div>
                </div>
            }
        })
        .collect_view()
}
