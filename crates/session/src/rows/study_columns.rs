//! The columns that a study brings: its factors, the answers about the participant, the condition.

use std::collections::BTreeMap;

use mimique_study::columns::{ASSIGNED_CONDITION, ColumnKind, EXCLUSION_COLUMNS};
use mimique_study::{Choice, KindOfQuestion as _, Question, Sequence, SequenceItem, Study};
use serde_json::Value;

use super::column::Column;

/// The column of a factor of the clips, with its levels.
pub(super) fn factor_column(study: &Study, factor: &str) -> Column {
    let mut levels: Vec<Value> = study
        .clips()
        .iter()
        .filter_map(|clip| clip.factors.get(factor))
        .map(|v| v.to_value())
        .collect();
    levels.sort_by(|left, right| match (left.as_f64(), right.as_f64()) {
        (Some(left), Some(right)) => left.total_cmp(&right),
        _ => left.to_string().cmp(&right.to_string()),
    });
    levels.dedup();
    let numbers = levels.iter().all(Value::is_number);
    let kind = if numbers { ColumnKind::Number } else { ColumnKind::Text };
    let mut column = Column::new(factor, kind, "Factor of the clip");
    column.levels = levels.into_iter().map(|level| (level, String::new())).collect();
    column
}

/// The columns of an answer about the participant.
pub(super) fn question_columns(question: &Question, language: &str) -> Vec<Column> {
    let prompt = question.prompt.in_language(language);
    let level =
        |each: &Choice| (each.value.as_str().into(), each.label.in_language(language).to_owned());
    let levels: Vec<(Value, String)> = question.kind.levels().iter().map(level).collect();
    question
        .response_ids()
        .into_iter()
        .map(|id| {
            let mut column = Column::new(&id, question.kind.column_kind(), prompt);
            column.levels = levels.clone();
            column
        })
        .collect()
}

/// The column of the participant's condition, where the study has conditions.
pub(super) fn assigned_column(study: &Study) -> Option<Column> {
    let conditions = study.conditions();
    let description =
        "Condition of the participant: the one that the address named, or that was given";
    let mut column = Column::new(ASSIGNED_CONDITION, ColumnKind::Text, description);
    column.levels = conditions.iter().map(|name| ((*name).into(), String::new())).collect();
    (!conditions.is_empty()).then_some(column)
}

/// Whether the researcher excluded the participant, and why: behind the columns of the tidy and of the wide form.
pub fn exclusion_columns() -> [Column; 2] {
    let [excluded, reason] = EXCLUSION_COLUMNS;
    let about = "Whether the researcher excluded the participant; every answer is kept";
    let why = "Why the researcher excluded the participant";
    [Column::new(excluded, ColumnKind::Boolean, about), Column::new(reason, ColumnKind::Text, why)]
}

/// Participant's condition and component -> identifier of the nearest sequence that has one.
/// `enclosing` is the condition and the identifier of the sequences around.
pub(super) fn conditions_of(
    sequence: &Sequence,
    enclosing: (Option<&str>, Option<&str>),
    conditions: &mut BTreeMap<(Option<String>, String), String>,
) {
    let own = sequence.id.as_deref();
    let assigned = if sequence.conditional { own } else { enclosing.0 };
    let condition = own.or(enclosing.1);
    for item in &sequence.components {
        match item {
            SequenceItem::Component(name) => {
                let key = (assigned.map(str::to_owned), name.clone());
                conditions.entry(key).or_insert(condition.unwrap_or(name).to_owned());
            }
            SequenceItem::Sequence(nested) => {
                conditions_of(nested, (assigned, condition), conditions);
            }
        }
    }
}
