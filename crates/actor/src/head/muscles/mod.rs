//! The 51 blendshapes of the face, each a muscle's (or a few muscles') action on the control cage, and the
//! six of the body.
//!
//! | shapes | muscle | FACS unit |
//! |---|---|---|
//! | browInnerUp | frontalis, medial part | AU 1 |
//! | browOuterUp L/R | frontalis, lateral part | AU 2 |
//! | browDown L/R | corrugator, depressor supercilii, procerus | AU 4 |
//! | eyeWide L/R | levator palpebrae | AU 5 |
//! | cheekSquint L/R | orbicularis oculi, orbital part | AU 6 |
//! | eyeSquint L/R | orbicularis oculi, palpebral part | AU 7 |
//! | eyeBlink L/R | orbicularis oculi, relaxed levator | AU 43, 45 |
//! | eyeLook* | the eye's own muscles; lids follow the ball | AU 61-64 |
//! | noseSneer L/R | levator labii superioris alaeque nasi | AU 9 |
//! | mouthUpperUp L/R | levator labii superioris | AU 10 |
//! | mouthSmile L/R | zygomaticus major | AU 12 |
//! | mouthDimple L/R | buccinator | AU 14 |
//! | mouthFrown L/R | depressor anguli oris | AU 15 |
//! | mouthLowerDown L/R | depressor labii inferioris | AU 16 |
//! | mouthShrugLower, mouthShrugUpper | mentalis | AU 17 |
//! | mouthPucker | incisivii, orbicularis oris | AU 18 |
//! | mouthStretch L/R | risorius, platysma | AU 20 |
//! | mouthFunnel | orbicularis oris | AU 22 |
//! | mouthPress L/R | orbicularis oris | AU 23, 24 |
//! | mouthRollLower, mouthRollUpper | orbicularis oris | AU 28 |
//! | mouthLeft, mouthRight | risorius and buccinator of one side | AD 30 |
//! | mouthClose | lips held shut over an open jaw | AU 8 |
//! | jawOpen | digastric, relaxed masseter | AU 26, 27 |
//! | jawForward, jawLeft, jawRight | pterygoids | AD 29, 30 |
//! | cheekPuff | buccinator against the breath | AD 33, 34 |
//! | headNod, headTurn, headTilt | none: the stage turns head and neck | none |
//! | breath | what lifts the ribs and widens the chest, scalenes | none |
//! | flush, sweat | none: the stage shades the skin | none |

mod brow_and_cheek;
mod chest;
mod field;
mod jaw;
mod lids;
mod mouth;

pub(crate) use chest::risen;
pub(crate) use jaw::JawMotion;

use super::Cage;
use super::vec3::Vec3;
use field::Flesh;
use mimique_avatar::{ARKIT_SHAPES, BODY_SHAPES};

/// The names of the face's shapes: ARKit's without `tongueOut`, its last, in alphabetical order.
pub const SHAPE_NAMES: [&str; 51] = match ARKIT_SHAPES.first_chunk() {
    Some(names) => *names,
    None => unreachable!(),
};

/// The names of all shapes of the head: the face's, then the body's.
pub(crate) const HEAD_SHAPES: [&str; SHAPE_NAMES.len() + BODY_SHAPES.len()] = {
    let mut names = [""; SHAPE_NAMES.len() + BODY_SHAPES.len()];
    let mut k = 0;
    while k < names.len() {
        let face = SHAPE_NAMES.len();
        names[k] = if k < face { SHAPE_NAMES[k] } else { BODY_SHAPES[k - face] };
        k += 1;
    }
    names
};

/// Displacements of the cage's vertices, millimetres, one list per shape in [`HEAD_SHAPES`]' order.
pub(crate) fn all(cage: &Cage) -> Vec<Vec<Vec3>> {
    let flesh = Flesh::new(cage);
    HEAD_SHAPES
        .iter()
        .map(|name| match (name.strip_suffix("Left"), name.strip_suffix("Right")) {
            // Whole mouth and jaw to one side: their own shapes, mirrored.
            (Some(stem @ ("mouth" | "jaw")), _) => whole(&flesh, stem),
            (_, Some(stem @ ("mouth" | "jaw"))) => flesh.mirrored(&whole(&flesh, stem)),
            (Some(stem), _) => left(&flesh, stem),
            (_, Some(stem)) => flesh.mirrored(&left(&flesh, stem)),
            _ => both(&flesh, name),
        })
        .collect()
}

fn whole(flesh: &Flesh, stem: &str) -> Vec<Vec3> {
    if stem == "jaw" { jaw::to_left(flesh) } else { mouth::to_left(flesh) }
}

fn left(flesh: &Flesh, stem: &str) -> Vec<Vec3> {
    match stem {
        "browDown" => brow_and_cheek::brow_down(flesh),
        "browOuterUp" => brow_and_cheek::brow_outer_up(flesh),
        "cheekSquint" => brow_and_cheek::cheek_squint(flesh),
        "noseSneer" => brow_and_cheek::nose_sneer(flesh),
        "eyeBlink" => lids::blink(flesh),
        "eyeLookDown" => lids::look_down(flesh),
        "eyeLookUp" => lids::look_up(flesh),
        "eyeLookIn" => lids::look_aside(flesh, -1.0),
        "eyeLookOut" => lids::look_aside(flesh, 1.0),
        "eyeSquint" => lids::squint(flesh),
        "eyeWide" => lids::wide(flesh),
        "mouthDimple" => mouth::dimple(flesh),
        "mouthFrown" => mouth::frown(flesh),
        "mouthLowerDown" => mouth::lower_down(flesh),
        "mouthPress" => mouth::press(flesh),
        "mouthSmile" => mouth::smile(flesh),
        "mouthStretch" => mouth::stretch(flesh),
        "mouthUpperUp" => mouth::upper_up(flesh),
        _ => flesh.still(),
    }
}

fn both(flesh: &Flesh, name: &str) -> Vec<Vec3> {
    match name {
        "browInnerUp" => flesh.on_both_sides(&brow_and_cheek::brow_inner_up(flesh)),
        "breath" => chest::breath(flesh),
        "cheekPuff" => flesh.on_both_sides(&brow_and_cheek::cheek_puff(flesh)),
        "jawForward" => jaw::forward(flesh),
        "jawOpen" => jaw::open(flesh),
        "mouthClose" => mouth::close(flesh),
        "mouthFunnel" => mouth::funnel(flesh),
        "mouthPucker" => mouth::pucker(flesh),
        "mouthRollLower" => mouth::roll(flesh, false),
        "mouthRollUpper" => mouth::roll(flesh, true),
        "mouthShrugLower" => mouth::shrug_lower(flesh),
        "mouthShrugUpper" => mouth::shrug_upper(flesh),
        _ => flesh.still(),
    }
}
