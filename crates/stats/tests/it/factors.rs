//! Groups of a factor. `mimique verify` holds the tests against the values of R and SciPy.

use mimique_stats::{Factor, Outcome, Undefined};

#[test]
fn a_comparison_of_two_groups_is_what_restricting_the_factor_gives() {
    let factor = Factor::from_cells("g", ["b", "a", "c"].into_iter().map(Some), |_| None);
    let restricted = factor.restricted(&["c".to_owned(), "a".to_owned()]).unwrap();
    assert_eq!(restricted.levels, ["c", "a"]);
    assert_eq!(restricted.codes, [Factor::MISSING, 1, 0]);
    assert!(factor.restricted(&["d".to_owned()]).unwrap_err().to_string().contains("\"d\""));
    let outcome: Outcome<u8> = Outcome::undefined(Undefined::Unbalanced);
    assert_eq!(outcome.reason(), Some(&Undefined::Unbalanced));
}
