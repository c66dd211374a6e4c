//! The ear: loops from its root over the back and the rim to the conch.

use super::sculpt::{Landmarks, Sculpt};
use super::topology::{EAR_RINGS, Feature, Site, Topology};
use super::vec3::{Vec3, bump, mix, smoothstep, v3};
use std::f64::consts::{PI, TAU};

/// Angle of loop index `k`: 0 at the top, a quarter turn at the back.
fn angle(k: i32) -> f64 {
    TAU * (f64::from(k) - 2.0) / 20.0
}

/// The hole's boundary: where the ear grows from the head.
pub(crate) fn root(sculpt: &Sculpt, at: &Landmarks, k: i32) -> Vec3 {
    let a = angle(k);
    let (s, c) = (libm::sin(a), libm::cos(a));
    let y = at.ear.y + 27.0 * at.ear_scale * c;
    let z = at.ear.z - if s > 0.0 { 7.0 } else { 12.5 } * s - 0.2 * (y - at.ear.y);
    sculpt.project(v3(at.ear.x + 3.0, y, z))
}

/// One loop of the ear: scale of the outline and lift off the head, at the front and at the back.
struct EarLoop {
    front: (f64, f64),
    back: (f64, f64),
}

const LOOPS: [EarLoop; EAR_RINGS as usize] = [
    EarLoop { front: (1.10, 0.3), back: (0.66, 0.5) },
    EarLoop { front: (1.02, 0.8), back: (0.92, 5.0) },
    EarLoop { front: (0.94, 2.2), back: (1.00, 8.5) },
    EarLoop { front: (0.86, 2.6), back: (0.95, 10.5) },
    EarLoop { front: (0.76, 1.6), back: (0.82, 7.5) },
    EarLoop { front: (0.64, 1.8), back: (0.62, 9.0) },
    EarLoop { front: (0.50, -0.5), back: (0.46, 5.5) },
    EarLoop { front: (0.36, -3.5), back: (0.30, -2.0) },
];

/// Lay the loops of the left ear.
pub(crate) fn place_ear(t: &Topology, sculpt: &Sculpt, at: &Landmarks, p: &mut [Vec3]) {
    let feature = Feature::EarLeft;
    let flare = 24f64.to_radians();
    let back = v3(libm::sin(flare), 0.0, -libm::cos(flare));
    let up = v3(0.03, 0.98, -0.19).unit();
    let out = back.cross(up).unit();
    let origin = sculpt.project(v3(at.ear.x + 3.0, at.ear.y, at.ear.z + 2.0));
    let outline = |a: f64| {
        let (s, c) = (libm::sin(a), libm::cos(a));
        let breadth = if s > 0.0 { 17.5 * (1.0 + 0.22 * c) } else { 10.0 };
        let height = if c > 0.0 { 31.0 } else { 30.0 };
        let round = if c < 0.0 { libm::pow(s.abs(), 0.72).copysign(s) } else { s };
        (breadth * round * at.ear_scale, height * c * at.ear_scale)
    };
    for (ring, l) in (1..).zip(&LOOPS) {
        for k in 0..feature.ring_length() {
            let a = angle(k);
            let behind = smoothstep(-0.75, 0.45, libm::sin(a));
            let scale = mix(l.front.0, l.back.0, behind);
            let mut lift = mix(l.front.1, l.back.1, behind);
            // The tragus stands before the conch; the lobe is soft and flat.
            if (5..=6).contains(&ring) {
                lift += 3.0 * bump((a - 1.5 * PI) / 0.3);
            }
            let lobe = smoothstep(-0.5, -0.95, libm::cos(a));
            if ring >= 5 {
                lift = mix(lift, mix(6.0, 4.0, f64::from(ring - 5) / 3.0), lobe * 0.7);
            }
            let (b, u) = outline(a);
            let on_plate = origin + back * (b * scale) + up * (u * scale) + out * lift;
            p[t.ring(feature, ring, k)] = on_plate;
        }
    }
    fill_conch(t, out, p);
}

fn fill_conch(t: &Topology, out: Vec3, p: &mut [Vec3]) {
    let (r0, r1, c0, c1) = Feature::EarLeft.block();
    let (h, w) = (r1 - r0, c1 - c0);
    let ring = |k: i32| t.ring(Feature::EarLeft, EAR_RINGS, k);
    for i in 1..h {
        let front = p[ring(2 * w + h + (h - i))];
        let behind = p[ring(w + i)];
        for j in 1..w {
            let q = front.lerp(behind, f64::from(j) / f64::from(w));
            p[t.at(Site::Fill(Feature::EarLeft, i, j))] = q - out * 1.0;
        }
    }
}
