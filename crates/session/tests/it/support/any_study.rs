//! What holds of any bytes as a study file: the check answers, and what it lets pass can be run.
//! Shared by `tests/it/hostile.rs` and the fuzz target `study_file`.

use mimique_session::Client;
use mimique_session::flow::{Input, Plan, State, update, view};
use mimique_session::wire::SessionStarted;
use mimique_study::{Draw, Severity, check, order};

/// Checks bytes as a study file and runs what passes; panics where that is not answered as promised.
pub fn check_anyhow(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let report = check(&text, &|_| Ok(()));
    for issue in &report.issues {
        assert!(
            !issue.message().is_empty() && !issue.remedy().is_empty() && !issue.code().is_empty()
        );
        assert!(issue.pointer.is_empty() || issue.pointer.starts_with('/'), "{}", issue.pointer);
    }
    let errors = report.issues.iter().any(|issue| issue.severity == Severity::Error);
    assert_eq!(report.study.is_some(), !errors);
    let Some(checked) = report.study else { return };
    for participant in [1, 2, 9_007_199_254_740_991] {
        let study = checked.study().clone();
        let draw = Draw {
            seed: study.seed,
            config_hash: checked.config_hash(),
            participant,
            condition: None,
        };
        assert!(order(&study.projection(), draw).is_ok(), "a checked order exists");
        let started = serde_json::json!({
            "session": "s", "participant_id": "p", "participant": participant, "seed": study.seed,
            "stage": "live", "config_hash": checked.config_hash(), "withdrawal_code": "w",
        });
        let started: SessionStarted = serde_json::from_value(started).expect("a session");
        let plan = Plan::new(study.projection(), started).expect("a checked study has a plan");
        assert!(plan.trial_count(false) > 0);
        let mut state = State::new(&plan, "fr");
        let inputs = [Input::Opened(Client::default()), Input::Consent, Input::Next, Input::Tick];
        for (input, now_ms) in inputs.into_iter().zip([0.0, 1e3, 2e3, 1e9]) {
            (state, _) = update(&plan, state, input, now_ms);
            let _ = view(&plan, &state);
        }
    }
}
