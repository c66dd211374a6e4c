//! Who goes on: the device gate, calibration, time limits, and the ends of a session before its
//! last page.

use super::allowed::shown_questions;
use super::clock;
use super::effect::Effect;
use super::state::{Play, State};
use super::update::Transition;
use crate::event::{Calibrated, EventKind, PlayLog};
use crate::plan::{Plan, Step, StepKind};
use mimique_study::{
    AfterTraining, Answers, AttentionEnd, Calibration, DeviceRules, Display, FullscreenRule,
    ScreeningRule, StudyProjection, Unmet,
};

/// Width of a bank card, millimetres (ISO/IEC 7810, ID-1).
pub const CARD_WIDTH_MM: f64 = 85.60;
/// Height of a bank card, millimetres (ISO/IEC 7810, ID-1).
pub const CARD_HEIGHT_MM: f64 = 53.98;
/// Distances from eyes to screen that can be told, centimetres.
pub(super) const DISTANCES_CM: std::ops::RangeInclusive<f64> = 15.0..=300.0;
/// Measurements of a display that are recorded in one session; a window that is dragged about makes
/// many.
const MEASUREMENTS_RECORDED: u32 = 50;

/// Plays of one trial with too few frames after which a session ends: the second chance is the last.
const SLOW_PLAYS: u32 = 2;

impl Transition<'_> {
    /// The page has measured the display.
    pub(super) fn measured(&mut self, display: &Display) -> bool {
        let first = self.state.record.display.is_none();
        let known = self.state.record.display.as_ref() == Some(display);
        if !known && self.state.record.measurements < MEASUREMENTS_RECORDED {
            let was_at_device = self.is_at_device();
            self.record(EventKind::DeviceMeasured { display: display.clone() });
            if was_at_device && !self.is_at_device() {
                self.arrive();
                return true;
            }
        }
        // A page that appears and is fine already only stands in the way.
        if first && self.is_at_device() && !self.asks_fullscreen() && self.device_is_fine() {
            self.finish_page(Answers::new(), false);
        }
        true
    }

    fn is_at_device(&self) -> bool {
        self.step().is_some_and(|step| step.kind == StepKind::Device)
    }

    fn device_is_fine(&self) -> bool {
        device_problems(self.plan, &self.state).is_some_and(|unmet| unmet.is_empty())
    }

    /// Whether a full screen is wanted that is not there.
    pub(super) fn asks_fullscreen(&self) -> bool {
        fullscreen_rule(&self.plan.study) != FullscreenRule::No && !self.state.record.fullscreen
    }

    /// The button that leads on from the device gate.
    pub(super) fn pass_gate(&mut self) -> bool {
        if self.asks_fullscreen() {
            self.effects.push(Effect::RequestFullscreen);
            if fullscreen_rule(&self.plan.study) == FullscreenRule::Required {
                // It goes on when the screen is filled.
                self.state.live.entering = true;
                return true;
            }
        }
        self.finish_page(Answers::new(), false);
        true
    }

    pub(super) fn without_fullscreen(&mut self) -> bool {
        let asked = fullscreen_rule(&self.plan.study) == FullscreenRule::Asked;
        if !self.is_at_device() || !asked || !self.device_is_fine() {
            return false;
        }
        self.finish_page(Answers::new(), false);
        true
    }

    pub(super) fn fullscreen(&mut self, on: bool) -> bool {
        if self.state.record.fullscreen != on {
            self.record(EventKind::Fullscreen { on });
        }
        if on && self.is_at_device() && std::mem::take(&mut self.state.live.entering) {
            self.finish_page(Answers::new(), false);
        }
        true
    }

    /// The participant cannot put right what is missing.
    pub(super) fn give_up(&mut self) -> bool {
        let unmet = device_problems(self.plan, &self.state).unwrap_or_default();
        if !self.is_at_device() || unmet.is_empty() {
            return false;
        }
        self.screen_out("device", unmet.iter().map(|each| each.key().to_owned()).collect());
        self.leave();
        true
    }

    /// Notes in the log of a whole play that it showed fewer frames than the study wants.
    pub(super) fn judged(&self, mut log: PlayLog) -> PlayLog {
        let rules = self.plan.study.device.as_ref();
        let clip_ms = log.end_ms - log.onset_ms;
        let enough =
            |rules: &DeviceRules| rules.shows_enough(log.frames.len(), clip_ms, log.refresh_hz);
        if log.is_whole() && !rules.is_none_or(enough) {
            log.aborted = Some(PlayLog::TOO_FEW_FRAMES.to_owned());
        }
        // The clip is offered once more; a browser that plays no sound at all keeps nobody from going on.
        if log.is_whole() && log.is_mute() && self.state.record.attempt.mute_plays == 0 {
            log.aborted = Some(PlayLog::NO_SOUND.to_owned());
        }
        log
    }

    /// Ends the session of somebody whose device shows too few frames once more.
    pub(super) fn end_slow(&mut self) {
        if self.state.record.attempt.slow_plays >= SLOW_PLAYS {
            self.screen_out("frames", vec!["minimumFrameShare".to_owned()]);
            self.leave();
        }
    }

    /// The script of the page has what it is for: tones were heard or not, the measuring was agreed to or not.
    pub(super) fn page_scripted(&mut self, answers: &Answers) -> bool {
        let is_there = self
            .step()
            .is_some_and(|step| matches!(step.kind, StepKind::Sound | StepKind::Mimicry));
        if is_there {
            self.finish_page(answers.clone(), false);
        }
        is_there
    }

    pub(super) fn remeasure(&mut self) -> bool {
        if !self.is_at_device() {
            return false;
        }
        self.effects.push(Effect::MeasureDevice);
        true
    }

    pub(super) fn card_width(&mut self, px: f64, device_pixel_ratio: f64) -> bool {
        if calibration(self.plan, &self.state).is_none_or(|it| !it.card) || !px.is_finite() {
            return false;
        }
        let draft = &mut self.state.live.calibration;
        draft.px_per_mm = Some(px.clamp(10.0, 10_000.0) / CARD_WIDTH_MM);
        draft.device_pixel_ratio = device_pixel_ratio;
        self.state.live.no_card = false;
        true
    }

    pub(super) fn no_card(&mut self) -> bool {
        if calibration(self.plan, &self.state).is_none_or(|it| it.required) {
            return false;
        }
        self.state.live.no_card = true;
        self.state.live.calibration.px_per_mm = None;
        true
    }

    pub(super) fn distance(&mut self, centimetres: Option<f64>) -> bool {
        if calibration(self.plan, &self.state).is_none_or(|it| !it.ask_distance) {
            return false;
        }
        self.state.live.calibration.distance_cm = centimetres;
        true
    }

    /// The button that leads on from the calibration.
    pub(super) fn calibrate(&mut self) {
        let calibrated: Calibrated = self.state.live.calibration.clone();
        self.record(EventKind::Calibrated(calibrated));
        self.finish_page(Answers::new(), false);
    }

    pub(super) fn extend_time(&mut self) -> bool {
        let more = clock::clock(self.plan, &self.state)
            .is_some_and(|clock| clock.left > 0.0 && clock.extensions > 0);
        let Some(step) = self.step().filter(|_| more) else { return false };
        self.record(EventKind::TimeExtended { step: step.id.clone() });
        true
    }

    /// Time has passed.
    pub(super) fn tick(&mut self) {
        if !clock::is_over(self.plan, &self.state) {
            return;
        }
        let Some(step) = self.step() else { return };
        // What can be taken is taken; what is half written is not an answer.
        let mut answers = Answers::new();
        answers.extend(shown_questions(step, &self.state).filter_map(|question| {
            let value = self.state.record.draft(&question.id)?;
            question.accept(Some(value)).ok()?;
            Some((question.id.clone(), value.clone()))
        }));
        match step.trial() {
            Some(_) => self.finish_trial(answers, true),
            None => self.finish_page(answers, true),
        }
        self.state.live.timed_out = true;
    }

    fn screen_out(&mut self, reason: &str, details: Vec<String>) {
        let step = self.step().map_or("end", |step| &step.id).to_owned();
        self.record(EventKind::ScreenedOut { step, reason: reason.to_owned(), details });
    }

    /// Ends the session of somebody whom the study does not take any further. Called whenever a step
    /// was finished, and after a reload.
    pub(super) fn turn_away(&mut self) {
        if !self.state.record.standing.is_open() {
            return;
        }
        let study = &self.plan.study;
        let failed = self.state.record.failed_checks(|step| self.plan.questions_of(step));
        if let Some(rule) = screening(study, &self.state) {
            let question = rule.condition.question.clone();
            self.screen_out("screening", vec![question]);
        } else if study.hearing_is_required() && did_not_hear(&self.state) {
            self.screen_out("sound", Vec::new());
        } else if self.state.record.practice_failed && screens_out_of_training(study) {
            self.screen_out("training", Vec::new());
        } else if let Some(rule) = &study.attention_checks
            && failed > rule.allowed_failures
            && (rule.when == AttentionEnd::Immediately || self.step().is_none())
        {
            self.record(EventKind::ChecksFailed { failed });
        }
    }

    /// The session is over before its last page: what waits is sent, and the screen given back.
    fn leave(&mut self) {
        self.state.live.play = Play::Still;
        self.effects.extend([Effect::LeaveFullscreen, Effect::Flush, Effect::FocusHeading]);
    }
}

/// The first rule by which the study does not take this participant.
pub(super) fn screening<'a>(
    study: &'a StudyProjection,
    state: &State,
) -> Option<&'a ScreeningRule> {
    let answers = &state.record.answers;
    study.screening.iter().find(|rule| rule.condition.holds(answers.get(&rule.condition.question)))
}

/// What the sound check says of somebody who heard its tones.
pub const SOUND_HEARD: &str = "heard";

/// Whether the tones of the sound check were played and not heard.
fn did_not_hear(state: &State) -> bool {
    state.record.answers.get("sound_check").is_some_and(|outcome| outcome != SOUND_HEARD)
}

fn screens_out_of_training(study: &StudyProjection) -> bool {
    let criterion = study.training.as_ref().and_then(|training| training.criterion.as_ref());
    criterion.is_some_and(|rule| rule.otherwise == AfterTraining::ScreenOut)
}

/// What the device lacks; `None` before it was measured.
pub(super) fn device_problems(plan: &Plan, state: &State) -> Option<Vec<Unmet>> {
    let display = state.record.display.as_ref()?;
    Some(unmet(&plan.study, display))
}

/// What a display lacks. Where the study asks for nothing, it must be able to draw the clips.
pub(crate) fn unmet(study: &StudyProjection, display: &Display) -> Vec<Unmet> {
    match &study.device {
        Some(rules) => rules.unmet(display),
        None => DeviceRules::default().unmet(display),
    }
}

/// Whether the pages fill the screen.
pub(super) fn fullscreen_rule(study: &StudyProjection) -> FullscreenRule {
    study.device.as_ref().map_or(FullscreenRule::No, |rules| rules.fullscreen)
}

/// Whether a clip may not be played because the screen is not filled.
pub(super) fn needs_fullscreen(plan: &Plan, state: &State) -> bool {
    fullscreen_rule(&plan.study) == FullscreenRule::Required && !state.record.fullscreen
}

/// The calibration, if it stands on the screen.
fn calibration<'a>(plan: &'a Plan, state: &State) -> Option<&'a Calibration> {
    match plan.step(state.record.step) {
        Some(Step { kind: StepKind::Calibration(calibration), .. }) => Some(calibration),
        _ => None,
    }
}

/// Whether the calibration is complete.
pub(super) fn is_calibrated(calibration: &Calibration, state: &State) -> bool {
    let live = &state.live;
    let card = !calibration.card || live.no_card || live.calibration.px_per_mm.is_some();
    let told = live.calibration.distance_cm;
    let distance = match told {
        Some(cm) => DISTANCES_CM.contains(&cm),
        None => !calibration.required,
    };
    card && (!calibration.ask_distance || distance)
}
