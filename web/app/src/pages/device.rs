//! The device gate: what is missing, and what to do about it.

use leptos::prelude::*;
use mimique_study::flow::{DeviceView, Input, View};

use super::ProgressLine;
use crate::session::Session;

/// The device gate. It changes in place when the window changes its size.
#[component]
pub fn DevicePage() -> impl IntoView {
    let session = Session::here();
    let View::Device(first) = session.view.get_untracked() else {
        return ().into_any();
    };
    let (step, progress, heading) = (first.step.clone(), first.progress, first.heading.clone());
    let gate: Memo<DeviceView> = Memo::new(move |last: Option<&DeviceView>| {
        session.view.with(|view| match view {
            View::Device(gate) => (**gate).clone(),
            _ => last.cloned().unwrap_or_else(|| (*first).clone()),
        })
    });
    let send = move |input: fn() -> Input| move |_| session.send(input());
    let (next, again, give_up) =
        (send(|| Input::Next), send(|| Input::MeasureAgain), send(|| Input::GiveUp));
    let without = send(|| Input::WithoutFullscreen);
    view! {
        <main class="page" data-view="device" data-step=step
            data-fine=move || gate.with(|gate| gate.button.can_submit.to_string())>
            <ProgressLine done=progress.done total=progress.total/>
            <div class="card">
                <h1 tabindex="-1">{heading}</h1>
                <div role="status">
                    <p>{move || gate.with(|gate| gate.text.clone())}</p>
                    {move || gate.with(|gate| gate.problems.clone()).into_iter().map(|(what, remedy)| view! {
                        <div class="notice warn"><p><strong>{what}</strong></p><p>{remedy}</p></div>
                    }).collect_view()}
                </div>
                <div class="actions">
                    <Show when=move || gate.with(|gate| gate.button.can_submit)>
                        <button type="button" class="primary" data-action="next" on:click=next>
                            {move || gate.with(|gate| gate.button.label.clone())}
                        </button>
                    </Show>
                    {move || gate.with(|gate| gate.without.clone()).map(|label| view! {
                        <button type="button" data-action="without-fullscreen" on:click=without>{label}</button>
                    })}
                    {move || gate.with(|gate| gate.again.clone()).map(|label| view! {
                        <button type="button" class="primary" data-action="again" on:click=again>{label}</button>
                    })}
                    {move || gate.with(|gate| gate.give_up.clone()).map(|label| view! {
                        <button type="button" data-action="give-up" on:click=give_up>{label}</button>
                    })}
                </div>
            </div>
        </main>
    }
    .into_any()
}
