//! The size of the screen: a card drawn to be made as large as a real one, and the distance.

use mimique_session::flow::{CalibrationView, CardView, DistanceView, Input};

use super::{button, form, heading, main, problem, progress_line, px, submit};
use crate::browser::document;
use crate::dom::{Element, el, words};

/// Widths that the slider reaches, CSS pixels: from a phone held far out of scale to a wall.
const WIDTHS: (f64, f64) = (150.0, 900.0);

/// The size of the screen.
pub fn calibration(shown: &CalibrationView) -> Element {
    let form = form()
        .with(heading(&shown.heading))
        .paragraphs(&shown.text)
        .option(shown.card.as_ref().map(card))
        .option(shown.distance.as_ref().map(distance))
        .with(submit(&shown.button.label));
    main("page wide-card", "calibration").with(progress_line(shown.progress)).with(form)
}

/// The distance of the eyes.
fn distance(shown: &DistanceView) -> Element {
    let wrong = shown.problem.as_deref();
    let label = words("label", "", &shown.label).set("for", "distance");
    let field = el("input", "")
        .set("id", "distance")
        .set("type", "number")
        .set("inputmode", "numeric")
        .set("min", "15")
        .set("max", "300")
        .set("step", "1")
        .maybe("value", shown.value.map(|number| number.to_string()).as_deref())
        .flag("aria-invalid", wrong.is_some())
        .maybe("aria-describedby", wrong.map(|_| "distance-problem"))
        .on("change", |field| Input::Distance(field.number()));
    fieldset("distance", wrong)
        .with(el("legend", "").with(label))
        .with(field)
        .text(" ")
        .text(&shown.unit)
        .option(problem(wrong, "distance-problem"))
}

fn fieldset(question: &str, wrong: Option<&str>) -> Element {
    el("fieldset", "question")
        .key(question)
        .set("data-question", question)
        .maybe("data-invalid", wrong.map(|_| "true"))
}

/// The picture of the card, its slider, and the way around it.
fn card(shown: &CardView) -> Element {
    let wrong = shown.problem.as_deref();
    let width = shown.width_px;
    let picture = el("div", "bank-card")
        .set("aria-hidden", "true")
        .style("--card-long", &px(width))
        .style("--card-short", &px(shown.height_px))
        .with(el("span", "chip"));
    let slider = el("input", "")
        .set("type", "range")
        .set("aria-label", &shown.label)
        .set("min", &WIDTHS.0.to_string())
        .set("max", &WIDTHS.1.to_string())
        .set("step", "0.5")
        .set(
            "aria-describedby",
            if wrong.is_some() { "card-hint card-problem" } else { "card-hint" },
        )
        .flag("aria-invalid", wrong.is_some())
        .value(&width.to_string())
        .handles("input", |field| field.number().map(|px| card_width(px).into()));
    let (smaller, larger) = &shown.steps;
    let no_card = shown.no_card.as_ref().map(|(label, skipped)| {
        button("", "no-card", label)
            .set("aria-pressed", if *skipped { "true" } else { "false" })
            .on("click", super::sends(|| Input::NoCard))
    });
    let row = el("div", "row")
        .with(button("", "smaller", smaller).on("click", move |_| card_width(width - 1.0)))
        .with(button("", "larger", larger).on("click", move |_| card_width(width + 1.0)))
        .option(no_card);
    fieldset("card", wrong)
        .with(words("legend", "", &shown.label))
        .with(words("p", "hint", &shown.instruction).key("hint").set("id", "card-hint"))
        .with(el("div", "bank-card-frame").with(picture))
        .with(slider)
        .with(row)
        .option(problem(wrong, "card-problem"))
}

fn card_width(px: f64) -> Input {
    let device_pixel_ratio = document::pixel_ratio();
    Input::CardWidth { px: px.clamp(WIDTHS.0, WIDTHS.1), device_pixel_ratio }
}
