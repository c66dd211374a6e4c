//! Bands: where every method above is told apart from every method below.

use std::collections::BTreeSet;

use serde::Serialize;

use super::{Difference, Placed};

/// Methods that are not ranked among themselves.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Band {
    /// The ranks that they share, from the first to the last.
    pub ranks: [usize; 2],
    /// The methods, by name.
    pub methods: Vec<String>,
}

/// The bands of methods that stand from the highest worth; each method gets the number of its own.
pub(super) fn bands(placed: &mut [Placed], differences: &[Difference]) -> Vec<Band> {
    let told: BTreeSet<[&str; 2]> = (differences.iter())
        .filter(|difference| difference.separated)
        .map(|difference| [difference.a.as_str(), difference.b.as_str()])
        .collect();
    let names: Vec<String> = placed.iter().map(|own| own.standing.method.clone()).collect();
    let ends_after = |place: usize| {
        let below = &names[place + 1..];
        names[..=place]
            .iter()
            .all(|a| below.iter().all(|b| told.contains(&[a.as_str(), b.as_str()])))
    };
    let mut bands: Vec<Band> = Vec::new();
    let mut first = 0;
    for (place, own) in placed.iter_mut().enumerate() {
        own.band = bands.len() + 1;
        if ends_after(place) {
            let mut methods = names[first..=place].to_vec();
            methods.sort();
            bands.push(Band { ranks: [first + 1, place + 1], methods });
            first = place + 1;
        }
    }
    bands
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranking::Standing;

    fn placed(names: &[&str]) -> Vec<Placed> {
        let standing = |name: &&str| Standing {
            method: (*name).to_owned(),
            votes: 0,
            chosen: 0,
            same: 0,
            people: 0,
            first_day: None,
        };
        let own = |name| Placed {
            standing: standing(name),
            band: 0,
            ranks: [0, 0],
            worth: 0.0,
            interval: None,
        };
        names.iter().map(own).collect()
    }

    fn told(pairs: &[[&str; 2]]) -> Vec<Difference> {
        let own = |[a, b]: &[&str; 2]| Difference {
            a: (*a).to_owned(),
            b: (*b).to_owned(),
            difference: 1.0,
            interval: [0.5, 1.5],
            preferred: 0.75,
            p: 0.01,
            separated: true,
        };
        pairs.iter().map(own).collect()
    }

    #[test]
    fn a_band_ends_where_all_above_are_told_from_all_below() {
        let all = [["a", "b"], ["a", "c"], ["a", "d"], ["b", "d"], ["c", "d"]];
        let mut own = placed(&["a", "c", "b", "d"]);
        let found = bands(&mut own, &told(&all));
        let names: Vec<Vec<String>> = found.iter().map(|band| band.methods.clone()).collect();
        assert_eq!(names, [vec!["a"], vec!["b", "c"], vec!["d"]]);
        assert_eq!(found[1].ranks, [2, 3]);
        assert_eq!(own.iter().map(|own| own.band).collect::<Vec<_>>(), [1, 2, 2, 3]);
    }

    #[test]
    fn ends_that_differ_do_not_rank_what_stands_between_and_overlaps_both() {
        // The first is told from the last, the middle from neither: nothing can be cut.
        let found = bands(&mut placed(&["a", "b", "c"]), &told(&[["a", "c"]]));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].ranks, [1, 3]);
    }
}
