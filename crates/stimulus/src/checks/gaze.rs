//! Where the eyes of a performance look, and whether eyes do so.

use std::fmt;

use mimique_avatar::{GazeShapes, VERGENCE_DEGREES, VERTICAL_DISPARITY_DEGREES};
use serde::Serialize;

use crate::TakeWarning;

/// Where the eyes look over the frames of a take, degrees: least and largest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GazeStatistics {
    /// Mean azimuth of both eyes, to the person's left above 0.
    pub azimuth_deg: [f64; 2],
    /// Mean elevation of both eyes.
    pub elevation_deg: [f64; 2],
    /// Angle between both lines of sight, above 0 where the eyes converge.
    pub vergence_deg: [f64; 2],
    /// Largest difference of the eyes' elevations.
    pub vertical_disparity_deg: f64,
    /// How many frames show what eyes do not do, and the worst of them, counted from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beyond: Option<GazeBeyond>,
}

/// Frames with a gaze that eyes do not have.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GazeBeyond {
    /// How many frames.
    pub frames: usize,
    /// The worst of them, counted from 0.
    pub worst: usize,
    /// What is wrong with it.
    pub why: GazeFault,
}

/// What eyes do not do.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase", tag = "what", content = "degrees")]
pub enum GazeFault {
    /// They are turned outwards from each other, by so many degrees.
    Diverges(f64),
    /// They converge on what is nearer than eyes can see, by so many degrees.
    Crosses(f64),
    /// One looks so many degrees higher than the other.
    OneHigher(f64),
}

impl GazeFault {
    /// The fault of two eyes with this vergence and vertical disparity, and how far it goes beyond what eyes do.
    fn of(vergence: f64, disparity: f64) -> Option<(Self, f64)> {
        let faults = [
            (Self::Diverges(-vergence), VERGENCE_DEGREES[0] - vergence),
            (Self::Crosses(vergence), vergence - VERGENCE_DEGREES[1]),
            (Self::OneHigher(disparity.abs()), disparity.abs() - VERTICAL_DISPARITY_DEGREES),
        ];
        faults.into_iter().filter(|fault| fault.1 > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

impl GazeStatistics {
    /// Of weights, a row per frame; none of a bank that turns no eye, or of no frame.
    pub fn of(shape_names: &[String], weights: &[f64]) -> Option<Self> {
        let shapes = GazeShapes::of(shape_names);
        let mut out: Option<Self> = None;
        let mut worst: Option<(usize, GazeFault, f64)> = None;
        let mut beyond = 0;
        for (frame, row) in weights.chunks_exact(shape_names.len().max(1)).enumerate() {
            let eyes = shapes.eyes(row);
            let gaze = eyes.gaze()?;
            let disparity = eyes.vertical_disparity();
            let so_far = out.get_or_insert(Self {
                azimuth_deg: [gaze.azimuth; 2],
                elevation_deg: [gaze.elevation; 2],
                vergence_deg: [gaze.vergence; 2],
                vertical_disparity_deg: 0.0,
                beyond: None,
            });
            widen(&mut so_far.azimuth_deg, gaze.azimuth);
            widen(&mut so_far.elevation_deg, gaze.elevation);
            widen(&mut so_far.vergence_deg, gaze.vergence);
            so_far.vertical_disparity_deg = so_far.vertical_disparity_deg.max(disparity.abs());
            let Some((fault, by)) = GazeFault::of(gaze.vergence, disparity) else { continue };
            beyond += 1;
            if worst.is_none_or(|(.., most)| by > most) {
                worst = Some((frame, fault, by));
            }
        }
        let beyond = worst.map(|(worst, why, _)| GazeBeyond { frames: beyond, worst, why });
        out.map(|statistics| Self { beyond, ..statistics })
    }

    /// Whether the eyes stay where they are throughout.
    pub fn is_still(&self) -> bool {
        [self.azimuth_deg, self.elevation_deg, self.vergence_deg].iter().all(|[a, b]| a == b)
            && self.vertical_disparity_deg == 0.0
    }

    /// Where the eyes look, in a few words.
    pub fn words(&self) -> String {
        let span = |[low, high]: [f64; 2]| format!("{low:.1} to {high:.1}");
        format!(
            "azimuth {}, elevation {}, vergence {} degrees",
            span(self.azimuth_deg),
            span(self.elevation_deg),
            span(self.vergence_deg)
        )
    }

    /// What should be said of a gaze that eyes do not have, frames counted from `first_frame`.
    pub fn warning(&self, first_frame: u64) -> Option<TakeWarning> {
        let GazeBeyond { frames, worst, why } = *self.beyond.as_ref()?;
        Some(TakeWarning::GazeBeyondEyes { frames, worst: worst as u64 + first_frame, why })
    }
}

/// `the eyes diverge by 17.0 degrees (wall-eyed)`.
impl fmt::Display for GazeFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diverges(by) => write!(f, "the eyes diverge by {by:.1} degrees (wall-eyed)"),
            Self::Crosses(by) => write!(f, "the eyes converge by {by:.1} degrees (cross-eyed)"),
            Self::OneHigher(by) => write!(f, "one eye looks {by:.1} degrees higher than the other"),
        }
    }
}

fn widen(range: &mut [f64; 2], value: f64) {
    *range = [range[0].min(value), range[1].max(value)];
}

#[cfg(test)]
mod tests {
    use mimique_avatar::{ARKIT_SHAPES, GazeAngles};

    use super::*;

    fn take(gazes: &[GazeAngles]) -> (Vec<String>, Vec<f64>) {
        let names = ARKIT_SHAPES.map(str::to_owned).to_vec();
        let shapes = GazeShapes::of(&names);
        let mut weights = vec![0.0; names.len() * gazes.len()];
        for (row, &gaze) in weights.chunks_exact_mut(names.len()).zip(gazes) {
            shapes.shapes().into_iter().zip(shapes.weights(gaze)).for_each(|(k, w)| row[k] = w);
        }
        (names, weights)
    }

    #[test]
    fn a_gaze_of_people_is_told_and_not_warned_of() {
        let gaze = |azimuth, elevation, vergence| GazeAngles { azimuth, elevation, vergence };
        let (names, weights) = take(&[gaze(-5.0, 2.0, 1.0), gaze(10.0, -12.0, 8.0)]);
        let told = GazeStatistics::of(&names, &weights).unwrap();
        assert_eq!(
            told.words(),
            "azimuth -5.0 to 10.0, elevation -12.0 to 2.0, vergence 1.0 to 8.0 degrees"
        );
        assert_eq!((told.warning(0), told.is_still()), (None, false));
        let (names, weights) = take(&[GazeAngles::default(); 3]);
        assert!(GazeStatistics::of(&names, &weights).unwrap().is_still());
        assert_eq!(GazeStatistics::of(&["jawOpen".to_owned()], &[0.5]), None);
        assert_eq!(GazeStatistics::of(&names, &[]), None);
    }

    #[test]
    fn eyes_that_diverge_cross_or_part_vertically_are_warned_of_with_their_worst_frame() {
        let gaze = |vergence| GazeAngles { vergence, ..GazeAngles::default() };
        let (names, weights) = take(&[gaze(0.0), gaze(-4.0), gaze(-17.0), gaze(26.0)]);
        let told = GazeStatistics::of(&names, &weights).unwrap();
        assert_eq!(told.beyond.as_ref().map(|b| (b.frames, b.worst)), Some((3, 2)));
        let said = told.warning(100).unwrap().to_string();
        assert!(
            said.contains("3 frames") && said.contains("frame 102, the eyes diverge by 17.0"),
            "{said}"
        );
        let up = names.iter().position(|n| n == "eyeLookUpLeft").unwrap();
        let (_, mut weights) = take(&[gaze(0.0)]);
        weights[up] = 0.2;
        let told = GazeStatistics::of(&names, &weights).unwrap();
        assert_eq!(told.beyond.unwrap().why, GazeFault::OneHigher(5.0));
    }
}
