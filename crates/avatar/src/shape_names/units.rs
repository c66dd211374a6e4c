//! Action units as an avatar shows them: which of its shapes each unit moves.

use super::{ACTION_UNITS, Action, actions};

/// Units that no clip of single units shows unless they are named: lips held shut over a jaw that need not be
/// open (8), eyes that look up and down (63, 64).
const NOT_BY_THEMSELVES: [u32; 3] = [8, 63, 64];

/// An action unit as an avatar shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct ActionUnit {
    /// Its name: `AU12`; of one side `AU12_L`.
    pub name: String,
    /// The avatar's shapes that it moves, each with its share: the weight of a whole activation.
    pub shapes: Vec<(usize, f64)>,
}

impl ActionUnit {
    /// A unit by its name, as every reader of shape names knows it; none where the name means no action, or the
    /// avatar cannot show all of it.
    pub fn of<A: AsRef<str>>(name: &str, avatar: &[A]) -> Option<Self> {
        let wanted = actions(name);
        let same = |a: &Action, b: &Action| a.feature == b.feature && a.side == b.side;
        let mut shown = vec![false; wanted.len()];
        let mut shapes = Vec::new();
        for (place, shape) in avatar.iter().enumerate() {
            let does = actions(shape.as_ref());
            let moved = does.iter().filter(|action| wanted.iter().any(|w| same(w, action))).count();
            if moved > 0 {
                shapes.push((place, moved as f64 / does.len() as f64));
            }
            for (wanted, shown) in wanted.iter().zip(&mut shown) {
                *shown |= does.iter().any(|action| same(wanted, action));
            }
        }
        let whole = !wanted.is_empty() && shown.into_iter().all(|each| each);
        whole.then(|| Self { name: name.to_owned(), shapes })
    }

    /// The units that an avatar can show, both sides at once, by their numbers. Of units that are the same
    /// shapes (26 and 27, 43 and 45) the first; not those that are nothing by themselves (8, 63, 64).
    pub fn of_avatar<A: AsRef<str>>(avatar: &[A]) -> Vec<Self> {
        let mut units: Vec<Self> = Vec::new();
        for (number, _) in ACTION_UNITS {
            let found = Self::of(&format!("AU{number:02}"), avatar);
            let Some(unit) = found.filter(|_| !NOT_BY_THEMSELVES.contains(&number)) else {
                continue;
            };
            if units.iter().all(|known| known.shapes != unit.shapes) {
                units.push(unit);
            }
        }
        units
    }
}

impl AsRef<[(usize, f64)]> for ActionUnit {
    fn as_ref(&self) -> &[(usize, f64)] {
        &self.shapes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ARKIT_SHAPES;

    #[test]
    fn arkits_shapes_show_every_unit_that_is_one_by_itself() {
        let units = ActionUnit::of_avatar(&ARKIT_SHAPES);
        let names: Vec<&str> = units.iter().map(|unit| unit.name.as_str()).collect();
        assert_eq!(names.len(), 23, "{names:?}");
        for left_out in ["AU08", "AU27", "AU45", "AU63", "AU64"] {
            assert!(!names.contains(&left_out), "{left_out}");
        }
        let smile = units.iter().find(|unit| unit.name == "AU12").unwrap();
        let moved: Vec<&str> = smile.shapes.iter().map(|(k, _)| ARKIT_SHAPES[*k]).collect();
        assert_eq!(moved, ["mouthSmileLeft", "mouthSmileRight"]);
        // By names alone: sorted as texts they stand by their numbers.
        assert!(names.is_sorted());
    }

    #[test]
    fn sides_and_halves_take_their_shares() {
        let avatar =
            ["browInnerUp", "mouthSmile_L", "mouthSmile_R", "CTRL_expressions_mouthFunnelUL"];
        let of = |name: &str| ActionUnit::of(name, &avatar).map(|unit| unit.shapes);
        assert_eq!(of("AU12_L"), Some(vec![(1, 1.0)]));
        assert_eq!(of("AU12"), Some(vec![(1, 1.0), (2, 1.0)]));
        // One side of a brow that the avatar moves as a whole: half of it.
        assert_eq!(of("AU01_L"), Some(vec![(0, 0.5)]));
        // A funnel of one quarter is no funnel, and there is no jaw.
        assert_eq!(of("AU22"), None);
        assert_eq!((of("AU26"), of("AU25"), of("smirk")), (None, None, None));
    }
}
