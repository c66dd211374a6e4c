//! Answers while the clip plays, from simulated people to the report: presses with their times, lines with their courses.

#[path = "support/simulated.rs"]
mod simulated;

use std::collections::BTreeMap;

use mimique_analysis::{Language, Parameters, Simulation, analyze};
use mimique_stats::Table;
use mimique_study::Study;
use serde_json::{Value, json};
use simulated::simulated_export;

fn study(change: impl FnOnce(&mut Value)) -> Study {
    let text = include_str!("../../../study-config/speeded.json");
    let mut file = mimique_study::parse(text).unwrap();
    change(&mut file);
    Study::from_value(&file).unwrap()
}

/// A line that follows the clip, in the place of the keys.
fn followed() -> Study {
    study(|file| {
        file["questions"][0] = json!({
            "id": "strength", "type": "slider", "whilePlaying": true, "minimum": 0, "maximum": 100,
            "prompt": {"en": "How intense?", "fr": "Quelle intensité ?"},
            "leftLabel": {"en": "not", "fr": "pas"}, "rightLabel": {"en": "very", "fr": "très"},
        });
        file["components"]["faces"]["questions"] = json!(["strength"]);
        file["hypotheses"][0]["response"] = json!("strength");
        file["hypotheses"][0].as_object_mut().unwrap().remove("measure");
    })
}

fn results(study: &Study, parameters: &Parameters, people: u64) -> (Value, Vec<String>) {
    let simulation = Simulation::new(study, "hash", parameters, 7).unwrap();
    let csv = simulated_export(&simulation, study, people);
    let report = analyze(&Table::parse(csv.as_bytes()).unwrap(), study, Language::English).unwrap();
    let text = &report.files.iter().find(|file| file.path == "results.json").unwrap().text;
    let paths = report.files.iter().map(|file| file.path.clone()).collect();
    (serde_json::from_str(text).unwrap(), paths)
}

#[test]
fn planted_times_of_presses_are_found_again() {
    let study = study(|_| ());
    let mut parameters = Parameters::for_study(&study);
    (parameters.times.median_ms, parameters.times.sigma) = (900.0, 0.2);
    parameters.times.person_sigma = 0.1;
    parameters.times.effects = BTreeMap::from([(
        "method".to_owned(),
        BTreeMap::from([
            ("box".to_owned(), 0.3),
            ("lsts".to_owned(), 0.0),
            ("recorded".to_owned(), 0.0),
        ]),
    )]);
    parameters.careless.share = 0.0;
    let (results, _) = results(&study, &parameters, 40);
    let comparisons = results["comparisons"].as_array().unwrap();
    let times = comparisons
        .iter()
        .find(|own| own["measure"] == "felt.rt" && own["factor"] == "method")
        .unwrap();
    let median = |level: &str| times["descriptions"][level]["median"].as_f64().unwrap();
    // 900 ms and exp 0.3 of it; a page takes 60 ms from the press on play to the first frame.
    assert!((median("lsts") - 0.9).abs() < 0.1, "{}", median("lsts"));
    assert!((median("box") / median("lsts") - 1.35).abs() < 0.1, "{}", median("box"));
    assert!(
        results["hypotheses"][0]["recommended"]["overall"][0]["p_value"].as_f64().unwrap() < 1e-4
    );
    assert!(!results["confusion"].as_array().unwrap().is_empty(), "which key is right is known");
}

#[test]
fn the_mean_course_rises_to_the_planted_rating_with_intervals_over_time() {
    let study = followed();
    let mut parameters = Parameters::for_study(&study);
    let own = parameters.ratings.get_mut("strength").unwrap();
    (own.mean, own.noise_sd, own.person_sd, own.clip_sd, own.segment_sd) =
        (0.0, 5.0, 4.0, 0.0, 0.0);
    own.person_by_sd = BTreeMap::new();
    own.effects = BTreeMap::from([(
        "method".to_owned(),
        [("box", 60.0), ("lsts", 80.0), ("recorded", 90.0)]
            .map(|(level, mean)| (level.to_owned(), mean))
            .into(),
    )]);
    parameters.careless.share = 0.0;
    let (results, paths) = results(&study, &parameters, 30);
    let traces = &results["traces"][0];
    assert_eq!(
        (traces["response"].as_str(), traces["factor"].as_str()),
        (Some("strength"), Some("method"))
    );
    let seconds = parameters.times.clip_ms / 1000.0;
    for (level, planted) in [("box", 60.0), ("lsts", 80.0), ("recorded", 90.0)] {
        let own =
            traces["levels"].as_array().unwrap().iter().find(|own| own["level"] == level).unwrap();
        let mean: Vec<f64> =
            own["mean"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        assert_eq!(mean.len(), (seconds * 60.0) as usize + 1);
        assert_eq!(mean[0], 50.0, "the line stands in the middle at first");
        // A second after the first frame it is half-way.
        let after_a_second = 50.0 + (planted - 50.0) / 2.0;
        assert!((mean[60] - after_a_second).abs() < 2.0, "{level}: {}", mean[60]);
        let ends = own["interval_95"].as_array().unwrap().last().unwrap();
        let [low, high] = [0, 1].map(|end| ends[end].as_f64().unwrap());
        let last = 50.0 + (planted - 50.0) * (1.0 - (-seconds).exp2());
        assert!(low - 1.0 < last && last < high + 1.0 && high - low < 6.0, "{level}: {low} {high}");
    }
    assert!(paths.iter().any(|path| path == "figures/strength-while-playing.svg"), "{paths:?}");
    assert!(
        paths.iter().any(|path| path == "tables/figure-strength-while-playing.csv"),
        "{paths:?}"
    );
}
