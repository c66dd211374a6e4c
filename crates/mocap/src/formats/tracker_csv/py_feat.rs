//! Py-Feat's CSV (`Fex.to_csv`): `FaceRectX, ...`, landmarks, pose, `AU01` to `AU43` from 0 to 1, emotions,
//! `frame`.
//!
//! A video's rows have a number and no exact time (`approx_time` is in whole seconds), so the rate has to be
//! said, unless a column `time` in seconds has been added. Frames without a face have blank cells. Format:
//! Cheong, Jolly, Xie, Byrne, Kenney, Chang, *Py-Feat: Python Facial Expression Analysis Toolbox*, 2023.

use std::borrow::Cow;

use super::{Columns, header_fields, position, time_column};
use crate::formats::format::{Format, Read, Recognise};

pub(in crate::formats) static FORMAT: Format = Format {
    id: "py-feat-csv",
    name: "Py-Feat CSV (weights)",
    extensions: &["csv"],
    recognised_by: "`AU01` or another unit, and `FaceRectX` or `FaceScore`",
    reads: "action units from 0 to 1, at the rate that is asked for or by a column `time` in seconds; emotions, pose and landmarks are left out; frames without a face are filled and listed",
    recognise: Recognise::FirstLine(is_header),
    read: Read::TextWeights(|lines, options| super::read(lines, options, columns, |_| Vec::new())),
    write: None,
};

/// Whether a column is an action unit: `AU01`.
fn is_unit(name: &str) -> bool {
    name.strip_prefix("AU")
        .is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}

fn is_header(line: &str) -> bool {
    let fields = header_fields(line);
    let has = |name| position(&fields, name).is_some();
    (has("FaceRectX") || has("FaceScore")) && fields.iter().any(|name| is_unit(name))
}

fn columns(fields: &[Cow<'_, str>]) -> Columns {
    let units = fields.iter().enumerate().filter(|(_, name)| is_unit(name));
    Columns {
        frame: position(fields, "frame"),
        time: time_column(fields, &[("time", 1.0), ("time_s", 1.0)]),
        face: None,
        found: None,
        weights: units.map(|(k, name)| (k, name.to_string())).collect(),
        whole: 1.0,
        may_be_blank: true,
    }
}

#[cfg(test)]
mod tests {
    use crate::{WeightOptions, read_weights, recognise};

    #[test]
    fn units_by_frame_numbers_at_the_rate_that_is_said() {
        let text = ",FaceRectX,FaceScore,x_0,Pitch,AU01,AU12,anger,input,frame\n\
                    0,1,0.9,4,0,0.5,0.25,0,a.mp4,0\n1,,,,,,,,a.mp4,10\n2,1,0.9,4,0,0.7,0.75,0,a.mp4,20\n";
        assert_eq!(recognise(text.as_bytes()).map(|f| f.id), Some("py-feat-csv"));
        let options = WeightOptions { rate_hz: Some(3.0), ..WeightOptions::default() };
        let table = read_weights(text.as_bytes(), &options).unwrap();
        assert_eq!(table.shape_names, ["AU01", "AU12"]);
        assert_eq!((table.rate_hz(), table.row(1)), (Some(3.0), &[0.6, 0.5][..]));
        assert_eq!(table.filled, [(1, 2)]);
        let error = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap_err();
        assert!(error.to_string().starts_with("line 2, frame: no rate"), "{error}");
        // A second face has the same frame's number.
        let error = read_weights(text.replace(",10\n", ",0\n").as_bytes(), &options).unwrap_err();
        assert!(error.to_string().starts_with("line 3, frame: frame 0 after 0"), "{error}");
    }
}
