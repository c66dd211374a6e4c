//! Which events can be a session's: those that its plan allows at all, in whatever order.
//!
//! Whoever keeps a token can send anything. What no page of the plan could have sent is kept as it came
//! and counts in no table; the page itself sends nothing of the kind.

use std::collections::{HashMap, HashSet};

use mimique_study::{Answers, Component, Question};
use serde_json::Value;

use crate::event::EventKind;
use crate::plan::{Plan, Step, StepKind};
use crate::record::Record;
use crate::sound_answers::are_of_sound_check;
use crate::tracked_face::are_of_mimicry;

/// Why an event cannot be a session's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misfit {
    /// This version knows no such event, or cannot read it.
    Unreadable,
    /// The plan has no such step.
    NoSuchStep,
    /// A trial was finished as a page, or a page as a trial.
    OtherKind,
    /// The trial has another clip.
    OtherClip,
    /// The step does not ask this question.
    NoSuchQuestion,
    /// The question does not take this answer.
    NoSuchAnswer,
    /// The step has no limit of time that could be over.
    NoTimeLimit,
}

impl Misfit {
    /// The word that is stored and exported.
    pub fn word(self) -> &'static str {
        match self {
            Self::Unreadable => "unreadable",
            Self::NoSuchStep => "no-such-step",
            Self::OtherKind => "other-kind",
            Self::OtherClip => "other-clip",
            Self::NoSuchQuestion => "no-such-question",
            Self::NoSuchAnswer => "no-such-answer",
            Self::NoTimeLimit => "no-time-limit",
        }
    }
}

/// How much of a session is kept at most: more than a study can give, whatever its participant does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SessionLimits {
    /// Events.
    pub events: u64,
    /// Bytes of their bodies.
    pub bytes: u64,
}

impl SessionLimits {
    /// Those of a session with so many steps that ask so many questions in all. A step has some dozens of
    /// events and, with the frames of a clip that is replayed, some hundred kilobytes; a question that is
    /// answered to and fro (a slider, a text) has some dozens more.
    fn of(steps: usize, questions: usize) -> Self {
        const KIBIBYTE: u64 = 1024;
        let (steps, questions) = (steps as u64, questions as u64);
        let kibibytes = 4096 + 512 * steps + 64 * questions;
        Self {
            events: (2000 + 200 * steps + 100 * questions).min(100_000),
            bytes: (kibibytes * KIBIBYTE).min(256 * 1024 * KIBIBYTE),
        }
    }
}

/// What a plan allows, in a form that is kept for many sessions.
#[derive(Debug, Clone)]
pub struct Admission {
    steps: HashMap<String, Allowed>,
    /// The questions of the steps, each list once.
    asked: Vec<Vec<Question>>,
    /// The pages of questions and the trials, practice left out, without which nobody comes to the end.
    required: Vec<String>,
}

/// What a step allows.
#[derive(Debug, Clone)]
struct Allowed {
    /// The clip, of a trial.
    clip: Option<String>,
    /// Place of its questions in [`Admission::asked`].
    asked: usize,
    is_timed: bool,
    /// What the answers of a page must be whose controls are a script's.
    scripted: Option<fn(&Answers) -> bool>,
}

/// Whether a trial is one that an adaptive block may end before.
fn may_be_left_out(plan: &Plan, step: &Step) -> bool {
    let Some((component, number)) = step.id.split_once('/') else { return false };
    match plan.study.components.get(component) {
        Some(Component::Adaptive(block)) => {
            let stops = !block.0["stopSd"].is_null();
            let number: usize = number.parse().unwrap_or_default();
            stops && number > FEWEST_TRIALS
        }
        _ => false,
    }
}

/// No track of an adaptive block ends before so many trials but by their number.
const FEWEST_TRIALS: usize = 20;

impl Admission {
    /// What this plan allows.
    pub fn of(plan: &Plan) -> Self {
        let mut asked: Vec<Vec<Question>> = Vec::new();
        let mut steps = HashMap::with_capacity(plan.steps.len());
        for step in &plan.steps {
            let questions = step.questions();
            let known = asked.iter().position(|list| list == questions);
            let place = known.unwrap_or_else(|| {
                asked.push(questions.to_vec());
                asked.len() - 1
            });
            let allowed = Allowed {
                clip: step.trial().map(|trial| trial.clip.clone()),
                asked: place,
                is_timed: step.time_limit.is_some(),
                scripted: match step.kind {
                    StepKind::Sound => Some(are_of_sound_check),
                    StepKind::Mimicry => Some(are_of_mimicry),
                    _ => None,
                },
            };
            steps.insert(step.id.clone(), allowed);
        }
        let is_required = |step: &&Step| match &step.kind {
            StepKind::Trial(trial) => !trial.training,
            StepKind::Questions { .. } | StepKind::Sound | StepKind::Mimicry => true,
            _ => false,
        };
        let may_be_left_out = |step: &&Step| may_be_left_out(plan, step);
        let required = plan.steps.iter().filter(is_required).filter(|step| !may_be_left_out(step));
        let required = required.map(|step| step.id.clone()).collect();
        Self { steps, asked, required }
    }

    /// Whether everything was finished that stands between the beginning and the end: `finished` alone is
    /// nothing but a word.
    pub fn is_done(&self, record: &Record) -> bool {
        let done: HashSet<&str> = record.finished.iter().map(|step| step.id.as_str()).collect();
        self.required.iter().all(|step| done.contains(step.as_str()))
    }

    /// How much of the session is kept, by its steps and what they ask.
    pub fn limits(&self) -> SessionLimits {
        let asked = |step: &Allowed| self.asked.get(step.asked).map_or(0, Vec::len);
        SessionLimits::of(self.steps.len(), self.steps.values().map(asked).sum())
    }

    /// Why an event cannot be one of the session's, if it cannot.
    pub fn misfit(&self, body: &Value) -> Option<Misfit> {
        let Some(event) = EventKind::from_body(body) else { return Some(Misfit::Unreadable) };
        self.admits(&event).err()
    }

    fn admits(&self, event: &EventKind) -> Result<(), Misfit> {
        match event {
            EventKind::PageShown { step } | EventKind::PairsDrawn { step, .. } => {
                self.step(step).map(|_| ())
            }
            EventKind::TimeExtended { step } => match self.step(step)?.is_timed {
                true => Ok(()),
                false => Err(Misfit::NoTimeLimit),
            },
            EventKind::Answered { step, question, .. } => {
                self.question(self.step(step)?, question).map(|_| ())
            }
            EventKind::TrialPlayed { step, .. } => match self.step(step)?.clip {
                Some(_) => Ok(()),
                None => Err(Misfit::OtherKind),
            },
            EventKind::TrialStarted { step, clip, .. } => self.trial(step, clip).map(|_| ()),
            EventKind::TrialFinished { step, clip, answers, timed_out, .. } => {
                self.finished(self.trial(step, clip)?, answers, *timed_out)
            }
            EventKind::PageFinished { step, answers, timed_out } => {
                let step = self.step(step)?;
                match (&step.clip, step.scripted) {
                    (Some(_), _) => Err(Misfit::OtherKind),
                    (None, Some(are_fit)) => match are_fit(answers) {
                        true => Ok(()),
                        false => Err(Misfit::NoSuchAnswer),
                    },
                    (None, None) => self.finished(step, answers, *timed_out),
                }
            }
            _ => Ok(()),
        }
    }

    fn step(&self, id: &str) -> Result<&Allowed, Misfit> {
        self.steps.get(id).ok_or(Misfit::NoSuchStep)
    }

    fn trial(&self, id: &str, clip: &str) -> Result<&Allowed, Misfit> {
        let step = self.step(id)?;
        match &step.clip {
            None => Err(Misfit::OtherKind),
            // The clip of an adaptive trial follows from answers: the replay of its levels says what fits.
            Some(own) if own != clip && !own.is_empty() => Err(Misfit::OtherClip),
            Some(_) => Ok(step),
        }
    }

    fn question(&self, step: &Allowed, id: &str) -> Result<&Question, Misfit> {
        let asked = self.asked.get(step.asked).map_or(&[][..], Vec::as_slice);
        asked.iter().find(|question| question.id == id).ok_or(Misfit::NoSuchQuestion)
    }

    fn finished(&self, step: &Allowed, answers: &Answers, timed_out: bool) -> Result<(), Misfit> {
        if timed_out && !step.is_timed {
            return Err(Misfit::NoTimeLimit);
        }
        for (id, answer) in answers {
            // What is half written when the time is over is not sent either.
            if self.question(step, id)?.accept(Some(answer)).is_err() {
                return Err(Misfit::NoSuchAnswer);
            }
        }
        Ok(())
    }
}
