//! An answer in the words that the participant read.

use mimique_session::flow::{ChoiceView, QuestionKindView};
use serde_json::Value;

/// An answer, by the control that gave it.
pub(super) fn answer_in_words(kind: &QuestionKindView, value: &Value) -> String {
    use QuestionKindView as Kind;
    match (kind, value) {
        (Kind::Keys { options, .. } | Kind::SingleChoice { options }, Value::String(_)) => {
            label(options, value)
        }
        (Kind::MultipleChoice { options, .. }, Value::Array(chosen)) => {
            let labels: Vec<String> = chosen.iter().map(|each| label(options, each)).collect();
            labels.join(", ")
        }
        (Kind::Ranking { options }, Value::Array(ranked)) => {
            let places = ranked.iter().zip(1..);
            let labels: Vec<String> =
                places.map(|(each, place)| format!("{place}. {}", label(options, each))).collect();
            labels.join(" ")
        }
        (Kind::Likert { points, left, right }, Value::Number(_)) => {
            let of = |number: Option<i64>| {
                points.iter().find(|(each, _)| Some(*each) == number).map(|(_, label)| &**label)
            };
            let ends = [points.first(), points.last()].map(|end| end.map(|(number, _)| *number));
            let own = of(value.as_i64()).unwrap_or_default();
            match (own, ends) {
                ("", [Some(first), Some(last)]) => {
                    format!("{value} ({first} {left} – {last} {right})")
                }
                (own, _) => format!("{value} ({own})"),
            }
        }
        (Kind::Slider { minimum, maximum, left, right, .. }, Value::Number(_)) => {
            format!("{value} ({minimum} {left} – {maximum} {right})")
        }
        // The course of a line that was moved while the clip played: where it stood at the end.
        (Kind::Slider { .. }, Value::Array(course)) => {
            format!("… {}", course.last().map(plain).unwrap_or_default())
        }
        (Kind::Number { unit, .. }, Value::Number(_)) => {
            format!("{value} {}", unit.as_deref().unwrap_or_default()).trim_end().to_owned()
        }
        (Kind::Matrix { rows, options }, Value::Object(chosen)) => {
            let row = |row: &ChoiceView| {
                let own = chosen.get(&row.value).map(|own| label(options, own));
                format!("{}: {}", row.label, own.as_deref().unwrap_or("–"))
            };
            rows.iter().map(row).collect::<Vec<_>>().join("; ")
        }
        (Kind::BestWorst { best, worst, options }, Value::Object(picks)) => {
            let pick = |name: &str| picks.get(name).map(|own| label(options, own));
            let [first, last] = ["best", "worst"].map(|name| pick(name).unwrap_or("–".to_owned()));
            format!("{best} {first}; {worst} {last}")
        }
        (Kind::ValenceArousal { left, right, bottom, top, .. }, Value::Object(point)) => {
            let axis = |name: &str| point.get(name).map(plain).unwrap_or_default();
            let [valence, arousal] = ["valence", "arousal"].map(axis);
            format!("{left} – {right}: {valence}; {bottom} – {top}: {arousal}")
        }
        _ => plain(value),
    }
}

/// The label of an option, or what was answered where no option is it.
fn label(options: &[ChoiceView], value: &Value) -> String {
    let own = options.iter().find(|option| Some(&*option.value) == value.as_str());
    own.map_or_else(|| plain(value), |option| option.label.clone())
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn options() -> Vec<ChoiceView> {
        let option = |value: &str, label: &str| ChoiceView {
            value: value.to_owned(),
            label: label.to_owned(),
            image: None,
            video: None,
        };
        vec![option("joy", "la joie"), option("fear", "la peur")]
    }

    #[test]
    fn answers_are_told_in_the_words_that_were_read() {
        let likert = QuestionKindView::Likert {
            points: (1..=7)
                .map(|point| (point, if point == 7 { "tout à fait" } else { "" }.to_owned()))
                .collect(),
            left: "pas du tout".to_owned(),
            right: "tout à fait".to_owned(),
        };
        let matrix = QuestionKindView::Matrix { rows: options(), options: options() };
        let text = QuestionKindView::Text { long: true, max_length: 100 };
        for (kind, value, words) in [
            (QuestionKindView::SingleChoice { options: options() }, json!("fear"), "la peur"),
            (QuestionKindView::SingleChoice { options: options() }, json!("other"), "other"),
            (
                QuestionKindView::MultipleChoice { options: options(), maximum: None },
                json!(["fear", "joy"]),
                "la peur, la joie",
            ),
            (
                QuestionKindView::Ranking { options: options() },
                json!(["fear", "joy"]),
                "1. la peur 2. la joie",
            ),
            (likert.clone(), json!(6), "6 (1 pas du tout – 7 tout à fait)"),
            (likert, json!(7), "7 (tout à fait)"),
            (matrix, json!({"joy": "fear"}), "la joie: la peur; la peur: –"),
            (text, json!("=SUM(1)"), "=SUM(1)"),
        ] {
            assert_eq!(answer_in_words(&kind, &value), words);
        }
    }
}
