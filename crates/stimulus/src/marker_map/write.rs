//! The JSON form, written: what [`super::MarkerMap::from_text`] reads back as it was.

use serde_json::{Map, Value, json};

use super::{Depth, MapOrigin, MarkerAssociation, MarkerMap, MarkerPlace};

impl MarkerMap {
    /// The map as JSON, metres, markers in their order.
    pub fn to_json(&self) -> String {
        self.to_json_with(&[])
    }

    /// The same with more members, which readers of maps pass over.
    pub fn to_json_with(&self, more: &[(&str, Value)]) -> String {
        let mut lines = Vec::new();
        let mut put = |key: &str, value: Value| lines.push(format!("  {key:?}: {value}"));
        if let Some(avatar) = &self.avatar {
            put("avatar", json!(avatar));
        }
        put("unit", json!("m"));
        if !self.head.is_empty() {
            put("head", json!(self.head));
        }
        if let Some(neutral) = &self.neutral {
            put("neutral", json!([neutral.start, neutral.end]));
        }
        match self.association {
            MarkerAssociation::Vertex => {}
            MarkerAssociation::Nearest => put("association", json!("nearest")),
            MarkerAssociation::Triangle => put("association", json!("triangle")),
        }
        if self.depth == Depth::Surface {
            put("depth", json!("surface"));
        }
        let mut scale = Map::new();
        if let Some(frames) = &self.scale.automatic {
            scale.insert("automatic".to_owned(), json!([frames.start, frames.end]));
        }
        if let Some(global) = self.scale.global {
            scale.insert("global".to_owned(), json!(global));
        }
        if !scale.is_empty() {
            put("scale", Value::Object(scale));
        }
        if self.origin == MapOrigin::Suggested {
            put("suggested", json!(true));
        }
        if !self.lids.is_empty() {
            put("lids", json!(self.lids));
        }
        let markers: Vec<String> = (self.face.iter())
            .map(|marker| {
                let mut value = match marker.place {
                    MarkerPlace::Position(p) => json!({ "position": p }),
                    MarkerPlace::Vertex(v) => json!({ "vertex": v }),
                };
                if let Some(factors) = self.scale.markers.get(&marker.label) {
                    value["scale"] = json!(factors);
                }
                format!("    {}: {value}", json!(marker.label))
            })
            .collect();
        lines.push(format!("  \"markers\": {{\n{}\n  }}", markers.join(",\n")));
        lines.extend(more.iter().map(|(key, value)| format!("  {key:?}: {value}")));
        format!("{{\n{}\n}}\n", lines.join(",\n"))
    }
}

#[cfg(test)]
mod tests {
    use crate::MarkerMap;

    #[test]
    fn what_is_written_is_read_back() {
        for text in [
            r#"{"markers": {"A": {"vertex": 1}}}"#,
            r#"{"markers": {"A": {"vertex": 1}}, "suggested": true}"#,
            r#"{"avatar": "Ada \"x\"", "unit": "mm", "head": ["Z", "H"], "neutral": [5, 65],
                "markers": {"Z": {"position": [1, 2.5, 3], "scale": 1.5}, "A\u00e9": {"vertex": 7}},
                "association": "triangle", "depth": "surface",
                "scale": {"automatic": [0, 600], "global": [1, 1.2, 0.8]},
                "lids": [{"marker": "Z", "edge": "upper", "closed": "eyeBlinkLeft"}]}"#,
        ] {
            let map = MarkerMap::from_text(text).unwrap();
            let again = MarkerMap::from_text(&map.to_json()).unwrap();
            assert_eq!(again, map, "{}", map.to_json());
        }
    }
}
