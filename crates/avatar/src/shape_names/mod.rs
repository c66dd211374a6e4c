//! What blendshapes of other rigs are called in ARKit's vocabulary, and which of a file's columns
//! drive an avatar's shapes.
//!
//! A name stands for one or more *actions*: a feature on one side of the face. `browDownLeft`,
//! `browDown_L`, `L_BrowDown` and `AU4_L` are one action; ARKit's `browInnerUp` is two, which other
//! rigs have as `browInnerUp_L` and `browInnerUp_R`. FACS numbers after Ekman, Friesen and Hager
//! (2002); what is called otherwise stands in `vocabularies`.

use crate::head_pose::HEAD_POSE_SHAPES;

mod units;
mod vocabularies;

pub use units::ActionUnit;
use vocabularies::{Meaning, meaning};

/// ARKit's 52 blendshapes.
#[rustfmt::skip]
pub const ARKIT_SHAPES: [&str; 52] = [
    "browDownLeft", "browDownRight", "browInnerUp", "browOuterUpLeft", "browOuterUpRight",
    "cheekPuff", "cheekSquintLeft", "cheekSquintRight",
    "eyeBlinkLeft", "eyeBlinkRight", "eyeLookDownLeft", "eyeLookDownRight",
    "eyeLookInLeft", "eyeLookInRight", "eyeLookOutLeft", "eyeLookOutRight",
    "eyeLookUpLeft", "eyeLookUpRight", "eyeSquintLeft", "eyeSquintRight",
    "eyeWideLeft", "eyeWideRight",
    "jawForward", "jawLeft", "jawOpen", "jawRight",
    "mouthClose", "mouthDimpleLeft", "mouthDimpleRight", "mouthFrownLeft", "mouthFrownRight",
    "mouthFunnel", "mouthLeft", "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthPressLeft", "mouthPressRight", "mouthPucker", "mouthRight",
    "mouthRollLower", "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper",
    "mouthSmileLeft", "mouthSmileRight", "mouthStretchLeft", "mouthStretchRight",
    "mouthUpperUpLeft", "mouthUpperUpRight", "noseSneerLeft", "noseSneerRight", "tongueOut",
];

/// Shapes that show the body and no expression: where the head is turned to ([`crate::HEAD_POSE_SHAPES`]), how far the
/// chest is filled, how red the skin is, how wet. `breath` moves neck and chest; the others move nothing, the stage
/// turns the head and shades the skin by them. No method solves for them: they rest unless the head's own motion is
/// shown, or recorded weights have columns of these names.
pub const BODY_SHAPES: [&str; 6] = {
    let [nod, turn, tilt] = HEAD_POSE_SHAPES;
    [nod, turn, tilt, BREATH, "flush", "sweat"]
};

/// The chest's shape.
pub const BREATH: &str = "breath";

/// FACS numbers and the features that they are. AU 23, 25 and others have none of their own in
/// ARKit: shapes of those names stay what they are called.
const ACTION_UNITS: [(u32, &[&str]); 28] = [
    (1, &["browInnerUp"]),
    (2, &["browOuterUp"]),
    (4, &["browDown"]),
    (5, &["eyeWide"]),
    (6, &["cheekSquint"]),
    (7, &["eyeSquint"]),
    (8, &["mouthClose"]),
    (9, &["noseSneer"]),
    (10, &["mouthUpperUp"]),
    (12, &["mouthSmile"]),
    (14, &["mouthDimple"]),
    (15, &["mouthFrown"]),
    (16, &["mouthLowerDown"]),
    (17, &["mouthShrugLower"]),
    (18, &["mouthPucker"]),
    (19, &["tongueOut"]),
    (20, &["mouthStretch"]),
    (22, &["mouthFunnel"]),
    (24, &["mouthPress"]),
    (26, &["jawOpen"]),
    (27, &["jawOpen"]),
    (28, &["mouthRollLower", "mouthRollUpper"]),
    (29, &["jawForward"]),
    (34, &["cheekPuff"]),
    (43, &["eyeBlink"]),
    (45, &["eyeBlink"]),
    (63, &["eyeLookUp"]),
    (64, &["eyeLookDown"]),
];

/// A feature on one side of the face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Action {
    feature: &'static str,
    side: Side,
    /// Whether the name means one of two halves of it, upper and lower.
    half: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Side {
    Left,
    Right,
}

/// Which columns of recorded weights drive each shape of an avatar.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeMap {
    /// For each shape of the avatar, columns and their shares: its weight is the sum of share
    /// times column. Empty where no column means the shape.
    pub terms: Vec<Vec<(usize, f64)>>,
    /// Columns that drive nothing.
    pub unused: Vec<usize>,
}

/// ARKit's shapes that a name stands for: one as a rule; both sides of `AU12`, `mouthSmile`; none
/// for what ARKit has not.
pub fn arkit_shapes(name: &str) -> Vec<&'static str> {
    let mut out: Vec<&'static str> = actions(name).into_iter().filter_map(Action::shape).collect();
    out.dedup();
    out
}

/// Whether a shape turns the eyes: its name means one of ARKit's `eyeLook` shapes or of the action
/// units 61 to 64.
pub fn turns_eyes(name: &str) -> bool {
    actions(name).iter().any(|action| action.feature.starts_with("eyeLook"))
}

/// Whether a shape shows the body and no expression: one of [`BODY_SHAPES`].
pub fn shows_body(name: &str) -> bool {
    BODY_SHAPES.contains(&name)
}

/// Whether a shape shuts the eyes: its name means one of ARKit's `eyeBlink` shapes or the action
/// unit 43 or 45.
pub fn blinks(name: &str) -> bool {
    actions(name).iter().any(|action| action.feature == "eyeBlink")
}

/// Joins columns of recorded weights to an avatar's shapes by their names.
///
/// A column of the very same name comes first, then one that means the same, then columns that
/// mean parts of it or more than it: an avatar's `browInnerUp_L` takes ARKit's `browInnerUp`; an
/// avatar's `browInnerUp` takes half of each side's column.
pub fn map_shapes<A: AsRef<str>, C: AsRef<str>>(avatar: &[A], columns: &[C]) -> ShapeMap {
    let columns: Vec<&str> = columns.iter().map(AsRef::as_ref).collect();
    let meant: Vec<Vec<Action>> = columns.iter().map(|name| actions(name)).collect();
    let terms: Vec<Vec<(usize, f64)>> =
        avatar.iter().map(|name| terms_of(name.as_ref(), &columns, &meant)).collect();
    let used = |c: usize| terms.iter().flatten().any(|(column, _)| *column == c);
    let unused = (0..columns.len()).filter(|&c| !used(c)).collect();
    ShapeMap { terms, unused }
}

fn terms_of(name: &str, columns: &[&str], meant: &[Vec<Action>]) -> Vec<(usize, f64)> {
    let plain = |name: &str| {
        let letters = name.chars().filter(|c| c.is_alphanumeric());
        letters.flat_map(char::to_lowercase).collect::<String>()
    };
    let wanted = actions(name);
    let is_half = |actions: &[Action]| actions.iter().any(|action| action.half);
    let whole = (columns.iter().position(|c| *c == name))
        .or_else(|| columns.iter().position(|c| plain(c) == plain(name)))
        .or_else(|| {
            // Half a feature is not the other half, unless it is asked for by its own name.
            meant.iter().position(|m| !wanted.is_empty() && !is_half(m) && *m == wanted)
        });
    if let Some(column) = whole {
        return vec![(column, 1.0)];
    }
    let mut out: Vec<(usize, f64)> = Vec::new();
    let share = 1.0 / wanted.len().max(1) as f64;
    let mut add = |column: usize, share: f64| match out.iter_mut().find(|(c, _)| *c == column) {
        Some((_, sum)) => *sum += share,
        None => out.push((column, share)),
    };
    for action in &wanted {
        let does = |m: &[Action], half| m.contains(&Action { half, ..*action });
        if let Some(column) = meant.iter().position(|m| does(m, false)) {
            add(column, share);
            continue;
        }
        let halves = (0..columns.len()).filter(|&c| does(&meant[c], true));
        halves.for_each(|column| add(column, share / 2.0));
    }
    out
}

impl Action {
    /// ARKit's shape that does it.
    fn shape(self) -> Option<&'static str> {
        let side = if self.side == Side::Left { "Left" } else { "Right" };
        ARKIT_SHAPES.into_iter().find(|shape| {
            *shape == self.feature || shape.strip_suffix(side).is_some_and(|s| s == self.feature)
        })
    }
}

/// What a name stands for, sorted; nothing for a name that is no one's.
fn actions(name: &str) -> Vec<Action> {
    // `head.eyeBlink_L`, `rig:eyeBlink_L`: the last part is the shape's.
    let last = name.rsplit(['.', ':', '|', '/']).next().unwrap_or(name);
    let words: Vec<String> = last
        .split(|c: char| !c.is_alphanumeric())
        .filter(|w| !w.is_empty())
        .map(str::to_lowercase)
        .collect();
    // Rigs put words in front: `Face_browDown_L`, `BS_browDown_L`.
    let mut found =
        (0..words.len()).find_map(|first| of_words(&words[first..])).unwrap_or_default();
    found.sort_unstable();
    found
}

fn of_words(words: &[String]) -> Option<Vec<Action>> {
    if let Some(actions) = of_letters(&words.concat()) {
        return Some(actions);
    }
    let side = |word: &str| match word {
        "l" | "left" | "lt" | "lf" => Some(Side::Left),
        "r" | "right" | "rt" => Some(Side::Right),
        _ => None,
    };
    let (first, last) = (words.first()?, words.last()?);
    let (side, rest) = match (side(last), side(first)) {
        (Some(side), _) => (Some(side), &words[..words.len() - 1]),
        (None, Some(side)) => (Some(side), &words[1..]),
        (None, None) => (None, words),
    };
    let bare = |word| action_unit(word).and_then(|(n, tail)| tail.is_empty().then_some(n));
    // `AU12_LipCornerPuller`, `AU_12`.
    let of_number = match rest {
        [first, second, ..] if first == "au" => second.parse().ok().map(|n| unit(n, side)),
        [first, ..] => bare(first).map(|n| unit(n, side)),
        [] => None,
    };
    of_number.flatten().or_else(|| of_name(&rest.concat(), side))
}

/// A name without anything between its words: `eyeblinkleft`, `leftau12`, `au12l`.
fn of_letters(name: &str) -> Option<Vec<Action>> {
    if let Some(actions) = of_name(name, None) {
        return Some(actions);
    }
    let ends =
        [("left", Side::Left), ("right", Side::Right), ("l", Side::Left), ("r", Side::Right)];
    if let Some((number, tail)) = action_unit(name) {
        let side = ends.into_iter().find(|(end, _)| *end == tail).map(|(_, side)| side);
        return if tail.is_empty() || side.is_some() { unit(number, side) } else { None };
    }
    ends.into_iter().find_map(|(end, side)| {
        let rest = name.strip_suffix(end).or_else(|| name.strip_prefix(end))?;
        match action_unit(rest) {
            Some((number, "")) => unit(number, Some(side)),
            _ => of_name(rest, Some(side)),
        }
    })
}

/// The actions of a name in small letters, without its side: ARKit's own, or another vocabulary's.
fn of_name(name: &str, side: Option<Side>) -> Option<Vec<Action>> {
    if let Some(feature) = feature(name) {
        return Some(sides(&[feature], side));
    }
    let on_side = |action: &Action| side.is_none_or(|side| action.side == side);
    Some(match meaning(name)? {
        Meaning::Features(features) => sides(features, side),
        Meaning::Half(feature) => sides(&[feature], side)
            .into_iter()
            .map(|action| Action { half: true, ..action })
            .collect(),
        Meaning::LooksLeft => unit(61, None)?.into_iter().filter(on_side).collect(),
        Meaning::LooksRight => unit(62, None)?.into_iter().filter(on_side).collect(),
    })
}

/// `au12l` to 12 and `l`.
fn action_unit(word: &str) -> Option<(u32, &str)> {
    let rest = word.strip_prefix("au")?;
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    Some((rest[..end].parse().ok()?, &rest[end..]))
}

/// The actions of a FACS number. The side of AU 30, 61 and 62 is where jaw or eyes go.
fn unit(number: u32, side: Option<Side>) -> Option<Vec<Action>> {
    let gaze = |out: Side, inward: Side| {
        vec![
            Action { feature: "eyeLookOut", side: out, half: false },
            Action { feature: "eyeLookIn", side: inward, half: false },
        ]
    };
    match (number, side) {
        (30, Some(Side::Left)) => Some(sides(&["jawLeft"], None)),
        (30, Some(Side::Right)) => Some(sides(&["jawRight"], None)),
        (61, None) => Some(gaze(Side::Left, Side::Right)),
        (62, None) => Some(gaze(Side::Right, Side::Left)),
        _ => {
            let (_, features) = ACTION_UNITS.into_iter().find(|(n, _)| *n == number)?;
            Some(sides(features, side))
        }
    }
}

/// ARKit's feature of that name in small letters: a shape of ARKit, or two without their side.
fn feature(name: &str) -> Option<&'static str> {
    ARKIT_SHAPES.into_iter().find_map(|shape| {
        let feature = match (shape, shape.strip_suffix("Left").or(shape.strip_suffix("Right"))) {
            // Whole features that go to one side.
            ("mouthLeft" | "mouthRight" | "jawLeft" | "jawRight", _) | (_, None) => shape,
            (_, Some(stem)) => stem,
        };
        feature.eq_ignore_ascii_case(name).then_some(feature)
    })
}

fn sides(features: &[&'static str], side: Option<Side>) -> Vec<Action> {
    let both = [Side::Left, Side::Right];
    features
        .iter()
        .flat_map(|&feature| both.map(|side| Action { feature, side, half: false }))
        .filter(|action| side.is_none_or(|side| action.side == side))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shape_of_arkit_means_itself_in_every_spelling() {
        for shape in ARKIT_SHAPES {
            let snake: String = shape
                .chars()
                .flat_map(|c| if c.is_uppercase() { vec!['_', c] } else { vec![c] })
                .collect();
            let upper = shape[..1].to_uppercase() + &shape[1..];
            for name in [shape, &snake, &upper, &format!("head_blendShape.{shape}")] {
                assert_eq!(arkit_shapes(name), [shape], "{name}");
            }
        }
    }

    #[test]
    fn rigs_names_of_sides_and_facs_numbers_are_known() {
        for (name, expected) in [
            ("browDown_L", vec!["browDownLeft"]),
            ("R_browDown", vec!["browDownRight"]),
            ("browInnerUp_L", vec!["browInnerUp"]),
            ("cheekPuff_R", vec!["cheekPuff"]),
            ("LeftEyeBlink", vec!["eyeBlinkLeft"]),
            ("Face_EyeBlink_Left", vec!["eyeBlinkLeft"]),
            ("AU1", vec!["browInnerUp"]),
            ("AU_01_L", vec!["browInnerUp"]),
            ("AU04", vec!["browDownLeft", "browDownRight"]),
            ("au12_r", vec!["mouthSmileRight"]),
            ("AU12R", vec!["mouthSmileRight"]),
            ("L_AU12", vec!["mouthSmileLeft"]),
            ("AU12_LipCornerPuller_L", vec!["mouthSmileLeft"]),
            ("AU28", vec!["mouthRollLower", "mouthRollUpper"]),
            ("AU30_L", vec!["jawLeft"]),
            ("AU61", vec!["eyeLookInRight", "eyeLookOutLeft"]),
            ("mouthSmile", vec!["mouthSmileLeft", "mouthSmileRight"]),
            ("mouthLeft", vec!["mouthLeft"]),
            ("jaw_R", vec![]),
            ("AU25", vec![]),
            ("AU121", vec![]),
            ("viseme_aa", vec![]),
            ("", vec![]),
            ("_", vec![]),
        ] {
            assert_eq!(arkit_shapes(name), expected, "{name}");
        }
    }

    #[test]
    fn shapes_that_turn_the_eyes_are_known_in_every_spelling() {
        for name in ["eyeLookUpLeft", "eyeLookIn_L", "Face_EyeLookOut_Right", "AU61", "au64_r"] {
            assert!(turns_eyes(name), "{name}");
        }
        for name in ["eyeBlinkLeft", "eyeWideRight", "eyeSquint_L", "AU45", "look", "lidsClosed_L"]
        {
            assert!(!turns_eyes(name), "{name}");
        }
        assert_eq!(ARKIT_SHAPES.into_iter().filter(|name| turns_eyes(name)).count(), 8);
        for name in ["eyeBlinkLeft", "eyeBlink_R", "AU45", "Face_EyeBlink_Left"] {
            assert!(blinks(name), "{name}");
        }
        assert_eq!(ARKIT_SHAPES.into_iter().filter(|name| blinks(name)).count(), 2);
    }

    #[test]
    fn columns_find_their_shapes_whole_in_halves_and_shared() {
        let avatar = ["browInnerUp_L", "browInnerUp_R", "jawOpen", "smirk", "cheekPuff", "AU12"];
        let columns = [
            "JawOpen",
            "BrowInnerUp",
            "HeadYaw",
            "cheekPuff_L",
            "cheekPuff_R",
            "mouthSmileLeft",
            "mouthSmileRight",
            "smirk",
        ];
        let map = map_shapes(&avatar, &columns);
        assert_eq!(map.terms[0], [(1, 1.0)]);
        assert_eq!(map.terms[1], [(1, 1.0)]);
        assert_eq!(map.terms[2], [(0, 1.0)]);
        assert_eq!(map.terms[3], [(7, 1.0)]);
        assert_eq!(map.terms[4], [(3, 0.5), (4, 0.5)]);
        assert_eq!(map.terms[5], [(5, 0.5), (6, 0.5)]);
        assert_eq!(map.unused, [2]);
        // A whole column drives each half of it fully.
        let halves = map_shapes(&["mouthSmileLeft", "mouthSmileRight"], &["AU12"]);
        assert_eq!(halves.terms, [vec![(0, 1.0)], vec![(0, 1.0)]]);
        // The very same name wins over one that means the same.
        assert_eq!(map_shapes(&["AU4_L"], &["browDownLeft", "AU4_L"]).terms, [vec![(1, 1.0)]]);
    }

    #[test]
    fn facs_in_words_metahuman_and_vrm_are_known() {
        for (name, expected) in [
            ("lipCornerPullerL", vec!["mouthSmileLeft"]),
            ("innerBrowRaiserR", vec!["browInnerUp"]),
            ("browLowerL", vec!["browDownLeft"]),
            ("dimplerR", vec!["mouthDimpleRight"]),
            ("dimpler", vec!["mouthDimpleLeft", "mouthDimpleRight"]),
            ("eyesCloseL", vec!["eyeBlinkLeft"]),
            ("eyesLookLeft", vec!["eyeLookInRight", "eyeLookOutLeft"]),
            ("CTRL_expressions_jawOpen", vec!["jawOpen"]),
            ("CTRL_expressions_browDownL", vec!["browDownLeft"]),
            ("CTRL_expressions_eyeLookLeftL", vec!["eyeLookOutLeft"]),
            ("CTRL_expressions_eyeLookLeftR", vec!["eyeLookInRight"]),
            ("CTRL_expressions_eyeLookRightR", vec!["eyeLookOutRight"]),
            ("CTRL_expressions_mouthLeft", vec!["mouthLeft"]),
            ("CTRL_expressions_mouthFunnelUL", vec!["mouthFunnel"]),
            ("CTRL_expressions_jawChinRaiseDR", vec!["mouthShrugLower"]),
            ("CTRL_expressions_browLateralL", vec![]),
            ("blink", vec!["eyeBlinkLeft", "eyeBlinkRight"]),
            ("blinkLeft", vec!["eyeBlinkLeft"]),
            ("lookDown", vec!["eyeLookDownLeft", "eyeLookDownRight"]),
            ("aa", vec![]),
            ("happy", vec![]),
        ] {
            assert_eq!(arkit_shapes(name), expected, "{name}");
        }
    }

    #[test]
    fn halves_of_a_feature_are_joined_in_equal_shares() {
        let quarters = ["UL", "UR", "DL", "DR"].map(|q| format!("CTRL_expressions_mouthFunnel{q}"));
        let map = map_shapes(&["mouthFunnel", "mouthFunnel_L"], &quarters);
        assert_eq!(map.terms[0], [(0, 0.25), (2, 0.25), (1, 0.25), (3, 0.25)]);
        assert_eq!(map.terms[1], [(0, 0.5), (2, 0.5)]);
        assert!(map.unused.is_empty());
        // The other way round each quarter takes the whole feature, or its very own column.
        let back = map_shapes(&quarters, &["mouthFunnel"]);
        assert!(back.terms.iter().all(|terms| *terms == [(0, 1.0)]), "{back:?}");
        let same = map_shapes(&quarters, &quarters);
        assert!(same.terms.iter().enumerate().all(|(k, terms)| *terms == [(k, 1.0)]));
        // VRM's visemes are taken where the avatar has them.
        let vrm = map_shapes(&["aa", "jawOpen", "eyeBlinkLeft"], &["aa", "blink", "happy"]);
        assert_eq!(vrm.terms, [vec![(0, 1.0)], vec![], vec![(1, 1.0)]]);
        assert_eq!(vrm.unused, [2]);
    }
}
