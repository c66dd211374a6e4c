//! What was clicked is what is exported.

use std::collections::BTreeMap;

use mimique_session::flow::{Input, View};
use mimique_session::rows::{SessionRecord, Table, psych_ds_description, tidy, wide};
use mimique_session::wire::SessionStarted;
use mimique_study::ClipSource;
use mimique_study::{Study, parse};
use serde_json::{Value, json};

use crate::support::{Page, failed_checks, first_answer, status, study_text};

fn record(page: &Page) -> SessionRecord<'_> {
    SessionRecord { started: &page.plan.started, events: &page.stored }
}

fn sources(study: &Study) -> BTreeMap<String, ClipSource> {
    let source = |clip: mimique_study::Clip| {
        let method = study.stimuli.methods[&clip.method].spec.clone();
        let source = ClipSource {
            avatar: "a".into(),
            operators: "o".into(),
            take: "t".into(),
            method,
            duration_ms: 2_000.0,
            bytes: 1,
            provenance: format!("provenance of {}", clip.id),
            weights_hash: "w".into(),
            look: "stimulus".into(),
            video: None,
            sound: None,
            units: None,
        };
        (clip.id, source)
    };
    study.clips().into_iter().map(source).collect()
}

/// A participant whose answers follow a rule, and the answers given, by trial and question.
fn answered(participant: u64) -> (Page, BTreeMap<(String, String), Value>) {
    let mut page = Page::open(&study_text("demo.json"), participant);
    let mut given = BTreeMap::new();
    let mut count = 0_i64;
    loop {
        let step = page.plan.step(page.state.record.step).map(|step| step.id.clone());
        let mut choose = |id: &str, kind: &_| {
            count += 1;
            let value = match id {
                "age" => json!(33),
                "emotion" => json!(["anger", "disgust", "fear", "joy"][count as usize % 4]),
                "perceived_intensity" | "believability" | "familiarity" => json!(1 + count % 7),
                _ => first_answer(id, kind),
            };
            given.insert((step.clone().unwrap(), id.to_owned()), value.clone());
            value
        };
        if !page.act(&mut choose) {
            return (page, given);
        }
    }
}

#[test]
fn tidy_rows_are_the_answers_given_with_their_factors() {
    let (page, given) = answered(1);
    let study = &page.study;
    let table = tidy(study, &sources(study), [record(&page)]);
    assert_eq!(table.rows.len(), 2 + 12 * 3);
    assert_eq!(given.len(), table.rows.len());
    for row in 0..table.rows.len() {
        let text = |name: &str| table.cell(row, name).as_str().unwrap().to_owned();
        let answer = &given[&(text("trial_id"), text("response_id"))];
        assert_eq!(table.cell(row, "answer"), answer);
        assert_eq!(table.cell(row, "response"), answer);
        assert_eq!(table.cell(row, "participant_id"), "p0001");
        assert_eq!(table.cell(row, "status"), "completed");
        assert_eq!(table.cell(row, "age"), &json!(33), "demographics in every row");
        assert_eq!(table.cell(row, "config_hash"), page.plan.started.config_hash.as_str());
        if text("trial_type") == "demographics" {
            assert_eq!(table.cell(row, "method"), &Value::Null);
            continue;
        }
        let stimulus = text("stimulus");
        let (segment, method) = stimulus.split_once('.').unwrap();
        assert_eq!(table.cell(row, "method"), method);
        let alpha = if method == "box" { Value::Null } else { json!(0.3) };
        assert_eq!(table.cell(row, "alpha"), &alpha);
        assert_eq!(text("expression"), segment.trim_end_matches('2'));
        assert_eq!(table.cell(row, "intensity"), &json!(2));
        assert_eq!(text("provenance"), format!("provenance of {stimulus}"));
        assert_eq!(table.cell(row, "frames"), &json!(3));
        assert_eq!(table.cell(row, "frames_late"), &json!(1));
        assert_eq!(table.cell(row, "frame_longest_ms"), &json!(33.3));
        assert_eq!(table.cell(row, "viewport"), "1280x720");
        if text("response_id") == "emotion" {
            let truth = segment.trim_end_matches('2');
            assert_eq!(table.cell(row, "truth"), truth);
            assert_eq!(table.cell(row, "correct"), &json!(answer == truth));
        } else {
            assert_eq!(table.cell(row, "correct"), &Value::Null);
        }
    }
}

#[test]
fn the_provenance_is_that_of_the_clip_as_it_was_shown() {
    let mut page = Page::open(&study_text("demo.json"), 1);
    while page.act(&mut first_answer) {}
    // As the server's table of clips is after its stimuli have changed under the same study file.
    let served = sources(&page.study);
    let mut logged = 0;
    for event in &mut page.stored {
        if let Some(log) = event.body.get_mut("log").filter(|log| log.is_object()) {
            logged += 1;
            // The last trial is of an earlier version of the pages, which said nothing.
            if logged < 12 {
                log["provenance"] = json!("as shown");
                log["renderer"] = json!("drawn by");
            }
        }
    }
    assert_eq!(logged, 12);
    let table = tidy(&page.study, &served, [record(&page)]);
    for row in 0..table.rows.len() {
        let Some(order) = table.cell(row, "trial_order").as_u64() else { continue };
        let stimulus = table.cell(row, "stimulus").as_str().unwrap();
        let [provenance, renderer] =
            ["provenance", "renderer"].map(|name| table.cell(row, name).clone());
        if order < 12 {
            assert_eq!((provenance, renderer), (json!("as shown"), json!("drawn by")));
        } else {
            let served = json!(format!("provenance of {stimulus}"));
            assert_eq!((provenance, renderer), (served, Value::Null));
        }
    }
}

#[test]
fn response_times_run_from_the_first_frame_to_the_last_change_of_the_answer() {
    let mut page = Page::open(&study_text("demo.json"), 2);
    while page.played.is_empty() {
        page.act(&mut first_answer);
    }
    let onset = page.stored.last().unwrap().body["log"]["onset_ms"].as_f64().unwrap();
    page.send(Input::Answer { question: "emotion".into(), value: json!("joy") });
    page.now_ms += 1_000.0;
    page.send(Input::Answer { question: "emotion".into(), value: json!("fear") });
    let changed_at = page.stored.last().unwrap().at_ms;
    page.now_ms += 5_000.0;
    page.finish();
    let study = &page.study;
    let table = tidy(study, &BTreeMap::new(), [record(&page)]);
    let row = (0..table.rows.len())
        .find(|&row| {
            table.cell(row, "trial_order") == &json!(1)
                && table.cell(row, "response_id") == "emotion"
        })
        .unwrap();
    assert_eq!(table.cell(row, "answer"), "fear");
    assert_eq!(table.cell(row, "rt").as_f64().unwrap(), changed_at - onset);
    let duration = table.cell(row, "duration").as_f64().unwrap();
    assert!(duration > 6_000.0, "{duration}");
}

#[test]
fn trial_order_is_the_order_played() {
    let (page, _) = answered(3);
    let table = tidy(&page.study, &BTreeMap::new(), [record(&page)]);
    let mut played = vec![String::new(); 12];
    for row in 0..table.rows.len() {
        if let Some(order) = table.cell(row, "trial_order").as_u64() {
            played[order as usize - 1] = table.cell(row, "stimulus").as_str().unwrap().to_owned();
        }
    }
    assert_eq!(played, page.played);
}

#[test]
fn reloaded_trial_has_one_set_of_rows_and_says_what_was_seen_before() {
    let mut page = Page::open(&study_text("demo.json"), 4);
    while page.played.is_empty() {
        page.act(&mut first_answer);
    }
    page.send(Input::Answer { question: "emotion".into(), value: json!("joy") });
    page.reload();
    page.finish();
    let table = tidy(&page.study, &BTreeMap::new(), [record(&page)]);
    assert_eq!(table.rows.len(), 2 + 12 * 3);
    let rows = |column: &str, value: u64| -> Vec<usize> {
        (0..table.rows.len()).filter(|&row| table.cell(row, column) == &json!(value)).collect()
    };
    // The clip was seen whole before: the play after the reload is another one, and no interruption.
    let again = rows("replays", 1);
    assert_eq!(again.len(), 3, "the three answers of the first trial");
    assert!(rows("interruptions", 1).is_empty());
    // The answer before the reload is gone; its time must not stay.
    let rt = table.cell(again[0], "rt").as_f64().unwrap();
    assert!(rt > 0.0 && rt < 4_000.0, "{rt}");

    // A reload before the clip was seen whole is one.
    let mut page = Page::open(&study_text("demo.json"), 4);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    page.reload();
    page.finish();
    let table = tidy(&page.study, &BTreeMap::new(), [record(&page)]);
    let cell = |row: usize, column: &str| table.cell(row, column).clone();
    let interrupted: Vec<usize> =
        (0..table.rows.len()).filter(|&row| cell(row, "interruptions") == json!(1)).collect();
    assert_eq!(interrupted.len(), 3);
    assert!(interrupted.iter().all(|&row| cell(row, "replays") == json!(0)));
}

#[test]
fn status_follows_the_events() {
    let (page, _) = answered(5);
    assert_eq!(status(&page.stored), "completed");
    assert_eq!(status(&page.stored[..20]), "active");
    let table = tidy(
        &page.study,
        &BTreeMap::new(),
        [SessionRecord { events: &page.stored[..20], ..record(&page) }],
    );
    assert!(table.rows.iter().all(|row| row.len() == table.columns.len()));
    assert_eq!(table.cell(0, "status"), "active");
}

#[test]
fn wide_has_a_row_a_participant() {
    let people: Vec<(Page, _)> = (1..=3).map(answered).collect();
    let study = &people[0].0.study;
    let table = wide(study, &BTreeMap::new(), people.iter().map(|(page, _)| record(page)));
    assert_eq!(table.rows.len(), 3);
    for (row, (page, given)) in people.iter().enumerate() {
        assert_eq!(table.cell(row, "participant_id"), &json!(page.plan.started.participant_id));
        for ((trial, question), answer) in given {
            let name = match trial.as_str() {
                "demographics" => question.clone(),
                trial => format!("{trial}.{question}"),
            };
            assert_eq!(table.cell(row, &name), answer, "{name}");
        }
    }
}

#[test]
fn questions_of_many_cells_become_rows_of_their_own() {
    let study = Study::from_value(&parse(MANY_CELLS).unwrap()).unwrap();
    let started = SessionStarted {
        session: "s".into(),
        participant_id: "p1".into(),
        participant: 1,
        slot: 1,
        condition: None,
        seed: 0,
        stage: "pilot".into(),
        config_hash: "h".into(),
        withdrawal_code: "w".into(),
    };
    let body = json!({ "type": "page_finished", "step": "form", "answers": {
        "grid": { "valence": 2, "arousal": 7 },
        "rank": ["b", "a"],
        "table": { "x": "b" },
        "several": ["a", "b"],
    }});
    let event = mimique_session::wire::Event { sequence: 0, at_ms: 0.0, body };
    let record = SessionRecord { started: &started, events: &[event] };
    let table: Table = tidy(&study, &BTreeMap::new(), [record]);
    let answers: BTreeMap<String, Value> = (0..table.rows.len())
        .map(|row| {
            let id = table.cell(row, "response_id").as_str().unwrap().to_owned();
            (id, table.cell(row, "answer").clone())
        })
        .collect();
    let expected = [
        ("grid.arousal", json!(7)),
        ("grid.valence", json!(2)),
        ("rank.a", json!(2)),
        ("rank.b", json!(1)),
        ("several", json!("a|b")),
        ("table.x", json!("b")),
        ("table.y", Value::Null),
    ];
    assert_eq!(answers.into_iter().collect::<Vec<_>>(), expected.map(|(k, v)| (k.to_owned(), v)));
}

const MANY_CELLS: &str = r#"{
  id: "many", studyMetadata: { title: "t", version: "1" }, languages: ["en"],
  stimuli: { avatars: {}, captures: {}, segments: [], methods: {} },
  components: { form: { type: "questionnaire", questions: [
    { id: "grid", type: "valenceArousal", prompt: "p", leftLabel: "l", rightLabel: "r", bottomLabel: "b", topLabel: "t" },
    { id: "rank", type: "ranking", prompt: "p", options: [{ value: "a", label: "A" }, { value: "b", label: "B" }] },
    { id: "several", type: "multipleChoice", prompt: "p", options: [{ value: "a", label: "A" }, { value: "b", label: "B" }] },
    { id: "table", type: "matrix", prompt: "p", rows: [{ value: "x", label: "X" }, { value: "y", label: "Y" }],
      options: [{ value: "a", label: "A" }, { value: "b", label: "B" }] },
  ] } },
  sequence: { order: "fixed", components: ["form"] },
}"#;

#[test]
fn every_column_is_described() {
    let (page, _) = answered(6);
    let study = &page.study;
    let table = tidy(study, &BTreeMap::new(), [record(&page)]);
    let description = psych_ds_description(study, &table);
    let variables = description["variableMeasured"].as_array().unwrap();
    assert_eq!(variables.len(), table.columns.len());
    assert!(variables.iter().all(|variable| !variable["description"].as_str().unwrap().is_empty()));
    let mut names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), table.columns.len(), "no column twice");
}

/// On the closing page of a study two questions are opened by an answer of the first page: one that
/// may be left out, and an attention check. Rows as they were shown.
#[test]
fn a_question_opened_by_an_earlier_page_and_left_empty_has_a_row() {
    let mut file = parse(&study_text("demo.json")).unwrap();
    let yes_no = json!([{ "value": "yes", "label": "Yes" }, { "value": "no", "label": "No" }]);
    file["demographics"] = json!({ "questions": [
        { "id": "glasses", "type": "singleChoice", "prompt": "Glasses?", "options": yes_no } ] });
    let opened = json!({ "question": "glasses", "equals": "yes" });
    file["components"]["closing"] = json!({ "type": "questionnaire", "questions": [
        { "id": "which", "type": "shortText", "prompt": "Which?", "required": false, "showIf": opened },
        { "id": "awake", "type": "singleChoice", "prompt": "Choose yes.", "required": false,
          "options": yes_no, "showIf": opened, "attentionCheck": { "expected": "yes" } },
        { "id": "comment", "type": "longText", "prompt": "Else?", "required": false } ] });
    let sequence = file["sequence"].take();
    file["sequence"] = json!({ "order": "fixed", "components": [sequence, "closing"] });
    let rows_for = |glasses: &str| {
        let mut page = Page::open(&file.to_string(), 1);
        loop {
            let step = page.plan.step(page.state.record.step).map(|step| step.id.clone());
            if step.as_deref() == Some("closing") {
                page.send(Input::Next);
            } else if !page.act(&mut |id, kind| match id {
                "glasses" => json!(glasses),
                _ => first_answer(id, kind),
            }) {
                break;
            }
        }
        let study = Study::from_value(&file).unwrap();
        let table = tidy(&study, &sources(&study), [record(&page)]);
        let column = |name| table.columns.iter().position(|each| each.name == name).unwrap();
        let (trial, response) = (column("trial_id"), column("response_id"));
        let shown: Vec<String> = table
            .rows
            .iter()
            .filter(|row| row[trial] == "closing")
            .map(|row| row[response].as_str().unwrap().to_owned())
            .collect();
        (shown, failed_checks(&study, &page.stored))
    };
    let wanted = |ids: &[&str]| ids.iter().map(|id| (*id).to_owned()).collect::<Vec<_>>();
    assert_eq!(rows_for("yes"), (wanted(&["which", "awake", "comment"]), 1));
    assert_eq!(rows_for("no"), (wanted(&["comment"]), 0));
}
