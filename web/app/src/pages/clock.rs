//! How much time is left: seen every second, heard once when the end is near.

use leptos::prelude::*;
use mimique_study::flow::{ClockView, Input};

use crate::session::Session;

/// The clock of a page or a trial, with the button that gives more time.
#[component]
pub fn Clock(
    /// What it shows; none where there is no limit.
    clock: Memo<Option<ClockView>>,
) -> impl IntoView {
    let session = Session::here();
    // Memos, so that what a screen reader is told changes once and not with every second.
    let warning =
        Memo::new(move |_| clock.with(|clock| clock.as_ref().and_then(|c| c.warning.clone())));
    let extend =
        Memo::new(move |_| clock.with(|clock| clock.as_ref().and_then(|c| c.extend.clone())));
    let there = Memo::new(move |_| clock.with(Option::is_some));
    view! {
        <Show when=move || there.get()>
            <div class="clock" class:near=move || warning.with(Option::is_some)>
                // A timer is announced only when its reader asks for it.
                <span class="number" role="timer">
                    {move || clock.with(|clock| clock.as_ref().map(|c| c.text.clone()))}
                </span>
                {move || extend.get().map(|label| view! {
                    <button type="button" data-action="more-time"
                        on:click=move |_| session.send(Input::ExtendTime)>{label}</button>
                })}
                <span class="visually-hidden" role="status">{move || warning.get()}</span>
            </div>
        </Show>
    }
}
