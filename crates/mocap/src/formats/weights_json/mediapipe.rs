//! Results of MediaPipe's Face Landmarker as JSON: a list of them, or one a line, or under `frames`.
//!
//! A result has `faceBlendshapes[].categories[]{categoryName, score}` (JavaScript) or `face_blendshapes[][]
//! {category_name, score}` (Python). Its time, where a script has added one, is `timestampMs`, `timestamp_ms`
//! or `timestamp` in milliseconds, as MediaPipe's own, or `time` in seconds. Landmarks are passed over. A
//! result without a face is filled.

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use super::{NamedFrame, damaged, holds, of_named_frames, opening, parse, whole};
use crate::formats::format::{Format, Read, Recognise};
use crate::formats::source::Source;
use crate::formats::tracker_csv::mediapipe::{NEUTRAL, notes};
use crate::{ReadError, WeightOptions, WeightsTable};

const REMEDY: &str = "write a list of the Face Landmarker's results with faceBlendshapes (outputFaceBlendshapes: true)";

pub(in crate::formats) static FORMAT: Format = Format {
    id: "mediapipe-json",
    name: "MediaPipe JSON (weights)",
    extensions: &["json", "jsonl"],
    recognised_by: "`faceBlendshapes`, `faceLandmarks` or `categoryName`",
    reads: "blendshape scores of one face, by `timestampMs` or `time`, else at the rate that is asked for; `_neutral` is left out; frames without a face are filled and listed",
    recognise: Recognise::Beginning(|bytes| {
        let bytes = opening(bytes);
        let words = [
            "\"faceBlendshapes\"",
            "\"face_blendshapes\"",
            "\"faceLandmarks\"",
            "\"face_landmarks\"",
            "\"categoryName\"",
            "\"category_name\"",
        ];
        (bytes.starts_with(b"{") || bytes.starts_with(b"[")) && holds(bytes, &words)
    }),
    read: Read::BinaryWeights(|file, _, options| read(file, options)),
    write: None,
};

/// A result, or a document that holds results.
#[derive(Deserialize)]
struct Item {
    #[serde(alias = "results")]
    frames: Option<Vec<Item>>,
    #[serde(rename = "faceBlendshapes", alias = "face_blendshapes")]
    faces: Option<Vec<Face>>,
    time: Option<f64>,
    #[serde(alias = "timestampMs", alias = "timestamp_ms")]
    timestamp: Option<f64>,
}

#[derive(Deserialize)]
struct Category {
    #[serde(rename = "categoryName", alias = "category_name")]
    name: String,
    score: f64,
}

#[derive(Deserialize)]
struct Categories {
    categories: Vec<Category>,
}

/// The scores of a face, in an object or bare.
struct Face(Vec<Category>);

impl<'de> Deserialize<'de> for Face {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Face;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("the categories of a face")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Face, A::Error> {
                Ok(Face(Categories::deserialize(MapAccessDeserializer::new(map))?.categories))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Face, A::Error> {
                Ok(Face(Vec::deserialize(SeqAccessDeserializer::new(list))?))
            }
        }
        deserializer.deserialize_any(Either)
    }
}

fn read(file: &mut dyn Source, options: &WeightOptions<'_>) -> Result<WeightsTable, ReadError> {
    let bytes = whole(file)?;
    let items: Vec<Item> = if opening(&bytes).starts_with(b"[") {
        parse(&bytes, REMEDY)?
    } else {
        let stream = serde_json::Deserializer::from_slice(&bytes).into_iter();
        let mut items: Vec<Item> =
            stream.collect::<Result<_, _>>().map_err(|e| damaged(&e, REMEDY))?;
        match &mut items[..] {
            [Item { frames: Some(frames), .. }] => std::mem::take(frames),
            _ => items,
        }
    };
    let frames = items.into_iter().enumerate().map(|(k, item)| frame(k, item));
    of_named_frames(frames.collect::<Result<_, _>>()?, notes, options)
}

/// The weights of a result.
fn frame(number: usize, item: Item) -> Result<NamedFrame, ReadError> {
    let time_s = item.time.or_else(|| item.timestamp.map(|ms| ms / 1e3));
    let mut faces = item.faces.unwrap_or_default();
    if faces.len() > 1 {
        let (at, what) =
            (format!("frame {number}, faceBlendshapes"), format!("{} faces", faces.len()));
        return Err(ReadError::in_json(at, what, "keep one face (numFaces: 1)"));
    }
    let scores = |face: Face| {
        let shapes = face.0.into_iter().filter(|category| category.name != NEUTRAL);
        shapes.map(|category| (category.name, category.score)).collect()
    };
    Ok(NamedFrame { time_s, weights: faces.pop().map(scores) })
}

#[cfg(test)]
mod tests {
    use crate::{WeightOptions, read_weights, recognise};

    fn result(time: u32, jaw: f64) -> String {
        format!(
            r#"{{"timestampMs": {time}, "faceLandmarks": [[{{"x": 0.5, "y": 0.5, "z": 0}}]], "faceBlendshapes": [{{"headIndex": -1, "categories": [
            {{"index": 0, "score": 0.5, "categoryName": "_neutral", "displayName": ""}},
            {{"index": 1, "score": {jaw}, "categoryName": "jawOpen", "displayName": ""}},
            {{"index": 2, "score": 0, "categoryName": "noseSneerLeft", "displayName": ""}}]}}]}}"#
        )
    }

    #[test]
    fn lists_lines_and_documents_of_results_are_the_same() {
        let [a, b, c] = [(0, 0.0), (40, 0.5), (120, 1.0)].map(|(t, jaw)| result(t, jaw));
        let lost = r#"{"timestampMs": 80, "faceLandmarks": [], "faceBlendshapes": []}"#;
        let python = [&a, &b, lost, &c].map(|text| {
            text.replace("categoryName", "category_name")
                .replace(r#"{"headIndex": -1, "categories": ["#, "[")
                .replace("]}]}", "]]}")
                .replace("faceBlendshapes", "face_blendshapes")
                .replace("faceLandmarks", "face_landmarks")
        });
        for text in [
            format!("[{a},{b},{lost},{c}]"),
            format!("{a}\n{b}\n{lost}\n{c}\n"),
            format!("{{\"frames\": [{a},{b},{lost},{c}]}}"),
            format!("[{}]", python.join(",")),
        ] {
            assert_eq!(recognise(text.as_bytes()).map(|f| f.id), Some("mediapipe-json"), "{text}");
            let table = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap();
            assert_eq!(table.shape_names, ["jawOpen", "noseSneerLeft"]);
            assert_eq!((table.rate_hz(), &table.filled[..]), (Some(25.0), &[(2, 3)][..]));
            let jaw: Vec<f64> = table.weights.iter().step_by(2).copied().collect();
            assert_eq!(jaw, [0.0, 0.5, 0.75, 1.0]);
            assert!(table.notes[0].contains("noseSneerLeft"), "{:?}", table.notes);
        }
        let text = format!("[{a},{}]", b.replace("jawOpen", "jawLeft"));
        let error = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap_err();
        assert!(error.to_string().starts_with("frame 1, weights: no weight of \"jawOpen\"; "));
    }
}
