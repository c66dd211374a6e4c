//! OptiTrack Motive CSV, format versions 1.1 to 1.25: one line of settings in pairs, then lines
//! that name for each column its type, name, id, parent, measure (position, rotation...) and axis.

use super::format::{Format, Read, Recognise};
use super::plausibility::shortened;
use super::text::{Delimiter, Lines, Row, Table, split_fields};
use crate::{LengthUnit, ReadError, ReadOptions, Recording};
use std::collections::HashMap;

pub(super) static FORMAT: Format = Format {
    id: "motive-csv",
    name: "Motive CSV",
    extensions: &["csv"],
    recognised_by: "`Format Version`",
    reads: "1.1 to 1.25; measured markers, else rigid-body markers",
    recognise: Recognise::FirstLine(is_first_line),
    read: Read::Text(read),
    write: None,
};

/// Whether a line is the first of such a file.
fn is_first_line(line: &str) -> bool {
    line.trim_start_matches('"').starts_with("Format Version")
}

/// Read the document.
fn read(lines: &mut Lines<'_>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let (_, settings) = lines.next_filled()?.unwrap_or((1, ""));
    let fields = split_fields(settings, Delimiter::Comma);
    let setting = |name: &str| {
        let key = fields.iter().step_by(2).position(|key| key.eq_ignore_ascii_case(name))?;
        fields.get(2 * key + 1).map(ToString::to_string)
    };
    let version = setting("Format Version").unwrap_or_default();
    let mut table = Table {
        system: Some(format!("OptiTrack Motive, CSV {version}")),
        declared_rate: ["Export Frame Rate", "Capture Frame Rate"]
            .into_iter()
            .find_map(|name| setting(name)?.parse().ok().filter(|r| *r > 0.0)),
        declared_unit: setting("Length Units").as_deref().and_then(LengthUnit::from_name),
        ..Table::default()
    };

    let exported = setting("Total Exported Frames").and_then(|n| n.parse().ok());
    let header = header(lines)?;
    let (columns, partial) = marker_columns(&|row, column| header.cell(row, column), &header.axes);
    if !partial.is_empty() {
        table.notes.push(format!("markers without X, Y and Z left out: {}", shortened(&partial)));
    }
    if columns.is_empty() {
        return Err(ReadError::at_line(
            header.axes_line,
            "header",
            "no column of marker positions",
            "export markers from Motive, not only rigid bodies or skeletons",
        ));
    }
    table.labels = columns.iter().map(|(label, _)| label.clone()).collect();

    while let Some((line, text)) = lines.next_filled()? {
        let fields = split_fields(text, Delimiter::Comma);
        let remedy = "export the take again from Motive";
        let row = Row { line, fields: &fields, delimiter: Delimiter::Comma, remedy };
        row.of_width(header.axes.len())?;
        table.frame_numbers.push(row.frame_number(0)?);
        table.times.push(row.number(1)?);
        for (_, axes) in &columns {
            table.positions.push(row.point(*axes)?);
        }
        table.lines.push(line);
    }
    table.count_frames("Total Exported Frames", exported);
    table.finish(&FORMAT, options)
}

/// The lines that say what each column is.
struct Header {
    /// By what stands in their second column; the measures have nothing there.
    rows: HashMap<String, Vec<String>>,
    /// The line of axes, which begins with the word Frame.
    axes: Vec<String>,
    axes_line: usize,
}

impl Header {
    fn cell(&self, row: &str, column: usize) -> &str {
        self.rows.get(row).and_then(|r| r.get(column)).map_or("", String::as_str)
    }
}

fn header(lines: &mut Lines<'_>) -> Result<Header, ReadError> {
    let mut rows: HashMap<String, Vec<String>> = HashMap::new();
    while let Some((axes_line, text)) = lines.next()? {
        let fields = split_fields(text, Delimiter::Comma);
        let owned: Vec<String> = fields.iter().map(ToString::to_string).collect();
        if owned[0].eq_ignore_ascii_case("frame") {
            return Ok(Header { rows, axes: owned, axes_line });
        }
        let key = owned.get(1).map(|k| k.to_ascii_lowercase()).unwrap_or_default();
        if owned.len() > 2 {
            rows.insert(key, owned);
        }
    }
    Err(ReadError::at_line(
        1,
        "header",
        "no line that starts with Frame",
        "export the take again from Motive with its header",
    ))
}

/// Label and the three columns of every marker, and the labels of those that have fewer. Columns of type `Marker` are what was measured;
/// only a file without them gives its rigid body or bone markers, which are the model's.
fn marker_columns<'h>(
    cell: &impl Fn(&str, usize) -> &'h str,
    axes: &[String],
) -> (Vec<(String, [usize; 3])>, Vec<String>) {
    let measured = (2..axes.len()).any(|c| cell("type", c).eq_ignore_ascii_case("marker"));
    let mut markers: Vec<(String, [Option<usize>; 3])> = Vec::new();
    let mut places: HashMap<(String, String), usize> = HashMap::new();
    for (column, axis) in axes.iter().enumerate().skip(2) {
        let kind = cell("type", column).to_ascii_lowercase();
        let wanted = if measured { kind == "marker" } else { kind.ends_with("marker") };
        if !wanted || !cell("", column).eq_ignore_ascii_case("position") {
            continue;
        }
        let axis = match axis.as_str() {
            "X" | "x" => 0,
            "Y" | "y" => 1,
            "Z" | "z" => 2,
            _ => continue,
        };
        let (name, id) = (cell("name", column).to_owned(), cell("id", column).to_owned());
        // The same axis of the same name again is another marker of that name.
        let known = places.get(&(name.clone(), id.clone())).copied();
        let marker = known.filter(|&m| markers[m].1[axis].is_none()).unwrap_or_else(|| {
            markers.push((name.clone(), [None; 3]));
            places.insert((name, id), markers.len() - 1);
            markers.len() - 1
        });
        markers[marker].1[axis] = Some(column);
    }
    let (mut whole, mut partial) = (Vec::new(), Vec::new());
    for (label, axes) in markers {
        match axes {
            [Some(x), Some(y), Some(z)] => whole.push((label, [x, y, z])),
            _ => partial.push(label),
        }
    }
    (whole, partial)
}

#[cfg(test)]
mod tests {
    use crate::{LengthUnit, ReadOptions, read_recording};

    #[test]
    fn measured_markers_are_taken_and_blanks_are_missing() {
        let text = "Format Version,1.23,Take Name,\"a, b\",Capture Frame Rate,120.000000,\
            Export Frame Rate,60.000000,Rotation Type,Quaternion,Length Units,Meters\n\n\
            ,Type,Rigid Body,Rigid Body,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,Marker,Marker,Marker,Marker,Marker,Marker\n\
            ,Name,head,head,head:1,head:1,head:1,brow,brow,brow,nose,nose,nose\n\
            ,ID,1,1,2,2,2,3,3,3,4,4,4\n\
            ,,Rotation,Position,Position,Position,Position,Position,Position,Position,Position,Position,Position\n\
            Frame,Time (Seconds),X,X,X,Y,Z,X,Y,Z,X,Y,Z\n\
            10,0.000000,1,1,9,9,9,0.1,0.2,0.3,0.4,0.5,0.6\n\
            11,0.016667,1,1,9,9,9,,,,0.4,0.5,0.6\n";
        for text in [text.to_owned(), text.replace('\n', "\r\n")] {
            let got = read_recording(text.as_bytes(), &ReadOptions::default()).unwrap();
            assert_eq!(got.system.as_deref(), Some("OptiTrack Motive, CSV 1.23"));
            let capture = got.capture;
            assert_eq!(capture.labels, ["brow", "nose"]);
            assert_eq!((capture.rate_hz, capture.first_frame), (60.0, 10));
            assert_eq!(capture.unit, LengthUnit::Metre);
            assert_eq!(capture.frame(0), [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]);
            assert!(capture.frame(1)[0][0].is_nan());
        }
    }
}
