//! The name that was probably meant.

/// The known name nearest to `given`, if it is near enough to be what was meant: at most a third of
/// the letters differ (a swap counts as one), case apart, or one contains the other.
pub(super) fn nearest<'a>(given: &str, known: &[&'a str]) -> Option<&'a str> {
    let wanted = given.to_lowercase();
    known
        .iter()
        .map(|name| (strsim::damerau_levenshtein(&wanted, &name.to_lowercase()), *name))
        .filter(|(distance, name)| {
            let lower = name.to_lowercase();
            let longer = wanted.chars().count().max(lower.chars().count());
            let part = wanted.len() > 3 && (lower.contains(&wanted) || wanted.contains(&lower));
            *distance * 3 <= longer || part
        })
        .min()
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_forgives_typing_but_does_not_guess() {
        let known = ["numItems", "start", "leftLabel", "rightLabel", "labels"];
        assert_eq!(nearest("numitems", &known), Some("numItems"));
        assert_eq!(nearest("letfLabel", &known), Some("leftLabel"));
        assert_eq!(nearest("items", &known), Some("numItems"));
        assert_eq!(nearest("colour", &known), None);
    }
}
