//! The preregistration of a study whose power a test found.

use mimique_analysis::{Parameters, Power, Preregistration, preregistration};
use mimique_locale::Language;
use mimique_study::Study;

/// The text without a power curve.
pub fn preregistered(
    study: &Study,
    parameters: &Parameters,
    power: &Power,
    language: Language,
) -> String {
    let config_hash = "hash";
    let from = Preregistration { study, config_hash, power, parameters, language, curve: None };
    preregistration(&from)
}
