//! The mouth: loops from the skin round it over the vermilion to the line where the lips meet, and
//! the lining behind them.
//!
//! A place along a lip is `t`, -1 at the right corner, 0 in the middle, 1 at the left corner.

use super::sculpt::{Landmarks, Sculpt};
use super::topology::{Feature, MOUTH_RINGS, Site, Topology};
use super::vec3::{Vec3, bump, mix, v3};
use std::f64::consts::FRAC_PI_2;

/// Place along the lip, and whether it is the upper one, of loop index `k`.
pub(crate) fn along(k: i32) -> (f64, bool) {
    let n = Feature::Mouth.ring_length();
    let from_right = (k - 26).rem_euclid(n);
    if from_right <= 14 {
        (f64::from(from_right - 7) / 7.0, true)
    } else {
        (f64::from(21 - from_right) / 7.0, false)
    }
}

/// The hole's boundary on the sculpt.
pub(crate) fn boundary(sculpt: &Sculpt, at: &Landmarks, k: i32) -> Vec3 {
    let (t, upper) = along(k);
    let (s, c) = (libm::sin(FRAC_PI_2 * t), libm::cos(FRAC_PI_2 * t));
    let x = (at.mouth_half + 11.0) * s;
    let height = if upper { at.nose_base_y - 6.5 - at.mouth_y } else { -20.0 };
    sculpt.front(x, at.mouth_y - 1.0 * s * s + height * libm::pow(c.max(0.0), 0.85))
}

/// One loop across a lip: how far from the meeting line towards the border (0 to 1 and beyond),
/// extra height (mm), depth before the sculpt in the middle and at the corner, extra breadth.
struct LipLoop {
    height: f64,
    extra: f64,
    depth: f64,
    corner_depth: f64,
    corner_out: f64,
}

/// Rings 2 to 7, upper lip.
const UPPER: [LipLoop; 6] = [
    LipLoop { height: 1.0, extra: 1.7, depth: 1.5, corner_depth: 0.6, corner_out: 3.0 },
    LipLoop { height: 1.0, extra: 0.0, depth: 2.3, corner_depth: 0.4, corner_out: 1.6 },
    LipLoop { height: 0.55, extra: 0.0, depth: 5.3, corner_depth: 0.0, corner_out: 0.7 },
    LipLoop { height: 0.16, extra: 0.25, depth: 5.0, corner_depth: -0.7, corner_out: 0.1 },
    LipLoop { height: 0.0, extra: 0.12, depth: 2.6, corner_depth: -1.6, corner_out: -0.4 },
    LipLoop { height: 0.0, extra: 0.5, depth: -2.0, corner_depth: -4.0, corner_out: -1.0 },
];

/// Rings 2 to 7, lower lip.
const LOWER: [LipLoop; 6] = [
    LipLoop { height: 1.0, extra: 1.7, depth: 1.0, corner_depth: 0.6, corner_out: 3.0 },
    LipLoop { height: 1.0, extra: 0.0, depth: 2.2, corner_depth: 0.4, corner_out: 1.6 },
    LipLoop { height: 0.55, extra: 0.0, depth: 5.2, corner_depth: 0.0, corner_out: 0.7 },
    LipLoop { height: 0.16, extra: 0.25, depth: 5.0, corner_depth: -0.7, corner_out: 0.1 },
    LipLoop { height: 0.0, extra: 0.12, depth: 2.6, corner_depth: -1.6, corner_out: -0.4 },
    LipLoop { height: 0.0, extra: 0.5, depth: -2.0, corner_depth: -4.0, corner_out: -1.0 },
];

/// Lay the loops of the mouth.
pub(crate) fn place_lips(t: &Topology, sculpt: &Sculpt, at: &Landmarks, p: &mut [Vec3]) {
    let feature = Feature::Mouth;
    for k in 0..feature.ring_length() {
        let (along, upper) = along(k);
        let (s, c) = (libm::sin(FRAC_PI_2 * along), libm::cos(FRAC_PI_2 * along).max(0.0));
        let sign = if upper { 1.0 } else { -1.0 };
        let line = at.mouth_y + meeting_line(along);
        let border = border_height(at, along, upper);
        let swell = libm::pow(c, 0.8);
        let loops = if upper { &UPPER } else { &LOWER };
        for (ring, l) in (2..).zip(loops) {
            let x = (at.mouth_half + l.corner_out) * s;
            let y = line + sign * (border * l.height + l.extra * mix(0.3, 1.0, swell));
            let z = sculpt.front(x, y).z + mix(l.corner_depth, l.depth * at.lip_swell, swell);
            p[t.ring(feature, ring, k)] = v3(x, y, z);
        }
        let outer = p[t.ring(feature, 0, k)];
        let middle = outer.lerp(p[t.ring(feature, 2, k)], 0.55);
        let on_skin = sculpt.project(middle);
        p[t.ring(feature, 1, k)] = on_skin.lerp(middle, 0.35);
        // Lining: before the teeth, then round them to the throat.
        let front = sculpt.front(0.0, at.mouth_y).z;
        for (ring, narrow, up, z) in
            [(8, 0.98, 7.0, -3.5), (9, 0.92, 15.0, -20.0), (10, 0.62, 11.0, -42.0)]
        {
            let x = (at.mouth_half - 1.0) * narrow * s;
            let curve = -0.013 * x * x;
            let height = up * libm::pow(c, 0.5) + 0.8;
            let y = line + sign * height * mix(0.3, 1.0, swell);
            p[t.ring(feature, ring, k)] =
                v3(x, y, front + z + if ring == 8 { curve } else { 0.4 * curve });
        }
    }
    fill_throat(t, p);
}

/// Height of the line where the lips meet, relative to the mouth's height.
fn meeting_line(t: f64) -> f64 {
    -0.7 * bump(t / 0.22) + 0.4 * bump((t.abs() - 0.45) / 0.25) - 0.9 * t * t * t * t
}

/// Height of the red of a lip.
fn border_height(at: &Landmarks, t: f64, upper: bool) -> f64 {
    let c = libm::cos(FRAC_PI_2 * t).max(0.0);
    if upper {
        let bow = 1.0 - 0.13 * bump(t / 0.10) + 0.03 * bump((t.abs() - 0.24) / 0.12);
        at.lip_upper * libm::pow(c, 1.55) * bow
    } else {
        at.lip_lower * libm::pow(c, 1.35)
    }
}

/// The lining's inner vertices, evenly between the innermost loop's top and bottom.
fn fill_throat(t: &Topology, p: &mut [Vec3]) {
    let (r0, r1, c0, c1) = Feature::Mouth.block();
    let (h, w) = (r1 - r0, c1 - c0);
    for j in 1..w {
        let top = p[t.ring(Feature::Mouth, MOUTH_RINGS, j)];
        let bottom = p[t.ring(Feature::Mouth, MOUTH_RINGS, 2 * w + h - j)];
        for i in 1..h {
            let q = top.lerp(bottom, f64::from(i) / f64::from(h));
            p[t.at(Site::Fill(Feature::Mouth, i, j))] = q + v3(0.0, 0.0, -3.0);
        }
    }
}
