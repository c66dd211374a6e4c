//! What is read from the text of a stored event is what is read from its JSON, and a record that is made of one
//! event after the other is that of all of them.

use mimique_session::rows::{SessionRecord, TidyForm, WideForm, tidy, wide};
use mimique_session::{EventKind, Record};
use mimique_study::Study;
use serde_json::{Value, json};

use crate::support::{Page, study_text};

const STUDIES: [&str; 4] = ["demo.json", "template.json", "study1.json", "study2b.json"];

#[test]
fn text_is_read_as_its_json_is() {
    let mut kinds = std::collections::BTreeSet::new();
    let mut bodies: Vec<Value> = Vec::new();
    for name in STUDIES {
        let mut page = Page::open(&study_text(name), 3);
        page.finish();
        bodies.extend(page.stored.into_iter().map(|event| event.body));
    }
    for body in &bodies {
        kinds.extend(body["type"].as_str().map(str::to_owned));
        let kind = EventKind::from_text(&body.to_string());
        assert!(kind.is_some(), "{body}");
        assert_eq!(kind, EventKind::from_body(body), "{body}");
    }
    assert!(kinds.contains("trial_played") && kinds.len() >= 8, "{kinds:?}");
    // What is damaged, or from elsewhere, is read the same way: not at all, mostly.
    let played = bodies.iter().find(|body| body["type"] == "trial_played").unwrap();
    let mut others = vec![
        json!({}),
        json!({"type": 1}),
        json!({"type": "unheard_of"}),
        json!({"type": "trial_played"}),
        json!({"type": "trial_played", "step": "a", "log": {}}),
        json!({"type": "trial_played", "step": "a", "log": {"frames": [[1, 2]]}}),
        json!({"type": "trial_played", "step": "a", "log": {"frames": [[1, 2, 3]], "new": 1}}),
        json!({"type": "finished", "and": "more"}),
        json!([1]),
        json!("finished"),
        Value::Null,
    ];
    for (key, value) in [("onset_ms", json!("soon")), ("late", json!(-1)), ("late", json!(1.5))] {
        let mut body = played.clone();
        body["log"][key] = value;
        others.push(body);
    }
    for body in &others {
        assert_eq!(EventKind::from_text(&body.to_string()), EventKind::from_body(body), "{body}");
    }
    assert_eq!(EventKind::from_text("{\"type\":\"finished\""), None);
}

#[test]
fn a_record_and_its_rows_are_made_one_session_at_a_time() {
    for name in STUDIES {
        let mut pages: Vec<Page> =
            (1..4).map(|number| Page::open(&study_text(name), number)).collect();
        pages.iter_mut().for_each(Page::finish);
        let file = mimique_study::parse(&study_text(name)).unwrap();
        let study = Study::from_value(&file).unwrap();
        let clips = Default::default();
        let form = TidyForm::new(&study, &clips);
        let mut wide_form = WideForm::new(&study, &clips);
        let (mut rows, mut records) = (Vec::new(), Vec::new());
        for page in &pages {
            let mut record = Record::default();
            for event in &page.stored {
                let kind = EventKind::from_text(&event.body.to_string());
                record.add(None, event.sequence, event.at_ms, kind);
            }
            assert_eq!(record, Record::of(None, &page.stored), "{name}");
            rows.extend(form.rows(&page.plan.started, &record));
            // The columns follow from what was answered: no play is asked for.
            let without_plays: Vec<_> = page
                .stored
                .iter()
                .filter(|event| event.body["type"] != "trial_played")
                .cloned()
                .collect();
            wide_form.look_at(&Record::of(None, &without_plays));
            records.push(record);
        }
        let sessions = || {
            pages
                .iter()
                .map(|page| SessionRecord { started: &page.plan.started, events: &page.stored })
        };
        let whole = tidy(&study, &clips, sessions());
        assert_eq!((form.columns(), &rows), (&whole.columns[..], &whole.rows), "{name}");
        assert!(rows.len() > 20, "{name}");
        let whole = wide(&study, &clips, sessions());
        let lines: Vec<_> = pages
            .iter()
            .zip(&records)
            .map(|(page, record)| wide_form.row(&page.plan.started, record).unwrap())
            .collect();
        assert_eq!((wide_form.columns(), lines), (whole.columns, whole.rows), "{name}");
        assert_eq!(wide_form.row(&pages[0].plan.started, &Record::default()), None);
    }
}
