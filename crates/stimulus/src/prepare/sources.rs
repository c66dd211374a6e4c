//! The avatars, captures and marker maps that a study file names, each read once.

use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use mimique_avatar::{Avatar, GazeAngles, MOST_SHAPES};
use mimique_clip::sha256_hex;
use mimique_mocap::{Capture, LengthUnit, ReadOptions, WeightOptions, WeightsTable};
use mimique_solver::Method;
use mimique_study::{
    AvatarSource, CaptureSource, Clip, ExertionCapture, GazeSource, HeldGaze, Segment, Span, Study,
    resolve_path, video_type,
};
use serde_json::json;

use super::avatar_key::avatar_key;
use super::exertion::{ComputedExertion, Exertion, ExertionWeights};
use super::known::Asked;
use super::source_files::{AvatarFile, CaptureFile, Performance, Recording, Video};
use super::{Places, PrepareError, builtin, pointer};
use crate::provenance::{Provenance, sha256_of_file};
use crate::{
    ExertionDrawing, GazeTrack, GivenGaze, MarkerMap, RepairSidecar, TakeOptions, Training,
    read_performance, split_shapes,
};

/// Everything that a study file names.
pub(super) struct Sources<'a> {
    study: &'a Study,
    places: &'a Places,
    avatars: RefCell<BTreeMap<String, Result<Rc<AvatarFile>, PrepareError>>>,
    captures: RefCell<BTreeMap<String, Result<Rc<CaptureFile>, PrepareError>>>,
    trainings: RefCell<BTreeMap<String, Rc<Training>>>,
    asked: Asked,
    /// Weights of exertions, by their captures.
    exertions: RefCell<BTreeMap<String, Rc<ExertionWeights>>>,
}

impl<'a> Sources<'a> {
    pub fn new(study: &'a Study, places: &'a Places) -> Self {
        let (avatars, captures, trainings, exertions, asked) = Default::default();
        Self { study, places, avatars, captures, trainings, exertions, asked }
    }

    /// The files that were asked for.
    pub fn asked(&self) -> &Asked {
        &self.asked
    }

    /// The avatar of that identifier.
    pub fn avatar(&self, id: &str) -> Result<Rc<AvatarFile>, PrepareError> {
        if let Some(found) = self.avatars.borrow().get(id) {
            return found.clone();
        }
        let read = self.read_avatar(id).map(Rc::new);
        self.avatars.borrow_mut().insert(id.to_owned(), read.clone());
        read
    }

    fn read_avatar(&self, id: &str) -> Result<AvatarFile, PrepareError> {
        let at = |field: &str| pointer(&["stimuli", "avatars", id, field]);
        let source = self.study.stimuli.avatars.get(id).and_then(|a| a.source());
        let mut locked = Vec::new();
        let (key, avatar, sites, pointer) = match source {
            Some(AvatarSource::Builtin(who)) => {
                let (avatar, sites) = builtin::avatar(who);
                (avatar_key(&avatar), avatar, Some(sites), at("builtin"))
            }
            Some(AvatarSource::File(file)) => {
                let path = self.path(file, &at("file"))?;
                let read = mimique_avatar_files::read_avatar(&path).map_err(|e| {
                    PrepareError::new(at("file"), format!("{}: {e}", path.display()))
                })?;
                locked = read.locked;
                (avatar_key(&read.avatar), read.avatar, None, at("file"))
            }
            Some(AvatarSource::Videos(_)) | None => {
                let message = "give exactly one of builtin, file and videos";
                return Err(PrepareError::new(pointer(&["stimuli", "avatars", id]), message));
            }
        };
        let split = self.study.stimuli.avatars.get(id).map_or(&[][..], |a| &a.split);
        let (key, avatar) = if split.is_empty() {
            (key, avatar)
        } else {
            let avatar =
                split_shapes(&avatar, split).map_err(|e| PrepareError::new(at("split"), e))?;
            (avatar_key(&avatar), avatar)
        };
        let (key, avatar) = if self.study.shows_head_motion() {
            let avatar = with_head_pose(avatar).map_err(|e| PrepareError::new(at("file"), e))?;
            (avatar_key(&avatar), avatar)
        } else {
            (key, avatar)
        };
        Ok(AvatarFile { key, avatar, locked, sites, skin: OnceCell::new(), pointer })
    }

    /// The video that a clip shows; `None` for a clip of a head.
    pub fn video(&self, clip: &Clip) -> Result<Option<Video>, PrepareError> {
        let avatar = self.study.stimuli.avatars.get(&clip.avatar);
        let Some(AvatarSource::Videos(videos)) = avatar.and_then(|a| a.source()) else {
            return Ok(None);
        };
        let at = pointer(&["stimuli", "avatars", &clip.avatar, "videos"]);
        let path = videos.get(&clip.segment).ok_or_else(|| {
            PrepareError::new(&at, format!("no video of segment {:?}; name its file", clip.segment))
        })?;
        let at = pointer(&["stimuli", "avatars", &clip.avatar, "videos", &clip.segment]);
        let media_type = video_type(path).ok_or_else(|| {
            PrepareError::new(&at, format!("{path:?} is neither MP4 nor WebM; convert it"))
        })?;
        let (_, bytes) = self.read(path, &at)?;
        Ok(Some(Video { bytes, media_type }))
    }

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

    fn segment(&self, id: &str) -> Result<(&'a Segment, String), PrepareError> {
        let segments = &self.study.stimuli.segments;
        let index = segments.iter().position(|s| s.id == id).ok_or_else(|| {
            PrepareError::new("/stimuli/segments", format!("no segment {id:?}; add it"))
        })?;
        Ok((&segments[index], pointer(&["stimuli", "segments", &index.to_string()])))
    }

    /// The capture of a segment; for a built-in actor the take of its performance.
    fn capture(&self, segment: &Segment, at: &str) -> Result<Rc<CaptureFile>, PrepareError> {
        let id = &segment.capture;
        let source = self.study.stimuli.captures.get(id).and_then(|capture| capture.source());
        let name = match (source, segment.span()) {
            (Some(CaptureSource::Builtin(_)), Some(Span::Performance(what))) => {
                json!([id, what]).to_string()
            }
            (Some(CaptureSource::File(_)), Some(Span::Frames { .. })) => id.clone(),
            (None, _) => {
                let message = "give exactly one of builtin, file and exertion";
                return Err(PrepareError::new(pointer(&["stimuli", "captures", id]), message));
            }
            _ => {
                let message = "give first and end for a file, performance for a built-in actor";
                return Err(PrepareError::new(at, message));
            }
        };
        if let Some(found) = self.captures.borrow().get(&name) {
            return found.clone();
        }
        let read = self.capture_read(segment).map(Rc::new);
        self.captures.borrow_mut().insert(name, read.clone());
        read
    }

    /// The same, read or performed, at the rate that is shown.
    fn capture_read(&self, segment: &Segment) -> Result<CaptureFile, PrepareError> {
        let id = &segment.capture;
        let entry = self.study.stimuli.captures.get(id);
        let at = pointer(&["stimuli", "captures", id]);
        let file = match (entry.and_then(|c| c.source()), segment.span()) {
            (Some(CaptureSource::Builtin(actor)), Some(Span::Performance(what))) => {
                let take = builtin::take(actor, what);
                CaptureFile {
                    head: take.head,
                    known: Some((take.neutral, take.played)),
                    ..CaptureFile::new(builtin::take_key(&take.capture), take.capture)
                }
            }
            (Some(CaptureSource::File(path)), _) => {
                let (key, capture, repair) = self.read_capture(path, entry, &at)?;
                CaptureFile { repair, ..CaptureFile::new(key, capture) }
            }
            _ => return Err(PrepareError::new(at, "give exactly one of builtin and file")),
        };
        match entry.and_then(|c| c.rate_hz) {
            Some(rate_hz) => file.at_rate(rate_hz, &format!("{at}/rateHz")),
            None => Ok(file),
        }
    }

    /// The capture of a file, and what it is known by.
    fn read_capture(
        &self,
        file: &str,
        entry: Option<&mimique_study::Capture>,
        at: &str,
    ) -> Result<(String, Capture, Option<String>), PrepareError> {
        let at_file = format!("{at}/file");
        let path = self.path(file, &at_file)?;
        let unit = entry.and_then(|entry| entry.unit.as_deref());
        let file_rate_hz = entry.and_then(|entry| entry.file_rate_hz);
        let unit_read = unit_of(unit, &format!("{at}/unit"))?;
        let options = ReadOptions { unit: unit_read, rate_hz: file_rate_hz };
        let recording = mimique_mocap::CaptureFile::open(&path)
            .and_then(|mut file| file.recording(&options))
            .map_err(|e| PrepareError::new(&at_file, format!("{}: {e}", path.display())))?;
        let hash = sha256_of_file(&path).map_err(|e| unread(&path, &e, &at_file))?;
        let repair = RepairSidecar::beside(&path, || Ok(hash.clone()))
            .map_err(|e| PrepareError::new(&at_file, e))?
            .map(|sidecar| sidecar.hash());
        let key = Provenance::default().json("file", hash).json("unit", json!(unit));
        // Of a file that says its rate, the key is as it was.
        let key = match file_rate_hz {
            Some(rate_hz) => key.json("fileRateHz", rate_hz),
            None => key,
        };
        let key = key.hash();
        Ok((key, recording.capture, repair))
    }

    /// The path of a file that the study names.
    fn path(&self, file: &str, at: &str) -> Result<PathBuf, PrepareError> {
        let path = resolve_path(file, &self.places.study, self.places.data.as_deref())
            .map_err(|e| PrepareError::new(at, e))?;
        self.asked.note(&path);
        Ok(path)
    }

    /// The file that a path of the study names.
    pub fn read(&self, file: &str, at: &str) -> Result<(PathBuf, Vec<u8>), PrepareError> {
        let path = self.path(file, at)?;
        let bytes = std::fs::read(&path).map_err(|e| unread(&path, &e, at))?;
        Ok((path, bytes))
    }
}

/// What a part is where it is sound; what is wrong with it goes to the faults.
fn sound<T>(part: Result<T, PrepareError>, faults: &mut Vec<PrepareError>) -> Option<T> {
    part.map_err(|fault| faults.push(fault)).ok()
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

/// A file that cannot be read.
fn unread(path: &Path, error: &std::io::Error, at: &str) -> PrepareError {
    PrepareError::new(at, format!("{}: {error}; check the path", path.display()))
}

pub(super) fn unit_of(unit: Option<&str>, at: &str) -> Result<Option<LengthUnit>, PrepareError> {
    match unit {
        None => Ok(None),
        Some("mm") => Ok(Some(LengthUnit::Millimetre)),
        Some("cm") => Ok(Some(LengthUnit::Centimetre)),
        Some("m") => Ok(Some(LengthUnit::Metre)),
        Some(other) => Err(PrepareError::new(at, format!("unit {other:?}; write m, cm or mm"))),
    }
}

/// An avatar with the shapes that turn its head.
fn with_head_pose(avatar: Avatar) -> Result<Avatar, String> {
    let shapes = avatar.shape_names.len();
    let turned = avatar.with_head_pose_shapes();
    if turned.shape_names.len() > MOST_SHAPES {
        return Err(format!(
            "{shapes} shapes, of which a clip shows {MOST_SHAPES} at most with those that turn the head; write \
             \"headMotion\": 0 in the captures"
        ));
    }
    Ok(turned)
}
