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
mod trial;

use leptos::prelude::*;
use mimique_study::flow::{Input, View};
use wasm_bindgen::JsCast as _;

use crate::focus;
use crate::session::Session;

/// What has to be built anew when it changes; everything else changes in place.
#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Consent,
    Questions(String),
    Page(String),
    Device,
    Calibration,
    Feedback(String),
    /// The canvas stays from one trial to the next.
    Trial,
    ReceiptPending,
    End,
    Declined,
    Withdrawn,
}

impl Shape {
    fn of(view: &View) -> Self {
        match view {
            View::Consent { .. } => Self::Consent,
            View::Questions { step, .. } => Self::Questions(step.clone()),
            View::Page { step, .. } => Self::Page(step.clone()),
            View::Device(_) => Self::Device,
            View::Calibration(_) => Self::Calibration,
            View::Feedback(feedback) => Self::Feedback(feedback.step.clone()),
            View::Trial(_) => Self::Trial,
            View::ReceiptPending { .. } => Self::ReceiptPending,
            View::End(_) => Self::End,
            View::Declined { .. } => Self::Declined,
            View::Withdrawn { .. } => Self::Withdrawn,
        }
    }
}

/// The step of a view that has one.
pub fn step_of(view: &View) -> Option<&str> {
    match view {
        View::Consent { step, .. } | View::Questions { step, .. } | View::Page { step, .. } => {
            Some(step)
        }
        View::Device(gate) => Some(&gate.step),
        View::Calibration(shown) => Some(&shown.step),
        View::Feedback(feedback) => Some(&feedback.step),
        View::Trial(trial) => Some(&trial.step),
        _ => None,
    }
}

/// Header and page.
#[component]
pub fn Pages() -> impl IntoView {
    let session = Session::here();
    let shape = Memo::new(move |_| (session.view.with(Shape::of), session.language()));
    let step = Memo::new(move |_| session.view.with(|view| step_of(view).map(str::to_owned)));
    Effect::new(move |_| {
        if let Some(step) = step.get() {
            // After the first paint of the page.
            request_animation_frame(move || {
                request_animation_frame(move || {
                    let here = session.view.with_untracked(|view| step_of(view) == Some(&step));
                    if here {
                        session.send(Input::Shown { step });
                    }
                });
            });
        }
    });
    Effect::new(move |_| {
        let language = session.language();
        set_language(&language);
        let title = &session.engine().plan.study.study_metadata.title;
        document().set_title(title.in_language(&language));
    });
    Effect::new(move |before: Option<()>| {
        shape.track();
        if before.is_some() {
            focus::rescue(&["main h1"]);
        }
    });
    view! {
        <header::Header/>
        {move || match shape.get().0 {
            Shape::Consent => view! { <consent::ConsentPage/> }.into_any(),
            Shape::Questions(_) => view! { <questions::QuestionsPage/> }.into_any(),
            Shape::Page(_) => view! { <read::ReadPage/> }.into_any(),
            Shape::Device => view! { <device::DevicePage/> }.into_any(),
            Shape::Calibration => view! { <calibration::CalibrationPage/> }.into_any(),
            Shape::Feedback(_) => view! { <feedback::FeedbackPage/> }.into_any(),
            Shape::Trial => view! { <trial::TrialPage/> }.into_any(),
            Shape::ReceiptPending => view! { <message::ReceiptPendingPage/> }.into_any(),
            Shape::End => view! { <end::EndPage/> }.into_any(),
            Shape::Declined => view! { <message::DeclinedPage/> }.into_any(),
            Shape::Withdrawn => view! { <message::WithdrawnPage/> }.into_any(),
        }}
    }
}

/// How far the session is, as a bar and in words for those who do not see it.
#[component]
fn ProgressLine(
    #[prop(into)] done: Signal<usize>,
    #[prop(into)] total: Signal<usize>,
) -> impl IntoView {
    view! {
        <div class="progress-line">
            <progress max=move || total.get().to_string() value=move || done.get().to_string()
                aria-label=move || format!("{} / {}", done.get(), total.get())></progress>
        </div>
    }
}

/// Tells browser and screen reader the language of the page.
pub fn set_language(language: &str) {
    if let Some(root) = document().document_element() {
        let _ = root.set_attribute("lang", language);
    }
}

/// The element of that identifier, or the body.
pub fn element(id: &str) -> web_sys::HtmlElement {
    document()
        .get_element_by_id(id)
        .and_then(|element| element.dyn_into().ok())
        .unwrap_or_else(|| document().body().expect("a page has a body"))
}
