//! Qualisys Track Manager TSV: key lines (`NO_OF_FRAMES`, `MARKER_NAMES`...), an optional line of
//! column names, rows with or without frame and time; or, exported without header, numbers alone.
//! Coordinates are in millimetres. A gap is blank, `NULL` or zeros.

use std::borrow::Cow;

use super::format::{Format, Read, Recognise};
use super::text::{Delimiter, Lines, Row, Table, coordinate, split_fields};
use crate::{Event, LengthUnit, ReadError, ReadOptions, Recording};

pub(super) static FORMAT: Format = Format {
    id: "qtm-tsv",
    name: "QTM TSV",
    extensions: &["tsv"],
    recognised_by: "`NO_OF_FRAMES`, or rows of numbers",
    reads: "with and without header, frame and time; events",
    recognise: Recognise::FirstLine(|line| is_first_line(line) || is_row(line)),
    read: Read::Text(read),
    write: None,
};

/// Whether a line is one that only such a file starts with.
fn is_first_line(line: &str) -> bool {
    line.starts_with("NO_OF_FRAMES\t") || line.starts_with("NO_OF_CAMERAS\t")
}

/// Whether a line is a row of numbers alone: whole triples, with or without frame and time.
fn is_row(line: &str) -> bool {
    let fields = split_fields(line.trim_end(), Delimiter::Tab);
    let numbers = fields.iter().all(|f| coordinate(f, Delimiter::Tab).is_some());
    numbers && fields.len() >= 3 && fields.len() % 3 != 1 && line.contains('\t')
}

/// Read the document.
fn read(lines: &mut Lines<'_>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let mut table = Table {
        system: Some("Qualisys Track Manager".to_owned()),
        declared_unit: Some(LengthUnit::Millimetre),
        ..Table::default()
    };
    let mut header = Header::default();
    let mut leading = None;
    while let Some((line, text)) = lines.next_filled()? {
        let mut fields = split_fields(text, Delimiter::Tab);
        header.over |= coordinate(&fields[0], Delimiter::Tab).is_some() && !fields[0].is_empty();
        if !header.over {
            header.has_keys = true;
            let values: Vec<&str> = fields[1..].iter().map(AsRef::as_ref).collect();
            header.take(&mut table, line, &fields[0], &values)?;
            continue;
        }
        while fields.last().is_some_and(|f| f.is_empty())
            && leading.is_some_and(|l| fields.len() > l + 3 * table.labels.len())
        {
            fields.pop();
        }
        if leading.is_none() {
            if header.has_keys && table.labels.is_empty() {
                return Err(ReadError::at_line(
                    line,
                    "header",
                    "no MARKER_NAMES, so that nothing says what the columns are",
                    "export the 3D data from QTM with its header, or without any",
                ));
            }
            leading = leading_columns(&mut table, &mut fields);
        }
        let Some(leading) = leading.filter(|l| fields.len() >= l + 3 * table.labels.len()) else {
            return Err(ReadError::at_line(
                line,
                "row",
                format!("{} columns for {} markers", fields.len(), table.labels.len()),
                "export the take again; the file may have been cut short",
            ));
        };
        let remedy = "export the take again from QTM";
        let row = Row { line, fields: &fields, delimiter: Delimiter::Tab, remedy };
        row.of_width(leading + 3 * table.labels.len())?;
        if leading == 2 {
            table.frame_numbers.push(row.frame_number(0)?);
            table.times.push(row.number(1)?);
        }
        for marker in 0..table.labels.len() {
            let at = leading + 3 * marker;
            table.positions.push(row.point([at, at + 1, at + 2])?);
        }
        table.lines.push(line);
    }
    table.count_frames("NO_OF_FRAMES", header.frames);
    let mut recording = table.finish(&FORMAT, options)?;
    recording.events = header.events;
    Ok(recording)
}

/// The lines before the rows, a key and its values each.
#[derive(Default)]
struct Header {
    /// Whether the rows have begun.
    over: bool,
    /// Whether there is a header at all.
    has_keys: bool,
    /// Frames that the file says to have.
    frames: Option<usize>,
    events: Vec<Event>,
}

impl Header {
    fn take(
        &mut self,
        table: &mut Table,
        line: usize,
        key: &str,
        values: &[&str],
    ) -> Result<(), ReadError> {
        match key {
            "FREQUENCY" => table.declared_rate = values.first().and_then(|v| decimal(v)),
            "NO_OF_FRAMES" => self.frames = values.first().and_then(|v| v.parse().ok()),
            "MARKER_NAMES" => {
                table.labels = values.iter().map(|v| (*v).to_owned()).collect();
                while table.labels.last().is_some_and(String::is_empty) {
                    table.labels.pop();
                }
            }
            "EVENT" => self.events.extend(event(values)),
            "DATA_INCLUDED" if !values.iter().any(|value| names_trajectories(value)) => {
                let named = values.join(" ");
                return Err(ReadError::at_line(
                    line,
                    "DATA_INCLUDED",
                    format!("{:?}, which holds no trajectories", named.trim()),
                    "export the 3D data from QTM",
                ));
            }
            _ => {}
        }
        Ok(())
    }
}

/// Whether a value of `DATA_INCLUDED` names the trajectories of markers: `3D` among its words. `2D` are
/// camera images, `6D` poses of bodies; angles, forces and analog signals are named in words.
fn names_trajectories(value: &str) -> bool {
    value.split(|c: char| !c.is_alphanumeric()).any(|word| word.eq_ignore_ascii_case("3D"))
}

/// Columns before the coordinates, from the first row: none, or frame and time. Without a header the
/// row says how many markers there are.
fn leading_columns(table: &mut Table, fields: &mut Vec<Cow<'_, str>>) -> Option<usize> {
    if table.labels.is_empty() {
        while fields.len() % 3 == 1 && fields.last().is_some_and(|f| f.is_empty()) {
            fields.pop();
        }
        table.labels = vec![String::new(); fields.len() / 3];
        table.notes.push("no header: labels are made up".to_owned());
    }
    // With a trailing tab there is one empty field more.
    let trailing = fields.last().is_some_and(|f| f.is_empty());
    match fields.len().checked_sub(3 * table.labels.len()) {
        Some(0) => Some(0),
        Some(1) if trailing => Some(0),
        Some(2) => Some(2),
        Some(3) if trailing => Some(2),
        _ => None,
    }
}

/// A number with a point or a decimal comma.
fn decimal(text: &str) -> Option<f64> {
    text.replace(',', ".").parse().ok()
}

/// `EVENT  label  frame  seconds`.
fn event(values: &[&str]) -> Option<Event> {
    let [label, _frame, time, ..] = values else { return None };
    decimal(time).map(|time_s| Event { label: (*label).to_owned(), time_s })
}

#[cfg(test)]
mod tests {
    use crate::{LengthUnit, ReadOptions, read_bytes, read_recording};

    const HEAD: &str = "NO_OF_FRAMES\t3\nNO_OF_CAMERAS\t8\nNO_OF_MARKERS\t2\nFREQUENCY\t200\n\
        NO_OF_ANALOG\t0\nDESCRIPTION\t--\nDATA_INCLUDED\t3D\nEVENT\tsmile\t706\t0.005\n\
        MARKER_NAMES\tleft brow\tnose\nTRAJECTORY_TYPES\tMeasured\tMixed\n";
    const ROWS: [&str; 3] =
        ["100.5\t2\t300\t50\t60\t70", "0.000\t0.000\t0.000\t50\t60\t70", "101\t2\t300\t\t\t"];

    #[test]
    fn with_frame_and_time_columns_and_without() {
        let numbered: String = ROWS
            .iter()
            .enumerate()
            .map(|(i, r)| format!("{}\t{}\t{r}\n", 705 + i, i as f64 / 200.0))
            .collect();
        let plain: String = ROWS.iter().map(|r| format!("{r}\t\n")).collect();
        let columns =
            "Frame\tTime\tleft brow X\tleft brow Y\tleft brow Z\tnose X\tnose Y\tnose Z\n";
        for (text, first) in [
            (format!("{HEAD}{numbered}"), 705),
            (format!("{HEAD}{columns}{numbered}"), 705),
            (format!("{HEAD}{plain}"), 0),
        ] {
            let got = read_recording(text.as_bytes(), &ReadOptions::default()).unwrap();
            let capture = got.capture;
            assert_eq!(capture.labels, ["left brow", "nose"]);
            assert_eq!((capture.rate_hz, capture.first_frame, capture.frames()), (200.0, first, 3));
            assert_eq!(capture.unit, LengthUnit::Millimetre);
            assert_eq!(capture.frame(0), [[100.5, 2.0, 300.0], [50.0, 60.0, 70.0]]);
            assert!(capture.frame(1)[0][0].is_nan(), "zeros are a gap");
            assert!(capture.frame(2)[1][0].is_nan(), "blanks are a gap");
            assert_eq!((got.events[0].label.as_str(), got.events[0].time_s), ("smile", 0.005));
        }
    }

    #[test]
    fn what_holds_no_trajectories_is_refused_by_name() {
        for named in ["6D", "Analog", "Angles", "2D", "Force\tEMG"] {
            let head = HEAD.replace("DATA_INCLUDED\t3D", &format!("DATA_INCLUDED\t{named}"));
            let text = format!("{head}{}\n", ROWS[0]);
            let error = read_bytes(text.as_bytes()).unwrap_err().to_string();
            let named = named.replace('\t', " ");
            assert!(
                error.starts_with(&format!("line 7, DATA_INCLUDED: {named:?}, which holds no")),
                "{error}"
            );
        }
        for named in ["3D", "3D Analog", "2D/3D", "3d"] {
            let head = HEAD.replace("DATA_INCLUDED\t3D", &format!("DATA_INCLUDED\t{named}"));
            assert!(read_bytes(format!("{head}{}\n", ROWS[0]).as_bytes()).is_ok(), "{named}");
        }
        // Analog samples whose header does not say what is included.
        let text = "NO_OF_FRAMES\t1\nFREQUENCY\t200\n0\t0.000\t1.5\t2\t3\t4\n";
        let error = read_bytes(text.as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with("line 3, header: no MARKER_NAMES"), "{error}");
    }

    #[test]
    fn without_header_labels_are_made_up_and_the_rate_is_asked_for() {
        let text = "1\t2\t3\t4\t5\t6\n1\t2\t3\t4\t5\t6\n";
        let options = ReadOptions { rate_hz: Some(100.0), ..ReadOptions::default() };
        let capture = read_recording(text.as_bytes(), &options).unwrap().capture;
        assert_eq!(capture.labels, ["M001", "M002"]);
        assert_eq!(capture.frame(1)[1], [4.0, 5.0, 6.0]);
        assert_eq!(
            read_bytes(text.as_bytes()).unwrap_err().to_string(),
            "line 1, header: no rate and no time column; give the rate of the recording (--mocap-rate)"
        );
    }
}
