//! ARKit's blendshapes as JSON, in two layouts.
//!
//! - `{"names": [...], "frames": [{"weights": [...], "time": 0.0, "rotation": [...]}, ...]}`: what the phone
//!   of the BEAT corpus recorded (Liu et al., ECCV 2022) and LAM Audio2Expression writes; `metadata.fps`
//!   where frames have no time. This one is written.
//! - frames that name their weights, `{"timestamp": 12.5, "blendShapes": {"jawOpen": 0.1, ...}}`: what
//!   applications save of `ARFaceAnchor.blendShapes`, in a list or under `frames`.
//!
//! Times are in seconds, as ARKit's are; `timestampMs` in milliseconds.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};

use super::{NamedFrame, holds, of_named_frames, opening, parse, whole};
use crate::formats::format::{Format, Read, Recognise, Write};
use crate::formats::source::Source;
use crate::formats::weight_rows::{Place, WeightRow, WeightRows};
use crate::{ReadError, WeightOptions, WeightsTable};

const REMEDY: &str =
    "write {\"names\": [...], \"frames\": [{\"weights\": [...], \"time\": 0.0}, ...]}";

/// ARKit's 52 blendshapes in the order in which phones write them.
#[rustfmt::skip]
pub(crate) const ARKIT: [&str; 52] = [
    "eyeBlinkLeft", "eyeLookDownLeft", "eyeLookInLeft", "eyeLookOutLeft", "eyeLookUpLeft",
    "eyeSquintLeft", "eyeWideLeft", "eyeBlinkRight", "eyeLookDownRight", "eyeLookInRight",
    "eyeLookOutRight", "eyeLookUpRight", "eyeSquintRight", "eyeWideRight", "jawForward", "jawRight",
    "jawLeft", "jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthRight", "mouthLeft",
    "mouthSmileLeft", "mouthSmileRight", "mouthFrownLeft", "mouthFrownRight", "mouthDimpleLeft",
    "mouthDimpleRight", "mouthStretchLeft", "mouthStretchRight", "mouthRollLower", "mouthRollUpper",
    "mouthShrugLower", "mouthShrugUpper", "mouthPressLeft", "mouthPressRight", "mouthLowerDownLeft",
    "mouthLowerDownRight", "mouthUpperUpLeft", "mouthUpperUpRight", "browDownLeft", "browDownRight",
    "browInnerUp", "browOuterUpLeft", "browOuterUpRight", "cheekPuff", "cheekSquintLeft",
    "cheekSquintRight", "noseSneerLeft", "noseSneerRight", "tongueOut",
];

pub(in crate::formats) static FORMAT: Format = Format {
    id: "arkit-json",
    name: "ARKit JSON (weights)",
    extensions: &["json"],
    recognised_by: "`{\"names\"`, `blendShapes`, or `frames` of `weights`",
    reads: "`names` and `frames` of `weights` and `time` (BEAT, LAM), or frames with `blendShapes` by name (applications of ARKit)",
    recognise: Recognise::Beginning(is_document),
    read: Read::BinaryWeights(|file, _, options| read(file, options)),
    write: Some(Write::Weights { columns: Some(&ARKIT), write }),
};

fn is_document(bytes: &[u8]) -> bool {
    let bytes = opening(bytes);
    let named = bytes.strip_prefix(b"{").map(<[u8]>::trim_ascii_start);
    named.is_some_and(|rest| rest.starts_with(b"\"names\""))
        || (bytes.starts_with(b"{") || bytes.starts_with(b"["))
            && (holds(bytes, &["\"blendShapes\"", "\"blendshapes\""])
                || holds(bytes, &["\"frames\""]) && holds(bytes, &["\"weights\""]))
}

#[derive(Deserialize)]
struct Document {
    names: Option<Vec<String>>,
    frames: Vec<Frame>,
    fps: Option<f64>,
    #[serde(default)]
    metadata: Metadata,
}

#[derive(Deserialize, Default)]
struct Metadata {
    fps: Option<f64>,
}

#[derive(Deserialize)]
struct Frame {
    weights: Option<Vec<f64>>,
    #[serde(rename = "blendShapes", alias = "blendshapes")]
    blend_shapes: Option<Pairs>,
    #[serde(alias = "timestamp")]
    time: Option<f64>,
    #[serde(rename = "timestampMs", alias = "timestamp_ms")]
    timestamp_ms: Option<f64>,
}

impl Frame {
    fn time_s(&self) -> Option<f64> {
        self.time.or_else(|| self.timestamp_ms.map(|ms| ms / 1e3))
    }
}

/// An object of numbers, with the names that come twice.
struct Pairs(Vec<(String, f64)>);

impl<'de> Deserialize<'de> for Pairs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Collects;
        impl<'de> Visitor<'de> for Collects {
            type Value = Pairs;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object of shapes and weights")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Pairs, A::Error> {
                let mut pairs = Vec::new();
                while let Some(pair) = map.next_entry()? {
                    pairs.push(pair);
                }
                Ok(Pairs(pairs))
            }
        }
        deserializer.deserialize_map(Collects)
    }
}

fn read(file: &mut dyn Source, options: &WeightOptions<'_>) -> Result<WeightsTable, ReadError> {
    let bytes = whole(file)?;
    let document = if opening(&bytes).starts_with(b"[") {
        let frames = parse(&bytes, REMEDY)?;
        Document { names: None, frames, fps: None, metadata: Metadata::default() }
    } else {
        parse(&bytes, REMEDY)?
    };
    let said = document.fps.or(document.metadata.fps);
    let options = WeightOptions { rate_hz: options.rate_hz.or(said), ..*options };
    let Some(names) = document.names else {
        let named = |frame: Frame| NamedFrame {
            time_s: frame.time_s(),
            weights: frame.blend_shapes.map(|pairs| pairs.0),
        };
        let frames = document.frames.into_iter().map(named).collect();
        return of_named_frames(frames, |_| Vec::new(), &options);
    };
    if document.frames.is_empty() {
        return Err(ReadError::in_json("frames", "no frame", REMEDY));
    }
    let mut rows = WeightRows::new(names, Place::Item(0))?;
    for (item, frame) in document.frames.iter().enumerate() {
        let place = Place::Item(item);
        let weights = frame.weights.as_deref();
        if weights.is_none() {
            return Err(place.error("weights", "none", REMEDY));
        }
        rows.push(WeightRow { place, number: None, time_s: frame.time_s(), weights })?;
    }
    rows.finish(&options)
}

/// The document: numbers are the shortest that read back as the same f64.
fn write(table: &WeightsTable, path: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let names = serde_json::to_string(&table.shape_names).unwrap_or_default();
    let fps = table.rate_hz().map_or(String::new(), |rate| format!("\"fps\":{rate},"));
    let mut text = format!(
        "{{\"names\":{names},\n\"metadata\":{{{fps}\"frame_count\":{}}},\n\"frames\":[",
        table.frames.len()
    );
    for (row, time) in table.times.iter().enumerate() {
        let weights: Vec<String> = table.row(row).iter().map(f64::to_string).collect();
        let comma = if row == 0 { "" } else { "," };
        let _ = write!(
            text,
            "{comma}\n{{\"weights\":[{}],\"time\":{time},\"rotation\":[]}}",
            weights.join(",")
        );
    }
    text.push_str("\n]}\n");
    vec![(path.to_owned(), text.into_bytes())]
}

#[cfg(test)]
mod tests {
    use crate::{WeightOptions, WeightsTable, read_weights, recognise, weights_files};
    use std::path::Path;

    #[test]
    fn what_is_written_reads_back_bit_for_bit() {
        let names: Vec<String> = super::ARKIT.map(str::to_owned).to_vec();
        let weights: Vec<f64> = (0..5 * 52).map(|i| (f64::from(i) / 7.0).sin()).collect();
        for rate_hz in [24.0, 60.0, 200.0] {
            let table = WeightsTable::at_rate(names.clone(), weights.clone(), 0, rate_hz);
            let files = weights_files(&table, Path::new("a.json")).unwrap();
            assert_eq!(recognise(&files[0].1).map(|f| f.id), Some("arkit-json"));
            let back = read_weights(&files[0].1, &WeightOptions::default()).unwrap();
            assert_eq!(back, table);
        }
    }

    #[test]
    fn frames_that_name_their_weights() {
        let text = r#"[{"timestamp": 12.5, "blendShapes": {"jawOpen": 0.5, "cheekPuff": 0}},
            {"timestamp": 12.52, "blendShapes": {"cheekPuff": 0.25, "jawOpen": 0.75}},
            {"timestamp": 12.54, "blendShapes": {"jawOpen": 1, "cheekPuff": 0.5}}]"#;
        let table = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap();
        assert_eq!(table.shape_names, ["jawOpen", "cheekPuff"]);
        assert_eq!((table.rate_hz(), table.row(1)), (Some(50.0), &[0.75, 0.25][..]));
        for (what, by, said) in [
            (r#""cheekPuff": 0.25, "#, "", "frame 1, weights: no weight of \"cheekPuff\"; "),
            (
                r#""jawOpen": 1"#,
                r#""cheekPuff": 1"#,
                "frame 2, weights: no weight of \"jawOpen\"; ",
            ),
            ("12.54", "12.5", "frame 2, time: 12.5 s after 12.52 s; "),
        ] {
            let text = text.replace(what, by);
            let error = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap_err();
            assert!(error.to_string().starts_with(said), "{error}");
        }
    }
}
