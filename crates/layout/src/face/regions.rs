//! Parts of a face by its landmarks: those that may have no marker, and those that errors and labels are told
//! of.

use std::fmt;
use std::str::FromStr;

use mimique_geometry::Point;
use serde::Serialize;

use super::Face;
use super::openings::moved_by;
use crate::view::{DepthPicture, View};

/// Distance from the border of the eye that markers keep, metres.
const LID_M: f64 = 0.005;
/// What a blink moves farther is lid, metres.
const BLINK_M: f64 = 0.002;
/// Distance from the border of the mouth that is the inner lip, metres.
const INNER_LIP_M: f64 = 0.004;
/// Width of the lips from the border of the mouth on, metres: no beard grows there.
const LIPS_M: f64 = 0.010;
/// Markers keep away from the ears by this in front of them, metres.
const BEFORE_EAR_M: f64 = 0.012;
/// The brows reach this far from what their shapes move most, metres.
const BROW_M: f64 = 0.004;
/// The share of the most that the brows' shapes move which the brows themselves are moved by.
const BROW_SHARE: f64 = 0.85;
/// Farther than this from the base of the nose there is no nostril, metres.
const NOSTRIL_REACH_M: f64 = 0.022;
/// Of the directions in front of and below the face, a nostril is seen from fewer than this share of those
/// that its skin looks towards.
const NOSTRIL_SEEN: f64 = 0.55;

/// A part of the face that may be kept free of markers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Excluded {
    /// The lids: within 5 mm of the border of an eye, or moved by 2 mm when it shuts.
    Lids,
    /// The inner lips: within 4 mm of the border of the mouth.
    LipsInner,
    /// The insides of the nostrils.
    Nostrils,
    /// The ears and what is behind them.
    Ears,
    /// Below chin and jaw.
    Neck,
    /// Above the hair line.
    Hair,
    /// The brows.
    Brows,
    /// Where a beard grows.
    Beard,
}

impl Excluded {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Lids,
        Self::LipsInner,
        Self::Nostrils,
        Self::Ears,
        Self::Neck,
        Self::Hair,
        Self::Brows,
        Self::Beard,
    ];
    /// Those that are excluded where nothing else is said.
    pub const USUAL: [Self; 6] =
        [Self::Lids, Self::LipsInner, Self::Nostrils, Self::Ears, Self::Neck, Self::Hair];

    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Lids => "lids",
            Self::LipsInner => "lips-inner",
            Self::Nostrils => "nostrils",
            Self::Ears => "ears",
            Self::Neck => "neck",
            Self::Hair => "hair",
            Self::Brows => "brows",
            Self::Beard => "beard",
        }
    }

    /// Whether each vertex is in it.
    pub fn mask(self, face: &Face<'_>) -> Vec<bool> {
        let marks = &face.landmarks;
        let positions = &face.skin.mesh.positions;
        let each = |of: &dyn Fn(Point) -> bool| -> Vec<bool> {
            positions.iter().map(|&p| of(p)).collect()
        };
        match self {
            Self::Lids => {
                let blink = moved_by(face.skin, &["eyeBlinkLeft", "eyeBlinkRight"]);
                let border: Vec<usize> = face.openings.eyes.concat();
                let near = near(face, &border, LID_M);
                near.into_iter().zip(blink).map(|(near, moved)| near || moved > BLINK_M).collect()
            }
            Self::LipsInner => near(face, &face.openings.mouth, INNER_LIP_M),
            Self::Nostrils => nostrils(face),
            Self::Ears => each(&|p| p.z < marks.ear_front_z + BEFORE_EAR_M),
            Self::Neck => each(&|p| below_the_jaw(face, p)),
            Self::Hair => each(&|p| p.y > marks.hair_y),
            Self::Brows => brows(face),
            Self::Beard => {
                let lips = near(face, &face.openings.mouth, LIPS_M);
                let grows = |(p, lip): (&Point, bool)| p.y < marks.subnasale.y && !lip;
                positions.iter().zip(lips).map(grows).collect()
            }
        }
    }
}

impl fmt::Display for Excluded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl FromStr for Excluded {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|region| region.word() == word).ok_or_else(|| {
            let words: Vec<&str> = Self::ALL.iter().map(|region| region.word()).collect();
            format!("{word:?} is no part of a face; use {}", words.join(", "))
        })
    }
}

/// Which vertices are within a distance (metres) of some vertices.
fn near(face: &Face<'_>, of: &[usize], distance: f64) -> Vec<bool> {
    let positions = &face.skin.mesh.positions;
    let near = |p: &Point| of.iter().any(|&v| (positions[v] - *p).length() <= distance);
    positions.iter().map(near).collect()
}

/// Below the plane through the chin's lowest point and two points 25 mm below the ears.
fn below_the_jaw(face: &Face<'_>, p: Point) -> bool {
    let marks = &face.landmarks;
    let under_ear = 0.5 * (marks.ear_bottom[0].y + marks.ear_bottom[1].y) - 0.025;
    let ear_z = 0.5 * (marks.ear_bottom[0].z + marks.ear_bottom[1].z);
    let depth = marks.gnathion.z - ear_z;
    let back = if depth > 0.0 { ((marks.gnathion.z - p.z) / depth).max(0.0) } else { 0.0 };
    p.y < marks.gnathion.y + 0.002 + back * (under_ear - marks.gnathion.y)
}

/// What the brows' own shapes move most, and a rim around it.
fn brows(face: &Face<'_>) -> Vec<bool> {
    let mut core: Vec<usize> = Vec::new();
    let names = ["browDownLeft", "browDownRight", "browOuterUpLeft", "browOuterUpRight"];
    for name in names {
        let moved = moved_by(face.skin, &[name]);
        let most = moved.iter().fold(0.0_f64, |most, m| most.max(*m));
        core.extend((0..moved.len()).filter(|&v| most > 0.0 && moved[v] >= BROW_SHARE * most));
    }
    near(face, &core, BROW_M)
}

/// What is near the base of the nose and hardly seen from anywhere in front of it.
fn nostrils(face: &Face<'_>) -> Vec<bool> {
    let mesh = &face.skin.mesh;
    let base = face.landmarks.subnasale;
    let reach = |p: Point| (p - base).length() < NOSTRIL_REACH_M;
    let near: Vec<usize> =
        (0..mesh.positions.len()).filter(|&v| reach(mesh.positions[v])).collect();
    let mut out = vec![false; mesh.positions.len()];
    let mut seen = vec![[0_usize; 2]; near.len()];
    let heights = [base.y - 0.06, base.y + 0.06];
    // The face is tilted instead of the view: directions in front, from 60 degrees below to 20 above.
    for tilt in [-60.0_f64, -40.0, -20.0, 0.0, 20.0] {
        let (sine, cosine) = libm::sincos(tilt.to_radians());
        let tilted = |p: Point| {
            let d = p - base;
            Point::new(d.x, d.y * cosine - d.z * sine, d.y * sine + d.z * cosine)
        };
        let mut turned = mimique_solver::SkinMesh {
            positions: mesh.positions.iter().map(|&p| tilted(p)).collect(),
            triangles: Vec::new(),
            shapes: Vec::new(),
        };
        // Only what is around the nose can stand before it.
        let around = |t: &&[u32; 3]| (mesh.positions[t[0] as usize] - base).length() < 0.06;
        turned.triangles = mesh.triangles.iter().filter(around).copied().collect();
        for degrees in [-60.0, -30.0, 0.0, 30.0, 60.0] {
            let view = View::turned(degrees);
            let heights = [heights[0] - base.y, heights[1] - base.y];
            let picture = DepthPicture::of(&turned, view, heights, 0.0005);
            for (&v, counts) in near.iter().zip(&mut seen) {
                let normal = tilted(base + face.gradients.normal(v).unwrap_or_default());
                if normal.0.dot(view.towards()) < 0.2 {
                    continue;
                }
                counts[0] += usize::from(picture.sees(turned.positions[v], 0.001));
                counts[1] += 1;
            }
        }
    }
    for (v, [seen, of]) in near.into_iter().zip(seen) {
        out[v] = of == 0 || (seen as f64) < NOSTRIL_SEEN * of as f64;
    }
    out
}

/// A part of the face that errors and labels are told of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FacePart {
    /// Above the brows.
    Forehead,
    /// The brows and between them.
    Brow,
    /// Around the eyes.
    Eye,
    /// The nose.
    Nose,
    /// The cheeks.
    Cheek,
    /// Lips and what is around them.
    Mouth,
    /// The chin.
    Chin,
    /// Beside the chin, up to the ears.
    Jaw,
}

impl FacePart {
    /// All of them, from above to below.
    pub const ALL: [Self; 8] = [
        Self::Forehead,
        Self::Brow,
        Self::Eye,
        Self::Nose,
        Self::Cheek,
        Self::Mouth,
        Self::Chin,
        Self::Jaw,
    ];

    /// Its name as labels begin: `Mouth`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Forehead => "Forehead",
            Self::Brow => "Brow",
            Self::Eye => "Eye",
            Self::Nose => "Nose",
            Self::Cheek => "Cheek",
            Self::Mouth => "Mouth",
            Self::Chin => "Chin",
            Self::Jaw => "Jaw",
        }
    }

    /// The part that a point of the skin belongs to.
    pub fn of(face: &Face<'_>, p: Point) -> Self {
        let marks = &face.landmarks;
        let aside = face.mirror.plane.distance(p).abs();
        let size = marks.nasion.y - marks.stomion.y;
        let eye = marks.eye.iter().map(|eye| (*eye - p).length()).fold(f64::INFINITY, f64::min);
        let half_mouth = 0.5 * (marks.cheilion[0] - marks.cheilion[1]).length();
        // The mouth is the line between its corners.
        let across = (aside - half_mouth).max(0.0);
        let mouth = across.hypot(p.y - marks.stomion.y);
        let above_lip = p.y < marks.subnasale.y;
        if p.y > marks.brow_y + 0.20 * size {
            Self::Forehead
        } else if p.y > marks.brow_y - 0.08 * size {
            Self::Brow
        } else if aside < 0.25 * size && !above_lip {
            Self::Nose
        } else if eye < 0.32 * size || p.y > marks.eye[0].y - 0.12 * size {
            Self::Eye
        } else if mouth < 0.24 * size && (above_lip || across > 0.0) {
            Self::Mouth
        } else if p.y < marks.sublabiale.y + 0.04 * size && aside < 0.34 * size {
            Self::Chin
        } else if p.y < marks.stomion.y - 0.06 * size {
            Self::Jaw
        } else {
            Self::Cheek
        }
    }
}
