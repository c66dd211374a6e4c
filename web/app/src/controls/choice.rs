//! One of several, or any of several.

use mimique_study::flow::ChoiceView;
use serde_json::Value;

use super::Answering;
use super::media::{picture, signed_video};
use crate::dom::{Element, el, words};

/// Radio buttons.
pub fn single(answering: &Answering, options: &[ChoiceView]) -> Vec<Element> {
    let tiles = options.iter().map(|option| {
        let (give, value) = (answering.give.clone(), option.value.clone());
        let field = answering
            .radio("choice", &option.value, answering.is(&option.value))
            .on("change", move |_| give.give(Value::from(value.as_str())));
        tile(field, option)
    });
    vec![el("div", "choices").all(tiles.collect())]
}

/// Check boxes. The answer holds the values in the order of the file; none is no answer.
pub fn multiple(
    answering: &Answering,
    options: &[ChoiceView],
    maximum: Option<usize>,
) -> Vec<Element> {
    let chosen = texts(answering.value());
    let full = maximum.is_some_and(|most| chosen.len() >= most);
    let tiles = options.iter().map(|option| {
        let checked = chosen.contains(&option.value);
        let order: Vec<String> = options.iter().map(|option| option.value.clone()).collect();
        let (give, toggled) = (answering.give.clone(), option.value.clone());
        let field = el("input", "")
            .set("type", "checkbox")
            .set("value", &option.value)
            .checked(checked)
            .flag("disabled", full && !checked)
            .on("change", move |given| {
                let chosen = texts(give.now().as_ref());
                let is_on = |value: &&String| match **value == toggled {
                    true => given.checked,
                    false => chosen.contains(value),
                };
                let now: Vec<String> = order.iter().filter(is_on).cloned().collect();
                give.give(if now.is_empty() { Value::Null } else { Value::from(now) });
            });
        tile(field, option)
    });
    vec![el("div", "choices").all(tiles.collect())]
}

/// The texts of an answer that is a list.
pub fn texts(value: Option<&Value>) -> Vec<String> {
    let values = value.and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    values.iter().filter_map(|each| each.as_str().map(str::to_owned)).collect()
}

/// A field with its option; the option's signed video stands above it.
pub fn tile(field: Element, option: &ChoiceView) -> Element {
    let label = label(option).into_iter().fold(el("label", "choice").with(field), Element::with);
    el("div", "option-box").key(&option.value).option(video_of(option)).with(label)
}

/// The words of a scale's end or point, below their signed video.
pub fn signed(sign: &ChoiceView) -> Element {
    el("div", "option-box").key(&sign.value).option(video_of(sign)).all(label(sign))
}

/// What an option shows: its picture and its label.
pub fn label(option: &ChoiceView) -> Vec<Element> {
    let picture = option.image.as_ref().map(|path| picture(path));
    picture.into_iter().chain([words("span", "", &option.label)]).collect()
}

/// The signed video of an option stands above its tile: its controls are not the tile's.
pub fn video_of(option: &ChoiceView) -> Option<Element> {
    option.video.as_ref().map(|path| signed_video(path, &option.label, "option"))
}
