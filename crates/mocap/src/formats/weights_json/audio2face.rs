//! NVIDIA Audio2Face's export of blendshape weights: `exportFps`, `numPoses`, `numFrames`, `facsNames`,
//! `weightMat`.
//!
//! `facsNames` are ARKit's shapes, or FACS in words (`lipCornerPullerL`), as the solver was set up.

use serde::Deserialize;

use super::{holds, opening, parse, whole};
use crate::formats::format::{Format, Read, Recognise};
use crate::formats::source::Source;
use crate::formats::weight_rows::{Place, WeightRow, WeightRows};
use crate::{ReadError, WeightOptions, WeightsTable};

const REMEDY: &str = "export the weights again from Audio2Face";

pub(in crate::formats) static FORMAT: Format = Format {
    id: "audio2face-json",
    name: "Audio2Face JSON (weights)",
    extensions: &["json"],
    recognised_by: "`exportFps`, `facsNames`",
    reads: "`weightMat` under `facsNames` at `exportFps`",
    recognise: Recognise::Beginning(|bytes| {
        let bytes = opening(bytes);
        bytes.starts_with(b"{")
            && holds(bytes, &["\"exportFps\"", "\"facsNames\"", "\"weightMat\""])
    }),
    read: Read::BinaryWeights(|file, _, options| read(file, options)),
    write: None,
};

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Document {
    export_fps: f64,
    num_poses: Option<usize>,
    num_frames: Option<usize>,
    facs_names: Vec<String>,
    weight_mat: Vec<Vec<f64>>,
}

fn read(file: &mut dyn Source, options: &WeightOptions<'_>) -> Result<WeightsTable, ReadError> {
    let document: Document = parse(&whole(file)?, REMEDY)?;
    let counts = [
        ("numPoses", document.num_poses, document.facs_names.len(), "facsNames"),
        ("numFrames", document.num_frames, document.weight_mat.len(), "weightMat"),
    ];
    for (key, said, found, of) in counts {
        if let Some(said) = said.filter(|said| *said != found) {
            let what = format!("{said}, {of} has {found}");
            return Err(ReadError::in_json(key, what, REMEDY));
        }
    }
    let rate_hz = document.export_fps;
    if !(rate_hz > 0.0 && rate_hz.is_finite()) {
        let what = format!("{rate_hz} frames per second");
        return Err(ReadError::in_json("exportFps", what, REMEDY));
    }
    let mut rows = WeightRows::new(document.facs_names, Place::Item(0))?;
    for (item, weights) in document.weight_mat.iter().enumerate() {
        let place = Place::Item(item);
        rows.push(WeightRow { place, number: None, time_s: None, weights: Some(weights) })?;
    }
    rows.finish(&WeightOptions { rate_hz: Some(rate_hz), ..*options })
}

#[cfg(test)]
mod tests {
    use crate::{WeightOptions, read_weights, recognise};

    #[test]
    fn the_matrix_is_read_under_its_names_at_its_rate() {
        let text = r#"{"exportFps": 60, "trackPath": "a.wav", "numPoses": 2, "numFrames": 3,
            "facsNames": ["jawOpen", "mouthClose"], "weightMat": [[0, 0.5], [0.25, 0.5], [1, 0]]}"#;
        assert_eq!(recognise(text.as_bytes()).map(|f| f.id), Some("audio2face-json"));
        let table = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap();
        assert_eq!(table.shape_names, ["jawOpen", "mouthClose"]);
        assert_eq!(table.weights, [0.0, 0.5, 0.25, 0.5, 1.0, 0.0]);
        assert_eq!(table.rate_hz(), Some(60.0));
        for (what, by, said) in [
            ("[1, 0]", "[1]", "frame 2, weights: 1 weights of 2 shapes; "),
            (
                "[1, 0]",
                "[1, \"a\"]",
                "line 2, column 96: invalid type: string \"a\", expected f64; ",
            ),
            ("\"numFrames\": 3", "\"numFrames\": 4", "numFrames: 4, weightMat has 3; "),
            ("60", "0", "exportFps: 0 frames per second; "),
        ] {
            let text = text.replace(what, by);
            let error = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap_err();
            assert!(error.to_string().starts_with(said), "{error}");
        }
    }
}
