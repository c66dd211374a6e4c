//! Addresses of single clips in the preview of a study, to which figures lead.

use mimique_locale::Language;
use mimique_report::svg::Link;
use mimique_study::percent_encoded;

/// The preview of the study, by its address.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Preview<'a>(pub &'a str);

impl Preview<'_> {
    /// Leads to a clip.
    pub(crate) fn of_clip(self, language: Language, clip: &str) -> Link {
        Link {
            address: format!("{}?clip={}", self.0, percent_encoded(clip)),
            title: language.pick(format!("Preview of {clip}"), format!("Aperçu de {clip}")),
        }
    }

    /// Leads to two clips side by side, at an instant of theirs in seconds.
    pub(crate) fn of_pair(self, language: Language, clips: [&str; 2], seconds: f64) -> Link {
        let [clip, beside] = clips;
        let at = language.fixed(seconds, 1);
        Link {
            address: format!(
                "{}?clip={}&beside={}&t={seconds:.3}",
                self.0,
                percent_encoded(clip),
                percent_encoded(beside)
            ),
            title: language.pick(
                format!("Preview of {clip} beside {beside} at {at} s"),
                format!("Aperçu de {clip} à côté de {beside} à {at} s"),
            ),
        }
    }
}
