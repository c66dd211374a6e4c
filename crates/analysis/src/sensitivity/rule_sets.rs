//! Which rules of exclusion are applied: the sets of rules of a multiverse.

use mimique_study::Study;

use crate::trials::rule::Rule;

/// With more rules than this, not every subset of them is computed.
const MOST_RULES_IN_ALL_SUBSETS: usize = 4;

/// Sets of rules, each as whether a rule is applied; the first is all of them. Up to four rules: every subset. More: all of
/// them, all without one, and none.
pub(super) fn of(rules: usize) -> Vec<Vec<bool>> {
    if rules <= MOST_RULES_IN_ALL_SUBSETS {
        let subset = |omitted: usize| (0..rules).map(|rule| omitted >> rule & 1 == 0).collect();
        return (0..1_usize << rules).map(subset).collect();
    }
    let without = |omitted: usize| (0..rules).map(|rule| rule != omitted).collect();
    let mut sets = vec![vec![true; rules]];
    sets.extend((0..rules).map(without));
    sets.push(vec![false; rules]);
    sets
}

/// The study file with some of its rules only.
pub(super) fn applied_in(study: &Study, rules: &[Rule], applied: &[bool]) -> Study {
    let mut varied = study.clone();
    for (rule, _) in rules.iter().zip(applied).filter(|(_, applied)| !**applied) {
        rule.remove_from(&mut varied);
    }
    varied
}

#[cfg(test)]
mod tests {
    use super::of;

    #[test]
    fn few_rules_are_crossed_and_many_are_omitted_one_by_one() {
        assert_eq!(of(0), [Vec::<bool>::new()]);
        assert_eq!(of(2), [[true, true], [false, true], [true, false], [false, false]]);
        assert_eq!(of(4).len(), 16);
        let many = of(6);
        assert_eq!(many.len(), 8);
        assert_eq!((&many[0], &many[7]), (&vec![true; 6], &vec![false; 6]));
        assert!(many[1..7].iter().all(|set| set.iter().filter(|own| !**own).count() == 1));
    }
}
