//! What is saved of an exertion: weights and series as the command writes them, a figure, a study's capture.

use mimique_analysis::components::{CoursePanel, time_courses};
use mimique_exertion::{Course, FRAMES_PER_SECOND};
use mimique_study::{ExertionCapture, ExertionHeart, ExertionPerson};
use serde_json::{Value, json};

use super::settings::{HeartChoice, ModelChoice, SourceChoice};
use super::{Made, SLOT};
use crate::workspace::{Problem, Workspace};

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
    /// [`Problem`]: nothing is computed; a source or a heart that no study file has.
    pub fn exertion_study(&self) -> Result<String, Problem> {
        let Made { settings, clip, .. } = self.exertion_made()?;
        let (id, motion) = self.study_motion(settings.source)?;
        let heart = match settings.heart {
            HeartChoice::Thesis => ExertionHeart::Thesis,
            HeartChoice::Steady => ExertionHeart::Steady,
            HeartChoice::Recorded => {
                let what = "a study file has no recorded heart; take thesis or steady";
                return Err(Problem::of("heart", what));
            }
        };
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
            seconds: self.exertion_seconds(settings.source, settings.seconds),
            person,
            heart,
            model,
            breath: settings.breath,
            seed: settings.seed,
        };
        let parts = json!({
            "captures": {&id: {"exertion": capture}},
            "segments": [{"id": &id, "capture": &id, "first": first, "end": first + clip.times.len()}],
            "methods": {"recorded": {"method": "recorded"}},
        });
        Ok(pretty(&parts))
    }

    /// How long it goes on: what was asked for, else the motion once.
    fn exertion_seconds(&self, source: SourceChoice, seconds: Option<f64>) -> f64 {
        seconds.or_else(|| Some(self.body_motion(source)?.once.span_s())).unwrap_or_default()
    }

    /// An identifier, and the file of the motion.
    fn study_motion(&self, source: SourceChoice) -> Result<(String, Option<String>), Problem> {
        let file = match (source, &self.exertion.file) {
            (SourceChoice::File, Some(file)) => {
                if file.activity().is_some() {
                    let what = "a recording of a watch; a study file takes the motion of a body: play its weights \
                                there, as a file of weights";
                    return Err(Problem::of(&file.name, what));
                }
                file.name.clone()
            }
            (SourceChoice::Take, _) => self.take_name().to_owned(),
            _ => {
                let word = source.built_in().map_or("exertion", |motion| motion.word());
                return Ok((word.to_owned(), None));
            }
        };
        let stem = file.rsplit_once('.').map_or(&file[..], |(stem, _)| stem);
        let id: String = stem
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' })
            .collect();
        Ok((id, Some(file)))
    }
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}
