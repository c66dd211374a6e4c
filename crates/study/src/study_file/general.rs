//! Who asks, whom, under which agreement: metadata, contact, recruitment, consent.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::LocalText;
use crate::instant::instant_ms;

/// Title, version, authors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Metadata {
    /// Title as participants see it.
    pub title: LocalText,
    /// Version of the study file, for people: `1.0.0`.
    pub version: String,
    /// Who made it.
    #[serde(default)]
    pub authors: Vec<String>,
    /// `YYYY-MM-DD`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// One or two sentences.
    #[serde(default)]
    pub description: LocalText,
    /// Where it is made.
    #[serde(default)]
    pub organizations: Vec<String>,
}

/// Whom a participant can write to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Contact {
    /// Who leads the study.
    pub investigator: ContactPerson,
    /// The board that approved it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ethics_board: Option<ContactPerson>,
}

/// A person or a board with an address.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ContactPerson {
    /// Name.
    pub name: LocalText,
    /// Electronic mail address.
    pub email: String,
    /// File number of the approval.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<String>,
}

/// Where participants come from and go back to.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Recruitment {
    /// Shown at the end, once every answer is stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub completion_code: Option<String>,
    /// For those whom the study cannot take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub screened_out_code: Option<String>,
    /// For those whose device cannot take part; `screenedOutCode` if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub device_code: Option<String>,
    /// For those who failed the attention checks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed_checks_code: Option<String>,
    /// Address to go back to; `{code}` stands for the completion code and `{NAME}` for a URL
    /// parameter of the arrival.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub redirect: Option<String>,
    /// Seconds after which the last page goes back to `redirect` by itself, 20 or more; the participant can
    /// stay. Not by itself if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub return_after_seconds: Option<u32>,
    /// Parameters of the address that are kept, apart from the answers: `PROLIFIC_PID`...
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub url_parameters: Vec<String>,
    /// How a second participation of one person is recognised.
    #[serde(default)]
    pub repeat_prevention: RepeatPrevention,
    /// How many participants the study wants; it takes no more once so many have finished or are
    /// on their way. None: any number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub participants: Option<u64>,
    /// Nobody can begin before: `2026-03-01T08:00:00+01:00`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opens: Option<String>,
    /// Nobody can begin from then on; who has begun can finish.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closes: Option<String>,
    /// How long a participant's place is kept after the last sign of life, in minutes (60 if not
    /// given). Then the next participant takes it, so that conditions stay balanced over those who
    /// finish.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reservation_minutes: Option<u32>,
}

/// How a second participation of one person is recognised.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum RepeatPrevention {
    /// Anybody may take part again.
    #[default]
    None,
    /// This browser has taken part.
    Browser,
    /// The recruitment identifier has taken part (the first of `urlParameters`).
    RecruitmentIdentifier,
}

/// What a participant agrees to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Consent {
    /// Version of the text; in every row of the export.
    pub version: String,
    /// Youngest age that may take part, in years.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_age: Option<u32>,
    /// How long the answers are kept, and what then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub retention: Option<LocalText>,
    /// Days after the end of a session at which the server deletes its answers; for ever if not
    /// given. It should say the same as `retention`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub retention_days: Option<u32>,
    /// The text.
    pub sections: Vec<Section>,
}

impl Recruitment {
    /// How long a place is kept after the last sign of life, milliseconds.
    pub fn reservation_ms(&self) -> i64 {
        i64::from(self.reservation_minutes.unwrap_or(60)) * 60_000
    }

    /// When the study opens, milliseconds since 1970.
    pub fn opens_ms(&self) -> Option<i64> {
        instant_ms(self.opens.as_deref()?)
    }

    /// When the study closes, milliseconds since 1970.
    pub fn closes_ms(&self) -> Option<i64> {
        instant_ms(self.closes.as_deref()?)
    }
}

/// A heading and its paragraphs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Section {
    /// Heading.
    pub heading: LocalText,
    /// Text; an empty line parts paragraphs.
    pub text: LocalText,
}

/// Which served file a published one was made of: a published file has neither completion codes nor addresses of
/// recruitment.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Published {
    /// Hashes of the files that were served, the latest last: the column `config_hash` of their answers. Several where a
    /// published file was served again.
    pub served_hashes: Vec<String>,
    /// Hash of this file without this key: where they differ, the file was changed afterwards and is another version.
    pub published_hash: String,
}
