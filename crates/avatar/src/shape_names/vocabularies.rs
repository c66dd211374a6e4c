//! What shapes are called in other vocabularies than ARKit's: FACS in words, MetaHuman's controls, VRM's
//! expressions. Small letters, without side.
//!
//! Sources: names of action units after Ekman, Friesen and Hager (2002), with the spellings of
//! Audio2Face's `facsNames` and of Meta's face tracking (`EOculusXRFaceExpression`); what MetaHuman's
//! `CTRL_expressions_*` do in these terms, from the table of Meta's plugin for Unreal
//! (OculusXRMovement, retargeting to MetaHuman); lip suck and chin raiser of the upper lip as ARKit's
//! rolls and shrug, from VRCFaceTracking's comparison of Unified Expressions with ARKit; `blink` and
//! `look*` from VRM 1.0, `VRMC_vrm`, *expressions*. For VRM's visemes (`aa`, `ih`, `ou`, `ee`, `oh`) and
//! emotions (`happy`, `angry`, `sad`, `relaxed`, `surprised`) no source says which of ARKit's shapes they
//! are: they drive shapes of the very same name, and nothing else.

/// What a name stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    /// Features, on the sides that the name says (both where it says none).
    Features(&'static [&'static str]),
    /// One of two halves of a feature, upper and lower: a column of it is half of the feature's weight.
    Half(&'static str),
    /// Both eyes, or the one that the name says, turned to the left or to the right of the face.
    LooksLeft,
    LooksRight,
}

use Meaning::{Features, Half, LooksLeft, LooksRight};

#[rustfmt::skip]
const NAMES: &[(&str, Meaning)] = &[
    // FACS in words, by action unit.
    ("innerbrowraiser", Features(&["browInnerUp"])),           // 1
    ("outerbrowraiser", Features(&["browOuterUp"])),           // 2
    ("browlowerer", Features(&["browDown"])),                  // 4
    ("browlower", Features(&["browDown"])),
    ("upperlidraiser", Features(&["eyeWide"])),                // 5
    ("eyesupperlidraiser", Features(&["eyeWide"])),
    ("cheekraiser", Features(&["cheekSquint"])),               // 6
    ("lidtightener", Features(&["eyeSquint"])),                // 7
    ("squint", Features(&["eyeSquint"])),
    ("nosewrinkler", Features(&["noseSneer"])),                // 9
    ("upperlipraiser", Features(&["mouthUpperUp"])),           // 10
    ("lipcornerpuller", Features(&["mouthSmile"])),            // 12
    ("dimpler", Features(&["mouthDimple"])),                   // 14
    ("lipcornerdepressor", Features(&["mouthFrown"])),         // 15
    ("lowerlipdepressor", Features(&["mouthLowerDown"])),      // 16
    ("chinraiser", Features(&["mouthShrugLower"])),            // 17
    ("chinraiserb", Features(&["mouthShrugLower"])),
    ("chinraisert", Features(&["mouthShrugUpper"])),
    ("lippucker", Features(&["mouthPucker"])),                 // 18
    ("pucker", Features(&["mouthPucker"])),
    ("lipstretcher", Features(&["mouthStretch"])),             // 20
    ("lipfunneler", Features(&["mouthFunnel"])),               // 22
    ("funneler", Features(&["mouthFunnel"])),
    ("lippressor", Features(&["mouthPress"])),                 // 24
    ("jawdrop", Features(&["jawOpen"])),                       // 26
    ("lipsuck", Features(&["mouthRollLower", "mouthRollUpper"])), // 28
    ("jawthrust", Features(&["jawForward"])),                  // 29
    ("jawslideleft", Features(&["jawLeft"])),                  // 30
    ("jawslideright", Features(&["jawRight"])),
    ("jawsidewaysleft", Features(&["jawLeft"])),
    ("jawsidewaysright", Features(&["jawRight"])),
    ("mouthslideleft", Features(&["mouthLeft"])),
    ("mouthslideright", Features(&["mouthRight"])),
    ("eyesclose", Features(&["eyeBlink"])),                    // 43
    ("eyesclosed", Features(&["eyeBlink"])),
    ("eyeslookleft", LooksLeft),                               // 61
    ("eyeslookright", LooksRight),                             // 62
    ("eyeslookup", Features(&["eyeLookUp"])),                  // 63
    ("eyeslookdown", Features(&["eyeLookDown"])),              // 64
    // MetaHuman: CTRL_expressions_*.
    ("browraisein", Features(&["browInnerUp"])),
    ("browraiseouter", Features(&["browOuterUp"])),
    ("eyeupperlidup", Features(&["eyeWide"])),
    ("eyewiden", Features(&["eyeWide"])),
    ("eyecheekraise", Features(&["cheekSquint"])),
    ("eyesquintinner", Features(&["eyeSquint"])),
    ("eyelookleft", LooksLeft),
    ("eyelookright", LooksRight),
    ("nosewrinkle", Features(&["noseSneer"])),
    ("mouthcheekblow", Features(&["cheekPuff"])),
    ("mouthupperlipraise", Features(&["mouthUpperUp"])),
    ("mouthlowerlipdepress", Features(&["mouthLowerDown"])),
    ("mouthcornerpull", Features(&["mouthSmile"])),
    ("mouthcornerdepress", Features(&["mouthFrown"])),
    ("mouthlipspress", Features(&["mouthPress"])),
    ("mouthfunnelu", Half("mouthFunnel")),
    ("mouthfunneld", Half("mouthFunnel")),
    ("mouthlipspurseu", Half("mouthPucker")),
    ("mouthlipspursed", Half("mouthPucker")),
    ("mouthlowerlipbite", Features(&["mouthRollLower"])),
    ("mouthupperlipbite", Features(&["mouthRollUpper"])),
    ("jawfwd", Features(&["jawForward"])),
    ("jawchinraised", Features(&["mouthShrugLower"])),
    ("jawchinraiseu", Features(&["mouthShrugUpper"])),
    // VRM 1.0.
    ("blink", Features(&["eyeBlink"])),
    ("lookup", Features(&["eyeLookUp"])),
    ("lookdown", Features(&["eyeLookDown"])),
    ("lookleft", LooksLeft),
    ("lookright", LooksRight),
];

/// What a name in small letters, without side, stands for in these vocabularies.
pub(super) fn meaning(name: &str) -> Option<Meaning> {
    NAMES.iter().find(|(known, _)| *known == name).map(|(_, meaning)| *meaning)
}
