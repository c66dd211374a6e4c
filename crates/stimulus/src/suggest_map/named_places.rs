//! Markers that are named for a landmark are drawn to it, and their neighbours with them.
//!
//! A similarity cannot lay a long nose on a short one: on a face of other proportions the best of them leaves
//! named markers some 7 mm beside their landmarks. The rest of the way is a smooth field of displacements, a
//! Gaussian process over the places of the named ones, which dies away where nothing is named.

use mimique_avatar::arkit_shapes;
use mimique_geometry::{DVec3, Displacement, Point, solve_linear};
use mimique_solver::MirrorPlane;

use super::Face;
use super::label_words::{Named, Region, Side, named_place, place_of};
use crate::{AvatarSkin, Landmarks, Openings};

/// How far displacements go together, metres: about half the width of a mouth.
const LENGTH_M: f64 = 0.03;
/// The standard error of a landmark in units of the displacements' own deviation.
const NOISE: f64 = 0.3;
/// A landmark farther from its marker belongs to another label, metres.
const FARTHEST_M: f64 = 0.03;
/// Fewest named markers that a face is bent by.
const FEWEST: usize = 4;
/// Vertices that a brow's shape moves by this share of the most are the brow.
const BROW: f64 = 0.5;
/// The share of a brow at each of its ends.
const END: f64 = 0.08;
/// Markers around an eye that stand for its middle.
const AROUND_EYE: usize = 3;

/// Markers and the places that their labels name.
pub(super) struct NamedPlaces {
    /// Markers that stand for the place together (their mean), and the place on the avatar.
    pairs: Vec<(Vec<usize>, Point)>,
}

impl NamedPlaces {
    /// The places that labels name on a skin. `swapped`: the labels' left is the viewer's. Nothing of an avatar
    /// whose landmarks are not found.
    pub fn of(skin: &AvatarSkin, face: &Face, labels: &[&str], swapped: bool) -> Self {
        let Some(places) = Places::of(skin, face) else { return Self { pairs: Vec::new() } };
        let own = |side: Side| if swapped { side.other() } else { side };
        let mut pairs: Vec<(Vec<usize>, Point)> = (labels.iter().enumerate())
            .filter_map(|(marker, label)| {
                let (named, side) = named_place(label)?;
                Some((vec![marker], places.at(named, own(side))?))
            })
            .collect();
        for side in [Side::Left, Side::Right] {
            let around: Vec<usize> = (labels.iter().enumerate())
                .filter(|(_, label)| place_of(label) == Some((Region::Eye, side)))
                .map(|(marker, _)| marker)
                .collect();
            let eye = usize::from(own(side) == Side::Right);
            if around.len() >= AROUND_EYE {
                pairs.push((around, places.landmarks.eye[eye]));
            }
        }
        Self { pairs }
    }

    /// How well the places that labels name say where each laid marker is: 1 for a named one, less the farther the
    /// nearest of them is, 0 where none is named.
    pub fn nearness(&self, laid: &[Point]) -> Vec<f64> {
        let bends = self.pairs.len() >= FEWEST;
        let near = |p: Point, markers: &[usize]| {
            let to = mimique_geometry::centroid(markers.iter().map(|&m| laid[m]));
            libm::exp(-(p - to).length_squared() / (2.0 * LENGTH_M * LENGTH_M))
        };
        let of =
            |p: &Point| self.pairs.iter().map(|(markers, _)| near(*p, markers)).fold(0.0, f64::max);
        laid.iter().map(|p| if bends { of(p) } else { 0.0 }).collect()
    }

    /// The laid markers drawn to the places that their labels name; as they are where too few are named.
    pub fn draw(&self, laid: &[Point]) -> Vec<Point> {
        let stands =
            |markers: &[usize]| mimique_geometry::centroid(markers.iter().map(|&m| laid[m]));
        let pairs: Vec<(Point, Displacement)> = (self.pairs.iter())
            .map(|(markers, place)| (stands(markers), *place - stands(markers)))
            .filter(|(_, way)| way.length() < FARTHEST_M)
            .collect();
        if pairs.len() < FEWEST {
            return laid.to_vec();
        }
        let near =
            |a: Point, b: Point| libm::exp(-(a - b).length_squared() / (2.0 * LENGTH_M * LENGTH_M));
        let count = pairs.len();
        let mut gram = vec![0.0; count * count];
        for (i, (a, _)) in pairs.iter().enumerate() {
            for (j, (b, _)) in pairs.iter().enumerate() {
                gram[i * count + j] = near(*a, *b) + if i == j { NOISE * NOISE } else { 0.0 };
            }
        }
        let mut weights: Vec<f64> = pairs.iter().flat_map(|(_, way)| way.to_array()).collect();
        if solve_linear(&gram, &mut weights, count).is_none() {
            return laid.to_vec();
        }
        laid.iter()
            .map(|&p| {
                let mut way = DVec3::ZERO;
                for (i, (at, _)) in pairs.iter().enumerate() {
                    way += near(p, *at) * DVec3::from_slice(&weights[3 * i..3 * i + 3]);
                }
                p + Displacement(way)
            })
            .collect()
    }
}

/// Landmarks of an avatar, and what its brows' shapes move.
struct Places {
    landmarks: Landmarks,
    /// Inner end, middle and outer end of the left and the right brow.
    brows: [Option<[Point; 3]>; 2],
    /// The wings of the nostrils.
    wings: [Option<Point>; 2],
}

impl Places {
    fn of(skin: &AvatarSkin, face: &Face) -> Option<Self> {
        let plane = MirrorPlane::of(&skin.mesh).ok()?;
        let openings = Openings::of(skin, &plane).ok()?;
        let landmarks = Landmarks::of(&skin.mesh, &openings, &plane).ok()?;
        let brows = ["browDownLeft", "browDownRight"].map(|shape| brow(skin, face, shape, &plane));
        let wings = [1.0, -1.0].map(|side| wing(skin, face, &landmarks, &plane, side));
        Some(Self { landmarks, brows, wings })
    }

    fn at(&self, named: Named, side: Side) -> Option<Point> {
        let marks = &self.landmarks;
        let own = usize::from(side == Side::Right);
        let between = |a: Point, b: Point, share: f64| a + (b - a) * share;
        Some(match named {
            Named::BrowInner => self.brows[own]?[0],
            Named::BrowMiddle => self.brows[own]?[1],
            Named::BrowOuter => self.brows[own]?[2],
            Named::NoseRoot => marks.nasion,
            Named::NoseTip => marks.pronasale,
            Named::NoseWing => self.wings[own]?,
            Named::MouthCorner => marks.cheilion[own],
            // The borders of the red of the lips lie about half way to the nose's base, and to the fold below.
            Named::UpperLip => between(marks.stomion, marks.subnasale, 0.5),
            Named::LowerLip => between(marks.stomion, marks.sublabiale, 0.6),
            Named::Chin => between(marks.pogonion, marks.gnathion, 0.7),
        })
    }
}

/// Inner end, middle and outer end of what a shape lowers.
fn brow(skin: &AvatarSkin, face: &Face, shape: &str, plane: &MirrorPlane) -> Option<[Point; 3]> {
    let index = skin.shape_names.iter().position(|name| arkit_shapes(name) == [shape])?;
    let moved = &skin.mesh.shapes[index];
    let reach = |v: usize| {
        moved.vertices.binary_search(&(v as u32)).map_or(0.0, |at| moved.deltas[at].length())
    };
    let most = face.vertices.iter().map(|&v| reach(v)).fold(0.0, f64::max);
    let mut own: Vec<(f64, Point, f64)> = (face.vertices.iter())
        .map(|&v| (v, reach(v)))
        .filter(|(_, reach)| most > 0.0 && *reach > BROW * most)
        .map(|(v, reach)| {
            let p = skin.mesh.positions[v];
            (plane.distance(p).abs(), p, (reach / most).powi(8))
        })
        .collect();
    own.sort_by(|a, b| a.0.total_cmp(&b.0));
    let end = ((END * own.len() as f64).ceil() as usize).max(1).min(own.len());
    let mean = |some: &[(f64, Point, f64)]| mimique_geometry::centroid(some.iter().map(|s| s.1));
    let total: f64 = own.iter().map(|each| each.2).sum();
    let middle = own.iter().map(|(_, p, weight)| *weight * p.0).sum::<DVec3>() / total;
    (!own.is_empty()).then(|| [mean(&own[..end]), Point(middle), mean(&own[own.len() - end..])])
}

/// The wing of a nostril: of the skin beside the nose's tip and base, what stands out farthest sideways before it falls
/// back to the cheek.
fn wing(
    skin: &AvatarSkin,
    face: &Face,
    marks: &Landmarks,
    plane: &MirrorPlane,
    side: f64,
) -> Option<Point> {
    let size = marks.nasion.y - marks.stomion.y;
    let height = marks.subnasale.y + 0.1 * (marks.pronasale.y - marks.subnasale.y);
    let depth = marks.subnasale.z - 0.06 * size;
    let beside = |p: &Point| {
        (p.y - height).abs() < 0.08 * size
            && p.z > depth
            && side * plane.distance(*p) > 0.0
            && plane.distance(*p).abs() < 0.3 * size
    };
    let own = face.vertices.iter().map(|&v| skin.mesh.positions[v]).filter(beside);
    own.max_by(|a, b| plane.distance(*a).abs().total_cmp(&plane.distance(*b).abs()))
}
