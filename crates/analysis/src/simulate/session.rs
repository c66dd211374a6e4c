//! A simulated person goes through the study: the page's own state machine makes the events.

use mimique_session::flow::{Effect, Input, Plan, State, StepKind, update};
use mimique_session::wire::{Event, SessionStarted};
use mimique_session::{Client, EventKind, PlayLog, SOUND_HEARD, SoundLog};
use mimique_study::{
    Calibration, Component, Display, DrawnPairs, KindOfQuestion as _, Multilingual as _,
    OrderError, PairRequest, TRACE_HZ, TrialsComponent,
};
use serde::Deserialize as _;

use super::faces::Viewer;
use super::latent::ClipEffects;
use super::levels::{Levels, Observer};
use super::model::Model;
use super::person::{BEFORE_REPLAY_MS, Person, Raw, Showing, as_json};
use super::scaling::Judge;
use super::{PairChoices, SimulatedSession};

/// 5 January 2026, 9:00 UTC: when the first simulated session begins.
const FIRST_SESSION_MS: f64 = 1_767_603_600_000.0;
/// From one session to the next, on average.
const BETWEEN_SESSIONS_MS: f64 = 660_000.0;

/// Windows that people have, CSS pixels, and device pixels a CSS pixel.
const WINDOWS: [([u32; 2], f64); 5] = [
    ([1920, 969], 1.0),
    ([1536, 730], 1.25),
    ([1440, 789], 2.0),
    ([2560, 1329], 1.0),
    ([1366, 651], 1.0),
];
/// Browsers, their versions and platforms.
const BROWSERS: [[&str; 3]; 5] = [
    ["Chrome", "143", "Windows"],
    ["Firefox", "146", "Windows"],
    ["Safari", "26", "macOS"],
    ["Edge", "143", "Windows"],
    ["Chrome", "143", "macOS"],
];

/// A session from its opening to its end. No events are left of one that was taken back. `others` is what people before
/// chose between two levels: the pairs of an active schedule are drawn under it.
pub(crate) fn session(
    model: &Model<'_>,
    clips: &ClipEffects,
    seed: u64,
    started: SessionStarted,
    others: &PairChoices,
) -> Result<SimulatedSession, OrderError> {
    let plan = Plan::new(model.study.projection(), started.clone())?;
    let person =
        |seed| Person::new(model, clips, seed, started.participant, started.condition.as_deref());
    // Practice is not part of the answers' stream.
    let (person, practice) = (person(seed), person(seed ^ PRACTICE));
    let state = State::new(&plan, model.study.default_language());
    let levels = Levels::default();
    let page = Page { plan: &plan, state, events: Vec::new(), now_ms: 0.0, levels, others };
    let observer = Observer::new(model.study, model.parameters, seed, started.participant);
    let viewer = Viewer::new(model.study, model.parameters, seed, started.participant);
    let judge = Judge::new(model.study, model.parameters, seed, started.participant);
    let mut walk = Walk { model, seed, person, practice, observer, viewer, judge, page, trial: 0 };
    walk.go();
    let Page { events, state, .. } = walk.page;
    let mut choices = PairChoices::new();
    // Of who took the answers back, nothing counts.
    for (name, component) in plan.study.components.iter().filter(|_| !events.is_empty()) {
        if let Component::Trials(TrialsComponent { pairs: Some(pairs), .. }) = component
            && pairs.active > 0
        {
            let own = state.record.pair_choices(&plan, name);
            choices.entry(name.clone()).or_default().add_own(pairs, &own);
        }
    }
    Ok(SimulatedSession { started, events, choices })
}

/// Tells the seed of practice from that of the answers.
const PRACTICE: u64 = 0x7072_6163_7469_6365;

/// A page that carries out effects as a browser does, and a server that stores at once.
pub(super) struct Page<'p> {
    pub(super) plan: &'p Plan,
    pub(super) state: State,
    pub(super) events: Vec<Event>,
    pub(super) now_ms: f64,
    pub(super) levels: Levels,
    pub(super) others: &'p PairChoices,
}

impl Page<'_> {
    pub(super) fn wait(&mut self, ms: f64) {
        // Eighths of a millisecond: sums and differences of times are exact.
        self.now_ms += eighths(ms);
    }

    pub(super) fn send(&mut self, input: Input) {
        let mut inputs = vec![input];
        while let Some(input) = inputs.pop() {
            let state = std::mem::take(&mut self.state);
            let (state, effects) = update(self.plan, state, input, self.now_ms);
            self.state = state;
            for effect in effects {
                match effect {
                    Effect::Store(event) => self.events.push(event),
                    Effect::PrepareClips(clips) => {
                        inputs.extend(clips.into_iter().map(|clip| Input::ClipPrepared { clip }));
                    }
                    Effect::ChooseLevel(request) => inputs.extend(self.levels.choose(&request)),
                    Effect::DrawPairs(request) => {
                        inputs.extend(pairs_drawn(&request, self.others));
                    }
                    Effect::Flush => {
                        inputs.push(Input::Acknowledged { stored: self.events.len() as u64 });
                    }
                    _ => {}
                }
            }
        }
    }
}

/// Answers the effect `DrawPairs` as the page's module does, and the server that tells it what others chose.
fn pairs_drawn(request: &serde_json::Value, others: &PairChoices) -> Option<Input> {
    let mut request = PairRequest::deserialize(request).ok()?;
    request.others = others.get(&request.component).cloned().unwrap_or_default();
    let DrawnPairs { pairs, answers, hash } = request.draw();
    let (step, batch) = (request.step, request.batch);
    let event = EventKind::PairsDrawn { step, batch, pairs, answers, hash };
    Some(Input::PairsDrawn(event.to_body()))
}

/// A time in eighths of a millisecond, one at least.
pub(crate) fn eighths(ms: f64) -> f64 {
    ((ms * 8.0).round() / 8.0).max(0.125)
}

/// A simulated person on the way through the study.
pub(super) struct Walk<'w, 'm> {
    pub(super) model: &'m Model<'m>,
    pub(super) seed: u64,
    pub(super) person: Person<'m>,
    pub(super) practice: Person<'m>,
    pub(super) observer: Observer,
    pub(super) viewer: Viewer,
    pub(super) judge: Judge,
    pub(super) page: Page<'w>,
    /// Trials finished.
    pub(super) trial: usize,
}

impl Walk<'_, '_> {
    fn go(&mut self) {
        let number = self.page.plan.started.participant.saturating_sub(1) as f64;
        let chance = self.person.chance();
        let client = client(chance.below(WINDOWS.len()), chance.below(BROWSERS.len()));
        self.page.now_ms = FIRST_SESSION_MS;
        self.page.wait(BETWEEN_SESSIONS_MS * (number + chance.unit()));
        self.page.send(Input::Opened(client.clone()));
        while self.page.state.record.standing.is_open() {
            let here = self.page.state.record.step;
            let Some(step) = self.page.plan.steps.get(here) else { return };
            match &step.kind {
                StepKind::Consent => {
                    self.read(30_000.0);
                    let agrees = !self.person.fate.declines;
                    self.page.send(if agrees { Input::Consent } else { Input::Decline });
                    continue;
                }
                StepKind::Trial(trial) => {
                    let leaves = self.person.fate.leaves_after.is_some_and(|n| self.trial >= n);
                    if leaves && !trial.training {
                        self.leave();
                        return;
                    }
                    self.shown(&step.id);
                    self.read(800.0);
                    // Of a pair that follows from answers, what they chose.
                    let chosen = self.page.state.record.chosen(step);
                    let clip = trial.pair(chosen.as_ref()).0.to_owned();
                    self.watch(&client, &clip, trial.maximum_replays, trial.training);
                    if self.page.state.record.step == here {
                        self.answer_trial(&clip, trial.training);
                    }
                    self.trial += usize::from(!trial.training);
                    if self.page.state.record.step != here {
                        continue;
                    }
                }
                StepKind::Questions { page, demographics } => {
                    self.shown(&step.id);
                    self.answer_page(page, *demographics);
                }
                StepKind::Break(rest) => {
                    self.shown(&step.id);
                    self.page.wait(1000.0 * rest.minimum_seconds);
                    self.read(4_000.0);
                }
                StepKind::Page(_) | StepKind::Debriefing(_) | StepKind::Feedback { .. } => {
                    self.shown(&step.id);
                    self.read(15_000.0);
                }
                StepKind::Device => {
                    self.check_device(&client);
                    continue;
                }
                StepKind::Sound => {
                    self.shown(&step.id);
                    self.hear();
                    continue;
                }
                // Nobody who is simulated has a face.
                StepKind::Mimicry => {
                    self.shown(&step.id);
                    self.read(15_000.0);
                    let version = self.model.study.mimicry.as_ref().map(|own| &own.consent.version);
                    let answers = [
                        ("mimicry_consent", "declined"),
                        ("mimicry_version", version.map_or("", String::as_str)),
                        ("mimicry_camera", "off"),
                    ];
                    let answers = answers.map(|(name, word)| (name.to_owned(), word.into()));
                    self.page.send(Input::PageScripted(answers.into_iter().collect()));
                    continue;
                }
                StepKind::Calibration(calibration) => {
                    self.shown(&step.id);
                    self.calibrate(calibration, &client);
                }
            }
            self.page.send(Input::Next);
            if self.page.state.record.step == here {
                // An answer that its question does not take; the person can go no further.
                return;
            }
        }
    }

    /// The device is measured, made to fit where that is possible, or given up.
    fn check_device(&mut self, client: &Client) {
        let here = self.page.state.record.step;
        self.page.send(Input::Measured(display(client)));
        if self.page.state.record.step != here {
            return;
        }
        self.read(4_000.0);
        self.page.send(Input::Next);
        self.page.send(Input::Fullscreen(true));
        if self.page.state.record.step == here {
            self.page.send(Input::GiveUp);
        }
    }

    /// A card is held to the screen, and the distance from it is told.
    fn calibrate(&mut self, calibration: &Calibration, client: &Client) {
        self.read(20_000.0);
        if calibration.card {
            let device_pixel_ratio = client.device_pixel_ratio;
            self.page.send(Input::CardWidth { px: 324.0, device_pixel_ratio });
        }
        if calibration.ask_distance {
            self.page.send(Input::Distance(Some(60.0)));
        }
    }

    /// The volume is set, and the tones of every round are counted right.
    fn hear(&mut self) {
        let check = self.model.study.sound.clone().unwrap_or_default().check;
        self.read(15_000.0);
        let number = self.page.plan.started.participant;
        let mut draws = super::random::Draws::new(0, Some(number), "tones");
        let mut round = || {
            let tones = 1 + draws.below(check.most_tones.max(1) as usize) as u32;
            [tones; 2]
        };
        let rounds: Vec<[u32; 2]> = (0..check.rounds).map(|_| round()).collect();
        self.page.wait(5_000.0 * f64::from(check.rounds));
        let answers = [
            ("sound_check", SOUND_HEARD.into()),
            ("sound_check_correct", check.rounds.into()),
            ("sound_check_attempts", 1.into()),
            ("sound_check_rounds", serde_json::json!(rounds)),
        ];
        let answers = answers.map(|(name, value)| (name.to_owned(), value));
        self.page.send(Input::PageScripted(answers.into_iter().collect()));
    }

    /// What a browser would have heard: sound on time.
    fn heard(&self, clip: &str) -> serde_json::Value {
        let study = self.model.study;
        let clips = &self.page.plan.study.clips;
        let clip = clips.iter().find(|each| each.id == clip);
        let Some(heard) = clip.and_then(|clip| study.heard(clip)) else {
            return Default::default();
        };
        let log = SoundLog {
            status: "played".to_owned(),
            offset_ms: Some(heard.delay_ms),
            delay_ms: heard.delay_ms,
            drift_ms: Some(0.0),
            ..SoundLog::default()
        };
        serde_json::to_value(log).unwrap_or_default()
    }

    /// The person closes the page, or takes everything back: then nothing is left.
    fn leave(&mut self) {
        if self.person.fate.withdraws {
            self.page.events.clear();
        }
    }

    fn shown(&mut self, step: &str) {
        self.page.wait(40.0);
        self.page.send(Input::Shown { step: step.to_owned() });
    }

    pub(super) fn read(&mut self, median_ms: f64) {
        let ms = self.person.chance().log_normal(median_ms, 0.4);
        self.page.wait(ms);
    }

    fn watch(&mut self, client: &Client, clip: &str, most_replays: Option<u32>, training: bool) {
        let person = if training { &mut self.practice } else { &mut self.person };
        let showing = person.showing(most_replays);
        let webgl2 = self.model.parameters.display.webgl2;
        let backend = if self.backend_draw() < webgl2 { "webgl2" } else { "webgpu" };
        if showing.reload {
            self.page.send(Input::Resumed(client.clone()));
            self.page.wait(3_000.0);
        }
        if showing.cut_short {
            self.page.send(Input::Play);
            let log = self.log(&showing, backend, client, Some("the page was hidden"));
            self.page.wait(600.0);
            self.page.send(Input::Played(log));
            self.page.wait(BEFORE_REPLAY_MS);
        }
        for play in 0..=showing.replays {
            if play > 0 {
                self.page.wait(BEFORE_REPLAY_MS);
            }
            self.page.send(Input::Play);
            self.page.wait(60.0);
            let sound = self.heard(clip);
            let traces = self.follow(clip, training, play);
            let log = PlayLog { sound, traces, ..self.log(&showing, backend, client, None) };
            let left_ms = match play {
                0 => self.press_while_playing(clip, training),
                _ => self.model.parameters.times.clip_ms,
            };
            self.page.wait(left_ms);
            let here = self.page.state.record.step;
            self.page.send(Input::Played(log));
            if self.page.state.record.step != here {
                // The last press was all that the trial asked for.
                return;
            }
        }
        if showing.focus_loss {
            self.page.send(Input::FocusLost);
            self.page.send(Input::FocusGained);
        }
    }

    /// Presses the keys of the trial's questions while the clip plays; how much of the clip is left then. What would
    /// come after its end is answered with the other questions.
    fn press_while_playing(&mut self, clip: &str, training: bool) -> f64 {
        let mut left_ms = self.model.parameters.times.clip_ms;
        let here = self.page.state.record.step;
        let keyed: Vec<String> = self.page.plan.steps[here]
            .questions()
            .iter()
            .filter(|question| question.kind.keys().is_some())
            .map(|question| question.id.clone())
            .collect();
        for question in keyed {
            let Some((value, ms)) = self.pressed(&question, clip, training) else { continue };
            if ms < left_ms {
                self.page.wait(ms);
                left_ms -= ms;
                let at_ms = self.page.now_ms;
                self.page.send(Input::Press { question, value, at_ms });
            }
        }
        left_ms.max(1.0)
    }

    /// Where the lines of the trial stand while the clip plays for the first time: from the middle to the rating that
    /// the person comes to, after a second half-way.
    fn follow(&mut self, clip: &str, training: bool, play: usize) -> serde_json::Value {
        let here = self.page.state.record.step;
        let traced: Vec<(String, [f64; 2])> = self.page.plan.steps[here]
            .questions()
            .iter()
            .filter(|question| question.kind.is_traced() && play == 0)
            .filter_map(|question| {
                let [low, high] = question.kind.bounds()?;
                Some((question.id.clone(), [low?, high?]))
            })
            .collect();
        let seconds = self.model.parameters.times.clip_ms / 1000.0;
        let (model, trial) = (self.model, self.trial);
        let mut courses = serde_json::Map::new();
        for (question, [low, high]) in traced {
            let places = (model.question(&question), model.clip(clip));
            let (Some(place), Some(clip)) = places else { continue };
            let person = if training { &mut self.practice } else { &mut self.person };
            let Some(Raw::Number(rating)) = person.trial_answer(place, clip, None, trial) else {
                continue;
            };
            let middle = (low + high) / 2.0;
            let at = |k: usize| {
                let share = 1.0 - libm::exp2(-(k as f64) / TRACE_HZ);
                (middle + share * (rating - middle)).round().clamp(low, high)
            };
            let course: Vec<f64> = (0..=(seconds * TRACE_HZ) as usize).map(at).collect();
            courses.insert(question, course.into());
        }
        if courses.is_empty() { serde_json::Value::Null } else { courses.into() }
    }

    /// What a person would press, and how long it takes; nothing where the answer is the option without a key.
    pub(super) fn pressed(
        &mut self,
        question: &str,
        clip: &str,
        training: bool,
    ) -> Option<(String, f64)> {
        let (place, clip) = (self.model.question(question)?, self.model.clip(clip)?);
        let trial = self.trial;
        let person = if training { &mut self.practice } else { &mut self.person };
        let ms = person.answering_ms(Some(clip));
        let raw = person.trial_answer(place, clip, None, trial)?;
        let asked = &self.model.questions[place];
        let value = as_json(asked, raw).as_str()?.to_owned();
        asked.question.kind.keys()?.contains_key(&value).then_some((value, ms))
    }

    /// One browser has one back end: drawn by the participant's number alone.
    fn backend_draw(&self) -> f64 {
        let number = self.page.plan.started.participant;
        super::random::Draws::new(0, Some(number), "backend").unit()
    }

    fn log(
        &self,
        showing: &Showing,
        backend: &str,
        client: &Client,
        aborted: Option<&str>,
    ) -> PlayLog {
        let look = &self.model.study.stimuli.look;
        let thousandths = |ms: f64| (ms * 1000.0).round() / 1000.0;
        let shown = if aborted.is_some() { 5 } else { showing.frames.len() };
        PlayLog {
            backend: backend.to_owned(),
            onset_ms: self.page.now_ms,
            end_ms: self.page.now_ms + self.model.parameters.times.clip_ms,
            refresh_hz: self.model.parameters.display.refresh_hz,
            frames: showing.frames[..shown.min(showing.frames.len())]
                .iter()
                .map(|&(ms, late)| (thousandths(ms), thousandths(ms), f64::from(u8::from(late))))
                .collect(),
            late: showing.late() as u32,
            longest_ms: thousandths(showing.longest_ms()),
            width: f64::from(look.width),
            height: f64::from(look.height),
            device_pixel_ratio: client.device_pixel_ratio,
            // Nothing was rendered.
            weights_hash: String::new(),
            provenance: String::new(),
            beside_provenance: String::new(),
            renderer: String::new(),
            drift_ms: 0.0,
            sound: serde_json::Value::Null,
            mimicry: serde_json::Value::Null,
            triggers: None,
            panel: serde_json::Value::Null,
            traces: serde_json::Value::Null,
            alone: None,
            aborted: aborted.map(str::to_owned),
        }
    }
}

/// A computer that can show every study.
fn display(client: &Client) -> Display {
    Display {
        viewport: client.viewport,
        device_pixel_ratio: client.device_pixel_ratio,
        refresh_hz: Some(60.0),
        backend: Some("webgpu".to_owned()),
        desktop: true,
        fullscreen: true,
    }
}

fn client(window: usize, browser: usize) -> Client {
    let (viewport, device_pixel_ratio) = WINDOWS[window % WINDOWS.len()];
    let [name, version, platform] = BROWSERS[browser % BROWSERS.len()];
    let about = [("browser", name), ("version", version), ("platform", platform)];
    Client {
        viewport,
        device_pixel_ratio,
        about: about.into_iter().map(|(key, word)| (key.to_owned(), word.to_owned())).collect(),
    }
}
