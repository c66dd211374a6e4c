//! Whether the clips of one segment are the same but for the method, and in which millimetres the methods differ.
//!
//! Camera and light are the stage's and one for all clips: what can differ is how long clips are, when their frames are
//! shown, where head and eyes are turned to, and when they blink.

use std::collections::BTreeMap;

use mimique_avatar::pack::{PackError, decode_pack};
use mimique_avatar::{EyeAngles, GazeShapes, HEAD_POSE_SHAPES, HeadAngles, blinks};
use mimique_clip::{
    MarkerTake, SolvePacksError, SolvedTake, TakeContent, decode_operators, decode_take,
    marker_motion, solve_packs,
};
use mimique_solver::{MeshError, Method};
use mimique_stimulus::AvatarSkin;
use mimique_study::{Clip, ClipSource, Study};
use serde::{Deserialize, Serialize};

use crate::difference::{Difference, difference};
use crate::markers::{correlations, median_correlation};
use crate::{ClipCourses, ClipMeasures, ComparedFace, FaceMotion, measures};

/// Heads that are turned this many degrees from each other are seen to.
const HEAD_DEG: f64 = 1.0;
/// Eyes that look this many degrees aside from each other are seen to.
const GAZE_DEG: f64 = 1.0;
/// Shapes that shut the eyes by more show a blink, and by less than the second do not.
const BLINK: [f64; 2] = [0.6, 0.2];
/// Clips that end this many milliseconds after each other are as long.
const DURATION_MS: f64 = 1.0;

/// The clips of a study held against each other.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct StudyComparison {
    /// What two clips of one segment have not in common, though only the method should differ.
    pub unlike: Vec<Unlike>,
    /// How far apart the faces of every two clips of one segment and one avatar are.
    pub differences: Vec<ClipDifference>,
    /// What is measured of each clip.
    pub measures: Vec<ClipMeasures>,
}

/// What two clips of one segment have not in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Unlike {
    /// The segment.
    pub segment: String,
    /// Both clips.
    pub clips: [String; 2],
    /// What it is.
    #[serde(flatten)]
    pub what: Disagreement,
}

/// What should be the same and is not. Frames are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "what", rename_all = "camelCase", rename_all_fields = "camelCase")]
pub enum Disagreement {
    /// One is longer.
    Duration {
        /// How long both are, milliseconds.
        milliseconds: [f64; 2],
    },
    /// Their frames are shown at other times.
    FrameTimes {
        /// Frames per second of both.
        rates_hz: [f64; 2],
    },
    /// Their heads are turned elsewhere.
    HeadPose {
        /// By how many degrees, in the worst frame.
        degrees: f64,
        /// That frame.
        frame: usize,
    },
    /// Their eyes look elsewhere.
    Gaze {
        /// By how many degrees an eye is turned aside, in the worst frame.
        degrees: f64,
        /// That frame.
        frame: usize,
    },
    /// One blinks where the other does not.
    Blink {
        /// By how much the eyes of both are shut, 0 to 1, in the worst frame.
        shut: [f64; 2],
        /// That frame.
        frame: usize,
    },
}

impl Unlike {
    /// What differs, and what to do about it.
    pub fn words(&self) -> (String, &'static str) {
        let [a, b] = &self.clips;
        let (what, remedy) = match self.what {
            Disagreement::Duration { milliseconds: [first, second] } => (
                format!("last {first:.0} and {second:.0} ms"),
                "cut both to the same frames and give the capture one \"rateHz\"",
            ),
            Disagreement::FrameTimes { rates_hz: [first, second] } => (
                format!("show {first} and {second} frames per second"),
                "give the capture one \"rateHz\"",
            ),
            Disagreement::HeadPose { degrees, frame } => (
                format!("turn their heads {degrees:.1} degrees from each other in frame {frame}"),
                "give all captures of the segment the same \"headMotion\"; 0 holds every head still",
            ),
            Disagreement::Gaze { degrees, frame } => (
                format!("look {degrees:.1} degrees aside from each other in frame {frame}"),
                "give the capture a \"gaze\", which every method then shows",
            ),
            Disagreement::Blink { shut: [first, second], frame } => (
                format!("shut their eyes by {first:.2} and {second:.2} in frame {frame}"),
                "drive the lids of both by lid markers, or lock eyeBlink in both methods",
            ),
        };
        (format!("{a} and {b} differ in more than the method: they {what}"), remedy)
    }
}

/// How far apart the faces of two clips are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ClipDifference {
    /// The segment.
    pub segment: String,
    /// The avatar.
    pub avatar: String,
    /// Both clips.
    pub clips: [String; 2],
    /// Their methods.
    pub methods: [String; 2],
    /// In millimetres.
    #[serde(flatten)]
    pub difference: Difference,
}

/// Why clips cannot be compared: a pack that is absent or damaged.
#[derive(Debug, thiserror::Error)]
pub enum ComparisonError {
    /// A pack cannot be read.
    #[error("pack {hash}: {error}; prepare the study again")]
    Read {
        /// Its hash.
        hash: String,
        /// Why.
        error: std::io::Error,
    },
    /// A pack is no avatar's.
    #[error("pack {hash}: {error}")]
    Avatar {
        /// Its hash.
        hash: String,
        /// Why.
        error: PackError,
    },
    /// The avatar has no skin.
    #[error("avatar {avatar}: {error}")]
    Skin {
        /// Its identifier.
        avatar: String,
        /// Why.
        error: MeshError,
    },
    /// A clip is not solved.
    #[error("clip {clip}: {error}")]
    Solve {
        /// Its identifier.
        clip: String,
        /// Why.
        error: Box<SolvePacksError>,
    },
}

/// Where packs are read from, by their hashes.
pub type ReadPack<'r> = &'r dyn Fn(&str) -> std::io::Result<Vec<u8>>;

/// Holds the clips of each segment of a study against each other. Videos have no weights and are left out.
///
/// # Errors
/// [`ComparisonError`] where packs are absent or damaged.
pub fn compare_clips(
    study: &Study,
    sources: &BTreeMap<String, ClipSource>,
    read: ReadPack<'_>,
) -> Result<StudyComparison, ComparisonError> {
    // Clips that differ by their sound alone show the same face.
    let mut clips: Vec<Clip> = Vec::new();
    for clip in study.clips() {
        if !clips.iter().any(|own| shows_the_same(own, &clip)) {
            clips.push(clip);
        }
    }
    let mut faces = Faces { read, skins: BTreeMap::new(), faces: BTreeMap::new() };
    let mut comparison = StudyComparison::default();
    // Surfaces last: the other clips of an avatar tell its landmarks.
    let of_shapes = |source: &&ClipSource| source.method.method != Method::ThinShellSurface;
    for clip in &clips {
        if let Some(source) = sources.get(&clip.id).filter(of_shapes).filter(|s| s.video.is_none())
        {
            faces.open(clip, source)?;
        }
    }
    for segment in &study.stimuli.segments {
        let drawn = |clip: &&Clip| {
            clip.segment == segment.id && sources.get(&clip.id).is_some_and(|s| s.video.is_none())
        };
        let shown: Vec<Shown> = (clips.iter().filter(drawn))
            .map(|clip| faces.shown(clip, &sources[&clip.id]))
            .collect::<Result<_, _>>()?;
        for (second, b) in shown.iter().enumerate() {
            for a in &shown[..second] {
                hold(a, b, &faces, &mut comparison);
            }
        }
        let of = |own: &Shown<'_>| {
            let SolvedTake { shape_names, weights, rate_hz, .. } = &own.solved;
            let courses = || ClipCourses::of(shape_names, weights, *rate_hz);
            let courses = study.mimicry.is_some().then(courses);
            ClipMeasures { courses, ..measured(own, &shown, &faces) }
        };
        comparison.measures.extend(shown.iter().map(of));
    }
    // With another sound the face moves as it does.
    for clip in study.clips() {
        let twin = clips.iter().find(|own| shows_the_same(own, &clip) && own.id != clip.id);
        let measured = |twin: &Clip| comparison.measures.iter().find(|own| own.clip == twin.id);
        if let Some(measures) = twin.and_then(measured).cloned() {
            comparison.measures.push(ClipMeasures { clip: clip.id, ..measures });
        }
    }
    Ok(comparison)
}

/// Whether two clips show the same face: they may differ by their sound.
fn shows_the_same(a: &Clip, b: &Clip) -> bool {
    [&a.avatar, &a.segment, &a.method] == [&b.avatar, &b.segment, &b.method]
}

/// A clip as it is shown.
struct Shown<'c> {
    clip: &'c Clip,
    method: Method,
    solved: SolvedTake,
    /// Median correlation of the skin with the markers; none of recorded weights.
    marker_correlation: Option<f64>,
    motion: FaceMotion,
    head: Vec<HeadAngles>,
    eyes: Vec<EyeAngles>,
    /// By how much the eyes are shut in each frame; empty where no shape shuts them.
    shut: Vec<f64>,
}

/// What is measured of a clip: by itself, against its markers, and against the recorded face of its segment.
fn measured(own: &Shown<'_>, all: &[Shown<'_>], faces: &Faces<'_>) -> ClipMeasures {
    let face = &faces.faces[&own.clip.avatar];
    let mut found = ClipMeasures::of_motion(&own.clip.id, &measures(face, &own.motion));
    let residual = own.solved.statistics.as_ref().map(|statistics| statistics.residual_rms_mm);
    found.add("obj_residual_mm", residual);
    found.add("obj_marker_correlation", own.marker_correlation);
    let recorded = |other: &&Shown<'_>| {
        other.method == Method::Recorded
            && other.clip.avatar == own.clip.avatar
            && other.clip.id != own.clip.id
    };
    // Of two recordings neither is the one that was meant.
    let mut recordings = all.iter().filter(recorded);
    if let (Some(recording), None) = (recordings.next(), recordings.next())
        && let Ok(difference) = difference(face, &recording.motion, &own.motion)
    {
        found.add_recorded(&difference);
    }
    found
}

/// What one clip has that the other has not, and how far apart they are.
fn hold(a: &Shown<'_>, b: &Shown<'_>, faces: &Faces<'_>, comparison: &mut StudyComparison) {
    let clips = [a.clip.id.clone(), b.clip.id.clone()];
    let segment = a.clip.segment.clone();
    let mut unlike = Vec::new();
    let length = |shown: &Shown<'_>| shown.solved.frames() as f64 / shown.solved.rate_hz * 1e3;
    let milliseconds = [length(a), length(b)];
    let rates_hz = [a.solved.rate_hz, b.solved.rate_hz];
    if (milliseconds[0] - milliseconds[1]).abs() > DURATION_MS {
        unlike.push(Disagreement::Duration { milliseconds });
    }
    if (rates_hz[0] - rates_hz[1]).abs() > 1e-3 * rates_hz[0] {
        unlike.push(Disagreement::FrameTimes { rates_hz });
    } else {
        unlike.extend(head_apart(&a.head, &b.head));
        unlike.extend(gaze_apart(&a.eyes, &b.eyes));
        unlike.extend(blink_apart(&a.shut, &b.shut));
    }
    let new = unlike.into_iter();
    comparison.unlike.extend(new.map(|what| Unlike {
        segment: segment.clone(),
        clips: clips.clone(),
        what,
    }));
    let face = faces.faces.get(&a.clip.avatar).filter(|_| a.clip.avatar == b.clip.avatar);
    if let Some(Ok(difference)) = face.map(|face| difference(face, &a.motion, &b.motion)) {
        comparison.differences.push(ClipDifference {
            segment,
            avatar: a.clip.avatar.clone(),
            clips,
            methods: [a.clip.method.clone(), b.clip.method.clone()],
            difference,
        });
    }
}

/// Where the heads of two clips are farthest from being turned alike; none where nobody sees it.
fn head_apart(a: &[HeadAngles], b: &[HeadAngles]) -> Option<Disagreement> {
    let both = a.iter().zip(b).map(|(a, b)| a.apart(b));
    let (frame, degrees) = both.enumerate().max_by(|x, y| x.1.total_cmp(&y.1))?;
    (degrees > HEAD_DEG).then_some(Disagreement::HeadPose { degrees, frame })
}

/// Where the eyes of two clips are farthest from looking alike; none where nobody sees it.
fn gaze_apart(a: &[EyeAngles], b: &[EyeAngles]) -> Option<Disagreement> {
    let apart = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| match (a, b) {
        (Some(a), Some(b)) => (a[0] - b[0]).hypot(a[1] - b[1]),
        _ => 0.0,
    };
    let both = a.iter().zip(b).map(|(a, b)| apart(a.left, b.left).max(apart(a.right, b.right)));
    let (frame, degrees) = both.enumerate().max_by(|x, y| x.1.total_cmp(&y.1))?;
    (degrees > GAZE_DEG).then_some(Disagreement::Gaze { degrees, frame })
}

/// The frame in which one clip's eyes are shut and the other's are open, and most so.
fn blink_apart(a: &[f64], b: &[f64]) -> Option<Disagreement> {
    let differs = |(a, b): (f64, f64)| a.max(b) > BLINK[0] && a.min(b) < BLINK[1];
    let frames = a.iter().copied().zip(b.iter().copied()).enumerate();
    let (frame, (a, b)) = frames
        .filter(|(_, pair)| differs(*pair))
        .max_by(|x, y| (x.1.0 - x.1.1).abs().total_cmp(&(y.1.0 - y.1.1).abs()))?;
    Some(Disagreement::Blink { shut: [a, b], frame })
}

/// How the skin goes with the markers; none where nothing was solved for shapes.
fn with_markers(
    operators: &[u8],
    take: &[u8],
    source: &ClipSource,
    solved: &SolvedTake,
) -> Result<Option<f64>, SolvePacksError> {
    let take = decode_take(take)?;
    let TakeContent::Markers(markers) = &take.content else { return Ok(None) };
    let operators = decode_operators(operators)?;
    let parts = operators.parts();
    let (n, own) = (parts.shape_names.len(), solved.shape_names.len());
    if n > own {
        return Ok(None);
    }
    let marker_take = MarkerTake { markers, rate_hz: take.rate_hz, played: take.played.clone() };
    let motion = marker_motion(&operators, &marker_take, &source.method)?;
    // Shapes that turn the head stand behind those that are solved for.
    let weights: Vec<f64> =
        solved.weights.chunks_exact(own).flat_map(|row| row[..n].iter().copied()).collect();
    let of = |rows| correlations(&parts.marker_labels, rows, &motion.displacements, &weights);
    Ok(median_correlation(&of(&parts.marker_deltas)))
}

/// Avatars that were opened: skins by their packs, faces by the avatars' identifiers.
struct Faces<'r> {
    read: ReadPack<'r>,
    skins: BTreeMap<String, AvatarSkin>,
    faces: BTreeMap<String, ComparedFace>,
}

impl Faces<'_> {
    fn shown<'c>(
        &mut self,
        clip: &'c Clip,
        source: &ClipSource,
    ) -> Result<Shown<'c>, ComparisonError> {
        self.open(clip, source)?;
        let [operators, take] = [&source.operators, &source.take].map(|hash| self.bytes(hash));
        let (operators, take) = (operators?, take?);
        let failed =
            |error| ComparisonError::Solve { clip: clip.id.clone(), error: Box::new(error) };
        let solved = solve_packs(&operators, &take, &source.method).map_err(failed)?;
        let marker_correlation =
            with_markers(&operators, &take, source, &solved).map_err(failed)?;
        let skin = &self.skins[&source.avatar];
        let n = skin.shape_names.len();
        // Shapes of the body stand after those of the face.
        let own = solved.shape_names.len();
        let rows = solved.weights.chunks_exact(own.max(1));
        let weights: Vec<f64> = rows.flat_map(|row| row[..n.min(own)].iter().copied()).collect();
        let face = &self.faces[&clip.avatar];
        let motion = FaceMotion::of(skin, face, &weights, solved.rate_hz);
        let gaze = GazeShapes::of(&solved.shape_names);
        let shutting: Vec<usize> = (0..own).filter(|&k| blinks(&solved.shape_names[k])).collect();
        let frames = || solved.weights.chunks_exact(own.max(1));
        let eyes = frames().map(|row| gaze.eyes(row)).collect();
        let turning =
            HEAD_POSE_SHAPES.map(|name| solved.shape_names.iter().position(|own| own == name));
        let angles = |row: &[f64]| {
            HeadAngles::of_weights(turning.map(|shape| shape.map_or(0.0, |k| row[k])))
        };
        let head = frames().map(angles).collect();
        let mean = |row: &[f64]| {
            shutting.iter().map(|&k| row[k]).sum::<f64>() / shutting.len().max(1) as f64
        };
        let shut = if shutting.is_empty() { Vec::new() } else { frames().map(mean).collect() };
        let method = source.method.method;
        Ok(Shown { clip, method, motion, head, eyes, shut, solved, marker_correlation })
    }

    /// The skin of a clip's pack, and the face of its avatar: a moved surface has the avatar's vertices and none of
    /// the shapes that tell its landmarks.
    fn open(&mut self, clip: &Clip, source: &ClipSource) -> Result<(), ComparisonError> {
        if !self.skins.contains_key(&source.avatar) {
            let hash = &source.avatar;
            let avatar = decode_pack(&self.bytes(hash)?)
                .map_err(|error| ComparisonError::Avatar { hash: hash.clone(), error })?;
            let skin = AvatarSkin::of(&avatar)
                .map_err(|error| ComparisonError::Skin { avatar: clip.avatar.clone(), error })?;
            self.skins.insert(hash.clone(), skin);
        }
        let skin = &self.skins[&source.avatar];
        if !self.faces.contains_key(&clip.avatar) {
            self.faces.insert(clip.avatar.clone(), ComparedFace::of(skin));
        }
        Ok(())
    }

    fn bytes(&self, hash: &str) -> Result<Vec<u8>, ComparisonError> {
        (self.read)(hash).map_err(|error| ComparisonError::Read { hash: hash.to_owned(), error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blink_of_one_is_found_in_its_frame_and_half_shut_eyes_are_none() {
        let lids = [0.0, 0.1, 0.9, 0.95, 0.1];
        assert_eq!(blink_apart(&lids, &lids), None);
        assert_eq!(blink_apart(&lids, &[0.0, 0.1, 0.5, 0.5, 0.1]), None);
        let found = blink_apart(&lids, &[0.0, 0.1, 0.1, 0.05, 0.1]);
        assert_eq!(found, Some(Disagreement::Blink { shut: [0.95, 0.05], frame: 3 }));
        assert_eq!(blink_apart(&[], &lids), None);
    }

    #[test]
    fn heads_that_are_turned_apart_are_found_in_their_frame() {
        let head = |nod: f64| HeadAngles { nod, ..HeadAngles::default() };
        assert_eq!(head_apart(&[head(3.0)], &[head(3.9)]), None);
        let found = head_apart(&[head(0.0), head(3.0)], &[head(0.5), head(-1.0)]);
        assert_eq!(found, Some(Disagreement::HeadPose { degrees: 4.0, frame: 1 }));
    }

    #[test]
    fn a_gaze_that_nobody_sees_apart_is_the_same() {
        let eye =
            |azimuth: f64| EyeAngles { left: Some([azimuth, 0.0]), right: Some([azimuth, 0.0]) };
        assert_eq!(gaze_apart(&[eye(3.0)], &[eye(3.9)]), None);
        let found = gaze_apart(&[eye(0.0), eye(3.0)], &[eye(0.0), eye(-2.0)]);
        assert_eq!(found, Some(Disagreement::Gaze { degrees: 5.0, frame: 1 }));
    }
}
