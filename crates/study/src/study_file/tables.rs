//! Tables of the report that the study lays out itself.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::LocalText;

/// One table of the report, in a layout of the study's choice.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct TableLayout {
    /// Short name, part of its file's name: `6-3`.
    pub id: String,
    /// What it shows.
    pub caption: LocalText,
    /// How it is laid out.
    pub layout: Layout,
    /// Identifiers of questions, or of their parts (`grid.valence`): its rows, in order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub responses: Vec<String>,
    /// Factors of the clips, questions about the participant, or `assigned_condition`: the condition
    /// that the participant is in.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub factors: Vec<String>,
    /// Pairs of factors, for `interactions`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub crossings: Vec<[String; 2]>,
}

/// How a table is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Statistic and p of each hypothesis.
    Hypotheses,
    /// p of each pair of levels of one factor: levels in rows and columns.
    Pairs,
    /// Mean of each response (rows) at each level of a factor (columns); with a second factor also at
    /// each of its levels.
    Means,
    /// Two factors and their interaction: one row a crossing and response.
    Interactions,
    /// Statistic and p of each response (rows) against each factor (columns).
    Influences,
    /// Shown and answered, one matrix a level of the factor beside the other.
    Confusion,
}

impl Layout {
    /// The word of the file.
    pub fn word(self) -> &'static str {
        match self {
            Self::Hypotheses => "hypotheses",
            Self::Pairs => "pairs",
            Self::Means => "means",
            Self::Interactions => "interactions",
            Self::Influences => "influences",
            Self::Confusion => "confusion",
        }
    }
}
