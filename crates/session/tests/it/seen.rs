//! What a participant saw, made of the stored events: every page in order, its answers, the plays of its clips.

use mimique_session::flow::{BESIDE_CANVAS, KeptFrames, OWN_CANVAS, Plays, Seen, SeenPage, View};
use mimique_session::{EventKind, PlayLog};
use serde_json::Value;

use crate::support::{Page, first_answer, study_text};

fn seen(page: &Page, frames: KeptFrames) -> Vec<SeenPage> {
    let mut seen = Seen::new(&page.plan, frames);
    for event in &page.stored {
        seen.add(event.sequence, event.at_ms, EventKind::from_body(&event.body));
    }
    seen.pages()
}

fn step_of(view: &View) -> &str {
    match view {
        View::Consent { step, .. } | View::Questions { step, .. } | View::Page { step, .. } => step,
        View::Device(device) => &device.step,
        View::Trial(trial) => &trial.step,
        other => panic!("no page of the demo study: {other:?}"),
    }
}

fn steps_of(seen: &[SeenPage]) -> Vec<&str> {
    seen.iter().map(|page| step_of(&page.view)).collect()
}

#[test]
fn every_page_is_seen_in_order_with_what_was_answered() {
    let mut page = Page::open(&study_text("demo.json"), 1);
    page.finish();
    let seen = seen(&page, KeptFrames::None);
    // A gate without rules is passed before anybody sees it.
    let steps = page.plan.steps.iter().map(|step| &*step.id).filter(|id| *id != "device");
    let steps: Vec<&str> = steps.collect();
    assert_eq!(steps_of(&seen), steps);
    for own in &seen {
        let left_ms = own.left_ms.expect("every page was left");
        assert!(left_ms > own.shown_ms, "{own:?}");
        let questions = match &own.view {
            View::Questions { questions, .. } => questions,
            View::Trial(trial) => &trial.questions,
            _ => continue,
        };
        assert!(!questions.is_empty());
        for question in questions {
            assert!(question.value.is_some(), "{}", question.id);
            let answered = own.answered_ms[&question.id];
            assert!(own.shown_ms < answered && answered <= left_ms, "{}", question.id);
        }
    }
    // The clips are those that the stage was asked to play.
    let played: Vec<&str> = seen
        .iter()
        .flat_map(|own| &own.plays)
        .map(|play| {
            let [clip] = &play.clips[..] else { panic!("{play:?}") };
            assert_eq!((&*clip.canvas, play.in_turn, play.frames), (OWN_CANVAS, false, 3));
            assert!(play.log.frames.is_empty(), "frames are kept of the page asked for");
            &*clip.clip
        })
        .collect();
    assert_eq!(played, page.played);
}

#[test]
fn frames_are_kept_of_the_pages_that_are_asked_for() {
    let mut page = Page::open(&study_text("demo.json"), 1);
    page.finish();
    let place =
        seen(&page, KeptFrames::None).iter().rposition(|own| !own.plays.is_empty()).unwrap();
    for (at, own) in seen(&page, KeptFrames::OfPage(place)).iter().enumerate() {
        for play in &own.plays {
            let kept = if at == place { 3 } else { 0 };
            assert_eq!((play.log.frames.len(), play.frames), (kept, 3), "{at}");
        }
    }
    let all = seen(&page, KeptFrames::All);
    let plays: Vec<_> = all.iter().flat_map(|own| &own.plays).collect();
    assert_eq!(plays.len(), page.played.len());
    assert!(plays.iter().all(|play| play.log.frames.len() == 3));
    // As they are drawn again: each with its clip and its frames.
    for own in all.iter().filter(|own| !own.plays.is_empty()) {
        let drawn = serde_json::to_value(Plays::of(&page.plan, own)).unwrap();
        assert_eq!(drawn["plays"][0]["clips"][0]["clip"], own.plays[0].clips[0].clip.as_str());
        assert_eq!(drawn["plays"][0]["frames"].as_array().unwrap().len(), 3);
        assert!(own.step.starts_with("faces/"), "{}", own.step);
    }
}

#[test]
fn a_play_cut_short_is_seen_too_and_the_last_page_of_a_session_under_way_is_not_left() {
    let mut page = Page::open(&study_text("demo.json"), 2);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    // The first play is asked for, and the page is hidden meanwhile.
    page.act(&mut first_answer);
    let cut = page.stored.iter_mut().rfind(|event| event.body["type"] == "trial_played").unwrap();
    cut.body["log"]["aborted"] = Value::from("page hidden");
    page.reload();
    page.act(&mut first_answer);
    let seen = seen(&page, KeptFrames::None);
    let [before @ .., last] = &seen[..] else { panic!() };
    assert!(before.iter().all(|own| own.left_ms.is_some()));
    assert_eq!(last.left_ms, None);
    let whole: Vec<bool> = last.plays.iter().map(|play| PlayLog::is_whole(&play.log)).collect();
    assert_eq!(whole, [false, true]);
    assert_eq!(before.iter().map(|own| own.plays.len()).sum::<usize>(), 0);
}

#[test]
fn both_clips_of_a_pair_are_seen_on_their_canvases() {
    let mut page = Page::open(&study_text("study2b.json"), 3);
    page.finish();
    let seen = seen(&page, KeptFrames::None);
    let plays: Vec<_> = seen.iter().flat_map(|own| &own.plays).collect();
    assert!(plays.len() >= 36, "{}", plays.len());
    for play in plays {
        let [own, beside] = &play.clips[..] else { panic!("{play:?}") };
        assert_eq!([&*own.canvas, &*beside.canvas], [OWN_CANVAS, BESIDE_CANVAS]);
        assert!(own.clip != beside.clip && !play.in_turn, "{play:?}");
    }
}

#[test]
fn who_declines_has_seen_the_agreement_alone() {
    let mut page = Page::open(&study_text("demo.json"), 4);
    page.send(mimique_session::flow::Input::Decline);
    let seen = seen(&page, KeptFrames::None);
    assert_eq!(steps_of(&seen), ["consent"]);
    assert!(seen[0].left_ms.is_some());
}
