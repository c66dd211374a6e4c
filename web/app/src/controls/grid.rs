//! A point on a grid of valence and arousal: radio buttons in rows, the four edges named.

use leptos::prelude::*;
use serde_json::json;

use super::Answering;

/// A square grid; `edges` are left, right, bottom, top. Cells count from 1, left to right and
/// bottom to top.
pub fn grid(answering: Answering, num_items: u32, edges: [String; 4]) -> impl IntoView {
    let name = answering.element("cell");
    let [left, right, bottom, top] = edges;
    let cells =
        (1..=num_items).rev().flat_map(|arousal| (1..=num_items).map(move |v| (v, arousal)));
    let cells = cells
        .map(|(valence, arousal)| {
            let (read, give) = (answering.clone(), answering.clone());
            let answer = json!({ "valence": valence, "arousal": arousal });
            let given = answer.clone();
            let spoken = format!("{left}–{right}: {valence}, {bottom}–{top}: {arousal}");
            view! {
                <label class="point">
                    <input type="radio" name=name.clone() value=format!("{valence},{arousal}") aria-label=spoken
                        prop:checked=move || read.value().as_ref() == Some(&answer)
                        on:change=move |_| give.give(given.clone())/>
                </label>
            }
        })
        .collect_view();
    view! {
        <div class="affect">
            <p class="soft top" aria-hidden="true">{top}</p>
            <div class="likert grid" style=("--points", num_items.to_string())>{cells}</div>
            <p class="soft bottom" aria-hidden="true">{bottom}</p>
            <div class="likert-ends" aria-hidden="true"><span>{left}</span><span>{right}</span></div>
        </div>
    }
}
