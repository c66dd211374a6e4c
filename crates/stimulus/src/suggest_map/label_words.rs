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
