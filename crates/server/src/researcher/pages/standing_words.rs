//! The dashboard's words for how a session stands.

use mimique_locale::Language;
use mimique_session::Standing;

/// The word of a standing in addresses of lists.
pub(crate) fn list_word(standing: Standing) -> &'static str {
    match standing {
        Standing::Abandoned => "abandoned",
        other => other.stored_word(),
    }
}

/// A standing in the researcher's language.
pub(super) fn standing_word(standing: Standing, language: Language) -> &'static str {
    match standing {
        Standing::InProgress => language.pick("under way", "en cours"),
        Standing::Abandoned => language.pick("abandoned", "abandonné"),
        Standing::Declined => language.pick("declined", "refusé"),
        Standing::DeviceRefused => language.pick("device refused", "appareil refusé"),
        Standing::ScreenedOut => language.pick("screened out", "non retenu"),
        Standing::PracticeFailed => language.pick("practice failed", "entraînement échoué"),
        Standing::ChecksFailed => {
            language.pick("attention checks failed", "contrôles d’attention échoués")
        }
        Standing::Withdrawn => language.pick("withdrawn", "retiré"),
        Standing::Completed => language.pick("completed", "terminé"),
    }
}
