//! Plain CSV from a capture: a comment with unit and rate, then a row per frame.

use crate::formats::text::{check_label, push};
use crate::{Capture, WriteError};

/// Write plain wide CSV: `# unit: mm; rate_hz: 200`, the header `frame,time,LABEL_x,...`, a row a
/// frame; a missing marker is three blanks. Reading it gives the same capture, bit for bit.
///
/// # Errors
/// [`WriteError::Label`] for a label with control characters, or blanks around it.
pub fn write_csv(capture: &Capture) -> Result<String, WriteError> {
    let mut text =
        format!("# unit: {}; rate_hz: {}\nframe,time", capture.unit.symbol(), capture.rate_hz);
    for label in &capture.labels {
        check_label(label)?;
        for axis in ['x', 'y', 'z'] {
            if label.contains([',', '"', ';', '\t']) {
                let doubled = label.replace('"', "\"\"");
                push(&mut text, format_args!(",\"{doubled}_{axis}\""));
            } else {
                push(&mut text, format_args!(",{label}_{axis}"));
            }
        }
    }
    text.push('\n');
    for frame in 0..capture.frames() {
        let number = capture.first_frame + frame as u64;
        push(&mut text, format_args!("{number},{}", frame as f64 / capture.rate_hz));
        for p in capture.frame(frame) {
            if p[0].is_nan() {
                text.push_str(",,,");
            } else {
                push(&mut text, format_args!(",{},{},{}", p[0], p[1], p[2]));
            }
        }
        text.push('\n');
    }
    Ok(text)
}
