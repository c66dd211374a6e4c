//! Mixed models of single answers, which only the script in R fits.

use std::fmt::Write;

use super::quoted;
use crate::language::Language;
use crate::report::section::Writer;
use crate::trials::measure::{Measure, MeasureKind};

/// Mixed models of each rating and each recognition on the first two factors.
pub(super) fn models(writer: &Writer<'_>) -> String {
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
