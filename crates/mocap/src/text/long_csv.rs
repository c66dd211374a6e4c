//! Long CSV, a row a marker and frame: `frame,time,marker,x,y,z`.

use super::table::frame_number;
use super::{Delimiter, Lines, Table, coordinate, split_fields};
use crate::{Format, ReadError, ReadOptions, Recording};
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

/// Whether a line is the header of such a file.
pub(crate) fn is_header(line: &str, delimiter: Delimiter) -> bool {
    columns(&split_fields(line, delimiter)).is_some()
}

/// Read the document.
pub(crate) fn read(lines: &mut Lines<'_>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let mut table = Table::default();
    let (header_line, header) = loop {
        match lines.next_filled()? {
            Some((_, line)) if line.starts_with('#') => {}
            found => break found.unwrap_or((1, "")),
        }
    };
    let delimiter = Delimiter::of(header);
    let Some(columns) = columns(&split_fields(header, delimiter)) else {
        return Err(ReadError::at_line(
            header_line,
            "header",
            "no columns frame, marker, x, y, z",
            "name the columns frame,time,marker,x,y,z",
        ));
    };
    // Frames in order, by number or by the bits of a time that is not negative.
    let mut frames: BTreeMap<u64, (usize, f64)> = BTreeMap::new();
    let mut markers: HashMap<String, usize> = HashMap::new();
    let mut points: Vec<(u64, usize, [f64; 3], usize)> = Vec::new();
    while let Some((line, text)) = lines.next_filled()? {
        if text.starts_with('#') {
            continue;
        }
        let fields = split_fields(text, delimiter);
        let number = |index: usize| {
            let field = fields.get(index).map_or("", AsRef::as_ref);
            coordinate(field, delimiter).ok_or_else(|| {
                ReadError::at_line(
                    line,
                    format!("column {}", index + 1),
                    format!("\"{field}\" is not a number"),
                    "write numbers with a decimal point, a missing one as blank or NaN",
                )
            })
        };
        let time = columns.time.map_or(Ok(f64::NAN), number)?;
        let key = match columns.frame {
            Some(column) => {
                let field = fields.get(column).map_or("", AsRef::as_ref);
                frame_number(number(column)?, field, line)?
            }
            None if time >= 0.0 => (time + 0.0).to_bits(),
            None => {
                return Err(ReadError::at_line(
                    line,
                    "time",
                    format!("{time} seconds"),
                    "give times from 0 up",
                ));
            }
        };
        let label = fields.get(columns.marker).map_or("", AsRef::as_ref);
        let next = markers.len();
        let marker = *markers.entry(label.to_owned()).or_insert_with(|| {
            table.labels.push(label.to_owned());
            next
        });
        let [x, y, z] = columns.axes;
        points.push((key, marker, [number(x)?, number(y)?, number(z)?], line));
        frames.entry(key).or_insert((line, time));
    }
    let cells = frames.len().saturating_mul(markers.len());
    // Bounded by the file: every marker in a fair share of the frames.
    if cells > 16 * points.len() + 10_000 {
        return Err(ReadError::at_line(
            header_line,
            "marker",
            format!(
                "{} rows for {} frames of {} markers",
                points.len(),
                frames.len(),
                markers.len()
            ),
            "check that the marker column holds labels and the frame column frames",
        ));
    }
    let places: HashMap<u64, usize> = frames.keys().enumerate().map(|(i, k)| (*k, i)).collect();
    table.positions = vec![[f64::NAN; 3]; cells];
    let mut seen = vec![false; cells];
    for (key, marker, p, line) in points {
        let cell = places[&key] * table.labels.len() + marker;
        if std::mem::replace(&mut seen[cell], true) {
            return Err(ReadError::at_line(
                line,
                "row",
                format!("marker \"{}\" twice in one frame", table.labels[marker]),
                "remove one of the rows",
            ));
        }
        table.positions[cell] = p;
    }
    if columns.frame.is_some() {
        table.frame_numbers = frames.keys().copied().collect();
    }
    if columns.time.is_some() {
        table.times = frames.values().map(|(_, time)| *time).collect();
    }
    table.lines = frames.values().map(|(line, _)| *line).collect();
    table.finish(Format::LongCsv, options)
}

#[cfg(test)]
mod tests {
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
        assert_eq!((capture.rate_hz, capture.frame(0)[0]), (50.0, [1.5, 2.0, 3.0]));
        let twice = "frame,time,marker,x,y,z\n0,0,a,1,2,3\n0,0,a,7,8,9\n";
        assert_eq!(
            read_bytes(twice.as_bytes()).unwrap_err().to_string(),
            "line 3, row: marker \"a\" twice in one frame; remove one of the rows"
        );
    }
}
