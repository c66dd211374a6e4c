//! What is saved of an exertion: weights and series as the command writes them, a figure, a study's capture.

use mimique_exertion::{Course, FRAMES_PER_SECOND};
use mimique_report::figure::{CoursePanel, time_courses};
use mimique_study::{ExertionCapture, ExertionHeart, ExertionPerson};
use serde_json::{Value, json};

use super::settings::{HeartChoice, ModelChoice, SourceChoice};
use super::{Made, SLOT};
use crate::problem::Problem;
use crate::workspace::Workspace;

impl Workspace {
    fn exertion_made(&self) -> Result<&Made, Problem> {
        let none = || Problem::of(SLOT, "nothing is computed; mend what is marked first");
        self.exertion.made.as_ref().ok_or_else(none)
    }

    /// The window's weights, byte for byte what `mimique exertion --window --out` writes.
    ///
    /// # Errors
    /// [`Problem`]: nothing is computed.
    pub fn exertion_weights_csv(&self) -> Result<String, Problem> {
        Ok(self.exertion_made()?.clip.table().to_csv())
    }

    /// The series, byte for byte what `mimique exertion --series` writes.
    ///
    /// # Errors
    /// [`Problem`]: nothing is computed.
    pub fn exertion_series_csv(&self) -> Result<String, Problem> {
        Ok(self.exertion_made()?.series.to_csv())
    }

    /// The figure that `mimique exertion --plot` writes.
    ///
    /// # Errors
    /// [`Problem`]: nothing is computed.
    pub fn exertion_plot(&self) -> Result<String, Problem> {
        let Made { settings, name, person, expression, series, .. } = self.exertion_made()?;
        let curves = series.curves(person, expression);
        let panel = |course: Course| {
            let lines = series.lines(course, &curves).into_iter();
            let lines = lines.map(|(name, values)| (name.to_owned(), values)).collect();
            CoursePanel { label: course.label().to_owned(), lines }
        };
        let title = format!("Heart rate, EPOC and curves of {name}");
        Ok(time_courses(&title, &Course::PLOTTED.map(panel), Some(settings.window)))
    }

    /// What a study file takes of it: capture, segment and method as JSON.
    ///
    /// # Errors
    /// [`Problem`]: nothing is computed.
    pub fn exertion_study(&self) -> Result<String, Problem> {
        let Made { settings, clip, .. } = self.exertion_made()?;
        let (id, file) = self.study_source(settings.source);
        let heart = match settings.heart {
            HeartChoice::Thesis => ExertionHeart::Thesis,
            HeartChoice::Steady => ExertionHeart::Steady,
            HeartChoice::Recorded => ExertionHeart::Recorded,
        };
        let is_activity = settings.source == SourceChoice::File
            && self.exertion.file.as_ref().is_some_and(|file| file.activity().is_some());
        let (activity, motion) = if is_activity { (file, None) } else { (None, file) };
        let person: ExertionPerson = serde_json::from_value(settings.person.clone())
            .map_err(|e| Problem::of("person", e))?;
        let model = match settings.model {
            ModelChoice::Rules => "rules".to_owned(),
            ModelChoice::Linear => "linear".to_owned(),
            ModelChoice::File => {
                self.exertion.model.as_ref().map_or("", |(name, _)| name).to_owned()
            }
        };
        let first = (settings.window[0] * FRAMES_PER_SECOND).round() as usize;
        let capture = ExertionCapture {
            builtin: settings.source.built_in(),
            motion,
            activity,
            plan: Vec::new(),
            seconds: settings.seconds,
            joints: None,
            motion_rate_hz: None,
            motion_unit: None,
            person,
            heart: Some(heart),
            model,
            breath: settings.breath,
            skin: settings.skin,
            seed: settings.seed,
        };
        let parts = json!({
            "captures": {&id: {"exertion": capture}},
            "segments": [{"id": &id, "capture": &id, "first": first, "end": first + clip.times.len()}],
            "methods": {"recorded": {"method": "recorded"}},
        });
        Ok(pretty(&parts))
    }

    /// An identifier, and the file of the motion or the recording.
    fn study_source(&self, source: SourceChoice) -> (String, Option<String>) {
        let file = match (source, &self.exertion.file) {
            (SourceChoice::File, Some(file)) => file.name.clone(),
            (SourceChoice::Take, _) => self.take_name().to_owned(),
            _ => {
                let word = source.built_in().map_or("exertion", |motion| motion.word());
                return (word.to_owned(), None);
            }
        };
        let stem = file.rsplit_once('.').map_or(&file[..], |(stem, _)| stem);
        let id: String = stem
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' })
            .collect();
        (id, Some(file))
    }
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}
