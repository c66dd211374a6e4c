//! One of several, or any of several.

use mimique_session::flow::ChoiceView;
use serde_json::Value;

use super::media::{picture, sign_language_video};
use super::{Answering, change};
use crate::dom::{Element, el, words};
use crate::engine::Engine;

/// Radio buttons.
pub fn single(answering: &Answering, options: &[ChoiceView]) -> Vec<Element> {
    let tiles = options.iter().map(|option| {
        let value = option.value.clone();
        let field = answering
            .radio("choice", &option.value, answering.is(&option.value))
            .on("change", answering.gives(move |_| Value::from(value.as_str())));
        tile(answering.engine, field, option)
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
        let (question, toggled) = (answering.question.id.clone(), option.value.clone());
        let field = el("input", "")
            .set("type", "checkbox")
            .set("value", &option.value)
            .checked(checked)
            .flag("disabled", full && !checked)
            .on("change", move |field| {
                let (order, toggled) = (order.clone(), toggled.clone());
                change(&question, move |answer| {
                    let chosen = texts(answer);
                    let is_on = |value: &&String| match **value == toggled {
                        true => field.checked,
                        false => chosen.contains(value),
                    };
                    let now: Vec<String> = order.iter().filter(is_on).cloned().collect();
                    if now.is_empty() { Value::Null } else { Value::from(now) }
                })
            });
        tile(answering.engine, field, option)
    });
    vec![el("div", "choices").all(tiles.collect())]
}

/// The texts of an answer that is a list.
pub fn texts(value: Option<&Value>) -> Vec<String> {
    let values = value.and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    values.iter().filter_map(|each| each.as_str().map(str::to_owned)).collect()
}

/// A field with its option; the option's sign-language video stands above it.
pub fn tile(engine: &Engine, field: Element, option: &ChoiceView) -> Element {
    let label = el("label", "choice").with(field).all(label(engine, option));
    el("div", "option-box").key(&option.value).option(video_of(engine, option)).with(label)
}

/// The words of a scale's end or point, below their sign-language video.
pub fn signed(engine: &Engine, sign: &ChoiceView) -> Element {
    el("div", "option-box").key(&sign.value).option(video_of(engine, sign)).all(label(engine, sign))
}

/// What an option shows: its picture and its label.
pub fn label(engine: &Engine, option: &ChoiceView) -> Vec<Element> {
    let picture = option.image.as_ref().map(|path| picture(engine, path));
    picture.into_iter().chain([words("span", "", &option.label)]).collect()
}

/// The sign-language video of an option stands above its tile: its controls are not the tile's.
pub fn video_of(engine: &Engine, option: &ChoiceView) -> Option<Element> {
    option.video.as_ref().map(|path| sign_language_video(engine, path, &option.label, "option"))
}
