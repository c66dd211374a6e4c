//! The nose: pins of the quilt on bridge, tip and wings, and the loops into the nostrils.

use super::sculpt::{Landmarks, Sculpt};
use super::topology::{Feature, NOSTRIL_RINGS, Site, Topology};
use super::vec3::{Vec3, v3};

/// Hold the quilt's rows and columns on the nose; `pin(row, column, place)` for the left half.
pub(crate) fn pin_nose(sculpt: &Sculpt, at: &Landmarks, pin: &mut dyn FnMut(i32, i32, Vec3)) {
    let (tip, base, w) = (at.nose_tip, at.nose_base_y, at.wing_half);
    let seen = |x: f64, y: f64| sculpt.front(x, y);
    // Bridge, from between the brows to above the tip.
    let bridge = [(5, 10.0), (6, 0.5), (7, -9.0), (8, -18.0)];
    let reach = (tip.y + 10.0 + 18.0) / 1.0;
    for (r, y) in bridge {
        pin(r, 0, seen(0.0, y));
        pin(r, 1, seen(4.3, y));
        if r > 5 {
            pin(r, 2, seen(8.5 + 0.4 * f64::from(r - 6), y));
        }
    }
    let supratip = -18.0 + 0.5 * reach;
    for (r, y, x3, x4) in
        [(9, supratip, 13.5, w + 5.5), (10, tip.y + 6.5, w - 1.6, w + 4.0), (11, tip.y, w, w + 3.4)]
    {
        pin(r, 0, seen(0.0, y));
        pin(r, 1, seen(4.6, y));
        pin(r, 2, seen(9.3, y));
        pin(r, 3, seen(x3, y - 0.5));
        pin(r, 4, seen(x4, y - 2.0));
    }
    let low = |x: f64, y: f64, z: f64| sculpt.project(v3(x, y, z));
    // The underside: its front edge hangs a little below its back edge, so that the nostrils look
    // down and hardly forward.
    pin(12, 0, low(0.0, tip.y - 7.0, tip.z - 4.0));
    pin(13, 0, low(0.0, base - 0.3, tip.z - 10.0));
    pin(14, 0, seen(0.0, base - 2.6));
    pin(12, 1, low(4.2, tip.y - 8.2, tip.z - 5.5));
    pin(12, 2, low(8.6, tip.y - 8.2, tip.z - 8.0));
    pin(12, 3, low(w - 1.2, tip.y - 7.6, tip.z - 13.5));
    pin(13, 3, low(w - 1.2, base + 0.6, tip.z - 17.0));
    pin(14, 3, low(w - 3.2, base + 0.6, tip.z - 19.5));
    pin(14, 2, low(8.6, base + 1.4, tip.z - 18.0));
    pin(14, 1, low(4.4, base + 0.4, tip.z - 15.0));
    pin(13, 1, low(3.6, base - 0.4, tip.z - 10.0));
    pin(12, 4, seen(w + 3.0, tip.y - 7.0));
    pin(13, 4, seen(w + 2.8, base + 0.5));
    pin(14, 4, seen(w + 2.4, base - 4.0));
}

/// Loops that sink into the nostril.
pub(crate) fn place_nostril(t: &Topology, sculpt: &Sculpt, p: &mut [Vec3]) {
    let feature = Feature::NostrilLeft;
    let n = feature.ring_length();
    let rim: Vec<Vec3> = (0..n).map(|k| p[t.ring(feature, 0, k)]).collect();
    let mut centre = Vec3::default();
    for &q in &rim {
        centre += q * (1.0 / f64::from(n));
    }
    let normal = sculpt.normal(sculpt.project(centre));
    let inward = v3(0.05, 0.85, -0.35).unit();
    for (ring, shrink, depth, lift) in
        [(1, 0.40, 0.0, 0.6), (2, 0.46, 2.0, 0.0), (3, 0.60, 4.2, 0.0)]
    {
        for (k, &q) in rim.iter().enumerate() {
            let to = q.lerp(centre, shrink) + inward * depth + normal * lift;
            p[t.ring(feature, ring, k as i32)] = to;
        }
    }
    let mut inner = Vec3::default();
    for k in 0..n {
        inner += p[t.ring(feature, NOSTRIL_RINGS, k)] * (1.0 / f64::from(n));
    }
    p[t.at(Site::Fill(feature, 1, 1))] = inner + inward * 0.6;
}
