//! Of which factors answers to two clips at once can be told.

use mimique_study::{AnswerOfPair, Measure, Study};
use serde_json::{Value, json};

/// Two segments by three methods; `blocks` show them, and ask for a rating and a choice.
fn study(blocks: Value) -> Study {
    let mut study =
        mimique_study::parse(include_str!("../../../../study-config/study2b.json")).unwrap();
    let choice = json!({ "id": "nearer", "type": "comparison", "prompt": "Which is nearer?" });
    study["questions"].as_array_mut().unwrap().push(choice);
    study["components"] = blocks;
    Study::from_value(&study).unwrap()
}

fn block(methods: &[&str], beside: Value) -> Value {
    let mut block = json!({ "type": "trials", "questions": ["fidelity", "nearer"],
        "clips": { "where": { "method": methods } } });
    if !beside.is_null() {
        block["beside"] = beside;
    }
    block
}

fn found(study: &Study, question: &str, measure: Measure, factor: &str) -> Option<AnswerOfPair> {
    let question = study.questions.iter().find(|each| each.id == question).unwrap();
    study.answer_of_pair(question, measure, factor, &[])
}

#[test]
fn a_rating_beside_one_reference_that_is_not_compared_is_of_the_clip() {
    let real = json!({ "method": "real", "avatar": "actor" });
    let study = study(json!({ "pairs": block(&["lsts30", "box"], real) }));
    for factor in ["method", "expression", "avatar"] {
        assert_eq!(found(&study, "fidelity", Measure::Answer, factor), None, "{factor}");
    }
    // The time to choose is a time with this clip beside the reference, the choice is of neither.
    assert_eq!(found(&study, "nearer", Measure::Rt, "method"), None);
    let choice = found(&study, "nearer", Measure::Answer, "method");
    assert!(matches!(choice, Some(AnswerOfPair::Choice { .. })), "{choice:?}");
}

#[test]
fn a_rating_of_clips_that_are_compared_with_each_other_is_of_neither() {
    let blocks = json!({
        "first": block(&["lsts30"], json!({ "method": "box" })),
        "second": block(&["box"], json!({ "method": "lsts30" })),
    });
    let study = study(blocks);
    let Some(AnswerOfPair::Rating { question, factor, clip, beside }) =
        found(&study, "fidelity", Measure::Answer, "method")
    else {
        panic!("told of a method");
    };
    assert_eq!([question, factor], ["fidelity", "method"]);
    assert_eq!([clip, beside], ["anger1.lsts30.head", "anger1.box.head"]);
    // Both clips show the same emotion: a rating of the two is one of that emotion.
    assert_eq!(found(&study, "fidelity", Measure::Answer, "expression"), None);
    assert_eq!(found(&study, "fidelity", Measure::Answer, "age"), None);
}

#[test]
fn a_rating_is_of_neither_where_only_some_clips_have_a_companion() {
    let blocks = json!({
        "alone": block(&["lsts30"], Value::Null),
        "beside": block(&["box"], json!({ "method": "real", "avatar": "actor" })),
    });
    let found = found(&study(blocks), "fidelity", Measure::Answer, "method");
    assert!(matches!(found, Some(AnswerOfPair::Rating { .. })), "{found:?}");
}

#[test]
fn only_the_levels_that_are_compared_count() {
    let blocks = json!({
        "solved": block(&["lsts30", "box"], json!({ "method": "real", "avatar": "actor" })),
        "real": block(&["real"], json!({ "method": "box", "avatar": "head" })),
    });
    let study = study(blocks);
    let is_told = |levels: &[&str]| {
        let levels: Vec<String> = levels.iter().map(|level| (*level).to_owned()).collect();
        let question = study.questions.iter().find(|each| each.id == "fidelity").unwrap();
        study.answer_of_pair(question, Measure::Answer, "method", &levels).is_none()
    };
    assert!(is_told(&["lsts30", "box"]));
    assert!(!is_told(&["lsts30", "real"]) && !is_told(&[]));
}
