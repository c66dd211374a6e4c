//! A layout: markers with labels in the order in which they are placed, and the head's.

use std::collections::BTreeMap;

use mimique_geometry::Point;
use mimique_solver::{FaceMoments, MarkerSite, SkinMesh, best_heads, head_error};
use mimique_stimulus::{MappedMarker, MarkerMap, MarkerPlace};
use serde::Serialize;
use serde_json::{Value, json};

use crate::candidates::seen;
use crate::error::LayoutError;
use crate::face::{Excluded, Face, FacePart};
use crate::spacing::Spacing;

/// Skin that no shape moves by more carries head markers, metres.
pub const HEAD_STILL_M: f64 = 2e-4;
/// Noise of head markers that the error of the head's pose is told for, metres.
pub const HEAD_NOISE_M: f64 = 3e-4;
/// Most places that head markers are sought among.
const HEAD_PLACES: usize = 600;

/// Left, right or middle of the person.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// The person's left.
    Left,
    /// The person's right.
    Right,
    /// In the middle plane.
    Middle,
}

impl Side {
    /// L, R or M.
    pub fn letter(self) -> char {
        match self {
            Self::Left => 'L',
            Self::Right => 'R',
            Self::Middle => 'M',
        }
    }

    /// The side that a point is on; within half a millimetre of the middle plane it is in the middle.
    pub fn of(face: &Face<'_>, p: Point) -> Self {
        let distance = face.mirror.plane.distance(p);
        if distance.abs() < 5e-4 {
            Self::Middle
        } else if distance > 0.0 {
            Self::Left
        } else {
            Self::Right
        }
    }
}

/// A marker of a layout.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LayoutMarker {
    /// Its label: `Mouth_L3`.
    pub label: String,
    /// The vertex of the welded skin.
    pub vertex: usize,
    /// The part of the face; none of a head marker.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<FacePart>,
    /// The side.
    pub side: Side,
}

/// Face and head markers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Layout {
    /// The face's, in the order in which they are placed.
    pub markers: Vec<LayoutMarker>,
    /// The head's.
    pub head: Vec<LayoutMarker>,
}

impl Layout {
    /// Labels for units of face markers in their order, and for head markers: part of the face, side, number;
    /// the two of a pair share the number.
    pub fn named(face: &Face<'_>, units: &[Vec<usize>], head: &[usize]) -> Self {
        let mut numbers: BTreeMap<FacePart, usize> = BTreeMap::new();
        let mut markers: Vec<LayoutMarker> = Vec::new();
        for unit in units {
            let part = face.part(unit[0]);
            let number = numbers.entry(part).or_default();
            *number += 1;
            for &vertex in unit {
                let side = Side::of(face, face.place(vertex));
                let label = format!("{}_{}{number}", part.name(), side.letter());
                markers.push(LayoutMarker { label, vertex, part: Some(part), side });
            }
        }
        let head = head.iter().enumerate().map(|(number, &vertex)| {
            let side = Side::of(face, face.place(vertex));
            let label = format!("Head_{}{}", side.letter(), number + 1);
            LayoutMarker { label, vertex, part: None, side }
        });
        Self { head: head.collect(), markers }
    }

    /// The vertices of the face markers, in order.
    pub fn vertices(&self) -> Vec<usize> {
        self.markers.iter().map(|marker| marker.vertex).collect()
    }

    /// The layout as a marker map that `solve` reads: every face marker at its place, the labels of the head's.
    pub fn to_map(&self, face: &Face<'_>) -> MarkerMap {
        let placed = |marker: &LayoutMarker| MappedMarker {
            label: marker.label.clone(),
            place: MarkerPlace::Position(face.place(marker.vertex)),
        };
        MarkerMap {
            avatar: Some(face.skin.name.clone()),
            face: self.markers.iter().map(placed).collect(),
            head: self.head.iter().map(|marker| marker.label.clone()).collect(),
            ..MarkerMap::default()
        }
    }

    /// The map as JSON, with `about` and the places of the head markers under `layout`.
    pub fn to_json(&self, face: &Face<'_>, about: Value) -> String {
        let mut about = about;
        let head: serde_json::Map<String, Value> = (self.head.iter())
            .map(|marker| (marker.label.clone(), json!({"position": face.place(marker.vertex)})))
            .collect();
        if !head.is_empty() {
            about["head"] = Value::Object(head);
        }
        self.to_map(face).to_json_with(&[("layout", about)])
    }
}

/// Places of head markers, and the error that their noise makes on the face.
#[derive(Debug, Clone, PartialEq)]
pub struct Heads {
    /// The vertices.
    pub vertices: Vec<usize>,
    /// Root mean square error on the face, in the unit of the noise.
    pub error: f64,
}

/// The places of a map's head markers, as far as they are known: those that are face markers, too, and those
/// that a layout's own file names under `layout.head`; `text` is the file's.
pub fn head_places(
    labels: &[String],
    sites: &[MarkerSite],
    mesh: &SkinMesh,
    text: &str,
) -> Vec<(String, Point)> {
    let file: Value = serde_json::from_str(text).unwrap_or(Value::Null);
    let named = |label: &String| -> Option<(String, Point)> {
        if let Some(site) = sites.iter().find(|site| site.label == *label) {
            return Some((label.clone(), site.position(mesh)));
        }
        let place = &file["layout"]["head"][label]["position"];
        let number = |axis: usize| place[axis].as_f64();
        Some((label.clone(), Point::new(number(0)?, number(1)?, number(2)?)))
    };
    labels.iter().filter_map(named).collect()
}

/// The places of `count` head markers with the least error of the head's pose on the face: on skin that hardly
/// moves, seen from in front, off ears and neck, at a distance from each other and from `taken`.
///
/// # Errors
/// [`LayoutError::TooFewHeads`] for fewer than three, [`LayoutError::NoHead`] where not so many find room.
pub fn choose_heads(
    face: &Face<'_>,
    spacing: &Spacing<'_>,
    taken: &[usize],
    count: usize,
    noise: f64,
) -> Result<Heads, LayoutError> {
    if count < 3 {
        return Err(LayoutError::TooFewHeads(count));
    }
    let seen = seen(face);
    let neck = Excluded::Neck.mask(face);
    let may = |&v: &usize| {
        face.reach[v] < HEAD_STILL_M
            && seen[v]
            && !neck[v]
            && !on_an_ear(face, v)
            && spacing.apart_from_all(v, taken)
    };
    let all: Vec<usize> = (0..face.skin.mesh.positions.len()).filter(may).collect();
    let places = thinned(face, &all);
    let none = LayoutError::NoHead { found: places.len(), wanted: count };
    if places.len() < count {
        return Err(none);
    }
    let points: Vec<Point> = places.iter().map(|&v| face.place(v)).collect();
    let moments = face_moments(face);
    let fits =
        |chosen: &[usize], i: usize| chosen.iter().all(|&c| spacing.apart(places[c], places[i]));
    let found = best_heads(&points, &moments, count, &fits).ok_or(none)?;
    let chosen: Vec<Point> = found.iter().map(|&i| points[i]).collect();
    let error = head_error(&chosen, &moments, noise).unwrap_or(f64::INFINITY);
    let mut vertices: Vec<usize> = found.into_iter().map(|i| places[i]).collect();
    // From front to back, left before right.
    vertices.sort_by(|&a, &b| {
        let key = |v: usize| (-face.place(v).z, -face.place(v).x);
        key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
    });
    Ok(Heads { vertices, error })
}

/// At most [`HEAD_PLACES`] of some vertices, with the mirror image of each that is among them.
fn thinned(face: &Face<'_>, all: &[usize]) -> Vec<usize> {
    let mirror = &face.mirror;
    let left: Vec<usize> = all.iter().copied().filter(|&v| mirror.from_middle[v] >= 0.0).collect();
    let step = all.len().div_ceil(HEAD_PLACES).max(1);
    let mut places: Vec<usize> = left.into_iter().step_by(step).collect();
    let others: Vec<usize> = places.iter().map(|&v| mirror.of[v]).collect();
    places.extend(others.into_iter().filter(|v| all.binary_search(v).is_ok()));
    places.sort_unstable();
    places.dedup();
    places
}

/// The face that the error of a pose is told of: what the shapes move.
pub fn face_moments(face: &Face<'_>) -> FaceMoments {
    let moved = |v: &usize| face.reach[*v] >= crate::candidates::MOVED_M;
    let points: Vec<Point> =
        (0..face.skin.mesh.positions.len()).filter(moved).map(|v| face.place(v)).collect();
    FaceMoments::of(&points)
}

/// Whether a vertex is on an ear, which bends, or hidden by one.
fn on_an_ear(face: &Face<'_>, vertex: usize) -> bool {
    let (p, marks) = (face.place(vertex), &face.landmarks);
    let widest = face.mirror.plane.distance(marks.ear_bottom[0]).abs();
    let height = p.y - marks.ear_bottom[0].y.min(marks.ear_bottom[1].y);
    face.mirror.plane.distance(p).abs() > 0.6 * widest
        && (-0.055..0.008).contains(&(p.z - marks.ear_front_z))
        && (-0.008..0.075).contains(&height)
}
