//! Whether what is found holds for other people and other clips: min F' and the mixed model beside each hypothesis that
//! compares ratings within people, and the mixed model as what decides.

#[expect(dead_code, reason = "other tests take the other studies")]
mod support;

use mimique_analysis::{
    Language, Parameters, PowerOptions, Preregistration, analyze, power, preregistration,
};
use mimique_stats::Table;
use mimique_study::{Generalise, Severity, Study};
use serde_json::{Value, json};
use support::{Raters, demo_study, export};

/// The hypotheses of a study's results, by a few raters.
fn hypotheses(study: &Study, people: usize, language: Language) -> Vec<Value> {
    let csv = export(study, &Raters { people, effect: 1.5, seed: 9 });
    let report = analyze(&Table::parse(csv.as_bytes()).unwrap(), study, language).unwrap();
    let file = report.files.iter().find(|file| file.path == "results.json").unwrap();
    let results: Value = serde_json::from_str(&file.text).unwrap();
    results["hypotheses"].as_array().unwrap().clone()
}

/// The place of the first hypothesis that has tests of other clips.
fn place(found: &[Value]) -> usize {
    found.iter().position(|own| own["other_clips"].is_object()).expect("a comparison of ratings")
}

#[test]
fn ratings_within_people_have_both_tests_and_these_clips_decide() {
    let study = demo_study();
    let found = hypotheses(&study, 14, Language::English);
    let own = &found[place(&found)];
    let clips = &own["other_clips"];
    assert_eq!(clips["decides"], false);
    let model = &clips["mixed_model"];
    assert_eq!(model["status"], "ok", "{model}");
    let terms: Vec<&String> = model["sd"].as_object().unwrap().keys().collect();
    assert_eq!(terms, ["clip", "participant", "participant:method", "segment"]);
    let p = model["p"].as_f64().unwrap();
    assert!(p < 0.05, "methods 1.5 points apart: {p}");
    let pair = &model["pairs"][0];
    // The hypothesis names the higher one first.
    assert_eq!([&pair["a"], &pair["b"]], ["lsts", "box"]);
    let odds = |value: &Value| value.as_f64().unwrap();
    assert!(odds(&pair["interval_95"][1]) < 1.0 && odds(&pair["odds_ratio"]) > 0.005);
    assert!(odds(&pair["higher"]) < 0.45);
    assert_ne!(own["p"].as_f64(), Some(p));
    let reading = own["reading"].as_str().unwrap();
    assert!(reading.contains("odds of a higher rating"), "{reading}");
    assert!(reading.contains("take the clips as they are"), "{reading}");
    assert!(reading.contains("min F'"), "{reading}");
}

#[test]
fn a_hypothesis_about_other_clips_is_decided_by_the_mixed_model() {
    let mut study = demo_study();
    let at = place(&hypotheses(&study, 14, Language::English));
    study.hypotheses[at].generalise = Some(Generalise::Clips);
    for (language, words) in
        [(Language::English, "which decides this"), (Language::French, "ce qui décide de cette")]
    {
        let found = hypotheses(&study, 14, language);
        let own = &found[at];
        assert_eq!(own["p"], own["other_clips"]["mixed_model"]["p"]);
        assert!(own["p_holm_over_hypotheses"].as_f64() >= own["p"].as_f64());
        assert!(own["reading"].as_str().unwrap().contains(words), "{}", own["reading"]);
    }
    // Of four people the spread is not estimated: that is said, and nothing else stands in.
    let found = hypotheses(&study, 4, Language::English);
    assert_eq!(found[at]["p"], Value::Null);
    assert!(
        found[at]["reading"].as_str().unwrap().contains("gives no p"),
        "{}",
        found[at]["reading"]
    );
    let parameters = Parameters::for_study(&study);
    let options = PowerOptions {
        participants: vec![8],
        clips: Vec::new(),
        runs: 3,
        seed: 1,
        alpha: 0.05,
        false_positives: false,
        mixed: true,
    };
    let found = power(&study, "hash", &parameters, &options, &|| {}).unwrap();
    let own = &found.points[0].hypotheses[at].power;
    assert_eq!((own.min_f.unwrap().runs, own.mixed.unwrap().runs), (3, 3));
    assert_eq!(own.mixed.unwrap().positive, own.recommended.positive);
    for (language, words) in [
        (Language::English, "decides: likelihood ratio test of a cumulative link mixed model"),
        (Language::French, "décide : test du rapport de vraisemblance d’un modèle mixte"),
    ] {
        let text = preregistration(&Preregistration {
            study: &study,
            config_hash: "hash",
            power: &found,
            parameters: &parameters,
            language,
            curve: None,
        });
        assert!(text.contains(words), "{text}");
    }
}

/// The places and codes of what is wrong with the demonstration when its first comparison of ratings is changed.
fn problems(change: impl Fn(&mut Value, usize)) -> Vec<(String, String)> {
    let at = place(&hypotheses(&demo_study(), 6, Language::English));
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/demo.json");
    let mut file = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    file["hypotheses"][at]["generalise"] = json!("clips");
    change(&mut file, at);
    let checked = mimique_study::check(&file.to_string(), &|_| Ok(()));
    let errors = checked.issues.iter().filter(|issue| issue.severity == Severity::Error);
    let own = errors.filter(|issue| issue.pointer.ends_with("/generalise"));
    own.map(|issue| (issue.pointer.clone(), issue.code().to_owned())).collect()
}

#[test]
fn other_clips_are_asked_about_ratings_of_several_segments_alone() {
    assert_eq!(problems(|_, _| ()), []);
    let wrong = problems(|file, at| file["hypotheses"][at]["measure"] = "rt".into());
    assert_eq!(wrong.len(), 1);
    assert_eq!(wrong[0].1, "not-a-number");
    let wrong = problems(|file, at| file["hypotheses"][at]["test"] = "spearman".into());
    assert_eq!(wrong[0].1, "not-a-number");
    let wrong = problems(|file, at| file["hypotheses"][at]["generalise"] = "faces".into());
    assert_eq!(wrong.len(), 1, "{wrong:?}");
}
