//! The figures of a report, each with alternative text and its data as a table.

mod boxes;
pub(crate) mod conditions;
mod confusion;
mod detection;
mod differences;
mod equivalence;
pub(crate) mod flow_chart;
mod likert;
mod mixed_model;
pub(crate) mod people;
mod roc;
mod scatter;
mod shares;
mod specification_curve;
mod stacked;
mod traces;

pub(crate) use boxes::boxes;
pub(crate) use confusion::confusion;
pub(crate) use detection::{DetectionPanel, DetectionPoints, detection_planes};
pub(crate) use differences::differences;
pub(crate) use equivalence::{EquivalenceInterval, equivalence_zone};
pub(crate) use likert::likert;
pub(crate) use mixed_model::{deviations, model_shares};
pub(crate) use roc::roc_curves;
pub(crate) use scatter::{ScatterPanel, scatter};
pub(crate) use shares::shares;
pub(crate) use specification_curve::{Choices, CurvePoint, CurveWords, specification_curve};
pub(crate) use traces::{TraceSpans, traces};

use mimique_locale::Language;

use crate::trials::measure::MeasureKind;

/// The title of an axis of values, with their unit.
fn values_title(language: Language, kind: MeasureKind) -> &'static str {
    match kind {
        MeasureKind::Rating => language.pick("answer (points)", "réponse (points)"),
        MeasureKind::Recognition => {
            language.pick("share of right answers", "part de réponses justes")
        }
        MeasureKind::ResponseTime => language.pick("response time (s)", "temps de réponse (s)"),
        MeasureKind::Choice => language.pick("share of choices", "part des choix"),
    }
}

/// The same of differences of values.
fn differences_title(language: Language, kind: MeasureKind) -> &'static str {
    match kind {
        MeasureKind::Rating => {
            language.pick("difference of answers (points)", "différence des réponses (points)")
        }
        MeasureKind::Recognition => language.pick(
            "difference of shares of right answers (percentage points)",
            "différence des parts de réponses justes (points de pourcentage)",
        ),
        MeasureKind::ResponseTime => {
            language.pick("difference of response times (s)", "différence des temps de réponse (s)")
        }
        MeasureKind::Choice => {
            language.pick("difference of shares of choices", "différence des parts des choix")
        }
    }
}
