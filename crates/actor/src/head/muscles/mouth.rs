//! The lips.

use super::super::vec3::{Vec3, bump, mix, smoothstep, v3};
use super::field::{Bit, Flesh, left_along};
use super::jaw::{self, CORNER_SHARE, JawMotion};

/// Pull of the left corner: along the lips it fades towards the middle, on the skin with distance.
fn corner_pull(flesh: &Flesh, bit: &Bit, reach: f64) -> f64 {
    flesh.near_lips(bit, reach).map_or(0.0, |near| {
        near.weight * libm::pow(near.along.max(0.0), 1.5) * left_along(near.along)
    })
}

/// How red: 1 between border and meeting line, for actions that turn the lips in or out.
fn red(bit: &Bit) -> f64 {
    bit.lip.map_or(0.0, |lip| {
        [0.0, 0.0, 0.45, 0.85, 1.0, 0.9, 0.6, 0.3, 0.1][(lip.ring as usize).min(8)]
    })
}

pub(super) fn smile(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let corner = corner_pull(flesh, bit, 17.0);
        let cheek = flesh.spot(bit, (at.mouth_half + 17.0, at.mouth_y + 33.0), (14.0, 12.0));
        let fold = flesh.spot(bit, (at.mouth_half + 12.0, at.mouth_y + 14.0), (9.0, 12.0));
        let mut d =
            v3(8.5, 9.6, -5.0) * corner + v3(1.8, 5.2, 5.0) * cheek + v3(2.4, 4.4, 2.6) * fold;
        if let Some(near) = flesh.near_lips(bit, 8.0) {
            // The middle is drawn flat against the teeth.
            let middle = bump(near.along / 0.5) * near.weight * left_along(near.along);
            d += v3(0.0, mix(0.4, 2.4, near.upper), -1.6) * middle;
        }
        d
    })
}

pub(super) fn frown(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let corner = corner_pull(flesh, bit, 11.0);
        let below = flesh.spot(bit, (at.mouth_half + 2.0, at.mouth_y - 15.0), (9.0, 10.0));
        v3(2.2, -8.2, -1.0) * corner + v3(0.8, -2.2, 1.4) * below
    })
}

pub(super) fn stretch(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let corner = corner_pull(flesh, bit, 13.0);
        let neck = flesh.spot(bit, (34.0, at.chin_y + 8.0), (16.0, 12.0));
        let mut d = v3(9.5, -4.2, -5.5) * corner + v3(2.0, -2.2, 0.0) * neck;
        if let Some(near) = flesh.near_lips(bit, 8.0) {
            let left = near.weight * left_along(near.along);
            let middle = bump(near.along / 0.5) * left;
            d += v3(0.0, mix(-0.9, 0.2, near.upper), -1.4) * middle;
            // The platysma draws the lower lip's sides out and down: a broad, flat opening.
            let side = bump((near.along - 0.62) / 0.34) * left * (1.0 - near.upper);
            d += v3(2.2, -3.4, -0.6) * side;
        }
        d
    })
}

pub(super) fn dimple(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let corner = corner_pull(flesh, bit, 9.0);
        let around = flesh.spot(bit, (at.mouth_half + 9.0, at.mouth_y + 1.0), (6.0, 9.0));
        v3(4.6, 0.8, -4.4) * corner + v3(0.6, 0.2, 1.8) * around
    })
}

pub(super) fn upper_up(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let mut d = Vec3::default();
        if let Some(near) = flesh.near_lips(bit, 9.0) {
            let part = bump((near.along - 0.42) / 0.36) * left_along(near.along + 0.12);
            d += v3(0.8, 6.8, 0.2) * (near.weight * near.upper * part);
        }
        let wing = flesh.spot(bit, (at.wing_half, at.nose_tip.y - 3.0), (7.0, 7.0));
        let fold = flesh.spot(bit, (25.0, at.nose_base_y + 5.0), (9.0, 12.0));
        d + v3(0.5, 1.3, 0.0) * wing + v3(1.0, 2.8, 2.0) * fold
    })
}

pub(super) fn lower_down(flesh: &Flesh) -> Vec<Vec3> {
    flesh.map(|bit| {
        let Some(near) = flesh.near_lips(bit, 9.0) else { return Vec3::default() };
        let part = bump((near.along - 0.42) / 0.36) * left_along(near.along + 0.12);
        v3(0.8, -7.0, 0.4) * (near.weight * (1.0 - near.upper) * part)
    })
}

pub(super) fn press(flesh: &Flesh) -> Vec<Vec3> {
    flesh.map(|bit| {
        let mut d = Vec3::default();
        if let Some(lip) = bit.lip {
            let side = left_along(lip.along);
            let thin = red(bit) * side * (1.0 - 0.5 * lip.along.abs());
            let to_line = flesh.cage.at.mouth_y - bit.p.y;
            d += v3(0.0, 0.45 * to_line, -2.6) * thin;
        }
        let bulge = flesh.spot(
            bit,
            (flesh.cage.at.mouth_half - 2.0, flesh.cage.at.mouth_y - 11.0),
            (10.0, 5.0),
        );
        d + v3(1.4, 0.3, -1.6) * corner_pull(flesh, bit, 7.0) + v3(0.0, 0.4, 1.3) * bulge
    })
}

pub(super) fn pucker(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let Some(near) = flesh.near_lips(bit, 12.0) else { return Vec3::default() };
        let inwards = -0.46 * bit.p.x.clamp(-1.25 * at.mouth_half, 1.25 * at.mouth_half);
        let fuller = 0.16 * (bit.p.y - at.mouth_y).clamp(-9.0, 9.0);
        let forward = mix(7.0, 12.5, near.along.abs());
        let rim = bit.lip.map_or(0.0, |l| if (4..=7).contains(&l.ring) { 1.0 } else { 0.0 });
        v3(inwards, fuller, forward + 1.2 * rim) * near.weight
    })
}

pub(super) fn funnel(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let Some(near) = flesh.near_lips(bit, 11.0) else { return Vec3::default() };
        let inwards = -0.27 * bit.p.x.clamp(-1.25 * at.mouth_half, 1.25 * at.mouth_half);
        let middle = 1.0 - near.along * near.along;
        let apart = mix(-6.2, 5.2, near.upper) * middle;
        let rim = red(bit);
        v3(inwards, apart, mix(4.5, 8.0, near.along.abs()) + 2.6 * rim) * near.weight
    })
}

pub(super) fn to_left(flesh: &Flesh) -> Vec<Vec3> {
    flesh.map(|bit| {
        let Some(near) = flesh.near_lips(bit, 14.0) else { return Vec3::default() };
        // Round the arch of the teeth: back on the side it goes to, forward on the other.
        v3(8.5, 1.2 * near.along, -3.6 * near.along) * near.weight
    })
}

pub(super) fn roll(flesh: &Flesh, upper: bool) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let mut d = Vec3::default();
        let Some(near) = flesh.near_lips(bit, 7.0) else { return d };
        let own = if upper { near.upper } else { 1.0 - near.upper };
        let middle = 1.0 - libm::pow(near.along.abs(), 3.0);
        let to_line = at.mouth_y - bit.p.y;
        d += v3(0.0, 0.62 * to_line, -3.8) * (red(bit) * own * middle);
        let skin = near.weight * (1.0 - red(bit)) * own * middle;
        d + v3(0.0, if upper { -1.8 } else { 1.8 }, -1.4) * skin
    })
}

pub(super) fn shrug_lower(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let chin = smoothstep(0.0, 45.0, bit.p.z)
            * bit.loose
            * bump(
                ((bit.p.x / 15.0).powi(2) + ((bit.p.y - at.chin_y - 19.0) / 11.0).powi(2)).sqrt(),
            );
        let mut d = v3(0.0, 5.2, 1.4) * chin;
        if let Some(near) = flesh.near_lips(bit, 8.0) {
            let middle = 1.0 - libm::pow(near.along.abs(), 2.5);
            let own = near.weight * (1.0 - near.upper) * middle;
            d += v3(0.0, 3.8, 1.6) * own + v3(0.0, -0.6, 2.6) * (own * red(bit));
            // The lower lip pushes the upper one before it.
            d += v3(0.0, 2.2, 0.8) * (near.weight * near.upper * middle);
        }
        d
    })
}

pub(super) fn shrug_upper(flesh: &Flesh) -> Vec<Vec3> {
    flesh.map(|bit| {
        let Some(near) = flesh.near_lips(bit, 8.0) else { return Vec3::default() };
        let middle = 1.0 - libm::pow(near.along.abs(), 2.5);
        v3(0.0, 3.4, 1.6) * (near.weight * near.upper * middle)
    })
}

/// Lips shut over an open jaw: both meet part of the way down, before the upper teeth.
pub(super) fn close(flesh: &Flesh) -> Vec<Vec3> {
    let bone = JawMotion::new(&flesh.cage.at);
    flesh.map(|bit| {
        let Some(near) = flesh.near_lips(bit, 9.0) else { return Vec3::default() };
        let weight = match bit.lip {
            // The lining near the lips comes along; the throat stays with the jaw.
            Some(lip) if lip.ring >= 9 => 0.0,
            Some(lip) if lip.ring >= 3 => 1.0,
            _ => near.weight * 0.9,
        };
        let open = bone.open(bit.p);
        // In the middle the seam goes straight down; the corners stay where the jaw has them.
        let corner = near.along * near.along;
        let seam = v3(
            open.x,
            open.y * mix(0.44, CORNER_SHARE, corner),
            mix(1.2, open.z * CORNER_SHARE, corner),
        );
        (seam - open * jaw::share(flesh, bit)) * weight
    })
}
