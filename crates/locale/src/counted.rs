//! Counts with their nouns, as messages say them: a number and the word for one in; "1 error", "2 errors" out.

/// A count with an English noun whose plural ends in s.
///
/// ```
/// use mimique_locale::counted;
///
/// assert_eq!(counted(1, "error"), "1 error");
/// assert_eq!(counted(0, "error"), "0 errors");
/// ```
pub fn counted(count: usize, one: &str) -> String {
    counted_as(count, one, &format!("{one}s"))
}

/// A count with an English noun and its plural: 1 is one, all else is many.
pub fn counted_as(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A count with a French noun and its plural, which begins at two: "0 suite", "1 suite", "2 suites".
pub fn counted_in_french(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count < 2 { one } else { many })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_one_in_both_languages_and_none_is_many_in_english() {
        let english = [0, 1, 2].map(|count| counted_as(count, "person", "people"));
        assert_eq!(english, ["0 people", "1 person", "2 people"]);
        let french = [0, 1, 2].map(|count| counted_in_french(count, "suite", "suites"));
        assert_eq!(french, ["0 suite", "1 suite", "2 suites"]);
    }
}
