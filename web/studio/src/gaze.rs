//! Where the eyes look: at rest, held, at a marker, or as a file tells.

use mimique_avatar::GazeAngles;
use mimique_mocap::{WeightOptions, read_weights};
use mimique_stimulus::{GazeTrack, GivenGaze};
use serde_json::{Value, json};

use crate::problem::Problem;
use crate::workspace::Workspace;

/// The largest angles that can be held, degrees to each side, as in a study file.
const MOST_DEGREES: f64 = 45.0;

impl Workspace {
    /// Lets the eyes rest.
    pub fn rest_gaze(&mut self) -> Value {
        self.gaze = None;
        self.gaze_state()
    }

    /// Holds one gaze throughout, degrees: to the person's left, upwards, and between both lines of sight.
    ///
    /// # Errors
    /// [`Problem`]: angles that eyes do not turn by.
    pub fn hold_gaze(
        &mut self,
        azimuth: f64,
        elevation: f64,
        vergence: f64,
    ) -> Result<Value, Problem> {
        for (what, degrees, least) in [
            ("azimuth", azimuth, -MOST_DEGREES),
            ("elevation", elevation, -MOST_DEGREES),
            ("vergence", vergence, 0.0),
        ] {
            if !(least..=MOST_DEGREES).contains(&degrees) {
                let what = format!("gaze, {what}");
                let words = format!("{degrees} degrees; write {least} to {MOST_DEGREES}");
                return Err(Problem::of(&what, words));
            }
        }
        self.gaze = Some(GivenGaze::Held(GazeAngles { azimuth, elevation, vergence }));
        Ok(self.gaze_state())
    }

    /// Turns the eyes to a marker of the capture.
    ///
    /// # Errors
    /// [`Problem`]: no capture, or one without that marker.
    pub fn gaze_at_marker(&mut self, label: &str) -> Result<Value, Problem> {
        if self.capture()?.marker_index(label).is_none() {
            return Err(Problem::of(
                "gaze",
                format!("no marker {label}; choose one of the capture"),
            ));
        }
        self.gaze = Some(GivenGaze::Target(label.to_owned()));
        Ok(self.gaze_state())
    }

    /// Takes the gaze of a file: `azimuth`, `elevation` and `vergence` in degrees, or weights with eyeLook shapes.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn gaze_file(&mut self, file: &str, bytes: &[u8]) -> Result<Value, Problem> {
        let table =
            read_weights(bytes, &WeightOptions::default()).map_err(|e| Problem::of(file, e))?;
        let track = GazeTrack::of(&table, 0.0).map_err(|e| Problem::of(file, e))?;
        self.gaze = Some(GivenGaze::Track(track));
        Ok(self.gaze_state())
    }

    /// What gives the gaze (`rest`, `held`, `marker`, `file`), and the markers that the eyes can be turned to.
    pub fn gaze_state(&self) -> Value {
        let kind = match &self.gaze {
            None => "rest",
            Some(GivenGaze::Held(_)) => "held",
            Some(GivenGaze::Target(_)) => "marker",
            Some(GivenGaze::Track(_)) => "file",
        };
        json!({ "kind": kind, "markers": self.capture().map_or(&[][..], |own| &own.labels) })
    }
}
