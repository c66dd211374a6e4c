//! How a session stands: the one vocabulary of page, event store, dashboard, export and report.
//!
//! | standing | stored | exported | how it comes about |
//! |---|---|---|---|
//! | in progress | `active` | `active` | begun, not ended |
//! | abandoned | `active` | `active` | in progress, and no sign of life for as long as the study keeps a place |
//! | declined | `declined` | `declined` | the agreement was not given |
//! | device refused | `device_refused` | `screened_out` | the device does not do what the study asks |
//! | screened out | `screened_out` | `screened_out` | an answer is not one that the study takes |
//! | practice failed | `practice_failed` | `screened_out` | the criterion of the practice was not met |
//! | checks failed | `failed_checks` | `failed_checks` | more attention checks were failed than the study allows |
//! | withdrawn | `withdrawn` | `withdrawn` | the participant took everything back |
//! | completed | `completed` | `completed` | every step is done |
//!
//! A limit of time ends a page or a trial and never a session: `timed_out` stands in the row of that
//! page or trial. Only [`Standing::at`] knows the time; what is stored and exported does not.

use mimique_study::Recruitment;

/// How a session stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Standing {
    /// Begun, not ended.
    #[default]
    InProgress,
    /// In progress, and without a sign of life for as long as the study keeps a place.
    Abandoned,
    /// The participant did not agree.
    Declined,
    /// The device does not do what the study asks.
    DeviceRefused,
    /// An answer is not one that the study takes.
    ScreenedOut,
    /// The criterion of the practice was not met.
    PracticeFailed,
    /// More attention checks were failed than the study allows.
    ChecksFailed,
    /// The participant took everything back.
    Withdrawn,
    /// Every step is done.
    Completed,
}

impl Standing {
    /// Every standing, in the order of a participant flow.
    pub const ALL: [Self; 9] = [
        Self::InProgress,
        Self::Abandoned,
        Self::Declined,
        Self::DeviceRefused,
        Self::ScreenedOut,
        Self::PracticeFailed,
        Self::ChecksFailed,
        Self::Withdrawn,
        Self::Completed,
    ];

    /// The word that is stored. Being abandoned is a matter of time and stored as `active`.
    pub fn stored_word(self) -> &'static str {
        match self {
            Self::DeviceRefused => "device_refused",
            Self::PracticeFailed => "practice_failed",
            other => other.export_word(),
        }
    }

    /// The standing of a stored word.
    pub fn from_stored_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|standing| standing.stored_word() == word)
    }

    /// The word of the export's column `status`.
    pub fn export_word(self) -> &'static str {
        match self {
            Self::InProgress | Self::Abandoned => "active",
            Self::Declined => "declined",
            Self::DeviceRefused | Self::ScreenedOut | Self::PracticeFailed => "screened_out",
            Self::ChecksFailed => "failed_checks",
            Self::Withdrawn => "withdrawn",
            Self::Completed => "completed",
        }
    }

    /// The standing of an exported word. The export does not say why somebody was screened out.
    pub fn from_export_word(word: &str) -> Option<Self> {
        const EXPORTED: [Standing; 6] = [
            Standing::InProgress,
            Standing::Declined,
            Standing::ScreenedOut,
            Standing::ChecksFailed,
            Standing::Withdrawn,
            Standing::Completed,
        ];
        EXPORTED.into_iter().find(|standing| standing.export_word() == word)
    }

    /// The standing at a time, given when the next sign of life is due at the latest (both milliseconds
    /// since 1970).
    #[must_use]
    pub fn at(self, now_ms: i64, sign_of_life_due_ms: i64) -> Self {
        match self {
            Self::InProgress if sign_of_life_due_ms <= now_ms => Self::Abandoned,
            other => other,
        }
    }

    /// Whether the session has not ended: whoever abandoned it can still come back.
    pub fn is_open(self) -> bool {
        matches!(self, Self::InProgress | Self::Abandoned)
    }

    /// Whether the study did not take this participant, for whatever reason.
    pub fn is_screened_out(self) -> bool {
        matches!(self, Self::DeviceRefused | Self::ScreenedOut | Self::PracticeFailed)
    }

    /// Whether the participant counts among those that the study wants.
    pub fn holds_place(self) -> bool {
        matches!(self, Self::InProgress | Self::Completed)
    }

    /// Whether the page waits for a receipt, and then shows the code of this end.
    pub fn has_receipt(self) -> bool {
        self == Self::Completed || self == Self::ChecksFailed || self.is_screened_out()
    }

    /// The recruitment's code for a session that stands so.
    pub fn completion_code(self, recruitment: &Recruitment) -> Option<&str> {
        let code = match self {
            Self::Completed => &recruitment.completion_code,
            Self::ChecksFailed => &recruitment.failed_checks_code,
            Self::DeviceRefused if recruitment.device_code.is_some() => &recruitment.device_code,
            screened_out if screened_out.is_screened_out() => &recruitment.screened_out_code,
            _ => &None,
        };
        code.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_name_one_standing_each() {
        for standing in Standing::ALL {
            let stored = Standing::from_stored_word(standing.stored_word());
            let kept = if standing.is_open() { Standing::InProgress } else { standing };
            assert_eq!(stored, Some(kept));
            let exported = Standing::from_export_word(standing.export_word()).unwrap();
            let told = if standing.is_screened_out() { Standing::ScreenedOut } else { kept };
            assert_eq!(exported, told);
        }
        assert_eq!(Standing::from_stored_word("finished"), None);
        assert_eq!(Standing::from_export_word("device_refused"), None);
    }

    #[test]
    fn only_what_is_in_progress_can_be_abandoned() {
        for standing in Standing::ALL {
            assert_eq!(standing.at(999, 1000), standing);
            let after = standing.at(1000, 1000);
            let wanted = if standing.is_open() { Standing::Abandoned } else { standing };
            assert_eq!(after, wanted);
            assert!(after != Standing::InProgress);
        }
    }
}
