//! Lids: they slide round the ball, so displacements are made from angles about its centre.

use super::super::eyelids::LID_LOOPS;
use super::super::vec3::{Vec3, bump, v3};
use super::field::{Flesh, OnLid};
use std::f64::consts::PI;

/// Move the margins by `upper(u)` and `lower(u)` degrees; outer loops follow by their share.
fn slide(flesh: &Flesh, upper: impl Fn(f64) -> f64, lower: impl Fn(f64) -> f64) -> Vec<Vec3> {
    let eye = &flesh.cage.eye;
    flesh.map(|bit| {
        let Some(lid) = bit.lid else { return Vec3::default() };
        let Some(k) = lid_loop(&lid) else {
            // The skin between orbit and fold yields a little.
            let degrees = if lid.upper { upper(lid.along) } else { lower(lid.along) };
            return v3(0.0, degrees.to_radians() * eye.radius * 0.12, 0.0);
        };
        let (az, el, above) = eye.lid(k, lid.along, lid.upper);
        let degrees = if lid.upper { upper(lid.along) } else { lower(lid.along) };
        let follows = LID_LOOPS[k].follows[usize::from(!lid.upper)];
        eye.place(az, el + follows * degrees, above) - bit.p
    })
}

fn lid_loop(lid: &OnLid) -> Option<usize> {
    (lid.ring >= 2).then_some((lid.ring - 2) as usize)
}

fn arch(u: f64) -> f64 {
    libm::sin(PI * u)
}

pub(super) fn blink(flesh: &Flesh) -> Vec<Vec3> {
    let eye = &flesh.cage.eye;
    flesh.map(|bit| {
        let Some(lid) = bit.lid else { return Vec3::default() };
        match lid_loop(&lid) {
            Some(k) => {
                let (az, el, above) = eye.lid_shut(k, lid.along, lid.upper);
                eye.place(az, el, above) - bit.p
            }
            None => v3(0.0, if lid.upper { -1.2 } else { 0.4 } * arch(lid.along), 0.0),
        }
    })
}

pub(super) fn look_down(flesh: &Flesh) -> Vec<Vec3> {
    slide(flesh, |u| -19.0 * arch(u), |u| -5.0 * arch(u))
}

pub(super) fn look_up(flesh: &Flesh) -> Vec<Vec3> {
    slide(flesh, |u| 9.0 * arch(u), |u| 3.0 * arch(u))
}

/// The cornea drags the lids along and the corner it turns to gives way; `towards` is -1 for in.
pub(super) fn look_aside(flesh: &Flesh, towards: f64) -> Vec<Vec3> {
    let middle = 0.5 + 0.25 * towards;
    let bulge = move |u: f64| bump((u - middle) / 0.2) - bump((u - 0.5) / 0.25) * 0.6;
    let mut d = slide(flesh, move |u| 3.0 * bulge(u), move |u| -2.0 * bulge(u));
    for (d, bit) in d.iter_mut().zip(&flesh.bits) {
        if let Some(lid) = bit.lid
            && (2..=6).contains(&lid.ring)
        {
            d.x += 0.5 * towards * arch(lid.along);
        }
    }
    d
}

pub(super) fn squint(flesh: &Flesh) -> Vec<Vec3> {
    let mut d = slide(flesh, |u| -4.5 * arch(u), |u| 12.5 * arch(u));
    let at = flesh.cage.at.eye;
    for (d, bit) in d.iter_mut().zip(&flesh.bits) {
        let below = flesh.spot(bit, (at.x + 2.0, at.y - 19.0), (15.0, 6.0));
        let outer = flesh.spot(bit, (at.x + 24.0, at.y - 1.0), (7.0, 9.0));
        *d += v3(-1.2 * outer, 2.6 * below, 0.9 * below);
    }
    d
}

/// The levator lifts the upper lid off the iris; the lower one has no part in it.
pub(super) fn wide(flesh: &Flesh) -> Vec<Vec3> {
    slide(flesh, |u| 14.5 * arch(u), |u| -arch(u))
}
