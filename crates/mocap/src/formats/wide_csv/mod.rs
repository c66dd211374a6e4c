//! Plain CSV, a row per frame and a column per coordinate: `frame,time,LABEL_x,LABEL_y,LABEL_z,...`.
//!
//! Separated by commas, semicolons (decimal commas allowed) or tabs. Axes end the column's name
//! after `_`, `.`, `:`, `-` or a blank, in either case, in any order; a unit may follow in
//! brackets (`LABEL_x [mm]`). `time` is in seconds, `time_ms` in milliseconds. Lines that start
//! with `#` are comments; `# unit: mm` and `# rate_hz: 200` are read.

mod write;

pub use write::write_csv;

use crate::formats::plausibility::shortened;
use crate::formats::text::{
    Delimiter, Lines, Row, Table, coordinate, frame_number, plain_row, split_fields,
};
use crate::formats::{Format, Read, Recognise, Write};
use crate::{LengthUnit, ReadError, ReadOptions, Recording};
use mimique_geometry::Point;
use std::borrow::Cow;
use std::collections::HashMap;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Column {
    Frame,
    /// Time, and how many seconds one of its units is.
    Time(f64),
    Coordinate {
        marker: usize,
        axis: usize,
    },
    Ignored,
}

/// The format that this program's own captures are in.
pub static FORMAT: Format = Format {
    id: "wide-csv",
    name: "CSV (a column per coordinate)",
    extensions: &["csv", "tsv"],
    recognised_by: "`LABEL_x`, `LABEL_y`, `LABEL_z`",
    reads: "any order of columns; units in brackets; `# unit: mm; rate_hz: 200`",
    recognise: Recognise::FirstLine(|line| is_header(line, Delimiter::of(line))),
    read: Read::Text(read),
    write: Some(Write::Capture(|capture, _| write_csv(capture).map(String::into_bytes))),
};

/// Whether a line is the header of such a file: it names at least one marker in x, y and z.
fn is_header(line: &str, delimiter: Delimiter) -> bool {
    columns(&split_fields(line, delimiter)).map_or(true, |(labels, _, _)| !labels.is_empty())
}

/// Read the document.
fn read(lines: &mut Lines<'_>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let mut table = Table::default();
    let (header_line, header) = header(lines, &mut table)?;
    let delimiter = Delimiter::of(&header);
    let names = split_fields(&header, delimiter);
    let (labels, columns, unit) = columns(&names)
        .map_err(|(what, remedy)| ReadError::at_line(header_line, "header", what, remedy))?;
    table.labels = labels;
    table.declared_unit = table.declared_unit.or(unit);
    table.notes.extend(ignored(&names, &columns));
    let length = lines.length();
    let mut values = Vec::with_capacity(columns.len());
    while let Some((line_number, line)) = lines.next()? {
        if plain_row(line, delimiter, columns.len(), &mut values) {
            if table.lines.is_empty() {
                // As many rows as the rest of the file holds at this length, in one piece.
                let rows = length / (line.len() as u64 + 1) + 1;
                table.positions.reserve(rows as usize * table.labels.len());
            }
            let cells = values.iter().map(|value| Ok((*value, None)));
            put(&mut table, &columns, line_number, cells)?;
            continue;
        }
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        let fields = split_fields(line, delimiter);
        let remedy = "write numbers with a decimal point, a missing one as blank or NaN";
        Row { line: line_number, fields: &fields, delimiter, remedy }.of_width(columns.len())?;
        let cells = fields.iter().zip(&columns).enumerate().map(|(index, (field, column))| {
            if *column == Column::Ignored {
                return Ok((f64::NAN, None));
            }
            let value = coordinate(field, delimiter).ok_or_else(|| {
                ReadError::at_line(
                    line_number,
                    format!("column {} ({})", index + 1, names[index]),
                    format!("\"{field}\" is not a number"),
                    "write numbers with a decimal point, a missing one as blank or NaN",
                )
            })?;
            Ok((value, Some(field.as_ref())))
        });
        put(&mut table, &columns, line_number, cells)?;
    }
    table.finish(&FORMAT, options)
}

/// What is said of columns that are not read.
fn ignored(names: &[Cow<'_, str>], columns: &[Column]) -> Option<String> {
    let ignored: Vec<String> = names
        .iter()
        .zip(columns)
        .filter(|(name, column)| **column == Column::Ignored && !name.is_empty())
        .map(|(name, _)| name.to_string())
        .collect();
    (!ignored.is_empty()).then(|| format!("columns ignored: {}", shortened(&ignored)))
}

/// The header and its line, behind comments.
fn header(lines: &mut Lines<'_>, table: &mut Table) -> Result<(usize, String), ReadError> {
    while let Some((number, line)) = lines.next()? {
        if line.starts_with('#') {
            comment(line, table);
        } else if !line.trim().is_empty() {
            return Ok((number, line.to_owned()));
        }
    }
    Err(ReadError::at_line(
        1,
        "header",
        "no header",
        "name the columns frame,time,LABEL_x,LABEL_y,LABEL_z",
    ))
}

/// Puts a row of numbers, each with its text where it is not the plain number, behind the others.
fn put<'f>(
    table: &mut Table,
    columns: &[Column],
    line: usize,
    cells: impl Iterator<Item = Result<(f64, Option<&'f str>), ReadError>>,
) -> Result<(), ReadError> {
    let row = table.positions.len();
    table.positions.resize(row + table.labels.len(), Point::UNSEEN);
    for (cell, column) in cells.zip(columns) {
        let (value, text) = cell?;
        match *column {
            Column::Frame => {
                let number = match text {
                    Some(text) => frame_number(value, text, line)?,
                    None => frame_number(value, &value.to_string(), line)?,
                };
                table.frame_numbers.push(number);
            }
            Column::Time(seconds) => table.times.push(value * seconds),
            Column::Coordinate { marker, axis } => table.positions[row + marker][axis] = value,
            Column::Ignored => {}
        }
    }
    table.lines.push(line);
    Ok(())
}

/// Read `# unit: mm` and `# rate_hz: 200`.
fn comment(line: &str, table: &mut Table) {
    for part in line.trim_start_matches('#').split([',', ';']) {
        let Some((key, value)) = part.split_once([':', '=']) else { continue };
        match key.trim().to_ascii_lowercase().as_str() {
            "unit" | "units" => table.declared_unit = LengthUnit::from_name(value),
            "rate_hz" | "rate" => table.declared_rate = value.trim().parse().ok(),
            "system" => table.system = Some(value.trim().to_owned()),
            _ => {}
        }
    }
}

/// Labels, meaning of every column, and the unit named in the columns. `Err` says what is wrong, a name or
/// a unit, and what to do.
#[allow(clippy::type_complexity)] // three results of one pass, used once
fn columns(
    names: &[Cow<'_, str>],
) -> Result<(Vec<String>, Vec<Column>, Option<LengthUnit>), (String, &'static str)> {
    let mut labels: Vec<String> = Vec::new();
    let mut places: Vec<[Option<usize>; 3]> = Vec::new();
    let mut by_label: HashMap<String, usize> = HashMap::new();
    let mut columns = vec![Column::Ignored; names.len()];
    let mut unit: Option<LengthUnit> = None;
    let (mut frame_seen, mut time_seen) = (false, false);
    for (index, name) in names.iter().enumerate() {
        let (name, in_brackets) = without_unit(name);
        if index <= 3 || !(frame_seen && time_seen) {
            match meaning(name) {
                Some(Column::Frame) if !frame_seen => {
                    frame_seen = true;
                    columns[index] = Column::Frame;
                    continue;
                }
                Some(Column::Time(_)) if !time_seen => {
                    time_seen = true;
                    let seconds = if in_brackets == Some("ms") { 1e-3 } else { 1.0 };
                    columns[index] = match meaning(name) {
                        Some(Column::Time(s)) => Column::Time(s.min(seconds)),
                        _ => Column::Ignored,
                    };
                    continue;
                }
                _ => {}
            }
        }
        let Some((label, axis)) = label_and_axis(name) else { continue };
        let marker = *by_label.entry(label.to_owned()).or_insert_with(|| {
            labels.push(label.to_owned());
            places.push([None; 3]);
            labels.len() - 1
        });
        if places[marker][axis].replace(index).is_some() {
            return Err((format!("two columns are {name}"), "give every column its own name"));
        }
        let own = in_brackets.and_then(LengthUnit::from_name);
        if let (Some(unit), Some(own)) = (unit, own)
            && unit != own
        {
            let what =
                format!("{name} is in {}, columns before it in {}", own.symbol(), unit.symbol());
            return Err((what, "write all coordinates in one unit"));
        }
        unit = unit.or(own);
    }
    // Keep whole triples only.
    let mut kept = Vec::new();
    for (label, place) in labels.into_iter().zip(places) {
        if let [Some(x), Some(y), Some(z)] = place {
            for (axis, column) in [x, y, z].into_iter().enumerate() {
                columns[column] = Column::Coordinate { marker: kept.len(), axis };
            }
            kept.push(label);
        }
    }
    Ok((kept, columns, unit))
}

/// Split `NAME [mm]` or `NAME (mm)` into name and unit.
fn without_unit(name: &str) -> (&str, Option<&str>) {
    let name = name.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(inside) = name.strip_suffix(close)
            && let Some((before, unit)) = inside.rsplit_once(open)
        {
            return (before.trim_end(), Some(unit.trim()));
        }
    }
    (name, None)
}

/// Whether a column is the frame number or the time.
fn meaning(name: &str) -> Option<Column> {
    match name.to_ascii_lowercase().as_str() {
        "frame" | "frames" | "frame#" | "frame #" | "frame_number" | "framenumber" | "index" => {
            Some(Column::Frame)
        }
        "time" | "time_s" | "times" | "seconds" | "timestamp" | "t" => Some(Column::Time(1.0)),
        "time_ms" | "timestamp_ms" | "milliseconds" => Some(Column::Time(1e-3)),
        _ => None,
    }
}

/// Split `LABEL_x` into label and axis.
fn label_and_axis(name: &str) -> Option<(&str, usize)> {
    let axis = match name.chars().next_back()? {
        'x' | 'X' => 0,
        'y' | 'Y' => 1,
        'z' | 'Z' => 2,
        _ => return None,
    };
    let stem = &name[..name.len() - 1];
    let label = stem.strip_suffix(['_', '.', ':', '-', ' '])?.trim_end();
    (!label.is_empty()).then_some((label, axis))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_bytes;

    #[test]
    fn reads_labels_rate_unit_and_missing_markers() {
        let text = "frame,time,A_x,A_y,A_z,B b.X,B b.Y,B b.Z\n\
                    7,0.000,0,0,100,50,1,2\n8,0.010,1,2,103,,,\n9,0.020,1,NaN,3,51,1,2\n";
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert_eq!(capture.labels, ["A", "B b"]);
        assert_eq!((capture.rate_hz, capture.first_frame, capture.frames()), (100.0, 7, 3));
        assert_eq!(capture.unit, LengthUnit::Millimetre);
        assert_eq!(capture.frame(0), [[0.0, 0.0, 100.0], [50.0, 1.0, 2.0]]);
        assert!(capture.frame(1)[1].is_nan_mask().all());
        assert!(capture.frame(2)[0].is_nan_mask().all(), "one coordinate is no position");
    }

    #[test]
    fn semicolons_decimal_commas_units_in_brackets_and_columns_in_any_order() {
        let text = "Time (ms);n_z [cm];n_x [cm];n_y [cm];quality\n0;3,5;1,5;2,5;a\n20;3;1;2;b\n";
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert_eq!((capture.rate_hz, capture.unit), (50.0, LengthUnit::Centimetre));
        assert_eq!(capture.positions, [[1.5, 2.5, 3.5], [1.0, 2.0, 3.0]]);
        assert_eq!(capture.notes, ["columns ignored: quality"]);
    }

    #[test]
    fn dropped_rows_become_missing_frames() {
        let text = "frame,time_s,a_x,a_y,a_z\n0,0,1,2,3\n1,0.01,1,2,3\n4,0.04,1,2,4\n";
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert_eq!((capture.frames(), capture.rate_hz), (5, 100.0));
        assert!(capture.frame(2)[0][0].is_nan() && capture.frame(3)[0][0].is_nan());
        assert_eq!(capture.frame(4), [[1.0, 2.0, 4.0]]);
        assert!(capture.notes.iter().any(|n| n == "2 dropped frames filled in as missing"));
    }

    #[test]
    fn every_second_frame_halves_the_rate() {
        let text = "frame,time_s,a_x,a_y,a_z\n10,0,1,2,3\n12,0.02,1,2,3\n16,0.06,1,2,4\n";
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert_eq!((capture.frames(), capture.rate_hz, capture.first_frame), (4, 50.0, 10));
    }

    #[test]
    fn errors_name_line_value_and_remedy() {
        let message = |text: &str| read_bytes(text.as_bytes()).unwrap_err().to_string();
        let head = "frame,time,a_x,a_y,a_z\n";
        assert_eq!(
            message(&format!("{head}0,0,1,2,3\n1,0.01,1,2 mm,3\n")),
            "line 3, column 4 (a_y): \"2 mm\" is not a number; \
             write numbers with a decimal point, a missing one as blank or NaN"
        );
        assert_eq!(
            message(&format!("{head}0,0,1,2,3\n1,0.01,1\n")),
            "line 3, row: 3 columns where the header has 5; \
             complete the row or remove it; the file may have been cut short"
        );
        assert_eq!(
            message(&format!("{head}5,0,1,2,3\n4,0.01,1,2,3\n")),
            "line 3, frame: frame 4 after frame 5; give one take a file, frames in order"
        );
        assert_eq!(
            message("frame,a_x,a_y,a_z\n0,1,2,3\n"),
            "line 1, header: no rate and no time column; give the rate of the recording (--mocap-rate)"
        );
        assert_eq!(
            message(&format!("{head}0,0,1,2,3\n900719925474099,0.01,1,2,3\n")),
            "line 3, frame: 2 rows for 900719925474100 frames, more than half of them not in the \
             file; check the frame or time column and the rate, or give one take a file"
        );
        assert_eq!(
            message("frame,time,a_x,a_y,a_z,a_x\n0,0,1,2,3,4\n"),
            "line 1, header: two columns are a_x; give every column its own name"
        );
    }

    #[test]
    fn a_hole_may_not_ask_for_more_than_the_file_has() {
        // 900 frames are missing between two rows: of a few markers they are made good, of a thousand
        // they would be ten thousand times the file.
        let text = |markers: usize| {
            let names: Vec<String> =
                (0..markers).map(|n| format!("m{n}_x,m{n}_y,m{n}_z")).collect();
            let row = vec!["1"; 3 * markers].join(",");
            let names = names.join(",");
            format!("# rate_hz: 100\nframe,{names}\n0,{row}\n901,{row}\n")
        };
        assert_eq!(read_bytes(text(3).as_bytes()).unwrap().frames(), 902);
        let refused = read_bytes(text(1000).as_bytes()).unwrap_err().to_string();
        assert!(refused.contains("2 rows for 902 frames"), "{refused}");
    }

    #[test]
    fn zeros_are_gaps_unless_the_marker_is_near_the_origin() {
        let text = "# unit: mm; rate_hz: 100\nframe,a_x,a_y,a_z,b_x,b_y,b_z\n\
                    0,100,2,3,1,1,1\n1,0,0,0,0,0,0\n2,100,2,3,1,0,0\n";
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert!(capture.frame(1)[0][0].is_nan());
        assert_eq!(capture.frame(1)[1], [0.0; 3]);
    }
}
