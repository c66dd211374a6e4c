//! The distributions of the answers, question by question.

use maud::{Markup, html};

use super::bars::{bars_with, round};
use crate::researcher::dashboard::tally::{Distribution, Numbers, Shape};
use crate::researcher::pages::frame::Frame;

/// The distribution of the answers to each question.
pub(super) fn answers(frame: &Frame, distributions: &[Distribution], language: &str) -> Markup {
    html! {
        div.card {
            h2 { (frame.say("Answers", "Réponses")) }
            p.soft {
                (frame.say(
                    "Practice and excluded participants left out. Texts are only counted here.",
                    "Sans l’entraînement ni les participants exclus. Les textes sont seulement comptés ici.",
                ))
            }
            div.distributions lang=(language) {
                @for distribution in distributions {
                    (answer(frame, distribution))
                }
            }
        }
    }
}

fn answer(frame: &Frame, distribution: &Distribution) -> Markup {
    let caption = html! {
        (distribution.prompt) " " code { (distribution.question) }
    };
    let count_line = |count: u64| {
        let words = match count {
            1 => frame.say("answer", "réponse"),
            _ => frame.say("answers", "réponses"),
        };
        html! { (count) " " (words) }
    };
    match &distribution.shape {
        Shape::Counts(counts) => {
            bars_with(&caption, counts.iter().map(|(label, count)| (label.as_str(), *count)))
        }
        Shape::Numbers(numbers) => {
            summed(frame, &caption, &html! { (count_line(numbers.count)) }, numbers)
        }
        Shape::Thresholds(numbers) => {
            let what = frame.say("threshold so far", "seuil jusqu’ici");
            summed(frame, &caption, &of_people(frame, what, numbers.count), numbers)
        }
        Shape::Levels(numbers) => {
            let what = frame.say("level of the staircases now", "niveau actuel des escaliers");
            summed(frame, &caption, &of_people(frame, what, numbers.count), numbers)
        }
        Shape::Texts(count) => html! {
            div { p.caption { (caption) } p lang=(frame.language.code()) { (count_line(*count)) } }
        },
    }
}

/// Numbers in a line: how many, the least and the greatest, the mean.
fn summed(frame: &Frame, caption: &Markup, count: &Markup, numbers: &Numbers) -> Markup {
    html! {
        div {
            p.caption { (caption) }
            p lang=(frame.language.code()) {
                (count) ", " (round(frame.language, numbers.least)) " – " (round(frame.language, numbers.greatest)) ", "
                (frame.say("mean", "moyenne")) " " (round(frame.language, numbers.sum / numbers.count as f64))
            }
        }
    }
}

fn of_people(frame: &Frame, what: &str, count: u64) -> Markup {
    let people = match count {
        1 => frame.say("person", "personne"),
        _ => frame.say("people", "personnes"),
    };
    html! { (what) " (" (count) " " (people) ")" }
}
