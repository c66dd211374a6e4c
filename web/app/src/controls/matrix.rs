//! One choice in each of several rows; on a narrow screen the rows stand below each other.

use mimique_session::flow::ChoiceView;
use serde_json::{Map, Value};

use super::choice::{tile, video_of};
use super::{Answering, change};
use crate::dom::{Element, el, words};

/// The rows, each a group of radio buttons. The answer is an object from row to option.
pub fn matrix(answering: &Answering, rows: &[ChoiceView], options: &[ChoiceView]) -> Vec<Element> {
    let now = rows_of(answering.value());
    let row = |row: &ChoiceView| {
        let chosen = now.get(&row.value).and_then(Value::as_str);
        let tiles = options.iter().map(|option| {
            let question = answering.question.id.clone();
            let (in_row, value) = (row.value.clone(), option.value.clone());
            let field = answering
                .radio(&row.value, &option.value, chosen == Some(option.value.as_str()))
                .on("change", move |_| {
                    let (in_row, value) = (in_row.clone(), Value::from(value.as_str()));
                    change(&question, move |answer| {
                        let mut now = rows_of(answer);
                        now.insert(in_row, value);
                        Value::Object(now)
                    })
                });
            tile(answering.engine, field, option)
        });
        el("div", "matrix-row")
            .key(&row.value)
            .set("role", "radiogroup")
            .set("aria-label", &row.label)
            .with(words("p", "row-label", &row.label))
            .option(video_of(answering.engine, row))
            .with(el("div", "choices").all(tiles.collect()))
    };
    rows.iter().map(row).collect()
}

fn rows_of(answer: Option<&Value>) -> Map<String, Value> {
    answer.and_then(Value::as_object).cloned().unwrap_or_default()
}
