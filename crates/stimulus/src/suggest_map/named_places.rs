//! Markers that are named for a landmark are drawn to it, and their neighbours with them.
//!
//! A similarity cannot lay a long nose on a short one: on a face of other proportions the best of them leaves
//! named markers some 7 mm beside their landmarks. The rest of the way is a smooth field of displacements, a
//! Gaussian process over the places of the named ones, which dies away where nothing is named.

use mimique_geometry::{DVec3, Displacement, Point, align_rigidly, solve_linear};
use mimique_solver::MirrorPlane;

use super::Face;
use super::label_words::{Named, Side, named_place};
use super::registration::similarity;
use crate::{AvatarSkin, Landmarks, Openings};

/// How far displacements go together, metres: about half the width of a mouth.
const LENGTH_M: f64 = 0.045;
/// The standard error of a landmark in units of the displacements' own deviation.
const NOISE: f64 = 0.35;
/// A landmark farther from its marker belongs to another label, metres.
const FARTHEST_M: f64 = 0.03;
/// Fewest named markers that a face is bent by.
const FEWEST: usize = 4;
/// Fewest named markers that say how the face lies and how large it is.
const FEWEST_TO_FIT: usize = 8;

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
        let pairs: Vec<(Vec<usize>, Point)> = (labels.iter().enumerate())
            .filter_map(|(marker, label)| {
                let (named, side) = named_place(label)?;
                Some((vec![marker], places.at(named, own(side))?))
            })
            .collect();
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
        let (laid, pairs) = fitted(laid, pairs);
        let laid = &laid[..];
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

/// The laid markers turned, moved and sized so that the named ones come to their places as well as they can.
fn fitted(
    laid: &[Point],
    pairs: Vec<(Point, Displacement)>,
) -> (Vec<Point>, Vec<(Point, Displacement)>) {
    if pairs.len() < FEWEST_TO_FIT {
        return (laid.to_vec(), pairs);
    }
    let (from, to): (Vec<Point>, Vec<Point>) = pairs.iter().map(|&(p, way)| (p, p + way)).unzip();
    let Ok(motion) = align_rigidly(&from, &to) else { return (laid.to_vec(), pairs) };
    let fit = similarity(&from, &to, motion);
    let ways = from.iter().zip(&to).map(|(&p, &q)| (fit.apply(p), q - fit.apply(p)));
    (laid.iter().map(|&p| fit.apply(p)).collect(), ways.collect())
}

/// Landmarks of an avatar, its brows and the bases of its nostrils.
struct Places {
    landmarks: Landmarks,
    /// Inner end, middle and outer end of the left and the right brow.
    brows: [Option<[Point; 3]>; 2],
    /// Where the wings of the nostrils meet the lip.
    nose_bases: [Option<Point>; 2],
}

impl Places {
    fn of(skin: &AvatarSkin, face: &Face) -> Option<Self> {
        let plane = MirrorPlane::of(&skin.mesh).ok()?;
        let openings = Openings::of(skin, &plane).ok()?;
        let landmarks = Landmarks::of(&skin.mesh, &openings, &plane).ok()?;
        let brows = [0, 1].map(|own| brow(skin, face, &landmarks, own));
        let nose_bases = [1.0, -1.0].map(|side| nose_base(skin, face, &landmarks, &plane, side));
        Some(Self { landmarks, brows, nose_bases })
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
            Named::NoseBase => self.nose_bases[own]?,
            Named::MouthCorner => marks.cheilion[own],
            // The borders of the red of the lips lie about half way to the nose's base, and to the fold below.
            Named::UpperLip => between(marks.stomion, marks.subnasale, 0.6),
            Named::LowerLip => between(marks.stomion, marks.sublabiale, 0.6),
            Named::Chin => between(marks.pogonion, marks.gnathion, 0.7),
        })
    }
}

/// Inner end, middle and outer end of a brow (Farkas 1994): it begins above the inner corner of the eye and ends on the line
/// from the wing of the nose past the outer corner, at about the height of the glabella.
fn brow(skin: &AvatarSkin, face: &Face, marks: &Landmarks, own: usize) -> Option<[Point; 3]> {
    let [inner, outer] = [marks.endocanthion[own], marks.exocanthion[own]];
    let aside = outer - inner;
    let size = marks.glabella.y - marks.nasion.y;
    let front = |at: Point, above: f64| {
        let y = marks.brow_y + above * size;
        let beside = |p: &Point| (p.x - at.x).hypot(p.y - y);
        let near = face.vertices.iter().map(|&v| skin.mesh.positions[v]);
        let found = near.min_by(|a, b| beside(a).total_cmp(&beside(b)))?;
        Some(Point::new(at.x, y, found.z))
    };
    Some([
        front(inner - aside * 0.25, -0.1)?,
        front(inner + aside * 0.6, 0.2)?,
        front(outer + aside * 0.4, -0.3)?,
    ])
}

/// Where the wing of a nostril meets the lip: below what stands out farthest sideways of the nose before it falls back to
/// the cheek.
fn nose_base(
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
    let wing = own.max_by(|a, b| plane.distance(*a).abs().total_cmp(&plane.distance(*b).abs()))?;
    // Its base, where it meets the lip.
    let base = marks.subnasale + (wing - marks.subnasale) * 0.75;
    Some(Point::new(base.x, marks.subnasale.y, base.z))
}
