//! A panel: everything is seen before anything is rated, each clip alone as often as replays are left; a row for each
//! clip in both exports.

use std::collections::BTreeMap;

use mimique_session::flow::{Effect, Input, Phase, TrialView, View, update};
use mimique_session::rows::{SessionRecord, Table, tidy, wide};
use mimique_study::Study;
use serde_json::{Value, json};

use crate::support::{Page, first_answer, study_text, whole_play};

fn text() -> String {
    let mut study = mimique_study::parse(&study_text("panel.json")).unwrap();
    study["components"]["quality"]["maximumReplays"] = json!(1);
    study.to_string()
}

fn trial(page: &Page) -> TrialView {
    match page.view() {
        View::Trial(trial) => *trial,
        other => panic!("{other:?}"),
    }
}

fn at_first_page() -> Page {
    let mut page = Page::open(&text(), 3);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    page
}

#[test]
fn the_reference_stands_open_and_hidden_and_all_are_played_at_once() {
    let page = at_first_page();
    let view = trial(&page);
    let panel = view.panel.as_ref().unwrap();
    let captions: Vec<&str> = panel.figures.iter().map(|it| it.caption.as_str()).collect();
    assert_eq!(captions, ["Reference", "A", "B", "C", "D", "E"]);
    let open = &panel.figures[0].clip;
    assert!(open.ends_with(".recorded"), "{open}");
    assert_eq!(panel.figures.iter().filter(|it| it.clip == *open).count(), 2);
    assert!(panel.figures.iter().all(|it| !it.can_play), "none alone before all were seen");
    let (_, effects) = update(&page.plan, page.state.clone(), Input::Play, page.now_ms);
    let Some(Effect::PlayClips { clips, in_turn: false }) =
        effects.iter().find(|effect| matches!(effect, Effect::PlayClips { .. }))
    else {
        panic!("{effects:?}")
    };
    assert_eq!(clips, &view.placed());
    let canvases: std::collections::BTreeSet<&str> =
        clips.iter().map(|placed| placed.canvas.as_str()).collect();
    assert_eq!(canvases.len(), 6, "each on a canvas of its own");
}

#[test]
fn ratings_wait_for_the_whole_play_and_replays_are_counted_clip_by_clip() {
    let mut page = at_first_page();
    let rate = |page: &mut Page, at: usize, value: i64| {
        let question = trial(page).questions[at].id.clone();
        page.send(Input::Answer { question, value: json!(value) });
    };
    rate(&mut page, 0, 50);
    assert!(trial(&page).questions.iter().all(|it| it.value.is_none()), "too soon");
    page.send(Input::PlayAlone(1));
    assert_eq!(trial(&page).phase, Phase::Ready, "not alone before all were seen");
    page.send(Input::Play);
    for at in 0..5 {
        rate(&mut page, at, 10 * at as i64);
    }
    let view = trial(&page);
    assert!(view.button.can_submit);
    assert_eq!(view.questions.iter().map(|it| it.prompt.as_str()).collect::<String>(), "ABCDE");
    page.send(Input::PlayAlone(2));
    let attempt = &page.state.record.attempt;
    assert_eq!((attempt.plays, attempt.alone.get(&2)), (1, Some(&1)));
    let can_play: Vec<bool> =
        trial(&page).panel.unwrap().figures.iter().map(|it| it.can_play).collect();
    assert_eq!(can_play, [true, true, false, true, true, true], "one replay each");
    page.send(Input::PlayAlone(2));
    assert_eq!(page.state.record.attempt.alone[&2], 1);
    page.send(Input::PlayAlone(9));
    assert_eq!(page.state.record.attempt.alone.len(), 1, "there is no ninth place");
    page.send(Input::Next);
    assert_eq!(page.state.record.finished.last().unwrap().attempt.panel.len(), 5);
}

fn column(table: &Table, name: &str) -> usize {
    table.columns.iter().position(|column| column.name == name).unwrap_or_else(|| panic!("{name}"))
}

#[test]
fn both_exports_have_each_rating_with_its_clip() {
    let mut page = Page::open(&text(), 7);
    let mut given: BTreeMap<String, Value> = BTreeMap::new();
    let mut next = 0;
    while page.act(&mut |id, kind| {
        if !id.starts_with("faithful/") {
            return first_answer(id, kind);
        }
        next += 1;
        given.insert(id.to_owned(), json!(next));
        json!(next)
    }) {}
    assert_eq!(given.len(), 30);
    let study = Study::from_value(&mimique_study::parse(&text()).unwrap()).unwrap();
    let record = SessionRecord { started: &page.plan.started, events: &page.stored };
    let table = tidy(&study, &BTreeMap::new(), [record]);
    let rated: Vec<&Vec<Value>> =
        table.rows.iter().filter(|row| row[column(&table, "response_id")] == "faithful").collect();
    assert_eq!(rated.len(), 30);
    for row in &rated {
        let clip = row[column(&table, "stimulus")].as_str().unwrap();
        assert_eq!(row[column(&table, "answer")], given[&format!("faithful/{clip}")]);
        assert_eq!(row[column(&table, "panel_condition")], clip.split_once('.').unwrap().1);
        assert!(row[column(&table, "rt")].as_f64().unwrap() > 0.0);
        let expression = row[column(&table, "expression")].as_str().unwrap();
        assert!(clip.starts_with(expression), "{clip}: {expression}");
    }
    let wide = wide(&study, &BTreeMap::new(), [record]);
    for (id, value) in &given {
        let clip = id.split_once('/').unwrap().1;
        let segment = clip.split_once('.').unwrap().0;
        let name = format!("quality/{segment}|head.{id}");
        assert_eq!(wide.rows[0][column(&wide, &name)], *value, "{name}");
    }
}

#[test]
fn a_play_of_one_clip_alone_that_is_cut_short_counts_for_nothing() {
    let mut page = at_first_page();
    page.send(Input::Play);
    let (state, _) = update(&page.plan, page.state.clone(), Input::PlayAlone(1), page.now_ms);
    let mut log = whole_play(page.now_ms);
    log.aborted = Some("page hidden".to_owned());
    let (state, _) = update(&page.plan, state, Input::Played(log), page.now_ms + 100.0);
    let attempt = &state.record.attempt;
    assert_eq!((attempt.plays, attempt.alone.len(), attempt.interruptions), (1, 0, 1));
    drop(std::mem::replace(&mut page.state, state));
    assert!(trial(&page).panel.unwrap().figures[1].can_play);
}
