//! Studies that are nothing but stimuli.

use mimique_study::Study;
use serde_json::{Value, json};

/// A study of the given stimuli and nothing else.
pub fn study_of(stimuli: &Value) -> Study {
    Study::from_value(&json!({
        "id": "test",
        "studyMetadata": {"title": "Test", "version": "1"},
        "languages": ["en"],
        "components": {},
        "sequence": {"order": "fixed", "components": []},
        "stimuli": stimuli,
    }))
    .unwrap()
}
