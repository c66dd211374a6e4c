//! The flow, through the whole demo study.

use mimique_session::flow::{Effect, Input, Phase, Plan, State, View, update};
use mimique_session::{Record, Standing};
use serde_json::json;

use crate::support::{self, Page, client, failure, first_answer, started, study_text, whole_play};

#[test]
fn demo_goes_from_consent_to_the_completion_code() {
    let mut page = Page::open(&study_text("demo.json"), 1);
    assert!(matches!(page.view(), View::Consent { .. }));
    page.finish();
    let View::End(end) = page.view() else { panic!("{:?}", page.view()) };
    assert_eq!(end.completion_code.unwrap().code, "MIMIQUE-DEMO");
    assert_eq!(page.played.len(), 12);
    let mut clips = page.played.clone();
    clips.sort();
    clips.dedup();
    assert_eq!(clips.len(), 12, "each clip once");
    assert_eq!(page.completed, Some(page.stored.len() as u64));
    assert_eq!(page.state.record.unexpected, 0);
}

#[test]
fn replay_of_any_beginning_is_the_state_that_was() {
    let mut page = Page::open(&study_text("demo.json"), 2);
    let mut checked = 0;
    loop {
        let replayed = State::replay(&page.plan, &page.stored);
        assert_eq!(replayed.record, page.state.record, "after {} events", page.stored.len());
        checked += 1;
        if !page.act(&mut first_answer) {
            break;
        }
    }
    assert!(checked > 60, "{checked} states compared");
}

#[test]
fn reload_at_every_point_ends_with_the_same_answers() {
    let answers_of = |page: &Page| {
        let finished = page.stored.iter().filter(|event| {
            event.body["type"] == "trial_finished" || event.body["type"] == "page_finished"
        });
        finished.map(|event| event.body["answers"].clone()).collect::<Vec<_>>()
    };
    let text = study_text("demo.json");
    let mut undisturbed = Page::open(&text, 3);
    undisturbed.finish();
    let mut reloaded = Page::open(&text, 3);
    let mut acts: usize = 0;
    loop {
        // Every point, but not for ever: a trial that starts anew needs five acts to end.
        if acts % 7 == 3 {
            reloaded.reload();
        }
        acts += 1;
        if !reloaded.act(&mut first_answer) {
            break;
        }
    }
    assert!(matches!(reloaded.view(), View::End(_)));
    assert!(reloaded.state.record.resumptions > 8);
    assert_eq!(answers_of(&reloaded), answers_of(&undisturbed));
}

#[test]
fn reload_in_a_trial_starts_its_clip_anew() {
    let mut page = Page::open(&study_text("demo.json"), 4);
    while !matches!(page.view(), View::Trial(trial) if trial.phase == Phase::Answering) {
        page.act(&mut first_answer);
    }
    page.send(Input::Answer { question: "emotion".into(), value: json!("joy") });
    let View::Trial(before) = page.view() else { panic!() };
    page.reload();
    let View::Trial(after) = page.view() else { panic!() };
    assert_eq!(after.step, before.step);
    assert_eq!(after.phase, Phase::Ready);
    assert!(after.questions.iter().all(|question| question.value.is_none()));
    assert_eq!(page.state.record.resumptions, 1);
}

#[test]
fn reload_on_a_page_of_questions_keeps_what_was_written() {
    let mut page = Page::open(&study_text("demo.json"), 4);
    page.send(Input::Consent);
    page.send(Input::Answer { question: "age".into(), value: json!(41) });
    page.reload();
    let View::Questions { questions, button, .. } = page.view() else { panic!() };
    assert_eq!(questions[0].value, Some(json!(41)));
    assert_eq!(questions[1].value, None, "nothing is pre-selected");
    assert!(!button.can_submit);
}

#[test]
fn lost_last_event_of_a_session_is_made_up_after_a_reload() {
    let mut page = Page::open(&study_text("demo.json"), 5);
    page.finish();
    // The page died between the last page's event and the one that says `finished`.
    let finished = page.stored.iter().rposition(|event| event.body["type"] == "finished").unwrap();
    page.stored.truncate(finished);
    page.completed = None;
    page.reload();
    assert!(matches!(page.view(), View::End(_)), "{:?}", page.view());
    assert_eq!(page.completed, Some(page.stored.len() as u64));
}

#[test]
fn no_answer_counts_before_one_whole_play() {
    let mut page = Page::open(&study_text("demo.json"), 6);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    let answer = || Input::Answer { question: "emotion".into(), value: json!("joy") };
    page.send(answer());
    let View::Trial(trial) = page.view() else { panic!() };
    assert!(!trial.can_answer && trial.questions[0].value.is_none());
    assert_eq!(page.state.record.unexpected, 1, "recorded and ignored");
    assert_eq!(page.stored.last().unwrap().body["type"], "unexpected");

    // A play cut short does not count either.
    let (state, effects) = update(&page.plan, page.state.clone(), Input::Play, page.now_ms);
    assert!(effects.iter().any(|effect| matches!(effect, Effect::PlayClips { .. })));
    let mut log = whole_play(page.now_ms);
    log.aborted = Some("hidden".into());
    let (state, _) = update(&page.plan, state, Input::Played(log), page.now_ms + 900.0);
    page.state = state;
    let View::Trial(trial) = page.view() else { panic!() };
    assert_eq!(trial.phase, Phase::Ready);
    assert!(!trial.can_answer);
    assert!(trial.message.contains("interrupted"));
}

#[test]
fn sending_too_early_points_out_what_is_missing() {
    let mut page = Page::open(&study_text("demo.json"), 6);
    page.send(Input::Consent);
    page.send(Input::Answer { question: "age".into(), value: json!(7) });
    page.send(Input::Next);
    let View::Questions { questions, .. } = page.view() else { panic!() };
    assert_eq!(questions[0].problem.as_deref(), Some("The lowest number is 18."));
    assert_eq!(questions[1].problem.as_deref(), Some("Please answer this question."));
    assert_eq!(page.state.record.unexpected, 0);
}

#[test]
fn late_and_doubled_reports_change_nothing() {
    let mut page = Page::open(&study_text("demo.json"), 7);
    while page.played.len() < 2 {
        page.act(&mut first_answer);
    }
    let before = page.view();
    let unexpected = page.state.record.unexpected;
    page.send(Input::Played(whole_play(page.now_ms)));
    page.send(Input::Consent);
    page.send(Input::Opened(client()));
    page.send(Input::Retry);
    page.send(Input::Shown { step: "demographics".into() });
    page.send(Input::Acknowledged { stored: 1 });
    assert_eq!(page.view(), before);
    assert_eq!(page.state.record.unexpected, unexpected + 5);
    page.finish();
    assert!(matches!(page.view(), View::End(_)));
}

#[test]
fn the_code_comes_only_after_everything_is_acknowledged() {
    let (study, session) = started(&study_text("demo.json"), 8);
    let plan = Plan::new(study.projection(), session).unwrap();
    let mut page = Page::open(&study_text("demo.json"), 8);
    page.finish();
    // The same session at its end, with nothing acknowledged.
    let state = State::replay(&plan, &page.stored);
    assert_eq!(state.record.standing, Standing::Completed);
    let total = page.stored.len() as u64;
    let shown = mimique_session::flow::view(&plan, &state);
    assert!(matches!(shown, View::ReceiptPending { stored: 0, .. }), "{shown:?}");
    let (state, effects) =
        update(&plan, state, Input::Acknowledged { stored: total - 1 }, page.now_ms);
    assert_eq!(effects, vec![]);
    let (state, effects) = update(&plan, state, Input::Acknowledged { stored: total }, page.now_ms);
    assert_eq!(effects, vec![Effect::Complete { events: total }]);
    let (_, effects) = update(&plan, state, Input::Acknowledged { stored: total }, page.now_ms);
    assert_eq!(effects, vec![], "asked once");
}

#[test]
fn next_trial_waits_a_moment_for_the_answers_before_it() {
    let mut page = Page::open(&study_text("demo.json"), 9);
    while page.state.record.step < page.plan.steps.len() - 3 {
        page.act(&mut first_answer);
    }
    let mut state = page.state.clone();
    state.live.stored = state.record.checkpoint - 1;
    state.live.now_ms = state.record.entered_ms + 100.0;
    let View::Trial(trial) = mimique_session::flow::view(&page.plan, &state) else { panic!() };
    assert!(!trial.can_play);
    assert_eq!(trial.phase, Phase::Loading { fraction: 1.0 });
    // No network must not stop anybody.
    let later = state.record.entered_ms + 3_500.0;
    let (state, _) = update(&page.plan, state, Input::Tick, later);
    let View::Trial(trial) = mimique_session::flow::view(&page.plan, &state) else { panic!() };
    assert!(trial.can_play);
}

#[test]
fn declining_and_withdrawing_end_the_session() {
    let text = study_text("demo.json");
    let mut page = Page::open(&text, 10);
    page.send(Input::Decline);
    assert!(matches!(page.view(), View::Declined { .. }));
    let stored = page.stored.len();
    page.send(Input::Consent);
    page.send(Input::FocusLost);
    assert_eq!(page.stored.len(), stored, "nothing more is recorded");

    let mut page = Page::open(&text, 11);
    page.send(Input::Consent);
    page.send(Input::Withdraw);
    assert!(matches!(page.view(), View::Withdrawn { confirmed: true, .. }));
    assert_eq!(page.stored.last().unwrap().body["type"], "withdrawn");
}

#[test]
fn who_withdraws_while_the_last_answers_are_sent_stays_withdrawn_after_a_reload() {
    let mut page = Page::open(&study_text("demo.json"), 11);
    page.finish();
    // The same session, of which the server has acknowledged nothing.
    let state = State::replay(&page.plan, &page.stored);
    let shown = mimique_session::flow::view(&page.plan, &state);
    assert!(matches!(shown, View::ReceiptPending { .. }), "{shown:?}");
    let (_, effects) = update(&page.plan, state, Input::Withdraw, page.now_ms);
    assert!(effects.contains(&Effect::Withdraw));
    let made = effects.into_iter().filter_map(|effect| match effect {
        Effect::Store(event) => Some(event),
        _ => None,
    });
    page.stored.extend(made);

    let state = State::replay(&page.plan, &page.stored);
    let (state, effects) = update(&page.plan, state, Input::Resumed(client()), page.now_ms);
    assert_eq!(effects, vec![Effect::Flush, Effect::Withdraw]);
    // And the server's word that everything has arrived completes nothing.
    let stored = page.stored.len() as u64;
    let (state, effects) = update(&page.plan, state, Input::Acknowledged { stored }, page.now_ms);
    assert_eq!(effects, vec![]);
    let shown = mimique_session::flow::view(&page.plan, &state);
    assert!(matches!(shown, View::Withdrawn { confirmed: false, .. }), "{shown:?}");
}

#[test]
fn focus_is_logged_once_a_change() {
    let mut page = Page::open(&study_text("demo.json"), 12);
    let stored = page.stored.len();
    for input in [Input::FocusGained, Input::FocusLost, Input::FocusLost, Input::FocusGained] {
        page.send(input);
    }
    let kinds: Vec<_> =
        page.stored[stored..].iter().map(|event| event.body["type"].clone()).collect();
    assert_eq!(kinds, [json!("focus_lost"), json!("focus_gained")]);
}

#[test]
fn a_failed_clip_can_be_tried_again() {
    let mut page = Page::open(&study_text("demo.json"), 13);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    let View::Trial(trial) = page.view() else { panic!() };
    page.send(Input::ClipFailed { clip: trial.clip.clone(), failure: failure("connection") });
    let View::Trial(failed) = page.view() else { panic!() };
    assert!(matches!(failed.phase, Phase::Failed { .. }) && !failed.can_play);
    page.send(Input::Retry);
    page.finish();
    assert!(matches!(page.view(), View::End(_)));
}

#[test]
fn why_a_clip_failed_is_said_in_the_participants_language_and_goes_on_by_itself_when_the_line_is_back()
 {
    let mut page = Page::open(&study_text("demo.json"), 13);
    page.send(Input::ChooseLanguage("fr".into()));
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    let View::Trial(trial) = page.view() else { panic!() };
    let shown = |page: &Page| match page.view() {
        View::Trial(trial) => match trial.phase {
            Phase::Failed { reason, .. } => reason,
            other => format!("{other:?}"),
        },
        other => format!("{other:?}"),
    };
    let codes = [
        ("connection", "La connexion"),
        ("stalled", "Rien n’est arrivé pendant 15 s."),
        ("damaged", "Il est arrivé endommagé."),
        ("graphics_lost", "L’affichage graphique"),
        ("a code of a later version", "Une erreur inattendue"),
    ];
    for (code, words) in codes {
        page.send(Input::ClipFailed { clip: trial.clip.clone(), failure: failure(code) });
        assert!(shown(&page).starts_with(words), "{code}: {}", shown(&page));
        assert!(!shown(&page).contains("pack"), "{code}: {}", shown(&page));
    }
    assert_eq!(page.stored.last().unwrap().body["code"], "a code of a later version");
    page.send(Input::Online);
    let View::Trial(trial) = page.view() else { panic!() };
    assert!(trial.can_play, "{:?}", trial.phase);
}

#[test]
fn the_last_page_says_what_to_do_now_and_goes_back_by_itself_only_where_the_study_says_so() {
    let mut text = mimique_study::parse(&study_text("demo.json")).unwrap();
    let end = |page: &Page| match page.view() {
        View::End(end) => *end,
        other => panic!("{other:?}"),
    };
    let with_way_back = |page: &mut Page| {
        let mut receipt = support::receipt(page.stored.len() as u64);
        receipt.redirect = Some("https://recruit.example/done".to_owned());
        page.send(Input::ReceiptArrived(receipt));
    };
    let mut page = Page::open(&text.to_string(), 3);
    page.finish();
    let shown = end(&page);
    assert!(shown.text.iter().all(|text| !text.contains("close this page")), "{:?}", shown.text);
    assert_eq!(shown.records.participant.1, "p0003");
    page.send(Input::Copied);
    assert_eq!(end(&page).completion_code.unwrap().copied.as_deref(), Some("Copied"));
    with_way_back(&mut page);
    assert_eq!(end(&page).returning, None);

    text["recruitment"]["returnAfterSeconds"] = json!(30);
    text["recruitment"]["redirect"] = json!("https://recruit.example/done");
    let mut page = Page::open(&text.to_string(), 3);
    page.finish();
    with_way_back(&mut page);
    assert_eq!(end(&page).returning.unwrap().0, "You go back by itself in 30 s.");
    let tick = |page: &mut Page, seconds: f64| {
        let (state, effects) =
            update(&page.plan, page.state.clone(), Input::Tick, page.now_ms + seconds * 1000.0);
        page.state = state;
        effects
    };
    assert_eq!(tick(&mut page, 29.0), []);
    let mut stays = Page { state: page.state.clone(), ..Page::open(&text.to_string(), 3) };
    assert_eq!(tick(&mut page, 31.0), [Effect::GoBack("https://recruit.example/done".to_owned())]);
    assert_eq!(tick(&mut page, 40.0), [], "once");
    stays.now_ms = page.now_ms;
    stays.send(Input::Stay);
    assert_eq!(tick(&mut stays, 60.0), []);
}

#[test]
fn every_code_that_the_stage_gives_has_its_words() {
    let folder = mimique_test_support::repository().join("static");
    let scripts =
        ["stage", "participant"].map(|name| std::fs::read_dir(folder.join(name)).unwrap());
    let mut codes = Vec::new();
    for file in scripts.into_iter().flatten() {
        let text = std::fs::read_to_string(file.unwrap().path()).unwrap();
        for made in ["new StageFailure(", "failureOf(", "discard(started, ", "discard(asked, "] {
            let quoted = text.split(made).skip(1).filter_map(|rest| rest.split('"').nth(1));
            codes.extend(
                quoted
                    .filter(|code| {
                        !code.is_empty() && code.chars().all(|c| c.is_ascii_lowercase() || c == '_')
                    })
                    .map(str::to_owned),
            );
        }
    }
    assert!(codes.len() >= 12, "{codes:?}");
    for code in codes {
        let name = format!("failed_{code}");
        assert!(mimique_study::text::names().any(|known| known == name), "{name}");
    }
}

/// A page of questions and a trial, each with a picture.
const WITH_PICTURES: &str = "{ id: 's', studyMetadata: { title: 'Faces', version: '1' },
  languages: ['en'], seed: 5,
  demographics: { questions: [{ id: 'who', type: 'singleChoice', prompt: 'Who?',
    options: [{ value: 'a', label: 'A', image: 'who.png' }, { value: 'b', label: 'B' }] }] },
  questions: [{ id: 'r', type: 'singleChoice', prompt: 'Which?', video: { en: 'sign.webm' },
    options: [{ value: 'a', label: 'A', image: 'eye.png' }, { value: 'b', label: 'B', image: 'eye.png' }] }],
  components: { faces: { type: 'trials', questions: ['r'] } },
  sequence: { order: 'fixed', components: ['faces'] },
  stimuli: { avatars: { h: { builtin: {} } }, captures: { c: { file: 'x' } },
    segments: [{ id: 'p', capture: 'c', first: 0, end: 9 }],
    methods: { box: { method: 'box' } } } }";

#[test]
fn pictures_are_loaded_before_their_page_and_no_trial_starts_without_them() {
    let (study, session) = started(WITH_PICTURES, 1);
    let plan = Plan::new(study.projection(), session).unwrap();
    let shown = |state: &State| mimique_session::flow::view(&plan, state);
    let turn = |state: State, input: Input| update(&plan, state, input, 1e12);
    let prepared = |state, name: &str| turn(state, Input::ClipPrepared { clip: name.into() }).0;
    let failed = |state, name: &str| {
        turn(state, Input::ClipFailed { clip: name.into(), failure: failure("missing") }).0
    };
    let all = ["media:who.png", "p.box", "media:sign.webm", "media:eye.png"].map(str::to_owned);
    let (state, effects) = turn(State::new(&plan, "en"), Input::Opened(client()));
    assert!(effects.contains(&Effect::PrepareClips(all.to_vec())), "{effects:?}");

    let (state, _) = turn(state, Input::Measured(support::display()));

    // A page of questions stands there at once; it says what could not be had, and tries again.
    let View::Questions { failed: None, .. } = shown(&state) else { panic!() };
    let state = failed(state, "media:who.png");
    let View::Questions { failed: Some(trouble), .. } = shown(&state) else { panic!() };
    let words = "The server does not have it. Please write to the investigator.";
    assert_eq!((trouble.reason.as_str(), trouble.retry.as_str()), (words, "Try again"));
    let (state, effects) = turn(state, Input::Retry);
    assert_eq!(effects, vec![Effect::PrepareClips(all.to_vec())]);
    let View::Questions { failed: None, .. } = shown(&state) else { panic!() };
    // What failed ahead of its page is asked for again there, and shown as on its way.
    let state = failed(state, "media:eye.png");
    let answer = Input::Answer { question: "who".into(), value: json!("a") };
    let (state, effects) = turn(turn(state, answer).0, Input::Next);
    assert!(effects.contains(&Effect::PrepareClips(all[1..].to_vec())), "{effects:?}");

    // The trial waits for everything.
    let state = prepared(prepared(state, "p.box"), "media:sign.webm");
    let View::Trial(trial) = shown(&state) else { panic!() };
    assert_eq!((trial.phase, trial.can_play), (Phase::Loading { fraction: 2.0 / 3.0 }, false));
    let state = failed(state, "media:eye.png");
    let View::Trial(trial) = shown(&state) else { panic!() };
    assert!(matches!(trial.phase, Phase::Failed { .. }) && !trial.can_play);
    assert_eq!(trial.message, "A picture or a video of this page could not be shown.");
    let (state, effects) = turn(state, Input::Retry);
    assert_eq!(effects, vec![Effect::PrepareClips(all[1..].to_vec())]);
    let state = prepared(state, "media:eye.png");
    let (state, _) = turn(state, Input::Acknowledged { stored: 99 });
    let View::Trial(trial) = shown(&state) else { panic!() };
    assert_eq!((trial.phase, trial.can_play), (Phase::Ready, true));
}

#[test]
fn pages_come_in_the_language_chosen() {
    let mut page = Page::open(&study_text("demo.json"), 14);
    page.send(Input::ChooseLanguage("fr".into()));
    let View::Consent { agree, agreement, .. } = page.view() else { panic!() };
    assert_eq!(agree, "J’accepte de participer");
    assert_eq!(agreement.title, "Que lisez-vous sur ce visage\u{a0}?");
    page.reload();
    let View::Consent { agree, .. } = page.view() else { panic!() };
    assert_eq!(agree, "J’accepte de participer", "kept after a reload");
    page.send(Input::ChooseLanguage("xx".into()));
    assert_eq!(page.state.record.language, "fr");
}

#[test]
fn a_study_brings_buttons_and_messages_in_its_own_languages() {
    let mut value = mimique_study::parse(&study_text("demo.json")).unwrap();
    value["languages"] = json!(["en", "fr", "de"]);
    value["translations"] = json!({
        "de": { "language_name": "Deutsch", "agree": "Ich nehme teil", "trial_of": "Clip {number} von {of}" },
        "fr": { "decline": "Non merci" },
    });
    let mut page = Page::open(&value.to_string(), 14);
    page.send(Input::ChooseLanguage("de".into()));
    let View::Consent { agree, decline, languages, .. } = page.view() else { panic!() };
    assert_eq!(agree, "Ich nehme teil");
    assert_eq!(decline, "I do not want to take part", "what is not translated is in English");
    assert_eq!(languages[2], ("de".to_owned(), "Deutsch".to_owned()));
    assert_eq!(page.plan.words("de").trial_of(3, 12), "Clip 3 von 12");
    page.send(Input::ChooseLanguage("fr".into()));
    let View::Consent { agree, decline, .. } = page.view() else { panic!() };
    assert_eq!(agree, "J’accepte de participer");
    assert_eq!(decline, "Non merci", "a single text is changed");
}

#[test]
fn unknown_events_of_another_version_are_counted_and_skipped() {
    let mut page = Page::open(&study_text("demo.json"), 15);
    page.send(Input::Consent);
    let sequence = page.stored.len() as u64;
    let body = json!({ "type": "from_the_future", "what": 1 });
    page.stored.push(mimique_session::wire::Event { sequence, at_ms: page.now_ms, body });
    let state = State::replay(&page.plan, &page.stored);
    assert_eq!(state.record.events, sequence + 1);
    assert_eq!(state.record.unexpected, 1);
    assert_eq!(state.record.step, 2);
}

/// Where a study asks nothing of devices, they are looked at all the same before the first question: whoever
/// cannot see the clips is told so there, in the participant's language.
#[test]
fn without_rules_a_device_that_cannot_draw_is_turned_away_at_the_gate() {
    let mut page = Page::open(&study_text("demo.json"), 4);
    assert!(page.study.device.is_none(), "the demo asks nothing of devices");
    page.display.backend = None;
    page.send(Input::ChooseLanguage("fr".into()));
    page.send(Input::Consent);
    let View::Device(gate) = page.view() else { panic!("{:?}", page.view()) };
    assert_eq!(gate.problems[0].0, "Ce navigateur ne peut pas dessiner les animations.");
    assert!(page.plan.is_before_session(page.state.record.step), "no place is held yet");
    page.send(Input::GiveUp);
    assert_eq!(page.state.record.standing, Standing::DeviceRefused);

    // One that can is not shown the gate, and no page is counted for it.
    let mut page = Page::open(&study_text("demo.json"), 4);
    page.send(Input::Consent);
    assert!(matches!(page.view(), View::Questions { .. }), "{:?}", page.view());
    assert!(page.state.record.finished.is_empty());
    assert!(!page.plan.is_before_session(page.state.record.step));
    // Who was measured before the agreement goes through at once when measured again.
    page.reload();
    assert!(matches!(page.view(), View::Questions { .. }), "{:?}", page.view());
}

#[test]
fn a_session_of_before_there_was_a_gate_goes_on_behind_it() {
    let mut page = Page::open(&study_text("demo.json"), 5);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    let (here, finished) = (page.state.record.step, page.state.record.finished.len());
    // Its events as they were: without a measurement.
    page.stored.retain(|event| event.body["type"] != "device_measured");
    for (sequence, event) in (0..).zip(&mut page.stored) {
        event.sequence = sequence;
    }
    let state = State::replay(&page.plan, &page.stored);
    assert_eq!((state.record.step, state.record.finished.len()), (here, finished));
    assert_eq!(state.record.unexpected, 0);
}

/// What happens before the session is its beginning, once it is begun under its own plan.
#[test]
fn what_happened_before_the_session_is_replayed_under_its_plan() {
    let mut lobby = Page::open(&study_text("demo.json"), 1);
    lobby.send(Input::ChooseLanguage("fr".into()));
    assert!(lobby.plan.is_before_session(lobby.state.record.step));
    lobby.send(Input::Consent);
    let (study, session) = started(&study_text("demo.json"), 40);
    let plan = Plan::new(study.projection(), session).unwrap();
    let state = State::replay(&plan, &lobby.stored);
    let (state, effects) = update(&plan, state, Input::Begun, lobby.now_ms);
    assert_eq!(state.record.language, "fr");
    assert_eq!(state.record.events, lobby.stored.len() as u64, "beginning is no event");
    assert!(matches!(mimique_session::flow::view(&plan, &state), View::Questions { .. }));
    let prepares = |effect: &Effect| matches!(effect, Effect::PrepareClips(_));
    assert!(effects.iter().any(prepares), "{effects:?}");
}

#[test]
fn template_goes_to_its_end_with_every_question_type_training_and_break() {
    let mut page = Page::open(&study_text("template.json"), 1);
    let mut kinds = std::collections::HashSet::new();
    let mut waited = false;
    loop {
        if let View::Page { button, .. } = page.view()
            && !button.can_submit
        {
            assert!(button.hint.is_some(), "a break says how long it lasts");
            page.send(Input::Next);
            let View::Page { .. } = page.view() else { panic!("a break cannot be skipped") };
            waited = true;
        }
        let mut choose = |id: &str, kind: &_| {
            kinds.insert(std::mem::discriminant(kind));
            if id == "gender" { json!("other") } else { first_answer(id, kind) }
        };
        if !page.act(&mut choose) {
            break;
        }
    }
    assert!(matches!(page.view(), View::End(_)));
    assert_eq!(kinds.len(), 9, "every type of question was answered");
    assert!(waited);
    assert_eq!(page.state.record.unexpected, 0);
    let ids: Vec<&str> = page.plan.steps.iter().map(|step| step.id.as_str()).collect();
    assert!(ids.contains(&"training/1/joy3.lsts30") && ids.contains(&"rest"), "{ids:?}");
    // First of the drop-down's two options is the wrong one.
    let study = &page.study;
    assert_eq!(Record::of(None, &page.stored).failed_checks(|step| study.questions_of(step)), 1);
}

#[test]
fn question_is_asked_only_if_an_earlier_answer_says_so() {
    let mut page = Page::open(&study_text("template.json"), 2);
    page.send(Input::Consent);
    let asks = |page: &Page| {
        let View::Questions { questions, .. } = page.view() else { panic!() };
        questions.iter().any(|question| question.id == "gender_words")
    };
    assert!(!asks(&page));
    page.send(Input::Answer { question: "gender".into(), value: json!("other") });
    assert!(asks(&page));
    page.send(Input::Answer { question: "gender_words".into(), value: json!("words") });
    page.send(Input::Answer { question: "gender".into(), value: json!("woman") });
    assert!(!asks(&page));
    page.finish();
    let body = page.stored.iter().find(|event| {
        event.body["step"] == "demographics" && event.body["type"] == "page_finished"
    });
    let answers = &body.unwrap().body["answers"];
    assert!(answers.get("gender_words").is_none(), "an answer no longer asked is not sent");
}

#[test]
fn replays_are_limited_and_counted() {
    let mut page = Page::open(&study_text("template.json"), 3);
    let block =
        |page: &Page| page.plan.step(page.state.record.step).unwrap().id.starts_with("faces/");
    while !block(&page) || page.state.record.attempt.plays == 0 {
        page.act(&mut first_answer);
    }
    for replay in 1..=3 {
        let View::Trial(trial) = page.view() else { panic!() };
        assert!(trial.can_replay, "replay {replay}");
        page.send(Input::Play);
    }
    let View::Trial(trial) = page.view() else { panic!() };
    assert!(!trial.can_replay && trial.can_answer);
    while page.stored.last().unwrap().body["type"] != "trial_finished" {
        page.act(&mut first_answer);
    }
    assert_eq!(page.stored.last().unwrap().body["replays"], 3);
}

/// Where the browser has no locks: two tabs of one session. What the second one stored stands; the
/// first one's event under the same number is refused by the server, and after its reload both see
/// the same session.
#[test]
fn a_second_tab_takes_the_session_over_and_the_first_follows_after_a_reload() {
    let text = study_text("demo.json");
    let mut first = Page::open(&text, 16);
    first.send(Input::Consent);
    first.send(Input::Answer { question: "age".into(), value: json!(41) });
    let mut second = Page::open(&text, 16);
    second.stored.clone_from(&first.stored);
    second.reload();
    second.send(Input::Answer { question: "age".into(), value: json!(42) });
    // The first tab goes on from what it knows: the same number, another event.
    let number = first.stored.len();
    first.send(Input::Answer { question: "age".into(), value: json!(43) });
    assert_eq!(first.stored[number].sequence, second.stored[number].sequence);
    assert_ne!(first.stored[number].body, second.stored[number].body, "a conflict for the server");
    // First write wins; the first tab is told so (409) and loads anew what is stored.
    first.stored.clone_from(&second.stored);
    first.reload();
    let View::Questions { questions, .. } = first.view() else { panic!() };
    assert_eq!(questions[0].value, Some(json!(42)));
    first.finish();
    assert!(matches!(first.view(), View::End(_)));
    assert_eq!(first.state.record.unexpected, 0);
}

/// A slow network: answers are on their way for minutes, and come acknowledged in one piece.
#[test]
fn a_slow_network_holds_nobody_up_and_the_code_back() {
    let (study, session) = started(&study_text("demo.json"), 17);
    let plan = Plan::new(study.projection(), session).unwrap();
    let mut now_ms = 1_790_000_000_000.0;
    let mut state = State::new(&plan, "en");
    let mut made = 0_u64;
    let mut inputs = std::collections::VecDeque::from([Input::Opened(client())]);
    for _ in 0..10_000 {
        let input = inputs.pop_front().unwrap_or_else(|| {
            now_ms += 5_000.0;
            match mimique_session::flow::view(&plan, &state) {
                View::Consent { .. } => Input::Consent,
                View::Questions { questions, .. } => questions
                    .iter()
                    .find(|question| question.value.is_none())
                    .map_or(Input::Next, |question| Input::Answer {
                        question: question.id.clone(),
                        value: first_answer(&question.id, &question.kind),
                    }),
                View::Trial(trial) if trial.phase == Phase::Answering => trial
                    .questions
                    .iter()
                    .find(|question| question.value.is_none())
                    .map_or(Input::Next, |question| Input::Answer {
                        question: question.id.clone(),
                        value: first_answer(&question.id, &question.kind),
                    }),
                View::Trial(trial) if trial.can_play => Input::Play,
                View::Page { .. } => Input::Next,
                View::Device(_) => Input::Measured(support::display()),
                _ => Input::Tick,
            }
        });
        let (next, effects) = update(&plan, state, input, now_ms);
        state = next;
        for effect in effects {
            match effect {
                Effect::Store(_) => made += 1,
                Effect::PrepareClips(clips) => {
                    inputs.extend(clips.into_iter().map(|clip| Input::ClipPrepared { clip }));
                }
                Effect::PlayClips { .. } => inputs.push_back(Input::Played(whole_play(now_ms))),
                Effect::Complete { .. } => panic!("nothing has arrived"),
                _ => {}
            }
        }
        if state.record.standing == Standing::Completed {
            break;
        }
    }
    assert_eq!(state.record.standing, Standing::Completed, "the participant got to the end");
    let shown = mimique_session::flow::view(&plan, &state);
    assert!(matches!(shown, View::ReceiptPending { stored: 0, .. }), "{shown:?}");
    let (_, effects) = update(&plan, state, Input::Acknowledged { stored: made }, now_ms);
    assert_eq!(effects, vec![Effect::Complete { events: made }]);
}
