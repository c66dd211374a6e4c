//! Simulated answers are the same directly and by way of events and CSV.

use mimique_stats::Table;
use mimique_study::Study;
use mimique_study::columns::ASSIGNED_CONDITION;
use serde_json::Value;

use super::design::Design;
use super::precision;
use crate::Parameters;
use crate::simulate::Simulation;
use crate::trials::export::{Export, Trial};

fn study(name: &str) -> (Value, Study) {
    let path = format!("{}/../../study-config/{name}", env!("CARGO_MANIFEST_DIR"));
    let value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    let study = Study::from_value(&value).unwrap();
    (value, study)
}

/// The tidy export of simulated sessions, as CSV.
fn csv(study: &Study, hash: &str, parameters: &Parameters, seed: u64, people: u64) -> String {
    let simulation = Simulation::new(study, hash, parameters, seed).unwrap();
    precision::csv(study, &simulation.sessions(people, |session| session).unwrap())
}

/// The demo study with every rule that leaves people or trials out, a response time, and a condition.
fn strict_demo() -> Value {
    let (mut value, _) = study("demo.json");
    value["exclusions"] = serde_json::json!({
        "incomplete": true, "failedAttentionChecks": 0, "lateFrameShare": 0.05,
        "longestFrameMs": 33.0, "shortestRtMs": 1200.0,
        "straightLining": {"longestRun": 3},
    });
    value["hypotheses"].as_array_mut().unwrap().push(serde_json::json!({
        "id": "H5", "statement": "s", "test": "wilcoxon", "response": "believability",
        "measure": "rt", "factors": ["method"],
    }));
    value["components"]["check"] = serde_json::json!({"type": "questionnaire", "questions": [{
        "id": "check", "type": "singleChoice", "prompt": "Choose blue",
        "attentionCheck": {"expected": "blue"},
        "options": [{"value": "red", "label": "Red"}, {"value": "blue", "label": "Blue"}],
    }]});
    let conditions = ["rested", "at-once"].map(|id| {
        serde_json::json!({
            "id": id, "conditional": true, "order": "random", "components": ["faces"],
            "interruptions": [{"component": "check", "spacing": 100, "firstLocation": 4}],
        })
    });
    value["sequence"] = serde_json::json!({"order": "fixed", "components": conditions});
    // It shifts answers and times.
    for measure in ["answer", "rt"] {
        value["hypotheses"].as_array_mut().unwrap().push(serde_json::json!({
            "id": measure, "statement": "s", "test": "mann-whitney", "measure": measure,
            "response": "believability", "factors": [ASSIGNED_CONDITION],
        }));
    }
    value["questions"][2]["showIf"] =
        serde_json::json!({"question": "perceived_intensity", "atLeast": 3});
    value
}

#[test]
fn direct_answers_are_those_of_the_export() {
    let value = strict_demo();
    let study = Study::from_value(&value).unwrap();
    let hash = mimique_study::config_hash(&value);
    let mut parameters = Parameters::for_study(&study);
    parameters.dropout = crate::Dropout { declined: 0.1, per_trial: 0.01, withdrawn: 0.3 };
    parameters.careless.share = 0.2;
    parameters.display.slow_people = 0.3;
    let people = 60;
    let design = Design::new(&study, &hash, people, None).unwrap();
    let model = design.model(&parameters);
    for seed in [1, 99] {
        let text = csv(&study, &hash, &parameters, seed, people as u64);
        let table = Table::parse(text.as_bytes()).unwrap();
        let read = Export::read(&table, &study).unwrap();
        let direct = design.answers(&model, seed, people);
        assert_eq!(direct.people, read.people);
        assert_eq!(direct.flow, read.flow);
        // The place in the order has no part in the tests: the direct path leaves it out.
        let unplaced: Vec<Trial> = read
            .trials
            .iter()
            .map(|trial| Trial { order: None, beside: None, ..trial.clone() })
            .collect();
        assert_eq!(direct.trials, unplaced);
        assert_eq!(direct.factors, read.factors);
        assert!(direct.about.iter().any(|(name, _)| name == ASSIGNED_CONDITION));
        for (question, cells) in &direct.about {
            let column = read.about.iter().find(|(name, _)| name == question).unwrap();
            assert_eq!(cells, &column.1, "{question}");
        }
        assert_eq!(direct.answers, read.answers);
        // The rules bite, or this test says little.
        assert!(read.flow.people_left_out.len() >= 2, "{:?}", read.flow);
        assert!(read.flow.trials_left_out.len() >= 3, "{:?}", read.flow);
    }
}

#[test]
fn pairs_that_follow_from_answers_are_those_of_the_export() {
    let (mut value, _) = study("pairs.json");
    let blocks = value["components"].as_object_mut().unwrap().values_mut();
    for block in blocks.filter(|block| block["type"] == "pairs") {
        block["schedule"] = serde_json::json!({ "rule": "active", "perParticipant": 8 });
    }
    let study = Study::from_value(&value).unwrap();
    let hash = mimique_study::config_hash(&value);
    let mut parameters = Parameters::for_study(&study);
    parameters.dropout = crate::Dropout { declined: 0.1, per_trial: 0.03, withdrawn: 0.3 };
    let people = 25;
    let design = Design::new(&study, &hash, people, None).unwrap();
    let direct = design.answers(&design.model(&parameters), 3, people);
    let text = csv(&study, &hash, &parameters, 3, people as u64);
    let read = Export::read(&Table::parse(text.as_bytes()).unwrap(), &study).unwrap();
    assert_eq!(direct.flow, read.flow);
    assert!(direct.trials.len() > 120, "{}", direct.trials.len());
    let pairs = |export: &Export| -> Vec<[String; 2]> {
        let pair = |trial: &Trial| {
            let beside = trial.beside.as_ref().unwrap();
            [trial.stimulus.to_string(), beside.clip.to_string()]
        };
        export.trials.iter().map(pair).collect()
    };
    assert_eq!(pairs(&direct), pairs(&read));
    // No hypothesis is about times: they are not drawn.
    let told = |export: &Export, response: &str| -> Vec<(usize, usize, String)> {
        let answers = export.answers[response].iter();
        answers.map(|own| (own.person, own.trial, own.text.to_string())).collect()
    };
    for response in direct.answers.keys() {
        assert!(told(&direct, response) == told(&read, response), "{response}");
    }
    // What others answered counts: whoever follows own answers alone is shown other pairs.
    let alone = Simulation::new(&study, &hash, &parameters, 3).unwrap();
    let drawn = |session: crate::SimulatedSession| {
        let events = session.events.into_iter();
        events
            .filter(|event| event.body["type"] == "pairs_drawn")
            .map(|event| event.body)
            .next_back()
    };
    let together = alone.sessions(people as u64, drawn).unwrap();
    let told = together[people - 1].as_ref().unwrap()["answers"].as_u64().unwrap();
    assert!(told > 100, "the last is drawn under the answers of all before: {told}");
    assert_ne!(together[people - 1], drawn(alone.session(people as u64).unwrap()));
}
