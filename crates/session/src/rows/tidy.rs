//! The tidy form: one row a participant x trial x response.

use std::collections::{BTreeMap, HashMap};

use serde_json::Value;

use super::SessionRecord;
use super::cells::{answer_cells, milliseconds, plain};
use super::column::{Column, Table};
use super::faces::{self, face_cells};
use super::levels::{Blocks, level_cells, replay};
use super::pairs::{self, chosen_item, pair_cells};
use super::panels;
use super::scaling::Scalings;
use super::step_cells::{Cells, StepType};
use super::study_columns::{assigned_column, conditions_of, factor_column, question_columns};
use crate::record::{EarlyEnd, EndReason, FinishedStep, Record};
use crate::tracked_face::MIMICRY_STEP;
use crate::wire::SessionStarted;
use mimique_study::columns::{
    ASSIGNED_CONDITION, FIXED_COLUMNS, LEVEL_COLUMNS, MIMICRY_COLUMNS, PAIR_COLUMNS, PANEL_COLUMNS,
    SCALING_COLUMNS, SOUND_COLUMNS, TRACE_COLUMN, TRAJECTORIES_COLUMN, TRIGGER_COLUMN,
    WEIGHTS_EXPECTED_COLUMN,
};
use mimique_study::{
    Answers, Clip, ClipSource, KindOfQuestion as _, Multilingual as _, Question, Study, alike,
    iso_time,
};

/// The tidy form. `clips` are the study's clips as the server prepared them; a session of another
/// version of the study keeps its rows, with the factors that are still known.
pub fn tidy<'a>(
    study: &Study,
    clips: &BTreeMap<String, ClipSource>,
    sessions: impl IntoIterator<Item = SessionRecord<'a>>,
) -> Table {
    let form = TidyForm::new(study, clips);
    // The study may be another version than the session's: what it answered is kept all the same.
    let rows =
        |session: SessionRecord<'_>| form.rows(session.started, &Record::of(None, session.events));
    let rows = sessions.into_iter().flat_map(rows).collect();
    Table { columns: form.columns, rows }
}

/// The tidy form of a version of a study: what is the same for all its sessions, made once.
#[derive(Debug, Clone)]
pub struct TidyForm {
    study: Study,
    /// Provenance of each clip as it is served.
    pub(super) served: BTreeMap<String, String>,
    pub(super) clips: BTreeMap<String, Clip>,
    /// Adaptive blocks.
    blocks: Blocks,
    /// The blocks of reverse correlation, by name.
    faces: faces::Blocks,
    /// The blocks of difference scaling.
    scalings: Scalings,
    /// The blocks of pairs, by name.
    pairs: pairs::Blocks,
    /// The blocks of panels, by name.
    pub(super) panels: panels::Blocks,
    /// Hash of the weights of each clip as they were solved beforehand.
    weights: BTreeMap<String, String>,
    /// Of a participant's condition (none: everybody's) and a component.
    pub(super) conditions: BTreeMap<(Option<String>, String), String>,
    columns: Vec<Column>,
    /// Place of each column.
    places: HashMap<String, usize>,
}

impl TidyForm {
    /// The form of a version of a study and its clips as they were prepared.
    pub fn new(study: &Study, clips: &BTreeMap<String, ClipSource>) -> Self {
        let factors = study.factor_names();
        let mut columns = Vec::new();
        let column = |(name, kind, unit, description): (&str, _, &str, &str)| {
            let mut column = Column::new(name, kind, description);
            column.unit = (!unit.is_empty()).then(|| unit.to_owned());
            column
        };
        let has_sound = study.has_sound();
        let blocks: Blocks =
            study.adaptive().map(|(name, block)| (name.to_owned(), block)).collect();
        let pairs: pairs::Blocks =
            study.pair_blocks().map(|(name, block)| (name.to_owned(), block)).collect();
        let panels: panels::Blocks =
            study.panel_blocks().map(|(name, block)| (name.to_owned(), block)).collect();
        let faces = faces::blocks(study, clips);
        let scalings = Scalings::of(study);
        for fixed in FIXED_COLUMNS {
            let name = fixed.0;
            columns.push(column(fixed));
            if name == "beside_drift_ms" && has_sound {
                columns.extend(SOUND_COLUMNS.map(column));
            }
            if name == "beside_drift_ms" && study.mimicry.is_some() {
                columns.extend(MIMICRY_COLUMNS.map(column));
            }
            if name == "beside_drift_ms" && study.triggers.is_some() {
                columns.push(column(TRIGGER_COLUMN));
            }
            if name == "chosen" && !blocks.is_empty() {
                columns.extend(LEVEL_COLUMNS.map(column));
            }
            if name == "chosen" && !faces.is_empty() {
                columns.push(column(TRAJECTORIES_COLUMN));
            }
            if name == "chosen" && !scalings.is_empty() {
                columns.extend(SCALING_COLUMNS.map(column));
            }
            let is_known = !(blocks.is_empty() && faces.is_empty() && scalings.is_empty());
            if name == "chosen" && is_known {
                columns.push(column(WEIGHTS_EXPECTED_COLUMN));
            }
            if name == "chosen" && !pairs.is_empty() {
                columns.extend(PAIR_COLUMNS.map(column));
            }
            if name == "answer" && study.all_questions().any(|asked| asked.kind.is_traced()) {
                columns.push(column(TRACE_COLUMN));
            }
            if name == "chosen" && !panels.is_empty() {
                columns.extend(PANEL_COLUMNS.map(column));
            }
            if name == "condition" {
                columns.extend(assigned_column(study));
            }
            if name == "stimulus" {
                columns.extend(factors.iter().map(|factor| factor_column(study, factor)));
            }
        }
        for question in study.demographics.iter().flat_map(|page| &page.questions) {
            columns.extend(question_columns(question, study.default_language()));
        }
        let mut places = HashMap::with_capacity(columns.len());
        for (place, column) in columns.iter().enumerate() {
            places.entry(column.name.clone()).or_insert(place);
        }
        let mut conditions = BTreeMap::new();
        conditions_of(&study.sequence, (None, None), &mut conditions);
        let weights = clips.iter().map(|(id, source)| (id.clone(), source.weights_hash.clone()));
        let served = clips.iter().map(|(id, source)| (id.clone(), source.provenance.clone()));
        Self {
            study: study.clone(),
            served: served.collect(),
            clips: study
                .clips()
                .into_iter()
                .chain(study.level_clips().into_iter().map(|level| level.clip))
                .chain(study.clips_at_rest().into_iter().map(|(clip, _)| clip))
                .map(|clip| (clip.id.clone(), clip))
                .collect(),
            blocks,
            faces,
            scalings,
            pairs,
            panels,
            weights: weights.collect(),
            conditions,
            columns,
            places,
        }
    }

    /// Place of a column.
    pub(super) fn place(&self, name: &str) -> Option<usize> {
        self.places.get(name).copied()
    }

    /// The columns of the rows.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The rows of a session, of the record that was made without a plan.
    pub fn rows(&self, started: &SessionStarted, record: &Record) -> Vec<Vec<Value>> {
        let mut rows = Vec::new();
        let common = self.personal_cells(started, record);
        let (mut trials, mut trainings) = (0_u64, 0_u64);
        let levels = replay(&self.blocks, started, record);
        let mut earlier = Answers::new();
        for (index, step) in record.finished.iter().enumerate() {
            let kind = StepType::of(step);
            let order = match kind {
                StepType::Trial => count(&mut trials),
                StepType::Training => count(&mut trainings),
                _ => Value::Null,
            };
            let mut cells = common.clone();
            self.step_cells(record, step, kind, &mut cells);
            if let Some(replayed) = levels.get(&index) {
                level_cells(step, replayed, &self.weights, &mut cells);
            }
            face_cells(step, &self.faces, started, &mut cells);
            self.scalings.cells(step, &self.weights, &mut cells);
            pair_cells(step, &self.pairs, &self.clips, &mut cells);
            cells.put("trial_index", index.into());
            cells.put("trial_order", order);
            self.each_response(step, &earlier, |response| {
                let mut cells = cells.clone();
                if let Some(clip) = response.clip {
                    self.panel_cells(step, clip, &mut cells);
                }
                rows.push(self.row(cells, step, response));
            });
            step.keep_answers(&mut earlier);
        }
        if let Some(end) = &record.early_end {
            rows.push(self.end_row(record, end, common));
        }
        rows
    }

    /// The trial and the response of each row that [`Self::rows`] has of a record, and whether the trial is
    /// the page about the participant.
    pub(super) fn responses(&self, record: &Record) -> Vec<(String, String, bool)> {
        let mut found = Vec::new();
        let mut earlier = Answers::new();
        for step in &record.finished {
            let is_demographics = StepType::of(step) == StepType::Demographics;
            self.each_response(step, &earlier, |response| {
                // Of a panel the name that tells its clips apart.
                let id = response.clip.map_or(response.id, |_| response.kept.to_owned());
                found.push((step.id.clone(), id, is_demographics));
            });
            step.keep_answers(&mut earlier);
        }
        let end = record.early_end.iter();
        found.extend(end.map(|end| (end.step.clone(), end_word(end).to_owned(), false)));
        found
    }

    /// What is the same in every row of a session.
    fn personal_cells(&self, started: &SessionStarted, record: &Record) -> Cells<'_> {
        let mut cells = Cells { form: self, row: vec![Value::Null; self.columns.len()] };
        cells.put("participant_id", started.participant_id.as_str().into());
        cells.put("participant", started.participant.into());
        cells.put("slot", started.slot().into());
        cells.put(ASSIGNED_CONDITION, started.condition.as_deref().into());
        cells.put("stage", started.stage.as_str().into());
        cells.put("status", record.standing.export_word().into());
        cells.put("seed", started.seed.into());
        cells.put("config_hash", started.config_hash.as_str().into());
        cells.put("language", record.language.as_str().into());
        cells.put("consent_version", record.consent_version.as_deref().into());
        let is_scripted = |step: &&FinishedStep| ["sound", MIMICRY_STEP].contains(&&*step.id);
        for page in record.finished.iter().filter(is_scripted) {
            for (name, answer) in &page.answers {
                cells.put(name, plain(Some(answer)));
            }
        }
        if let Some(page) = record.finished.iter().find(|step| step.id == "demographics") {
            for question in self.study.demographics.iter().flat_map(|page| &page.questions) {
                let answer = page.answers.get(&question.id).unwrap_or(&Value::Null);
                for (suffix, cell) in answer_cells(question, answer) {
                    cells.put(&format!("{}{suffix}", question.id), cell);
                }
            }
        }
        cells
    }

    /// The row that says why a session ended before its last page.
    fn end_row(&self, record: &Record, end: &EarlyEnd, mut cells: Cells<'_>) -> Vec<Value> {
        let mut put = |name: &str, value: Value| cells.put(name, value);
        put("trial_id", end.step.as_str().into());
        put("trial_type", "screening".into());
        put("trial_index", record.finished.len().into());
        put("time_elapsed", milliseconds(end.at_ms - record.opened_ms));
        put("end_time", iso_time(end.at_ms).into());
        let about: Vec<&str> = record.client.about.values().map(String::as_str).collect();
        put("browser", about.join(" ").into());
        let [width, height] = record.client.viewport;
        put("viewport", format!("{width}x{height}").into());
        let why: Value = match &end.reason {
            EndReason::ScreenedOut { by, details } if details.is_empty() => by.as_str().into(),
            EndReason::ScreenedOut { by, details } => {
                format!("{by}: {}", details.join(", ")).into()
            }
            EndReason::ChecksFailed { failed } => (*failed).into(),
        };
        put("response_id", end_word(end).into());
        put("answer", why.clone());
        put("response", why);
        cells.row
    }

    /// Gives each response of a step, in the order of its questions, given the answers of the pages before
    /// it.
    fn each_response(
        &self,
        step: &FinishedStep,
        earlier: &Answers,
        mut take: impl FnMut(Response<'_>),
    ) {
        let questions = self.study.questions_of(&step.id);
        let rated = self.rated(step);
        for rated in &rated {
            let asked = questions.iter().find(|question| question.id == rated.question);
            take(Response {
                id: rated.question.to_owned(),
                kept: &rated.kept,
                clip: Some(rated.clip),
                asked: asked.map(|question| (*question, rated.answer)),
                cell: plain(Some(rated.answer)),
            });
        }
        let of_panel = |id: &str| rated.iter().any(|rated| rated.question == id);
        for question in questions.iter().filter(|question| !of_panel(&question.id)) {
            let answer = step.answers.get(&question.id);
            if answer.is_none() && !question.is_shown(&step.answers, earlier) {
                continue;
            }
            let answer = answer.unwrap_or(&Value::Null);
            for (suffix, cell) in answer_cells(question, answer) {
                let id = format!("{}{suffix}", question.id);
                take(Response {
                    id,
                    kept: &question.id,
                    clip: None,
                    asked: Some((question, answer)),
                    cell,
                });
            }
        }
        // Answers to questions that this version of the study no longer asks.
        for (id, answer) in &step.answers {
            let is_known = questions.iter().any(|question| question.id == *id)
                || rated.iter().any(|rated| rated.kept == *id);
            if !is_known {
                let cell = plain(Some(answer));
                take(Response { id: id.clone(), kept: id, clip: None, asked: None, cell });
            }
        }
    }

    /// Whether the answer is right, and whether an attention check was passed.
    fn judge(&self, question: &Question, step: &FinishedStep, answer: &Value, row: &mut Cells<'_>) {
        if let Some(factor) = question.kind.truth()
            && let Some(clip) = step.clip.as_ref().and_then(|clip| self.clips.get(clip))
            && let Some(truth) = clip.factor_text(factor)
        {
            if !answer.is_null() {
                let correct = answer.as_str() == Some(truth.as_str());
                row.put("correct", correct.into());
            }
            row.put("truth", truth.into());
        }
        if question.kind.compares_clips()
            && let (Some(clip), Some(beside)) = (&step.clip, &step.attempt.beside)
        {
            let chosen = match answer.as_str() {
                Some("left") if beside.left => Some(beside.clip.as_str()),
                Some("right") if !beside.left => Some(beside.clip.as_str()),
                Some("left" | "right") => Some(clip.as_str()),
                _ => None,
            };
            row.put("chosen", chosen.into());
            chosen_item((step, &question.id), chosen, &self.pairs, &self.clips, row);
        }
        if let Some(check) = &question.attention_check {
            let passed = alike(answer, &check.expected);
            row.put("attention_passed", passed.into());
        }
    }

    /// The row of a response; the cells are those of its step.
    fn row(&self, mut cells: Cells<'_>, step: &FinishedStep, response: Response<'_>) -> Vec<Value> {
        let Response { id, kept, clip: _, asked, cell } = response;
        cells.put("response_id", id.into());
        if let Some((asked, answer)) = asked {
            self.judge(asked, step, answer, &mut cells);
            if asked.kind.is_traced() && !answer.is_null() {
                cells.put(TRACE_COLUMN.0, answer.to_string().into());
            }
        }
        let onset_ms = step.attempt.play.as_ref().map_or(step.start_ms, |play| play.onset_ms);
        let answered_ms = step.attempt.answered_ms.get(kept).filter(|_| !cell.is_null());
        // Keys can be pressed from the first frame on.
        let is_keyed = asked.is_some_and(|(question, _)| question.kind.keys().is_some());
        let opened_ms =
            step.attempt.answering_ms.map(|at_ms| if is_keyed { onset_ms } else { at_ms });
        let open = answered_ms.zip(opened_ms).map(|(at_ms, open)| at_ms - open);
        cells.put("rt_open", open.map_or(Value::Null, milliseconds));
        let rt = step.attempt.answered_ms.get(kept).map(|at_ms| at_ms - onset_ms);
        // An answer without an event of its own takes the time at which all were sent.
        let rt = rt.filter(|_| !cell.is_null()).or(step.rt_ms.filter(|_| !cell.is_null()));
        cells.put("rt", rt.map_or(Value::Null, milliseconds));
        cells.put("response", cell.clone());
        cells.put("answer", cell);
        cells.row
    }
}

/// A response of a step.
struct Response<'r> {
    /// Identifier of the response: the question's, and that of its part.
    id: String,
    /// The name under which the answer is kept: the question's, and of a panel the clip's.
    kept: &'r str,
    /// The clip that it is about, of a panel.
    clip: Option<&'r str>,
    /// The question and its whole answer; none where the study no longer asks it.
    asked: Option<(&'r Question, &'r Value)>,
    /// What was answered.
    cell: Value,
}

/// The response of the row that says why a session ended early.
fn end_word(end: &EarlyEnd) -> &'static str {
    match &end.reason {
        EndReason::ScreenedOut { .. } => "screened_out",
        EndReason::ChecksFailed { .. } => "failed_checks",
    }
}

fn count(counter: &mut u64) -> Value {
    *counter += 1;
    (*counter).into()
}
