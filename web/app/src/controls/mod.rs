//! Questions on the screen: a file a kind. Nothing is pre-selected; each works by keyboard alone.

mod choice;
mod field;
mod grid;
mod likert;
mod matrix;
mod media;
mod ranking;
mod slider;

use leptos::prelude::*;
use mimique_study::flow::{Input, QuestionKindView, QuestionView};
use serde_json::Value;

use crate::session::Session;

/// What every kind of control needs: how to read and to give the answer.
#[derive(Clone)]
struct Answering {
    /// Distinguishes the fields of the page: names and identifiers are made of it.
    name: String,
    id: String,
    now: Memo<Option<QuestionView>>,
    session: Session,
    help: bool,
}

impl Answering {
    /// The answer so far (tracked).
    fn value(&self) -> Option<Value> {
        self.now.with(|now| now.as_ref().and_then(|question| question.value.clone()))
    }

    /// Gives an answer; null takes it back.
    fn give(&self, value: Value) {
        self.session.send(Input::Answer { question: self.id.clone(), value });
    }

    /// Whether the answer so far is this text (tracked).
    fn is(&self, wanted: &str) -> bool {
        self.value().is_some_and(|value| value.as_str() == Some(wanted))
    }

    /// What is wrong with the answer (tracked).
    fn problem(&self) -> Option<String> {
        self.now.with(|now| now.as_ref().and_then(|question| question.problem.clone()))
    }

    /// The identifiers of help and problem, as `aria-describedby` wants them (tracked).
    fn described(&self) -> Option<String> {
        let help = self.help.then(|| self.element("help"));
        let ids: Vec<String> =
            help.into_iter().chain(self.problem().map(|_| self.element("problem"))).collect();
        (!ids.is_empty()).then(|| ids.join(" "))
    }

    /// `aria-invalid` (tracked).
    fn invalid(&self) -> Option<&'static str> {
        self.problem().map(|_| "true")
    }

    /// An identifier for an element of this question.
    fn element(&self, part: &str) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
        format!("q-{}-{part}", self.name.chars().map(plain).collect::<String>())
    }
}

/// A number as people write it: 51, not 51.0.
fn plain(number: f64) -> Value {
    if number.fract() == 0.0 && number.abs() < 9e15 {
        Value::from(number as i64)
    } else {
        Value::from(number)
    }
}

/// A question: legend, help, control, problem.
#[component]
pub fn QuestionField(
    /// Distinguishes the fields of the page.
    name: String,
    /// The question as it is first shown.
    first: QuestionView,
    /// The question as it is now.
    now: Memo<Option<QuestionView>>,
) -> impl IntoView {
    let session = Session::here();
    let answering =
        Answering { name, id: first.id.clone(), now, session, help: first.help.is_some() };
    let (help_id, problem_id) = (answering.element("help"), answering.element("problem"));
    // One answer out of several is one widget; elsewhere the fields say themselves what is wrong.
    let radios = matches!(
        first.kind,
        QuestionKindView::SingleChoice { .. }
            | QuestionKindView::Likert { .. }
            | QuestionKindView::ValenceArousal { .. }
    );
    let required = (radios && first.required).then_some("true");
    let (of, wrong, tell) = (answering.clone(), answering.clone(), answering.clone());
    let invalid = Signal::derive_local(move || wrong.invalid());
    let control = match first.kind {
        QuestionKindView::SingleChoice { options } => choice::single(answering, options).into_any(),
        QuestionKindView::MultipleChoice { options, maximum } => {
            choice::multiple(answering, options, maximum).into_any()
        }
        QuestionKindView::Likert { points, left, right } => {
            likert::likert(answering, points, left, right).into_any()
        }
        QuestionKindView::Slider { minimum, maximum, step, left, right } => {
            slider::slider(answering, minimum, maximum, step, left, right).into_any()
        }
        QuestionKindView::Number { minimum, maximum, integer, unit } => {
            field::number(answering, minimum, maximum, integer, unit).into_any()
        }
        QuestionKindView::Text { long, max_length } => {
            field::text(answering, long, max_length).into_any()
        }
        QuestionKindView::Matrix { rows, options } => {
            matrix::matrix(answering, rows, options).into_any()
        }
        QuestionKindView::Ranking { options } => ranking::ranking(answering, options).into_any(),
        QuestionKindView::ValenceArousal { num_items, left, right, bottom, top } => {
            grid::grid(answering, num_items, [left, right, bottom, top]).into_any()
        }
        // A kind of a later version of the study file: the page is older than the server.
        _ => view! { <p class="notice bad">"?"</p> }.into_any(),
    };
    let prompt = first.prompt.clone();
    view! {
        <fieldset class="question" data-question=first.id role=radios.then_some("radiogroup")
            aria-required=required aria-describedby=move || of.described()
            aria-invalid=move || invalid.get().filter(|_| radios) data-invalid=invalid>
            <legend>
                {first.prompt}
                {first.optional_mark.map(|mark| view! { <span class="optional">" ("{mark}")"</span> })}
            </legend>
            {first.video.map(|path| view! {
                <media::SignedVideo path label=prompt class="prompt"/>
            })}
            {first.help.map(|text| view! { <p class="hint" id=help_id.clone()>{text}</p> })}
            {control}
            {move || tell.problem().map(|text| view! {
                <p class="problem" id=problem_id.clone()>{text}</p>
            })}
        </fieldset>
    }
}
