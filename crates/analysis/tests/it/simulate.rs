//! Simulated sessions: complete, the same each time, and true to what was planted.

use std::collections::BTreeMap;

use mimique_analysis::{Parameters, SimulatedSession, Simulation};
use mimique_session::rows::{self, SessionRecord, Table};
use mimique_session::{EventKind, Record};
use mimique_study::Study;

fn study(name: &str) -> (Study, String) {
    let path = format!("{}/../../study-config/{name}", env!("CARGO_MANIFEST_DIR"));
    let value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    (Study::from_value(&value).unwrap(), mimique_study::config_hash(&value))
}

fn sessions(
    study: &Study,
    hash: &str,
    parameters: &Parameters,
    seed: u64,
    people: u64,
) -> Vec<SimulatedSession> {
    let simulation = Simulation::new(study, hash, parameters, seed).unwrap();
    (1..=people).map(|number| simulation.session(number).unwrap()).collect()
}

fn tidy(study: &Study, sessions: &[SimulatedSession]) -> Table {
    let left = sessions.iter().filter(|session| !session.events.is_empty());
    let records =
        left.map(|session| SessionRecord { started: &session.started, events: &session.events });
    rows::tidy(study, &BTreeMap::new(), records)
}

/// How a session stands, in the export's word.
fn status(events: &[mimique_session::wire::Event]) -> &'static str {
    Record::of(None, events).standing.export_word()
}

#[test]
fn every_kind_of_question_is_answered_as_the_page_takes_it() {
    for name in ["demo.json", "template.json", "study1.json", "animface.json"] {
        let (study, hash) = study(name);
        let mut parameters = Parameters::for_study(&study);
        parameters.dropout =
            mimique_analysis::Dropout { declined: 0.0, per_trial: 0.0, withdrawn: 0.0 };
        for session in sessions(&study, &hash, &parameters, 5, 6) {
            assert_eq!(status(&session.events), "completed", "{name}");
            for event in &session.events {
                let kind = EventKind::from_body(&event.body);
                assert!(
                    !matches!(kind, None | Some(EventKind::Unexpected { .. })),
                    "{name}: {event:?}"
                );
            }
        }
    }
}

#[test]
fn is_the_same_for_the_same_seed_and_other_for_another() {
    let (study, hash) = study("demo.json");
    let parameters = Parameters::for_study(&study);
    let first = sessions(&study, &hash, &parameters, 7, 4);
    assert_eq!(first, sessions(&study, &hash, &parameters, 7, 4));
    assert_ne!(first, sessions(&study, &hash, &parameters, 8, 4));
    // The order of trials is the study's own, whatever the seed.
    let trials = |sessions: &[SimulatedSession]| -> Vec<String> {
        let table = tidy(&study, sessions);
        (0..table.rows.len()).map(|row| table.cell(row, "trial_id").to_string()).collect()
    };
    assert_eq!(trials(&first[..2]), trials(&sessions(&study, &hash, &parameters, 9, 2)));
}

/// The demonstration in two conditions: its trials in the order of the file, or drawn.
fn in_conditions() -> (Study, String) {
    let path = format!("{}/../../study-config/demo.json", env!("CARGO_MANIFEST_DIR"));
    let mut value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    let condition = |id: &str, order: &str| serde_json::json!({ "id": id, "conditional": true, "order": order, "components": ["faces"] });
    let conditions = [condition("as-listed", "fixed"), condition("drawn", "random")];
    value["sequence"] = serde_json::json!({ "order": "fixed", "components": conditions });
    (Study::from_value(&value).unwrap(), mimique_study::config_hash(&value))
}

#[test]
fn everybody_is_in_a_condition_each_as_often() {
    let (study, hash) = in_conditions();
    let parameters = Parameters::for_study(&study);
    let all = sessions(&study, &hash, &parameters, 1, 6);
    let places: Vec<_> = all
        .iter()
        .map(|each| (each.started.condition.as_deref().unwrap(), each.started.slot))
        .collect();
    let [a, b] = ["as-listed", "drawn"];
    assert_eq!(places, [(a, 1), (b, 1), (a, 2), (b, 2), (a, 3), (b, 3)]);
    let table = tidy(&study, &all);
    for row in 0..table.rows.len() {
        let number = table.cell(row, "participant").as_u64().unwrap();
        assert_eq!(table.cell(row, "assigned_condition"), [b, a][(number % 2) as usize]);
    }
    // Trials of a condition come in its own order.
    let clips = |number: u64| -> Vec<&str> {
        let own = (0..table.rows.len()).filter(|&row| {
            table.cell(row, "participant") == number && table.cell(row, "response_id") == "emotion"
        });
        own.map(|row| table.cell(row, "stimulus").as_str().unwrap()).collect()
    };
    let listed: Vec<String> = study.clips().into_iter().map(|clip| clip.id).collect();
    assert!(listed.starts_with(&clips(1).iter().map(|id| (*id).to_owned()).collect::<Vec<_>>()));
    assert_ne!(clips(2), clips(1));
}

#[test]
fn dropout_checks_frames_and_times_are_as_planted() {
    let (study, hash) = study("template.json");
    let mut parameters = Parameters::for_study(&study);
    parameters.dropout =
        mimique_analysis::Dropout { declined: 0.1, per_trial: 0.02, withdrawn: 0.25 };
    parameters.careless =
        mimique_analysis::Careless { share: 0.2, attention_pass: 0.5, time_share: 0.4 };
    parameters.attention_pass = 1.0;
    parameters.display.late_share = 0.03;
    parameters.display.slow_people = 0.0;
    parameters.times.clip_ms = 500.0;
    let people = 1500;
    let sessions = sessions(&study, &hash, &parameters, 3, people);
    let share = |count: usize| count as f64 / people as f64;
    let declined = sessions.iter().filter(|s| status(&s.events) == "declined").count();
    // Standard errors about 0.008 for shares of people; the seed is fixed.
    assert!((share(declined) - 0.1).abs() < 0.025, "declined {}", share(declined));
    let trials = study.clips().len() as i32;
    let table = tidy(&study, &sessions);
    let leaves = 0.9 * (1.0 - 0.98_f64.powi(trials));
    let gone = sessions.iter().filter(|s| s.events.is_empty()).count();
    assert!((share(gone) - 0.25 * leaves).abs() < 0.02, "withdrawn {}", share(gone));
    let active =
        sessions.iter().filter(|s| !s.events.is_empty() && status(&s.events) == "active").count();
    assert!((share(active) - 0.75 * leaves).abs() < 0.03, "left {}", share(active));

    let (mut checks, mut passed, mut frames, mut late) = (0.0, 0.0, 0.0, 0.0);
    for row in 0..table.rows.len() {
        if let Some(pass) = table.cell(row, "attention_passed").as_bool() {
            checks += 1.0;
            passed += f64::from(u8::from(pass));
        }
        frames += table.cell(row, "frames").as_f64().unwrap_or(0.0);
        late += table.cell(row, "frames_late").as_f64().unwrap_or(0.0);
        if let Some(rt) = table.cell(row, "rt").as_f64() {
            assert!(rt > 0.0);
            if table.cell(row, "trial_type") == "trial" {
                assert!(rt >= parameters.times.clip_ms);
            }
        }
    }
    assert!(checks > 1000.0);
    assert!((passed / checks - 0.9).abs() < 0.03, "passed {}", passed / checks);
    assert!((late / frames - 0.03).abs() < 0.002, "late {}", late / frames);
}

#[test]
fn answers_have_the_planted_confusion_means_and_spreads() {
    let (study, hash) = study("demo.json");
    let mut parameters = Parameters::for_study(&study);
    parameters.careless.share = 0.0;
    parameters.times.clip_ms = 200.0;
    let rating = parameters.ratings.get_mut("believability").unwrap();
    rating.mean = 4.0;
    rating.interactions.clear();
    rating.effects = [(
        "method".to_owned(),
        [("lsts30".to_owned(), 0.5), ("box".to_owned(), -0.5)].into_iter().collect(),
    )]
    .into_iter()
    .collect();
    (rating.segment_sd, rating.clip_sd) = (0.0, 0.0);
    let recognition = parameters.recognition.get_mut("emotion").unwrap();
    recognition.effects.clear();
    (recognition.segment_sd, recognition.clip_sd) = (0.0, 0.0);
    recognition.person_sd = 0.8;
    let table = tidy(&study, &sessions(&study, &hash, &parameters, 11, 1500));
    let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    let mut answers: BTreeMap<(String, String), f64> = BTreeMap::new();
    let mut shown: BTreeMap<String, f64> = BTreeMap::new();
    for row in 0..table.rows.len() {
        let text = |column: &str| table.cell(row, column).as_str().unwrap_or_default().to_owned();
        match text("response_id").as_str() {
            "believability" => {
                let sum = sums.entry(text("method")).or_default();
                sum.0 += table.cell(row, "answer").as_f64().unwrap();
                sum.1 += 1.0;
            }
            "emotion" => {
                *answers.entry((text("expression"), text("answer"))).or_default() += 1.0;
                *shown.entry(text("expression")).or_default() += 1.0;
            }
            _ => {}
        }
    }
    // 9,000 ratings a method; people's spread 0.6 and 0.3 gives a standard error of 0.02.
    for (method, expected) in [("lsts30", 4.5), ("box", 3.5)] {
        let (sum, count) = sums[method];
        assert!((sum / count - expected).abs() < 0.06, "{method}: {}", sum / count);
    }
    // The share of right answers over people is the matrix's, however much people differ.
    for (right, rows) in &parameters.recognition["emotion"].confusion {
        for (answer, share) in rows.values().next().unwrap() {
            let found = answers.get(&(right.clone(), answer.clone())).copied().unwrap_or(0.0);
            let found = found / shown[right];
            assert!((found - share).abs() < 0.035, "{right} as {answer}: {found}, planted {share}");
        }
    }
}

#[test]
fn parameters_name_the_key_that_is_wrong() {
    let (study, _) = study("demo.json");
    let base = Parameters::for_study(&study);
    let refused = |text: &str| Parameters::read_over(&base, text, &study).unwrap_err().to_string();
    for (text, expected) in [
        (
            r#"{"ratings": {"believability": {"personSd": -1}}}"#,
            "/ratings/believability/personSd: -1 is no standard deviation",
        ),
        (
            r#"{"ratings": {"belief": {"mean": 4}}}"#,
            "/ratings/belief: the study has no such question here",
        ),
        (
            r#"{"ratings": {"believability": {"mena": 4}}}"#,
            "/ratings/believability/mena: unknown field `mena`",
        ),
        (
            r#"{"ratings": {"believability": {"mean": "four"}}}"#,
            "/ratings/believability/mean: invalid type",
        ),
        (
            r#"{"ratings": {"believability": {"thresholds": [1, 2]}}}"#,
            "/ratings/believability/thresholds: 2 thresholds for a scale of 7 points",
        ),
        (
            r#"{"ratings": {"believability": {"effects": {"method": {"lst": 1}}}}}"#,
            "/ratings/believability/effects/method/lst: there is no level \"lst\"",
        ),
        (
            r#"{"ratings": {"believability": {"effects": {"methods": {}}}}}"#,
            "/ratings/believability/effects/methods: there is no factor",
        ),
        (
            r#"{"recognition": {"emotion": {"confusion": {"joy": {"*": {"joy": 1}}}}}}"#,
            "/recognition/emotion/confusion: there is no row of \"anger\"",
        ),
        (r#"{"careless": {"share": 1.5}}"#, "/careless/share: 1.5 is no share"),
        (r#"{"dropuot": {}}"#, "/dropuot: unknown field `dropuot`"),
        ("{", "/: line"),
    ] {
        let found = refused(text);
        assert!(found.starts_with(expected), "{text}: {found}");
    }
    let read =
        Parameters::read_over(&base, r#"{"times": {"clipMs": 500}, /* ours */}"#, &study).unwrap();
    assert_eq!(read.times.clip_ms, 500.0);
    assert_eq!(read.ratings, base.ratings);
}

#[test]
fn default_parameters_fit_every_study_of_the_repository() {
    for name in
        ["demo.json", "template.json", "study1.json", "animface.json", "power/independence.json"]
    {
        let (study, _) = study(name);
        let parameters = Parameters::for_study(&study);
        parameters.check(&study).unwrap_or_else(|error| panic!("{name}: {error}"));
        parameters.without_effects(&study).check(&study).unwrap();
        let text = serde_json::to_string(&parameters).unwrap();
        let read = Parameters::read_over(&parameters, &text, &study).unwrap();
        assert_eq!(read, parameters);
    }
}
