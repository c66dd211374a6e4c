//! One step of the machine: an input comes in, events and effects go out.

use mimique_study::Answers;
use serde_json::Value;

use super::allowed::{can_play, can_play_alone, can_submit, shown_questions};
use super::effect::Effect;
use super::gate;
use super::input::Input;
use super::needs::{needs_ahead, needs_now};
use super::state::{Play, State};
use crate::event::{Client, EventKind, PlayLog, ShownBeside, StageFailure};
use crate::plan::{Plan, Step, StepKind, TrialStep};
use crate::wire;

/// Unexpected inputs that are recorded; further ones are only ignored, so that a page gone wrong
/// cannot fill the disk.
const UNEXPECTED_RECORDED: u32 = 100;

/// One step of the machine. `now_ms` is the page's clock.
pub fn update(plan: &Plan, state: State, input: Input, now_ms: f64) -> (State, Vec<Effect>) {
    let mut transition = Transition { plan, state, effects: Vec::new(), now_ms };
    transition.state.live.now_ms = now_ms;
    if !transition.take(&input) {
        transition.unexpected(&input);
    }
    (transition.state, transition.effects)
}

pub(super) struct Transition<'a> {
    pub(super) plan: &'a Plan,
    pub(super) state: State,
    pub(super) effects: Vec<Effect>,
    pub(super) now_ms: f64,
}

impl<'a> Transition<'a> {
    /// Takes an input; false if it does not fit the state.
    fn take(&mut self, input: &Input) -> bool {
        match input {
            Input::Tick => {
                self.tick();
                self.go_back();
                true
            }
            Input::Acknowledged { stored } => self.acknowledged(*stored),
            Input::ReceiptArrived(receipt) => self.receipt_arrived(receipt),
            Input::Copied => {
                self.state.live.copied = true;
                true
            }
            Input::Stay => {
                self.state.live.return_ms = None;
                true
            }
            Input::WithdrawalConfirmed => {
                self.state.live.withdrawal_confirmed = true;
                true
            }
            Input::ClipProgress { clip, fraction } => {
                self.state.live.progress.insert(clip.clone(), fraction.clamp(0.0, 1.0));
                true
            }
            Input::ClipPrepared { clip } => {
                self.state.live.progress.remove(clip);
                self.state.live.failed.remove(clip);
                self.state.live.prepared.insert(clip.clone(), ());
                true
            }
            Input::Withdraw => self.withdraw(),
            // After the end nothing more is recorded.
            Input::Resumed(_) | Input::Begun if !self.state.record.standing.is_open() => {
                self.resumed_at_end()
            }
            _ if !self.state.record.standing.is_open() => true,
            Input::Opened(client) => self.opened(client),
            // Only an opened session can go on.
            _ if self.state.record.events == 0 => true,
            Input::Resumed(client) => self.resumed(client),
            Input::Begun => {
                self.arrive();
                true
            }
            Input::ChooseLanguage(language) => self.choose_language(language),
            Input::Consent => self.consent(),
            Input::Decline => self.decline(),
            Input::Shown { step } => self.shown(step),
            Input::Answer { question, value } => self.answer(question, value),
            Input::Press { question, value, at_ms } => self.press(question, value, *at_ms),
            Input::Next => self.next(),
            Input::Play => self.play(),
            Input::PlayAlone(place) => self.play_alone(*place),
            Input::Played(log) => self.played(log),
            Input::ClipFailed { clip, failure } => self.clip_failed(clip, failure),
            Input::Online => self.online(),
            Input::Retry => self.retry(),
            Input::FocusLost => self.focus(false),
            Input::FocusGained => self.focus(true),
            Input::Fullscreen(on) => self.fullscreen(*on),
            Input::Measured(display) => self.measured(display),
            Input::MeasureAgain => self.remeasure(),
            Input::GiveUp => self.give_up(),
            Input::WithoutFullscreen => self.without_fullscreen(),
            Input::CardWidth { px, device_pixel_ratio } => {
                self.card_width(*px, *device_pixel_ratio)
            }
            Input::NoCard => self.no_card(),
            Input::Distance(centimetres) => self.distance(*centimetres),
            Input::PageScripted(answers) => self.page_scripted(answers),
            Input::LevelChosen(event) => self.level_chosen(event),
            Input::LevelsAhead(clips) => self.levels_ahead(clips),
            Input::PairsDrawn(event) => self.pairs_drawn(event),
            Input::ExtendTime => self.extend_time(),
        }
    }

    /// Makes an event: it is applied, and stored under the next number.
    pub(super) fn record(&mut self, kind: EventKind) {
        self.record_at(kind, self.now_ms);
    }

    /// The same of what happened a moment ago, page clock.
    pub(super) fn record_at(&mut self, kind: EventKind, at_ms: f64) {
        let body = kind.to_body();
        let sequence = self.state.record.events;
        self.state.record.apply(Some(self.plan), kind, at_ms);
        self.effects.push(Effect::Store(wire::Event { sequence, at_ms, body }));
    }

    fn unexpected(&mut self, input: &Input) {
        if self.state.record.unexpected < UNEXPECTED_RECORDED {
            let step = self.step().map_or("end", |step| &step.id).to_owned();
            self.record(EventKind::Unexpected { input: input.name().to_owned(), step });
        }
    }

    pub(super) fn step(&self) -> Option<&'a Step> {
        self.plan.step(self.state.record.step)
    }

    fn trial(&self) -> Option<(&'a Step, &'a TrialStep)> {
        self.step().and_then(|step| step.trial().map(|trial| (step, trial)))
    }

    fn opened(&mut self, client: &Client) -> bool {
        if self.state.record.events > 0 {
            return false;
        }
        let language = self.state.record.language.clone();
        self.record(EventKind::Opened { client: client.clone(), language });
        self.arrive();
        true
    }

    fn resumed(&mut self, client: &Client) -> bool {
        self.state.live = super::Live { now_ms: self.now_ms, ..Default::default() };
        self.record(EventKind::Resumed { client: client.clone() });
        self.arrive();
        true
    }

    /// A step stands there: what it and the next trials need is prepared, what is behind is sent.
    pub(super) fn arrive(&mut self) {
        self.state.live.show_problems = false;
        self.state.live.timed_out = false;
        self.state.live.play = Play::Still;
        self.turn_away();
        if !self.state.record.standing.is_open() || self.step().is_none() {
            self.effects.push(Effect::LeaveFullscreen);
        } else if self.step().is_some_and(|step| step.kind == StepKind::Device) {
            self.effects.push(Effect::MeasureDevice);
        }
        if self.state.record.standing.is_open() {
            self.prepare();
        }
        if self.step().is_none() && self.state.record.standing.is_open() {
            self.record(EventKind::Finished);
        }
        self.effects.push(Effect::Flush);
        self.effects.push(Effect::FocusHeading);
    }

    /// Asks for what this step and the next ones need. What could not be had before is on its way again,
    /// and shown so: until it fails anew, nobody has to press anything.
    pub(super) fn prepare(&mut self) {
        self.choose_level();
        self.draw_pairs();
        let needs = needs_ahead(self.plan, &self.state);
        needs.iter().for_each(|need| drop(self.state.live.failed.remove(need)));
        if !needs.is_empty() {
            self.effects.push(Effect::PrepareClips(needs));
        }
    }

    fn choose_language(&mut self, language: &str) -> bool {
        if !self.plan.study.languages.iter().any(|known| known == language) {
            return false;
        }
        if self.state.record.language != language {
            self.record(EventKind::LanguageChosen { language: language.to_owned() });
        }
        true
    }

    fn consent(&mut self) -> bool {
        let Some(consent) = self.plan.study.consent.as_ref().filter(|_| self.is_at_consent())
        else {
            return false;
        };
        let language = self.state.record.language.clone();
        self.record(EventKind::Consented { version: consent.version.clone(), language });
        self.arrive();
        true
    }

    fn decline(&mut self) -> bool {
        if !self.is_at_consent() {
            return false;
        }
        self.record(EventKind::Declined);
        self.effects.push(Effect::Flush);
        self.effects.push(Effect::FocusHeading);
        true
    }

    fn is_at_consent(&self) -> bool {
        self.step().is_some_and(|step| step.kind == StepKind::Consent)
    }

    fn shown(&mut self, step: &str) -> bool {
        if self.step().is_none_or(|here| here.id != step) {
            return false;
        }
        self.record(EventKind::PageShown { step: step.to_owned() });
        true
    }

    fn answer(&mut self, question: &str, value: &Value) -> bool {
        let Some(step) = self.step() else { return false };
        let asked = shown_questions(step, &self.state).any(|each| each.id == question);
        let too_soon = step.trial().is_some() && self.state.record.attempt.plays == 0;
        if !asked || too_soon {
            return false;
        }
        if self.state.record.draft(question).unwrap_or(&Value::Null) != value {
            self.record(EventKind::Answered {
                step: step.id.clone(),
                question: question.to_owned(),
                value: value.clone(),
            });
        }
        true
    }

    pub(super) fn next(&mut self) -> bool {
        let Some(step) = self.step() else { return false };
        if step.kind == StepKind::Consent {
            return false;
        }
        if !can_submit(self.plan, &self.state) {
            let watched = step.trial().is_none() || self.state.record.attempt.plays > 0;
            let may_answer = watched && self.state.live.play == Play::Still;
            let asks =
                !step.questions().is_empty() || matches!(step.kind, StepKind::Calibration(_));
            self.state.live.show_problems = may_answer && asks;
            // A break that has not lasted long enough is no mistake either.
            return may_answer;
        }
        let mut answers = Answers::new();
        answers.extend(shown_questions(step, &self.state).filter_map(|question| {
            let value = self.state.record.draft(&question.id)?;
            Some((question.id.clone(), value.clone()))
        }));
        match &step.kind {
            StepKind::Trial(_) => self.finish_trial(answers, false),
            StepKind::Device => return self.pass_gate(),
            StepKind::Calibration(_) => self.calibrate(),
            _ => self.finish_page(answers, false),
        }
        true
    }

    pub(super) fn finish_page(&mut self, answers: Answers, timed_out: bool) {
        let Some(step) = self.step() else { return };
        self.record(EventKind::PageFinished { step: step.id.clone(), answers, timed_out });
        self.arrive();
    }

    pub(super) fn finish_trial(&mut self, answers: Answers, timed_out: bool) {
        let Some((step, trial)) = self.trial() else { return };
        let progress = &self.state.record.attempt;
        let onset_ms = progress.onset_ms().unwrap_or(self.now_ms);
        let replays = progress.plays.saturating_sub(1);
        self.record(EventKind::TrialFinished {
            step: step.id.clone(),
            clip: trial.pair(self.state.record.chosen(step).as_ref()).0.to_owned(),
            answers,
            rt_ms: self.now_ms - onset_ms,
            replays,
            timed_out,
        });
        self.arrive();
    }

    fn play(&mut self) -> bool {
        let Some((step, trial)) = self.trial() else { return false };
        if !can_play(self.plan, &self.state) {
            return false;
        }
        if gate::needs_fullscreen(self.plan, &self.state) {
            // The first press fills the screen, the next one plays.
            self.effects.push(Effect::RequestFullscreen);
            return true;
        }
        let panel = trial.panel.as_ref();
        let chosen = self.state.record.chosen(step);
        if !self.state.record.attempt.is_started() {
            let (clip, beside) = trial.pair(chosen.as_ref());
            let (step, clip) = (step.id.clone(), clip.to_owned());
            let beside = beside.map(|(clip, left)| ShownBeside { clip: clip.to_owned(), left });
            let panel = panel.map_or_else(Vec::new, |panel| panel.clips.clone());
            let of_batch = |place| self.state.record.batch_and_pair(&step, place);
            let batch = trial.active.and_then(of_batch).map(|(batch, _)| batch);
            self.record(EventKind::TrialStarted { step, clip, beside, panel, batch });
        }
        let clips = trial.placed(chosen.as_ref());
        let in_turn = trial.is_in_turn();
        self.run(Effect::PlayClips { clips, in_turn }, None)
    }

    /// The clip at a place of a panel once more, alone.
    fn play_alone(&mut self, place: u32) -> bool {
        let panel = self.trial().and_then(|(_, trial)| trial.panel.as_ref());
        let Some(clip) = panel.and_then(|panel| panel.placed(place)) else { return false };
        can_play_alone(self.plan, &self.state, place)
            && self.run(Effect::PlayClips { clips: vec![clip], in_turn: false }, Some(place))
    }

    fn run(&mut self, play: Effect, alone: Option<u32>) -> bool {
        self.state.live.play = Play::Running;
        self.state.live.alone = alone;
        self.effects.push(play);
        true
    }

    fn played(&mut self, log: &PlayLog) -> bool {
        let Some((step, _)) = self.trial() else { return false };
        if self.state.live.play != Play::Running {
            return false;
        }
        self.state.live.play = Play::Still;
        let alone = self.state.live.alone.take();
        let mut log = PlayLog { alone, ..log.clone() };
        let traces = std::mem::take(&mut log.traces);
        let log = self.judged(log);
        let counts = log.is_whole() && alone.is_none();
        self.record(EventKind::TrialPlayed { step: step.id.clone(), log: Box::new(log) });
        if counts {
            self.after_traces(&traces);
        }
        if alone.is_none() {
            self.after_play();
        }
        self.end_slow();
        true
    }

    fn clip_failed(&mut self, clip: &str, failure: &StageFailure) -> bool {
        self.state.live.prepared.remove(clip);
        self.state.live.progress.remove(clip);
        self.state.live.failed.insert(clip.to_owned(), failure.clone());
        let needs = self.step().map(|step| needs_now(step, &self.state));
        let is_shown = needs.is_some_and(|needs| needs.iter().any(|need| need == clip));
        if is_shown {
            self.state.live.play = Play::Still;
        }
        let StageFailure { code, message, .. } = failure.clone();
        self.record(EventKind::ClipFailed { clip: clip.to_owned(), message, code });
        true
    }

    /// What could not be had without a connection is asked for again by itself.
    fn online(&mut self) -> bool {
        if !self.state.live.failed.is_empty() {
            self.prepare();
        }
        true
    }

    fn retry(&mut self) -> bool {
        let Some(step) = self.step() else { return false };
        let needs = needs_now(step, &self.state);
        if !needs.iter().any(|need| self.state.live.failed.contains_key(need)) {
            return false;
        }
        self.prepare();
        true
    }

    fn focus(&mut self, focused: bool) -> bool {
        if self.state.record.focused != focused {
            self.record(if focused { EventKind::FocusGained } else { EventKind::FocusLost });
        }
        true
    }
}
