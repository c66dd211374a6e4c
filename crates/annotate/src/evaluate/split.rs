//! Which takes train and which test: never frames of one take in both.

use std::collections::BTreeMap;

use mimique_stats::Stream;

use crate::{AnnotateError, AnnotatedTake};

/// Takes that train, and takes that test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fold {
    /// Indices of the takes that train, ascending.
    pub train: Vec<usize>,
    /// Indices of the takes that test, ascending.
    pub test: Vec<usize>,
}

/// Leave one group out: each group (a take's own name, a person, a kind) tests once, in order of
/// names. Of `groups` there is one a take.
///
/// # Errors
/// [`AnnotateError::Count`] for fewer than two groups.
pub fn leave_out<G: Ord>(groups: &[G]) -> Result<Vec<Fold>, AnnotateError> {
    let mut members: BTreeMap<&G, Vec<usize>> = BTreeMap::new();
    groups.iter().zip(0..).for_each(|(group, take)| members.entry(group).or_default().push(take));
    folds_of(members.into_values().collect(), groups.len())
}

/// `folds` folds of takes, of sizes that differ by one at most, drawn from a seed.
///
/// # Errors
/// [`AnnotateError::Count`] for fewer than two folds, or fewer takes than folds.
pub fn folds(takes: usize, folds: usize, seed: u64) -> Result<Vec<Fold>, AnnotateError> {
    if takes < folds {
        let what = "takes to fold";
        return Err(AnnotateError::Count { what, found: takes, expected: folds });
    }
    let mut order: Vec<usize> = (0..takes).collect();
    Stream::new(seed, 0).draw_first(&mut order, takes);
    let mut members = vec![Vec::new(); folds];
    order.into_iter().enumerate().for_each(|(place, take)| members[place % folds].push(take));
    members.iter_mut().for_each(|own| own.sort_unstable());
    folds_of(members, takes)
}

/// Refuses folds whose test takes have a label that no take left to learn from has.
///
/// # Errors
/// [`AnnotateError::HeldOut`] with the first such label and take.
pub fn check_folds(
    labels: usize,
    takes: &[AnnotatedTake],
    folds: &[Fold],
) -> Result<(), AnnotateError> {
    for Fold { train, test } in folds {
        for label in 0..labels {
            let left = train.iter().any(|&take| takes[take].shows(label));
            let tested = test.iter().copied().find(|&take| takes[take].shows(label));
            if let (false, Some(take)) = (left, tested) {
                return Err(AnnotateError::HeldOut { label, take });
            }
        }
    }
    Ok(())
}

fn folds_of(members: Vec<Vec<usize>>, takes: usize) -> Result<Vec<Fold>, AnnotateError> {
    if members.len() < 2 {
        let (what, found) = ("groups to leave out", members.len());
        return Err(AnnotateError::Count { what, found, expected: 2 });
    }
    let fold = |test: Vec<usize>| {
        let train = (0..takes).filter(|take| !test.contains(take)).collect();
        Fold { train, test }
    };
    Ok(members.into_iter().map(fold).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_person_tests_once_and_trains_otherwise() {
        let found = leave_out(&["b", "a", "b", "c"]).unwrap();
        let tests: Vec<_> = found.iter().map(|f| f.test.clone()).collect();
        assert_eq!(tests, [vec![1], vec![0, 2], vec![3]]);
        assert_eq!(found[1].train, [1, 3]);
        assert!(leave_out(&["a", "a"]).is_err());
    }

    #[test]
    fn folds_test_each_take_once_and_are_the_seeds() {
        let found = folds(7, 3, 5).unwrap();
        let mut all: Vec<usize> = found.iter().flat_map(|f| f.test.clone()).collect();
        all.sort_unstable();
        assert_eq!(all, (0..7).collect::<Vec<_>>());
        assert!(found.iter().all(|f| f.test.len() >= 2 && f.train.len() + f.test.len() == 7));
        assert_eq!(found, folds(7, 3, 5).unwrap());
        assert_ne!(found, folds(7, 3, 6).unwrap());
        assert!(folds(2, 3, 5).is_err() && folds(5, 1, 5).is_err());
    }
}
