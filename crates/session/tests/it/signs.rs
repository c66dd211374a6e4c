//! Every prompt and every option can be signed: what a study names is checked, loaded before its page, and
//! handed to the page where it belongs.

use mimique_session::flow::{ChoiceView, Input, QuestionKindView, QuestionView, Step, View};
use mimique_study::{Problem, Study, check, parse};
use serde_json::{Value, json};

use crate::support::{Page, first_answer, study_text};

fn text(words: &str) -> Value {
    json!({ "en": words, "fr": format!("{words} (fr)") })
}

/// An option with a signed video a language.
fn signed(value: &str) -> Value {
    let video = json!({ "en": format!("{value}-bsl.mp4"), "fr": format!("{value}-lsf.mp4") });
    json!({ "value": value, "label": text(value), "video": video })
}

fn question(id: &str, mut parts: Value) -> Value {
    parts["id"] = json!(id);
    parts["prompt"] = text(id);
    let video = json!({ "en": format!("{id}-bsl.mp4"), "fr": format!("{id}-lsf.mp4") });
    parts["video"] = video;
    parts
}

/// A study that signs everything: a page of questions, and a comparison in its trials.
fn study() -> String {
    let mut file = parse(&study_text("study2b.json")).unwrap();
    let ends = |one: &str, other: &str| json!([signed(one), signed(other)]);
    let choices = |one: &str, other: &str| json!([signed(one), signed(other)]);
    file["demographics"] = json!({ "questions": [
        question("scale", json!({ "type": "likert", "numItems": 2, "labels": [text("a"), text("b")],
            "signs": ends("1", "2") })),
        question("line", json!({ "type": "slider", "minimum": 0, "maximum": 10,
            "leftLabel": text("no"), "rightLabel": text("yes"), "signs": ends("no", "yes") })),
        question("affect", json!({ "type": "valenceArousal", "leftLabel": text("bad"),
            "rightLabel": text("good"), "bottomLabel": text("calm"), "topLabel": text("wild"),
            "signs": [signed("bad"), signed("good"), signed("calm"), signed("wild")] })),
        question("table", json!({ "type": "matrix", "rows": choices("row1", "row2"),
            "options": choices("column1", "column2") })),
        question("rank", json!({ "type": "ranking", "options": choices("eyes", "mouth") })),
        question("one", json!({ "type": "singleChoice", "options": choices("x", "y") })),
        question("any", json!({ "type": "multipleChoice", "options": choices("u", "v") })),
    ] });
    let nearer = question(
        "nearer",
        json!({ "type": "comparison", "allowSame": true,
            "signs": [signed("left"), signed("right"), signed("same")] }),
    );
    file["questions"].as_array_mut().unwrap().push(nearer);
    for component in file["components"].as_object_mut().unwrap().values_mut() {
        if component["type"] == "trials" {
            component["questions"].as_array_mut().unwrap().push(json!("nearer"));
        }
    }
    file.to_string()
}

/// The words that are signed on the page of questions, in the order of the file.
const SIGNED: [&str; 23] = [
    "scale", "1", "2", "line", "no", "yes", "affect", "bad", "good", "calm", "wild", "table",
    "row1", "row2", "column1", "column2", "rank", "eyes", "mouth", "one", "x", "y", "any",
];

#[test]
fn every_signed_video_is_asked_for_and_missed() {
    assert_eq!(check(&study(), &|_| Ok(())).issues, []);
    let missing = |path: &str| Err(Problem::NoFile { path: path.to_owned() });
    let report = check(&study(), &missing);
    let places: Vec<_> = report
        .issues
        .iter()
        .filter(|issue| issue.code() == "missing-file")
        .map(|issue| issue.pointer.as_str())
        .collect();
    // 25 on the page, 4 of the comparison, each in two languages.
    assert_eq!(places.len(), 58, "{places:?}");
    for place in [
        "/demographics/questions/0/signs/1/video/fr",
        "/demographics/questions/2/signs/3/video/en",
        "/demographics/questions/3/rows/0/video/en",
        "/demographics/questions/4/options/1/video/fr",
    ] {
        assert!(places.contains(&place), "{place} of {places:?}");
    }
    let value = parse(&study()).unwrap();
    let study = Study::from_value(&value).unwrap();
    assert_eq!(study.media().len(), 58, "what the server prepares");
}

#[test]
fn every_signed_video_is_loaded_before_its_page() {
    let mut page = Page::open(&study(), 1);
    let needs = |step: &Step| -> Vec<String> {
        let needs = step.needs("fr", None);
        needs.iter().filter_map(|need| Some(need.strip_prefix("media:")?.to_owned())).collect()
    };
    let questions = page.plan.steps.iter().find(|step| step.questions().len() == 7).unwrap();
    let mut wanted: Vec<String> =
        SIGNED.iter().chain(&["u", "v"]).map(|word| format!("{word}-lsf.mp4")).collect();
    let mut found = needs(questions);
    wanted.sort();
    found.sort();
    assert_eq!(found, wanted);
    let trial = page.plan.steps.iter().find(|step| step.trial().is_some()).unwrap();
    assert_eq!(needs(trial).len(), 4, "the prompt and three options: {:?}", needs(trial));
    page.finish();
    assert!(matches!(page.view(), View::End(_)));
}

fn videos(choices: &[ChoiceView]) -> Vec<&str> {
    choices.iter().filter_map(|choice| choice.video.as_deref()).collect()
}

fn asked<'a>(questions: &'a [QuestionView], id: &str) -> &'a QuestionView {
    questions.iter().find(|question| question.id == id).unwrap()
}

#[test]
fn the_page_gets_them_where_they_belong() {
    let mut page = Page::open(&study(), 1);
    page.send(Input::ChooseLanguage("fr".to_owned()));
    page.send(Input::Consent);
    let View::Questions { questions, .. } = page.view() else { panic!("{:?}", page.view()) };
    for (id, signs) in [
        ("scale", vec!["1-lsf.mp4", "2-lsf.mp4"]),
        ("line", vec!["no-lsf.mp4", "yes-lsf.mp4"]),
        ("affect", vec!["bad-lsf.mp4", "good-lsf.mp4", "calm-lsf.mp4", "wild-lsf.mp4"]),
        ("table", vec![]),
    ] {
        assert_eq!(videos(&asked(&questions, id).signs), signs, "{id}");
    }
    assert_eq!(asked(&questions, "scale").signs[1].label, "2 (fr)");
    let QuestionKindView::Matrix { rows, options } = &asked(&questions, "table").kind else {
        panic!("{questions:?}")
    };
    assert_eq!(videos(rows), ["row1-lsf.mp4", "row2-lsf.mp4"]);
    assert_eq!(videos(options), ["column1-lsf.mp4", "column2-lsf.mp4"]);

    while !matches!(page.view(), View::Trial(_)) {
        assert!(page.act(&mut first_answer));
    }
    let View::Trial(trial) = page.view() else { panic!("{:?}", page.view()) };
    let nearer = asked(&trial.questions, "nearer");
    let QuestionKindView::SingleChoice { options } = &nearer.kind else { panic!("{nearer:?}") };
    let shown: Vec<_> = options.iter().map(|each| (each.value.as_str(), &*each.label)).collect();
    assert_eq!(shown, [("left", "left (fr)"), ("same", "same (fr)"), ("right", "right (fr)")]);
    assert_eq!(videos(options), ["left-lsf.mp4", "same-lsf.mp4", "right-lsf.mp4"]);
    assert!(nearer.signs.is_empty(), "they are the options");
}

#[test]
fn an_attention_check_tells_the_option_as_the_study_words_it() {
    let mut file = parse(&study()).unwrap();
    let last = file["questions"].as_array().unwrap().len() - 1;
    let nearer = &mut file["questions"][last];
    nearer["attentionCheck"] = json!({ "expected": "left" });
    nearer["signs"][0]["label"] = json!({ "en": "The upper one", "fr": "Celle du haut" });
    nearer["prompt"] = json!({ "en": "Choose left.", "fr": "Choisissez celle du haut." });
    let report = check(&file.to_string(), &|_| Ok(()));
    let [issue] = &report.issues[..] else { panic!("{:?}", report.issues) };
    assert_eq!(issue.code(), "unfair-check");
    assert!(issue.message().contains("\"en\"") && issue.message().contains("The upper one"));
}
