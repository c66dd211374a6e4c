//! A study as text that people read and change: JSON with comments, keys in the order of a study file.

use serde_json::{Map, Value};

/// Keys in the order in which people read them; all others come after, by the alphabet.
const ORDER: [&str; 66] = [
    "$schema",
    "id",
    "studyMetadata",
    "title",
    "version",
    "languages",
    "seed",
    "contact",
    "investigator",
    "ethicsBoard",
    "name",
    "email",
    "recruitment",
    "consent",
    "device",
    "screening",
    "attentionChecks",
    "heading",
    "text",
    "demographics",
    "instructions",
    "calibration",
    "training",
    "type",
    "prompt",
    "help",
    "truth",
    "numItems",
    "start",
    "minimum",
    "maximum",
    "step",
    "leftLabel",
    "rightLabel",
    "bottomLabel",
    "topLabel",
    "value",
    "label",
    "image",
    "minimumAge",
    "retention",
    "sections",
    "questions",
    "options",
    "components",
    "sequence",
    "instruction",
    "order",
    "constraints",
    "debriefing",
    "stimuli",
    "avatars",
    "captures",
    "file",
    "markers",
    "head",
    "neutral",
    "segments",
    "methods",
    "method",
    "clips",
    "look",
    "statement",
    "scales",
    "hypotheses",
    "exclusions",
];
/// An object or a list is on one line where it fits into so many letters.
const LINE: usize = 110;

/// The text of a study; `comments` by JSON pointers, that of the empty one above everything.
pub(crate) fn written(study: &Value, comments: &Map<String, Value>) -> String {
    let mut out = String::new();
    comment("", "", comments, &mut out);
    write(study, "", 0, comments, &mut out);
    out.push('\n');
    out
}

fn write(
    value: &Value,
    pointer: &str,
    depth: usize,
    comments: &Map<String, Value>,
    out: &mut String,
) {
    let short = value.to_string();
    let has_comments = comments.keys().any(|place| place.starts_with(&format!("{pointer}/")));
    if depth > 0 && !has_comments && short.chars().count() + 2 * depth < LINE {
        out.push_str(&spaced(value));
        return;
    }
    let indent = "  ".repeat(depth + 1);
    match value {
        Value::Object(map) => {
            out.push_str("{\n");
            for key in in_order(map) {
                let below = format!("{pointer}/{}", key.replace('~', "~0").replace('/', "~1"));
                comment(&below, &indent, comments, out);
                out.push_str(&format!("{indent}{}: ", Value::from(key.as_str())));
                write(&map[key], &below, depth + 1, comments, out);
                out.push_str(",\n");
            }
            out.push_str(&format!("{}}}", "  ".repeat(depth)));
        }
        Value::Array(items) => {
            out.push_str("[\n");
            for (index, item) in items.iter().enumerate() {
                let below = format!("{pointer}/{index}");
                comment(&below, &indent, comments, out);
                out.push_str(&indent);
                write(item, &below, depth + 1, comments, out);
                out.push_str(",\n");
            }
            out.push_str(&format!("{}]", "  ".repeat(depth)));
        }
        other => out.push_str(&other.to_string()),
    }
}

fn comment(pointer: &str, indent: &str, comments: &Map<String, Value>, out: &mut String) {
    let Some(text) = comments.get(pointer).and_then(Value::as_str) else { return };
    let mut line = format!("{indent}//");
    for word in text.split(' ') {
        if line.chars().count() + word.chars().count() > LINE {
            out.push_str(&line);
            out.push('\n');
            line = format!("{indent}//");
        }
        line.push(' ');
        line.push_str(word);
    }
    out.push_str(&line);
    out.push('\n');
}

/// A value on one line.
fn spaced(value: &Value) -> String {
    match value {
        Value::Object(map) if !map.is_empty() => {
            let entries: Vec<String> = in_order(map)
                .map(|key| format!("{}: {}", Value::from(key.as_str()), spaced(&map[key])))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(spaced).collect();
            format!("[{}]", items.join(", "))
        }
        other => other.to_string(),
    }
}

fn in_order(map: &Map<String, Value>) -> impl Iterator<Item = &String> {
    let mut keys: Vec<&String> = map.keys().collect();
    let rank = |key: &str| ORDER.iter().position(|own| *own == key).unwrap_or(ORDER.len());
    keys.sort_by_key(|key| (rank(key), key.as_str().to_owned()));
    keys.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_study_is_read_back_as_it_was_with_comments_above_its_parts() {
        let long = "words ".repeat(40);
        let study = json!({
            "languages": ["en"], "id": "x", "components": { "b/c": { "text": long }, "a": [] },
        });
        let comments =
            json!({ "": "Above all.", "/components/b~1c": long, "/id": "What it is called." });
        let text = written(&study, comments.as_object().unwrap());
        assert_eq!(mimique_study::parse(&text).unwrap(), study);
        assert!(text.starts_with(
            "// Above all.\n{\n  // What it is called.\n  \"id\": \"x\",\n  \"languages\""
        ));
        assert!(
            text.lines().filter(|line| line.contains("//")).all(|line| line.len() <= LINE),
            "{text}"
        );
    }
}
