//! The eye: its opening on the ball, and the loops from the orbit over the fold to the lid's margin.
//!
//! Angles are about the centre of the ball: azimuth towards the temple, elevation upwards. A place
//! along a lid is `u`, 0 at the inner and 1 at the outer corner.

use super::identity::Identity;
use super::sculpt::{Landmarks, Sculpt};
use super::topology::{EYE_RINGS, Feature, Topology};
use super::vec3::{Vec3, mix, v3};
use std::f64::consts::PI;

/// The left eye of one person.
#[derive(Debug, Clone)]
pub(crate) struct Eye {
    pub centre: Vec3,
    pub radius: f64,
    /// Slant, degrees.
    tilt: f64,
    /// Heights of the opening above and below the line through the corners, degrees: at rest the upper
    /// lid covers the iris by a millimetre or two, the lower one touches it.
    upper: f64,
    lower: f64,
    brow_y: f64,
    hood: f64,
}

/// Azimuth of the corners, degrees.
const INNER: f64 = -55.0;
const OUTER: f64 = 60.0;

/// A loop of the lids: how far beyond the margin (degrees), how far above the ball (mm), and how
/// much of a blink it follows; upper then lower.
pub(crate) struct LidLoop {
    pub beyond: [f64; 2],
    pub above: [f64; 2],
    pub follows: [f64; 2],
}

/// Rings 2 to 7: fold, crease, lid, outer margin, inner margin, tucked under.
pub(crate) const LID_LOOPS: [LidLoop; 6] = [
    LidLoop { beyond: [19.0, 19.0], above: [3.6, 1.6], follows: [0.30, 0.30] },
    LidLoop { beyond: [11.5, 10.0], above: [1.7, 1.9], follows: [0.72, 0.65] },
    LidLoop { beyond: [6.0, 5.0], above: [1.9, 2.0], follows: [0.92, 0.9] },
    LidLoop { beyond: [1.2, 1.2], above: [1.9, 1.8], follows: [1.0, 1.0] },
    LidLoop { beyond: [0.0, 0.0], above: [0.6, 0.6], follows: [1.0, 1.0] },
    LidLoop { beyond: [6.0, 6.0], above: [-1.2, -1.2], follows: [1.0, 1.0] },
];

/// Upper lid or not, and the place along it, of loop index `k`.
pub(crate) fn along(k: i32) -> (bool, f64) {
    let n = Feature::EyeLeft.ring_length();
    let upper = (k - 18).rem_euclid(n);
    if upper <= 10 {
        (true, f64::from(upper) / 10.0)
    } else {
        (false, f64::from((18 - k).rem_euclid(n)) / 10.0)
    }
}

impl Eye {
    pub(crate) fn new(who: &Identity, at: &Landmarks) -> Eye {
        Eye {
            centre: at.eye,
            radius: at.eye_radius,
            tilt: 3.5 + 1.2 * who.eye_tilt - 2.0 * who.age,
            upper: 18.5 - 1.5 * who.masculinity - 1.5 * who.age,
            lower: 18.2 - 1.0 * who.masculinity,
            brow_y: at.brow_y,
            hood: 0.5 * who.masculinity + 1.2 * who.age,
        }
    }

    /// The margin of a lid at rest: azimuth and elevation, degrees.
    pub(crate) fn margin(&self, u: f64, upper: bool) -> (f64, f64) {
        let arch = libm::sin(PI * u);
        // The upper lid peaks towards the nose, the lower one towards the temple.
        let height = if upper {
            self.upper * libm::pow(arch, 0.85) * (1.0 + 0.16 * libm::cos(PI * u))
        } else {
            -self.lower * libm::pow(arch, 0.95) * (1.0 - 0.14 * libm::cos(PI * u))
        };
        (mix(INNER, OUTER, spread(u)), self.corner_line(u) + height)
    }

    /// Elevation of the straight line between the corners.
    fn corner_line(&self, u: f64) -> f64 {
        -3.0 + self.tilt * (u - 0.4)
    }

    /// Where the lids meet when the eye is shut, degrees of elevation.
    pub(crate) fn seam(&self, u: f64) -> f64 {
        self.corner_line(u) - 9.5 * libm::sin(PI * u)
    }

    /// A place about the ball: angles in degrees, height above the ball in mm.
    pub(crate) fn place(&self, azimuth: f64, elevation: f64, above: f64) -> Vec3 {
        let (a, e) = (azimuth.to_radians(), elevation.to_radians());
        let r = self.radius + above;
        self.centre + v3(libm::sin(a) * libm::cos(e), libm::sin(e), libm::cos(a) * libm::cos(e)) * r
    }

    /// Angles and height of a lid loop (0 = [`LID_LOOPS`]' first) at `u`, at rest.
    pub(crate) fn lid(&self, lid_loop: usize, u: f64, upper: bool) -> (f64, f64, f64) {
        let l = &LID_LOOPS[lid_loop];
        let side = usize::from(!upper);
        let (az, el) = self.margin(u, upper);
        let sign = if upper { 1.0 } else { -1.0 };
        let (s, c) = (libm::sin(PI * u), libm::cos(PI * u));
        // Outwards from the opening, rounder than it: mostly sideways at the corners.
        let mut beyond = l.beyond[side];
        if lid_loop == 5 {
            beyond = l.beyond[side];
        } else {
            beyond *= mix(0.75, 1.0, s);
        }
        let mut above = l.above[side];
        if lid_loop == 0 && upper {
            above += self.hood * s;
        }
        (az - c * beyond, el + sign * s * beyond, above)
    }

    /// The same when the eye is shut.
    pub(crate) fn lid_shut(&self, lid_loop: usize, u: f64, upper: bool) -> (f64, f64, f64) {
        let follows = LID_LOOPS[lid_loop].follows[usize::from(!upper)];
        let (az, el, above) = self.lid(lid_loop, u, upper);
        let (_, margin) = self.margin(u, upper);
        // A shade past the seam from both sides, so that nothing shows between.
        let seam = self.seam(u) + if upper { -0.8 } else { 0.4 };
        let flat = if (1..=2).contains(&lid_loop) { 2.1 } else { above };
        (az, el + follows * (seam - margin), flat)
    }

    /// The orbit: the hole's boundary, on the sculpt.
    pub(crate) fn orbit(&self, sculpt: &Sculpt, k: i32) -> Vec3 {
        let (upper, u) = along(k);
        let angle = PI * u;
        // Its inner end keeps clear of the bridge's columns, however close the eyes stand.
        let half = if u < 0.5 { self.centre.x + 1.0 - 10.2 } else { 22.5 };
        let x = self.centre.x + 1.0 - half * libm::cos(angle);
        let top = self.brow_y - 4.0;
        let height = if upper { top } else { -19.0 };
        let y = height * libm::pow(libm::sin(angle), 0.9) + 1.5 * (u - 0.5);
        sculpt.front(x, y)
    }
}

/// Places along a lid stand closer near the corners.
fn spread(u: f64) -> f64 {
    mix(u, 0.5 - 0.5 * libm::cos(PI * u), 0.45)
}

/// Lay the loops of the left eye.
pub(crate) fn place_eyelids(t: &Topology, sculpt: &Sculpt, eye: &Eye, p: &mut [Vec3]) {
    let feature = Feature::EyeLeft;
    for k in 0..feature.ring_length() {
        let (upper, u) = along(k);
        for ring in 2..=EYE_RINGS {
            let (az, el, above) = eye.lid((ring - 2) as usize, u, upper);
            p[t.ring(feature, ring, k)] = eye.place(az, el, above);
        }
        let outer = p[t.ring(feature, 0, k)];
        let inner = p[t.ring(feature, 2, k)];
        let middle = outer.lerp(inner, 0.5);
        p[t.ring(feature, 1, k)] = middle.lerp(sculpt.project(middle), 0.5);
    }
}
