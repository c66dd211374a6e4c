//! Expressions of a take as the `segments` of a study file.

use std::collections::BTreeSet;

use mimique_study::{FactorValue, Factors, Segment};

use super::TakeSegment;

/// The segments of a study file that cut `capture` into these clips: frames with lead-in and
/// lead-out, the label as factor `expression`, and as identifier what a clip's identifier can hold
/// of it: `joy`, `joy-2`...
pub fn study_segments(segments: &[TakeSegment], capture: &str) -> Vec<Segment> {
    let mut taken = BTreeSet::new();
    let segments = segments.iter().map(|segment| {
        let base = identifier(&segment.label);
        let mut id = base.clone();
        for copy in 2.. {
            if taken.insert(id.clone()) {
                break;
            }
            id = format!("{base}-{copy}");
        }
        let expression = FactorValue::Text(segment.label.clone());
        Segment {
            id,
            capture: capture.to_owned(),
            first: Some(segment.clip.start),
            end: Some(segment.clip.end),
            performance: None,
            sound: None,
            factors: Factors::from([("expression".to_owned(), expression)]),
        }
    });
    segments.collect()
}

/// What an identifier of a study file can hold of a label: letters, digits, `_` and `-`; accents go, anything else
/// becomes one `-`.
pub fn identifier(label: &str) -> String {
    let mut id = String::with_capacity(label.len());
    for c in label.chars() {
        match plain(c) {
            Some(letters) => id.push_str(letters),
            None if c.is_ascii_alphanumeric() || c == '_' => id.push(c),
            None if !id.is_empty() && !id.ends_with('-') => id.push('-'),
            None => {}
        }
    }
    id.truncate(id.trim_end_matches('-').len());
    if id.is_empty() { "segment".to_owned() } else { id }
}

/// The letters without accent of a letter of Western Europe.
fn plain(c: char) -> Option<&'static str> {
    Some(match c {
        'à' | 'á' | 'â' | 'ã' | 'å' => "a",
        'ä' | 'æ' => "ae",
        'ç' => "c",
        'è' | 'é' | 'ê' | 'ë' => "e",
        'ì' | 'í' | 'î' | 'ï' => "i",
        'ñ' => "n",
        'ò' | 'ó' | 'ô' | 'õ' => "o",
        'ö' | 'ø' | 'œ' => "oe",
        'ß' => "ss",
        'ù' | 'ú' | 'û' => "u",
        'ü' => "ue",
        'ý' | 'ÿ' => "y",
        'À' | 'Á' | 'Â' | 'Ã' | 'Å' => "A",
        'Ä' | 'Æ' => "Ae",
        'Ç' => "C",
        'È' | 'É' | 'Ê' | 'Ë' => "E",
        'Ì' | 'Í' | 'Î' | 'Ï' => "I",
        'Ñ' => "N",
        'Ò' | 'Ó' | 'Ô' | 'Õ' => "O",
        'Ö' | 'Ø' | 'Œ' => "Oe",
        'Ù' | 'Ú' | 'Û' => "U",
        'Ü' => "Ue",
        'Ý' => "Y",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_unique_and_plain() {
        let labels = ["joy", "joy", "joy-2", "dégoût (fort)", " ", "喜び", "joy"];
        let takes: Vec<TakeSegment> = (0..)
            .zip(labels)
            .map(|(i, label)| TakeSegment::new(label, 10 * i..10 * i + 8))
            .collect();
        let segments = study_segments(&takes, "take");
        let ids: Vec<&str> = segments.iter().map(|s| s.id.as_str()).collect();
        let want = ["joy", "joy-2", "joy-2-2", "degout-fort", "segment", "segment-2", "joy-3"];
        assert_eq!(ids, want);
        assert_eq!(
            serde_json::to_string(&segments[3]).unwrap(),
            "{\"id\":\"degout-fort\",\"capture\":\"take\",\"first\":30,\"end\":38,\
             \"factors\":{\"expression\":\"dégoût (fort)\"}}"
        );
    }
}
