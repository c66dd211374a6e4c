//! The cells of a row that a page or a trial has by itself, whatever was answered: times, clip, play.

use serde_json::Value;

use super::cells::{milliseconds, number};
use super::tidy::TidyForm;
use crate::event::PlayLog;
use crate::record::{Attempt, FinishedStep, Record};
use mimique_study::columns::ASSIGNED_CONDITION;
use mimique_study::{component_of, iso_time};

/// The cells of a row in the making.
#[derive(Clone)]
pub(super) struct Cells<'f> {
    pub form: &'f TidyForm,
    pub row: Vec<Value>,
}

impl Cells<'_> {
    /// Writes a cell; what has no column is in no row.
    pub fn put(&mut self, name: &str, value: Value) {
        if let Some(place) = self.form.place(name) {
            self.row[place] = value;
        }
    }

    fn get(&self, name: &str) -> Option<&Value> {
        self.form.place(name).map(|place| &self.row[place])
    }
}

impl TidyForm {
    /// Writes what a step has by itself.
    pub(super) fn step_cells(
        &self,
        record: &Record,
        step: &FinishedStep,
        kind: StepType,
        cells: &mut Cells<'_>,
    ) {
        let component = component_of(&step.id);
        if kind == StepType::Trial {
            let assigned = cells.get(ASSIGNED_CONDITION).and_then(Value::as_str);
            let place = |assigned: Option<&str>| {
                self.conditions.get(&(assigned.map(str::to_owned), component.to_owned()))
            };
            let condition = place(assigned).or_else(|| place(None));
            let condition = condition.map_or(component, String::as_str).into();
            cells.put("condition", condition);
        }
        let mut put = |name: &str, value: Value| cells.put(name, value);
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
        put("replays", (step.replays + step.attempt.earlier_plays).into());
        let play = step.attempt.play.as_ref();
        self.clip_cells(clip, play.map(|play| play.provenance.as_str()), cells);
        if let Some(play) = play {
            play_cells(play, &step.attempt, record.opened_ms, cells);
        }
        let Some(beside) = &step.attempt.beside else { return };
        let mut put = |name: &str, value: Value| cells.put(name, value);
        if let Some(play) = play {
            put("beside_drift_ms", milliseconds(play.drift_ms));
        }
        put("beside", beside.clip.as_str().into());
        put("beside_side", if beside.left { "left" } else { "right" }.into());
        let logged = play.map(|play| play.beside_provenance.as_str());
        put("beside_provenance", self.provenance(&beside.clip, logged));
    }

    /// Writes which clip it is, with its factors and its provenance as logged.
    pub(super) fn clip_cells(&self, clip: &str, logged: Option<&str>, cells: &mut Cells<'_>) {
        cells.put("stimulus", clip.into());
        for (factor, value) in self.clips.get(clip).into_iter().flat_map(|it| &it.factors) {
            cells.put(factor, value.to_value());
        }
        cells.put("provenance", self.provenance(clip, logged));
    }

    /// What the page logged with the play: the stimuli that are served now may be others under the
    /// same study file. Logs of earlier versions say nothing, then it is what is served.
    fn provenance(&self, clip: &str, logged: Option<&str>) -> Value {
        let served = || self.served.get(clip).map(String::as_str);
        logged.filter(|hash| !hash.is_empty()).or_else(served).into()
    }
}

/// What was measured of the first whole play.
fn play_cells(play: &PlayLog, attempt: &Attempt, opened_ms: f64, cells: &mut Cells<'_>) {
    let mut put = |name: &str, value: Value| cells.put(name, value);
    put("onset_ms", milliseconds(play.onset_ms - opened_ms));
    put("frames", attempt.frames.into());
    put("frames_late", play.late.into());
    put("frame_longest_ms", milliseconds(play.longest_ms));
    put("refresh_hz", milliseconds(play.refresh_hz));
    put("backend", play.backend.as_str().into());
    put("clip_width", number(play.width));
    put("clip_height", number(play.height));
    put("weights_hash", play.weights_hash.as_str().into());
    let renderer = Some(play.renderer.as_str()).filter(|hash| !hash.is_empty());
    put("renderer", renderer.into());
    put("triggers_sent", play.triggers.into());
    for (name, key) in [
        ("mimicry_status", "status"),
        ("mimicry_pictures", "frames"),
        ("mimicry_faces", "faces"),
        ("mimicry_clock", "clock"),
        ("mimicry_model", "model"),
    ] {
        put(name, play.mimicry[key].clone());
    }
    let Some(sound) = play.sound_log() else { return };
    let number = |ms: Option<f64>| ms.map_or(Value::Null, milliseconds);
    put("sound_status", sound.status.into());
    put("sound_offset_ms", number(sound.offset_ms));
    put("sound_delay_ms", milliseconds(sound.delay_ms));
    put("sound_drift_ms", number(sound.drift_ms));
    put("sound_latency_ms", number(sound.latency_ms));
    put("sound_latency_source", sound.latency_source.into());
    put("captions_shown", sound.captions.into());
    put("sound_file", sound.file.into());
}

/// Kinds of steps that have answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StepType {
    Trial,
    Training,
    Demographics,
    Questionnaire,
}

impl StepType {
    pub fn of(step: &FinishedStep) -> Self {
        match (&step.clip, step.id.as_str()) {
            (Some(_), id) if id.starts_with("training/") => Self::Training,
            (Some(_), _) => Self::Trial,
            (None, "demographics") => Self::Demographics,
            (None, _) => Self::Questionnaire,
        }
    }

    pub fn word(self) -> &'static str {
        match self {
            Self::Trial => "trial",
            Self::Training => "training",
            Self::Demographics => "demographics",
            Self::Questionnaire => "questionnaire",
        }
    }
}
