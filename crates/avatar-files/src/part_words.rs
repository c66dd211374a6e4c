//! What a name says a mesh is: the words of the name against the words that rigs use.
//!
//! A name is cut at separators, digits and changes of case (`CC_Base_EyeOcclusion` has cc, base, eye,
//! occlusion), and a word that is several known words written as one is cut too (`lefteye`). Only
//! whole words count: `Solid` has no lid, a `Chair` no hair, a `Headset` is no head.

use mimique_avatar::Part;

/// The part that a mesh's name names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NamedPart {
    /// It is this part.
    Part(Part),
    /// It is an eyeball, of the person's left or right where the name says so.
    Eye(Option<Side>),
}

/// A side of the person.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

const LASHES: [&str; 4] = ["lash", "lashes", "eyelash", "eyelashes"];
/// Layers over the eye, whatever else the name says.
const OVERLAY: [&str; 6] = ["lacrimal", "tear", "tearline", "cornea", "caruncle", "cartilage"];
/// Layers over the eye in a name that says eye.
const OVER_EYE: [&str; 8] =
    ["occlusion", "wet", "moisture", "blend", "shell", "edge", "highlight", "reflection"];
const HAIR: [&str; 6] = ["brow", "eyebrow", "hair", "beard", "moustache", "mustache"];
const SOCKET: [&str; 2] = ["socket", "cavity"];
const TONGUE: [&str; 2] = ["tongue", "gum"];
const TEETH: [&str; 3] = ["teeth", "tooth", "denture"];
const SKIN: [&str; 3] = ["skin", "lid", "eyelid"];
const EYE: [&str; 6] = ["eye", "eyeball", "sclera", "iris", "irises", "pupil"];
const FACE: [&str; 2] = ["head", "face"];
/// What is worn on a part is not that part: `EyeGlasses`, `HairBand`.
const WORN: [&str; 20] = [
    "glasses", "glass", "goggles", "patch", "band", "phone", "gear", "mask", "shield", "clip",
    "pin", "tie", "brush", "wear", "hat", "helmet", "cloth", "clothes", "ring", "scarf",
];
/// Words that say nothing of a part by themselves, but are written as one with those that do.
const BESIDE: [&str; 27] = [
    "left", "right", "upper", "lower", "top", "bottom", "inner", "outer", "front", "back", "mesh",
    "geo", "geom", "model", "mat", "material", "mouth", "oral", "bag", "line", "base", "main",
    "my", "the", "male", "female", "white",
];
/// Longest word that is cut, letters: there are many ways to cut a long one.
const LONGEST_CUT: usize = 32;

/// What a name says, if anything; the order matters (an eyelash is no eye).
pub(crate) fn named_part(name: &str) -> Option<NamedPart> {
    let words = words(name);
    let any = |list: &[&str]| words.iter().any(|w| list.iter().any(|known| is(w, known)));
    if any(&WORN) {
        None
    } else if any(&LASHES) {
        Some(NamedPart::Part(Part::Lashes))
    } else if any(&OVERLAY) || (any(&["eye"]) && any(&OVER_EYE)) {
        Some(NamedPart::Part(Part::EyeOverlay))
    } else if any(&HAIR) {
        Some(NamedPart::Part(Part::Hair))
    } else if any(&SOCKET) || (any(&["mouth"]) && any(&["bag"])) {
        Some(NamedPart::Part(Part::Socket))
    } else if any(&TONGUE) {
        Some(NamedPart::Part(Part::Tongue))
    } else if any(&TEETH) {
        Some(NamedPart::Part(Part::Teeth))
    } else if any(&SKIN) {
        Some(NamedPart::Part(Part::Skin))
    } else if any(&EYE) {
        Some(NamedPart::Eye(side(&words)))
    } else if any(&FACE) {
        Some(NamedPart::Part(Part::Skin))
    } else {
        None
    }
}

/// The side that the words say, where they say one.
fn side(words: &[String]) -> Option<Side> {
    let any = |names: [&str; 2]| words.iter().any(|w| names.contains(&w.as_str()));
    match (any(["left", "l"]), any(["right", "r"])) {
        (true, false) => Some(Side::Left),
        (false, true) => Some(Side::Right),
        _ => None,
    }
}

/// Whether a word is the known one, or its plural.
fn is(word: &str, known: &str) -> bool {
    word == known || word.strip_suffix('s') == Some(known)
}

/// The words of a name, in small letters.
fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut out: Vec<String> = vec![String::new()];
    for (i, &c) in letters.iter().enumerate() {
        let before = i.checked_sub(1).map(|b| letters[b]);
        // `eyeLeft`, and the last capital of `EYELeft`.
        let after_small = before.is_some_and(char::is_lowercase);
        let before_small = letters.get(i + 1).is_some_and(|n| n.is_lowercase());
        let first = c.is_uppercase() && (after_small || before_small);
        if !c.is_alphabetic() || first {
            out.push(String::new());
        }
        if let (true, Some(word)) = (c.is_alphabetic(), out.last_mut()) {
            word.extend(c.to_lowercase());
        }
    }
    out.retain(|word| !word.is_empty());
    let pieces = |word: &str| if word.len() <= LONGEST_CUT { cut(word) } else { None };
    out.into_iter().flat_map(|word| pieces(&word).unwrap_or_else(|| vec![word])).collect()
}

/// A word as the known words it is made of; `None` where something is left over.
fn cut(word: &str) -> Option<Vec<String>> {
    let lists: [&[&str]; 12] = [
        &LASHES, &OVERLAY, &OVER_EYE, &HAIR, &SOCKET, &TONGUE, &TEETH, &SKIN, &EYE, &FACE, &WORN,
        &BESIDE,
    ];
    let known = || lists.iter().copied().flatten().copied();
    if known().any(|k| is(word, k)) {
        return Some(vec![word.to_owned()]);
    }
    known().find_map(|k| {
        let rest = word.strip_prefix(k)?;
        let rest = cut(rest).or_else(|| cut(rest.strip_prefix('s')?))?;
        Some([vec![k.to_owned()], rest].concat())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_told_from_the_names_that_rigs_use() {
        let (left, right) = (NamedPart::Eye(Some(Side::Left)), NamedPart::Eye(Some(Side::Right)));
        for (name, expected) in [
            ("MouthSocketEyeSockets", NamedPart::Part(Part::Socket)),
            ("mouthbag", NamedPart::Part(Part::Socket)),
            ("oral_cavity", NamedPart::Part(Part::Socket)),
            ("OralCavity", NamedPart::Part(Part::Socket)),
            ("GumsTongue", NamedPart::Part(Part::Tongue)),
            ("Teeth", NamedPart::Part(Part::Teeth)),
            ("upperteeth", NamedPart::Part(Part::Teeth)),
            ("teeth_lod0_mesh", NamedPart::Part(Part::Teeth)),
            ("EyeLeft", left),
            ("EyeRight", right),
            ("eye_R", right),
            ("R_EYE", right),
            ("EyeL", left),
            ("lEye", left),
            ("lefteye", left),
            ("eyeballsright", right),
            ("EYERight01", right),
            ("Eyes", NamedPart::Eye(None)),
            ("Eyeball", NamedPart::Eye(None)),
            ("Std_Eye_L", left),
            ("LeftIris", left),
            ("LacrimalBlendOcclusion", NamedPart::Part(Part::EyeOverlay)),
            ("CC_Base_EyeOcclusion", NamedPart::Part(Part::EyeOverlay)),
            ("CC_Base_TearLine", NamedPart::Part(Part::EyeOverlay)),
            ("eyeshell_lod0_mesh", NamedPart::Part(Part::EyeOverlay)),
            ("eyeEdge_lod0_mesh", NamedPart::Part(Part::EyeOverlay)),
            ("Std_Cornea_L", NamedPart::Part(Part::EyeOverlay)),
            ("eye_wet", NamedPart::Part(Part::EyeOverlay)),
            ("Lashes", NamedPart::Part(Part::Lashes)),
            ("Std_Eyelash", NamedPart::Part(Part::Lashes)),
            ("eyelashes_lod0_mesh", NamedPart::Part(Part::Lashes)),
            ("Wolf3D_Head", NamedPart::Part(Part::Skin)),
            ("ict_skin", NamedPart::Part(Part::Skin)),
            ("headmesh", NamedPart::Part(Part::Skin)),
            ("FACE", NamedPart::Part(Part::Skin)),
            ("EyeLids", NamedPart::Part(Part::Skin)),
            ("Eyebrows", NamedPart::Part(Part::Hair)),
            ("Wolf3D_Hair", NamedPart::Part(Part::Hair)),
        ] {
            assert_eq!(named_part(name), Some(expected), "{name}");
        }
    }

    #[test]
    fn letters_inside_other_words_say_nothing() {
        for name in [
            "Shirt",
            "Solid",
            "Lambert_solid1",
            "Surface",
            "Chair",
            "Argument",
            "Headset",
            "Wolf3D_Headwear",
            "Wolf3D_Glasses",
            "EyeGlasses",
            "HairBand",
            "FaceMask",
            "Flashlight",
            "Slider",
            "Buoyeye2go",
            "Body",
            "",
        ] {
            assert_eq!(named_part(name), None, "{name}");
        }
    }
}
