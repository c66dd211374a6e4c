//! Where each marker of a capture probably sits on an avatar, without anybody having said so: a
//! suggestion to be looked at and corrected, never used unseen.
//!
//! The neutral markers are laid on the part of the skin that shapes move ([`registration`]): from
//! every way up and round a capture may have, to the nearest vertices, again and again. Labels that
//! name a part of the face are drawn to what the avatar's shapes of that part move ([`anchors`]). Of
//! the ways that fit, the one counts whose markers move most where the avatar moves most, so that a
//! chin is not taken for a forehead.

mod anchors;
mod label_words;
mod motion;
mod named_places;
mod registration;

use std::ops::Range;

use mimique_geometry::{DVec3, Displacement, Point, centroid};
use mimique_mocap::{Capture, stillest};
use mimique_solver::SkinMesh;
use serde::Serialize;

use self::anchors::Anchors;
use self::label_words::{Region, Side, place_of};
use self::motion::{marker_motion, ranks_agree, rigid_to};
use self::named_places::NamedPlaces;
use self::registration::register;
use crate::{AvatarSkin, MapOrigin, MappedMarker, MarkerMap, MarkerPlace};

/// Farther than this from the skin a marker is not on it, metres.
pub const OFF_SKIN_M: f64 = 0.02;
/// A vertex that no shape moves farther is part of the skull, metres.
const SKULL_M: f64 = 1.5e-3;
/// A marker off the skin that moves less than this against the head belongs to it, metres.
const RIGID_M: f64 = 3e-3;
/// A marker so far from the skin is a third as sure as one on it, millimetres.
const FITS_MM: f64 = 10.0;
/// How many markers are named to be looked at first.
const LOOK_FIRST: usize = 5;
/// Fewest markers that a face is recognised by.
const FEWEST: usize = 6;

/// What a marker is taken for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MarkerRole {
    /// On the face.
    Face,
    /// On the skin where nothing moves: on the face, and good for the head's pose too.
    FaceAndHead,
    /// Off the skin, but moves with the head (a headband, a helmet).
    Head,
    /// Neither: left out.
    None,
}

/// Where one marker probably sits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuggestedMarker {
    /// The capture's label.
    pub label: String,
    /// What it is taken for.
    pub role: MarkerRole,
    /// Vertex of the welded skin, of a marker on the face.
    pub vertex: Option<usize>,
    /// The marker's neutral place laid on the avatar, metres.
    pub place: Point,
    /// From there to the skin, millimetres.
    pub distance_mm: f64,
    /// How sure the suggestion is, 0 to 1: by how near the places are that labels name, and the skin. Of labels that
    /// say nothing it is a half at most.
    pub confidence: f64,
}

/// A whole suggestion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuggestedMap {
    /// The markers that are seen while the face is neutral, in the capture's order.
    pub markers: Vec<SuggestedMarker>,
    /// Frames taken for neutral, counted from 0.
    pub neutral: Range<usize>,
    /// How far the markers on the face lie from the skin, millimetres rms.
    pub distance_rms_mm: f64,
    /// Size of the avatar's face in units of the actor's.
    pub scale: f64,
    /// How well what moves on the actor is what moves on the avatar: rank correlation, -1 to 1.
    pub motion_agreement: f64,
    /// What should be looked at.
    pub notes: Vec<String>,
}

/// Why nothing can be suggested.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SuggestMapError {
    /// Too few markers are seen while the face is neutral.
    #[error(
        "capture: {seen} markers are seen while the face is neutral (frames {start}:{end}), {FEWEST} \
         are needed; name other neutral frames, or write the marker map by hand"
    )]
    TooFew {
        /// Markers seen.
        seen: usize,
        /// First neutral frame.
        start: usize,
        /// One past the last.
        end: usize,
    },
    /// The neutral is not in the capture.
    #[error("neutral frames {start}:{end} of {frames}; give a range inside the capture")]
    Neutral {
        /// First frame.
        start: usize,
        /// One past the last.
        end: usize,
        /// Frames of the capture.
        frames: usize,
    },
    /// No shape moves any vertex that faces forward.
    #[error("avatar: no blendshape moves its face; nothing to lay the markers on")]
    NoFace,
}

/// Suggests where the markers of `capture` sit on `skin`; `neutral` are frames in which the face is
/// neutral, the stillest second where not given.
///
/// # Errors
/// [`SuggestMapError`]: too few markers, neutral frames outside the capture, an avatar without a face.
pub fn suggest_map(
    skin: &AvatarSkin,
    capture: &Capture,
    neutral: Option<Range<usize>>,
) -> Result<SuggestedMap, SuggestMapError> {
    let frames = capture.frames();
    let neutral = neutral
        .or_else(|| stillest(capture, 1.0).map(|found| found.frames))
        .unwrap_or(0..frames.min(60));
    let Range { start, end } = neutral;
    if start >= end || end > frames {
        return Err(SuggestMapError::Neutral { start, end, frames });
    }
    let rest = neutral_places(capture, start..end);
    let seen: Vec<usize> = (0..rest.len()).filter(|&m| rest[m].is_some()).collect();
    if seen.len() < FEWEST {
        return Err(SuggestMapError::TooFew { seen: seen.len(), start, end });
    }
    let points: Vec<Point> = seen.iter().filter_map(|&m| rest[m]).collect();
    let face = Face::of(&skin.mesh);
    if face.vertices.len() < FEWEST {
        return Err(SuggestMapError::NoFace);
    }
    let motion = marker_motion(capture, &seen, &points);
    let places: Vec<Point> = face.vertices.iter().map(|&v| skin.mesh.positions[v]).collect();
    let reach: Vec<f64> = face.vertices.iter().map(|&v| face.reach[v]).collect();
    let labels = seen.iter().map(|&m| capture.labels[m].as_str());
    let anchors = Anchors::of(skin, &face, labels, &points);
    let fit = register(&points, &places, &anchors, &|nearest| {
        let avatar: Vec<f64> = nearest.iter().map(|&v| reach[v]).collect();
        ranks_agree(&motion, &avatar)
    });

    let laid: Vec<Point> = points.iter().map(|&p| fit.apply(p)).collect();
    let names: Vec<&str> = seen.iter().map(|&m| capture.labels[m].as_str()).collect();
    let named = NamedPlaces::of(skin, &face, &names, anchors.swapped);
    let laid = named.draw(&laid);
    let vertices = face.distinct(&skin.mesh, &laid);
    let labels = seen.iter().map(|&m| capture.labels[m].as_str());
    let nearness = named.nearness(&laid);
    let mut markers = suggested(labels, &laid, &vertices, &face);
    for (marker, near) in markers.iter_mut().zip(nearness) {
        // The half of it is form, the other the names around.
        let skin = libm::exp(-marker.distance_mm / FITS_MM);
        marker.confidence = 0.5 * (1.0 + near) * skin;
    }
    let mut notes = Vec::new();
    let unsteady: Vec<f64> =
        motion.iter().zip(&vertices).map(|(m, (vertex, _))| m * face.reach[*vertex]).collect();
    complete_head(capture, &seen, &points, &unsteady, &mut markers, &mut notes);
    notes.extend(remarks(&markers, &anchors, fit.agreement));
    let on: Vec<f64> =
        (markers.iter()).filter(|m| m.vertex.is_some()).map(|m| m.distance_mm).collect();
    let square: f64 = on.iter().map(|d| d * d).sum();
    Ok(SuggestedMap {
        markers,
        neutral: start..end,
        distance_rms_mm: (square / on.len().max(1) as f64).sqrt(),
        scale: fit.scale,
        motion_agreement: fit.agreement,
        notes,
    })
}

/// The markers laid on the face, by their distance from the skin and whether it moves there.
fn suggested<'l>(
    labels: impl Iterator<Item = &'l str>,
    laid: &[Point],
    vertices: &[(usize, f64)],
    face: &Face,
) -> Vec<SuggestedMarker> {
    (labels.zip(laid).zip(vertices))
        .map(|((label, &place), &(vertex, distance))| {
            let on = distance <= OFF_SKIN_M;
            let role = match (on, face.reach[vertex] < SKULL_M) {
                (false, _) => MarkerRole::None,
                (true, true) if !moves_by_name(label) => MarkerRole::FaceAndHead,
                (true, true) => MarkerRole::Face,
                (true, false) => MarkerRole::Face,
            };
            SuggestedMarker {
                label: label.to_owned(),
                role,
                vertex: on.then_some(vertex),
                place,
                distance_mm: 1e3 * distance,
                confidence: 0.0,
            }
        })
        .collect()
}

/// Whether a label names a part of the face that moves against the skull.
fn moves_by_name(label: &str) -> bool {
    // The wings of the nostrils move, the root and the tip of the nose hardly do.
    place_of(label).is_some_and(|place| place != (Region::Nose, Side::Middle))
}

/// What should be looked at in a suggestion.
fn remarks(markers: &[SuggestedMarker], anchors: &Anchors, agreement: f64) -> Vec<String> {
    let mut notes = Vec::new();
    let left_out: Vec<&str> =
        (markers.iter()).filter(|m| m.role == MarkerRole::None).map(|m| m.label.as_str()).collect();
    if !left_out.is_empty() {
        notes.push(format!(
            "{} are more than {:.0} mm from the face and are left out",
            left_out.join(", "),
            1e3 * OFF_SKIN_M
        ));
    }
    let mut unsure: Vec<&SuggestedMarker> =
        markers.iter().filter(|m| m.role != MarkerRole::None && m.vertex.is_some()).collect();
    unsure.sort_by(|a, b| a.confidence.total_cmp(&b.confidence));
    let first: Vec<&str> = unsure.iter().take(LOOK_FIRST).map(|m| m.label.as_str()).collect();
    if !first.is_empty() {
        notes.push(format!("look first at {}, which are the least sure", first.join(", ")));
    }
    if anchors.swapped {
        notes.push("the labels' left is the viewer's left, the person's right".to_owned());
    }
    if anchors.actor.is_empty() {
        notes.push(
            "the labels name no parts of the face: laid by form and motion alone, look closely"
                .to_owned(),
        );
    }
    if agreement < 0.2 {
        notes.push(
            "what moves on the actor is not what moves on the avatar: the face may lie wrongly"
                .to_owned(),
        );
    }
    notes
}

impl SuggestedMap {
    /// The suggestion as a marker map: the face's markers at their vertices, and the head's.
    pub fn to_map(&self, skin: &AvatarSkin) -> MarkerMap {
        let face = self.markers.iter().filter_map(|m| {
            let place = MarkerPlace::Position(skin.mesh.positions[m.vertex?]);
            Some(MappedMarker { label: m.label.clone(), place })
        });
        let head = self
            .markers
            .iter()
            .filter(|m| matches!(m.role, MarkerRole::FaceAndHead | MarkerRole::Head));
        MarkerMap {
            avatar: Some(skin.name.clone()),
            face: face.collect(),
            head: head.map(|m| m.label.clone()).collect(),
            neutral: Some(self.neutral.clone()),
            origin: MapOrigin::Suggested,
            ..MarkerMap::default()
        }
    }
}

/// The mean place of each marker in the neutral frames, metres.
fn neutral_places(capture: &Capture, neutral: Range<usize>) -> Vec<Option<Point>> {
    let metres = capture.unit.metres();
    (0..capture.labels.len())
        .map(|m| {
            let seen = neutral.clone().map(|frame| capture.frame(frame)[m]);
            let mean = centroid(seen.filter(|p| p.is_finite()));
            mean.is_seen().then(|| mean.map(|x| x * metres))
        })
        .collect()
}

/// The part of a skin that can carry markers.
struct Face {
    /// Vertices in front, near what shapes move.
    vertices: Vec<usize>,
    /// How far each vertex of the skin is moved by the shape that moves it farthest, metres.
    reach: Vec<f64>,
}

impl Face {
    fn of(mesh: &SkinMesh) -> Self {
        let mut reach = vec![0.0_f64; mesh.positions.len()];
        for shape in &mesh.shapes {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                let most = &mut reach[v as usize];
                *most = most.max(d.length());
            }
        }
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (p, _) in mesh.positions.iter().zip(&reach).filter(|(_, r)| **r >= SKULL_M) {
            low = low.min(p.0);
            high = high.max(p.0);
        }
        // A forehead stands above what moves.
        high.y += 0.25 * (high.y - low.y);
        let normals = normals(mesh);
        let middle = 0.5 * (low.z + high.z);
        let inside = |p: Point| p.cmpge(low).all() && p.cmple(high).all();
        let vertices = (0..mesh.positions.len())
            .filter(|&v| {
                let p = mesh.positions[v];
                inside(p) && p.z > middle && normals[v].z > 0.0
            })
            .collect();
        Self { vertices, reach }
    }

    /// The nearest vertex of each place, none of them twice, and its distance; the nearest choose
    /// first.
    fn distinct(&self, mesh: &SkinMesh, places: &[Point]) -> Vec<(usize, f64)> {
        let mut found = vec![(0, f64::INFINITY); places.len()];
        let mut taken = vec![false; mesh.positions.len()];
        let nearest = |p: &Point, taken: &[bool]| {
            (self.vertices.iter().filter(|&&v| !taken[v]))
                .map(|&v| (v, (mesh.positions[v] - *p).length()))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap_or((0, f64::INFINITY))
        };
        let mut order: Vec<(usize, f64)> =
            places.iter().map(|p| nearest(p, &taken).1).enumerate().collect();
        order.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (m, _) in order {
            found[m] = nearest(&places[m], &taken);
            taken[found[m].0] = true;
        }
        found
    }
}

/// Unit normals of the vertices.
fn normals(mesh: &SkinMesh) -> Vec<Displacement> {
    let mut sums = vec![Displacement::ZERO; mesh.positions.len()];
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        let n = (b - a).cross(c - a);
        t.iter().for_each(|&v| sums[v as usize] += n);
    }
    sums.into_iter().map(|n| Displacement(n.normalize_or_zero())).collect()
}

/// Sees to at least three head markers: those off the skin that keep their distances (a headband),
/// else the ones on the face that are least `unsteady`.
fn complete_head(
    capture: &Capture,
    seen: &[usize],
    points: &[Point],
    unsteady: &[f64],
    markers: &mut [SuggestedMarker],
    notes: &mut Vec<String>,
) {
    let with = |markers: &[SuggestedMarker], roles: &[MarkerRole]| -> Vec<usize> {
        (0..markers.len()).filter(|&i| roles.contains(&markers[i].role)).collect()
    };
    let head = [MarkerRole::FaceAndHead, MarkerRole::Head];
    let join_rigid = |markers: &mut [SuggestedMarker], still: &[usize]| {
        let off = with(markers, &[MarkerRole::None]);
        for (&i, moved) in off.iter().zip(rigid_to(capture, seen, points, still, &off)) {
            if moved.is_some_and(|rms| rms < RIGID_M) {
                markers[i].role = MarkerRole::Head;
            }
        }
    };
    let still = with(markers, &head);
    if still.len() >= 3 {
        return join_rigid(markers, &still);
    }
    let off = with(markers, &[MarkerRole::None]);
    join_rigid(markers, &off);
    let missing = 4_usize.saturating_sub(with(markers, &head).len());
    if missing <= 1 {
        return;
    }
    // What its label says to move is no part of the skull, unless there is nothing else.
    let mut steady = with(markers, &[MarkerRole::Face]);
    let still_by_name: Vec<usize> =
        steady.iter().copied().filter(|&i| !moves_by_name(&markers[i].label)).collect();
    if still_by_name.len() >= 3 {
        steady = still_by_name;
    }
    steady.sort_by(|&a, &b| unsteady[a].total_cmp(&unsteady[b]));
    for i in steady.into_iter().take(missing) {
        markers[i].role = MarkerRole::FaceAndHead;
    }
    let still = with(markers, &head);
    notes.push(format!(
        "no three markers sit where the avatar's skin never moves: the head is taken from those \
         that move least ({})",
        still.iter().map(|&i| markers[i].label.as_str()).collect::<Vec<_>>().join(", ")
    ));
    join_rigid(markers, &still);
}
