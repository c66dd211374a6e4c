//! Landmarks of a face (Farkas, *Anthropometry of the Head and Face*, 1994), found from its openings and its
//! profile: what a person who puts markers on measures from.

use mimique_geometry::{Point, centroid};
use mimique_solver::{MirrorPlane, SkinMesh};
use serde::Serialize;

use super::openings::Openings;
use super::profile::Profile;

/// The points of a face that distances are measured from, on the neutral skin, metres; left and right are the
/// person's.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Landmarks {
    /// Deepest point of the root of the nose.
    pub nasion: Point,
    /// Foremost point between the brows.
    pub glabella: Point,
    /// Tip of the nose.
    pub pronasale: Point,
    /// Where the nose meets the upper lip.
    pub subnasale: Point,
    /// Where the lips meet in the middle.
    pub stomion: Point,
    /// Deepest point between lower lip and chin.
    pub sublabiale: Point,
    /// Foremost point of the chin.
    pub pogonion: Point,
    /// Lowest point of the chin.
    pub gnathion: Point,
    /// Outer corners of the eyes, left and right.
    pub exocanthion: [Point; 2],
    /// Inner corners of the eyes.
    pub endocanthion: [Point; 2],
    /// Middles of the eye openings.
    pub eye: [Point; 2],
    /// Upper and lower borders of the lids at their middles: left upper, left lower, right upper, right lower.
    pub lid: [[Point; 2]; 2],
    /// Corners of the mouth.
    pub cheilion: [Point; 2],
    /// Where the ears begin in front, measured along z, and how far down they reach, metres.
    pub ear_front_z: f64,
    /// Lowest points of the ears, left and right.
    pub ear_bottom: [Point; 2],
    /// Where the hair begins above the forehead, metres: as far above the glabella as that is above the nose's
    /// base, less a twentieth (the thirds of the face).
    pub hair_y: f64,
    /// Height of the brows, metres.
    pub brow_y: f64,
}

/// What cannot be found on a skin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoProfile;

impl Landmarks {
    /// Of a skin, its openings and its middle plane.
    ///
    /// # Errors
    /// `NoProfile` where the middle plane does not cut a nose and a chin out of the skin.
    pub fn of(
        mesh: &SkinMesh,
        openings: &Openings,
        plane: &MirrorPlane,
    ) -> Result<Self, NoProfile> {
        let profile = Profile::of(mesh, plane);
        let places = |vertices: &[usize]| -> Vec<Point> {
            vertices.iter().map(|&v| mesh.positions[v]).collect()
        };
        let eyes = openings.eyes.each_ref().map(|eye| Opening::of(&places(eye), plane));
        let mouth = Opening::of(&places(&openings.mouth), plane);
        let eye_y = 0.5 * (eyes[0].middle.y + eyes[1].middle.y);
        let mouth_y = mouth.middle.y;
        let size = eye_y - mouth_y;
        let [bottom, _] = profile.range().ok_or(NoProfile)?;
        let find = |low: f64, high: f64, of: &dyn Fn(Point) -> f64| {
            profile.most(low, high, of).ok_or(NoProfile)
        };
        let pronasale = find(mouth_y + 0.15 * size, eye_y - 0.1 * size, &|p| p.z)?;
        // The lower side of the nose turns back to the lip: the corner farthest back and below the tip.
        let subnasale =
            find(mouth_y + 0.12 * size, pronasale.y - 0.04 * size, &|p| -p.z + 0.5 * p.y)?;
        let [nasion, glabella] = root(&profile, pronasale, eye_y, size).ok_or(NoProfile)?;
        let sublabiale = find(mouth_y - 0.45 * size, mouth_y - 0.12 * size, &|p| -p.z)?;
        let pogonion = find(sublabiale.y - 0.5 * size, sublabiale.y, &|p| p.z)?;
        // Where the chin turns back to the neck, whose own profile goes farther down: not far behind the chin.
        let behind = pogonion.z - 0.35 * size;
        let gnathion = find(bottom.max(pogonion.y - 0.6 * size), pogonion.y, &|p| {
            if p.z < behind { f64::NEG_INFINITY } else { p.z - 2.0 * p.y }
        })?;
        let stomion = profile.at(mouth_y).ok_or(NoProfile)?;
        let ears = Ears::of(mesh, plane, [subnasale.y, glabella.y]);
        let hair_y = glabella.y + 0.95 * (glabella.y - subnasale.y);
        Ok(Self {
            brow_y: glabella.y,
            nasion,
            glabella,
            pronasale,
            subnasale,
            stomion,
            sublabiale,
            pogonion,
            gnathion,
            exocanthion: eyes.each_ref().map(|eye| eye.outer),
            endocanthion: eyes.each_ref().map(|eye| eye.inner),
            eye: eyes.each_ref().map(|eye| eye.middle),
            lid: eyes.each_ref().map(|eye| [eye.upper, eye.lower]),
            cheilion: [mouth.outer, mouth.inner],
            ear_front_z: ears.front_z,
            ear_bottom: ears.bottom,
            hair_y,
        })
    }

    /// The landmarks that a person measures from, with their names.
    pub fn measured(&self) -> Vec<(&'static str, Point)> {
        let [left, right] = [0, 1];
        vec![
            ("nasion", self.nasion),
            ("pronasale", self.pronasale),
            ("subnasale", self.subnasale),
            ("pogonion", self.pogonion),
            ("exocanthion left", self.exocanthion[left]),
            ("exocanthion right", self.exocanthion[right]),
            ("endocanthion left", self.endocanthion[left]),
            ("endocanthion right", self.endocanthion[right]),
            ("cheilion left", self.cheilion[left]),
            ("cheilion right", self.cheilion[right]),
        ]
    }
}

/// The root of the nose and the foremost point between the brows, above eyes at a height; `size` is how far the
/// eyes are above the mouth. Where the forehead only slopes back, neither deepest nor foremost point is there: the
/// root is then the point farthest behind the line from the tip of the nose to the forehead.
fn root(profile: &Profile, pronasale: Point, eye_y: f64, size: f64) -> Option<[Point; 2]> {
    let [low, high] = [eye_y - 0.15 * size, eye_y + 0.4 * size];
    let mut nasion = profile.most(low, high, |p| -p.z)?;
    if nasion.y > high - 0.03 * size {
        let forehead = profile.at(eye_y + 0.6 * size)?;
        let slope = (forehead.z - pronasale.z) / (forehead.y - pronasale.y);
        let behind = |p: Point| pronasale.z + slope * (p.y - pronasale.y) - p.z;
        nasion = profile.most(low, eye_y + 0.2 * size, behind)?;
    }
    let from = nasion.y + 0.05 * size;
    let foremost = profile.most(from, nasion.y + 0.45 * size, |p| p.z)?;
    let slopes_back = foremost.y < from + 0.03 * size;
    let glabella = if slopes_back { profile.at(nasion.y + 0.25 * size)? } else { foremost };
    Some([nasion, glabella])
}

/// The extremes of an opening.
struct Opening {
    middle: Point,
    /// Farthest from the middle plane on the left for a mouth, on its own side for an eye.
    outer: Point,
    /// The other end.
    inner: Point,
    upper: Point,
    lower: Point,
}

impl Opening {
    fn of(border: &[Point], plane: &MirrorPlane) -> Self {
        let middle = centroid(border.iter().copied());
        // An eye on the right has its outer corner on the right.
        let sign = if plane.distance(middle) < -0.005 { -1.0 } else { 1.0 };
        let most = |of: &dyn Fn(&Point) -> f64| {
            border.iter().copied().max_by(|a, b| of(a).total_cmp(&of(b))).unwrap_or(middle)
        };
        let aside = |p: &Point| (plane.distance(*p) - plane.distance(middle)).abs();
        Self {
            middle,
            outer: most(&|p| sign * plane.distance(*p)),
            inner: most(&|p| -sign * plane.distance(*p)),
            upper: most(&|p| p.y - aside(p)),
            lower: most(&|p| -p.y - aside(p)),
        }
    }
}

/// Where the ears are: what stands out farthest at the height of the nose.
struct Ears {
    front_z: f64,
    bottom: [Point; 2],
}

impl Ears {
    fn of(mesh: &SkinMesh, plane: &MirrorPlane, [low, high]: [f64; 2]) -> Self {
        let beside: Vec<Point> =
            mesh.positions.iter().copied().filter(|p| p.y > low && p.y < high).collect();
        let widest = beside.iter().fold(0.0_f64, |most, p| most.max(plane.distance(*p).abs()));
        let ear: Vec<Point> =
            beside.into_iter().filter(|p| plane.distance(*p).abs() > 0.9 * widest).collect();
        let front_z = ear.iter().fold(f64::NEG_INFINITY, |most, p| most.max(p.z));
        let bottom = [1.0, -1.0].map(|side| {
            let own = ear.iter().copied().filter(|p| side * plane.distance(*p) > 0.0);
            let lowest = own.reduce(|best, p| if p.y < best.y { p } else { best });
            lowest.unwrap_or(Point::new(side * widest, low, front_z))
        });
        Self { front_z, bottom }
    }
}
