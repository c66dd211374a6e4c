//! The jaw: a hinge before the ears; the skin of chin, lower lip and lower cheek rides on it.

use super::super::sculpt::Landmarks;
use super::super::vec3::{Vec3, mix, smoothstep, v3};
use super::field::{Bit, Flesh};

/// Opening at jawOpen = 1, radians.
const OPEN: f64 = 0.30;
/// Turn to the side at jawLeft = 1, radians.
const ASIDE: f64 = 0.085;
/// How much of the jaw's motion the corners of the mouth share.
pub(super) const CORNER_SHARE: f64 = 0.42;

/// The bone's own displacement at weight 1 of its four shapes: for teeth and tongue.
pub(crate) struct JawMotion {
    hinge: Vec3,
}

impl JawMotion {
    pub(crate) fn new(at: &Landmarks) -> JawMotion {
        JawMotion { hinge: at.jaw_hinge }
    }

    pub(crate) fn open(&self, p: Vec3) -> Vec3 {
        // Opening also slides the condyle forward a little.
        p.turned_about_x(self.hinge, OPEN) - p + v3(0.0, -0.6, 1.5)
    }

    pub(crate) fn left(&self, p: Vec3) -> Vec3 {
        p.turned_about_y(self.hinge, ASIDE) - p
    }

    pub(crate) fn forward(&self, _: Vec3) -> Vec3 {
        v3(0.0, -0.5, 6.0)
    }
}

/// Share of the bone's motion that a vertex takes, 0 to 1.
pub(super) fn share(flesh: &Flesh, bit: &Bit) -> f64 {
    let at = &flesh.cage.at;
    let half = at.mouth_half;
    let p = bit.p;
    let hinge = at.jaw_hinge;
    // The line from the corner of the mouth to the hinge parts still from moving skin.
    let back = ((92.0 - p.z) / (92.0 - hinge.z)).clamp(0.0, 1.0);
    let line = mix(at.mouth_y, hinge.y - 8.0, back);
    let beside = smoothstep(0.55 * half, 1.5 * half, p.x.abs());
    let blur = mix(3.0, 24.0, beside);
    let mut share = smoothstep(blur, -blur, p.y - line);
    if let Some(lip) = bit.lip {
        let corner = libm::pow(smoothstep(0.35, 1.0, lip.along.abs()), 1.3);
        let own = if lip.upper { CORNER_SHARE * corner } else { mix(1.0, CORNER_SHARE, corner) };
        let follows = [0.0, 0.55, 0.9][(lip.ring as usize).min(2)];
        share = mix(share, own, if lip.ring >= 3 { 1.0 } else { follows });
        if lip.ring >= 11 {
            share = 0.35;
        }
        return share;
    }
    // Behind the jaw, and below its edge, the neck stays.
    let edge = mix(at.mouth_y - 14.0, at.chin_y, smoothstep(10.0, 85.0, p.z));
    share * smoothstep(-6.0, 28.0, p.z) * smoothstep(edge - 34.0, edge - 2.0, p.y)
}

pub(super) fn open(flesh: &Flesh) -> Vec<Vec3> {
    let bone = JawMotion::new(&flesh.cage.at);
    flesh.map(|bit| {
        let share = share(flesh, bit);
        // Cheeks hollow a little as they are drawn over the opening.
        let cheek = (42.0, flesh.cage.at.mouth_y + 2.0);
        let left = flesh.spot(bit, cheek, (12.0, 16.0));
        let right = flesh.spot(&Bit { p: bit.p.mirrored(), ..*bit }, cheek, (12.0, 16.0));
        bone.open(bit.p) * share + v3(2.5 * (right - left), 0.0, -0.5 * (left + right))
    })
}

pub(super) fn forward(flesh: &Flesh) -> Vec<Vec3> {
    let bone = JawMotion::new(&flesh.cage.at);
    flesh.map(|bit| bone.forward(bit.p) * share(flesh, bit))
}

pub(super) fn to_left(flesh: &Flesh) -> Vec<Vec3> {
    let bone = JawMotion::new(&flesh.cage.at);
    flesh.map(|bit| bone.left(bit.p) * share(flesh, bit))
}
