//! The tidy export of a study as people, trials and answers, with the study's exclusions applied.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use mimique_session::Standing;
use mimique_stats::Table;
use mimique_study::{Exclusions, ShownCourse, Study};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;

use crate::agreement::answers::on_pages;
use crate::trials::combinations::Combinations;
use crate::trials::error::ExportError;
use crate::trials::reason::Reason;
use crate::trials::rule::Rule;
use crate::trials::screening::{Screening, screen};
use crate::trials::sessions::{Sessions, about_people};
use crate::trials::straight_lining::count_runs;
use crate::trials::trial_rows::{TrialReader, TrialRows, stretches};

/// One person.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Person {
    /// `participant_id`.
    pub id: String,
    /// How the session stands.
    pub status: String,
    /// Trials answered (practice not counted).
    pub trials: usize,
    /// Attention checks failed.
    pub failed_checks: usize,
    /// Most equal answers in a row, where the study has a rule about them; else 0.
    #[serde(skip_serializing_if = "is_zero")]
    pub longest_run: usize,
    /// Whether the tones of the sound check were heard.
    #[serde(skip)]
    pub heard: bool,
    /// Why the person is left out.
    pub excluded: Option<Reason>,
}

/// One answer in a trial that is used. Millions of answers share a few texts.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Answer {
    /// Place in [`Export::people`].
    pub person: usize,
    /// As exported.
    pub text: Arc<str>,
    /// As a number, if it is one.
    pub number: Option<f64>,
    /// Whether it is right, where there is a right answer.
    pub correct: Option<bool>,
    /// The right answer.
    pub truth: Option<Arc<str>>,
    /// Response time, milliseconds.
    pub rt_ms: Option<f64>,
    /// Place in [`Export::trials`].
    pub trial: usize,
    /// Of a rating that followed the clip: where it stood, `mimique_study::TRACE_HZ` times a second.
    pub trace: Option<Arc<[f32]>>,
}

/// One trial that is used: its clip, factors and frames.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Trial {
    pub stimulus: Arc<str>,
    /// The segment of its clip; none of a clip that the study does not have.
    pub segment: Option<Arc<str>>,
    /// What was played in step beside it.
    pub beside: Option<Beside>,
    /// The level, of a trial of an adaptive block.
    pub level: Option<ShownLevel>,
    /// The face, of a trial of a block of reverse correlation.
    pub face: Option<ShownFace>,
    /// Of a judgement of differences: name of the block, and the levels as they stood.
    pub scaled: Option<(Arc<str>, Arc<[f64]>)>,
    /// Place among the person's trials, from 1.
    pub order: Option<usize>,
    /// Value of each of [`Export::factors`].
    pub levels: Vec<Option<Arc<str>>>,
    pub frames: Option<f64>,
    pub late: Option<f64>,
    pub longest_ms: Option<f64>,
    /// How far its sound was from its time; infinitely where it was not played.
    pub sound_off_ms: Option<f64>,
}

/// A trial that a rule excludes although its participant is used.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ExcludedTrial {
    /// Place in [`Export::people`].
    pub person: usize,
    pub trial: Trial,
    /// Responses that were given in it.
    pub questions: Vec<String>,
}

/// The level of a trial of an adaptive block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShownLevel {
    /// Name of the component.
    pub block: Arc<str>,
    pub track: usize,
    pub level: f64,
    /// Whether no track counts it.
    pub catch: bool,
    /// Whether seed and answers give the level again.
    pub replayed: bool,
}

/// The face of a trial of a block of reverse correlation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ShownFace {
    /// Name of the component.
    pub block: Arc<str>,
    /// The course of each unit that it showed.
    pub courses: Arc<[ShownCourse]>,
    /// Whether the weights that were shown are those that the seed gives; true where nothing was drawn.
    pub replayed: bool,
}

/// A clip that was played beside the trial's own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Beside {
    pub clip: Arc<str>,
    /// Whether it stood on the left.
    pub left: bool,
    /// Its value of each of [`Export::factors`].
    pub levels: Vec<Option<Arc<str>>>,
}

/// What was left out, and why.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct Flow {
    /// People with at least one row.
    pub people: usize,
    /// People left out, by reason.
    pub people_left_out: BTreeMap<Reason, usize>,
    /// Those of them whom the researcher excluded, by the reason given.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub researcher_reasons: BTreeMap<String, usize>,
    /// People used.
    pub people_used: usize,
    /// Trials of the people used.
    pub trials: usize,
    /// Trials left out, by reason.
    pub trials_left_out: BTreeMap<Reason, usize>,
    /// Rows of trials that name no trial or no response: the study asks for nothing of the kind.
    #[serde(skip_serializing_if = "is_zero")]
    pub rows_unread: usize,
    /// Trials used.
    pub trials_used: usize,
    /// Rows of pilot sessions left out because there are live ones.
    pub pilot_people: usize,
    /// Rules of the study file.
    pub rules: Vec<Rule>,
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl Flow {
    /// Why no trial is left.
    pub(crate) fn no_trial(&self) -> ExportError {
        let reasons = self.people_left_out.iter().chain(&self.trials_left_out);
        ExportError::NoTrial {
            people_left_out: self.people - self.people_used,
            people: self.people,
            trials_left_out: self.trials - self.trials_used,
            trials: self.trials,
            reasons: reasons.map(|(&reason, &count)| (reason, count)).collect(),
        }
    }
}

/// A study's answers.
#[derive(Debug, Clone)]
pub(crate) struct Export {
    pub people: Vec<Person>,
    pub trials: Vec<Trial>,
    /// Trials that the rules exclude, of people who are used.
    pub excluded_trials: Vec<ExcludedTrial>,
    /// Answers to each question that was answered in trials, in the order of the file.
    pub answers: BTreeMap<String, Vec<Answer>>,
    /// Answers on pages to the items of the study's scales, by item and person.
    pub page_answers: BTreeMap<String, Vec<Option<f64>>>,
    /// Names of the factors.
    pub factors: Vec<String>,
    /// Answers about each person, and the assigned condition: column, then one cell a person.
    pub about: Vec<(String, Vec<Option<String>>)>,
    pub flow: Flow,
    /// Whom BS.1534 leaves out of panels, a block each that has a hidden reference.
    pub screening: Vec<Screening>,
    /// Of the trials; found when first asked for.
    pub(super) combinations: OnceLock<Combinations>,
}

/// In the place of the status of somebody whom the researcher excluded.
pub(super) const EXCLUDED: &str = "excluded";

/// Columns that must be there.
const NEEDED: [&str; 5] = ["participant_id", "trial_id", "trial_type", "response_id", "answer"];

impl Export {
    /// Without people, trials and answers yet.
    pub(crate) fn new(factors: Vec<String>, about: Vec<(String, Vec<Option<String>>)>) -> Self {
        Self {
            people: Vec::new(),
            trials: Vec::new(),
            excluded_trials: Vec::new(),
            answers: BTreeMap::new(),
            page_answers: BTreeMap::new(),
            factors,
            about,
            flow: Flow::default(),
            screening: Vec::new(),
            combinations: OnceLock::new(),
        }
    }

    /// Answers to a question, in the order of the file.
    pub(crate) fn answers_to(&self, question: &str) -> &[Answer] {
        self.answers.get(question).map_or(&[], Vec::as_slice)
    }

    /// The answers to every question.
    pub(crate) fn all_answers(&self) -> impl Iterator<Item = &[Answer]> {
        self.answers.values().map(Vec::as_slice)
    }

    /// The combinations of levels that the trials have. The trials must be complete.
    pub(crate) fn combinations(&self) -> &Combinations {
        self.combinations.get_or_init(|| Combinations::of(&self.trials))
    }

    /// Reads the tidy form and applies the study's exclusions.
    pub(crate) fn read(table: &Table, study: &Study) -> Result<Self, ExportError> {
        if let Some(missing) = NEEDED.iter().find(|name| !table.has(name)) {
            return Err(ExportError::NoColumn { column: missing });
        }
        let mut sessions = Sessions::read(table)?;
        count_runs(table, study, &sessions.person_of_row, &mut sessions.people)?;
        let mut flow = exclude_people(study, &mut sessions.people, &sessions.stages);
        let Sessions { mut people, person_of_row, reasons, .. } = sessions;
        let screening = screen(table, study, &person_of_row, &mut people, &mut flow)?;
        for (person, reason) in people.iter().zip(&reasons) {
            if let (Some(Reason::ByResearcher), Some(reason)) = (person.excluded, reason) {
                *flow.researcher_reasons.entry((*reason).to_owned()).or_insert(0) += 1;
            }
        }
        let factors = study.factor_names().into_iter().filter(|name| table.has(name)).collect();
        let about = about_people(table, study, &person_of_row, people.len());
        let mut export = Self { people, flow, screening, ..Self::new(factors, about) };
        export.read_trials(table, study, &person_of_row)?;
        export.page_answers = on_pages(table, study, &person_of_row, export.people.len())?;
        Ok(export)
    }

    fn read_trials(
        &mut self,
        table: &Table,
        study: &Study,
        person_of_row: &[usize],
    ) -> Result<(), ExportError> {
        let reader = TrialReader::new(table, study, self, person_of_row);
        let stretches = stretches(person_of_row).into_par_iter();
        let parts: Vec<Result<TrialRows, ExportError>> =
            stretches.map(|rows| reader.read(rows)).collect();
        for part in parts {
            let part = part?;
            for person in part.person_of_trial {
                self.people[person].trials += 1;
            }
            self.flow.trials += part.considered;
            self.flow.rows_unread += part.unread;
            for (reason, count) in part.left_out {
                *self.flow.trials_left_out.entry(reason).or_insert(0) += count;
            }
            self.excluded_trials.extend(part.excluded);
            let before = self.trials.len();
            self.trials.extend(part.trials);
            for (question, answers) in part.answers {
                let own = self.answers.entry(question).or_default();
                own.extend(
                    answers
                        .into_iter()
                        .map(|answer| Answer { trial: before + answer.trial, ..answer }),
                );
            }
        }
        self.flow.trials_used = self.trials.len();
        Ok(())
    }

    /// Level of a factor in an answer's trial.
    pub(crate) fn level(&self, answer: &Answer, factor: &str) -> Option<&str> {
        let place = self.factors.iter().position(|name| name == factor)?;
        self.trials[answer.trial].levels[place].as_deref()
    }
}

/// Why a trial is left out, if it is: its first reason. `quickest_ms` is its shortest response time.
pub(crate) fn why_left_out(
    rules: &Exclusions,
    trial: &Trial,
    quickest_ms: Option<f64>,
) -> Option<Reason> {
    let share = match (trial.late, trial.frames) {
        (Some(late), Some(frames)) if frames > 0.0 => Some(late / frames),
        _ => None,
    };
    let over = |value: Option<f64>, limit: Option<f64>| matches!((value, limit), (Some(value), Some(limit)) if value > limit);
    let quick =
        matches!((quickest_ms, rules.shortest_rt_ms), (Some(rt), Some(limit)) if rt < limit);
    if over(share, rules.late_frame_share) {
        Some(Reason::LateFrames)
    } else if over(trial.longest_ms, rules.longest_frame_ms) {
        Some(Reason::LongFrame)
    } else if over(trial.sound_off_ms, rules.sound_offset_ms) {
        Some(Reason::SoundOffset)
    } else if quick {
        Some(Reason::AnsweredTooSoon)
    } else {
        None
    }
}

/// Marks the people whom the rules leave out, and counts them.
pub(crate) fn exclude_people(study: &Study, people: &mut [Person], stages: &[&str]) -> Flow {
    let rules = study.exclusions.clone().unwrap_or_default();
    let live = stages.iter().any(|stage| *stage != "pilot");
    let mut flow = Flow { people: people.len(), rules: Rule::of(study), ..Flow::default() };
    for (person, stage) in people.iter_mut().zip(stages) {
        let standing = Standing::from_export_word(&person.status);
        person.excluded = if live && *stage == "pilot" {
            flow.pilot_people += 1;
            Some(Reason::Pilot)
        } else if standing == Some(Standing::Withdrawn) {
            Some(Reason::Withdrawn)
        } else if standing == Some(Standing::Declined) {
            Some(Reason::Declined)
        } else if person.status == EXCLUDED {
            Some(Reason::ByResearcher)
        } else if rules.incomplete && standing != Some(Standing::Completed) {
            Some(match standing {
                Some(screened_out) if screened_out.is_screened_out() => Reason::ScreenedOut,
                Some(Standing::ChecksFailed) => Reason::AttentionChecks,
                _ => Reason::Incomplete,
            })
        } else if rules
            .failed_attention_checks
            .is_some_and(|limit| person.failed_checks > limit as usize)
        {
            Some(Reason::AttentionChecks)
        } else if rules.sound_not_heard && !person.heard {
            Some(Reason::SoundNotHeard)
        } else if rules
            .straight_lining
            .as_ref()
            .is_some_and(|rule| person.longest_run > rule.longest_run as usize)
        {
            Some(Reason::StraightLining)
        } else {
            None
        };
        if let Some(reason) = person.excluded {
            *flow.people_left_out.entry(reason).or_insert(0) += 1;
        }
    }
    flow.people_used = people.iter().filter(|person| person.excluded.is_none()).count();
    flow
}
