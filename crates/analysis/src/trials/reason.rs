//! Why people and trials are left out: codes; their words are made where somebody reads them.

use serde::{Serialize, Serializer};

/// Why a person or a trial is left out. The order is that of the words, in which reasons are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// A trial: answered sooner than `shortestRtMs`.
    AnsweredTooSoon,
    /// A person: more attention checks failed than allowed.
    AttentionChecks,
    /// A person whom ITU-R BS.1534-3 leaves out of a panel.
    Bs1534,
    /// A person who did not agree.
    Declined,
    /// A person whom the researcher excluded.
    ByResearcher,
    /// A person who did not finish.
    Incomplete,
    /// A trial: too many frames were late.
    LateFrames,
    /// A trial: one frame stood too long.
    LongFrame,
    /// A person of the pilot, where there are live people.
    Pilot,
    /// A person whom the study could not take.
    ScreenedOut,
    /// A person who did not hear the tones of the sound check.
    SoundNotHeard,
    /// A trial whose sound was not played, or not when it should have been.
    SoundOffset,
    /// A person who gave the same answer in too many trials in a row.
    StraightLining,
    /// A person who withdrew.
    Withdrawn,
}

impl Reason {
    /// In English: what `results.json` says.
    pub(crate) fn english(self) -> &'static str {
        match self {
            Self::AnsweredTooSoon => "answered too soon",
            Self::AttentionChecks => "attention checks",
            Self::Bs1534 => "missed the hidden reference or the anchor (BS.1534)",
            Self::Declined => "declined",
            Self::ByResearcher => "excluded by the researcher",
            Self::Incomplete => "incomplete",
            Self::LateFrames => "late frames",
            Self::LongFrame => "long frame",
            Self::Pilot => "pilot",
            Self::ScreenedOut => "screened out",
            Self::SoundNotHeard => "sound not heard",
            Self::SoundOffset => "sound off its time",
            Self::StraightLining => "straight-lining",
            Self::Withdrawn => "withdrawn",
        }
    }

    /// In French.
    pub(crate) fn french(self) -> &'static str {
        match self {
            Self::AnsweredTooSoon => "réponse trop rapide",
            Self::AttentionChecks => "contrôles d’attention",
            Self::Bs1534 => "référence cachée ou ancre manquée (BS.1534)",
            Self::Declined => "sans accord",
            Self::ByResearcher => "exclus par le chercheur",
            Self::Incomplete => "incomplets",
            Self::LateFrames => "images en retard",
            Self::LongFrame => "image trop longue",
            Self::Pilot => "pilote",
            Self::ScreenedOut => "non retenus",
            Self::SoundNotHeard => "son non entendu",
            Self::SoundOffset => "son décalé",
            Self::StraightLining => "réponses toujours identiques",
            Self::Withdrawn => "retirés",
        }
    }
}

impl Serialize for Reason {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.english())
    }
}
