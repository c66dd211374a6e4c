//! Cells: an answer as one value or several, a time as text.

use serde_json::Value;

use mimique_study::{KindOfQuestion as _, Question};

/// `2026-11-21T08:30:00.250Z` for milliseconds since 1970 (proleptic Gregorian calendar, UTC).
pub fn iso_time(at_ms: f64) -> String {
    if !at_ms.is_finite() || at_ms.abs() > 8.0e15 {
        return String::new();
    }
    let total_ms = at_ms.floor() as i64;
    let (days, ms) = (total_ms.div_euclid(86_400_000), total_ms.rem_euclid(86_400_000));
    // Days since 0000-03-01; eras of 400 years have 146,097 days (H. Hinnant, "chrono-compatible
    // low-level date algorithms").
    let days = days + 719_468;
    let (era, day_of_era) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year_of_era =
        (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 { shifted_month + 3 } else { shifted_month - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    let (hour, minute) = (ms / 3_600_000, ms / 60_000 % 60);
    let (second, milli) = (ms / 1_000 % 60, ms % 1_000);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{milli:03}Z")
}

/// Milliseconds with three decimals, which is finer than any clock of a browser.
pub(super) fn milliseconds(value: f64) -> Value {
    number((value * 1000.0).round() / 1000.0)
}

/// A number; whole ones without a point.
pub(super) fn number(value: f64) -> Value {
    if value.fract() == 0.0 && value.abs() < 9e15 { (value as i64).into() } else { value.into() }
}

/// An answer as rows: suffix of the response's name, and the cell.
pub(super) fn answer_cells(question: &Question, answer: &Value) -> Vec<(String, Value)> {
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

    #[test]
    fn iso_time_knows_leap_years_and_times_before_1970() {
        // Values as `date -u -d @SECONDS` gives them.
        assert_eq!(iso_time(0.0), "1970-01-01T00:00:00.000Z");
        assert_eq!(iso_time(951_782_400_000.0), "2000-02-29T00:00:00.000Z");
        assert_eq!(iso_time(1_795_251_845_678.9), "2026-11-21T09:04:05.678Z");
        assert_eq!(iso_time(4_107_542_399_999.0), "2100-02-28T23:59:59.999Z");
        assert_eq!(iso_time(4_107_542_400_000.0), "2100-03-01T00:00:00.000Z");
        assert_eq!(iso_time(-1.0), "1969-12-31T23:59:59.999Z");
        assert_eq!(iso_time(f64::NAN), "");
    }
}
