//! Hypotheses of equivalence.

use mimique_study::Hypothesis;
use serde_json::json;

/// A hypothesis of equivalence about a study's answers.
pub fn equivalence(
    id: &str,
    response: &str,
    factor: &str,
    levels: [&str; 2],
    smallest: f64,
) -> Hypothesis {
    serde_json::from_value(json!({
        "id": id, "statement": { "en": "Alike.", "fr": "Pareils." }, "test": "equivalence", "response": response,
        "factors": [factor], "levels": levels, "smallestEffect": smallest, "generalise": "these clips",
        "smallestEffectReason": { "en": "nobody sees it", "fr": "personne ne le voit" },
    }))
    .unwrap()
}
