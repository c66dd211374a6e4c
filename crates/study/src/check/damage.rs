//! What is still true of a file whose structure is damaged: the rest of it is checked as it can be
//! read, and a finding that may come of the damage alone is left out.

use serde_json::Value;

use super::issue::Issue;

/// Keys and values that could not be read as they stand.
#[derive(Debug, Default)]
pub(super) struct Damage {
    /// Pointers of what is missing or has no right value.
    places: Vec<String>,
    /// Misspelt keys, outer ones first: their pointer, and the key that is meant.
    misspelt: Vec<(String, String)>,
}

/// Parts of the file on which the order of trials rests.
const ORDER: [&str; 6] = [
    "/sequence",
    "/components",
    "/stimuli/avatars",
    "/stimuli/segments",
    "/stimuli/methods",
    "/stimuli/clips",
];
/// Parts that refer to one another, besides those of the order.
const REFERRED: [&str; 6] =
    ["/questions", "/demographics", "/training", "/stimuli/captures", "/hypotheses", "/tables"];
/// Findings that a key is not there at all, which damage elsewhere in its section does not touch.
const ABSENT: [&str; 3] = ["no-minimum-age", "no-retention", "no-ethics-board"];

impl Damage {
    pub fn place(&mut self, pointer: String) {
        self.places.push(pointer);
    }

    pub fn misspelt(&mut self, pointer: String, meant: &str) {
        self.misspelt.push((pointer, meant.to_owned()));
    }

    pub fn is_none(&self) -> bool {
        self.places.is_empty() && self.misspelt.is_empty()
    }

    /// The file with its misspelt keys as they are meant.
    pub fn corrected(&self, file: &Value) -> Value {
        let mut file = file.clone();
        // Inner ones first: their pointers name the outer ones as the file does.
        for (pointer, meant) in self.misspelt.iter().rev() {
            let Some((parent, key)) = pointer.rsplit_once('/') else { continue };
            let key = key.replace("~1", "/").replace("~0", "~");
            if let Some(Value::Object(map)) = file.pointer_mut(parent)
                && let Some(value) = map.remove(&key)
            {
                map.insert(meant.clone(), value);
            }
        }
        file
    }

    /// The finding on the corrected file, with its place in the file as it is.
    pub fn placed(&self, mut issue: Issue) -> Issue {
        for (pointer, meant) in &self.misspelt {
            let Some((parent, _)) = pointer.rsplit_once('/') else { continue };
            let corrected = format!("{parent}/{meant}");
            if is_within(&issue.pointer, &corrected) {
                issue.pointer = format!("{pointer}{}", &issue.pointer[corrected.len()..]);
            }
        }
        issue
    }

    /// Whether a finding on the corrected file is true whatever the damaged places should say.
    pub fn leaves(&self, issue: &Issue) -> bool {
        self.places.iter().all(|place| !touches(&self.as_meant(place), issue))
    }

    /// The pointer of a place in the corrected file.
    fn as_meant(&self, place: &str) -> String {
        let mut place = place.to_owned();
        for (pointer, meant) in self.misspelt.iter().rev() {
            let Some((parent, _)) = pointer.rsplit_once('/') else { continue };
            if is_within(&place, pointer) {
                place = format!("{parent}/{meant}{}", &place[pointer.len()..]);
            }
        }
        place
    }
}

fn touches(place: &str, issue: &Issue) -> bool {
    let pointer = issue.pointer.as_str();
    if issue.code() == "bad-parameter"
        && !place.ends_with("/method")
        && element(place) != Some(place)
    {
        // A parameter is judged by itself.
        return is_within(pointer, place);
    }
    if is_within(pointer, element(place).unwrap_or(place)) {
        return true;
    }
    // A section as a whole is judged by its keys.
    let within = !pointer.is_empty() && is_within(place, pointer);
    if within && !ABSENT.contains(&issue.code()) {
        return true;
    }
    let among =
        |parts: &[&str]| parts.iter().any(|part| is_within(place, part) || is_within(part, place));
    match issue.code() {
        "missing-translation"
        | "undeclared-language"
        | "untranslated-buttons"
        | "one-text-for-all"
        | "unfair-check" => among(&["/languages"]),
        "unsatisfiable-order" | "uneven-samples" | "too-many" => among(&ORDER),
        "empty" => {
            among(&ORDER) && ["/sequence", "/components"].iter().any(|it| is_within(pointer, it))
        }
        "unknown-reference" => {
            (is_name(place) && (among(&ORDER) || among(&REFERRED)))
                || among(&ORDER[2..])
                || among(&["/training", "/stimuli/captures"])
        }
        "not-a-number"
        | "no-truth"
        | "bad-answer"
        | "never-holds"
        | "no-right-answer"
        | "nothing-to-fail"
        | "no-companion"
        | "missing-video"
        | "bad-video"
        | "bad-exertion"
        | "unused"
        | "unused-question"
        | "unused-factor"
        | "constraint-on-nothing"
        | "wrong-length"
        | "out-of-range"
        | "too-late"
        | "not-kept"
        | "factor-twice"
        | "no-conditions"
        | "dependent-samples"
        | "of-two-clips"
        | "no-order"
        | "not-asked"
        | "several-answers"
        | "bad-interruption" => among(&ORDER) || among(&REFERRED),
        "no-code" => among(&["/recruitment", "/device", "/screening", "/training"]),
        _ => false,
    }
}

/// Whether a pointer is at or below another.
pub(super) fn is_within(pointer: &str, outer: &str) -> bool {
    pointer.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// The outermost part of the file with a name or a number of its own that a place lies in: a
/// question, a component, a segment.
fn element(place: &str) -> Option<&str> {
    if is_within(place, "/sequence") {
        return Some("/sequence");
    }
    let named = [
        "/components",
        "/translations",
        "/stimuli/avatars",
        "/stimuli/captures",
        "/stimuli/methods",
    ];
    let mut end = 0;
    for token in place.split('/').skip(1) {
        let outer = &place[..end];
        end += 1 + token.len();
        let is_number = token.bytes().all(|digit| digit.is_ascii_digit());
        if (is_number && !token.is_empty()) || named.contains(&outer) {
            return Some(&place[..end]);
        }
    }
    None
}

/// Whether a place says what something is called, or of which type it is.
fn is_name(place: &str) -> bool {
    element(place).is_none_or(|element| element == place)
        || place.ends_with("/id")
        || place.ends_with("/type")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_is_the_outermost_part_with_a_name_or_number() {
        assert_eq!(element("/questions/1/options/0/label"), Some("/questions/1"));
        assert_eq!(element("/components/faces/clips"), Some("/components/faces"));
        assert_eq!(element("/stimuli/methods/box/alpha"), Some("/stimuli/methods/box"));
        assert_eq!(element("/sequence/components/0"), Some("/sequence"));
        assert_eq!(element("/consent/minimumAge"), None);
        assert_eq!(element("/components"), None);
    }
}
