//! How a session is conducted: device gate, calibration, time limits, practice, screening, attention
//! checks, full screen; each through the whole flow and into the export.

use mimique_session::flow::{Effect, Input, Phase, QuestionKindView, View, update};
use mimique_session::rows::{SessionRecord, Table, tidy};
use mimique_session::{PlayLog, Standing};
use serde_json::{Value, json};

use crate::support::{self, Page, display, first_answer, status, study_text, whole_play};

/// The demo with these sections more (or others).
fn demo_with(sections: Value) -> String {
    let mut study = mimique_study::parse(&study_text("demo.json")).unwrap();
    let file = study.as_object_mut().unwrap();
    for (key, value) in sections.as_object().unwrap() {
        file.insert(key.clone(), value.clone());
    }
    study.to_string()
}

fn table(page: &Page) -> Table {
    let record = SessionRecord { started: &page.plan.started, events: &page.stored };
    tidy(&page.study, &Default::default(), [record])
}

fn step(page: &Page) -> String {
    page.plan.step(page.state.record.step).map_or("end".into(), |step| step.id.clone())
}

fn kinds(page: &Page) -> Vec<&str> {
    page.stored.iter().filter_map(|event| event.body["type"].as_str()).collect()
}

/// On to the first step that begins with these letters.
fn go_to(page: &mut Page, wanted: &str) {
    while !step(page).starts_with(wanted) {
        assert!(page.act(&mut first_answer), "no step {wanted}");
    }
}

#[test]
fn a_play_of_too_few_frames_is_told_repeated_once_and_then_ends_the_session_with_its_code() {
    let mut text = mimique_study::parse(&study_text("demo.json")).unwrap();
    text["device"] = json!({ "minimumFrameShare": 0.5 });
    text["recruitment"]["deviceCode"] = json!("SLOW");
    let play = |page: &mut Page, shown: usize| {
        let (state, effects) = update(&page.plan, page.state.clone(), Input::Play, page.now_ms);
        page.state = state;
        page.stored.extend(effects.into_iter().filter_map(|effect| match effect {
            Effect::Store(event) => Some(event),
            _ => None,
        }));
        let frames = (0..shown).map(|n| (n as f64 * 16.7, n as f64 * 16.7, 0.0)).collect();
        page.send(Input::Played(PlayLog { frames, ..whole_play(page.now_ms) }));
    };
    let at_trial = || {
        let mut page = Page::open(&text.to_string(), 1);
        while !matches!(page.view(), View::Trial(_)) {
            page.act(&mut first_answer);
        }
        page
    };
    // Of 1.95 s at 60 Hz: 117 frames, 59 are half of them.
    let mut page = at_trial();
    play(&mut page, 17);
    let View::Trial(trial) = page.view() else { panic!("{:?}", page.view()) };
    assert!(trial.can_play && !trial.can_answer, "{trial:?}");
    assert!(trial.message.contains("did not run smoothly"), "{}", trial.message);
    play(&mut page, 59);
    let View::Trial(trial) = page.view() else { panic!("{:?}", page.view()) };
    assert!(trial.can_answer, "a play that shows enough counts");

    let mut page = at_trial();
    play(&mut page, 2);
    // A reload is no further chance.
    page.reload();
    play(&mut page, 58);
    assert_eq!(page.state.record.standing, Standing::DeviceRefused);
    let code = Standing::DeviceRefused.completion_code(&page.study.recruitment);
    assert_eq!(code, Some("SLOW"));
    let View::End(end) = page.view() else { panic!("{:?}", page.view()) };
    assert!(end.text[0].contains("do not run smoothly enough"), "{:?}", end.text);
    // Whose device draws the study's own head too slowly learns so at the gate.
    let mut page = Page::open(&text.to_string(), 1);
    page.display.refresh_hz = Some(20.0);
    page.send(Input::Consent);
    let View::Device(gate) = page.view() else { panic!("{:?}", page.view()) };
    assert!(gate.problems[0].0.contains("20 frames a second; the study needs 30"), "{gate:?}");
}

#[test]
fn a_device_that_is_fine_is_measured_and_not_bothered() {
    let text = demo_with(json!({ "device": { "minimumWidth": 1000, "minimumRefreshHz": 60 } }));
    let mut page = Page::open(&text, 1);
    page.send(Input::Consent);
    assert_eq!(step(&page), "demographics", "59.9 Hz are 60");
    assert!(kinds(&page).contains(&"device_measured"));
    page.finish();
    assert_eq!(status(&page.stored), "completed");
    assert_eq!(page.state.record.unexpected, 0);
}

#[test]
fn a_narrow_window_is_told_how_wide_it_must_be_and_looked_at_again() {
    let text = demo_with(json!({ "device": { "minimumWidth": 1400, "minimumHeight": 400 } }));
    let mut page = Page::open(&text, 2);
    page.send(Input::Consent);
    let View::Device(gate) = page.view() else { panic!("{:?}", page.view()) };
    assert_eq!(gate.problems.len(), 1);
    assert!(gate.problems[0].0.contains("1280") && gate.problems[0].0.contains("1400"));
    assert!(gate.problems[0].1.contains("wider"), "{}", gate.problems[0].1);
    assert!(!gate.button.can_submit && gate.give_up.is_some());
    page.send(Input::Next);
    assert_eq!(step(&page), "device", "nobody slips through");

    // The window is made wider: the page says so, and waits for the press.
    page.display.viewport = [1500, 720];
    page.send(Input::Measured(page.display.clone()));
    let View::Device(gate) = page.view() else { panic!("{:?}", page.view()) };
    assert!(gate.problems.is_empty() && gate.button.can_submit && gate.give_up.is_none());
    page.send(Input::Next);
    assert_eq!(step(&page), "demographics");
}

#[test]
fn a_device_that_cannot_be_mended_is_screened_out_with_reason_receipt_and_row() {
    let rules =
        json!({ "device": { "kind": "desktop", "minimumRefreshHz": 50, "backend": "webgpu" } });
    let (mut study, session) = support::started(&demo_with(rules), 3);
    study.recruitment.screened_out_code = Some("N0".into());
    let mut page = Page::open(&demo_with(json!({})), 3);
    page.plan = mimique_session::flow::Plan::new(study.projection(), session).unwrap();
    page.study = study;
    page.display = mimique_study::Display {
        desktop: false,
        refresh_hz: Some(24.0),
        backend: None,
        ..display()
    };
    page.send(Input::Consent);
    let View::Device(gate) = page.view() else { panic!("{:?}", page.view()) };
    assert_eq!(gate.problems.len(), 3);
    // A reload asks again, and changes nothing.
    page.reload();
    assert!(matches!(page.view(), View::Device(_)));
    page.send(Input::GiveUp);
    let View::End(end) = page.view() else { panic!("{:?}", page.view()) };
    assert_eq!(end.outcome, "screened_out");
    assert!(end.text.iter().any(|text| text.contains("computer")), "{:?}", end.text);
    assert_eq!(page.completed, Some(page.stored.len() as u64), "after everything has arrived");
    assert_eq!(status(&page.stored), "screened_out");
    assert_eq!(Standing::DeviceRefused.completion_code(&page.study.recruitment), Some("N0"));
    let table = table(&page);
    let last = table.rows.len() - 1;
    assert_eq!(table.cell(last, "trial_type"), "screening");
    assert_eq!(table.cell(last, "answer"), "device: kind, backend, minimumRefreshHz");
    assert_eq!(table.cell(last, "status"), "screened_out");
    // After the end nothing more is recorded, and the end stands after a reload.
    let events = page.stored.len();
    page.send(Input::Next);
    page.reload();
    assert_eq!(page.stored.len(), events);
    assert!(matches!(page.view(), View::End(_)));
}

#[test]
fn a_required_full_screen_is_entered_left_and_asked_for_again() {
    let text = demo_with(json!({ "device": { "fullscreen": "required" } }));
    let mut page = Page::open(&text, 4);
    page.send(Input::Consent);
    let View::Device(gate) = page.view() else { panic!("{:?}", page.view()) };
    assert!(gate.without.is_none() && gate.button.can_submit);
    page.send(Input::Next);
    assert!(page.state.record.fullscreen);
    assert_eq!(step(&page), "demographics");
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    page.send(Input::Fullscreen(false));
    let View::Trial(trial) = page.view() else { panic!() };
    assert!(trial.message.contains("full screen"), "{}", trial.message);
    let (_, effects) = update(&page.plan, page.state.clone(), Input::Play, page.now_ms);
    assert_eq!(effects, vec![Effect::RequestFullscreen], "the clip waits");
    page.send(Input::Play);
    page.send(Input::Play);
    page.finish();
    let table = table(&page);
    let trials = (0..table.rows.len()).filter(|row| table.cell(*row, "trial_type") == "trial");
    assert!(trials.into_iter().all(|row| table.cell(row, "fullscreen") == &json!(true)));
}

#[test]
fn a_full_screen_that_is_asked_for_can_be_left_out() {
    let mut page = Page::open(&demo_with(json!({ "device": { "fullscreen": "asked" } })), 5);
    page.send(Input::Consent);
    let View::Device(gate) = page.view() else { panic!("{:?}", page.view()) };
    assert!(gate.without.is_some());
    page.send(Input::WithoutFullscreen);
    assert_eq!(step(&page), "demographics");
    page.finish();
    assert!(matches!(page.view(), View::End(_)));
}

#[test]
fn the_card_gives_pixels_per_millimetre_and_the_size_of_the_clip() {
    let mut value = mimique_study::parse(&demo_with(
        json!({ "calibration": { "required": true, "askDistance": true, "distanceCm": 60 } }),
    ))
    .unwrap();
    value["stimuli"]["look"]["widthMm"] = json!(100);
    value["stimuli"]["look"]["heightMm"] = json!(120);
    let mut page = Page::open(&value.to_string(), 6);
    go_to(&mut page, "calibration");
    page.send(Input::Next);
    let View::Calibration(shown) = page.view() else { panic!("{:?}", page.view()) };
    let card = shown.card.unwrap();
    assert!(card.problem.is_some() && card.no_card.is_none(), "nothing is taken as it stands");
    assert!(shown.distance.unwrap().problem.is_some());
    assert!((card.width_px / card.height_px - 85.60 / 53.98).abs() < 1e-12);
    page.send(Input::NoCard);
    assert_eq!(page.state.record.unexpected, 1, "required");
    page.send(Input::CardWidth { px: 428.0, device_pixel_ratio: 2.0 });
    page.send(Input::Distance(Some(5.0)));
    let View::Calibration(shown) = page.view() else { panic!() };
    assert!(!shown.button.can_submit, "nobody sits 5 cm from a screen");
    page.send(Input::Distance(Some(57.0)));
    page.send(Input::Next);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    let View::Trial(trial) = page.view() else { panic!() };
    assert_eq!((trial.size.width, trial.size.height), (500.0, 600.0), "5 px a millimetre");
    assert_eq!(trial.size.device_pixel_ratio, Some(2.0));
    page.reload();
    let View::Trial(trial) = page.view() else { panic!() };
    assert_eq!(trial.size.width, 500.0, "kept after a reload");
    page.finish();
    let table = table(&page);
    let last = table.rows.len() - 1;
    assert_eq!(table.cell(last, "px_per_mm"), &json!(5));
    assert_eq!(table.cell(last, "viewing_distance_cm"), &json!(57));
}

#[test]
fn zooming_after_the_calibration_is_reckoned_with() {
    let set = mimique_session::Calibrated {
        px_per_mm: Some(4.0),
        device_pixel_ratio: 1.0,
        distance_cm: None,
    };
    assert_eq!(set.px_per_mm_at(2.0), Some(2.0), "twice the zoom: half the CSS pixels");
    assert_eq!(set.px_per_mm_at(0.0), Some(4.0));
}

#[test]
fn without_a_card_the_study_goes_on_in_pixels() {
    let mut page = Page::open(&demo_with(json!({ "calibration": {} })), 7);
    go_to(&mut page, "calibration");
    page.send(Input::NoCard);
    page.send(Input::Next);
    assert_ne!(step(&page), "calibration");
    page.finish();
    let table = table(&page);
    assert_eq!(table.cell(table.rows.len() - 1, "px_per_mm"), &Value::Null);
}

/// The demo whose trials have a limit.
fn limited(extensions: u32) -> String {
    let mut study = mimique_study::parse(&study_text("demo.json")).unwrap();
    study["components"]["faces"]["timeLimit"] = json!({ "seconds": 30, "extensions": extensions, "essential": { "en": "Quick.", "fr": "Vite." } });
    study.to_string()
}

fn to_answering(page: &mut Page) {
    while !matches!(page.view(), View::Trial(trial) if trial.phase == Phase::Answering) {
        page.act(&mut first_answer);
    }
}

#[test]
fn when_the_time_is_over_the_answers_so_far_are_sent_and_marked() {
    let mut page = Page::open(&limited(1), 8);
    while !matches!(page.view(), View::Trial(_)) {
        page.act(&mut first_answer);
    }
    let View::Trial(before) = page.view() else { panic!() };
    assert!(before.clock.unwrap().text.contains("30 s to answer. Quick."), "told before it begins");
    // No clock runs before the clip was seen.
    page.now_ms += 100_000.0;
    page.send(Input::Tick);
    to_answering(&mut page);
    let at = step(&page);
    page.send(Input::Answer { question: "emotion".into(), value: json!("joy") });
    let View::Trial(trial) = page.view() else { panic!() };
    assert!(trial.clock.as_ref().unwrap().warning.is_none());
    page.now_ms += 15_000.0;
    page.send(Input::Tick);
    let View::Trial(trial) = page.view() else { panic!() };
    let clock = trial.clock.unwrap();
    assert!(clock.warning.is_some() && clock.extend.is_some(), "told 20 s before the end");
    page.send(Input::ExtendTime);
    let View::Trial(trial) = page.view() else { panic!() };
    let clock = trial.clock.unwrap();
    assert!(clock.warning.is_none() && clock.extend.is_none(), "once only: {clock:?}");
    page.now_ms += 29_000.0;
    page.send(Input::Tick);
    assert_eq!(step(&page), at, "the time was extended");
    page.now_ms += 20_000.0;
    page.send(Input::Tick);
    assert_ne!(step(&page), at);
    let event = page.stored.iter().rfind(|event| event.body["type"] == "trial_finished").unwrap();
    assert_eq!(event.body["timed_out"], true);
    assert_eq!(event.body["answers"], json!({ "emotion": "joy" }));
    assert!(page.state.live.timed_out, "the next page says so");
    page.finish();
    let table = table(&page);
    let late: Vec<_> =
        (0..table.rows.len()).filter(|row| table.cell(*row, "timed_out") == &json!(true)).collect();
    assert!(late.iter().all(|row| table.cell(*row, "trial_id") == at.as_str()));
    assert_eq!(late.len(), 3, "a row a question, answered or not");
}

#[test]
fn a_closed_lid_ends_the_time_when_it_opens_again() {
    let mut page = Page::open(&limited(10), 9);
    to_answering(&mut page);
    let at = step(&page);
    // Hours later the clock of the page goes on.
    page.now_ms += 3.0 * 3_600_000.0;
    page.send(Input::FocusGained);
    page.send(Input::Tick);
    assert_ne!(step(&page), at);
    // A reload starts a trial and its clock anew.
    to_answering(&mut page);
    page.now_ms += 3_600_000.0;
    page.reload();
    let View::Trial(trial) = page.view() else { panic!() };
    assert_eq!(trial.phase, Phase::Ready);
    page.send(Input::Tick);
    assert!(matches!(page.view(), View::Trial(_)));
    page.finish();
    assert_eq!(status(&page.stored), "completed");
}

#[test]
fn a_clip_that_is_played_again_is_not_cut_off_by_the_clock() {
    let mut page = Page::open(&limited(0), 10);
    to_answering(&mut page);
    let at = step(&page);
    let (state, _) = update(&page.plan, page.state.clone(), Input::Play, page.now_ms);
    page.state = state;
    page.now_ms += 60_000.0;
    page.send(Input::Tick);
    assert_eq!(step(&page), at);
    page.send(Input::Played(whole_play(page.now_ms)));
    page.send(Input::Tick);
    assert_ne!(step(&page), at);
}

#[test]
fn a_page_of_questions_can_have_a_limit() {
    let mut study = mimique_study::parse(&study_text("demo.json")).unwrap();
    study["demographics"]["timeLimit"] = json!({ "seconds": 60 });
    let mut page = Page::open(&study.to_string(), 11);
    page.send(Input::Consent);
    // A number that is not allowed is not sent as an answer.
    page.send(Input::Answer { question: "age".into(), value: json!(7) });
    page.now_ms += 61_000.0;
    page.send(Input::Tick);
    let event = page.stored.iter().rfind(|event| event.body["type"] == "page_finished").unwrap();
    assert_eq!(event.body["timed_out"], true);
    assert!(event.body.get("answers").is_none(), "{}", event.body);
    let replayed = mimique_session::flow::State::replay(&page.plan, &page.stored);
    assert_eq!(replayed.record, page.state.record);
}

/// The demo with practice on two clips, as the value of `training` says.
fn practice(more: Value) -> String {
    let mut training = json!({
        "clips": ["joy2.box", "fear2.box"],
        "questions": ["emotion", "believability"],
        "feedback": true,
    });
    let file = training.as_object_mut().unwrap();
    more.as_object().unwrap().iter().for_each(|(k, v)| drop(file.insert(k.clone(), v.clone())));
    demo_with(json!({ "training": training }))
}

/// Goes on to the end of practice, always with this emotion.
fn practise(page: &mut Page, emotion: &str) -> Vec<(bool, Option<String>)> {
    let mut seen = Vec::new();
    let mut choose = |id: &str, kind: &QuestionKindView| {
        if id == "emotion" { json!(emotion) } else { first_answer(id, kind) }
    };
    loop {
        if let View::Feedback(feedback) = page.view() {
            seen.push((feedback.correct, feedback.text.clone()));
        }
        let before = step(page);
        if !page.act(&mut choose) || step(page).starts_with("faces/") {
            return seen;
        }
        assert!(seen.len() < 50, "{before}");
    }
}

#[test]
fn practice_says_what_was_right_and_goes_on_when_it_was_enough() {
    let text = practice(json!({
        "answers": { "joy2.box": { "believability": 1 } },
        "criterion": { "correct": 1, "maximumRounds": 3 },
    }));
    let mut page = Page::open(&text, 12);
    let seen = practise(&mut page, "joy");
    assert_eq!(seen.len(), 2, "one round: {seen:?}");
    assert_eq!((seen[0].0, seen[1].0), (true, false));
    assert_eq!(seen[0].1, None);
    assert_eq!(seen[1].1.as_deref(), Some("This was the last practice clip."));
    assert_eq!(page.state.record.unexpected, 0);
    page.finish();
    let table = table(&page);
    let rows = (0..table.rows.len()).filter(|row| table.cell(*row, "trial_type") == "training");
    assert_eq!(rows.count(), 4, "two clips, two questions");
}

#[test]
fn practice_begins_again_until_the_last_round() {
    let criterion = |otherwise: &str| {
        practice(
            json!({ "criterion": { "correct": 2, "maximumRounds": 3, "otherwise": otherwise } }),
        )
    };
    let mut page = Page::open(&criterion("goOn"), 13);
    let seen = practise(&mut page, "joy");
    assert_eq!(seen.len(), 6, "three rounds of two clips");
    assert!(seen[1].1.as_deref().unwrap().contains("1 of 2 clips were right"), "{seen:?}");
    assert!(step(&page).starts_with("faces/"), "the study goes on");
    let replayed = mimique_session::flow::State::replay(&page.plan, &page.stored);
    assert_eq!(replayed.record, page.state.record);

    let mut page = Page::open(&criterion("screenOut"), 13);
    practise(&mut page, "joy");
    let View::End(end) = page.view() else { panic!("{:?}", page.view()) };
    assert_eq!(end.outcome, "screened_out");
    assert_eq!(status(&page.stored), "screened_out");
    assert_eq!(table(&page).cell(table(&page).rows.len() - 1, "answer"), "training");
}

#[test]
fn feedback_names_the_right_answer_in_the_participants_words() {
    let mut page = Page::open(&practice(json!({})), 14);
    page.send(Input::ChooseLanguage("fr".into()));
    go_to(&mut page, "feedback/1");
    let View::Feedback(feedback) = page.view() else { panic!() };
    assert_eq!(feedback.heading, "Pas tout à fait");
    assert_eq!(feedback.items.len(), 1, "only what is known: {:?}", feedback.items);
    assert_eq!(feedback.items[0].right.as_deref(), Some("La bonne réponse\u{a0}: Joie"));
}

#[test]
fn an_answer_of_a_page_can_screen_out() {
    let reason = json!({ "en": "Adults only.", "fr": "Adultes seulement." });
    let rule = json!([{ "if": { "question": "age", "atLeast": 66 }, "reason": reason }]);
    let text = demo_with(json!({ "screening": rule }));
    for (age, taken) in [(65, true), (66, false)] {
        let mut page = Page::open(&text, 15);
        page.send(Input::Consent);
        page.send(Input::Answer { question: "age".into(), value: json!(age) });
        while step(&page) == "demographics" && page.act(&mut first_answer) {}
        assert_eq!(status(&page.stored) == "active", taken, "{age}");
        if !taken {
            let View::End(end) = page.view() else { panic!("{:?}", page.view()) };
            assert!(end.text.contains(&"Adults only.".to_owned()), "{:?}", end.text);
            let table = table(&page);
            let last = table.rows.len() - 1;
            assert_eq!(table.cell(last, "answer"), "screening: age");
            assert_eq!(table.cell(last, "age"), &json!(66));
        }
    }
}

/// The demo with two attention checks on a page before its trials.
fn with_checks(rule: Value) -> String {
    let check = |id: &str| {
        json!({ "id": id, "type": "likert", "numItems": 7, "prompt": { "en": "Choose 5.", "fr": "Choisissez 5." },
                "leftLabel": { "en": "low", "fr": "bas" }, "rightLabel": { "en": "high", "fr": "haut" },
                "attentionCheck": { "expected": 5 } })
    };
    let mut study = mimique_study::parse(&demo_with(json!({ "attentionChecks": rule }))).unwrap();
    study["components"]["checks"] =
        json!({ "type": "questionnaire", "questions": [check("one"), check("two")] });
    let parts = study["sequence"]["components"].take();
    study["sequence"] = json!({ "order": "fixed", "components": ["checks", { "order": "fixed", "components": parts }] });
    study.to_string()
}

#[test]
fn failed_attention_checks_end_the_session_when_the_study_says_so() {
    let answered = |first: i64, second: i64| {
        move |id: &str, kind: &QuestionKindView| match id {
            "one" => json!(first),
            "two" => json!(second),
            _ => first_answer(id, kind),
        }
    };
    let cases = [
        ("immediately", 5, 4, "completed", 12),
        ("immediately", 4, 4, "failed_checks", 0),
        ("atEnd", 4, 4, "failed_checks", 12),
    ];
    for (when, first, second, outcome, trials) in cases {
        let text = with_checks(json!({ "allowedFailures": 1, "when": when }));
        let mut page = Page::open(&text, 16);
        while page.act(&mut answered(first, second)) {}
        assert_eq!(status(&page.stored), outcome, "{when} {first} {second}");
        assert_eq!(page.played.len(), trials);
        let View::End(end) = page.view() else { panic!("{:?}", page.view()) };
        assert_eq!(end.outcome, outcome);
        assert_eq!(page.completed, Some(page.stored.len() as u64));
        if outcome == "failed_checks" {
            let table = table(&page);
            let last = table.rows.len() - 1;
            assert_eq!(table.cell(last, "response_id"), "failed_checks");
            assert_eq!(table.cell(last, "answer"), &json!(2));
        }
    }
}
