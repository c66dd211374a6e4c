//! Names with `*`: patterns of shapes and markers in `locked`, `bounds` and `importance`.

use wildmatch::WildMatchPattern;

use super::kind::NamesOf;
use super::problem::{SpecError, SpecFault};
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
        let is_used = |own: &str, known: &[String]| {
            own.contains(ANY) && known.iter().any(|name| fits(own, name))
        };
        let bounded: Vec<&str> = self.bounds.keys().map(String::as_str).collect();
        let locked: Vec<&str> = self.locked.iter().map(String::as_str).collect();
        let counted: Vec<&str> = self.importance.keys().map(String::as_str).collect();
        spec.locked.retain(|own| !is_used(own, shapes));
        spec.bounds.retain(|own, _| !is_used(own, shapes));
        spec.importance.retain(|own, _| !is_used(own, markers));
        spec.locked.extend(matched(&locked, shapes, &bounded).map(|(_, name)| name.clone()));
        let held: Vec<&str> = spec.locked.iter().map(String::as_str).collect();
        for (pattern, name) in matched(&bounded, shapes, &held) {
            spec.bounds.insert(name.clone(), self.bounds[pattern]);
        }
        for (pattern, name) in matched(&counted, markers, &[]) {
            spec.importance.insert(name.clone(), self.importance[pattern]);
        }
        spec
    }

    /// What is wrong with the names in `locked`, `importance` and `bounds`: each that is none of these shapes and
    /// markers, patterns that match none among them, at its place.
    pub fn unknown_names(&self, shapes: &[String], markers: &[String]) -> Vec<SpecError> {
        let spec = self.with_names_of(shapes, markers);
        let mut found = Vec::new();
        let mut look = |field: &str, entry: String, name: &String, of: NamesOf| {
            let known = match of {
                NamesOf::Shapes => shapes,
                NamesOf::Markers => markers,
            };
            if !known.contains(name) {
                let fault =
                    SpecFault::UnknownName { of, found: name.clone(), known: known.to_vec() };
                found.push(SpecError { entry: Some(entry), ..SpecError::of(field, fault) });
            }
        };
        for name in &spec.locked {
            let index = self.locked.iter().position(|own| own == name).unwrap_or_default();
            look("locked", index.to_string(), name, NamesOf::Shapes);
        }
        for name in spec.importance.keys() {
            look("importance", name.clone(), name, NamesOf::Markers);
        }
        for name in spec.bounds.keys() {
            look("bounds", name.clone(), name, NamesOf::Shapes);
        }
        found
    }
}

/// Whether a name is what a pattern says; a question mark is a letter like others.
fn fits(pattern: &str, name: &str) -> bool {
    WildMatchPattern::<ANY, '\0'>::new(pattern).matches(name)
}

/// For every known name that is not given itself, nor among `others`, the longest pattern that it matches.
fn matched<'a>(
    given: &[&'a str],
    known: &'a [String],
    others: &[&str],
) -> impl Iterator<Item = (&'a str, &'a String)> {
    known.iter().filter_map(move |name| {
        if given.contains(&&name[..]) || others.contains(&&name[..]) {
            return None;
        }
        let patterns = given.iter().filter(|own| own.contains(ANY) && fits(own, name));
        patterns.max_by_key(|own| own.len()).map(|pattern| (*pattern, name))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Method;

    fn names(all: &[&str]) -> Vec<String> {
        all.iter().map(|name| (*name).to_owned()).collect()
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
        assert_eq!(found.locked, names(&["jawOpen", "no*", "eyeLookInLeft", "eyeLookInRight"]));
        assert_eq!(found.bounds.keys().collect::<Vec<_>>(), ["eyeLookUpLeft"]);
        let of = |name: &str| found.importance[name];
        assert_eq!(
            (of("chin"), of("lip1"), of("nose"), found.importance.len()),
            (2.0, 3.0, 0.5, 3)
        );
        assert_eq!(found.with_names_of(&shapes, &[]), found);
        // A pattern that matches only what is named itself is no fault.
        spec.locked = names(&["*UpLeft"]);
        assert!(spec.with_names_of(&shapes, &[]).locked.is_empty());
        // A locked name comes before bounds of a pattern.
        let mut spec = MethodSpec::new(Method::Lsts);
        spec.locked = names(&["jawOpen"]);
        spec.bounds.insert("*".to_owned(), [0.0, 0.5]);
        assert_eq!(spec.with_names_of(&shapes, &[]).bounds.len(), 3);
    }
}
