//! Segments to be solved: capture, marker map, gaze, training.

use std::rc::Rc;

use mimique_avatar::GazeAngles;
use mimique_clip::sha256_hex;
use mimique_mocap::{WeightOptions, WeightsTable};
use mimique_study::{CaptureSource, GazeSource, HeldGaze, Segment, Span};
use serde_json::json;

use super::Sources;
use crate::prepare::source_files::{AvatarFile, Performance};
use crate::prepare::{PrepareError, builtin, pointer};
use crate::provenance::Provenance;
use crate::{GazeTrack, GivenGaze, MarkerMap, TakeOptions, Training, read_performance};

impl<'a> Sources<'a> {
    /// The segment of that identifier, with the marker map for an avatar.
    pub fn performance(
        &self,
        segment: &str,
        avatar: &Rc<AvatarFile>,
    ) -> Result<Performance, PrepareError> {
        match self.examined(segment, avatar) {
            (Some(performance), faults) => {
                faults.into_iter().next().map_or_else(|| Ok(performance), Err)
            }
            (None, mut faults) => Err(faults.remove(0)),
        }
    }

    /// The same with everything that is wrong with its parts, each looked at by itself. There is a performance
    /// where capture and map can be read, without what is at fault beside them, and at least one fault where
    /// there is none.
    pub fn examined(
        &self,
        segment: &str,
        avatar: &Rc<AvatarFile>,
    ) -> (Option<Performance>, Vec<PrepareError>) {
        let (segment, at) = match self.segment(segment) {
            Ok(found) => found,
            Err(fault) => return (None, vec![fault]),
        };
        let id = &segment.capture;
        let capture_pointer = pointer(&["stimuli", "captures", id]);
        let Some(entry) = self.study.stimuli.captures.get(id) else {
            let message = format!("no capture {id:?}; add it");
            return (None, vec![PrepareError::new("/stimuli/captures", message)]);
        };
        let mut faults = Vec::new();
        let file = sound(self.capture(segment, &at), &mut faults);
        let map = sound(self.marker_map(id, entry, avatar), &mut faults);
        let gaze = sound(self.gaze(segment), &mut faults).flatten();
        let Some(file) = file else { return (None, faults) };
        let shown = |[first, end]: [usize; 2]| file.frames.shown(first..end);
        let neutral = entry.neutral.map(shown).transpose();
        let neutral =
            neutral.map_err(|e| PrepareError::new(format!("{capture_pointer}/neutral"), e));
        let neutral = sound(neutral, &mut faults).flatten();
        let frames = match (segment.span(), &file.known) {
            (Some(Span::Frames { first, end }), None) => {
                file.frames.shown(first..end).map_err(|e| PrepareError::new(&at, e))
            }
            (Some(Span::Performance(_)), Some((_, played))) => Ok(played.clone()),
            _ => Err(PrepareError::new(
                &at,
                "give first and end for a file, performance for a built-in actor",
            )),
        };
        let frames = sound(frames, &mut faults).unwrap_or_default();
        let Some((map, map_key)) = map else { return (None, faults) };
        let head = if entry.head.is_empty() { file.head.clone() } else { entry.head.clone() };
        let known = file.known.as_ref().map(|(neutral, _)| neutral.clone());
        let options = TakeOptions {
            neutral: neutral.or(known),
            head: (!head.is_empty()).then_some(head),
            repair: file.repair.clone(),
            gaze,
            head_motion: entry.head_motion_shown(),
            ..TakeOptions::default()
        };
        let take_key = Provenance::default()
            .json("capture", file.key.as_str())
            .json("map", map_key)
            .json("neutral", json!(options.neutral.as_ref().map(|n| [n.start, n.end])))
            .json("head", json!(options.head))
            .json("gaze", json!(options.gaze.as_ref().map(GivenGaze::key)))
            .json("headMotion", options.head_motion)
            .hash();
        let performance = Performance {
            pointer: at,
            capture_pointer,
            head_lowpass_hz: entry.head_lowpass_hz,
            key: Provenance::default()
                .json("take", take_key.as_str())
                .json("frames", json!([frames.start, frames.end]))
                .hash(),
            take_key,
            frames,
            avatar: avatar.clone(),
            capture: file,
            map,
            options,
        };
        (Some(performance), faults)
    }

    /// The marker map of a capture and what it is known by.
    fn marker_map(
        &self,
        capture: &str,
        entry: &mimique_study::Capture,
        avatar: &AvatarFile,
    ) -> Result<(MarkerMap, String), PrepareError> {
        let at = pointer(&["stimuli", "captures", capture, "markers"]);
        match (&entry.markers, &avatar.sites) {
            (Some(path), _) => {
                let (path, bytes) = self.read(path, &at)?;
                let map = MarkerMap::from_bytes(&bytes)
                    .map_err(|e| PrepareError::new(&at, format!("{}: {e}", path.display())))?;
                Ok((map, sha256_hex(&bytes)))
            }
            (None, Some(sites)) if matches!(entry.source(), Some(CaptureSource::Builtin(_))) => {
                Ok((sites.clone(), "sites".to_owned()))
            }
            (None, _) => Err(PrepareError::new(
                at,
                "no marker map; name the file that says where each marker sits on the avatar",
            )),
        }
    }

    /// The gaze that is given for a segment's capture; none where the eyes rest.
    pub fn gaze(&self, segment: &Segment) -> Result<Option<GivenGaze>, PrepareError> {
        let id = &segment.capture;
        let at = pointer(&["stimuli", "captures", id, "gaze"]);
        let capture = self.study.stimuli.captures.get(id);
        let Some(gaze) = capture.and_then(|capture| capture.gaze.as_ref()) else { return Ok(None) };
        let track = |table: &WeightsTable, later_s: f64, at: &str| {
            let track = GazeTrack::of(table, later_s).map_err(|e| PrepareError::new(at, e))?;
            Ok(Some(GivenGaze::Track(track)))
        };
        match gaze.source() {
            Some(GazeSource::Held(HeldGaze { azimuth, elevation, vergence })) => {
                Ok(Some(GivenGaze::Held(GazeAngles { azimuth, elevation, vergence })))
            }
            Some(GazeSource::Target(label)) => Ok(Some(GivenGaze::Target(label.to_owned()))),
            Some(GazeSource::File(file, later_s)) => {
                let at = format!("{at}/file");
                let path = self.path(file, &at)?;
                let table = read_performance(&path, &WeightOptions::default())
                    .map_err(|e| PrepareError::new(&at, format!("{}: {e}", path.display())))?
                    .table;
                track(&table, later_s, &at)
            }
            Some(GazeSource::Performed) => {
                let source = capture.and_then(|capture| capture.source());
                let (Some(CaptureSource::Builtin(actor)), Some(Span::Performance(what))) =
                    (source, segment.span())
                else {
                    let message =
                        "only a built-in actor performs a gaze; give held, file or target";
                    return Err(PrepareError::new(at, message));
                };
                track(&builtin::performed(actor, what, 0.0).0, 0.0, &at)
            }
            None => {
                let message = "give exactly one of held, file, target and performed";
                Err(PrepareError::new(at, message))
            }
        }
    }

    /// What the regression of that identifier learns from.
    pub fn training(&self, method: &str) -> Result<Rc<Training>, PrepareError> {
        if let Some(found) = self.trainings.borrow().get(method) {
            return Ok(found.clone());
        }
        let at = format!("{}/training", pointer(&["stimuli", "methods", method]));
        let entry = self.study.stimuli.methods.get(method).and_then(|m| m.training.as_ref());
        let entry = entry.ok_or_else(|| {
            PrepareError::new(&at, "a regression learns from a range of motion; name its capture")
        })?;
        let id = &entry.capture;
        let capture_at = pointer(&["stimuli", "captures", id]);
        let source = self.study.stimuli.captures.get(id);
        let training = match (source.and_then(|c| c.source()), &entry.weights) {
            (Some(CaptureSource::Builtin(actor)), None) => builtin::training(actor),
            (Some(CaptureSource::File(path)), Some(weights_file)) => {
                let source = &self.study.stimuli.captures[id];
                let capture = self.read_capture(path, Some(source), &capture_at)?.1;
                let at = format!("{at}/weights");
                let path = self.path(weights_file, &at)?;
                let weights = read_performance(&path, &WeightOptions::default())
                    .map_err(|e| PrepareError::new(&at, format!("{}: {e}", path.display())))?
                    .table;
                Training {
                    capture,
                    weights,
                    neutral: source.neutral.map(|[first, end]| first..end),
                    head: (!source.head.is_empty()).then(|| source.head.clone()),
                }
            }
            _ => {
                let message = "give a capture of a file and its weights, or a built-in actor";
                return Err(PrepareError::new(at, message));
            }
        };
        let training = Rc::new(training);
        self.trainings.borrow_mut().insert(method.to_owned(), training.clone());
        Ok(training)
    }
}

/// What a part is where it is sound; what is wrong with it goes to the faults.
fn sound<T>(part: Result<T, PrepareError>, faults: &mut Vec<PrepareError>) -> Option<T> {
    part.map_err(|fault| faults.push(fault)).ok()
}
