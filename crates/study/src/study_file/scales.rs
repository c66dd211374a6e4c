//! Scales: questions whose answers belong together, as a questionnaire has them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Study;
use crate::question::{KindOfQuestion as _, Question};

/// Questions that are meant to measure one thing together: the report has Cronbach's alpha of them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct CompositeScale {
    /// The questions, or parts of them (`empathy.crowds`, a row of a matrix): all of them on pages about the
    /// participant, or all asked in trials.
    pub items: Vec<String>,
    /// Those of them whose answers are turned round: lowest + highest - answer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reversed: Vec<String>,
}

impl Study {
    /// The lowest and the highest answer to a question that is answered by numbers; none where nothing bounds them.
    pub fn answer_range(question: &Question) -> Option<[f64; 2]> {
        if let Some([Some(low), Some(high)]) = question.kind.bounds() {
            return Some([low, high]);
        }
        if let Some(points) = question.kind.points() {
            return Some([*points.start() as f64, *points.end() as f64]);
        }
        let options = question.kind.options().iter().map(|option| option.value.parse::<f64>().ok());
        let values: Vec<f64> = options.collect::<Option<_>>()?;
        let low = values.iter().copied().reduce(f64::min)?;
        Some([low, values.iter().copied().fold(low, f64::max)])
    }
}
