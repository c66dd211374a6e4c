//! Options put in order: a list whose items move up and down by buttons (no dragging needed). The
//! list is an answer only once something in it was moved or it was confirmed as it stands.

use leptos::prelude::*;
use mimique_study::flow::ChoiceView;
use serde_json::json;

use super::Answering;
use super::choice::{OptionLabel, video_of};

/// The list, from first to last.
pub fn ranking(answering: Answering, options: Vec<ChoiceView>) -> impl IntoView {
    let initial: Vec<String> = options.iter().map(|option| option.value.clone()).collect();
    let order = {
        let answering = answering.clone();
        Memo::new(move |_| {
            let value = answering.value().unwrap_or_default();
            let given: Vec<String> = value
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(|each| each.as_str().map(str::to_owned))
                .collect();
            if given.len() == initial.len() { given } else { initial.clone() }
        })
    };
    let swap = {
        let answering = answering.clone();
        move |at: usize, with: usize| {
            let mut now = order.get_untracked();
            if at < now.len() && with < now.len() {
                now.swap(at, with);
            }
            answering.give(json!(now));
        }
    };
    let confirmed = answering.clone();
    let confirm = {
        let answering = answering.clone();
        move |_| answering.give(json!(order.get_untracked()))
    };
    let words = untrack(|| answering.session.words());
    // The list stands once; each place shows what is in it, so that the keyboard's place stays.
    let places = (0..options.len()).map(|at| {
        let option = {
            let options = options.clone();
            Memo::new(move |_| {
                let value = order.with(|order| order.get(at).cloned());
                options.iter().find(|option| Some(&option.value) == value.as_ref()).cloned()
            })
        };
        let name = move |verb: &str| {
            option.with(|option| option.as_ref().map(|option| format!("{verb} {}", option.label)))
        };
        let (up, down, last) = (swap.clone(), swap.clone(), at + 1 == options.len());
        view! {
            <li class="row">
                <span class="what">{move || option.get().map(|option| view! {
                    {video_of(&option)}
                    <OptionLabel option/>
                })}</span>
                <button type="button" aria-label=move || name(words.move_up) disabled=at == 0
                    on:click=move |_| up(at, at.saturating_sub(1))>"\u{2191}"</button>
                <button type="button" aria-label=move || name(words.move_down) disabled=last
                    on:click=move |_| down(at, at + 1)>"\u{2193}"</button>
            </li>
        }
    });
    view! {
        <ol class="ranking">{places.collect_view()}</ol>
        <button type="button" data-action="confirm-order"
            aria-pressed=move || if confirmed.value().is_some() { "true" } else { "false" }
            on:click=confirm>{words.confirm_order}</button>
    }
}
