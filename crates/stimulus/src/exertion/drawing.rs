//! What a page draws of an exertion: courses over all of it, breath and weights over a window, the body.

use std::ops::Range;

use mimique_exertion::{Clip, Course, Expression, Figure, Person, Series};
use serde::Serialize;

/// Points of a line at most: more than a picture has columns.
const MOST_SECONDS: usize = 4000;
const MOST_FRAMES: usize = 6000;
/// Values are rounded to so many parts of 1.
const PARTS: f64 = 1e4;

/// An exertion as pages draw it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ExertionDrawing {
    /// How long all of it is, s.
    pub span_s: f64,
    /// The part that the face shows, s.
    pub window_s: [f64; 2],
    /// Seconds from a value of a course to the next.
    pub every_s: f64,
    /// From the beginning on.
    pub courses: Vec<DrawnCourse>,
    /// Values per second of breath and weights.
    pub rate_hz: f64,
    /// In the window: what is in the lungs, 0 to 1, and what flows, in above 0; nothing without breath.
    pub breath: Vec<DrawnLine>,
    /// In the window.
    pub weights: Vec<DrawnLine>,
    /// In the window; `None` where no motion is known.
    pub figure: Option<Figure>,
}

/// A course of an exertion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnCourse {
    /// What it is.
    pub course: Course,
    /// Its lines.
    pub lines: Vec<DrawnLine>,
}

/// A line of a picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnLine {
    /// Its name, empty where it is alone.
    pub name: String,
    /// Its values.
    pub values: Vec<f64>,
}

/// What there is to draw.
#[derive(Debug)]
pub struct Drawn<'a> {
    /// Whose body and face it is.
    pub person: &'a Person,
    /// What makes the curves.
    pub expression: &'a Expression,
    /// All of it.
    pub series: &'a Series,
    /// The clip of a face.
    pub clip: &'a Clip,
    /// The frames of the clip that are shown, one at least.
    pub frames: Range<usize>,
    /// How long all of it is, s.
    pub span_s: f64,
    /// The body in the window.
    pub figure: Option<Figure>,
}

impl ExertionDrawing {
    /// Makes the lines, thinned where they have more points than a picture shows.
    pub fn of(drawn: Drawn<'_>) -> Self {
        let Drawn { person, expression, series, clip, frames, span_s, figure } = drawn;
        let every = series.seconds().div_ceil(MOST_SECONDS).max(1);
        let step = frames.len().div_ceil(MOST_FRAMES).max(1);
        let curves = series.curves(person, expression);
        let course = |course: Course| DrawnCourse {
            course,
            lines: series
                .lines(course, &curves)
                .into_iter()
                .map(|(name, values)| line(name, values.into_iter().step_by(every)))
                .collect(),
        };
        let rows = || frames.clone().step_by(step);
        let breath = clip.breathing.iter().flat_map(|breathing| {
            [("lungs", &breathing.volume), ("flow", &breathing.flow)]
                .map(|(name, values)| line(name, rows().map(|frame| values[frame])))
        });
        let width = clip.shape_names.len();
        let weights = clip.shape_names.iter().enumerate().map(|(shape, name)| {
            line(name, rows().map(|frame| clip.weights[frame * width + shape]))
        });
        Self {
            span_s,
            window_s: [clip.times[frames.start], clip.times[frames.end - 1]],
            every_s: every as f64,
            courses: Course::ALL.map(course).into(),
            rate_hz: clip.rate_hz / step as f64,
            breath: breath.collect(),
            weights: weights.collect(),
            figure,
        }
    }
}

fn line(name: &str, values: impl Iterator<Item = f64>) -> DrawnLine {
    let rounded = values.map(|value| (PARTS * value).round() / PARTS).collect();
    DrawnLine { name: name.to_owned(), values: rounded }
}
