//! ROC curves of a forced choice with a rating of confidence: planted answers give the areas that pairs of answers have
//! when they are counted, and simulated people are surer where they are right.

use std::collections::HashMap;

use mimique_analysis::{Parameters, Simulation};
use mimique_locale::Language;
use mimique_stats::{Table, t_quantile_upper};
use mimique_study::{KindOfQuestion as _, Study};
use mimique_test_support::Random;
use serde_json::Value;

use crate::support::confident::confident;
use crate::support::demo_study;
use crate::support::planted::{answered, export_of_passes};
use crate::support::results::{careful, report, text};
use crate::support::simulated::simulated_export;

fn study() -> Study {
    let mut study = confident(demo_study());
    study.exclusions = None;
    study
}

/// What was shown, what was answered and how surely.
struct Trial {
    person: String,
    truth: String,
    answer: String,
    sure: i32,
}

fn trials(csv: &str) -> Vec<Trial> {
    let table = Table::parse(csv.as_bytes()).unwrap();
    let heading: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let place = |name: &str| heading.iter().position(|own| *own == name).unwrap();
    let cell = |row: usize, name: &str| table.cell(row, place(name)).unwrap_or_default().to_owned();
    let mut known: HashMap<(String, String), Trial> = HashMap::new();
    for row in 0..table.rows() {
        let response = cell(row, "response_id");
        let key = (cell(row, "participant_id"), cell(row, "trial_id"));
        let blank = || Trial {
            person: key.0.clone(),
            truth: String::new(),
            answer: String::new(),
            sure: 0,
        };
        match response.as_str() {
            "emotion" => {
                let own = known.entry(key.clone()).or_insert_with(blank);
                (own.truth, own.answer) = (cell(row, "truth"), cell(row, "answer"));
            }
            "believability" => {
                let sure = cell(row, "answer").parse().unwrap();
                known.entry(key.clone()).or_insert_with(blank).sure = sure;
            }
            _ => {}
        }
    }
    known.into_values().filter(|own| !own.truth.is_empty() && own.sure > 0).collect()
}

/// The share of pairs of a signal and a noise of which the signal is said the more surely to be of the category.
fn area(trials: &[&Trial], category: &str) -> f64 {
    let evidence =
        |own: &Trial| if own.answer == category { (1, own.sure) } else { (0, -own.sure) };
    let (signals, noise): (Vec<&Trial>, Vec<&Trial>) =
        trials.iter().partition(|own| own.truth == category);
    let mut above = 0.0;
    for signal in &signals {
        for other in &noise {
            above += match evidence(signal).cmp(&evidence(other)) {
                std::cmp::Ordering::Greater => 1.0,
                std::cmp::Ordering::Equal => 0.5,
                std::cmp::Ordering::Less => 0.0,
            };
        }
    }
    above / (signals.len() * noise.len()) as f64
}

#[test]
fn planted_answers_have_the_areas_that_their_pairs_have() {
    let study = study();
    let mut random = Random::new(12);
    let csv = export_of_passes(&study, 7, 4);
    let csv =
        answered(&csv, "believability", |_| (1 + (random.uniform() * 7.0) as usize).to_string());
    let all = trials(&csv);
    let (written, results) = report(&study, &csv, Language::English);
    let found = &results["roc"][0];
    assert_eq!(
        (&found["response"], &found["confidence"]),
        (&"emotion".into(), &"believability".into())
    );
    let categories = found["categories"].as_array().unwrap();
    assert_eq!(categories.len(), 6);
    for own in categories {
        let category = own["category"].as_str().unwrap();
        let pooled = own["pooled"]["area"].as_f64().unwrap();
        let counted = area(&all.iter().collect::<Vec<_>>(), category);
        assert!((pooled - counted).abs() < 1e-12, "{category}: {pooled}, counted {counted}");
        let people = own["people"].as_array().unwrap();
        let mut areas = Vec::new();
        for person in people {
            let id = person["participant"].as_str().unwrap();
            let of_person: Vec<&Trial> = all.iter().filter(|own| own.person == id).collect();
            let counted = area(&of_person, category);
            assert!((person["area"].as_f64().unwrap() - counted).abs() < 1e-12, "{id} {category}");
            areas.push(counted);
        }
        let (mean, variance) = mimique_stats::moments(&areas);
        let reach = t_quantile_upper(0.025, 6.0) * (variance.unwrap() / 7.0).sqrt();
        let [low, high] = [0, 1].map(|end| own["areas"]["mean_ci_t"][end].as_f64().unwrap());
        assert!((own["areas"]["mean"].as_f64().unwrap() - mean).abs() < 1e-12);
        assert!((low - mean + reach).abs() < 1e-12 && (high - mean - reach).abs() < 1e-12);
        // From nothing to everything, rising.
        let points = own["pooled"]["points"].as_array().unwrap();
        let number = |point: &Value, place: usize| point[place].as_f64().unwrap();
        assert_eq!((number(&points[0], 0), number(points.last().unwrap(), 1)), (0.0, 1.0));
        for pair in points.windows(2) {
            assert!((0..2).all(|place| number(&pair[1], place) >= number(&pair[0], place)));
        }
    }
    let svg = text(&written, "figures/emotion-roc.svg");
    assert_eq!(svg.matches("class=\"zero\"").count(), 1, "the diagonal");
    assert_eq!(svg.matches("fill=\"none\" stroke=").count(), 2 * 6, "a curve and a key each");
    assert!(svg.contains("rate of hits") && svg.contains("rate of false alarms"));
    let table = text(&written, "tables/emotion-roc.csv");
    assert_eq!(table.lines().count(), 1 + 6, "{table}");
    assert!(text(&written, "report.md").contains("ROC curves by confidence"));
}

#[test]
fn few_signals_are_told_of_all_people_together_and_in_french() {
    let study = study();
    let (written, results) = report(&study, &export_of_passes(&study, 5, 1), Language::French);
    for own in results["roc"][0]["categories"].as_array().unwrap() {
        assert_eq!((&own["few_signals"], &own["pooled"]["status"]), (&true.into(), &"ok".into()));
    }
    let table = text(&written, "tables/emotion-roc.csv");
    assert!(table.contains("aire, ensemble"), "{table}");
    for line in table.lines().skip(1) {
        assert_eq!(line.matches('–').count(), 2, "neither mean nor people: {line}");
    }
    assert!(text(&written, "report.md").contains("Courbes ROC selon la certitude"));
    assert!(text(&written, "figures/emotion-roc.svg").contains("taux de détections"));
    // Where nobody has said how sure an answer was, that is told.
    let csv = answered(&export_of_passes(&study, 5, 1), "believability", |_| "?".to_owned());
    let (written, results) = report(&study, &csv, Language::French);
    assert!(results["roc"].is_null());
    assert!(text(&written, "report.md").contains("il n’y a pas de courbe"));
}

#[test]
fn without_a_rating_of_confidence_there_is_no_curve_and_nothing_is_said() {
    let mut study = demo_study();
    study.exclusions = None;
    let (written, results) = report(&study, &export_of_passes(&study, 5, 1), Language::English);
    assert!(results["roc"].is_null() && results["detection"].is_array());
    assert!(!text(&written, "report.md").contains("ROC"));
}

#[test]
fn simulated_people_are_surer_where_they_are_right() {
    let study = study();
    let mean = |rise: f64| {
        let mut parameters: Parameters = careful(&study);
        parameters.recognition.get_mut("emotion").unwrap().confidence = rise;
        parameters.check(&study).unwrap();
        let simulation = Simulation::new(&study, "hash", &parameters, 3).unwrap();
        let (_, results) =
            report(&study, &simulated_export(&simulation, &study, 24), Language::English);
        let categories = results["roc"][0]["categories"].as_array().unwrap();
        let areas = categories.iter().map(|own| own["pooled"]["area"].as_f64().unwrap());
        areas.sum::<f64>() / categories.len() as f64
    };
    let [none, rather, very] = [0.0, 1.0, 4.0].map(mean);
    assert!(none + 0.01 < rather && rather + 0.01 < very, "{none} {rather} {very}");
    assert_eq!(Parameters::for_study(&study).recognition["emotion"].confidence, 1.0);
    assert_eq!(Parameters::for_study(&demo_study()).recognition["emotion"].confidence, 0.0);
}

#[test]
fn preregistrations_say_what_is_made_of_confidence() {
    let study = study();
    let kind = &study.questions.iter().find(|own| own.id == "emotion").unwrap().kind;
    assert!(kind.described("en").contains("`believability`, gives an ROC curve of each option"));
    assert!(
        kind.described("fr").contains("`believability`, donne une courbe ROC de chaque option")
    );
    let plain = demo_study();
    let kind = &plain.questions.iter().find(|own| own.id == "emotion").unwrap().kind;
    assert!(!kind.described("en").contains("ROC"));
}
