//! From state to screen: decisions made, texts in the participant's language.

use super::agreement::{self, AgreementView};
use super::allowed::{break_seconds_left, can_play, can_play_alone, can_submit, is_saving};
use super::gate;
use super::needs::{Needs, needs_of};
use super::placed::canvas_of_place;
use super::state::{Play, State};
use super::view::{
    BesideView, ButtonView, CodeView, EndView, FailedView, PanelFigure, PanelView, Phase,
    ProgressView, RecordsView, SectionView, TrialView, View,
};
use super::view_question::QuestionView;
use crate::event::PlayLog;
use crate::panel::{Panel, letter};
use crate::plan::{Plan, Step, StepKind, TrialStep};
use crate::record::CutShort;
use crate::standing::Standing;
use mimique_study::text::Words;
use mimique_study::{LocalText, MEDIA_PREFIX, Section};

/// What stands on the screen.
pub fn view(plan: &Plan, state: &State) -> View {
    let screen = Screen { plan, state, words: plan.words(&state.record.language) };
    let words = screen.words;
    if state.record.standing == Standing::Withdrawn || state.live.withdrawing {
        let confirmed = state.live.withdrawal_confirmed;
        let (heading, text) = if confirmed {
            (words.withdrawn(), words.withdrawn_text())
        } else {
            (words.withdrawing(), "")
        };
        return View::Withdrawn { heading: heading.into(), text: text.into(), confirmed };
    }
    if state.record.standing == Standing::Declined {
        let (heading, text) = (words.declined().into(), words.declined_text().into());
        return View::Declined { heading, text };
    }
    match plan.step(state.record.step) {
        Some(step) if state.record.standing.is_open() => screen.step(step),
        _ => screen.end(),
    }
}

pub(super) struct Screen<'a> {
    pub(super) plan: &'a Plan,
    pub(super) state: &'a State,
    pub(super) words: &'a Words,
}

impl Screen<'_> {
    pub(super) fn text(&self, text: &LocalText) -> String {
        agreement::text(&self.state.record.language, text)
    }

    /// The path of a file, as the study file writes it.
    pub(super) fn path(&self, path: &LocalText) -> String {
        path.in_language(&self.state.record.language).to_owned()
    }

    pub(super) fn paragraphs(&self, text: &LocalText) -> Vec<String> {
        agreement::paragraphs(&self.state.record.language, text)
    }

    fn section(&self, section: &Section) -> SectionView {
        agreement::section(&self.state.record.language, section)
    }

    pub(super) fn progress(&self) -> ProgressView {
        ProgressView { done: self.state.record.step, total: self.plan.steps.len() }
    }

    pub(super) fn button(&self, label: &str) -> ButtonView {
        ButtonView {
            label: label.to_owned(),
            can_submit: can_submit(self.plan, self.state),
            hint: None,
        }
    }

    fn step(&self, step: &Step) -> View {
        match &step.kind {
            StepKind::Consent => self.consent(step),
            StepKind::Questions { page, .. } => View::Questions {
                step: step.id.clone(),
                title: page
                    .title
                    .as_ref()
                    .map_or_else(|| self.words.about_you().to_owned(), |title| self.text(title)),
                text: page.text.as_ref().map_or_else(Vec::new, |text| self.paragraphs(text)),
                questions: self.questions(step),
                failed: match needs_of(step, self.state) {
                    Needs::Failed(_, failure) => Some(FailedView {
                        message: self.words.media_failed().to_owned(),
                        reason: self.words.stage_failure(&failure.code, &failure.values),
                        retry: self.words.retry().to_owned(),
                    }),
                    _ => None,
                },
                button: self.button(self.words.next()),
                clock: self.clock(step),
                progress: self.progress(),
            },
            StepKind::Device => View::Device(Box::new(self.device(step))),
            StepKind::Calibration(calibration) => {
                View::Calibration(Box::new(self.calibration(step, calibration)))
            }
            StepKind::Sound => View::Scripted(Box::new(self.sound(step))),
            StepKind::Mimicry => View::Scripted(Box::new(self.mimicry(step))),
            StepKind::Feedback { of } => View::Feedback(Box::new(self.feedback(step, *of))),
            StepKind::Page(section) => {
                let next = self.plan.step(self.state.record.step + 1);
                let before_trial = next.is_some_and(|step| step.trial().is_some());
                let label = if before_trial { self.words.begin() } else { self.words.next() };
                self.page(step, section, self.button(label))
            }
            StepKind::Debriefing(section) => {
                self.page(step, section, self.button(self.words.next()))
            }
            StepKind::Break(rest) => {
                let section = Section { heading: rest.heading.clone(), text: rest.text.clone() };
                let left = break_seconds_left(self.plan, self.state);
                let mut button = self.button(self.words.next());
                button.hint = (left > 0).then(|| self.words.wait_seconds(left));
                self.page(step, &section, button)
            }
            StepKind::Trial(trial) => View::Trial(Box::new(self.trial(step, trial))),
        }
    }

    fn page(&self, step: &Step, section: &Section, button: ButtonView) -> View {
        let SectionView { heading, text } = self.section(section);
        let (step, clock) = (step.id.clone(), self.clock(step));
        View::Page { step, heading, text, button, clock, progress: self.progress() }
    }

    fn consent(&self, step: &Step) -> View {
        let study = &self.plan.study;
        let words = self.words;
        let languages = if study.languages.len() > 1 {
            let name = |code: &String| (code.clone(), self.plan.words(code).language_name().into());
            study.languages.iter().map(name).collect()
        } else {
            Vec::new()
        };
        View::Consent {
            step: step.id.clone(),
            agreement: AgreementView::new(study, &self.state.record.language, words),
            languages,
            agree: words.agree().to_owned(),
            decline: words.decline().to_owned(),
        }
    }

    fn trial(&self, step: &Step, trial: &TrialStep) -> TrialView {
        let (state, words) = (self.state, self.words);
        let progress = &state.record.attempt;
        let playing = state.live.play == Play::Running;
        let saving = is_saving(state);
        let needs = needs_of(step, state);
        let prepared = matches!(needs, Needs::Ready);
        let mut failed = words.clip_failed();
        let phase = match needs {
            _ if playing => Phase::Playing,
            Needs::Failed(need, failure) => {
                if need.starts_with(MEDIA_PREFIX) {
                    failed = words.media_failed();
                }
                let reason = words.stage_failure(&failure.code, &failure.values);
                Phase::Failed { reason, retry: words.retry().to_owned() }
            }
            _ if progress.plays > 0 => Phase::Answering,
            Needs::Loading(fraction) => Phase::Loading { fraction },
            Needs::Ready if saving => Phase::Loading { fraction: 1.0 },
            Needs::Ready => Phase::Ready,
        };
        let fullscreen_first = gate::needs_fullscreen(self.plan, state);
        let message = match &phase {
            Phase::Ready if fullscreen_first => words.fullscreen_first(),
            Phase::Playing => words.playing(),
            Phase::Failed { .. } => failed,
            Phase::Answering if progress.play.as_ref().is_some_and(PlayLog::is_mute) => {
                self.sound_word("sound_not_played")
            }
            Phase::Answering => words.answer_now(),
            Phase::Loading { .. } if saving && prepared => words.saving(),
            Phase::Loading { .. } => words.loading(),
            Phase::Ready => match progress.cut_short {
                Some(CutShort::OutOfView) => words.play_out_of_view(),
                Some(CutShort::NoSound) => self.sound_word("sound_not_played"),
                Some(CutShort::TooFewFrames) => words.play_too_slow(),
                Some(CutShort::Interrupted) => words.play_interrupted(),
                None => words.watch_first(),
            },
        };
        let of = self.plan.trial_count(trial.training);
        let heading = if trial.training {
            words.training_of(trial.number, of)
        } else {
            words.trial_of(trial.number, of)
        };
        let can_play = can_play(self.plan, state);
        let chosen = state.record.chosen(step);
        let (clip, beside) = trial.pair(chosen.as_ref());
        let (keys, questions) = self
            .questions(step)
            .into_iter()
            .partition(|asked: &QuestionView| asked.kind.is_meanwhile());
        let can_answer = progress.plays > 0 && !playing;
        let mut button = self.button(words.submit());
        button.hint = (!can_answer).then(|| words.watch_first().to_owned());
        let play_label = match progress.plays {
            _ if fullscreen_first => words.back_to_fullscreen(),
            0 => words.play(),
            _ => words.play_again(),
        };
        TrialView {
            placed: trial.placed(chosen.as_ref()),
            step: step.id.clone(),
            clip: clip.to_owned(),
            beside: beside.map(|(clip, left)| {
                let below = trial.beside.as_ref();
                let caption = below.and_then(|it| it.caption.as_ref());
                let clip_caption = below.and_then(|it| it.clip_caption.as_ref());
                BesideView {
                    clip: clip.to_owned(),
                    left,
                    caption: caption.map(|text| self.text(text)),
                    clip_caption: clip_caption.map(|text| self.text(text)),
                }
            }),
            panel: trial.panel.as_ref().map(|panel| self.panel(panel)),
            heading,
            instruction: trial.instruction.as_ref().map(|text| self.text(text)),
            size: self.stage_size(),
            clock: self.clock(step),
            phase,
            message: message.to_owned(),
            captions: self.plan.study.sound["captions"]
                .as_str()
                .map(|rule| [rule, self.sound_word("sound_captions")].map(str::to_owned)),
            can_play,
            play_label: play_label.to_owned(),
            can_replay: can_play && progress.plays > 0,
            keys,
            can_press: progress.plays > 0 || (playing && state.live.alone.is_none()),
            questions,
            can_answer,
            button,
            progress: self.progress(),
        }
    }

    fn panel(&self, panel: &Panel) -> PanelView {
        let figure = |place: u32| {
            let caption = match (place as usize).checked_sub(1) {
                Some(at) => letter(at),
                None => self.words.reference().to_owned(),
            };
            Some(PanelFigure {
                place,
                canvas: canvas_of_place(place),
                clip: panel.clip(place)?.to_owned(),
                play_label: self.words.play_alone(&caption),
                caption,
                can_play: can_play_alone(self.plan, self.state, place),
            })
        };
        let figures = panel.places().filter_map(figure).collect();
        PanelView { is_rated: panel.is_rated(), prompt: self.text(&panel.prompt), figures }
    }

    fn end(&self) -> View {
        let (live, words) = (&self.state.live, self.words);
        let Some(receipt) = &live.receipt else {
            return View::ReceiptPending {
                heading: words.sending().to_owned(),
                text: words.sending_text().to_owned(),
                stored: live.stored.min(self.state.record.events),
                total: self.state.record.events,
            };
        };
        let labelled = |label: &str, value: &str| (label.to_owned(), value.to_owned());
        let (outcome, heading, mut text) = self.outcome();
        let what_now = match (&receipt.redirect, &receipt.completion_code) {
            (Some(_), _) => words.take_way_back(),
            (None, Some(_)) => words.take_code(),
            (None, None) => words.can_close(),
        };
        text.push(what_now.to_owned());
        let completion_code = receipt.completion_code.as_ref().map(|code| CodeView {
            label: words.completion_code().to_owned(),
            code: code.clone(),
            copy: words.copy_code().to_owned(),
            copied: live.copied.then(|| words.copied().to_owned()),
        });
        let started = &self.plan.started;
        View::End(Box::new(EndView {
            outcome,
            heading,
            text,
            completion_code,
            redirect: receipt.redirect.as_ref().map(|to| labelled(words.go_back(), to)),
            returning: live.return_ms.map(|at_ms| {
                let seconds = ((at_ms - live.now_ms) / 1000.0).ceil().max(0.0) as u64;
                (words.go_back_in(seconds), words.stay_here().to_owned())
            }),
            records: RecordsView {
                heading: words.for_your_records().to_owned(),
                withdrawal_code: labelled(words.withdrawal_code(), &started.withdrawal_code),
                participant: labelled(words.participant_number(), &started.participant_id),
                receipt: labelled(words.receipt(), &receipt.receipt),
                note: words.withdrawal_code_text().to_owned(),
                delete: words.delete_by_code().to_owned(),
            },
        }))
    }
}
