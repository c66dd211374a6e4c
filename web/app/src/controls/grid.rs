//! A point on a grid of valence and arousal: radio buttons in rows, the four edges named.

use serde_json::json;

use super::{Answering, ends};
use crate::dom::{Element, el, words};

/// A square grid; `edges` are left, right, bottom, top. Cells count from 1, left to right and
/// bottom to top.
pub fn grid(answering: &Answering, num_items: u32, edges: [&String; 4]) -> Vec<Element> {
    let [left, right, bottom, top] = edges;
    let mut cells = el("div", "likert grid").style("--points", &num_items.to_string());
    for arousal in (1..=num_items).rev() {
        for valence in 1..=num_items {
            let answer = json!({ "valence": valence, "arousal": arousal });
            let spoken = format!("{left}–{right}: {valence}, {bottom}–{top}: {arousal}");
            let chosen = answering.value() == Some(&answer);
            let field = answering
                .radio("cell", &format!("{valence},{arousal}"), chosen)
                .set("aria-label", &spoken)
                .on("change", answering.gives(move |_| answer.clone()));
            cells = cells.with(el("label", "point").with(field));
        }
    }
    let affect = el("div", "affect")
        .with(words("p", "soft top", top).set("aria-hidden", "true"))
        .with(cells)
        .with(words("p", "soft bottom", bottom).set("aria-hidden", "true"))
        .with(ends(left, right));
    vec![affect]
}
