//! Whether what is found holds for other people and other clips: mixed models and min F' beside each hypothesis that
//! compares levels, and the linear mixed model as what decides.

use mimique_analysis::{Parameters, PowerOptions, analyze, power};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{Generalise, Severity, Study};
use mimique_test_support::Random;
use serde_json::{Value, json};

use crate::support::planted::{answered, export_of_passes};
use crate::support::preregistered::preregistered;
use crate::support::{Raters, demo_study, export};

/// The hypotheses of a study's results, by a few raters.
fn hypotheses(study: &Study, people: usize, language: Language) -> Vec<Value> {
    let csv = export(study, &Raters { people, effect: 1.5, seed: 9 });
    let report = analyze(&Table::parse(csv.as_bytes()).unwrap(), study, language).unwrap();
    let file = report.files.iter().find(|file| file.path == "results.json").unwrap();
    let results: Value = serde_json::from_str(&file.text).unwrap();
    results["hypotheses"].as_array().unwrap().clone()
}

/// The place of the first hypothesis that compares ratings.
fn place(found: &[Value]) -> usize {
    let is_rating = |own: &Value| own["other_clips"]["mixed_model"].is_object();
    found.iter().position(is_rating).expect("a comparison of ratings")
}

#[test]
fn ratings_within_people_have_all_tests_and_the_study_says_which_decides() {
    let mut study = demo_study();
    let at = place(&hypotheses(&study, 14, Language::English));
    study.hypotheses[at].generalise = Some(Generalise::TheseClips);
    let found = hypotheses(&study, 14, Language::English);
    let own = &found[at];
    assert_eq!(own["scope"], "these_clips");
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
    assert_eq!([&pair["a"], &pair["b"]], ["lsts30", "box"]);
    let odds = |value: &Value| value.as_f64().unwrap();
    assert!(odds(&pair["interval_95"][1]) < 1.0 && odds(&pair["odds_ratio"]) > 0.005);
    assert!(odds(&pair["higher"]) < 0.45);
    assert_ne!(own["p"].as_f64(), Some(p));
    assert_ne!(own["p"], clips["linear_model"]["p"]);
    let reading = own["reading"].as_str().unwrap();
    assert!(reading.contains("odds of a higher rating"), "{reading}");
    assert!(reading.contains("take the clips as they are"), "{reading}");
    assert!(reading.contains("min F'"), "{reading}");
    assert!(
        reading.contains("null hypothesis of no difference rejected, for these clips"),
        "{reading}"
    );
}

#[test]
fn a_hypothesis_about_other_clips_is_decided_by_the_linear_mixed_model() {
    let study = demo_study();
    let at = place(&hypotheses(&study, 14, Language::English));
    for (language, words) in
        [(Language::English, "which decides this"), (Language::French, "ce qui décide de cette")]
    {
        let found = hypotheses(&study, 14, language);
        let own = &found[at];
        assert_eq!(own["scope"], "other_clips");
        assert_eq!(own["p"], own["other_clips"]["linear_model"]["p"]);
        assert!(own["p_holm_over_hypotheses"].as_f64() >= own["p"].as_f64());
        assert!(own["reading"].as_str().unwrap().contains(words), "{}", own["reading"]);
    }
    // The estimate and its interval are those of the model.
    let pair =
        &hypotheses(&study, 14, Language::English)[at]["other_clips"]["linear_model"]["pairs"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    assert_eq!([&pair["a"], &pair["b"]], ["lsts30", "box"]);
    assert!(number(&pair["interval_95"][0]) > 0.0 && number(&pair["difference"]) > 0.5, "{pair}");
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
    assert_eq!(own.mixed.unwrap().positive, own.deciding.positive);
    for (language, words) in [
        (Language::English, "decides: F test of a linear mixed model"),
        (Language::French, "décide : test F d’un modèle linéaire mixte"),
    ] {
        let text = preregistered(&study, &parameters, &found, language);
        assert!(text.contains(words), "{text}");
    }
}

/// In the demonstration each emotion has one performance: nothing tells it from the emotion, whatever the model.
#[test]
fn where_each_level_has_one_segment_nothing_is_decided_for_other_clips() {
    let mut study = demo_study();
    let at = study.hypotheses.iter().position(|own| own.factors.len() == 2).unwrap();
    study.hypotheses[at].generalise = Some(Generalise::Clips);
    for (language, words) in
        [(Language::English, "has only one unit of"), (Language::French, "n’a qu’une unité de")]
    {
        let found = hypotheses(&study, 14, language);
        assert_eq!(found[at]["p"], Value::Null);
        let reading = found[at]["reading"].as_str().unwrap();
        assert!(reading.contains(words), "{reading}");
    }
}

/// Clips that differ by chance make false positives of tests that take the clips as they are, the more people there are
/// the more; not of the linear mixed model.
#[test]
fn clips_that_differ_by_chance_make_no_false_positives_of_the_linear_model() {
    let mut study = demo_study();
    study.hypotheses.retain(|own| own.factors.len() == 1);
    let others = study.clone();
    study.hypotheses.iter_mut().for_each(|own| own.generalise = Some(Generalise::TheseClips));
    let parameters = Parameters::for_study(&study);
    let options = PowerOptions {
        participants: vec![80],
        clips: Vec::new(),
        runs: 150,
        seed: 4,
        alpha: 0.05,
        false_positives: true,
        mixed: false,
    };
    let positive = |study: &Study| -> Vec<u64> {
        let found = power(study, "hash", &parameters, &options, &|| {}).unwrap();
        let own = found.points[0].hypotheses.iter();
        own.map(|own| own.false_positives.unwrap().deciding.positive).collect()
    };
    let (of_these, of_others) = (positive(&study), positive(&others));
    // Of 150 draws of 5 %, 15 are as many as in 99 % of cases.
    assert!(of_others.iter().all(|own| *own <= 15), "{of_others:?} of 150");
    assert!(of_these.iter().any(|own| *own > 16), "{of_these:?} of 150, of these clips");
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
fn other_clips_are_asked_about_where_levels_are_compared() {
    assert_eq!(problems(|_, _| ()), []);
    assert_eq!(problems(|file, at| file["hypotheses"][at]["measure"] = "rt".into()), []);
    let wrong = problems(|file, at| file["hypotheses"][at]["test"] = "spearman".into());
    assert_eq!(wrong[0].1, "not-a-number");
    let wrong = problems(|file, at| file["hypotheses"][at]["generalise"] = "faces".into());
    assert_eq!(wrong.len(), 1, "{wrong:?}");
}

/// Effects of so many people or clips, of mean 0 and exactly this standard deviation.
fn effects_of(count: usize, sd: f64, random: &mut Random) -> Vec<f64> {
    let drawn: Vec<f64> = (0..count).map(|_| random.normal()).collect();
    let (mean, variance) = mimique_stats::moments(&drawn);
    drawn.iter().map(|own| (own - mean) / variance.unwrap().sqrt() * sd).collect()
}

#[test]
fn planted_thresholds_and_deviations_are_in_the_figures() {
    planted_in_the_figures(&[-3.0, -1.5, -0.5, 0.5, 1.5, 3.0], [0.2, 0.06]);
}

/// Two points of the scale are used: one threshold, a binomial model.
#[test]
fn a_planted_share_and_deviations_of_two_ratings_are_in_the_figures() {
    planted_in_the_figures(&[0.4], [0.35, 0.08]);
}

/// Ratings of people and clips that differ, cut at thresholds: the figures of the mixed model have the planted shares
/// of each level and the planted standard deviations, to `near_share` and `near_sd`.
fn planted_in_the_figures(thresholds: &[f64], [near_sd, near_share]: [f64; 2]) {
    let mut study = demo_study();
    study.exclusions = None;
    let effect = 1.0;
    let terms = [
        ("people", 60, 1.2),
        ("people × method", 120, 0.6),
        ("segments", 6, 0.8),
        ("clips", 12, 0.5),
    ];
    let mut random = Random::new(3);
    let effects = terms.map(|(_, count, sd)| effects_of(count, sd, &mut random));
    let mut met = [(); 4].map(|()| Vec::<String>::new());
    let passes = export_of_passes(&study, 60, 3);
    let text = answered(&passes, "believability", |cell| {
        let (person, method, clip) = (cell("participant_id"), cell("method"), cell("stimulus"));
        let segment = study.clips().iter().find(|own| own.id == clip).unwrap().segment.clone();
        let groups = [person.clone(), format!("{person}:{method}"), segment, clip];
        let mut latent = if method == "lsts30" { effect } else { 0.0 };
        for ((group, met), effects) in groups.into_iter().zip(&mut met).zip(&effects) {
            let place = met.iter().position(|own| *own == group).unwrap_or_else(|| {
                met.push(group);
                met.len() - 1
            });
            latent += effects[place];
        }
        let u = random.uniform();
        latent += (u / (1.0 - u)).ln();
        (1 + thresholds.iter().filter(|threshold| latent > **threshold).count()).to_string()
    });
    let at = study.hypotheses.iter().position(|own| own.response == "believability").unwrap();
    let id = study.hypotheses[at].id.to_lowercase();
    let report =
        analyze(&Table::parse(text.as_bytes()).unwrap(), &study, Language::English).unwrap();
    let file = |path: &str| {
        let path = path.replace("ID", &id);
        let found = report.files.iter().find(|file| file.path == path);
        found.unwrap_or_else(|| panic!("no {path}")).text.clone()
    };
    let drawn = Table::parse(file("tables/figure-hypothesis-ID-other-clips-sd.csv").into_bytes());
    let drawn = drawn.unwrap();
    assert_eq!(drawn.rows(), 4);
    for (row, (name, _, planted)) in terms.into_iter().enumerate() {
        assert_eq!(drawn.cell(row, 0), Some(name));
        let sd: f64 = drawn.cell(row, 1).unwrap().parse().unwrap();
        assert!((sd - planted).abs() < near_sd, "{name}: {sd}, planted {planted}");
    }
    let shares = file("tables/figure-hypothesis-ID-other-clips-shares.csv");
    let shares = Table::parse(shares.into_bytes()).unwrap();
    assert_eq!(shares.rows(), 4, "two levels, model and observed");
    let number =
        |row: usize, column: usize| -> f64 { shares.cell(row, column).unwrap().parse().unwrap() };
    let results: Value = serde_json::from_str(&file("results.json")).unwrap();
    let model = &results["hypotheses"][at]["other_clips"]["mixed_model"];
    for row in [0, 2] {
        assert_eq!(shares.cell(row, 1), Some("model"));
        assert_eq!(shares.cell(row + 1, 1), Some("observed"));
        let level = shares.cell(row, 0).unwrap();
        let shift = if level.contains("LSTS") || level == "lsts30" { effect } else { 0.0 };
        let below = |place: usize| match thresholds.get(place) {
            Some(threshold) => 1.0 / (1.0 + (shift - threshold).exp()),
            None => 1.0,
        };
        let mut before = 0.0;
        for place in 0..=thresholds.len() {
            let planted = below(place) - before;
            before = below(place);
            let own = number(row, 2 + place);
            assert!(
                (own - planted).abs() < near_share,
                "{level} {}: {own}, planted {planted}",
                place + 1
            );
        }
    }
    assert_eq!(model["ratings"].as_array().unwrap().len(), thresholds.len() + 1);
    let bars = file("figures/hypothesis-ID-other-clips-sd.svg");
    assert_eq!(bars.matches("class=\"box\"").count(), terms.len(), "a bar for each");
    for name in ["shares", "sd"] {
        let svg = file(&format!("figures/hypothesis-ID-other-clips-{name}.svg"));
        assert!(svg.contains("aria-label=") && !svg.contains("NaN"), "{svg}");
    }
    assert!(
        file("figures/hypothesis-ID-other-clips-sd.svg").contains("standard deviation (log odds)")
    );
}

#[test]
fn without_a_model_there_is_no_figure_and_that_is_said() {
    let study = demo_study();
    for (language, words) in
        [(Language::English, "are not drawn"), (Language::French, "ne sont pas dessinés")]
    {
        let csv = export(&study, &Raters { people: 4, effect: 1.0, seed: 9 });
        let report = analyze(&Table::parse(csv.as_bytes()).unwrap(), &study, language).unwrap();
        assert!(!report.files.iter().any(|file| file.path.contains("other-clips-sd")));
        let text = report.files.iter().find(|file| file.path == "report.md").unwrap();
        assert!(text.text.contains(words), "{}", text.text);
    }
}

/// One rating per person does not show how people differ: the mixed model has no result, and that is said.
#[test]
fn one_rating_per_person_gives_no_mixed_model() {
    let study = demo_study();
    let csv = export(&study, &Raters { people: 40, effect: 1.0, seed: 6 });
    let mut lines = csv.lines();
    let heading = lines.next().unwrap();
    let names: Vec<&str> = heading.split(',').collect();
    let place = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let [participant, order] = ["participant", "trial_order"].map(place);
    let kept = lines.filter(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let [participant, order] =
            [participant, order].map(|at| cells[at].parse::<usize>().unwrap());
        order == participant % 6 + 1
    });
    let csv = std::iter::once(heading).chain(kept).collect::<Vec<_>>().join("\n") + "\n";
    let report =
        analyze(&Table::parse(csv.as_bytes()).unwrap(), &study, Language::English).unwrap();
    let reading = &report.readings[2].1;
    assert!(reading.contains("every participant has one rating"), "{reading}");
}
