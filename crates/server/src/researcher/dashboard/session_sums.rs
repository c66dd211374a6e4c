//! What the dashboard counts of one session: made of its record, which is the one fold of its events.

use std::collections::{BTreeMap, BTreeSet};

use mimique_session::Record;
use mimique_session::flow::{Plan, StepKind};
use mimique_session::rows::TidyForm;
use mimique_storage::{CountedEvent, SessionRecord, Storage, StorageError};
use mimique_study::{
    FactorValue, PairCounts, PairsComponent, Study, StudyProjection, component_of,
};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tokio_stream::StreamExt as _;

use super::tally::{Counting, Tally, chosen_of, level_of, threshold_of};
use crate::export::sources::{Version, as_started};

/// The form of the sums that are kept of a session, and of what they are made by. Whoever changes either counts it up:
/// what was kept in another form is made anew.
pub const FORM: i64 = 4;

/// What is counted of one session. No text that was written is in it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct SessionSums {
    /// Steps done and steps there are; none where the plan cannot be made any more.
    pub progress: Option<(usize, usize)>,
    /// The step on the screen.
    pub step: String,
    /// Answers of every finished page and trial, practice left out, by response.
    pub answers: BTreeMap<String, Tally>,
    /// Clips shown in finished trials, by factor and level: both of a pair.
    pub levels: BTreeMap<String, BTreeMap<String, u64>>,
    /// Place of every finished trial, practice left out, and how long it took, milliseconds.
    pub trials: Vec<(u64, Option<f64>)>,
    /// Frames shown in them.
    pub frames: u64,
    /// Frames that came late.
    pub late: u64,
    /// How often each attention check was passed and failed.
    pub checks: BTreeMap<String, [u64; 2]>,
    /// Choices between two levels, by block of pairs.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub pairs: BTreeMap<String, PairCounts>,
    /// Class of the device: the platform as the page names it.
    pub device: String,
}

/// Counts the sessions of one version of a study.
pub(crate) struct Counter {
    pub projection: StudyProjection,
    form: TidyForm,
    /// How answers to each response are counted.
    counting: BTreeMap<String, Counting>,
    /// Levels of the factors of each clip, which may stand beside another.
    levels: BTreeMap<String, BTreeMap<String, String>>,
    /// The question that chooses, by block of pairs.
    choices: BTreeMap<String, String>,
    places: Places,
}

/// Places of the columns that are counted.
struct Places {
    trial_type: usize,
    trial_id: usize,
    trial_order: usize,
    beside: usize,
    response_id: usize,
    answer: usize,
    /// Where the study has blocks of pairs: the levels left and right, and the chosen one.
    items: Option<[usize; 3]>,
    /// Where the study has adaptive blocks: the track, the level, whether no track counts it, and what is known of the
    /// threshold.
    levels: Option<[usize; 4]>,
    attention_passed: usize,
    duration: usize,
    frames: usize,
    frames_late: usize,
    factors: Vec<(String, usize)>,
}

impl Places {
    /// Every study has these columns, or its form is a mistake of ours.
    fn of(form: &TidyForm, study: &Study) -> Option<Self> {
        let place = |name: &str| form.columns().iter().position(|column| column.name == name);
        let factors = study.factor_names().into_iter();
        Some(Self {
            trial_type: place("trial_type")?,
            trial_id: place("trial_id")?,
            trial_order: place("trial_order")?,
            beside: place("beside")?,
            response_id: place("response_id")?,
            answer: place("answer")?,
            items: place("item_left")
                .zip(place("item_right"))
                .zip(place("item_chosen"))
                .map(|((left, right), chosen)| [left, right, chosen]),
            levels: place("track")
                .zip(place("level"))
                .zip(place("level_catch").zip(place("posterior_mean")))
                .map(|((track, level), (catch, mean))| [track, level, catch, mean]),
            attention_passed: place("attention_passed")?,
            duration: place("duration")?,
            frames: place("frames")?,
            frames_late: place("frames_late")?,
            factors: factors.filter_map(|name| Some((name.clone(), place(&name)?))).collect(),
        })
    }
}

impl Counter {
    /// Counts the sessions of this version; none where it has not the columns that every version has.
    pub fn new(version: &Version) -> Option<Self> {
        let form = TidyForm::new(&version.study, &version.clips);
        let places = Places::of(&form, &version.study)?;
        let counting = Counting::of(&version.study);
        let of = |(name, block): (&str, PairsComponent)| (name.to_owned(), block.question);
        let choices = version.study.pair_blocks().map(of).collect();
        let level = |(name, level): (&String, &FactorValue)| (name.clone(), level.to_string());
        let clips = version.study.clips();
        let levels =
            clips.iter().map(|clip| (clip.id.clone(), clip.factors.iter().map(level).collect()));
        let levels = levels.collect();
        Some(Self {
            projection: version.study.projection(),
            form,
            counting,
            levels,
            choices,
            places,
        })
    }

    /// The sums of a session, whose events are read one by one.
    pub async fn count(
        &self,
        storage: &Storage,
        session: &SessionRecord,
    ) -> Result<SessionSums, StorageError> {
        let started = as_started(session);
        let plan = Plan::new(self.projection.clone(), started.clone()).ok();
        // Where somebody is follows from the plan; what was answered is kept whatever the plan is.
        let (mut planned, mut record) = (Record::default(), Record::default());
        let mut events = storage.counted_events(session.key, session.next_sequence);
        while let Some(event) = events.next().await {
            let CountedEvent { sequence, at_ms, kind } = event?;
            if plan.is_some() {
                planned.add(plan.as_ref(), sequence, at_ms, kind.clone());
            }
            record.add(None, sequence, at_ms, kind);
        }
        let rows = self.form.rows(&started, &record);
        let mut sums = SessionSums { device: device(&session.client), ..SessionSums::default() };
        if let Some(plan) = &plan {
            let here = planned.step.min(plan.steps.len());
            sums.progress = Some((here, plan.steps.len()));
            sums.step = plan.step(here).map_or_else(String::new, |step| match &step.kind {
                StepKind::Trial(trial) if trial.training => format!("practice {}", trial.number),
                StepKind::Trial(trial) => format!("trial {}: {}", trial.number, trial.clip),
                _ => step.id.clone(),
            });
        }
        self.count_rows(&rows, &mut sums);
        Ok(sums)
    }

    fn count_rows(&self, rows: &[Vec<Value>], sums: &mut SessionSums) {
        let places = &self.places;
        let mut counted = BTreeSet::new();
        // Question, track -> the last of a person's thresholds so far, or of the levels of a staircase.
        let mut thresholds: BTreeMap<(String, u64), f64> = BTreeMap::new();
        for row in rows {
            let text = |place: usize| row[place].as_str().unwrap_or_default();
            let count = |place: usize| row[place].as_u64().unwrap_or_default();
            let (kind, response) = (text(places.trial_type), text(places.response_id));
            if let Some(passed) = row[places.attention_passed].as_bool() {
                let check = sums.checks.entry(response.to_owned()).or_default();
                check[usize::from(!passed)] += 1;
            }
            if kind == "training" {
                continue;
            }
            if !row[places.answer].is_null() {
                let by = self.counting.get(response).copied().unwrap_or(Counting::Texts);
                let tally = sums.answers.entry(response.to_owned()).or_default();
                tally.count(&row[places.answer], by);
                if let Some([track, level, catch, mean]) = places.levels
                    && let Some(track) = row[track].as_u64()
                    && row[catch] != Value::Bool(true)
                {
                    let (name, number) = match row[mean].as_f64() {
                        Some(mean) => (threshold_of(response), Some(mean)),
                        None => (level_of(response), row[level].as_f64()),
                    };
                    if let Some(number) = number {
                        thresholds.insert((name, track), number);
                    }
                }
                if let Some([left, right, chosen]) = places.items {
                    let level = &row[chosen];
                    if !level.is_null() {
                        let tally = sums.answers.entry(chosen_of(response)).or_default();
                        tally.count(level, Counting::Values);
                    }
                    let block = component_of(text(places.trial_id));
                    if self.choices.get(block).is_some_and(|question| question == response) {
                        let own = sums.pairs.entry(block.to_owned()).or_default();
                        own.chosen([left, right].map(text), level.as_str());
                    }
                }
            }
            // A trial has a row for each answer; it is one trial all the same.
            if kind == "trial" && counted.insert(text(places.trial_id)) {
                let duration_ms = row[places.duration].as_f64();
                sums.trials.push((count(places.trial_order), duration_ms));
                sums.frames += count(places.frames);
                sums.late += count(places.frames_late);
                let beside = self.levels.get(text(places.beside));
                for (factor, place) in &places.factors {
                    let own = match &row[*place] {
                        Value::Null => None,
                        Value::String(level) => Some(level.clone()),
                        other => Some(other.to_string()),
                    };
                    let other = beside.and_then(|beside| beside.get(factor)).cloned();
                    for level in own.into_iter().chain(other) {
                        let levels = sums.levels.entry(factor.clone()).or_default();
                        *levels.entry(level).or_default() += 1;
                    }
                }
            }
        }
        let mut people: BTreeMap<String, (f64, u32)> = BTreeMap::new();
        for ((name, _), threshold) in thresholds {
            let (sum, tracks) = people.entry(name).or_default();
            (*sum, *tracks) = (*sum + threshold, *tracks + 1);
        }
        for (name, (sum, tracks)) in people {
            let mean = Value::from(sum / f64::from(tracks));
            sums.answers.entry(name).or_default().count(&mean, Counting::Numbers);
        }
    }
}

/// What the page said of its platform: `Windows`, `Android`…
fn device(client: &str) -> String {
    let about: BTreeMap<String, String> = serde_json::from_str(client).unwrap_or_default();
    about.get("platform").cloned().unwrap_or_default()
}
