//! Names with `*`: patterns of shapes and markers in `locked`, `bounds` and `importance`.

use std::collections::BTreeMap;

use super::table::MethodSpec;

/// What stands for any letters, or none.
const ANY: char = '*';

impl MethodSpec {
    /// The same with the patterns of `locked`, `bounds` and `importance` replaced by the names that they match:
    /// `eyeLook*` is the eight shapes that turn the eyes of an avatar with ARKit's names. What is named itself
    /// comes before a pattern, and a longer pattern before a shorter one. A pattern that matches nothing
    /// stays, and is refused as a name that nothing has.
    #[must_use]
    pub fn with_names_of(&self, shapes: &[String], markers: &[String]) -> Self {
        let mut spec = self.clone();
        spec.bounds = named(&self.bounds, shapes, &self.locked);
        spec.importance = named(&self.importance, markers, &[]);
        if self.locked.iter().any(|name| name.contains(ANY)) {
            spec.locked = Vec::new();
            for own in &self.locked {
                let found: Vec<&String> = names_of(own, shapes).collect();
                if found.is_empty() {
                    spec.locked.push(own.clone());
                }
                for name in found {
                    let is_pattern = name != own;
                    let named_itself = self.bounds.contains_key(name) || self.locked.contains(name);
                    if !spec.locked.contains(name) && !(is_pattern && named_itself) {
                        spec.locked.push(name.clone());
                        spec.bounds.remove(name);
                    }
                }
            }
        }
        spec
    }
}

/// The names that a name or a pattern stands for.
fn names_of<'a>(own: &'a str, known: &'a [String]) -> impl Iterator<Item = &'a String> {
    known.iter().filter(move |name| matches(own, name))
}

/// Values by name, of values by name or pattern; patterns give none to `except`.
fn named<T: Copy>(
    given: &BTreeMap<String, T>,
    known: &[String],
    except: &[String],
) -> BTreeMap<String, T> {
    let mut out = given.clone();
    let mut patterns: Vec<(&String, &T)> =
        given.iter().filter(|(name, _)| name.contains(ANY)).collect();
    patterns.sort_by_key(|(pattern, _)| std::cmp::Reverse(pattern.len()));
    for (pattern, value) in patterns {
        let mut found = false;
        for name in names_of(pattern, known) {
            found = true;
            if !except.contains(name) {
                out.entry(name.clone()).or_insert(*value);
            }
        }
        if found {
            out.remove(pattern);
        }
    }
    out
}

/// Whether a name is what a name or a pattern says.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once(ANY) {
        None => pattern == name,
        Some((start, rest)) => name.strip_prefix(start).is_some_and(|tail| {
            let ends = tail.char_indices().map(|(at, _)| at).chain([tail.len()]);
            ends.into_iter().any(|at| matches(rest, &tail[at..]))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Method;

    fn names(all: &[&str]) -> Vec<String> {
        all.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn patterns_are_the_names_that_they_match() {
        for (pattern, name, is) in [
            ("eyeLook*", "eyeLookUpLeft", true),
            ("eyeLook*", "eyeLook", true),
            ("eyeLook*", "eyeBlinkLeft", false),
            ("*Left", "mouthSmileLeft", true),
            ("*Left", "mouthSmileLeft2", false),
            ("mouth*Left", "mouthLeft", true),
            ("*o*e*", "noseSneer", true),
            ("jawOpen", "jawOpen", true),
            ("jaw", "jawOpen", false),
            ("*", "é", true),
        ] {
            assert_eq!(matches(pattern, name), is, "{pattern} {name}");
        }
    }

    #[test]
    fn what_is_named_itself_comes_first() {
        let shapes = names(&["eyeLookInLeft", "eyeLookInRight", "eyeLookUpLeft", "jawOpen"]);
        let mut spec = MethodSpec::new(Method::Lsts);
        spec.locked = names(&["jawOpen", "eyeLook*", "no*"]);
        spec.bounds.insert("eyeLookUpLeft".to_owned(), [0.0, 0.5]);
        spec.importance.insert("*".to_owned(), 0.5);
        spec.importance.insert("chin".to_owned(), 2.0);
        spec.importance.insert("lip*".to_owned(), 3.0);
        let found = spec.with_names_of(&shapes, &names(&["chin", "lip1", "nose"]));
        assert_eq!(found.locked, names(&["jawOpen", "eyeLookInLeft", "eyeLookInRight", "no*"]));
        assert_eq!(found.bounds.keys().collect::<Vec<_>>(), ["eyeLookUpLeft"]);
        let of = |name: &str| found.importance[name];
        assert_eq!(
            (of("chin"), of("lip1"), of("nose"), found.importance.len()),
            (2.0, 3.0, 0.5, 3)
        );
        assert_eq!(found.with_names_of(&shapes, &[]), found);
        // A locked name comes before bounds of a pattern.
        let mut spec = MethodSpec::new(Method::Lsts);
        spec.locked = names(&["jawOpen"]);
        spec.bounds.insert("*".to_owned(), [0.0, 0.5]);
        assert_eq!(spec.with_names_of(&shapes, &[]).bounds.len(), 3);
    }
}
