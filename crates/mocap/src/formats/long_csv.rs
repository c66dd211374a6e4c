//! Long CSV, a row per marker and frame: `frame,time,marker,x,y,z`.

use super::format::{Format, Read, Recognise};
use super::text::{Delimiter, Lines, Row, Table, split_fields};
use crate::{ReadError, ReadOptions, Recording};
use mimique_geometry::Point;
use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};

/// Where the columns are.
struct Columns {
    frame: Option<usize>,
    time: Option<usize>,
    marker: usize,
    axes: [usize; 3],
}

fn columns(names: &[Cow<'_, str>]) -> Option<Columns> {
    let place = |wanted: &[&str]| {
        names.iter().position(|n| wanted.contains(&n.to_ascii_lowercase().as_str()))
    };
    let columns = Columns {
        frame: place(&["frame", "frames", "frame_number"]),
        time: place(&["time", "time_s", "seconds", "timestamp", "t"]),
        marker: place(&["marker", "label", "name", "point", "markers"])?,
        axes: [place(&["x"])?, place(&["y"])?, place(&["z"])?],
    };
    (columns.frame.is_some() || columns.time.is_some()).then_some(columns)
}

pub(super) static FORMAT: Format = Format {
    id: "long-csv",
    name: "CSV (a row per marker and frame)",
    extensions: &["csv", "tsv"],
    recognised_by: "`marker`, `x`, `y`, `z`",
    reads: "rows in any order",
    recognise: Recognise::FirstLine(|line| is_header(line, Delimiter::of(line))),
    read: Read::Text(read),
    write: None,
};

/// Whether a line is the header of such a file.
fn is_header(line: &str, delimiter: Delimiter) -> bool {
    columns(&split_fields(line, delimiter)).is_some()
}

/// Read the document.
fn read(lines: &mut Lines<'_>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let mut table = Table::default();
    let (header_line, header) = loop {
        match lines.next_filled()? {
            Some((_, line)) if line.starts_with('#') => {}
            found => break found.unwrap_or((1, "")),
        }
    };
    let delimiter = Delimiter::of(header);
    let names = split_fields(header, delimiter);
    let width = names.iter().rposition(|name| !name.is_empty()).map_or(0, |last| last + 1);
    let Some(columns) = columns(&names) else {
        return Err(ReadError::at_line(
            header_line,
            "header",
            "no columns frame, marker, x, y, z",
            "name the columns frame,time,marker,x,y,z",
        ));
    };
    let mut rows = Rows::default();
    while let Some((line, text)) = lines.next_filled()? {
        if text.starts_with('#') {
            continue;
        }
        let fields = split_fields(text, delimiter);
        let remedy = "write numbers with a decimal point, a missing one as blank or NaN";
        let row = Row { line, fields: &fields, delimiter, remedy };
        row.of_width(width)?;
        rows.take(&columns, &row)?;
    }
    table.positions = rows.placed(header_line)?;
    let without_row = table.positions.len() - rows.points.len();
    if without_row > 0 {
        table.notes.push(format!("{without_row} positions without a row: taken as missing"));
    }
    table.labels = rows.labels;
    if columns.frame.is_some() {
        table.frame_numbers = rows.frames.keys().copied().collect();
    }
    if columns.time.is_some() {
        table.times = rows.frames.values().map(|(_, time)| *time).collect();
    }
    table.lines = rows.frames.values().map(|(line, _)| *line).collect();
    table.finish(&FORMAT, options)
}

/// The rows of a file, in its order.
#[derive(Default)]
struct Rows {
    /// Frames in order, by number or by the bits of a time that is not negative: the first line and the
    /// time of each.
    frames: BTreeMap<u64, (usize, f64)>,
    /// Labels in the order in which they were met, and where each stands there.
    labels: Vec<String>,
    markers: HashMap<String, usize>,
    points: Vec<MarkerRow>,
}

/// One row: where a marker is in a frame.
struct MarkerRow {
    frame: u64,
    marker: usize,
    place: Point,
    line: usize,
}

impl Rows {
    fn take(&mut self, columns: &Columns, row: &Row<'_>) -> Result<(), ReadError> {
        let time = columns.time.map_or(Ok(f64::NAN), |column| row.number(column))?;
        let frame = match columns.frame {
            Some(column) => row.frame_number(column)?,
            None if time >= 0.0 => (time + 0.0).to_bits(),
            None => {
                return Err(ReadError::at_line(
                    row.line,
                    "time",
                    format!("{time} seconds"),
                    "give times from 0 up",
                ));
            }
        };
        let label = row.text(columns.marker);
        let marker = *self.markers.entry(label.to_owned()).or_insert_with(|| {
            self.labels.push(label.to_owned());
            self.labels.len() - 1
        });
        let place = row.point(columns.axes)?;
        self.points.push(MarkerRow { frame, marker, place, line: row.line });
        self.frames.entry(frame).or_insert((row.line, time));
        Ok(())
    }

    /// The positions of all markers in all frames, frame-major.
    fn placed(&self, header_line: usize) -> Result<Vec<Point>, ReadError> {
        let (frames, markers) = (self.frames.len(), self.labels.len());
        let cells = frames.saturating_mul(markers);
        // Bounded by the file: every marker in a fair share of the frames.
        if cells > 16 * self.points.len() + 10_000 {
            return Err(ReadError::at_line(
                header_line,
                "marker",
                format!("{} rows for {frames} frames of {markers} markers", self.points.len()),
                "check that the marker column holds labels and the frame column frames",
            ));
        }
        let order: HashMap<u64, usize> =
            self.frames.keys().enumerate().map(|(i, k)| (*k, i)).collect();
        let mut positions = vec![Point::UNSEEN; cells];
        let mut seen = vec![false; cells];
        for row in &self.points {
            let cell = order[&row.frame] * markers + row.marker;
            if std::mem::replace(&mut seen[cell], true) {
                return Err(ReadError::at_line(
                    row.line,
                    "row",
                    format!("marker \"{}\" twice in one frame", self.labels[row.marker]),
                    "remove one of the rows",
                ));
            }
            positions[cell] = row.place;
        }
        Ok(positions)
    }
}

#[cfg(test)]
mod tests {
    use super::Point;
    use crate::read_bytes;

    #[test]
    fn rows_in_any_order_become_frames() {
        let text =
            "frame,time,marker,x,y,z\n1,0.01,b,4,5,6\n0,0,a,1,2,3\n0,0,b,7,8,9\n3,0.03,a,1,1,1\n";
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert_eq!(capture.labels, ["b", "a"]);
        assert_eq!((capture.rate_hz, capture.frames()), (100.0, 4));
        assert_eq!(capture.frame(0), [[7.0, 8.0, 9.0], [1.0, 2.0, 3.0]]);
        assert!(capture.frame(1)[1][0].is_nan() && capture.frame(2)[0][0].is_nan());
        let by_time = "time;label;x;y;z\n0;a;1,5;2;3\n0,02;a;1;2;3\n0,04;a;1;2;3\n";
        let capture = read_bytes(by_time.as_bytes()).unwrap();
        assert_eq!((capture.rate_hz, capture.frame(0)[0]), (50.0, Point::new(1.5, 2.0, 3.0)));
        let twice = "frame,time,marker,x,y,z\n0,0,a,1,2,3\n0,0,a,7,8,9\n";
        assert_eq!(
            read_bytes(twice.as_bytes()).unwrap_err().to_string(),
            "line 3, row: marker \"a\" twice in one frame; remove one of the rows"
        );
    }
}
