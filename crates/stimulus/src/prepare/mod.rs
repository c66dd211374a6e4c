//! A study file's stimuli in; packs in a folder, and where each clip's are, out.
//!
//! Every pack is a file named by the SHA-256 of its bytes. What was made before from the same
//! inputs is taken from the folder. The weights are solved by the function that the browsers run, once for each
//! program: what this very program has prepared of the same stimuli and files is known by hash.

mod advice;
mod at_rest;
mod avatar_key;
mod builtin;
mod cache;
mod exertion;
mod faults;
mod known;
mod solved_clip;
mod sound;
mod source_files;
mod sources;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use mimique_avatar::Avatar;
use mimique_clip::{TakeContent, TakePack, encode_take, solve_packs};
use mimique_solver::{Group, Method, MethodSpec};
use mimique_study::ClipSource;
use mimique_study::{AvatarLook, Clip, Study};

pub use self::advice::{AdvisedMethod, advised_methods};
pub use self::avatar_key::avatar_key;
use self::cache::{Cache, StoredPack};
pub use self::faults::source_faults;
use self::solved_clip::{Wanted, to_solve};
pub use self::sound::{StudySound, study_sounds};
use self::source_files::{AvatarFile, Performance, Recording, Video};
use self::sources::Sources;
use crate::provenance::Provenance;
use crate::{ExertionDrawing, GazeStatistics, RecordedWeights};

/// Whether what a study names is there: a file, or a folder of an avatar's poses.
pub fn is_source(path: &Path) -> bool {
    path.is_file() || mimique_avatar_files::is_folder_of_poses(path)
}

/// Where things are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Places {
    /// Folder of the study file: its paths are relative to it.
    pub study: PathBuf,
    /// What `${MIMIQUE_DATA}` stands for.
    pub data: Option<PathBuf>,
    /// Folder of the packs; made when it is not there.
    pub packs: PathBuf,
}

/// How far the preparation is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress<'a> {
    /// Clips that are ready.
    pub done: usize,
    /// Clips in all.
    pub total: usize,
    /// What is being worked at.
    pub what: &'a str,
}

/// The clips of a study, ready to be served.
#[derive(Debug, Clone, PartialEq)]
pub struct Prepared {
    /// Every clip, by its identifier in the study.
    pub clips: BTreeMap<String, ClipSource>,
    /// JSON pointer and sentence of what should be said.
    pub warnings: Vec<(String, String)>,
}

/// What is to be said, and which captures have been looked over already.
#[derive(Default)]
struct Remarks {
    /// JSON pointer and sentence.
    warnings: Vec<(String, String)>,
    /// Avatar and take of every capture whose labels have been looked at.
    looked_over: BTreeSet<[String; 2]>,
}

/// The stimuli cannot be prepared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{pointer}: {message}")]
pub struct PrepareError {
    /// JSON pointer into the study file; empty when the folder of packs is at fault.
    pub pointer: String,
    /// What is wrong and what to do.
    pub message: String,
}

impl PrepareError {
    pub(crate) fn new(pointer: impl Into<String>, message: impl std::fmt::Display) -> Self {
        Self { pointer: pointer.into(), message: message.to_string() }
    }
}

impl Places {
    /// The study file's own folder; the data folder as `MIMIQUE_DATA` names it.
    pub fn of(study_file: &Path, packs: impl Into<PathBuf>) -> Self {
        let folder = study_file.parent().filter(|p| !p.as_os_str().is_empty());
        Self {
            study: folder.map_or_else(|| PathBuf::from("."), PathBuf::from),
            data: std::env::var_os("MIMIQUE_DATA").map(PathBuf::from),
            packs: packs.into(),
        }
    }
}

/// Prepares every clip of a study that `mimique check` has found free of errors.
///
/// # Errors
/// Every fault that is found, at least one, each with the JSON pointer of the part at fault: first of all files,
/// where one is absent or damaged, a marker map does not fit, frames are outside the capture; where the files are
/// sound, of the clips, whose method does not solve.
pub fn prepare(
    study: &Study,
    places: &Places,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<Prepared, Vec<PrepareError>> {
    let cache = Cache::open(&places.packs).map_err(|fault| vec![fault])?;
    let key = known::key(study, places);
    if let Some(known) = key.as_ref().and_then(|key| known::find(&cache, key)) {
        let clips = known.clips.len();
        progress(Progress { done: clips, total: clips, what: "packs" });
        return Ok(known);
    }
    let sources = Sources::new(study, places);
    let mut found = faults::of_sources(study, &sources);
    if !found.is_empty() {
        return Err(found);
    }
    let clips = study.clips();
    let levels = study.level_clips();
    let at_rest = study.clips_at_rest();
    let total = clips.len() + levels.len() + at_rest.len();
    let mut ready = BTreeMap::new();
    let mut remarks = Remarks::default();
    let mut keep = |id: &str, source: Result<ClipSource, PrepareError>| match source {
        Ok(source) => drop(ready.insert(id.to_owned(), source)),
        Err(fault) => faults::add(&mut found, [fault]),
    };
    for (done, clip) in clips.iter().enumerate() {
        progress(Progress { done, total, what: &clip.id });
        let source = prepare_clip(study, clip, None, &sources, &cache, &mut remarks)
            .and_then(|source| sound::with_sound(study, clip, &sources, &cache, source));
        keep(&clip.id, source);
    }
    // Browsers solve a level when its answers ask for it; what they must find is known beforehand.
    for (done, level) in levels.iter().enumerate() {
        progress(Progress { done: clips.len() + done, total, what: &level.clip.id });
        let spec = Some(&level.method.spec);
        let source = prepare_clip(study, &level.clip, spec, &sources, &cache, &mut remarks);
        keep(&level.clip.id, source);
    }
    for (done, (clip, block)) in at_rest.iter().enumerate() {
        progress(Progress { done: clips.len() + levels.len() + done, total, what: &clip.id });
        keep(&clip.id, at_rest::clip_at_rest(study, clip, block, &sources, &cache));
    }
    if !found.is_empty() {
        return Err(found);
    }
    progress(Progress { done: total, total, what: "packs" });
    let mut warnings = remarks.warnings;
    let mut said = BTreeSet::new();
    warnings.retain(|warning| said.insert(warning.clone()));
    let prepared = Prepared { clips: ready, warnings };
    if let Some(key) = &key {
        known::keep(&cache, key, sources.asked(), &prepared).map_err(|fault| vec![fault])?;
    }
    Ok(prepared)
}

/// What the preview of a study draws of a clip whose capture is an exertion: what its weights were made of,
/// computed anew. None for other clips. Where it is not known where the study's files are, only what names none
/// can be computed.
///
/// # Errors
/// [`PrepareError`]: a file that is absent or damaged, frames that are not there.
pub fn exertion_drawing(
    study: &Study,
    clip: &Clip,
    places: Option<&Places>,
) -> Result<Option<ExertionDrawing>, PrepareError> {
    let nowhere = Places { study: PathBuf::new(), data: None, packs: PathBuf::new() };
    let sources = Sources::new(study, places.unwrap_or(&nowhere));
    let Some((id, own)) = sources.exertion_of(clip)? else { return Ok(None) };
    if places.is_none() && own.names_files() {
        let message = "its files are not at hand; open the motion in the studio";
        return Err(PrepareError::new(pointer(&["stimuli", "captures", id, "exertion"]), message));
    }
    sources.exertion_drawing(clip, id, own).map(Some)
}

/// What a clip is played from.
struct Ingredients {
    /// The method, the head's low-pass and held shapes written out.
    spec: MethodSpec,
    avatar: StoredPack,
    operators: StoredPack,
    take: StoredPack,
    /// Pointer of the segment.
    pointer: String,
    /// What the capture's repair is known by.
    repair: Option<String>,
}

/// Prepares a clip by its method, or by `spec` where that differs from the study's.
fn prepare_clip(
    study: &Study,
    clip: &Clip,
    spec: Option<&MethodSpec>,
    sources: &Sources<'_>,
    cache: &Cache,
    remarks: &mut Remarks,
) -> Result<ClipSource, PrepareError> {
    if let Some(video) = sources.video(clip)? {
        return prepare_video(study, clip, &video, cache);
    }
    let entry = study.stimuli.methods.get(&clip.method).ok_or_else(|| {
        PrepareError::new("/stimuli/methods", format!("no method {:?}; add it", clip.method))
    })?;
    let written = spec.unwrap_or(&entry.spec);
    let Ingredients { spec, avatar, operators, take, pointer: at, repair } = match written.method {
        Method::Recorded => recorded_clip(clip, written, sources, cache, remarks)?,
        _ => marker_clip(clip, written, sources, cache, remarks)?,
    };
    let solved = solve_packs(&operators.bytes, &take.bytes, &spec)
        .map_err(|e| PrepareError::new(method_pointer(clip), e))?;
    remarks.warnings.extend(solved.warnings.iter().map(|w| (at.clone(), w.to_string())));
    let gaze = GazeStatistics::of(&solved.shape_names, &solved.weights);
    let gaze = gaze.and_then(|gaze| gaze.warning(0));
    remarks.warnings.extend(gaze.map(|w| (at.clone(), format!("{}: {w}", clip.id))));
    let mut provenance = Provenance::new()
        .json("avatar", avatar.hash.as_str())
        .json("operators", operators.hash.as_str())
        .json("take", take.hash.as_str())
        .method(&spec)
        .json("weights", solved.weights_hash.as_str());
    if let Some(repair) = repair {
        provenance = provenance.json("repair", repair);
    }
    let packs = BTreeMap::from([&avatar, &operators, &take].map(|p| (&p.hash, p.bytes.len())));
    Ok(ClipSource {
        bytes: packs.values().map(|&bytes| bytes as u64).sum(),
        duration_ms: solved.frames() as f64 / solved.rate_hz * 1e3,
        avatar: avatar.hash,
        operators: operators.hash,
        take: take.hash,
        method: spec,
        provenance: provenance.hash(),
        weights_hash: solved.weights_hash,
        look: study.stimuli.avatars[&clip.avatar].look.word().to_owned(),
        video: None,
        sound: None,
        units: None,
    })
}

/// A clip of recorded weights. Nothing is solved: the page needs no operators, and loads the one pack
/// once.
fn recorded_clip(
    clip: &Clip,
    spec: &MethodSpec,
    sources: &Sources<'_>,
    cache: &Cache,
    remarks: &mut Remarks,
) -> Result<Ingredients, PrepareError> {
    let avatar = sources.avatar(&clip.avatar)?;
    let recording = sources.recording(&clip.segment, avatar.avatar.face_shapes())?;
    let take = cache.store(recorded(&recording, &avatar.avatar, &mut remarks.warnings)?)?;
    Ok(Ingredients {
        spec: spec.clone(),
        avatar: avatar_pack(&avatar, cache)?,
        operators: take.clone(),
        take,
        pointer: recording.pointer,
        repair: None,
    })
}

/// A clip that is solved from markers.
fn marker_clip(
    clip: &Clip,
    spec: &MethodSpec,
    sources: &Sources<'_>,
    cache: &Cache,
    remarks: &mut Remarks,
) -> Result<Ingredients, PrepareError> {
    let avatar = sources.avatar(&clip.avatar)?;
    let performance = sources.performance(&clip.segment, &avatar)?;
    let mut written = with_lowpass(spec, &performance);
    crate::lock_shapes(&mut written, &avatar.locked);
    let spec = performance.joined()?.with_shapes_held(&written);
    let method_pointer = method_pointer(clip);
    spec.validate().map_err(|e| PrepareError::new(&method_pointer, e))?;
    let learns = spec.method == Method::Regression;
    let training = learns.then(|| sources.training(&clip.method)).transpose()?;
    let wanted = Wanted {
        written: &written,
        spec: &spec,
        training: training.as_deref(),
        method_pointer: &method_pointer,
        performance: &performance,
        avatar: &avatar,
    };
    let (moved, operators, take) = to_solve(&wanted, cache, remarks)?;
    Ok(Ingredients {
        avatar: moved.map_or_else(|| avatar_pack(&avatar, cache), Ok)?,
        operators,
        take,
        repair: performance.repair(),
        spec: spec.at_rate(performance.rate_hz()),
        pointer: performance.pointer,
    })
}

/// The pack of an avatar that moves by its own shapes.
fn avatar_pack(avatar: &AvatarFile, cache: &Cache) -> Result<StoredPack, PrepareError> {
    let key = Provenance::default().json("pack", "avatar").json("avatar", avatar.key.as_str());
    cache.pack(&key, || Ok(avatar.pack()))
}

fn method_pointer(clip: &Clip) -> String {
    pointer(&["stimuli", "methods", &clip.method])
}

/// A video is served as it is.
fn prepare_video(
    study: &Study,
    clip: &Clip,
    video: &Video,
    cache: &Cache,
) -> Result<ClipSource, PrepareError> {
    let pack = cache.store(video.bytes.clone())?;
    let method = study.stimuli.methods.get(&clip.method).map(|entry| entry.spec.clone());
    Ok(ClipSource {
        bytes: pack.bytes.len() as u64,
        duration_ms: 0.0,
        provenance: Provenance::new().json("video", pack.hash.as_str()).hash(),
        avatar: pack.hash,
        operators: String::new(),
        take: String::new(),
        method: method.unwrap_or_else(|| MethodSpec::new(Method::Recorded)),
        weights_hash: String::new(),
        look: AvatarLook::Stimulus.word().to_owned(),
        video: Some(video.media_type.to_owned()),
        sound: None,
        units: None,
    })
}

/// The take pack of recorded weights, in the avatar's order of shapes.
fn recorded(
    recording: &Recording,
    avatar: &Avatar,
    warnings: &mut Vec<(String, String)>,
) -> Result<Vec<u8>, PrepareError> {
    let shape_names = &avatar.shape_names;
    let RecordedWeights { mut table, names } =
        RecordedWeights::with_expressions(&recording.table, shape_names, &avatar.expressions)
            .map_err(|error| PrepareError::new(&recording.pointer, error.to_string()))?;
    warnings.extend(recording.warnings.iter().cloned());
    warnings.extend(
        (names.warnings(!recording.is_computed).iter())
            .map(|w| (recording.pointer.clone(), w.to_string())),
    );
    let rate_hz = table.rate_hz().ok_or_else(|| {
        PrepareError::new(&recording.pointer, "fewer than two frames; give a longer recording")
    })?;
    if let Some(gaze) = &recording.gaze {
        gaze.put_into(&mut table).map_err(|e| PrepareError::new(&recording.pointer, e))?;
    }
    let frames = recording.frames.clone();
    let weights: Vec<f64> = frames.flat_map(|frame| table.row(frame).iter().copied()).collect();
    let take = TakePack {
        rate_hz,
        first_frame: table.frames[recording.frames.start],
        played: 0..recording.frames.len(),
        content: TakeContent::Weights { shape_names: shape_names.clone(), weights },
    };
    Ok(encode_take(&take))
}

/// The method with the head's low-pass that the capture asks for where the method names none.
fn with_lowpass(spec: &MethodSpec, performance: &Performance) -> MethodSpec {
    let mut spec = spec.clone();
    if spec.method.uses(Group::FrontEnd) {
        spec.head_lowpass_hz = spec.head_lowpass_hz.or(performance.head_lowpass_hz);
    }
    spec
}

/// A JSON pointer (RFC 6901) of its parts.
pub(crate) fn pointer(parts: &[&str]) -> String {
    parts.iter().map(|part| format!("/{}", part.replace('~', "~0").replace('/', "~1"))).collect()
}
