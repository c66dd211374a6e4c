//! Best-worst scaling from the page to the export: what is shown, what is refused, the two columns.

use std::collections::BTreeMap;

use mimique_session::flow::{Input, QuestionKindView, View};
use mimique_session::rows::{SessionRecord, tidy, wide};
use mimique_study::{check, parse};
use serde_json::{Value, json};

use crate::support::{Page, first_answer, study_text};

/// The demonstration study, which asks for the best and the worst feature before its trials.
fn study() -> String {
    let mut file = parse(&study_text("demo.json")).unwrap();
    let option = |value: &str| json!({ "value": value, "label": { "en": value, "fr": value } });
    let options: Vec<Value> = ["eyes", "mouth", "skin"].map(option).into();
    let question = json!({
        "id": "feature", "type": "bestWorst",
        "prompt": { "en": "Which looks best, which worst?", "fr": "Le meilleur, le pire ?" },
        "options": options,
    });
    file["demographics"]["questions"].as_array_mut().unwrap().push(question);
    let text = file.to_string();
    let report = check(&text, &|_| Ok(()));
    assert!(report.issues.is_empty(), "{:?}", report.issues);
    text
}

#[test]
fn the_best_and_the_worst_are_picked_and_exported() {
    let mut page = Page::open(&study(), 1);
    page.send(Input::Consent);
    let answers = |id: &str, kind: &QuestionKindView| match kind {
        QuestionKindView::BestWorst { best, worst, options } => {
            assert_eq!((best.as_str(), worst.as_str(), options.len()), ("Best", "Worst", 3));
            json!({ "best": options[2].value, "worst": options[0].value })
        }
        other => first_answer(id, other),
    };
    let View::Questions { questions, .. } = page.view() else { panic!("no questions") };
    for question in &questions {
        let value = answers(&question.id, &question.kind);
        page.send(Input::Answer { question: question.id.clone(), value });
    }
    // The worst alone is no answer: the page stays, and says so.
    let whole = json!({ "best": "skin", "worst": "eyes" });
    for partial in [json!({ "worst": "eyes" }), json!({ "best": "eyes", "worst": "eyes" })] {
        page.send(Input::Answer { question: "feature".into(), value: partial });
        page.send(Input::Next);
        let View::Questions { questions, .. } = page.view() else { panic!("the page went on") };
        let feature = questions.iter().find(|question| question.id == "feature").unwrap();
        assert!(feature.problem.is_some());
    }
    page.send(Input::Answer { question: "feature".into(), value: whole });
    while page.act(&mut |id, kind| answers(id, kind)) {}

    let record = || SessionRecord { started: &page.plan.started, events: &page.stored };
    let table = tidy(&page.study, &BTreeMap::new(), [record()]);
    let answer = |table: &mimique_session::rows::Table, response: &str| {
        let rows = 0..table.rows.len();
        let mut found = rows.filter(|row| table.cell(*row, "response_id") == response);
        table.cell(found.next().unwrap(), "answer").clone()
    };
    assert_eq!(answer(&table, "feature.best"), json!("skin"));
    assert_eq!(answer(&table, "feature.worst"), json!("eyes"));
    // An answer about the person is a column of every row, with its levels in the dictionary.
    for (name, value) in [("feature.best", "skin"), ("feature.worst", "eyes")] {
        assert!((0..table.rows.len()).all(|row| table.cell(row, name) == value));
        let column = &table.columns[table.column(name).unwrap()];
        let levels: Vec<&Value> = column.levels.iter().map(|(value, _)| value).collect();
        assert_eq!(levels, ["eyes", "mouth", "skin"]);
    }
    let table = wide(&page.study, &BTreeMap::new(), [record()]);
    assert_eq!(table.rows.len(), 1);
    assert_eq!(table.cell(0, "feature.best"), "skin");
    assert_eq!(table.cell(0, "feature.worst"), "eyes");
}
