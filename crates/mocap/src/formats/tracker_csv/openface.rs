//! OpenFace 2's CSV: `frame, face_id, timestamp, confidence, success, ...`, action units from `AU01_r` on.
//!
//! Intensities (`AUnn_r`) go from 0 to 5 and are divided by 5; presences (`AUnn_c`, 0 or 1) are left out,
//! and with them AU 28, which OpenFace only tells to be there or not. Columns are called by their units,
//! `AU01`; the avatars' side knows what these mean. Format: OpenFace wiki, *Output Format*; Baltrušaitis,
//! Zadeh, Lim, Morency, *OpenFace 2.0*, FG 2018. OpenFace 3 writes other units under the same names, in
//! another layout; such files have no `confidence` and are not taken.

use std::borrow::Cow;

use super::{Columns, header_fields, position, time_column};
use crate::formats::format::{Format, Read, Recognise};

/// The highest intensity.
const HIGHEST: f64 = 5.0;

pub(in crate::formats) static FORMAT: Format = Format {
    id: "openface-csv",
    name: "OpenFace 2 CSV (weights)",
    extensions: &["csv"],
    recognised_by: "`confidence` and `success`, or an intensity as `AU01_r`",
    reads: "intensities of action units, 0 to 5, divided by 5; presences, pose and gaze are left out; one face; frames without success are filled and listed",
    recognise: Recognise::FirstLine(is_header),
    read: Read::TextWeights(|lines, options| super::read(lines, options, columns, |_| Vec::new())),
    write: None,
};

/// `AU01` of `AU01_r`.
fn unit(name: &str) -> Option<&str> {
    let unit = name.strip_suffix("_r")?;
    let number = unit.strip_prefix("AU")?;
    (!number.is_empty() && number.bytes().all(|b| b.is_ascii_digit())).then_some(unit)
}

fn is_header(line: &str) -> bool {
    let fields = header_fields(line);
    let has = |name| position(&fields, name).is_some();
    has("confidence") && (has("success") || fields.iter().any(|name| unit(name).is_some()))
}

fn columns(fields: &[Cow<'_, str>]) -> Columns {
    let units = fields.iter().enumerate().filter_map(|(k, name)| Some((k, unit(name)?.to_owned())));
    Columns {
        frame: position(fields, "frame"),
        time: time_column(fields, &[("timestamp", 1.0)]),
        face: position(fields, "face_id"),
        found: position(fields, "success"),
        weights: units.collect(),
        whole: HIGHEST,
        may_be_blank: false,
    }
}

#[cfg(test)]
mod tests {
    use crate::{WeightOptions, read_weights, recognise};

    const HEAD: &str = "frame, face_id, timestamp, confidence, success, x_0, AU01_r, AU12_r, AU45_r, AU01_c, AU28_c\n";

    #[test]
    fn intensities_are_fifths_and_failures_are_filled() {
        let text = format!(
            "{HEAD}1, 0, 0.000, 0.98, 1, 3, 0.00, 5.00, 0.10, 0.00, 1.00\n\
             2, 0, 0.033, 0.20, 0, 3, 9.00, 9.00, 9.00, 0.00, 0.00\n\
             3, 0, 0.067, 0.98, 1, 3, 1.00, 2.50, 0.30, 1.00, 0.00\n\
             4, 0, 0.100, 0.98, 1, 3, 1.00, 2.50, 0.30, 1.00, 0.00\n"
        );
        assert_eq!(recognise(text.as_bytes()).map(|f| f.id), Some("openface-csv"));
        let table = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap();
        assert_eq!(table.shape_names, ["AU01", "AU12", "AU45"]);
        assert_eq!((table.rate_hz(), &table.frames[..]), (Some(30.0), &[1, 2, 3, 4][..]));
        assert_eq!(table.row(0), [0.0, 1.0, 0.02]);
        assert_eq!(table.row(1)[..2], [0.1, 0.75]);
        assert_eq!(table.filled, [(1, 2)]);
    }

    #[test]
    fn a_second_face_is_refused() {
        let text = format!("{HEAD}1,0,0,1,1,3,0,0,0,0,0\n1,1,0,1,1,3,0,0,0,0,0\n");
        let error = read_weights(text.as_bytes(), &WeightOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 3, column 2 (face_id): face 1 after face 0; \
             keep the rows of one face, and remove the others"
        );
    }
}
