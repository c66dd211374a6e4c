//! Questions on the screen: a file per kind. Nothing is pre-selected; each works by keyboard alone.

mod best_worst;
mod choice;
mod field;
mod grid;
mod likert;
mod matrix;
mod media;
mod ranking;
mod slider;

use mimique_session::flow::{Input, QuestionKindView, QuestionView};
use serde_json::Value;

use crate::act::Act;
use crate::dom::{Element, el, words};
use crate::engine::Engine;

/// What every kind of control needs: how to read and to give the answer.
struct Answering<'a> {
    engine: &'a Engine,
    /// Begins the names and identifiers of the fields.
    name: String,
    question: &'a QuestionView,
}

/// An answer to a question; null takes it back. `change` makes it from the answer so far.
fn change(question: &str, change: impl FnOnce(Option<&Value>) -> Value + 'static) -> Act {
    Act::Change { question: question.to_owned(), change: Box::new(change) }
}

impl Answering<'_> {
    /// The answer so far.
    fn value(&self) -> Option<&Value> {
        self.question.value.as_ref()
    }

    /// Whether the answer so far is this text.
    fn is(&self, wanted: &str) -> bool {
        self.value().and_then(Value::as_str) == Some(wanted)
    }

    /// Gives an answer when something happens to a field; null takes it back.
    fn gives<E>(&self, answer: impl Fn(E) -> Value + 'static) -> impl Fn(E) -> Input + 'static {
        let question = self.question.id.clone();
        move |event| Input::Answer { question: question.clone(), value: answer(event) }
    }

    /// What is wrong with the answer.
    fn problem(&self) -> Option<&str> {
        self.question.problem.as_deref()
    }

    /// The identifiers of help and problem, as `aria-describedby` wants them.
    fn described(&self) -> Option<String> {
        let help = self.question.help.as_ref().map(|_| self.element("help"));
        let problem = self.problem().map(|_| self.element("problem"));
        match (help, problem) {
            (Some(help), Some(problem)) => Some([help, problem].join(" ")),
            (help, problem) => help.or(problem),
        }
    }

    /// An identifier for an element of this question.
    fn element(&self, part: &str) -> String {
        [self.name.as_str(), part].concat()
    }

    /// A field that says itself what is asked and what is wrong with it.
    fn spoken(&self, field: Element) -> Element {
        field
            .set("aria-label", &self.question.prompt)
            .maybe("aria-describedby", self.described().as_deref())
            .flag("aria-invalid", self.problem().is_some())
    }

    /// A button of a group, one of which is chosen.
    fn radio(&self, part: &str, value: &str, checked: bool) -> Element {
        el("input", "")
            .set("type", "radio")
            .set("name", &self.element(part))
            .set("value", value)
            .checked(checked)
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

/// A question: legend, help, control, problem. `name` distinguishes the fields of the page.
pub fn question(engine: &Engine, name: &str, question: &QuestionView) -> Element {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    let fields: String = "q-".chars().chain(name.chars().map(plain)).chain(['-']).collect();
    let answering = Answering { engine, name: fields, question };
    // One answer out of several is one widget; elsewhere the fields say themselves what is wrong.
    let radios = matches!(
        question.kind,
        QuestionKindView::SingleChoice { .. }
            | QuestionKindView::Likert { .. }
            | QuestionKindView::ValenceArousal { .. }
    );
    let wrong = answering.problem();
    let mut legend = el("legend", "").text(&question.prompt);
    if let Some(mark) = &question.optional_mark {
        let mark = el("span", "optional").text(" (").text(mark).text(")");
        legend = legend.with(mark);
    }
    let mut set = el("fieldset", "question")
        .key(name)
        .set("data-question", &question.id)
        .maybe("aria-describedby", answering.described().as_deref())
        .flag("aria-invalid", radios && wrong.is_some())
        .flag("aria-required", radios && question.required)
        .maybe("data-invalid", wrong.map(|_| "true"))
        .with(legend);
    if radios {
        set = set.set("role", "radiogroup");
    }
    if let Some(path) = &question.video {
        set = set.with(media::sign_language_video(engine, path, &question.prompt, "prompt"));
    }
    if let Some(text) = &question.help {
        set = set.with(words("p", "hint", text).key("help").set("id", &answering.element("help")));
    }
    if !question.signs.is_empty() {
        let signs = question.signs.iter().map(|sign| choice::signed(engine, sign)).collect();
        set = set.with(el("div", "choices").key("signs").all(signs));
    }
    let problem = wrong.map(|text| {
        words("p", "problem", text).key("problem").set("id", &answering.element("problem"))
    });
    set.all(control(&answering)).option(problem)
}

fn control(answering: &Answering) -> Vec<Element> {
    match &answering.question.kind {
        QuestionKindView::SingleChoice { options } => choice::single(answering, options),
        QuestionKindView::MultipleChoice { options, maximum } => {
            choice::multiple(answering, options, *maximum)
        }
        QuestionKindView::Likert { points, left, right } => {
            likert::likert(answering, points, left, right)
        }
        QuestionKindView::Slider { minimum, maximum, step, left, right, .. } => {
            slider::slider(answering, [*minimum, *maximum, *step], [left, right])
        }
        QuestionKindView::Number { minimum, maximum, integer, unit } => {
            field::number(answering, *minimum, *maximum, *integer, unit.as_deref())
        }
        QuestionKindView::Text { long, max_length } => field::text(answering, *long, *max_length),
        QuestionKindView::Matrix { rows, options } => matrix::matrix(answering, rows, options),
        QuestionKindView::Ranking { options } => ranking::ranking(answering, options),
        QuestionKindView::ValenceArousal { num_items, left, right, bottom, top } => {
            grid::grid(answering, *num_items, [left, right, bottom, top])
        }
        QuestionKindView::BestWorst { best, worst, options } => {
            best_worst::best_worst(answering, best, worst, options)
        }
        // A kind of a later version of the study file: the page is older than the server.
        _ => vec![words("p", "notice bad", "?").key("unknown")],
    }
}

/// The names of the ends of a scale, above it.
fn ends(left: &str, right: &str) -> Element {
    el("div", "likert-ends")
        .key("ends")
        .set("aria-hidden", "true")
        .with(words("span", "", left))
        .with(words("span", "", right))
}
