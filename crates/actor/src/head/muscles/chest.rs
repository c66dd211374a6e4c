//! The chest that a breath fills: it rises and comes forward, and the root of the neck goes with it.

use super::super::vec3::{Vec3, smoothstep, v3};
use super::field::Flesh;

/// How far the chest rises and comes forward between an empty and a full breath of hard work, millimetres.
const RISE: f64 = 6.0;
const FORWARD: f64 = 5.0;
/// Below the chin: where the neck begins to move, and where it moves as the chest does, millimetres.
const STILL: f64 = -18.0;
const WHOLE: f64 = -85.0;

/// Displacement of a point of neck or chest at a full breath, millimetres.
pub(crate) fn risen(p: Vec3, chin_y: f64) -> Vec3 {
    let share = smoothstep(chin_y + STILL, chin_y + WHOLE, p.y);
    let front = smoothstep(-60.0, 40.0, p.z);
    v3(0.0, RISE * share, FORWARD * share * front)
}

pub(super) fn breath(flesh: &Flesh) -> Vec<Vec3> {
    let chin_y = flesh.cage.at.chin_y;
    flesh.map(|bit| risen(bit.p, chin_y))
}
