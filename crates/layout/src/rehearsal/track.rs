//! The trajectory of a marker in a simulated take.

use std::sync::OnceLock;

use mimique_geometry::{Displacement, Point};
use mimique_solver::MarkerSite;

use super::{Effort, Person};
use crate::draws::draws;
use crate::face::Face;
use crate::motion::{Basis, FaceMotion};

/// Frames that the neutral face of a capture is the mean of.
const NEUTRAL_FRAMES: f64 = 60.0;
/// Share of the shapes that play in a frame where no motion is known; each with a weight between 0 and 1.
const PLAYING: f64 = 0.15;

/// A take that is played: a person, and what the face does.
pub(super) struct SimulatedTake {
    person: Person,
    /// Frames x width.
    pub(super) coefficients: Vec<f64>,
    /// What each marker measures, by the vertex that it is meant for.
    tracks: Vec<OnceLock<Track>>,
}

/// What a marker measures.
pub(super) struct Track {
    /// Its place on the neutral face, metres.
    pub(super) neutral: Point,
    /// Frames x 3, metres.
    pub(super) positions: Vec<f64>,
}

impl SimulatedTake {
    pub(super) fn new(person: Person, coefficients: Vec<f64>, vertices: usize) -> Self {
        let tracks = (0..vertices).map(|_| OnceLock::new()).collect();
        Self { person, coefficients, tracks }
    }

    pub(super) fn frames(&self, width: usize) -> usize {
        self.coefficients.len() / width
    }

    /// The track of a vertex, made where it is asked for first.
    pub(super) fn track(&self, vertex: usize, make: impl FnOnce() -> Track) -> &Track {
        self.tracks[vertex].get_or_init(make)
    }
}

impl Track {
    /// Of a marker that sits at a site; the noise has a stream of the take and the vertex.
    pub(super) fn of(
        face: &Face<'_>,
        basis: &Basis,
        take: &SimulatedTake,
        site: &MarkerSite,
        (noise, seed, number, vertex): (f64, u64, usize, usize),
    ) -> Self {
        let width = basis.width;
        let on_avatar = site.position(&face.skin.mesh);
        // The rows of the site in the basis: 3 x width.
        let mut rows = vec![0.0; 3 * width];
        for (corner, weight) in site.parts() {
            let own = basis.of(corner);
            rows.iter_mut().zip(own).for_each(|(r, d)| *r += weight * d);
        }
        let mut draws = draws(seed, &format!("noise {number} {vertex}"));
        let mut off = |deviation: f64| {
            let [x, y, z] = [draws.normal(), draws.normal(), draws.normal()];
            Displacement::new(deviation * x, deviation * y, deviation * z)
        };
        let rest = take.person.place(on_avatar);
        let neutral = rest + off(noise / NEUTRAL_FRAMES.sqrt());
        let mut positions = Vec::with_capacity(3 * take.frames(width));
        for frame in take.coefficients.chunks_exact(width) {
            let along = |axis: usize| -> f64 {
                let row = &rows[axis * width..(axis + 1) * width];
                row.iter().zip(frame).map(|(d, c)| d * c).sum()
            };
            let moved = Displacement::new(along(0), along(1), along(2));
            let place = rest + take.person.displacement(moved) + off(noise);
            positions.extend(place.to_array());
        }
        Self { neutral, positions }
    }
}

/// The frames of a take: spread over the motion, others in each take; drawn where no motion is known.
pub(super) fn played_frames(
    motion: &FaceMotion,
    effort: Effort,
    take: usize,
    seed: u64,
) -> Vec<f64> {
    let all: Vec<&[f64]> = motion.frames().collect();
    if all.is_empty() {
        let mut draws = draws(seed, &format!("frames {take}"));
        let mut frames = vec![0.0; effort.frames * motion.basis.width];
        for row in frames.chunks_exact_mut(motion.basis.width) {
            for (k, weight) in row.iter_mut().enumerate().take(motion.basis.shape_count) {
                let (plays, amount) = (draws.unit() < PLAYING, draws.unit());
                if plays && !motion.rested.contains(&k) {
                    *weight = amount;
                }
            }
        }
        return frames;
    }
    let place = |f: usize| (f * effort.takes + take) * all.len() / (effort.frames * effort.takes);
    (0..effort.frames).flat_map(|f| all[place(f)]).copied().collect()
}
