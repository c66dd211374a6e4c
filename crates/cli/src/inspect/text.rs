//! Facts as text, for people.

use serde_json::{Value, json};

/// Of a capture's markers the labels on one line, and a line only for those with gaps.
pub(super) fn shorten_presence(facts: &mut Value) {
    let Some(presence) = facts.get_mut("presence").and_then(Value::as_array_mut) else { return };
    let labels: Vec<&str> = presence.iter().filter_map(|m| m["label"].as_str()).collect();
    let labels = labels.join(", ");
    presence.retain(|m| m["gaps"] != 0);
    facts["labels"] = json!(labels);
}

/// Facts as indented text: what is empty or unknown is left out.
pub(super) fn tell(value: &Value, depth: usize, out: &mut String) {
    let Value::Object(map) = value else { return };
    let pad = "  ".repeat(depth);
    // What it is and is called first, what is amiss last; the rest in alphabetical order.
    let rank = |key: &str| match key {
        "file" => 0,
        "kind" => 1,
        "name" | "label" => 2,
        "notes" => 4,
        "warnings" => 5,
        _ => 3,
    };
    let mut entries: Vec<_> = map.iter().collect();
    entries.sort_by_key(|(key, _)| rank(key));
    for (key, value) in entries {
        let label = key.replace('_', " ");
        match value {
            Value::Null => {}
            Value::String(text) if text.is_empty() => {}
            Value::String(text) => out.push_str(&format!("{pad}{label}: {text}\n")),
            Value::Array(items) if items.is_empty() => {}
            Value::Array(items) if items.iter().all(Value::is_object) => {
                out.push_str(&format!("{pad}{label}:\n"));
                for item in items {
                    out.push_str(&format!("{pad}  {}\n", line(item)));
                }
            }
            Value::Array(items) if items.iter().all(Value::is_string) => {
                out.push_str(&format!("{pad}{label}:\n"));
                for item in items {
                    out.push_str(&format!("{pad}  {}\n", scalar(item)));
                }
            }
            Value::Object(_) => {
                out.push_str(&format!("{pad}{label}:\n"));
                tell(value, depth + 1, out);
            }
            other => out.push_str(&format!("{pad}{label}: {}\n", scalar(other))),
        }
    }
}

/// An object on one line.
fn line(value: &Value) -> String {
    let Value::Object(map) = value else { return scalar(value) };
    let name = map.get("name").or_else(|| map.get("label"));
    let rest = map.iter().filter(|(key, value)| {
        !matches!(key.as_str(), "name" | "label") && !matches!(value, Value::Null)
    });
    let rest: Vec<String> =
        rest.map(|(key, value)| format!("{} {}", key.replace('_', " "), scalar(value))).collect();
    match name {
        Some(name) => format!("{}: {}", scalar(name), rest.join(", ")),
        None => rest.join(", "),
    }
}

fn scalar(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(items) => items.iter().map(scalar).collect::<Vec<_>>().join(" "),
        Value::Number(number) => match number.as_f64() {
            // Single-precision numbers and long fractions are for --json.
            Some(x) if number.is_f64() && x != 0.0 && x.abs() < 1e6 => {
                let digits = (6 - x.abs().log10().ceil() as i32).clamp(0, 12) as usize;
                let text = format!("{x:.digits$}");
                match text.contains('.') {
                    true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
                    false => text,
                }
            }
            _ => number.to_string(),
        },
        other => other.to_string(),
    }
}
