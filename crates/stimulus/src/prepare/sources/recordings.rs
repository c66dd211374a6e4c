//! Segments that are weights already: recorded, performed by the built-in actor, of an exertion; and when a segment begins.

use std::rc::Rc;

use mimique_mocap::{WeightOptions, WeightsTable};
use mimique_solver::Method;
use mimique_study::{CaptureSource, Clip, ExertionCapture, Segment, Span};

use super::Sources;
use crate::prepare::exertion::{ComputedExertion, Exertion, ExertionWeights};
use crate::prepare::source_files::Recording;
use crate::prepare::{PrepareError, builtin, pointer};
use crate::{ExertionDrawing, read_performance};

impl<'a> Sources<'a> {
    /// The segment of that identifier as recorded weights, at the rate that is shown.
    pub fn recording(
        &self,
        segment: &str,
        shape_names: &[String],
    ) -> Result<Recording, PrepareError> {
        let (segment, at) = self.segment(segment)?;
        let recording =
            Recording { gaze: self.gaze(segment)?, ..self.recorded(segment, at, shape_names)? };
        let id = &segment.capture;
        match self.study.stimuli.captures.get(id).and_then(|c| c.rate_hz) {
            Some(rate_hz) => {
                recording.at_rate(rate_hz, &pointer(&["stimuli", "captures", id, "rateHz"]))
            }
            None => Ok(recording),
        }
    }

    fn recorded(
        &self,
        segment: &Segment,
        at: String,
        shape_names: &[String],
    ) -> Result<Recording, PrepareError> {
        let pointer = format!("{}/file", pointer(&["stimuli", "captures", &segment.capture]));
        let entry = self.study.stimuli.captures.get(&segment.capture);
        let file = match (entry.and_then(|c| c.source()), segment.span()) {
            (Some(CaptureSource::File(file)), _) => file,
            // The performance itself, as the actor's own face made it.
            (Some(CaptureSource::Builtin(actor)), Some(Span::Performance(what))) => {
                let shown = entry.map_or(0.0, |capture| capture.head_motion_shown());
                let (table, frames) = builtin::performed(actor, what, shown);
                return Ok(Recording {
                    pointer: at,
                    table,
                    frames,
                    is_computed: false,
                    gaze: None,
                    warnings: vec![],
                });
            }
            (Some(CaptureSource::Exertion(exertion)), Some(Span::Frames { first, end })) => {
                let own = self.exertion(&segment.capture, exertion)?;
                let warnings = own.warnings.clone();
                let cut = cut(at, own.table.clone(), [first, end])?;
                return Ok(Recording { is_computed: true, warnings, ..cut });
            }
            _ => {
                let message = "the method recorded takes weights; name a CSV of weights";
                return Err(PrepareError::new(pointer, message));
            }
        };
        let path = self.path(file, &pointer)?;
        // An array has the avatar's shapes in their order.
        let rate_hz = entry.and_then(|capture| capture.file_rate_hz);
        let animation = entry.and_then(|capture| capture.animation.as_deref());
        let table = read_performance(&path, &WeightOptions { rate_hz, shape_names, animation })
            .map_err(|e| PrepareError::new(&pointer, format!("{}: {e}", path.display())))?
            .table;
        match segment.span() {
            Some(Span::Frames { first, end }) => cut(at, table, [first, end]),
            _ => cut(at, table, [0, usize::MAX]),
        }
    }

    /// The weights of an exertion.
    fn exertion(
        &self,
        id: &str,
        own: &ExertionCapture,
    ) -> Result<Rc<ExertionWeights>, PrepareError> {
        if let Some(found) = self.exertions.borrow().get(id) {
            return Ok(found.clone());
        }
        let weights = Rc::new(self.computed(id, own)?.weights());
        self.exertions.borrow_mut().insert(id.to_owned(), weights.clone());
        Ok(weights)
    }

    fn computed(&self, id: &str, own: &ExertionCapture) -> Result<ComputedExertion, PrepareError> {
        let at = pointer(&["stimuli", "captures", id, "exertion"]);
        let path = |file: &str, at: &str| self.path(file, at);
        Exertion { exertion: own, at: &at, path }.computed()
    }

    /// The exertion that a clip shows, and its identifier; none where the clip shows something else.
    pub fn exertion_of(
        &self,
        clip: &Clip,
    ) -> Result<Option<(&'a str, &'a ExertionCapture)>, PrepareError> {
        let (segment, _) = self.segment(&clip.segment)?;
        let capture = self.study.stimuli.captures.get(&segment.capture);
        Ok(match capture.and_then(|capture| capture.source()) {
            Some(CaptureSource::Exertion(own)) => Some((&segment.capture[..], own)),
            _ => None,
        })
    }

    /// The frames of an exertion that a clip shows, as pages draw them.
    pub fn exertion_drawing(
        &self,
        clip: &Clip,
        id: &str,
        own: &ExertionCapture,
    ) -> Result<ExertionDrawing, PrepareError> {
        let (segment, at) = self.segment(&clip.segment)?;
        let computed = self.computed(id, own)?;
        let drawing = match segment.span() {
            Some(Span::Frames { first, end }) => computed.drawing(first..end),
            _ => None,
        };
        drawing.ok_or_else(|| {
            PrepareError::new(at, "not all of its frames are there; correct first and end")
        })
    }

    /// When a segment begins in its capture, and how long it lasts, seconds, as a clip of this method shows it.
    pub fn segment_time(&self, id: &str, clip: &Clip) -> Result<(f64, f64), PrepareError> {
        let method = self.study.stimuli.methods.get(&clip.method);
        let is_recorded = method.is_some_and(|entry| entry.spec.method == Method::Recorded);
        let (segment, at) = self.segment(id)?;
        let (frames, rate_hz) = if is_recorded {
            let avatar = self.avatar(&clip.avatar)?;
            let recording = self.recording(id, avatar.avatar.face_shapes())?;
            let rate_hz = recording.table.rate_hz();
            (recording.frames, rate_hz)
        } else {
            let file = self.capture(segment, &at)?;
            let frames = match segment.span() {
                Some(Span::Frames { first, end }) => file.frames.shown(first..end),
                _ => Ok(0..file.capture.frames()),
            };
            (frames.map_err(|e| PrepareError::new(&at, e))?, Some(file.capture.rate_hz))
        };
        let rate_hz = rate_hz.ok_or_else(|| {
            PrepareError::new(&at, "nothing says when it begins; name a sound of its own")
        })?;
        Ok((frames.start as f64 / rate_hz, frames.len() as f64 / rate_hz))
    }
}

/// Frames of recorded weights.
fn cut(at: String, table: WeightsTable, frames: [usize; 2]) -> Result<Recording, PrepareError> {
    let [first, end] = frames;
    if end > table.frames.len() {
        let frames = table.frames.len();
        let message = format!("give first and end within the {frames} frames of the capture");
        return Err(PrepareError::new(at, message));
    }
    let frames = first..end;
    let warnings = table.notes.iter().map(|note| (at.clone(), note.clone())).collect();
    Ok(Recording { pointer: at, table, frames, is_computed: false, gaze: None, warnings })
}
