//! Parameters are planted, simulated, fitted and found again.

use std::collections::BTreeMap;

use mimique_analysis::{Parameters, Simulation};
use mimique_session::rows::{self, SessionRecord};
use mimique_stats::Table;
use mimique_study::Study;
use serde_json::Value;

fn study(name: &str) -> (Study, String) {
    let path = format!("{}/../../study-config/{name}", env!("CARGO_MANIFEST_DIR"));
    let value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    (Study::from_value(&value).unwrap(), mimique_study::config_hash(&value))
}

/// The tidy export of simulated people.
fn export(study: &Study, hash: &str, parameters: &Parameters, seed: u64, people: u64) -> Table {
    let simulation = Simulation::new(study, hash, parameters, seed).unwrap();
    let text = |cell: &Value| match cell {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let mut lines = Vec::new();
    for number in 1..=people {
        let session = simulation.session(number).unwrap();
        if session.events.is_empty() {
            continue;
        }
        let record = SessionRecord { started: &session.started, events: &session.events };
        let table = rows::tidy(study, &BTreeMap::new(), [record]);
        if lines.is_empty() {
            let names: Vec<&str> =
                table.columns.iter().map(|column| column.name.as_str()).collect();
            lines.push(names.join(","));
        }
        for row in &table.rows {
            lines.push(row.iter().map(text).collect::<Vec<_>>().join(","));
        }
    }
    Table::parse(lines.join("\n").as_bytes()).unwrap()
}

fn near(what: &str, found: f64, planted: f64, error: f64) {
    assert!((found - planted).abs() <= error, "{what}: {found}, planted {planted} (± {error})");
}

/// 200 people, 54 clips: 10,800 ratings. The errors are three to four standard errors of the estimates:
/// of a spread of people sd / sqrt(2 · 200), of people x method sd / sqrt(2 · 400) and the noise of 18
/// clips, of segments sd / sqrt(2 · 18), of an effect sqrt(0.35²/200 + ...) between methods.
#[test]
fn ratings_are_found_again() {
    let (study, hash) = study("power/independence.json");
    let mut planted = Parameters::for_study(&study);
    planted.careless.share = 0.0;
    planted.dropout = mimique_analysis::Dropout { declined: 0.0, per_trial: 0.004, withdrawn: 0.0 };
    let rating = planted.ratings.get_mut("rating").unwrap();
    // Thresholds that are not half-way: the middle of the scale is wide.
    rating.thresholds = vec![1.7, 2.6, 3.3, 4.7, 5.4, 6.3];
    (rating.mean, rating.noise_sd, rating.person_sd) = (4.2, 1.1, 0.7);
    (rating.segment_sd, rating.clip_sd) = (0.5, 0.25);
    rating.person_by_sd = [("method".to_owned(), 0.45)].into();
    let shifts = [("lsts30", 0.5), ("lsts50", 0.0), ("lsts70", -0.5)];
    let shifts = shifts.map(|(level, shift)| (level.to_owned(), shift)).into_iter().collect();
    let groups = [("no", -0.2), ("yes", 0.2)].map(|(level, shift)| (level.to_owned(), shift));
    rating.effects =
        [("method".to_owned(), shifts), ("group".to_owned(), groups.into_iter().collect())].into();
    planted
        .choices
        .insert("group".into(), [("no".to_owned(), 0.3), ("yes".to_owned(), 0.7)].into());
    planted.times.median_ms = 1800.0;
    planted.times.clip_ms = 500.0;
    planted.times.person_sigma = 0.4;
    planted.display.late_share = 0.01;
    let table = export(&study, &hash, &planted, 20, 200);
    // People who leave are kept: the file says `incomplete`, so fit without that rule.
    let mut open = study.clone();
    open.exclusions = None;
    let found = Parameters::fit(&table, &open).unwrap();
    found.check(&study).unwrap();
    let (was, is) = (&planted.ratings["rating"], &found.ratings["rating"]);
    near("noise", is.noise_sd, was.noise_sd, 0.06);
    near("people", is.person_sd, was.person_sd, 0.13);
    near("people x method", is.person_by_sd["method"], 0.45, 0.08);
    near("segments", is.segment_sd, was.segment_sd, 0.3);
    near("clips", is.clip_sd, was.clip_sd, 0.13);
    // Segments and clips of this simulation move the mean and the methods.
    near("mean", is.mean, was.mean, 0.5);
    for (threshold, planted) in is.thresholds.iter().zip(&was.thresholds) {
        near("threshold less mean", threshold - is.mean, planted - was.mean, 0.55);
    }
    for (pair, planted) in is.thresholds.windows(2).zip(was.thresholds.windows(2)) {
        near("between thresholds", pair[1] - pair[0], planted[1] - planted[0], 0.08);
    }
    for (level, shift) in &was.effects["method"] {
        near(level, is.effects["method"][level], *shift, 0.3);
    }
    near("group", is.effects["group"]["yes"], 0.2, 0.2);
    near("share of a group", found.choices["group"]["yes"], 0.7, 0.11);
    near("median time", found.times.median_ms, 1800.0, 220.0);
    near("times", found.times.sigma, planted.times.sigma, 0.02);
    near("times of people", found.times.person_sigma, 0.4, 0.08);
    near("clip", found.times.clip_ms, planted.times.clip_ms, 40.0);
    near("late frames", found.display.late_share, 0.01, 0.001);
    near("leaving", found.dropout.per_trial, 0.004, 0.002);
}

/// 300 people, 12 clips of six emotions.
#[test]
fn recognition_is_found_again() {
    let (study, hash) = study("demo.json");
    let mut planted = Parameters::for_study(&study);
    planted.careless.share = 0.0;
    planted.times.clip_ms = 200.0;
    let recognition = planted.recognition.get_mut("emotion").unwrap();
    (recognition.person_sd, recognition.segment_sd, recognition.clip_sd) = (0.6, 0.0, 0.0);
    recognition.person_by_sd = [("method".to_owned(), 0.4)].into();
    let shifts = [("lsts30", 0.25), ("box", -0.25)].map(|(level, shift)| (level.to_owned(), shift));
    recognition.effects = [("method".to_owned(), shifts.into_iter().collect())].into();
    let table = export(&study, &hash, &planted, 8, 400);
    let found = Parameters::fit(&table, &study).unwrap();
    found.check(&study).unwrap();
    let (was, is) = (&planted.recognition["emotion"], &found.recognition["emotion"]);
    for (right, rows) in &was.confusion {
        for (level, row) in rows {
            for (answer, share) in row {
                // 800 answers a row: three standard errors, people counted.
                let planted = share / row.values().sum::<f64>();
                near(
                    &format!("{right} as {answer}"),
                    is.confusion[right][level][answer],
                    planted,
                    0.07,
                );
            }
        }
    }
    near("people", is.person_sd, 0.6, 0.15);
    near("people x method", is.person_by_sd["method"], 0.4, 0.15);
    near("method", is.effects["method"]["lsts30"], 0.25, 0.08);
    assert!(is.clip_sd < 0.2 && is.segment_sd < 0.2, "{} {}", is.clip_sd, is.segment_sd);
}

/// What an export cannot tell is left as it was, and said by no number of its own.
#[test]
fn an_export_without_answers_is_refused() {
    let (study, hash) = study("demo.json");
    let mut nobody = Parameters::for_study(&study);
    nobody.dropout = mimique_analysis::Dropout { declined: 0.0, per_trial: 1.0, withdrawn: 0.0 };
    let table = export(&study, &hash, &nobody, 1, 5);
    let error = Parameters::fit(&table, &study).unwrap_err().to_string();
    assert!(error.contains("no answer of a trial is left"), "{error}");
}
