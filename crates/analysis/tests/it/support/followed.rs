//! A study whose rating follows the clip.

use mimique_analysis::Parameters;
use mimique_study::Study;
use serde_json::{Value, json};

/// The study of speeded answers with a change.
pub fn speeded(change: impl FnOnce(&mut Value)) -> Study {
    let text = include_str!("../../../../../study-config/speeded.json");
    let mut file = mimique_study::parse(text).unwrap();
    change(&mut file);
    Study::from_value(&file).unwrap()
}

/// A line that follows the clip, in the place of the keys.
pub fn followed() -> Study {
    followed_with(|_| ())
}

/// The same with a change.
pub fn followed_with(change: impl FnOnce(&mut Value)) -> Study {
    speeded(|file| {
        file["questions"][0] = json!({
            "id": "strength", "type": "slider", "whilePlaying": true, "minimum": 0, "maximum": 100,
            "prompt": {"en": "How intense?", "fr": "Quelle intensité ?"},
            "leftLabel": {"en": "not", "fr": "pas"}, "rightLabel": {"en": "very", "fr": "très"},
        });
        file["components"]["faces"]["questions"] = json!(["strength"]);
        file["hypotheses"][0]["response"] = json!("strength");
        file["hypotheses"][0].as_object_mut().unwrap().remove("measure");
        change(file);
    })
}

/// Attentive people whose line goes to these means.
pub fn followers(study: &Study, means: [(&str, f64); 3]) -> Parameters {
    let mut parameters = Parameters::for_study(study);
    let own = parameters.ratings.get_mut("strength").unwrap();
    (own.mean, own.noise_sd, own.person_sd, own.clip_sd, own.segment_sd) =
        (0.0, 5.0, 4.0, 0.0, 0.0);
    own.person_by_sd = std::collections::BTreeMap::new();
    let means = means.map(|(level, mean)| (level.to_owned(), mean));
    own.effects = std::collections::BTreeMap::from([("method".to_owned(), means.into())]);
    parameters.careless.share = 0.0;
    parameters
}
