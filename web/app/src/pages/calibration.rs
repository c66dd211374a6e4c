//! The size of the screen: a card drawn to be made as large as a real one, and the distance.

use leptos::prelude::*;
use mimique_study::flow::{CalibrationView, CardView, Input, View};

use super::ProgressLine;
use crate::focus;
use crate::session::Session;

/// Widths that the slider reaches, CSS pixels: from a phone held far out of scale to a wall.
const WIDTHS: (f64, f64) = (150.0, 900.0);

/// The size of the screen.
#[component]
pub fn CalibrationPage() -> impl IntoView {
    let session = Session::here();
    let View::Calibration(first) = session.view.get_untracked() else {
        return ().into_any();
    };
    let shown: Memo<CalibrationView> = {
        let first = first.clone();
        Memo::new(move |last: Option<&CalibrationView>| {
            session.view.with(|view| match view {
                View::Calibration(shown) => (**shown).clone(),
                _ => last.cloned().unwrap_or_else(|| (*first).clone()),
            })
        })
    };
    let CalibrationView { step, heading, text, card, distance, progress, .. } = *first;
    view! {
        <main class="page wide-card" data-view="calibration" data-step=step>
            <ProgressLine done=progress.done total=progress.total/>
            <form class="card" novalidate
                on:submit=move |event| {
                    event.prevent_default();
                    session.send(Input::Next);
                    focus::problem();
                }>
                <h1 tabindex="-1">{heading}</h1>
                {text.into_iter().map(|text| view! { <p>{text}</p> }).collect_view()}
                {card.map(|card| view! { <Card first=card shown/> })}
                {distance.map(|distance| {
                    let problem = move || shown.with(|all| all.distance.as_ref().and_then(|d| d.problem.clone()));
                    view! {
                        <fieldset class="question" data-question="distance" data-invalid=move || problem().map(|_| "true")>
                            <legend><label for="distance">{distance.label}</label></legend>
                            <input id="distance" type="number" inputmode="numeric" min="15" max="300" step="1"
                                value=distance.value.map(|cm| cm.to_string())
                                aria-invalid=move || problem().map(|_| "true")
                                aria-describedby=move || problem().map(|_| "distance-problem")
                                on:change=move |event| session.send(Input::Distance(event_target_value(&event).parse().ok()))/>
                            " "{distance.unit}
                            {move || problem().map(|text| view! { <p class="problem" id="distance-problem">{text}</p> })}
                        </fieldset>
                    }
                })}
                <div class="actions">
                    <button type="submit" class="primary" data-action="next">
                        {move || shown.with(|all| all.button.label.clone())}
                    </button>
                </div>
            </form>
        </main>
    }
    .into_any()
}

/// The picture of the card, its slider, and the way around it.
#[component]
fn Card(first: CardView, shown: Memo<CalibrationView>) -> impl IntoView {
    let session = Session::here();
    let card = move |read: fn(&CardView) -> f64| {
        move || shown.with(|all| all.card.as_ref().map_or(0.0, read))
    };
    let (width, height) = (card(|card| card.width_px), card(|card| card.height_px));
    let problem = move || shown.with(|all| all.card.as_ref().and_then(|card| card.problem.clone()));
    let set = move |px: f64| {
        let device_pixel_ratio = window().device_pixel_ratio();
        session.send(Input::CardWidth { px: px.clamp(WIDTHS.0, WIDTHS.1), device_pixel_ratio });
    };
    let skipped = move || {
        shown.with(|all| {
            all.card.as_ref().is_some_and(|it| it.no_card.as_ref().is_some_and(|n| n.1))
        })
    };
    let (smaller, larger) = first.steps;
    view! {
        <fieldset class="question" data-question="card" data-invalid=move || problem().map(|_| "true")>
            <legend>{first.label.clone()}</legend>
            <p class="hint" id="card-hint">{first.instruction}</p>
            <div class="bank-card-frame">
                <div class="bank-card" aria-hidden="true"
                    style=("--card-long", move || format!("{:.2}px", width()))
                    style=("--card-short", move || format!("{:.2}px", height()))>
                    <span class="chip"></span>
                </div>
            </div>
            <input type="range" aria-label=first.label min=WIDTHS.0.to_string() max=WIDTHS.1.to_string() step="0.5"
                aria-describedby=move || if problem().is_some() { "card-hint card-problem" } else { "card-hint" }
                aria-invalid=move || problem().map(|_| "true")
                prop:value=move || width().to_string()
                on:input=move |event| if let Ok(px) = event_target_value(&event).parse() { set(px) }/>
            <div class="row">
                <button type="button" data-action="smaller" on:click=move |_| set(width() - 1.0)>{smaller}</button>
                <button type="button" data-action="larger" on:click=move |_| set(width() + 1.0)>{larger}</button>
                {first.no_card.map(|(label, _)| view! {
                    <button type="button" data-action="no-card"
                        aria-pressed=move || if skipped() { "true" } else { "false" }
                        on:click=move |_| session.send(Input::NoCard)>{label}</button>
                })}
            </div>
            {move || problem().map(|text| view! { <p class="problem" id="card-problem">{text}</p> })}
        </fieldset>
    }
}
