//! How far markers keep from each other, at rest and in motion.

use mimique_geometry::Point;
use serde::Serialize;

use crate::face::Face;
use crate::motion::FaceMotion;

/// Distance of markers where nothing else is said, metres.
pub const DISTANCE_M: f64 = 0.008;
/// Frames that the distances are held against beside those in which each shape is largest.
const EVENLY: usize = 96;

/// What keeps two markers apart in a camera's picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Camera {
    /// Distance from the face, metres.
    pub distance: f64,
    /// Focal length, metres.
    pub focal_length: f64,
    /// Size of a pixel on the sensor, metres.
    pub pixel: f64,
}

/// How near two markers may come.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Distance {
    /// This far, metres.
    Given(f64),
    /// Markers of a diameter (metres) are told apart by a camera where they are two diameters apart, and three
    /// pixels of their picture lie between them.
    Seen {
        /// Diameter of a marker.
        diameter: f64,
        /// The camera, where one is known.
        camera: Option<Camera>,
    },
}

impl Camera {
    /// What a pixel covers on the face, metres.
    pub fn pixel_on_face(&self) -> f64 {
        self.pixel * self.distance / self.focal_length
    }
}

impl Distance {
    /// In metres.
    pub fn metres(&self) -> f64 {
        match *self {
            Self::Given(metres) => metres,
            Self::Seen { diameter, camera } => {
                let pixels = camera.map_or(0.0, |camera| 3.0 * camera.pixel_on_face());
                (2.0 * diameter).max(diameter + pixels)
            }
        }
    }
}

/// The two of some vertices that come nearest to each other in any frame of a motion, and how near, metres; none
/// of fewer than two.
pub fn nearest_in_motion(
    face: &Face<'_>,
    motion: &FaceMotion,
    vertices: &[usize],
) -> Option<([usize; 2], f64)> {
    let rest = vec![0.0; motion.basis.width];
    let mut least: Option<([usize; 2], f64)> = None;
    for frame in motion.frames().chain([&rest[..]]) {
        let places: Vec<Point> =
            vertices.iter().map(|&v| face.place(v) + motion.basis.displacement(v, frame)).collect();
        for (i, p) in places.iter().enumerate() {
            for (j, q) in places[..i].iter().enumerate() {
                let apart = (*p - *q).length();
                if least.is_none_or(|(_, distance)| apart < distance) {
                    least = Some(([vertices[j], vertices[i]], apart));
                }
            }
        }
    }
    least
}

/// Which vertices are far enough apart, on the neutral face and in the frames of its motion.
#[derive(Debug, Clone)]
pub struct Spacing<'a> {
    minimum: f64,
    rest: &'a [Point],
    /// For each vertex its place in the frames (none for vertices that may have no marker).
    moved: Vec<Vec<Point>>,
    /// How far each vertex goes from its rest in these frames, metres.
    farthest: Vec<f64>,
}

impl<'a> Spacing<'a> {
    /// Of some vertices of a face, by the frames of its motion in which it is moved most.
    pub fn of(face: &'a Face<'_>, motion: &FaceMotion, vertices: &[usize], minimum: f64) -> Self {
        let frames = motion.telling_frames(EVENLY);
        let count = face.skin.mesh.positions.len();
        let (mut moved, mut farthest) = (vec![Vec::new(); count], vec![0.0_f64; count]);
        for &v in vertices {
            let rest = face.place(v);
            let places: Vec<Point> =
                frames.iter().map(|frame| rest + motion.basis.displacement(v, frame)).collect();
            farthest[v] = places.iter().fold(0.0, |most, p| most.max((*p - rest).length()));
            moved[v] = places;
        }
        Self { minimum, rest: &face.skin.mesh.positions, moved, farthest }
    }

    /// At rest alone.
    pub fn at_rest(face: &'a Face<'_>, minimum: f64) -> Self {
        let count = face.skin.mesh.positions.len();
        let rest = &face.skin.mesh.positions;
        Self { minimum, rest, moved: vec![Vec::new(); count], farthest: vec![0.0; count] }
    }

    /// The distance, metres.
    pub fn minimum(&self) -> f64 {
        self.minimum
    }

    /// Whether two vertices are nowhere nearer than the distance.
    pub fn apart(&self, a: usize, b: usize) -> bool {
        let rest = (self.rest[a] - self.rest[b]).length();
        if rest < self.minimum {
            return false;
        }
        if rest - self.farthest[a] - self.farthest[b] >= self.minimum {
            return true;
        }
        let least = self.minimum * self.minimum;
        let pairs = self.moved[a].iter().zip(&self.moved[b]);
        pairs.into_iter().all(|(p, q)| (*p - *q).length_squared() >= least)
    }

    /// Whether a vertex is far enough from all of some others.
    pub fn apart_from_all(&self, vertex: usize, others: &[usize]) -> bool {
        others.iter().all(|&other| self.apart(vertex, other))
    }
}
