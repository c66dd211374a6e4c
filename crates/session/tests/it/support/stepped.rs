//! A page that goes where a test sends it: clips are ready at once, levels are chosen as the browser's module chooses
//! them, and a clip is played only when the test says so.

use mimique_session::Client;
use mimique_session::flow::{Effect, Input, Plan, State, update};
use mimique_session::wire::{Event, SessionStarted};
use mimique_study::{AdaptiveComponent, ClosedLoop, Display, Draw, Study};
use serde::Deserialize as _;
use serde_json::{Value, json};

/// A study of `study-config` that begins without its consent, changed.
pub fn study(name: &str, change: impl FnOnce(&mut Value)) -> Study {
    let mut value = mimique_study::parse(&mimique_test_support::study_text(name)).expect("JSON");
    value.as_object_mut().unwrap().remove("consent");
    change(&mut value);
    Study::from_value(&value).expect("a study")
}

/// The session of a participant, whose slot has the same number.
pub fn started(seed: u64, participant: u64, config_hash: &str) -> SessionStarted {
    SessionStarted {
        session: "s".to_owned(),
        participant_id: format!("p{participant:04}"),
        participant,
        slot: participant,
        condition: None,
        seed,
        stage: "live".to_owned(),
        config_hash: config_hash.to_owned(),
        withdrawal_code: String::new(),
    }
}

pub struct Page {
    pub plan: Plan,
    pub state: State,
    pub events: Vec<Event>,
    /// Every clip that was asked for.
    pub prepared: Vec<String>,
    /// What levels were made ready for, and what they were chosen for.
    pub readied: Vec<Value>,
    pub asked_for: Vec<Value>,
    now_ms: f64,
}

impl Page {
    pub fn open(study: &Study, started: SessionStarted) -> Self {
        let plan = Plan::new(study.projection(), started).expect("an order");
        let state = State::new(&plan, "en");
        let (events, prepared) = (vec![], vec![]);
        let (readied, asked_for, now_ms) = (vec![], vec![], 0.0);
        let mut page = Self { plan, state, events, prepared, readied, asked_for, now_ms };
        page.send(Input::Opened(Client::default()));
        page.send(Input::Measured(Display {
            viewport: [1600, 900],
            device_pixel_ratio: 1.0,
            refresh_hz: Some(60.0),
            backend: Some("webgpu".to_owned()),
            desktop: true,
            fullscreen: true,
        }));
        page
    }

    pub fn send(&mut self, input: Input) {
        let mut inputs = vec![input];
        while let Some(input) = inputs.pop() {
            self.now_ms += 10.0;
            let state = std::mem::take(&mut self.state);
            let (state, effects) = update(&self.plan, state, input, self.now_ms);
            self.state = state;
            for effect in effects {
                match effect {
                    Effect::Store(event) => self.events.push(event),
                    Effect::PrepareClips(clips) => {
                        self.prepared.extend(clips.clone());
                        let ready = |clip| Input::ClipPrepared { clip };
                        inputs.extend(clips.into_iter().map(ready));
                    }
                    Effect::ChooseLevel(request) => {
                        inputs.extend(chosen(&request));
                        self.asked_for.push(request);
                    }
                    Effect::ReadyLevels(request) => self.readied.push(request),
                    Effect::Flush => {
                        inputs.push(Input::Acknowledged { stored: self.events.len() as u64 });
                    }
                    _ => {}
                }
            }
        }
    }

    /// The step where the participant is; none at the end.
    pub fn step(&self) -> Option<String> {
        self.plan.step(self.state.record.step).map(|step| step.id.clone())
    }
}

/// What the module of the page does, without anything kept between its calls: the level, which is taken in first, and
/// what may come after it.
fn chosen(request: &Value) -> [Input; 2] {
    let block = AdaptiveComponent::deserialize(&request["block"]).expect("a block");
    let draw = Draw {
        seed: request["seed"].as_u64().unwrap(),
        config_hash: request["configHash"].as_str().unwrap(),
        participant: request["slot"].as_u64().unwrap(),
        condition: None,
    };
    let component = request["component"].as_str().unwrap();
    let mut closed_loop = ClosedLoop::new(block, component, draw).expect("levels");
    for answer in request["answers"].as_array().unwrap() {
        closed_loop.answer(answer.as_str());
    }
    let event = match closed_loop.next() {
        Some(level) => {
            let mut event = serde_json::to_value(level).unwrap();
            event["type"] = "level_chosen".into();
            event["step"] = request["step"].clone();
            event
        }
        None => json!({ "type": "levels_over", "step": request["step"] }),
    };
    let after = [false, true].map(|seen| closed_loop.after(seen).clips());
    [Input::LevelsAhead(after.concat()), Input::LevelChosen(event)]
}
