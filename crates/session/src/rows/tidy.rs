//! The tidy form: one row a participant x trial x response.

use std::collections::BTreeMap;

use serde_json::Value;

use super::SessionRecord;
use super::cells::{answer_cells, milliseconds, number, plain};
use super::column::{Column, Table};
use super::study_columns::{assigned_column, factor_column, question_columns};
use crate::event::PlayLog;
use crate::record::{EarlyEnd, EndReason, FinishedStep, Record};
use mimique_study::columns::{ASSIGNED_CONDITION, FIXED_COLUMNS};
use mimique_study::{
    Answers, Clip, ClipSource, KindOfQuestion as _, Multilingual as _, Question, Sequence,
    SequenceItem, Study, alike, component_of, iso_time,
};

/// The tidy form. `clips` are the study's clips as the server prepared them; a session of another
/// version of the study keeps its rows, with the factors that are still known.
pub fn tidy<'a>(
    study: &Study,
    clips: &BTreeMap<String, ClipSource>,
    sessions: impl IntoIterator<Item = SessionRecord<'a>>,
) -> Table {
    let layout = Layout::new(study, clips);
    let mut rows = Vec::new();
    for session in sessions {
        layout.session(&session, &mut rows);
    }
    Table { columns: layout.columns, rows }
}

/// What is the same for every session.
struct Layout<'a> {
    study: &'a Study,
    sources: &'a BTreeMap<String, ClipSource>,
    clips: BTreeMap<String, Clip>,
    demographics: Vec<&'a Question>,
    /// Of a participant's condition (none: everybody's) and a component.
    conditions: BTreeMap<(Option<String>, String), String>,
    columns: Vec<Column>,
}

/// Cells by column name, put in order at the end.
type Cells = BTreeMap<String, Value>;

impl<'a> Layout<'a> {
    fn new(study: &'a Study, sources: &'a BTreeMap<String, ClipSource>) -> Self {
        let factors = study.factor_names();
        let demographics: Vec<&Question> =
            study.demographics.iter().flat_map(|page| &page.questions).collect();
        let mut columns = Vec::new();
        for (name, kind, unit, description) in FIXED_COLUMNS {
            let mut column = Column::new(name, kind, description);
            column.unit = (!unit.is_empty()).then(|| unit.to_owned());
            columns.push(column);
            if name == "condition" {
                columns.extend(assigned_column(study));
            }
            if name == "stimulus" {
                columns.extend(factors.iter().map(|factor| factor_column(study, factor)));
            }
        }
        for question in &demographics {
            columns.extend(question_columns(question, study.default_language()));
        }
        let mut conditions = BTreeMap::new();
        conditions_of(&study.sequence, (None, None), &mut conditions);
        let clips = study.clips().into_iter().map(|clip| (clip.id.clone(), clip)).collect();
        Self { study, sources, clips, demographics, conditions, columns }
    }

    fn session(&self, session: &SessionRecord<'_>, rows: &mut Vec<Vec<Value>>) {
        // The study may be another version than the session's: what it answered is kept all the same.
        let record = Record::of(None, session.events);
        let mut common = Cells::new();
        let mut put = |name: &str, value: Value| common.insert(name.to_owned(), value);
        put("participant_id", session.started.participant_id.as_str().into());
        put("participant", session.started.participant.into());
        put("slot", session.started.slot().into());
        put(ASSIGNED_CONDITION, session.started.condition.as_deref().into());
        put("stage", session.started.stage.as_str().into());
        put("status", record.standing.export_word().into());
        put("seed", session.started.seed.into());
        put("config_hash", session.started.config_hash.as_str().into());
        put("language", record.language.as_str().into());
        put("consent_version", record.consent_version.as_deref().into());
        if let Some(page) = record.finished.iter().find(|step| step.id == "demographics") {
            for question in &self.demographics {
                let answer = page.answers.get(&question.id).unwrap_or(&Value::Null);
                for (suffix, cell) in answer_cells(question, answer) {
                    put(&format!("{}{suffix}", question.id), cell);
                }
            }
        }
        let (mut trials, mut trainings) = (0_u64, 0_u64);
        let mut earlier = Answers::new();
        for (index, step) in record.finished.iter().enumerate() {
            let kind = self.kind(step);
            let order = match kind {
                StepType::Trial => count(&mut trials),
                StepType::Training => count(&mut trainings),
                _ => Value::Null,
            };
            let mut cells = common.clone();
            self.step_cells(&record, step, kind, &mut cells);
            cells.insert("trial_index".to_owned(), index.into());
            cells.insert("trial_order".to_owned(), order);
            self.answer_rows(step, &earlier, &cells, rows);
            step.keep_answers(&mut earlier);
        }
        if let Some(end) = &record.early_end {
            rows.push(self.end_row(&record, end, common));
        }
    }

    /// The row that says why a session ended before its last page.
    fn end_row(&self, record: &Record, end: &EarlyEnd, mut cells: Cells) -> Vec<Value> {
        let mut put = |name: &str, value: Value| cells.insert(name.to_owned(), value);
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
        let what = match &end.reason {
            EndReason::ScreenedOut { .. } => "screened_out",
            EndReason::ChecksFailed { .. } => "failed_checks",
        };
        put("response_id", what.into());
        put("answer", why.clone());
        put("response", why);
        self.ordered(cells)
    }

    fn kind(&self, step: &FinishedStep) -> StepType {
        match (&step.clip, step.id.as_str()) {
            (Some(_), id) if id.starts_with("training/") => StepType::Training,
            (Some(_), _) => StepType::Trial,
            (None, "demographics") => StepType::Demographics,
            (None, _) => StepType::Questionnaire,
        }
    }

    fn step_cells(&self, record: &Record, step: &FinishedStep, kind: StepType, cells: &mut Cells) {
        let component = component_of(&step.id);
        if kind == StepType::Trial {
            let assigned = cells.get(ASSIGNED_CONDITION).and_then(Value::as_str);
            let place = |assigned: Option<&str>| {
                self.conditions.get(&(assigned.map(str::to_owned), component.to_owned()))
            };
            let condition = place(assigned).or_else(|| place(None));
            let condition = condition.map_or(component, String::as_str).into();
            cells.insert("condition".to_owned(), condition);
        }
        let mut put = |name: &str, value: Value| cells.insert(name.to_owned(), value);
        put("trial_id", step.id.as_str().into());
        put("trial_type", kind.word().into());
        put("duration", milliseconds(step.end_ms - step.start_ms));
        put("time_elapsed", milliseconds(step.end_ms - record.opened_ms));
        put("interruptions", step.attempt.interruptions.into());
        put("focus_losses", step.attempt.focus_losses.into());
        put("timed_out", step.timed_out.into());
        put("fullscreen", step.fullscreen.into());
        let ratio = step
            .attempt
            .play
            .as_ref()
            .map_or(step.client.device_pixel_ratio, |play| play.device_pixel_ratio);
        let px_per_mm = step.calibrated.px_per_mm_at(ratio);
        put("px_per_mm", px_per_mm.map_or(Value::Null, milliseconds));
        put("viewing_distance_cm", step.calibrated.distance_cm.map_or(Value::Null, number));
        put("start_time", iso_time(step.start_ms).into());
        put("end_time", iso_time(step.end_ms).into());
        let [width, height] = step.client.viewport;
        put("viewport", format!("{width}x{height}").into());
        put("device_pixel_ratio", number(step.client.device_pixel_ratio));
        let about: Vec<&str> = step.client.about.values().map(String::as_str).collect();
        put("browser", about.join(" ").into());
        let Some(clip) = &step.clip else { return };
        put("stimulus", clip.as_str().into());
        put("replays", (step.replays + step.attempt.earlier_plays).into());
        if let Some(known) = self.clips.get(clip) {
            for (factor, value) in &known.factors {
                put(factor, value.to_value());
            }
        }
        let play = step.attempt.play.as_ref();
        put("provenance", self.provenance(clip, play.map(|play| play.provenance.as_str())));
        if let Some(play) = play {
            play_cells(play, record.opened_ms, cells);
        }
        let Some(beside) = &step.attempt.beside else { return };
        let mut put = |name: &str, value: Value| cells.insert(name.to_owned(), value);
        if let Some(play) = play {
            put("beside_drift_ms", milliseconds(play.drift_ms));
        }
        put("beside", beside.clip.as_str().into());
        put("beside_side", if beside.left { "left" } else { "right" }.into());
        let logged = play.map(|play| play.beside_provenance.as_str());
        put("beside_provenance", self.provenance(&beside.clip, logged));
    }

    /// What the page logged with the play: the stimuli that are served now may be others under the
    /// same study file. Logs of earlier versions say nothing, then it is what is served.
    fn provenance(&self, clip: &str, logged: Option<&str>) -> Value {
        let served = || self.sources.get(clip).map(|source| source.provenance.as_str());
        logged.filter(|hash| !hash.is_empty()).or_else(served).into()
    }

    /// The rows of a step, given the answers of the pages before it.
    fn answer_rows(
        &self,
        step: &FinishedStep,
        earlier: &Answers,
        cells: &Cells,
        rows: &mut Vec<Vec<Value>>,
    ) {
        let questions = self.study.questions_of(&step.id);
        for question in &questions {
            let answer = step.answers.get(&question.id);
            if answer.is_none() && !question.is_shown(&step.answers, earlier) {
                continue;
            }
            let answer = answer.unwrap_or(&Value::Null);
            for (suffix, cell) in answer_cells(question, answer) {
                let mut row = cells.clone();
                row.insert("response_id".to_owned(), format!("{}{suffix}", question.id).into());
                self.judge(question, step, answer, &mut row);
                rows.push(self.row(row, step, &question.id, cell));
            }
        }
        // Answers to questions that this version of the study no longer asks.
        for (id, answer) in &step.answers {
            if !questions.iter().any(|question| question.id == *id) {
                let mut row = cells.clone();
                row.insert("response_id".to_owned(), id.as_str().into());
                rows.push(self.row(row, step, id, plain(Some(answer))));
            }
        }
    }

    /// Whether the answer is right, and whether an attention check was passed.
    fn judge(&self, question: &Question, step: &FinishedStep, answer: &Value, row: &mut Cells) {
        if let Some(factor) = question.kind.truth()
            && let Some(clip) = step.clip.as_ref().and_then(|clip| self.clips.get(clip))
            && let Some(truth) = clip.factor_text(factor)
        {
            if !answer.is_null() {
                let correct = answer.as_str() == Some(truth.as_str());
                row.insert("correct".to_owned(), correct.into());
            }
            row.insert("truth".to_owned(), truth.into());
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
            row.insert("chosen".to_owned(), chosen.into());
        }
        if let Some(check) = &question.attention_check {
            let passed = alike(answer, &check.expected);
            row.insert("attention_passed".to_owned(), passed.into());
        }
    }

    fn row(&self, mut cells: Cells, step: &FinishedStep, id: &str, answer: Value) -> Vec<Value> {
        let onset_ms = step.attempt.play.as_ref().map_or(step.start_ms, |play| play.onset_ms);
        let answered_ms = step.attempt.answered_ms.get(id).filter(|_| !answer.is_null());
        let open = answered_ms.zip(step.attempt.answering_ms).map(|(at_ms, open)| at_ms - open);
        cells.insert("rt_open".to_owned(), open.map_or(Value::Null, milliseconds));
        let rt = step.attempt.answered_ms.get(id).map(|at_ms| at_ms - onset_ms);
        // An answer without an event of its own takes the time at which all were sent.
        let rt = rt.filter(|_| !answer.is_null()).or(step.rt_ms.filter(|_| !answer.is_null()));
        cells.insert("rt".to_owned(), rt.map_or(Value::Null, milliseconds));
        cells.insert("response".to_owned(), answer.clone());
        cells.insert("answer".to_owned(), answer);
        self.ordered(cells)
    }

    /// The cells in the order of the columns.
    fn ordered(&self, mut cells: Cells) -> Vec<Value> {
        self.columns
            .iter()
            .map(|column| cells.remove(&column.name).unwrap_or(Value::Null))
            .collect()
    }
}

/// What was measured of the first whole play.
fn play_cells(play: &PlayLog, opened_ms: f64, cells: &mut Cells) {
    let mut put = |name: &str, value: Value| cells.insert(name.to_owned(), value);
    put("onset_ms", milliseconds(play.onset_ms - opened_ms));
    put("frames", play.frames.len().into());
    put("frames_late", play.late.into());
    put("frame_longest_ms", milliseconds(play.longest_ms));
    put("refresh_hz", milliseconds(play.refresh_hz));
    put("backend", play.backend.as_str().into());
    put("clip_width", number(play.width));
    put("clip_height", number(play.height));
    put("weights_hash", play.weights_hash.as_str().into());
    let renderer = Some(play.renderer.as_str()).filter(|hash| !hash.is_empty());
    put("renderer", renderer.into());
}

/// Kinds of steps that have answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StepType {
    Trial,
    Training,
    Demographics,
    Questionnaire,
}

impl StepType {
    fn word(self) -> &'static str {
        match self {
            Self::Trial => "trial",
            Self::Training => "training",
            Self::Demographics => "demographics",
            Self::Questionnaire => "questionnaire",
        }
    }
}

fn count(counter: &mut u64) -> Value {
    *counter += 1;
    (*counter).into()
}

/// Participant's condition and component -> identifier of the nearest sequence that has one.
/// `enclosing` is the condition and the identifier of the sequences around.
fn conditions_of(
    sequence: &Sequence,
    enclosing: (Option<&str>, Option<&str>),
    conditions: &mut BTreeMap<(Option<String>, String), String>,
) {
    let own = sequence.id.as_deref();
    let assigned = if sequence.conditional { own } else { enclosing.0 };
    let condition = own.or(enclosing.1);
    for item in &sequence.components {
        match item {
            SequenceItem::Component(name) => {
                let key = (assigned.map(str::to_owned), name.clone());
                conditions.entry(key).or_insert(condition.unwrap_or(name).to_owned());
            }
            SequenceItem::Sequence(nested) => {
                conditions_of(nested, (assigned, condition), conditions);
            }
        }
    }
}
