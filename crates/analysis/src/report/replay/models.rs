//! Mixed models of single answers, which only the script in R fits.

use std::fmt::Write;

use mimique_locale::Language;
use mimique_stats::Outcome;

use super::quoted;
use crate::report::section::Writer;
use crate::trials::measure::{Measure, MeasureKind};

/// All models.
pub(super) fn models(writer: &Writer<'_>) -> String {
    of_questions(writer) + &of_hypotheses(writer)
}

/// Mixed models of each rating and each recognition on the first two factors.
fn of_questions(writer: &Writer<'_>) -> String {
    let mut text = String::new();
    let Some(first) = writer.factors.first() else { return text };
    let second = writer.factors.get(1);
    let fixed = if second.is_some() { "a * b" } else { "a" };
    let clips = if writer.one_clip_a_cell() { "" } else { " + (1 | clip)" };
    for asked in writer.export.questions(writer.study) {
        let Some(measure) = Measure::of_question(writer.export, &asked, Language::English) else {
            continue;
        };
        let data = format!(
            "data.frame(y = number({}), a = factor(trials[[{}]]), {}person = factor(person), clip = factor(trials$stimulus))",
            quoted(&measure.id),
            quoted(first),
            second.map_or_else(String::new, |second| {
                format!("b = factor(trials[[{}]]), ", quoted(second))
            })
        );
        let random = format!("(1 | person) + (1 | person:a){clips}");
        let (title, package, model) = if measure.kind == MeasureKind::Recognition {
            (
                format!("Binomial mixed model of {}", measure.id),
                "lme4",
                format!("lme4::glmer(y ~ {fixed} + {random}, data, family = binomial)"),
            )
        } else if measure.scale.is_some() {
            (
                format!("Cumulative link mixed model of {}", measure.id),
                "ordinal",
                format!("ordinal::clmm(ordered(y) ~ {fixed} + {random}, data)"),
            )
        } else {
            continue;
        };
        let by = second.map_or_else(String::new, |second| format!(", b = {second}"));
        let title = quoted(&format!("{title} (a = {first}{by})"));
        let _ = writeln!(
            text,
            "fit({title}, \"{package}\", function() {{\n  data <- {data}\n  {model}\n}})"
        );
    }
    text
}

/// The mixed models of each hypothesis that other clips are asked about.
fn of_hypotheses(writer: &Writer<'_>) -> String {
    let mut text = String::new();
    for result in &writer.results.hypotheses {
        let (Some(found), Some(factor)) = (&result.other_clips, result.factors.first()) else {
            continue;
        };
        let title = format!("For other clips, hypothesis {}", result.id);
        let (measure, of_clips) = (quoted(&result.measure), quoted(factor));
        let levels: Vec<String> = found.levels.iter().map(|level| quoted(level)).collect();
        let levels = levels.join(", ");
        let data = format!(
            "data.frame(y = number({measure}), a = factor(trials[[{of_clips}]], c({levels})), person = factor(person), segment = factor(trials$segment), clip = factor(trials$stimulus))"
        );
        // Factors of people, and two factors, stand in no column of trials.
        let one = found.min_f.is_some();
        if let (true, Some(Outcome::Ok(model))) = (one, &found.linear_model) {
            let title = quoted(&format!("{title}, linear (a = {factor})"));
            let left_out = |own: &str| model.left_out.iter().any(|name| name == own);
            let terms = [
                (format!("participant:{factor}"), "person:a"),
                ("segment".to_owned(), "segment"),
                (format!("segment:{factor}"), "segment:a"),
                ("participant:segment".to_owned(), "person:segment"),
            ];
            let terms = terms.iter().filter(|(name, _)| !left_out(name));
            let terms: String = terms.map(|(_, term)| format!(" + (1 | {term})")).collect();
            let _ = writeln!(
                text,
                "fit({title}, \"lmerTest\", function() {{\n  data <- {data}\n  lmerTest::lmer(y ~ a + (1 | person){terms}, data)\n}})"
            );
        }
        if matches!(found.mixed_model, Some(Outcome::Ok(_))) {
            let title = quoted(&format!("{title}, cumulative (a = {factor})"));
            let _ = writeln!(
                text,
                "fit({title}, \"ordinal\", function() {{\n  data <- {data}\n  ordinal::clmm(ordered(y) ~ a + (1 | person) + (1 | person:a) + (1 | segment) + (1 | clip), data)\n}})"
            );
        }
    }
    text
}
