//! Shapes that belong together by name: the two sides of one movement, and movements that undo each
//! other.

use crate::fit::setup::Setup;

/// Words that turn a name into that of a partner.
const OPPOSED: [[&str; 2]; 4] = [["left", "right"], ["l", "r"], ["in", "out"], ["up", "down"]];

/// Partners whose motions of the markers have a cosine below this undo each other: `jawLeft` and
/// `jawRight` have -0.99 on ICT-FaceKit, `mouthLeft` and `mouthRight` -0.73, while the two sides of one
/// movement move markers of their own.
const AGAINST_EACH_OTHER: f64 = -0.5;

/// Pairs of free shapes.
#[derive(Debug, Default, PartialEq)]
pub(super) struct ShapePairs {
    /// The two sides of one movement: `mouthSmileLeft` and `mouthSmileRight`.
    pub(super) symmetric: Vec<[usize; 2]>,
    /// Movements that undo each other: `jawLeft` and `jawRight`, `eyeLookInLeft` and `eyeLookOutLeft`.
    pub(super) cancelling: Vec<[usize; 2]>,
}

/// The pairs among the free shapes of an avatar: by their names, and by how they move the markers.
pub(super) fn shape_pairs(setup: &Setup<'_>) -> ShapePairs {
    let names: Vec<Vec<&str>> = setup.free_names.iter().map(|name| words(name)).collect();
    let mut found = ShapePairs::default();
    for j in 0..names.len() {
        for i in 0..j {
            let Some(which) = opposed(&names[i], &names[j]) else { continue };
            let sizes = setup.product(i, i) * setup.product(j, j);
            if setup.product(i, j) < AGAINST_EACH_OTHER * sizes.sqrt() {
                found.cancelling.push([i, j]);
            } else if which < 2 {
                found.symmetric.push([i, j]);
            }
        }
    }
    found
}

/// Which of [`OPPOSED`] is all that two names differ by.
fn opposed(a: &[&str], b: &[&str]) -> Option<usize> {
    if a.len() != b.len() {
        return None;
    }
    let mut different = a.iter().zip(b).filter(|(a, b)| !a.eq_ignore_ascii_case(b));
    let ((a, b), None) = (different.next()?, different.next()) else { return None };
    let is =
        |word: &str, other: &str| a.eq_ignore_ascii_case(word) && b.eq_ignore_ascii_case(other);
    OPPOSED.iter().position(|[one, other]| is(one, other) || is(other, one))
}

/// `mouthSmile_L`: mouth, Smile, L.
fn words(name: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let (mut start, mut before) = (0, b' ');
    for (at, letter) in name.bytes().enumerate() {
        let parts = letter.is_ascii() && !letter.is_ascii_alphanumeric();
        if parts || (letter.is_ascii_uppercase() && !before.is_ascii_uppercase()) {
            words.extend(name.get(start..at).filter(|word| !word.is_empty()));
            start = at + usize::from(parts);
        }
        before = letter;
    }
    words.extend(name.get(start..).filter(|word| !word.is_empty()));
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_differ_by_one_opposed_word_are_partners() {
        for (a, b, which) in [
            ("mouthSmileLeft", "mouthSmileRight", Some(0)),
            ("mouthSmile_R", "mouthSmile_L", Some(1)),
            ("AU12_L", "AU12_R", Some(1)),
            ("Face_EyeLookOut_Right", "Face_EyeLookIn_Right", Some(2)),
            ("eyeLookUpLeft", "eyeLookDownLeft", Some(3)),
            ("jawLeft", "jawRight", Some(0)),
            ("eyeLookUpLeft", "eyeLookDownRight", None),
            ("mouthUpperUp_L", "mouthLowerDown_L", None),
            ("jawOpen", "mouthClose", None),
            ("smile", "smile", None),
        ] {
            assert_eq!(opposed(&words(a), &words(b)), which, "{a} {b}");
        }
        assert_eq!(words("browInnerUp_L"), ["brow", "Inner", "Up", "L"]);
    }
}
