//! What a marker's label says of its place: `Leyebrow_Outside` is at the left brow.

/// A part of the face that labels name and that an avatar's shapes show the place of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Region {
    Brow,
    Eye,
    Nose,
    Cheek,
    Mouth,
    MouthCorner,
    Chin,
}

/// Side of the person, as the label says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    Left,
    Right,
    Middle,
}

impl Side {
    pub(super) fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
            Self::Middle => Self::Middle,
        }
    }
}

/// A place that a label names to within a few millimetres, as landmarks of a face are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Named {
    /// Inner end, middle and outer end of a brow.
    BrowInner,
    BrowMiddle,
    BrowOuter,
    /// The root of the nose between the eyes.
    NoseRoot,
    NoseTip,
    /// Where the wing of a nostril meets the lip.
    NoseBase,
    MouthCorner,
    UpperLip,
    LowerLip,
    Chin,
}

/// Words of a region, in English and French; the first that a label holds counts, so that an eyebrow
/// is no eye.
const WORDS: [(&str, Option<Region>); 19] = [
    ("forehead", None),
    ("front", None),
    ("eyebrow", Some(Region::Brow)),
    ("brow", Some(Region::Brow)),
    ("sourcil", Some(Region::Brow)),
    ("eyelid", Some(Region::Eye)),
    ("eye", Some(Region::Eye)),
    ("lid", Some(Region::Eye)),
    ("paupi", Some(Region::Eye)),
    ("nostril", Some(Region::Nose)),
    ("nose", Some(Region::Nose)),
    ("nez", Some(Region::Nose)),
    ("cheek", Some(Region::Cheek)),
    ("joue", Some(Region::Cheek)),
    ("mouth", Some(Region::Mouth)),
    ("lip", Some(Region::Mouth)),
    ("bouche", Some(Region::Mouth)),
    ("chin", Some(Region::Chin)),
    ("menton", Some(Region::Chin)),
];
/// Words that put a marker of the mouth at its corner.
const CORNERS: [&str; 4] = ["corner", "commissure", "lend", "rend"];
/// Words between which a lone L or R is a side.
const PLACES: [&str; 8] = ["up", "down", "upper", "lower", "inner", "outer", "inside", "outside"];

/// What a label says of its place; none where it says nothing.
pub(super) fn place_of(label: &str) -> Option<(Region, Side)> {
    let lower = label.to_lowercase();
    let (_, region) = WORDS.iter().find(|(word, _)| lower.contains(word))?;
    let corner = *region == Some(Region::Mouth) && CORNERS.iter().any(|c| lower.contains(c));
    let region = if corner { Region::MouthCorner } else { (*region)? };
    Some((region, side_of(&lower)))
}

/// Words for where in its part a marker is: in English and French, and single letters between other characters.
const INNER: [&str; 4] = ["inside", "inner", "medial", "intern"];
const OUTER: [&str; 4] = ["outside", "outer", "lateral", "extern"];
const MIDDLE: [&str; 4] = ["middle", "mid", "milieu", "m"];
const UPPER: [&str; 5] = ["up", "upper", "top", "haut", "sup"];
const LOWER: [&str; 6] = ["down", "low", "lower", "bottom", "bas", "inf"];
const TIP: [&str; 5] = ["head", "tip", "apex", "pointe", "bout"];
const ROOT: [&str; 6] = ["top", "root", "bridge", "up", "upper", "racine"];

/// The landmark that a label names, and its side; none where it names none so closely.
pub(super) fn named_place(label: &str) -> Option<(Named, Side)> {
    let (region, side) = place_of(label)?;
    let lower = label.to_lowercase();
    // Words end where a digit, a capital or another character does.
    let mut words: Vec<String> = vec![String::new()];
    let mut last: Option<char> = None;
    for letter in label.chars() {
        let begins = letter.is_uppercase() && last.is_some_and(char::is_lowercase);
        if begins || !letter.is_alphabetic() {
            words.push(String::new());
        }
        if letter.is_alphabetic()
            && let Some(word) = words.last_mut()
        {
            word.extend(letter.to_lowercase());
        }
        last = Some(letter);
    }
    let says = |list: &[&str]| {
        words.iter().any(|word| list.contains(&word.as_str()))
            || list.iter().any(|long| long.len() > 4 && lower.contains(long))
    };
    let number = lower.chars().any(|c| c.is_ascii_digit());
    let middle = side == Side::Middle;
    let named = match region {
        Region::Brow if middle => return None,
        Region::Brow if says(&INNER) => Named::BrowInner,
        Region::Brow if says(&OUTER) => Named::BrowOuter,
        Region::Brow if says(&MIDDLE) => Named::BrowMiddle,
        Region::Nose if middle && says(&TIP) => Named::NoseTip,
        Region::Nose if middle && says(&ROOT) => Named::NoseRoot,
        Region::Nose if !middle && says(&TIP) => Named::NoseBase,
        Region::MouthCorner if !middle => Named::MouthCorner,
        Region::Mouth if middle && !number && says(&UPPER) => Named::UpperLip,
        Region::Mouth if middle && !number && says(&LOWER) => Named::LowerLip,
        Region::Chin if middle && !number => Named::Chin,
        _ => return None,
    };
    Some((named, side))
}

fn side_of(lower: &str) -> Side {
    if lower.contains("left") || lower.contains("gauche") {
        return Side::Left;
    }
    if lower.contains("right") || lower.contains("droit") {
        return Side::Right;
    }
    for token in lower.split(|c: char| !c.is_alphanumeric()).filter(|t| !t.is_empty()) {
        let token = token.trim_end_matches(|c: char| c.is_ascii_digit());
        for (letter, side) in [('l', Side::Left), ('r', Side::Right)] {
            let begins = token.strip_prefix(letter).is_some_and(|rest| {
                rest.is_empty() || rest == "end" || WORDS.iter().any(|(w, _)| rest.starts_with(w))
            });
            let ends = token.strip_suffix(letter).is_some_and(|rest| {
                PLACES.contains(&rest) || WORDS.iter().any(|(w, _)| rest == *w)
            });
            if begins || ends {
                return side;
            }
        }
    }
    Side::Middle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_that_name_landmarks() {
        for (label, place) in [
            ("Leyebrow_Inside", Some((Named::BrowInner, Side::Left))),
            ("Reyebrow_M", Some((Named::BrowMiddle, Side::Right))),
            ("Leyebrow_Outside", Some((Named::BrowOuter, Side::Left))),
            ("Eyebrow_Center", None),
            ("NoseHead", Some((Named::NoseTip, Side::Middle))),
            ("NoseHead_L", Some((Named::NoseBase, Side::Left))),
            ("nose_wing_left", None),
            ("NoseTop", Some((Named::NoseRoot, Side::Middle))),
            ("nose_tip", Some((Named::NoseTip, Side::Middle))),
            ("Mouth_Lend", Some((Named::MouthCorner, Side::Left))),
            ("mouth_corner_right", Some((Named::MouthCorner, Side::Right))),
            ("Mouth_Up", Some((Named::UpperLip, Side::Middle))),
            ("Mouth_UpL1", None),
            ("lip_lower", Some((Named::LowerLip, Side::Middle))),
            ("Mouth_DownR", None),
            ("Chin", Some((Named::Chin, Side::Middle))),
            ("Chin_R2", None),
            ("Leye_Up", None),
            ("Lcheek_Outside", None),
            ("M07", None),
        ] {
            assert_eq!(named_place(label), place, "{label}");
        }
    }

    #[test]
    fn labels_of_laboratories() {
        for (label, place) in [
            ("Leyebrow_Outside", Some((Region::Brow, Side::Left))),
            ("Eyebrow_Center", Some((Region::Brow, Side::Middle))),
            ("Reye_Down", Some((Region::Eye, Side::Right))),
            ("NoseHead_L", Some((Region::Nose, Side::Left))),
            ("NoseTop", Some((Region::Nose, Side::Middle))),
            ("Rcheek_up", Some((Region::Cheek, Side::Right))),
            ("Mouth_UpL1", Some((Region::Mouth, Side::Left))),
            ("Mouth_DownR", Some((Region::Mouth, Side::Right))),
            ("Mouth_Lend", Some((Region::MouthCorner, Side::Left))),
            ("mouth_corner_right", Some((Region::MouthCorner, Side::Right))),
            ("Chin_R2", Some((Region::Chin, Side::Right))),
            ("lip_upper", Some((Region::Mouth, Side::Middle))),
            ("lid_lower_left", Some((Region::Eye, Side::Left))),
            ("sourcil gauche 1", Some((Region::Brow, Side::Left))),
            ("ForeHead_L", None),
            ("M07", None),
            ("", None),
        ] {
            assert_eq!(place_of(label), place, "{label}");
        }
    }
}
