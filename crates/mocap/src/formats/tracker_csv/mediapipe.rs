//! Blendshape scores of MediaPipe's Face Landmarker as CSV: ARKit's names without `tongueOut`, and `_neutral`.
//!
//! MediaPipe writes no files itself; scripts around it write a column per score, under the names of the
//! categories, beside a time. `timestamp_ms` and `timestampMs` are milliseconds, as are MediaPipe's own
//! timestamps; `time`, `time_s` and `seconds` are seconds. A `timestamp` is in milliseconds where it is
//! written without a fraction.

use std::borrow::Cow;

use super::{Columns, header_fields, position, time_column};
use crate::formats::format::{Format, Read, Recognise};

/// The score of the face at rest, which is no shape.
pub(crate) const NEUTRAL: &str = "_neutral";

/// Shapes that the Face Landmarker hardly ever raises: issues 4436 (cheekPuff) and 4450 (eyeWide,
/// noseSneer: not over 0.05 however the face is drawn) of google-ai-edge/mediapipe.
pub(crate) const WEAK: [&str; 5] =
    ["cheekPuff", "eyeWideLeft", "eyeWideRight", "noseSneerLeft", "noseSneerRight"];

pub(in crate::formats) static FORMAT: Format = Format {
    id: "mediapipe-csv",
    name: "MediaPipe CSV (weights)",
    extensions: &["csv"],
    recognised_by: "columns `_neutral`, or `browDownLeft` and `jawOpen` that do not follow `frame,time`",
    reads: "blendshape scores; `_neutral` is left out; `timestamp_ms` or `time`, else the rate that is asked for; frames without a face are filled and listed",
    recognise: Recognise::FirstLine(is_header),
    read: Read::TextWeights(|lines, options| super::read(lines, options, columns, notes)),
    write: None,
};

fn is_header(line: &str) -> bool {
    let fields = header_fields(line);
    let has = |name| position(&fields, name).is_some();
    has(NEUTRAL)
        || has("browDownLeft") && has("jawOpen") && !line.starts_with("frame,") && !has("timecode")
}

/// Which columns are what: those named like ARKit's shapes are small letters and capitals alone.
fn columns(fields: &[Cow<'_, str>]) -> Columns {
    let time = time_column(
        fields,
        &[
            ("timestamp_ms", 1e-3),
            ("timestampMs", 1e-3),
            ("time_ms", 1e-3),
            ("time_s", 1.0),
            ("time", 1.0),
            ("seconds", 1.0),
            ("timestamp_s", 1.0),
            ("timestamp", 1e-3),
        ],
    );
    let frame = ["frame", "frame_number", "frame_index"];
    let frame = frame.iter().find_map(|name| position(fields, name));
    let is_shape = |name: &str| {
        let features = ["brow", "cheek", "eye", "jaw", "mouth", "nose", "tongue"];
        features.iter().any(|feature| name.starts_with(feature))
            && name.chars().all(|c| c.is_ascii_alphabetic())
    };
    let weights = fields.iter().enumerate().filter(|(_, name)| is_shape(name));
    Columns {
        frame,
        time,
        face: position(fields, "face_id").or_else(|| position(fields, "face")),
        found: None,
        weights: weights.map(|(k, name)| (k, name.to_string())).collect(),
        whole: 1.0,
        may_be_blank: true,
    }
}

/// Says which of the shapes the tracker hardly sees.
pub(crate) fn notes(names: &[String]) -> Vec<String> {
    let weak: Vec<&str> =
        WEAK.into_iter().filter(|weak| names.iter().any(|name| name == weak)).collect();
    if weak.is_empty() {
        return Vec::new();
    }
    vec![format!(
        "MediaPipe hardly ever raises {}, whatever the face does, and knows no tongueOut \
         (google-ai-edge/mediapipe, issues 4436, 4450 and 4403): do not compare stimuli by them",
        weak.join(", ")
    )]
}

#[cfg(test)]
mod tests {
    use crate::{WeightOptions, read_weights, recognise};

    #[test]
    fn scores_at_milliseconds_with_a_frame_lost() {
        let text = "timestamp_ms,_neutral,browDownLeft,jawOpen,cheekPuff\n\
                    0,0.9,0.0,0.25,0\n33,0.9,0.1,0.5,0\n100,0.9,0.3,1.0,0\n133,0.9,0.4,0.5,0\n\
                    167,0.9,0.4,0.5,0\n200,0.9,0.4,0.5,0\n";
        assert_eq!(recognise(text.as_bytes()).map(|f| f.id), Some("mediapipe-csv"));
        let table = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap();
        assert_eq!(table.shape_names, ["browDownLeft", "jawOpen", "cheekPuff"]);
        assert_eq!((table.rate_hz(), table.frames.len()), (Some(30.0), 7));
        assert_eq!(table.filled, [(2, 3)]);
        assert!((table.row(2)[1] - 0.75).abs() < 1e-12);
        assert!(
            table.notes.len() == 1 && table.notes[0].contains("cheekPuff"),
            "{:?}",
            table.notes
        );
    }

    #[test]
    fn a_face_that_is_lost_is_filled_and_uneven_times_are_said() {
        let text = "time,browDownLeft,jawOpen\n0,0,0\n0.04,,\n0.08,0.5,1\n0.12,0.5,1\n";
        let table = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap();
        assert_eq!((table.rate_hz(), table.row(1)), (Some(25.0), &[0.25, 0.5][..]));
        assert_eq!(table.filled, [(1, 2)]);
        assert!(table.notes.is_empty());
        let uneven = "time,browDownLeft,jawOpen\n0,0,0\n0.03,0,0.3\n0.08,0,0.8\n0.1,0,1\n0.15,0,1.5\n0.2,0,2\n";
        let table = read_weights(uneven.as_bytes(), &WeightOptions::default()).unwrap();
        let rate = table.rate_hz().unwrap();
        for (frame, row) in table.weights.chunks(2).enumerate() {
            assert!((row[1] - 10.0 * frame as f64 / rate).abs() < 1e-9, "{frame} {row:?}");
        }
        assert!(table.notes[0].contains("uneven"), "{:?}", table.notes);
    }

    #[test]
    fn errors_name_line_and_column() {
        let message = |text: &str| {
            read_weights(text.as_bytes(), &WeightOptions::default()).unwrap_err().to_string()
        };
        let head = "time,_neutral,browDownLeft,jawOpen\n0,0,0,0\n";
        assert_eq!(
            message(&format!("{head}0.04,0,0,\n")),
            "line 3, column 4 (jawOpen): \"\" is no number; export the take again, or correct the row"
        );
        assert!(message(&format!("{head}0,0,0,0\n")).starts_with("line 3, time: 0 s after 0 s; "));
        assert!(
            message("_neutral,jawOpen\n0,0\n0,1\n").contains("no rate and no times; give the rate")
        );
    }
}
