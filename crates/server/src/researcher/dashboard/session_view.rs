//! What the researcher's page says of one session.

use std::collections::BTreeSet;

use mimique_session::flow::{Plan, StepKind};
use mimique_session::wire::Event;
use mimique_session::{Record, Standing, rows};
use mimique_storage::SessionRecord;
use serde_json::Value;

use crate::export::sources::{Version, as_started};

/// What the researcher's page says of one session.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SessionView {
    /// How it stands, whatever the time is.
    pub standing: Standing,
    /// Steps done and steps there are; `None` where the plan cannot be made any more.
    pub progress: Option<(usize, usize)>,
    /// The step on the screen.
    pub step: String,
    /// Question and answer of every finished page and trial.
    pub answers: Vec<(String, Value)>,
    /// Factor and level of every finished trial.
    pub levels: Vec<(String, String)>,
    /// Every finished trial, practice left out.
    pub trials: Vec<TrialView>,
    /// Question and whether it was passed, of every attention check.
    pub checks: Vec<(String, bool)>,
    /// Class of the device: the platform as the page names it.
    pub device: String,
}

/// What was measured of one trial.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TrialView {
    /// 1-based place among the trials.
    pub number: u64,
    /// From its start to its end.
    pub duration_ms: Option<f64>,
    /// Frames shown.
    pub frames: u64,
    /// Frames that came late.
    pub late: u64,
}

impl SessionView {
    /// The view of a session and its events.
    pub fn new(version: &Version, session: &SessionRecord, events: &[Event]) -> Self {
        let started = as_started(session);
        let plan = Plan::new(version.study.projection(), started.clone()).ok();
        let record = Record::of(plan.as_ref(), events);
        // Of deleted answers nothing but the standing is left.
        let standing = if session.is_deleted() { session.standing } else { record.standing };
        let (progress, step) = match &plan {
            Some(plan) => {
                let here = record.step.min(plan.steps.len());
                let step = plan.step(here).map_or_else(String::new, |step| match &step.kind {
                    StepKind::Trial(trial) if trial.training => {
                        format!("practice {}", trial.number)
                    }
                    StepKind::Trial(trial) => format!("trial {}: {}", trial.number, trial.clip),
                    _ => step.id.clone(),
                });
                (Some((here, plan.steps.len())), step)
            }
            None => (None, String::new()),
        };
        let mut view = Self {
            standing,
            progress,
            step,
            answers: Vec::new(),
            levels: Vec::new(),
            trials: Vec::new(),
            checks: Vec::new(),
            device: device(&session.client),
        };
        view.read_rows(version, session, events);
        view
    }

    fn read_rows(&mut self, version: &Version, session: &SessionRecord, events: &[Event]) {
        let started = as_started(session);
        let record = rows::SessionRecord { started: &started, events };
        let table = rows::tidy(&version.study, &version.clips, [record]);
        let factors = version.study.factor_names();
        let mut counted = BTreeSet::new();
        for row in 0..table.rows.len() {
            let text = |name: &str| table.cell(row, name).as_str().unwrap_or_default().to_owned();
            let count = |name: &str| table.cell(row, name).as_u64().unwrap_or_default();
            let answer = table.cell(row, "answer");
            if let Some(passed) = table.cell(row, "attention_passed").as_bool() {
                self.checks.push((text("response_id"), passed));
            }
            if text("trial_type") == "training" {
                continue;
            }
            if !answer.is_null() {
                self.answers.push((text("response_id"), answer.clone()));
            }
            // A trial has a row for each answer; it is one trial all the same.
            if text("trial_type") == "trial" && counted.insert(text("trial_id")) {
                self.trials.push(TrialView {
                    number: count("trial_order"),
                    duration_ms: table.cell(row, "duration").as_f64(),
                    frames: count("frames"),
                    late: count("frames_late"),
                });
                for factor in &factors {
                    let level = match table.cell(row, factor) {
                        Value::Null => continue,
                        Value::String(level) => level.clone(),
                        other => other.to_string(),
                    };
                    self.levels.push((factor.clone(), level));
                }
            }
        }
    }
}

/// What the page said of its platform: `Windows`, `Android`…
fn device(client: &str) -> String {
    let about: std::collections::BTreeMap<String, String> =
        serde_json::from_str(client).unwrap_or_default();
    about.get("platform").cloned().unwrap_or_default()
}
