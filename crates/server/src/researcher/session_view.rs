//! What the researcher's page says of one session.

use std::collections::BTreeSet;

use mimique_study::flow::{Plan, State, Status as FlowStatus, StepKind};
use mimique_study::responses;
use mimique_study::wire::Event;
use serde_json::Value;

use crate::export::{Version, as_started};
use crate::storage::{SessionRecord, Status};

/// What the researcher's page says of one session.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SessionView {
    pub standing: Standing,
    /// Steps done and steps there are; `None` where the plan cannot be made any more.
    pub progress: Option<(usize, usize)>,
    /// The step on the screen.
    pub step: String,
    /// Question and answer of every finished page and trial.
    pub answers: Vec<(String, Value)>,
    /// Factor and level of every finished trial.
    pub levels: Vec<(String, String)>,
}

/// How a session stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Standing {
    Active,
    Completed,
    Declined,
    Withdrawn,
}

impl Standing {
    pub const ALL: [Self; 4] = [Self::Active, Self::Completed, Self::Declined, Self::Withdrawn];

    pub fn word(self) -> &'static str {
        match self {
            Self::Active => "under way",
            Self::Completed => "completed",
            Self::Declined => "declined",
            Self::Withdrawn => "withdrawn",
        }
    }
}

impl SessionView {
    /// The view of a session and its events.
    pub fn new(version: &Version, session: &SessionRecord, events: &[Event]) -> Self {
        let started = as_started(session);
        let plan = Plan::new(version.study.clone(), started.clone()).ok();
        let state = plan.as_ref().map(|plan| State::replay(plan, events));
        let flow_status = state.as_ref().map(|state| state.record.status);
        let standing = match (session.status, flow_status) {
            (Status::Withdrawn, _) => Standing::Withdrawn,
            (_, Some(FlowStatus::Declined)) => Standing::Declined,
            (Status::Completed, _) => Standing::Completed,
            (Status::Started, _) => Standing::Active,
        };
        let (progress, step) = match (&plan, &state) {
            (Some(plan), Some(state)) => {
                let here = state.record.step.min(plan.steps.len());
                let step = plan.step(here).map_or_else(String::new, |step| match &step.kind {
                    StepKind::Trial(trial) if trial.training => {
                        format!("practice {}", trial.number)
                    }
                    StepKind::Trial(trial) => format!("trial {}: {}", trial.number, trial.clip),
                    _ => step.id.clone(),
                });
                (Some((here, plan.steps.len())), step)
            }
            _ => (None, String::new()),
        };
        let (answers, levels) = answers_and_levels(version, session, events);
        Self { standing, progress, step, answers, levels }
    }
}

type Pairs<T> = Vec<(String, T)>;

fn answers_and_levels(
    version: &Version,
    session: &SessionRecord,
    events: &[Event],
) -> (Pairs<Value>, Pairs<String>) {
    let started = as_started(session);
    let record = responses::SessionRecord { started: &started, events, status: None };
    let table = responses::tidy(&version.study, &version.clips, [record]);
    let factors = version.study.factor_names();
    let mut answers = Vec::new();
    let mut levels = Vec::new();
    let mut counted = BTreeSet::new();
    for row in 0..table.rows.len() {
        let text = |name: &str| table.cell(row, name).as_str().unwrap_or_default().to_owned();
        let answer = table.cell(row, "answer");
        if text("trial_type") == "training" {
            continue;
        }
        if !answer.is_null() {
            answers.push((text("response_id"), answer.clone()));
        }
        // A trial has a row for each answer; it is one trial all the same.
        if text("trial_type") == "trial" && counted.insert(text("trial_id")) {
            for factor in &factors {
                let level = match table.cell(row, factor) {
                    Value::Null => continue,
                    Value::String(level) => level.clone(),
                    other => other.to_string(),
                };
                levels.push((factor.clone(), level));
            }
        }
    }
    (answers, levels)
}
