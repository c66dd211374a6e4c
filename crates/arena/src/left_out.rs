//! Why votes are not pooled.

use serde::{Deserialize, Serialize};

/// Answers given sooner than this after they could be, milliseconds, are no votes.
pub(crate) const SHORTEST_RT_MS: f64 = 300.0;
/// Clips of which a larger share of frames came late were not seen as they are.
pub(crate) const LATE_SHARE: f64 = 0.2;

/// Why votes are not pooled.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(tag = "reason", rename_all = "kebab-case", rename_all_fields = "camelCase")]
pub enum LeftOut {
    /// A clip is another than the arena's.
    Stimulus {
        /// Its method.
        method: String,
        /// Its segment.
        take: String,
        /// Its hash.
        found: String,
        /// The arena's; none where the arena has no such clip.
        expected: Option<String>,
    },
    /// The export does not say what was shown.
    NoHash,
    /// Given while the study was tried out.
    Pilot,
    /// The participant did not finish.
    Unfinished {
        /// How the session stands.
        status: String,
    },
    /// The laboratory left the participant out.
    Excluded {
        /// Why.
        why: String,
    },
    /// The participant failed an attention check.
    FailedCheck,
    /// Answered sooner than anybody can.
    TooFast,
    /// Too many frames came late.
    LateFrames,
    /// The same session is in another export, too.
    Duplicate {
        /// The laboratory whose copy counts.
        counted: String,
    },
}

impl std::fmt::Display for LeftOut {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Stimulus { method, take, found, expected: Some(expected) } => write!(
                f,
                "{take} by {method} is another clip than the arena's: provenance {}, the arena has {}",
                short(found),
                short(expected)
            ),
            Self::Stimulus { method, take, found, expected: None } => {
                write!(f, "{take} by {method} (provenance {}) is not in the arena", short(found))
            }
            Self::NoHash => f.write_str("the export does not say what was shown (no provenance)"),
            Self::Pilot => f.write_str("given in a pilot"),
            Self::Unfinished { status } => write!(f, "the session was not completed ({status})"),
            Self::Excluded { why } if why.is_empty() => {
                f.write_str("the laboratory left the participant out")
            }
            Self::Excluded { why } => write!(f, "the laboratory left the participant out: {why}"),
            Self::FailedCheck => f.write_str("the participant failed an attention check"),
            Self::TooFast => write!(f, "answered in less than {SHORTEST_RT_MS} ms"),
            Self::LateFrames => {
                write!(f, "more than {:.0} % of the frames came late", 100.0 * LATE_SHARE)
            }
            Self::Duplicate { counted } => {
                write!(f, "the same session is counted once, in the export of {counted}")
            }
        }
    }
}

/// The beginning of a hash, which tells it from others.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}
