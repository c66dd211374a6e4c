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
    /// Of the frames in which the lips of the first are shut, the share in which those of the second are not; none
    /// where the first never shuts them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lip_closure_misses: Option<f64>,
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
/// Lips whose distance is above this are not, metres: between the two nobody could say.
const OPEN_M: f64 = 2e-3;

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
    let lips = (!face.lips.is_empty() && frames > 0)
        .then(|| 1e3 * (0..frames).map(worst_lip).sum::<f64>() / frames as f64);
    Ok(Difference {
        parts,
        lip_vertex_error_mm: lips,
        lip_closure_misses: lip_closure_misses(&reference.gaps, &other.gaps),
    })
}

/// Of the frames in which the lips are shut, the share in which the other's are open.
fn lip_closure_misses(reference: &[f64], other: &[f64]) -> Option<f64> {
    let shut: Vec<usize> = (0..reference.len()).filter(|&f| reference[f] < SHUT_M).collect();
    let missed = shut.iter().filter(|&&f| other[f] > OPEN_M).count();
    (!shut.is_empty()).then(|| missed as f64 / shut.len() as f64)
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
