//! Other people: an avatar's face bent and stretched smoothly into another one.

use mimique_geometry::{DVec3, Displacement, Point};

use crate::draws::draws;

/// Root mean square distance of another face from the avatar's, metres: people of one sex and age differ by
/// some millimetres when they are laid on each other.
const DIFFERENCE_M: f64 = 0.004;
/// Standard deviation of the stretch along each axis.
const STRETCH: f64 = 0.04;
/// Waves that bend the face.
const WAVES: usize = 6;
/// Wave lengths, metres: features as large as a nose move as a whole.
const LENGTHS_M: [f64; 2] = [0.09, 0.24];

/// A face, as a map from the avatar's.
#[derive(Debug, Clone)]
pub struct Person {
    stretch: DVec3,
    waves: Vec<Wave>,
}

#[derive(Debug, Clone)]
struct Wave {
    amplitude: DVec3,
    /// Radians per metre.
    number: DVec3,
    phase: f64,
}

impl Person {
    /// The avatar's own face.
    pub fn own() -> Self {
        Self { stretch: DVec3::ONE, waves: Vec::new() }
    }

    /// Another face, by a seed and a number.
    pub fn other(seed: u64, number: usize) -> Self {
        let mut draws = draws(seed, &format!("person {number}"));
        let mut normal = || DVec3::new(draws.normal(), draws.normal(), draws.normal());
        let stretch = DVec3::ONE + STRETCH * normal();
        let size = DIFFERENCE_M * (2.0 / (3.0 * WAVES as f64)).sqrt();
        let mut waves = Vec::new();
        for _ in 0..WAVES {
            let (amplitude, direction) = (size * normal(), normal());
            waves.push((amplitude, direction));
        }
        let waves = waves.into_iter().map(|(amplitude, direction)| {
            let length = LENGTHS_M[0] + (LENGTHS_M[1] - LENGTHS_M[0]) * draws.unit();
            let unit = direction.try_normalize().unwrap_or(DVec3::Y);
            let number = unit * (std::f64::consts::TAU / length);
            Wave { amplitude, number, phase: std::f64::consts::TAU * draws.unit() }
        });
        Self { stretch, waves: waves.collect() }
    }

    /// Where a point of the avatar is on this face.
    pub fn place(&self, p: Point) -> Point {
        let bent = self.waves.iter().fold(DVec3::ZERO, |sum, wave| {
            sum + wave.amplitude * libm::sin(wave.number.dot(p.0) + wave.phase)
        });
        Point(p.0 * self.stretch + bent)
    }

    /// How a displacement of the avatar's skin goes on this face: a larger face moves by more. A face of
    /// another form moves as the avatar's does, as in the models that add a person's form and its expression
    /// (ICT-FaceKit, FLAME).
    pub fn displacement(&self, d: Displacement) -> Displacement {
        Displacement(d.0 * self.stretch)
    }
}
