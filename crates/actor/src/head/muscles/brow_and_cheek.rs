//! Brows, cheeks, nose.

use super::super::vec3::{Vec3, v3};
use super::field::Flesh;

pub(super) fn brow_inner_up(flesh: &Flesh) -> Vec<Vec3> {
    let y = flesh.cage.at.brow_y;
    flesh.map(|bit| {
        let inner = flesh.spot(bit, (14.0, y + 1.0), (12.0, 13.0));
        let forehead = flesh.spot(bit, (15.0, y + 22.0), (18.0, 14.0));
        v3(-1.2, 9.5, 0.8) * inner + v3(0.0, 2.4, 0.9) * forehead
    })
}

pub(super) fn brow_outer_up(flesh: &Flesh) -> Vec<Vec3> {
    let y = flesh.cage.at.brow_y;
    flesh.map(|bit| {
        let outer = flesh.spot(bit, (42.0, y + 1.0), (15.0, 13.0));
        let forehead = flesh.spot(bit, (42.0, y + 22.0), (16.0, 13.0));
        v3(0.5, 9.5, -0.8) * outer + v3(0.0, 2.2, -0.4) * forehead
    })
}

pub(super) fn brow_down(flesh: &Flesh) -> Vec<Vec3> {
    let y = flesh.cage.at.brow_y;
    flesh.map(|bit| {
        let inner = flesh.spot(bit, (13.0, y), (11.0, 11.0));
        let middle = flesh.spot(bit, (31.0, y), (13.0, 10.0));
        let root = flesh.spot(bit, (5.0, 8.0), (8.0, 8.0));
        v3(-4.6, -8.6, 2.4) * inner + v3(-2.4, -5.4, 1.2) * middle + v3(-0.6, -2.4, 1.4) * root
    })
}

pub(super) fn cheek_squint(flesh: &Flesh) -> Vec<Vec3> {
    let at = flesh.cage.at.eye;
    flesh.map(|bit| {
        let cheek = flesh.spot(bit, (at.x + 6.0, at.y - 27.0), (17.0, 11.0));
        let outer = flesh.spot(bit, (at.x + 25.0, at.y - 4.0), (8.0, 12.0));
        let mut d = v3(0.8, 5.6, 3.4) * cheek + v3(-1.0, 0.8, 0.6) * outer;
        if let Some(lid) = bit.lid
            && !lid.upper
            && lid.ring >= 2
        {
            let arch = libm::sin(std::f64::consts::PI * lid.along);
            d += v3(0.0, 1.7 * arch, if lid.ring <= 4 { 0.5 * arch } else { 0.0 });
        }
        d
    })
}

pub(super) fn cheek_puff(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let cheek = flesh.spot(bit, (43.0, at.mouth_y + 1.0), (14.0, 17.0));
        let lips = flesh.near_lips(bit, 9.0).map_or(0.0, |n| n.weight);
        v3(6.5, 0.0, 6.5) * cheek + v3(0.0, 0.0, 0.9) * lips
    })
}

pub(super) fn nose_sneer(flesh: &Flesh) -> Vec<Vec3> {
    let at = &flesh.cage.at;
    flesh.map(|bit| {
        let wing = flesh.spot(bit, (at.wing_half, at.nose_tip.y), (7.5, 8.5));
        let bridge = flesh.spot(bit, (9.0, -10.0), (8.0, 11.0));
        let fold = flesh.spot(bit, (24.0, -28.0), (10.0, 13.0));
        let tip = flesh.spot(bit, (0.0, at.nose_tip.y), (12.0, 10.0));
        let brow = flesh.spot(bit, (11.0, at.brow_y - 2.0), (10.0, 9.0));
        let mut d = v3(2.2, 5.4, -0.2) * wing
            + v3(0.0, 1.8, 0.0) * tip
            + v3(-0.4, 4.6, 2.6) * bridge
            + v3(0.6, 4.6, 3.0) * fold
            + v3(-1.4, -2.0, 0.9) * brow;
        if let Some(near) = flesh.near_lips(bit, 9.0) {
            let lift = super::super::vec3::bump((near.along - 0.45) / 0.4);
            d += v3(0.0, 2.6, 0.4) * (near.weight * near.upper * lift);
        }
        d
    })
}
