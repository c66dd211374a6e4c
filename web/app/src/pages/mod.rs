//! The frame of every page, and which page stands in it.

mod calibration;
mod clock;
mod consent;
mod device;
mod end;
pub mod failure;
mod feedback;
mod header;
mod message;
mod questions;
mod read;
mod scripted;
mod trial;

use mimique_session::flow::{Input, ProgressView, View};
use mimique_study::text::Words;

use crate::browser::focus;
use crate::dom::{Element, FieldEvent, el, words};
use crate::engine::Engine;

pub use trial::{WatchedClip, phase_word};

/// What has to be built anew when it changes; everything else changes in place. The canvas stays from
/// one trial to the next.
pub fn shape(view: &View, language: &str) -> String {
    let (page, step) = match view {
        View::Consent { .. } => ("consent", ""),
        View::Questions { step, .. } => ("questions", step.as_str()),
        View::Page { step, .. } => ("page", step.as_str()),
        View::Device(_) => ("device", ""),
        View::Calibration(_) => ("calibration", ""),
        View::Scripted(shown) => (shown.step.as_str(), ""),
        View::Feedback(feedback) => ("feedback", feedback.step.as_str()),
        View::Trial(_) => ("trial", ""),
        View::ReceiptPending { .. } => ("receipt", ""),
        View::End(_) => ("end", ""),
        View::Declined { .. } => ("declined", ""),
        View::Withdrawn { .. } => ("withdrawn", ""),
    };
    [page, step, language].join(" ")
}

/// The step of a view that has one.
pub fn step_of(view: &View) -> Option<&str> {
    match view {
        View::Consent { step, .. } | View::Questions { step, .. } | View::Page { step, .. } => {
            Some(step)
        }
        View::Device(gate) => Some(&gate.step),
        View::Calibration(shown) => Some(&shown.step),
        View::Scripted(shown) => Some(&shown.step),
        View::Feedback(feedback) => Some(&feedback.step),
        View::Trial(trial) => Some(&trial.step),
        _ => None,
    }
}

/// Header and page.
pub fn pages(engine: &Engine, view: &View, shape: &str, watched: &WatchedClip) -> Vec<Element> {
    let main = match view {
        View::Consent { .. } => consent::consent(engine, view),
        View::Questions { .. } => questions::questions(engine, view),
        View::Page { .. } => read::read(view),
        View::Device(gate) => device::device(gate),
        View::Calibration(shown) => calibration::calibration(shown),
        View::Scripted(shown) => scripted::scripted(shown),
        View::Feedback(feedback) => feedback::feedback(feedback),
        View::Trial(trial) => trial::trial(engine, trial, watched),
        View::ReceiptPending { heading, text, stored, total } => {
            message::receipt_pending(heading, text, *stored, *total)
        }
        View::End(end) => end::end(engine, end),
        View::Declined { heading, text } => message::declined(engine, heading, text),
        View::Withdrawn { heading, text, confirmed } => {
            message::withdrawn(heading, text, *confirmed)
        }
    };
    // Steps and clips have names of the study's in the log; the page shows their places alone.
    let step = step_of(view).map(|_| mark(engine));
    let mut all = header::header(engine, view);
    all.push(main.maybe("data-step", step.as_deref()).key(shape));
    all
}

/// What names the step on the screen, and nothing of it: its place.
fn mark(engine: &Engine) -> String {
    ["s", &engine.state().record.step.to_string()].concat()
}

/// Before there is anything to show.
pub fn opening() -> Element {
    let card = el("div", "card").with(words("p", "soft", "…"));
    main("page", "opening").key("opening").with(card)
}

/// While the session is being begun.
pub fn entering(fixed: &Words) -> Element {
    let card = el("div", "card").set("role", "status").with(words("p", "", fixed.beginning()));
    main("page", "opening").key("entering").with(card)
}

/// The frame of a page.
fn main(class: &str, view: &str) -> Element {
    el("main", class).set("data-view", view)
}

/// Its heading, which takes the focus when the page is new.
fn heading(text: &str) -> Element {
    words("h1", "", text).set("tabindex", "-1")
}

/// A button; what it does is its key.
fn button(class: &str, action: &str, label: &str) -> Element {
    words("button", class, label).key(action).set("type", "button").set("data-action", action)
}

/// What a button does that hands in an input.
fn sends(input: fn() -> Input) -> impl Fn(FieldEvent) -> Input {
    move |_| input()
}

/// The button that leads on.
fn next(label: &str) -> Element {
    button("primary", "next", label).on("click", sends(|| Input::Next))
}

/// A form that leads on when it is sent; what has to be corrected then gets the focus.
fn form() -> Element {
    el("form", "card").set("novalidate", "").on("submit", |_| {
        focus::focus_later(&[
            "main [data-invalid] :is(input, textarea, button):checked",
            "main [data-invalid] :is(input, textarea, button):not(:disabled)",
        ]);
        Input::Next
    })
}

/// The button of a form.
fn submit(label: &str) -> Element {
    let button = words("button", "primary", label).set("type", "submit");
    el("div", "actions").with(button.set("data-action", "next"))
}

/// What has to be corrected, below a field.
fn problem(text: Option<&str>, id: &str) -> Option<Element> {
    text.map(|text| words("p", "problem", text).key("problem").set("id", id))
}

/// A length in CSS pixels.
fn px(length: f64) -> String {
    [hundredth(length).as_str(), "px"].concat()
}

/// A number to its second decimal.
fn hundredth(number: f64) -> String {
    ((number * 100.0).round() / 100.0).to_string()
}

/// How far the session is, as a bar and in words for those who do not see it.
fn progress_line(progress: ProgressView) -> Element {
    let (done, total) = (progress.done.to_string(), progress.total.to_string());
    let label = [done.as_str(), total.as_str()].join(" / ");
    let bar = el("progress", "").set("max", &total).set("value", &done).set("aria-label", &label);
    el("div", "progress-line").key("progress").with(bar)
}
