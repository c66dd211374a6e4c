//! The best and the worst of several: two groups of radio buttons over the same options. An option that is
//! picked in one group is given up in the other.

use mimique_session::flow::ChoiceView;
use serde_json::{Map, Value};

use super::choice::tile;
use super::{Answering, change};
use crate::dom::{Element, el, words};

/// The two groups. The answer is `{"best": value, "worst": value}`.
pub fn best_worst(
    answering: &Answering,
    best: &str,
    worst: &str,
    options: &[ChoiceView],
) -> Vec<Element> {
    let now = picks_of(answering.value());
    let group = |pick: &'static str, other: &'static str, name: &str| {
        let picked = now.get(pick).and_then(Value::as_str);
        let tiles = options.iter().map(|option| {
            let (question, value) = (answering.question.id.clone(), option.value.clone());
            let field = answering
                .radio(pick, &option.value, picked == Some(option.value.as_str()))
                .on("change", move |_| {
                    let value = Value::from(value.as_str());
                    change(&question, move |answer| {
                        let mut now = picks_of(answer);
                        if now.get(other) == Some(&value) {
                            now.remove(other);
                        }
                        now.insert(pick.to_owned(), value);
                        Value::Object(now)
                    })
                });
            tile(answering.engine, field, option)
        });
        el("div", "matrix-row")
            .key(pick)
            .set("role", "radiogroup")
            .set("aria-label", name)
            .with(words("p", "row-label", name))
            .with(el("div", "choices").all(tiles.collect()))
    };
    vec![group("best", "worst", best), group("worst", "best", worst)]
}

fn picks_of(answer: Option<&Value>) -> Map<String, Value> {
    answer.and_then(Value::as_object).cloned().unwrap_or_default()
}
