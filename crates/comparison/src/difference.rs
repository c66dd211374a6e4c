//! How far apart two motions of one face are, part by part.

use serde::{Deserialize, Serialize};

use crate::motion::length;
use crate::{ComparedFace, FaceMotion};

/// How far apart two motions are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Difference {
    /// Each part of the face, from above to below, then the whole `Face`.
    pub parts: Vec<PartDifference>,
    /// Lip vertex error, millimetres: the largest distance of a vertex of the lips, its mean over the frames
    /// (Richard et al., MeshTalk, ICCV 2021); none of an avatar without lips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lip_vertex_error_mm: Option<f64>,
    /// The same of the square of that distance, square millimetres: what published code computes under the name of lip
    /// vertex error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lip_vertex_error_mm2: Option<f64>,
    /// Upper-face dynamics deviation, square millimetres: the standard deviation over the frames of a vertex's squared
    /// distance from its place at rest, that of the first less that of the second, its mean over forehead, brows and
    /// eyes (Xing et al., CodeTalker, CVPR 2023). Above 0 where the second moves less; none of an avatar without parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper_face_deviation_mm2: Option<f64>,
    /// By how much the distance of the lips is another, its mean over the frames, millimetres; none without lips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lip_gap_error_mm: Option<f64>,
    /// Frames in which the lips of the first are shut, and in how many of them those of the second are; none without
    /// lips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lip_closures: Option<LipClosures>,
}

/// Frames in which lips are shut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LipClosures {
    /// Those in which the lips of the reference are.
    pub shut: usize,
    /// Those among them in which the other's are, too.
    pub kept: usize,
}

impl LipClosures {
    /// Lips that come nearer than `below_m` beyond their distance at rest are shut, metres; none without lips.
    pub fn of(reference: &FaceMotion, other: &FaceMotion, below_m: f64) -> Option<Self> {
        let closed = |gap: &f64| *gap < below_m;
        let kept = reference.gaps.iter().zip(&other.gaps).filter(|(a, b)| closed(a) && closed(b));
        (!reference.gaps.is_empty()).then(|| Self {
            shut: reference.gaps.iter().filter(|gap| closed(gap)).count(),
            kept: kept.count(),
        })
    }

    /// The share of the closures that is kept, 0 to 1; none where there is none.
    pub fn share_kept(&self) -> Option<f64> {
        (self.shut > 0).then(|| self.kept as f64 / self.shut as f64)
    }
}

/// How far apart a part of the face is in two motions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct PartDifference {
    /// `Forehead`, `Brow`, `Eye`, `Nose`, `Cheek`, `Mouth`, `Chin`, `Jaw` or `Face`.
    pub part: String,
    /// Root mean square distance of its vertices over all frames, millimetres.
    pub rms_mm: f64,
    /// Largest distance of one of its vertices, millimetres.
    pub largest_mm: f64,
    /// The frame of the largest, counted from 0.
    pub largest_frame: usize,
}

/// Why two motions cannot be held against each other.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotComparable {
    /// Other numbers of frames.
    #[error("{0} frames and {1}; cut both to the same frames")]
    Frames(usize, usize),
    /// Other rates.
    #[error("{0} and {1} frames per second; bring both to one rate")]
    Rates(f64, f64),
    /// Other skins.
    #[error("skins of {0} and {1} vertices; compare motions of one avatar")]
    Vertices(usize, usize),
}

/// Lips whose distance is below this beyond that at rest are shut, metres.
const SHUT_M: f64 = 1e-3;

/// How far `other` is from `reference`, both on the same face.
///
/// # Errors
/// [`NotComparable`]: other frames, rates or skins.
pub fn difference(
    face: &ComparedFace,
    reference: &FaceMotion,
    other: &FaceMotion,
) -> Result<Difference, NotComparable> {
    comparable(reference, other)?;
    let frames = reference.frames();
    let part = |name: &'static str, places: &[usize]| {
        let (mut squares, mut largest) = (0.0, (0.0, 0));
        for frame in 0..frames {
            for &v in places {
                let apart = length(reference.place(frame, v), other.place(frame, v));
                squares += apart * apart;
                if apart > largest.0 {
                    largest = (apart, frame);
                }
            }
        }
        let count = (frames * places.len()).max(1) as f64;
        PartDifference {
            part: name.to_owned(),
            rms_mm: 1e3 * (squares / count).sqrt(),
            largest_mm: 1e3 * largest.0,
            largest_frame: largest.1,
        }
    };
    let mut parts: Vec<PartDifference> =
        face.by_part().iter().map(|(which, places)| part(which.name(), places)).collect();
    let all: Vec<usize> = (0..face.vertices.len()).collect();
    parts.push(part("Face", &all));
    let worst_lip = |frame: usize| {
        let apart = |&v: &usize| length(reference.place(frame, v), other.place(frame, v));
        face.lips.iter().map(apart).fold(0.0, f64::max)
    };
    let worst_lips: Vec<f64> = (0..frames).map(worst_lip).collect();
    let lips = !face.lips.is_empty() && frames > 0;
    let mean_over_frames =
        |of: &dyn Fn(usize) -> f64| (0..frames).map(of).sum::<f64>() / frames as f64;
    let gap = |frame: usize| (reference.gaps[frame] - other.gaps[frame]).abs();
    let gaps = !face.lip_pairs.is_empty() && frames > 0;
    let upper = !face.upper.is_empty() && frames > 0;
    let deviation = |&v: &usize| spread_mm2(reference, v) - spread_mm2(other, v);
    Ok(Difference {
        parts,
        lip_vertex_error_mm: lips.then(|| 1e3 * mean_over_frames(&|frame| worst_lips[frame])),
        lip_vertex_error_mm2: lips
            .then(|| 1e6 * mean_over_frames(&|frame| worst_lips[frame].powi(2))),
        upper_face_deviation_mm2: upper
            .then(|| face.upper.iter().map(deviation).sum::<f64>() / face.upper.len() as f64),
        lip_gap_error_mm: gaps.then(|| 1e3 * mean_over_frames(&gap)),
        lip_closures: LipClosures::of(reference, other, SHUT_M),
    })
}

/// Standard deviation over the frames of a vertex's squared distance from its place at rest, square millimetres; the
/// divisor is the number of frames.
fn spread_mm2(motion: &FaceMotion, vertex: usize) -> f64 {
    let squares: Vec<f64> =
        (0..motion.frames()).map(|f| 1e6 * motion.displacement(f, vertex).powi(2)).collect();
    let count = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / count;
    (squares.iter().map(|square| (square - mean).powi(2)).sum::<f64>() / count).sqrt()
}

fn comparable(a: &FaceMotion, b: &FaceMotion) -> Result<(), NotComparable> {
    if a.vertices() != b.vertices() {
        return Err(NotComparable::Vertices(a.vertices(), b.vertices()));
    }
    if a.frames() != b.frames() {
        return Err(NotComparable::Frames(a.frames(), b.frames()));
    }
    // Rates of files are written with few digits.
    if (a.rate_hz - b.rate_hz).abs() > 1e-3 * a.rate_hz {
        return Err(NotComparable::Rates(a.rate_hz, b.rate_hz));
    }
    Ok(())
}
