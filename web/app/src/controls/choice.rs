//! One of several, or any of several.

use leptos::prelude::*;
use mimique_study::flow::ChoiceView;
use serde_json::{Value, json};

use super::Answering;
use super::media::{Picture, SignedVideo};

/// Radio buttons.
pub fn single(answering: Answering, options: Vec<ChoiceView>) -> impl IntoView {
    let name = answering.element("choice");
    let tiles = options.into_iter().map(|option| {
        let (is, give) = (answering.clone(), answering.clone());
        let (wanted, value) = (option.value.clone(), option.value.clone());
        let video = video_of(&option);
        view! {
            <div class="option-box">
            {video}
            <label class="choice">
                <input type="radio" name=name.clone() value=option.value.clone()
                    prop:checked=move || is.is(&wanted)
                    on:change=move |_| give.give(json!(value))/>
                <OptionLabel option/>
            </label>
            </div>
        }
    });
    view! { <div class="choices">{tiles.collect_view()}</div> }
}

/// Check boxes. The answer holds the values in the order of the file; none is no answer.
pub fn multiple(
    answering: Answering,
    options: Vec<ChoiceView>,
    maximum: Option<usize>,
) -> impl IntoView {
    let order: Vec<String> = options.iter().map(|option| option.value.clone()).collect();
    let tiles = options.into_iter().map(|option| {
        let (read, give, order) = (answering.clone(), answering.clone(), order.clone());
        let (wanted, toggled) = (option.value.clone(), option.value.clone());
        let chosen = {
            let read = read.clone();
            move || chosen(&read).contains(&wanted)
        };
        let full = {
            let own = option.value.clone();
            move || {
                let now = self::chosen(&read);
                maximum.is_some_and(|most| now.len() >= most) && !now.contains(&own)
            }
        };
        let video = video_of(&option);
        view! {
            <div class="option-box">
            {video}
            <label class="choice">
                <input type="checkbox" value=option.value.clone() prop:checked=chosen disabled=full
                    on:change=move |event| {
                        let mut now = untrack(|| self::chosen(&give));
                        now.retain(|value| *value != toggled);
                        if event_target_checked(&event) {
                            now.push(toggled.clone());
                        }
                        now.sort_by_key(|value| order.iter().position(|each| each == value));
                        give.give(if now.is_empty() { Value::Null } else { json!(now) });
                    }/>
                <OptionLabel option/>
            </label>
            </div>
        }
    });
    view! { <div class="choices">{tiles.collect_view()}</div> }
}

fn chosen(answering: &Answering) -> Vec<String> {
    let value = answering.value().unwrap_or_default();
    let values = value.as_array().map(Vec::as_slice).unwrap_or_default();
    values.iter().filter_map(|each| each.as_str().map(str::to_owned)).collect()
}

/// What an option shows: its picture and its label.
#[component]
pub fn OptionLabel(option: ChoiceView) -> impl IntoView {
    view! {
        {option.image.map(|path| view! { <Picture path/> })}
        <span>{option.label}</span>
    }
}

/// The signed video of an option stands above its tile: its controls are not the tile's.
pub fn video_of(option: &ChoiceView) -> Option<AnyView> {
    let (path, label) = (option.video.clone()?, option.label.clone());
    Some(view! { <SignedVideo path label class="option"/> }.into_any())
}
