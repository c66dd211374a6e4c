//! TRC (Motion Analysis, OpenSim): tab-separated, two header lines of settings, labels, axes, rows.
//!
//! As found in the wild: commas in the place of tabs, CRLF, blanks for missing markers, rows that end
//! early or have markers beyond the labels, a blank line after the axes or none, `NumMarkers` that is
//! wrong, labels with blanks in them.

use super::format::{Format, Read, Recognise, Write};
use super::text::{Delimiter, Lines, Table, coordinate, plain_row, split_fields};
use super::text::{check_label, frame_number, push};
use crate::{Capture, LengthUnit, ReadError, ReadOptions, Recording, WriteError};
use mimique_geometry::Point;

const REMEDY: &str = "export the take again as TRC";

pub(super) static FORMAT: Format = Format {
    id: "trc",
    name: "TRC",
    extensions: &["trc"],
    recognised_by: "`PathFileType`",
    reads: "tabs or commas, CRLF, blanks, rows that end early or go beyond the labels, wrong `NumMarkers`, blanks in \
        labels",
    recognise: Recognise::FirstLine(is_first_line),
    read: Read::Text(read),
    write: Some(Write::Capture(|capture, name| write_trc(capture, name).map(String::into_bytes))),
};

/// Whether a line is the first of a TRC file.
fn is_first_line(line: &str) -> bool {
    line.trim_start().starts_with("PathFileType")
}

/// Read the document.
fn read(lines: &mut Lines<'_>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let mut table = Table::default();
    // The first line says that it is TRC.
    lines.next_filled()?;
    let [(_, keys), (values_line, values), (label_line, labels), (axes_line, axes)] =
        lines.header(1)?;

    let delimiter = match Delimiter::of(&keys) {
        Delimiter::Comma if keys.contains(',') => Delimiter::Comma,
        _ => Delimiter::Tab,
    };
    let settings = settings(&keys, &values, delimiter);
    let setting = |name: &str| {
        let (_, value) = settings.iter().find(|(key, _)| key.eq_ignore_ascii_case(name))?;
        (!value.is_empty()).then_some(*value)
    };
    table.declared_rate = setting("DataRate").and_then(|v| v.replace(',', ".").parse().ok());
    table.declared_unit = setting("Units").and_then(LengthUnit::from_name);
    if table.declared_rate.is_none() && options.rate_hz.is_none() {
        return Err(ReadError::at_line(
            values_line,
            "header",
            "no number under DataRate",
            "give the rate of the recording (--mocap-rate)",
        ));
    }

    table.labels = labels_of(&labels, delimiter);
    let triples = axes.split(delimiter.char()).filter(|f| f.trim().starts_with(['X', 'x'])).count();
    if triples > table.labels.len() {
        table.notes.push(format!("{} labels for {triples} markers", table.labels.len()));
        table.labels.resize(triples, String::new());
    }
    if table.labels.is_empty() {
        return Err(ReadError::at_line(label_line, "labels", "no marker", REMEDY));
    }
    let markers = table.labels.len();
    if let Some(declared) = setting("NumMarkers").filter(|n| n.parse() != Ok(markers)) {
        table.notes.push(format!("NumMarkers is {declared}, the labels are {markers}"));
    }

    let ended_early = rows(lines, (axes_line, &axes), delimiter, &mut table)?;
    if table.labels.len() > markers {
        let beyond = table.labels.len() - markers;
        table.notes.push(format!(
            "the rows have {beyond} markers beyond the labels: named by their place"
        ));
    }
    if ended_early > 0 {
        table.notes.push(format!("{ended_early} rows end early, the rest taken as missing"));
    }
    table.count_frames("NumFrames", setting("NumFrames").and_then(|n| n.parse().ok()));
    table.finish(&FORMAT, options)
}

/// The settings with their values. Files whose values are parted by more than one delimiter have them in
/// the same order.
fn settings<'l>(keys: &'l str, values: &'l str, delimiter: Delimiter) -> Vec<(&'l str, &'l str)> {
    let fields = |line: &'l str| line.split(delimiter.char()).map(str::trim);
    let filled = |line: &'l str| fields(line).filter(|field| !field.is_empty());
    let beyond = fields(values).skip(fields(keys).count()).any(|field| !field.is_empty());
    if beyond && filled(keys).count() == filled(values).count() {
        filled(keys).zip(filled(values)).collect()
    } else {
        fields(keys).zip(fields(values)).collect()
    }
}

/// Take in the rows of data, from the line of axes on; how many end early.
fn rows(
    lines: &mut Lines<'_>,
    axes: (usize, &str),
    delimiter: Delimiter,
    table: &mut Table,
) -> Result<usize, ReadError> {
    let (mut ended_early, mut values, length) = (0_usize, Vec::new(), lines.length());
    // The axes line is a row of data where a writer left it out.
    if axes.1.trim_start().starts_with(|c: char| c.is_ascii_digit()) {
        ended_early += usize::from(row(axes.0, axes.1, delimiter, length, table)?);
    }
    while let Some((line, text)) = lines.next_filled()? {
        if text.trim_matches(|c: char| c.is_whitespace() || c == delimiter.char()).is_empty() {
            continue;
        }
        let markers = table.labels.len();
        if plain_row(text, delimiter, 2 + 3 * markers, &mut values) {
            if table.lines.is_empty() {
                // As many rows as the rest of the file holds at this length, in one piece.
                let rows = length / (text.len() as u64 + 1) + 1;
                table.positions.reserve(rows as usize * markers);
            }
            let frame = frame_number(values[0], &values[0].to_string(), line)?;
            table.frame_numbers.push(frame);
            table.times.push(values[1]);
            table.positions.extend(values[2..].as_chunks().0.iter().map(|&p| Point::from(p)));
            table.lines.push(line);
        } else {
            ended_early += usize::from(row(line, text, delimiter, length, table)?);
        }
    }
    Ok(ended_early)
}

/// Take in a row of data of a file of so many bytes; whether it ends early.
fn row(
    line: usize,
    text: &str,
    delimiter: Delimiter,
    length: u64,
    table: &mut Table,
) -> Result<bool, ReadError> {
    let fields = split_fields(text, delimiter);
    let coordinates = fields.get(2..).unwrap_or(&[]);
    let filled = coordinates.iter().rposition(|f| !f.is_empty()).map_or(0, |last| last + 1);
    let markers = table.labels.len().max(filled.div_ceil(3));
    let beyond = markers > table.labels.len();
    // Whole markers only, and no more positions than the file has bytes.
    let rows = table.lines.len() as u64 + 1;
    if fields.len() < 2 || (beyond && (filled % 3 != 0 || rows * markers as u64 > length)) {
        let markers = table.labels.len();
        return Err(ReadError::at_line(
            line,
            "row",
            format!("{} columns for {markers} markers ({})", fields.len(), 2 + 3 * markers),
            "complete the labels or the row",
        ));
    }
    if beyond {
        widen(table, markers);
    }
    let number = |index: usize| {
        coordinate(&fields[index], delimiter).ok_or_else(|| {
            ReadError::at_line(
                line,
                format!("column {}", index + 1),
                format!("\"{}\" is not a number", fields[index]),
                "write numbers with a decimal point, a missing one as blank",
            )
        })
    };
    table.frame_numbers.push(frame_number(number(0)?, &fields[0], line)?);
    table.times.push(number(1)?);
    for marker in 0..markers {
        let mut p = Point::UNSEEN;
        for axis in 0..3 {
            let index = 2 + 3 * marker + axis;
            if index < fields.len() {
                p[axis] = number(index)?;
            }
        }
        table.positions.push(p);
    }
    table.lines.push(line);
    Ok(coordinates.len() < 3 * markers)
}

/// Make room for markers that the labels do not name; the rows before have none of them.
fn widen(table: &mut Table, markers: usize) {
    let before = table.labels.len();
    table.labels.resize(markers, String::new());
    let mut positions = Vec::with_capacity((table.lines.len() + 1) * markers);
    for row in table.positions.chunks_exact(before) {
        positions.extend_from_slice(row);
        positions.resize(positions.len() + markers - before, Point::UNSEEN);
    }
    table.positions = positions;
}

/// The labels: every third field after frame and time; where delimiters are missing, all that is there.
fn labels_of(line: &str, delimiter: Delimiter) -> Vec<String> {
    if !line.contains(delimiter.char()) {
        return line.split_whitespace().skip(2).map(str::to_owned).collect();
    }
    let fields: Vec<&str> = line.split(delimiter.char()).map(str::trim).skip(2).collect();
    let third: Vec<&str> = fields.iter().step_by(3).copied().collect();
    let named = fields.iter().filter(|f| !f.is_empty());
    let used = third.iter().rposition(|f| !f.is_empty()).map_or(0, |last| last + 1);
    let in_thirds = third.iter().filter(|f| !f.is_empty()).count() == named.clone().count();
    if in_thirds {
        third[..used].iter().map(|f| (*f).to_owned()).collect()
    } else {
        named.map(|f| (*f).to_owned()).collect()
    }
}

/// Write TRC; `name` is the file's name as its first line says it. A missing marker is three
/// blanks. Reading it gives the same capture, bit for bit.
///
/// # Errors
/// [`WriteError::Label`] for a label with control characters, or blanks around it.
pub fn write_trc(capture: &Capture, name: &str) -> Result<String, WriteError> {
    let (frames, markers) = (capture.frames(), capture.labels.len());
    let (rate, unit, first) = (capture.rate_hz, capture.unit.symbol(), capture.first_frame);
    let name: String = name.chars().filter(|c| !c.is_control()).collect();
    let mut text = format!(
        "PathFileType\t4\t(X/Y/Z)\t{name}\n\
         DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n\
         {rate}\t{rate}\t{frames}\t{markers}\t{unit}\t{rate}\t{first}\t{frames}\nFrame#\tTime"
    );
    for (index, label) in capture.labels.iter().enumerate() {
        check_label(label)?;
        text.push_str(if index == 0 { "\t" } else { "\t\t\t" });
        text.push_str(label);
    }
    text.push_str("\t\t\n\t");
    for marker in 1..=markers {
        push(&mut text, format_args!("\tX{marker}\tY{marker}\tZ{marker}"));
    }
    text.push_str("\n\n");
    for frame in 0..frames {
        push(&mut text, format_args!("{}\t{}", first + frame as u64, frame as f64 / rate));
        for p in capture.frame(frame) {
            if p[0].is_nan() {
                text.push_str("\t\t\t");
            } else {
                push(&mut text, format_args!("\t{}\t{}\t{}", p[0], p[1], p[2]));
            }
        }
        text.push('\n');
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use crate::{LengthUnit, read_bytes};

    const HEAD: &str = "PathFileType\t4\t(X/Y/Z)\ta.trc\r\n\
        DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\r\n100\t100\t3\t3\tcm\r\n";

    #[test]
    fn crlf_blanks_short_rows_wrong_count_and_labels_with_blanks() {
        let text = format!(
            "{HEAD}Frame#\tTime\tleft brow\t\t\tnose\t\t\r\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\r\n\r\n\
             11\t0.00\t1\t2\t3\t4\t5\t6\r\n12\t0.01\t\t\t\t4\t5\t6\r\n13\t0.02\t1\t2\t3\r\n"
        );
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert_eq!(capture.labels, ["left brow", "nose"]);
        assert_eq!((capture.rate_hz, capture.first_frame), (100.0, 11));
        assert_eq!((capture.unit, capture.frames()), (LengthUnit::Centimetre, 3));
        assert_eq!(capture.frame(0), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert!(capture.frame(1)[0][0].is_nan() && capture.frame(2)[1][0].is_nan());
        assert_eq!(
            capture.notes,
            ["NumMarkers is 3, the labels are 2", "1 rows end early, the rest taken as missing"]
        );
    }

    #[test]
    fn labels_without_their_empty_columns_and_without_axes_line() {
        let text = format!("{HEAD}Frame#\tTime\ta\tb\tc\r\n1\t0\t1\t2\t3\t4\t5\t6\t7\t8\t9\r\n");
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert_eq!(capture.labels, ["a", "b", "c"]);
        assert_eq!(capture.frame(0)[2], [7.0, 8.0, 9.0]);
    }

    #[test]
    fn markers_beyond_the_labels_are_named_by_their_place() {
        let text = format!(
            "{HEAD}Frame#\tTime\ta\t\t\r\n\t\tX1\tY1\tZ1\r\n\
             1\t0\t1\t2\t3\t\t\t\r\n2\t0.01\t1\t2\t3\t4\t5\t6\r\n\
             3\t0.02\t1\t2\t3\t4\t5\t6\t7\t8\t9\r\n4\t0.03\t1\t2\t3\r\n"
        );
        let capture = read_bytes(text.as_bytes()).unwrap();
        assert_eq!(capture.labels, ["a", "M002", "M003"]);
        assert_eq!(capture.frame(2), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
        assert!(!capture.frame(0)[1].is_seen() && !capture.frame(1)[2].is_seen());
        assert_eq!(capture.frame(1)[1], [4.0, 5.0, 6.0]);
        assert!(!capture.frame(3)[1].is_seen());
        assert!(
            capture.notes.contains(
                &"the rows have 2 markers beyond the labels: named by their place".to_owned()
            ),
            "{:?}",
            capture.notes
        );
    }

    #[test]
    fn commas_in_the_place_of_tabs() {
        let tabs = format!(
            "{HEAD}Frame#\tTime\tleft brow\t\t\tnose\t\t\r\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\r\n\r\n\
             11\t0.00\t1\t2\t3\t4\t5\t6\r\n12\t0.01\t\t\t\t4\t5\t6.5\r\n"
        );
        let (commas, tabs) = (
            read_bytes(tabs.replace('\t', ",").as_bytes()).unwrap(),
            read_bytes(tabs.as_bytes()).unwrap(),
        );
        assert_eq!(commas.labels, ["left brow", "nose"]);
        assert_eq!((commas.labels, commas.rate_hz), (tabs.labels, tabs.rate_hz));
        assert_eq!(format!("{:?}", commas.positions), format!("{:?}", tabs.positions));
    }

    #[test]
    fn errors_name_the_line() {
        let rows = "Frame#\tTime\ta\t\t\r\n\t\tX1\tY1\tZ1\r\n1\t0\t1\t2\t3\t4\r\n";
        assert_eq!(
            read_bytes(format!("{HEAD}{rows}").as_bytes()).unwrap_err().to_string(),
            "line 6, row: 6 columns for 1 markers (5); complete the labels or the row"
        );
    }
}
