//! Layouts that were used before, rebuilt on any face from its landmarks: MPEG-4's feature points and Face
//! Robot's markers (thesis 3.5.1). SignCom and Sign3D have no published places; they can be given as maps.

use mimique_geometry::Point;

use crate::draws::draws;
use crate::face::Face;
use crate::units::Units;

/// A layout with a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedSet {
    /// Its name.
    pub name: String,
    /// Its vertices, in their order.
    pub vertices: Vec<usize>,
}

/// A place as shares of the way between landmarks: across from the middle (1 at a corner of the eye, of the
/// mouth …) and up.
struct Frame<'f> {
    face: &'f Face<'f>,
}

impl Frame<'_> {
    /// The foremost vertex nearest to a place seen from the front: metres from the middle plane and height.
    fn at(&self, across: f64, height: f64) -> usize {
        let mesh = &self.face.skin.mesh;
        let plane = &self.face.mirror.plane;
        let facing = |v: &usize| self.face.gradients.normal(*v).is_some_and(|n| n.z > 0.05);
        let front = |v: &usize| mesh.positions[*v].z > self.face.landmarks.ear_front_z;
        let square = |v: usize| {
            let p = mesh.positions[v];
            let (x, y) = (plane.distance(p) - across, p.y - height);
            // Of places in one line of sight the nearer one counts.
            x * x + y * y - 1e-6 * p.z
        };
        (0..mesh.positions.len())
            .filter(|v| facing(v) && front(v))
            .min_by(|&a, &b| square(a).total_cmp(&square(b)))
            .unwrap_or(0)
    }

    /// The same on both sides, left first.
    fn both(&self, across: f64, height: f64) -> [usize; 2] {
        [self.at(across, height), self.at(-across, height)]
    }
}

fn named(name: &str, vertices: Vec<usize>) -> NamedSet {
    let mut each: Vec<usize> = Vec::new();
    for v in vertices {
        if !each.contains(&v) {
            each.push(v);
        }
    }
    NamedSet { name: name.to_owned(), vertices: each }
}

/// Half the distance of two mirrored landmarks.
fn half(points: [Point; 2]) -> f64 {
    0.5 * (points[0] - points[1]).length()
}

/// MPEG-4's facial feature points (ISO/IEC 14496-2, annex C) on the skin: groups 2 (chin and inner lips),
/// 3 (lids), 4 (brows), 5 (cheeks), 8 (outer lips) and 9 (nose), 53 of them.
pub fn mpeg4(face: &Face<'_>) -> NamedSet {
    let (f, m) = (Frame { face }, &face.landmarks);
    let (eye, corner) = (half(m.eye), half(m.cheilion));
    let (outer, inner) = (half(m.exocanthion), half(m.endocanthion));
    let upper_lid = 0.5 * (m.lid[0][0].y + m.lid[1][0].y);
    let lower_lid = 0.5 * (m.lid[0][1].y + m.lid[1][1].y);
    let eye_y = 0.5 * (m.eye[0].y + m.eye[1].y);
    let lip = m.stomion.y;
    let upper = m.subnasale.y - lip;
    let lower = lip - m.sublabiale.y;
    let mut v = vec![f.at(0.0, m.gnathion.y + 0.004), f.at(0.0, m.pogonion.y)];
    v.extend(f.both(1.9 * corner, m.sublabiale.y));
    v.extend(f.both(0.6 * corner, m.pogonion.y));
    // Inner lips: the border itself.
    v.extend([f.at(0.0, lip + 0.15 * upper), f.at(0.0, lip - 0.15 * lower)]);
    v.extend(f.both(0.95 * corner, lip));
    v.extend(f.both(0.5 * corner, lip + 0.12 * upper));
    v.extend(f.both(0.5 * corner, lip - 0.12 * lower));
    for (x, y) in [(eye, upper_lid), (eye, lower_lid), (outer, eye_y), (inner, eye_y)] {
        v.extend(f.both(x, y));
    }
    v.extend(f.both(eye, lower_lid - 0.6 * (upper_lid - lower_lid)));
    v.extend(f.both(eye, upper_lid + 0.5 * (upper_lid - lower_lid)));
    for x in [0.9 * inner, eye, 1.15 * outer] {
        v.extend(f.both(x, m.brow_y));
    }
    v.extend(f.both(1.5 * corner, 0.5 * (lip + m.subnasale.y)));
    v.extend(f.both(1.1 * outer, m.pronasale.y));
    // Outer lips.
    v.extend([f.at(0.0, lip + 0.7 * upper), f.at(0.0, lip - 0.75 * lower)]);
    v.extend(f.both(1.08 * corner, lip));
    v.extend(f.both(0.55 * corner, lip + 0.55 * upper));
    v.extend(f.both(0.55 * corner, lip - 0.6 * lower));
    v.extend(f.both(0.18 * corner, lip + 0.72 * upper));
    v.extend(f.both(0.95 * inner, m.subnasale.y + 0.25 * (m.pronasale.y - m.subnasale.y)));
    v.extend([f.at(0.0, m.pronasale.y), f.at(0.0, m.subnasale.y)]);
    v.extend(f.both(0.4 * inner, 0.5 * (m.nasion.y + m.pronasale.y)));
    v.push(f.at(0.0, m.nasion.y));
    named("MPEG-4", v)
}

/// The 32 face markers of Autodesk's Face Robot: brows, lids, cheeks, nose, lips, chin and jaw.
pub fn face_robot(face: &Face<'_>) -> NamedSet {
    let (f, m) = (Frame { face }, &face.landmarks);
    let (eye, corner) = (half(m.eye), half(m.cheilion));
    let (outer, inner) = (half(m.exocanthion), half(m.endocanthion));
    let upper_lid = 0.5 * (m.lid[0][0].y + m.lid[1][0].y);
    let lower_lid = 0.5 * (m.lid[0][1].y + m.lid[1][1].y);
    let lip = m.stomion.y;
    let upper = m.subnasale.y - lip;
    let lower = lip - m.sublabiale.y;
    let mut v = Vec::new();
    for x in [0.9 * inner, eye, 1.15 * outer] {
        v.extend(f.both(x, m.brow_y));
    }
    v.extend(f.both(eye, upper_lid));
    v.extend(f.both(eye, lower_lid));
    v.push(f.at(0.0, m.pronasale.y));
    v.extend(f.both(0.95 * inner, m.subnasale.y + 0.25 * (m.pronasale.y - m.subnasale.y)));
    for (x, y) in [
        (eye, m.pronasale.y + 0.35 * (m.nasion.y - m.pronasale.y)),
        (1.15 * outer, m.pronasale.y),
        (1.55 * corner, 0.5 * (lip + m.subnasale.y)),
    ] {
        v.extend(f.both(x, y));
    }
    v.extend([f.at(0.0, lip + 0.6 * upper), f.at(0.0, lip - 0.65 * lower)]);
    v.extend(f.both(1.08 * corner, lip));
    v.extend(f.both(0.55 * corner, lip + 0.5 * upper));
    v.extend(f.both(0.55 * corner, lip - 0.55 * lower));
    v.push(f.at(0.0, m.pogonion.y));
    v.extend(f.both(0.7 * corner, m.pogonion.y));
    v.extend(f.both(1.8 * corner, m.sublabiale.y));
    named("Face Robot", v)
}

/// A mix of both, from which the thesis's MAN sets are thinned (3.5.2): MPEG-4's points, then those of Face
/// Robot that are not within 4 mm of one.
pub fn mixed(face: &Face<'_>) -> NamedSet {
    let mut all = mpeg4(face).vertices;
    for v in face_robot(face).vertices {
        let near = |&t: &usize| (face.place(t) - face.place(v)).length() < 0.004;
        if !all.iter().any(near) {
            all.push(v);
        }
    }
    named("MAN", all)
}

/// Units drawn at random until there are `count` markers or nothing fits.
pub fn random(units: &Units<'_>, count: usize, seed: u64, number: usize) -> Vec<Vec<usize>> {
    let mut draws = draws(seed, &format!("random {count} {number}"));
    let mut order: Vec<usize> = (0..units.each.len()).collect();
    draws.shuffle(&mut order);
    let mut taken = units.kept.clone();
    let mut chosen = Vec::new();
    for u in order {
        let unit = &units.each[u];
        if taken.len() + unit.len() <= count && units.fits(unit, &taken) {
            taken.extend(unit);
            chosen.push(unit.clone());
        }
    }
    chosen
}
