//! Cells: an answer as one value or several, a time as text.

use serde_json::Value;

use mimique_study::{KindOfQuestion as _, Question};

/// Milliseconds with three decimals, which is finer than any clock of a browser.
pub(super) fn milliseconds(value: f64) -> Value {
    number((value * 1000.0).round() / 1000.0)
}

/// A number; whole ones without a point.
pub(super) fn number(value: f64) -> Value {
    if value.fract() == 0.0 && value.abs() < 9e15 { (value as i64).into() } else { value.into() }
}

/// An answer as rows: suffix of the response's name, and the cell. A rating that followed the clip is its mean.
pub(super) fn answer_cells(question: &Question, answer: &Value) -> Vec<(String, Value)> {
    if question.kind.is_traced() {
        let course: Vec<f64> =
            answer.as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
        let mean = course.iter().sum::<f64>() / course.len() as f64;
        let cell = if course.is_empty() { Value::Null } else { milliseconds(mean) };
        return vec![(String::new(), cell)];
    }
    match question.kind.parts() {
        Some(parts) => {
            let cell = |part: &str| plain(Some(&question.kind.part_of(answer, part)));
            parts.into_iter().map(|part| (format!(".{part}"), cell(part))).collect()
        }
        None => vec![(String::new(), plain(Some(answer)))],
    }
}

/// One plain value: several choices are joined by `|`.
pub(super) fn plain(value: Option<&Value>) -> Value {
    match value {
        None => Value::Null,
        Some(Value::Number(given)) => given.as_f64().map_or(Value::Null, number),
        Some(Value::Array(items)) => {
            let words: Vec<String> = items
                .iter()
                .map(|item| item.as_str().map_or_else(|| item.to_string(), str::to_owned))
                .collect();
            words.join("|").into()
        }
        Some(Value::Object(map)) => Value::Object(map.clone()).to_string().into(),
        Some(other) => other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_answers_have_the_names_that_hypotheses_give_them() {
        let text = std::fs::read_to_string(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../study-config/template.json"
        ));
        let value = mimique_study::parse(&text.expect("the template")).expect("JSON");
        let study = mimique_study::Study::from_value(&value).expect("a study");
        let mut parts = 0;
        for question in study.all_questions() {
            let cells = answer_cells(question, &Value::Null).into_iter();
            let rows: Vec<String> =
                cells.map(|(suffix, _)| question.id.clone() + &suffix).collect();
            assert_eq!(rows, question.response_ids());
            parts += usize::from(rows.len() > 1);
        }
        assert!(parts >= 3, "matrix, ranking and grid");
    }
}
