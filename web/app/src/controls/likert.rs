//! A rating scale: equal steps, coded as shown. Digits answer it when it has the focus.

use mimique_session::flow::Input;
use serde_json::Value;

use super::{Answering, ends};
use crate::act::Act;
use crate::browser::focus;
use crate::dom::{Element, el, words};

/// The points from the lowest to the highest, the ends named above them.
pub fn likert(
    answering: &Answering,
    points: &[(i64, String)],
    left: &str,
    right: &str,
) -> Vec<Element> {
    let answer = answering.value().and_then(Value::as_i64);
    let last = points.len().saturating_sub(1);
    let tiles = points.iter().enumerate().map(|(at, (number, label))| {
        let number = *number;
        // The ends stand above the scale; a screen reader hears them with the point itself.
        let meaning = match at {
            _ if !label.is_empty() => label,
            0 => left,
            _ if at == last => right,
            _ => "",
        };
        let shown = number.to_string();
        let spoken = match meaning {
            "" => shown.clone(),
            meaning => [shown.as_str(), meaning].join(", "),
        };
        let field = answering
            .radio("point", &shown, answer == Some(number))
            .set("aria-label", &spoken)
            .on("change", answering.gives(move |_| Value::from(number)));
        let label = (!label.is_empty())
            .then(|| words("span", "label", label).key("label").set("aria-hidden", "true"));
        el("label", "point")
            .with(field)
            .with(words("span", "", &shown).set("aria-hidden", "true"))
            .option(label)
    });
    let values: Vec<i64> = points.iter().map(|point| point.0).collect();
    let (question, group) = (answering.question.id.clone(), answering.element("point"));
    let scale = el("div", "likert")
        .key("scale")
        .style("--points", &points.len().to_string())
        .all(tiles.collect())
        .handles("keydown", move |press| {
            let digit = press.value.parse::<i64>().ok().filter(|digit| values.contains(digit))?;
            // The arrows go on from the point that was chosen.
            focus::focus(&[&format!("input[name='{group}'][value='{digit}']")]);
            let (question, value) = (question.clone(), Value::from(digit));
            Some(Act::Input(Input::Answer { question, value }))
        });
    vec![ends(left, right), scale]
}
