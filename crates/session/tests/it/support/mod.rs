//! The studies of `study-config`, and a participant who goes through one.

pub mod any_study;
pub mod stepped;

#[path = "../../../../study/tests/it/support/small.rs"]
#[allow(dead_code, reason = "the tests of mimique-study use the rest")]
pub mod small;

use std::collections::BTreeMap;

use mimique_session::flow::{
    Effect, Input, Phase, Plan, QuestionKindView, State, View, update, view,
};
use mimique_session::wire::{Event, Receipt, SessionStarted};
use mimique_session::{Client, PlayLog, Record, SOUND_HEARD, StageFailure};
use mimique_study::{Display, Study, config_hash};
pub use mimique_test_support::study_text;
use serde_json::{Value, json};

/// A session of a study.
pub fn started(text: &str, participant: u64) -> (Study, SessionStarted) {
    let value = mimique_study::parse(text).unwrap();
    let study = Study::from_value(&value).unwrap();
    let session = SessionStarted {
        session: "secret".into(),
        participant_id: format!("p{participant:04}"),
        participant,
        slot: participant,
        condition: None,
        seed: study.seed,
        stage: "live".into(),
        config_hash: config_hash(&value),
        withdrawal_code: "take-it-back".into(),
    };
    (study, session)
}

/// A page that carries out effects as a browser does, and a server that stores at once.
pub struct Page {
    /// The study that the plan is drawn from.
    pub study: Study,
    pub plan: Plan,
    pub state: State,
    pub stored: Vec<Event>,
    pub now_ms: f64,
    pub played: Vec<String>,
    pub completed: Option<u64>,
    /// What the browser reports about itself.
    pub display: Display,
    /// What its stage says of the sound of a play.
    pub sound: Value,
    /// What it says of the participant's face.
    pub mimicry: Value,
}

impl Page {
    pub fn open(text: &str, participant: u64) -> Self {
        Self::open_in(text, participant, None)
    }

    /// The page of somebody in this condition.
    pub fn open_in(text: &str, participant: u64, condition: Option<&str>) -> Self {
        let (study, mut session) = started(text, participant);
        session.condition = condition.map(str::to_owned);
        let plan = Plan::new(study.projection(), session).unwrap();
        let state = State::new(&plan, "en");
        let mut page = Self {
            study,
            plan,
            state,
            stored: Vec::new(),
            now_ms: 1_790_000_000_000.0,
            played: Vec::new(),
            completed: None,
            display: display(),
            sound: Value::Null,
            mimicry: Value::Null,
        };
        page.send(Input::Opened(client()));
        page
    }

    /// The page is loaded again: only what is stored is known.
    pub fn reload(&mut self) {
        self.state = State::replay(&self.plan, &self.stored);
        self.send(Input::Resumed(client()));
    }

    pub fn send(&mut self, input: Input) {
        self.now_ms += 250.0;
        let state = std::mem::take(&mut self.state);
        let (state, effects) = update(&self.plan, state, input, self.now_ms);
        self.state = state;
        for effect in effects {
            self.carry_out(effect);
        }
    }

    fn carry_out(&mut self, effect: Effect) {
        match effect {
            Effect::Store(event) => {
                assert_eq!(event.sequence, self.stored.len() as u64, "sequence without gaps");
                self.stored.push(event);
                let stored = self.stored.len() as u64;
                self.send(Input::Acknowledged { stored });
            }
            Effect::PrepareClips(clips) => {
                for clip in clips {
                    self.send(Input::ClipProgress { clip: clip.clone(), fraction: 0.5 });
                    self.send(Input::ClipPrepared { clip });
                }
            }
            Effect::PlayClips { clips, .. } => {
                self.played.extend(clips.into_iter().next().map(|placed| placed.clip));
                let onset_ms = self.now_ms + 20.0;
                self.now_ms += 2_000.0;
                let (sound, mimicry) = (self.sound.clone(), self.mimicry.clone());
                self.send(Input::Played(PlayLog { sound, mimicry, ..whole_play(onset_ms) }));
            }
            Effect::Complete { events } => {
                self.completed = Some(events);
                self.send(Input::ReceiptArrived(receipt(events)));
            }
            Effect::MeasureDevice => self.send(Input::Measured(self.display.clone())),
            Effect::RequestFullscreen => self.send(Input::Fullscreen(true)),
            Effect::LeaveFullscreen => self.send(Input::Fullscreen(false)),
            Effect::Withdraw => self.send(Input::WithdrawalConfirmed),
            _ => {}
        }
    }

    pub fn view(&self) -> View {
        view(&self.plan, &self.state)
    }

    /// Does the next thing that the page asks for; false at the end.
    pub fn act(&mut self, choose: &mut dyn FnMut(&str, &QuestionKindView) -> Value) -> bool {
        match self.view() {
            View::Consent { .. } => self.send(Input::Consent),
            View::Questions { questions, button, .. } => {
                match questions.iter().find(|question| question.value.is_none()) {
                    Some(question) => {
                        let value = choose(&question.id, &question.kind);
                        self.send(Input::Answer { question: question.id.clone(), value });
                    }
                    None => {
                        assert!(button.can_submit, "{questions:?}");
                        self.send(Input::Next);
                    }
                }
            }
            View::Page { button, .. } => {
                if !button.can_submit {
                    self.now_ms += 60_000.0;
                }
                self.send(Input::Next);
            }
            View::Device(device) => {
                let fine = device.button.can_submit;
                self.send(if fine { Input::Next } else { Input::GiveUp });
            }
            View::Calibration(calibration) => {
                if calibration.card.is_some_and(|card| !card.set) {
                    self.send(Input::CardWidth { px: 428.0, device_pixel_ratio: 2.0 });
                }
                if calibration.distance.is_some_and(|distance| distance.value.is_none()) {
                    self.send(Input::Distance(Some(60.0)));
                }
                self.send(Input::Next);
            }
            View::Scripted(_) => {
                let answers =
                    [("sound_check", json!(SOUND_HEARD)), ("sound_check_correct", json!(3))];
                let answers = answers.map(|(name, value)| (name.to_owned(), value));
                self.send(Input::PageScripted(answers.into_iter().collect()));
            }
            View::Feedback(_) => self.send(Input::Next),
            View::Trial(trial) => match trial.phase {
                Phase::Ready => self.send(Input::Play),
                Phase::Answering => {
                    match trial.questions.iter().find(|question| question.value.is_none()) {
                        Some(question) => {
                            let value = choose(&question.id, &question.kind);
                            self.send(Input::Answer { question: question.id.clone(), value });
                        }
                        None => self.send(Input::Next),
                    }
                }
                phase => panic!("stuck in {phase:?}"),
            },
            View::ReceiptPending { .. }
            | View::End(_)
            | View::Declined { .. }
            | View::Withdrawn { .. } => return false,
        }
        true
    }

    /// Goes on to the end.
    pub fn finish(&mut self) {
        while self.act(&mut first_answer) {}
    }
}

/// The first answer that is possible.
pub fn first_answer(_: &str, kind: &QuestionKindView) -> Value {
    match kind {
        QuestionKindView::SingleChoice { options } => json!(options[0].value),
        QuestionKindView::MultipleChoice { options, .. } => json!([options[0].value]),
        QuestionKindView::Likert { points, .. } => json!(points[0].0),
        QuestionKindView::Slider { minimum, .. } => json!(minimum),
        // An adult.
        QuestionKindView::Number { minimum, .. } => json!(minimum.unwrap_or(18.0).max(18.0)),
        QuestionKindView::Text { .. } => json!("text"),
        QuestionKindView::Matrix { rows, options } => {
            let row = |each: &mimique_session::flow::ChoiceView| {
                (each.value.clone(), json!(options[0].value))
            };
            Value::Object(rows.iter().map(row).collect())
        }
        QuestionKindView::Ranking { options } => {
            options.iter().map(|each| each.value.clone()).collect()
        }
        QuestionKindView::ValenceArousal { .. } => json!({ "valence": 1, "arousal": 1 }),
        other => panic!("no answer for {other:?}"),
    }
}

pub fn client() -> Client {
    Client { viewport: [1280, 720], device_pixel_ratio: 2.0, about: BTreeMap::new() }
}

pub fn display() -> Display {
    Display {
        viewport: [1280, 720],
        device_pixel_ratio: 2.0,
        refresh_hz: Some(59.9),
        backend: Some("webgl2".into()),
        desktop: true,
        fullscreen: true,
    }
}

pub fn whole_play(onset_ms: f64) -> PlayLog {
    PlayLog {
        backend: "webgpu".into(),
        onset_ms,
        end_ms: onset_ms + 1_950.0,
        refresh_hz: 60.0,
        frames: vec![(0.0, 0.0, 0.0), (16.7, 16.7, 0.0), (50.0, 50.0, 1.0)],
        late: 1,
        longest_ms: 33.3,
        width: 480.0,
        height: 480.0,
        device_pixel_ratio: 2.0,
        weights_hash: "ab".repeat(32),
        ..PlayLog::default()
    }
}

/// A failure of the stage with this code.
pub fn failure(code: &str) -> StageFailure {
    StageFailure {
        code: code.to_owned(),
        values: BTreeMap::from([("seconds".to_owned(), "15".to_owned())]),
        message: "pack 0123: no network".to_owned(),
    }
}

pub fn receipt(events: u64) -> Receipt {
    Receipt {
        receipt: "feed".into(),
        stored: events,
        completion_code: Some("MIMIQUE-DEMO".into()),
        redirect: None,
    }
}

/// How a session stands, in the export's word.
pub fn status(events: &[Event]) -> &'static str {
    Record::of(None, events).standing.export_word()
}

/// How many attention checks were failed.
pub fn failed_checks(study: &Study, events: &[Event]) -> u32 {
    Record::of(None, events).failed_checks(|step| study.questions_of(step))
}
