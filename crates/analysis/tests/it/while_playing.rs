//! Answers while the clip plays, from simulated people to the report: presses with their times, lines with their courses.

use std::collections::{BTreeMap, HashMap};

use mimique_analysis::{Parameters, ReportOptions, Simulation, analyze_with};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;
use serde_json::Value;

use crate::support::followed::{followed, followed_with, followers, speeded};
use crate::support::simulated::simulated_export;

/// The preview to which figures lead.
const PREVIEW: &str = "http://lab.example/preview/speeded";

fn results(
    study: &Study,
    parameters: &Parameters,
    people: u64,
) -> (Value, HashMap<String, String>) {
    let simulation = Simulation::new(study, "hash", parameters, 7).unwrap();
    let csv = simulated_export(&simulation, study, people);
    let table = Table::parse(csv.as_bytes()).unwrap();
    let options = ReportOptions { preview: Some(PREVIEW), ..ReportOptions::default() };
    let report = analyze_with(&table, study, Language::English, options).unwrap();
    let files: HashMap<String, String> =
        report.files.into_iter().map(|file| (file.path, file.text)).collect();
    (serde_json::from_str(&files["results.json"]).unwrap(), files)
}

#[test]
fn planted_times_of_presses_are_found_again() {
    let study = speeded(|_| ());
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
    let parameters = followers(&study, [("box", 60.0), ("lsts", 80.0), ("recorded", 90.0)]);
    let (results, files) = results(&study, &parameters, 30);
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
    assert!(files.contains_key("figures/strength-while-playing.svg"));
    assert!(files.contains_key("tables/figure-strength-while-playing.csv"));
}

/// The pairs of levels of the first trace, each with its significant spans.
fn significant(results: &Value) -> Vec<(String, Vec<[f64; 2]>)> {
    let pairs = results["traces"][0]["pairs"].as_array().unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let spans = |pair: &Value| {
        assert_eq!(pair["test"]["status"], "ok", "{pair}");
        assert_eq!(
            (&pair["test"]["seed"], &pair["test"]["permutations"]),
            (&1.into(), &5000.into())
        );
        let spans = pair["spans"].as_array().unwrap().iter();
        let spans = spans.filter(|span| number(&span["p_corrected"]) < 0.05);
        spans.map(|span| [number(&span["from_s"]), number(&span["to_s"])]).collect()
    };
    let name =
        |pair: &Value| format!("{} {}", pair["a"].as_str().unwrap(), pair["b"].as_str().unwrap());
    pairs.iter().map(|pair| (name(pair), spans(pair))).collect()
}

#[test]
fn courses_that_part_are_found_from_then_on_and_marked() {
    let study = followed();
    let parameters = followers(&study, [("box", 60.0), ("lsts", 60.0), ("recorded", 90.0)]);
    let (results, files) = results(&study, &parameters, 24);
    let seconds = parameters.times.clip_ms / 1000.0;
    for (pair, spans) in significant(&results) {
        if pair == "box lsts" {
            assert!(spans.is_empty(), "{spans:?}");
            continue;
        }
        let [[from, to]] = spans[..] else { panic!("{pair}: {spans:?}") };
        // The line stands in the middle at first, and goes to its place from then on.
        assert!(from > 0.0 && from < 0.5, "{pair}: {from}");
        assert!((to - seconds).abs() < 0.1, "{pair}: {to}");
    }
    let svg = &files["figures/strength-while-playing.svg"];
    assert_eq!(svg.matches("class=\"mark\"").count(), 2, "{svg}");
    assert!(svg.contains("Clusters that differ"), "{svg}");
    // Each method has many clips: a cluster stands for none of them.
    assert!(!svg.contains(PREVIEW), "{svg}");
    assert!(files["report.md"].contains("with seed 1"));
    let table = &files["tables/strength-while-playing-clusters.csv"];
    assert_eq!(table.lines().count(), 1 + 3, "{table}");
}

#[test]
fn a_cluster_between_two_clips_leads_to_both_of_them_at_its_beginning() {
    let study = followed_with(|file| {
        file["stimuli"]["segments"].as_array_mut().unwrap().retain(|own| own["id"] == "joy2");
    });
    let parameters = followers(&study, [("box", 60.0), ("lsts", 60.0), ("recorded", 90.0)]);
    let (results, files) = results(&study, &parameters, 24);
    let found = significant(&results);
    let svg = &files["figures/strength-while-playing.svg"];
    let mut links = 0;
    for (pair, spans) in found {
        let (a, b) = pair.split_once(' ').unwrap();
        for [from, _] in spans {
            let place = format!("?clip=joy2.{a}&amp;beside=joy2.{b}&amp;t={from:.3}");
            assert!(svg.contains(&place), "{place} in {svg}");
            links += 1;
        }
    }
    assert!(links >= 2, "{svg}");
    assert_eq!(svg.matches(PREVIEW).count(), links);
    assert!(svg.contains("role=\"group\"") && svg.contains("<title>Preview of joy2."), "{svg}");
}
