//! A participant of the demo study whose every answer is known beforehand.

use std::collections::BTreeMap;

use mimique_session::flow::{Plan, State, StepKind};
use mimique_session::wire::{Event, SessionStarted};
use mimique_session::{Client, EventKind, PlayLog, Standing};
use mimique_study::{Answers, Question, QuestionKind, Study};
use serde_json::{Value, json};

/// What was answered: (participant, step, question) -> answer.
pub type Planted = BTreeMap<(String, String, String), Value>;

/// The events of a participant who finishes `steps` steps (all of them: the whole study), and the
/// answers in them.
pub fn takes_part(study: &Study, started: &SessionStarted, steps: usize) -> (Vec<Event>, Planted) {
    let plan = Plan::new(study.projection(), started.clone()).unwrap();
    let mut log = Log::default();
    log.add(EventKind::Opened { client: Client::default(), language: "en".into() });
    let mut planted = Planted::new();
    for step in plan.steps.iter().take(steps) {
        let id = step.id.clone();
        let mut answers = Answers::new();
        for (place, question) in step.questions().iter().enumerate() {
            let answer = answer(question, started.participant + place as u64 + id.len() as u64);
            let key = (started.participant_id.clone(), id.clone(), question.id.clone());
            planted.insert(key, answer.clone());
            answers.insert(question.id.clone(), answer);
        }
        if let StepKind::Consent = step.kind {
            log.add(EventKind::Consented { version: "1".into(), language: "en".into() });
            continue;
        }
        log.add(EventKind::PageShown { step: id.clone() });
        if let Some(trial) = step.trial() {
            let clip = trial.clip.clone();
            log.add(EventKind::TrialStarted {
                step: id.clone(),
                clip: clip.clone(),
                beside: None,
                panel: Vec::new(),
                batch: None,
            });
            log.add(EventKind::TrialPlayed { step: id.clone(), log: Box::new(play(log.now_ms)) });
            log.add(EventKind::TrialFinished {
                step: id,
                clip,
                answers,
                rt_ms: 900.5,
                replays: 0,
                timed_out: false,
            });
        } else {
            log.add(EventKind::PageFinished { step: id, answers, timed_out: false });
        }
    }
    if steps >= plan.steps.len() {
        log.add(EventKind::Finished);
        let state = State::replay(&plan, &log.events);
        assert_eq!(state.record.standing, Standing::Completed, "the events fit the study");
        assert_eq!(state.record.unexpected, 0);
    }
    (log.events, planted)
}

#[derive(Default)]
struct Log {
    events: Vec<Event>,
    now_ms: f64,
}

impl Log {
    fn add(&mut self, kind: EventKind) {
        self.now_ms += 750.25;
        self.events.push(Event {
            sequence: self.events.len() as u64,
            at_ms: 1_790_000_000_000.0 + self.now_ms,
            body: serde_json::to_value(kind).unwrap(),
        });
    }
}

fn answer(question: &Question, choice: u64) -> Value {
    match &question.kind {
        QuestionKind::SingleChoice(kind) => {
            json!(kind.options[choice as usize % kind.options.len()].value)
        }
        QuestionKind::Likert(scale) => {
            json!(scale.start + (choice % u64::from(scale.num_items)) as i64)
        }
        QuestionKind::Number(_) => json!(20 + choice),
        other => panic!("the demo study asks no {other:?}"),
    }
}

fn play(now_ms: f64) -> PlayLog {
    PlayLog {
        backend: "webgpu".into(),
        onset_ms: 1_790_000_000_000.0 + now_ms,
        end_ms: 1_790_000_000_500.0 + now_ms,
        refresh_hz: 60.0,
        frames: (0..30).map(|k| (f64::from(k) * 16.667, f64::from(k) * 16.667, 0.0)).collect(),
        longest_ms: 16.7,
        weights_hash: "00ff".into(),
        ..PlayLog::default()
    }
}
