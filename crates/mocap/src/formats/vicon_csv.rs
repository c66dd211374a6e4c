//! Vicon Nexus CSV: sections (`Trajectories`, `Devices`, `Joints`...), each with its rate, a line
//! of names, a line of axes, a line of units and rows. Separated by commas, semicolons or tabs.

use super::format::{Format, Read, Recognise};
use super::plausibility::shortened;
use super::text::{Delimiter, Lines, Row, Table, split_fields};
use crate::{LengthUnit, ReadError, ReadOptions, Recording};

const SECTIONS: [&str; 6] =
    ["Trajectories", "Devices", "Joints", "Model Outputs", "Segments", "Events"];

/// The name of the section that a line opens.
fn section(line: &str) -> Option<&'static str> {
    let title = line.trim_matches(|c: char| c.is_whitespace() || ",;\"".contains(c));
    SECTIONS.into_iter().find(|name| title.eq_ignore_ascii_case(name))
}

pub(super) static FORMAT: Format = Format {
    id: "vicon-csv",
    name: "Vicon CSV",
    extensions: &["csv"],
    recognised_by: "`Trajectories` and other sections",
    reads: "`,` `;` and tabs; only the trajectories",
    recognise: Recognise::FirstLine(is_first_line),
    read: Read::Text(read),
    write: None,
};

/// Whether a line is the first of such a file.
fn is_first_line(line: &str) -> bool {
    section(line).is_some()
}

/// The line that opens the trajectories.
fn title_line(lines: &mut Lines<'_>) -> Result<usize, ReadError> {
    while let Some((number, line)) = lines.next()? {
        if section(line) == Some("Trajectories") {
            return Ok(number);
        }
    }
    Err(ReadError::at_line(
        1,
        "sections",
        "no section Trajectories",
        "export the trajectories from Nexus",
    ))
}

/// Read the trajectories of the document.
fn read(lines: &mut Lines<'_>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let mut table = Table { system: Some("Vicon Nexus".to_owned()), ..Table::default() };
    let title_line = title_line(lines)?;
    let [(_, rate), (_, names), (axes_line, axes), (_, units)] = lines.header(title_line)?;
    let delimiter = Delimiter::of(&axes);
    table.declared_rate = rate
        .trim_matches(|c: char| c.is_whitespace() || ";,".contains(c))
        .replace(',', ".")
        .parse()
        .ok();

    let names = split_fields(&names, delimiter);
    let fields = split_fields(&axes, delimiter);
    // A marker is named over its X; velocities and accelerations have axes X', X''.
    let columns: Vec<usize> = (2..fields.len().saturating_sub(2))
        .filter(|&c| fields[c] == "X" && fields[c + 1] == "Y" && fields[c + 2] == "Z")
        .collect();
    if columns.is_empty() {
        return Err(ReadError::at_line(
            axes_line,
            "axes",
            "no columns X, Y, Z",
            "export the trajectories from Nexus",
        ));
    }
    let left_out: Vec<String> = (2..names.len().min(fields.len()))
        .filter(|c| !names[*c].is_empty() && !columns.contains(c))
        .map(|c| names[c].to_string())
        .collect();
    if !left_out.is_empty() {
        table.notes.push(format!("columns without X, Y and Z left out: {}", shortened(&left_out)));
    }
    let declared_width = fields.len();
    let width = columns.last().map_or(0, |last| last + 3);
    table.labels =
        columns.iter().map(|&c| names.get(c).map_or("", AsRef::as_ref).to_owned()).collect();
    let units = split_fields(&units, delimiter);
    table.declared_unit = units.get(columns[0]).and_then(|u| LengthUnit::from_name(u));

    let mut ended_early = 0_usize;
    while let Some((line, text)) = lines.next()? {
        if text.trim_matches(|c: char| c.is_whitespace() || ",;".contains(c)).is_empty() {
            continue;
        }
        // What follows is another section.
        if !text.trim_start_matches(['"', ' ']).starts_with(|c: char| c.is_ascii_digit()) {
            break;
        }
        let fields = split_fields(text, delimiter);
        if fields.iter().skip(declared_width).any(|field| !field.is_empty()) {
            return Err(ReadError::at_line(
                line,
                "row",
                format!("{} columns where the header has {declared_width}", fields.len()),
                "export the take again from Nexus",
            ));
        }
        ended_early += usize::from(fields.len() < width);
        let remedy = "export the take again from Nexus";
        let row = Row { line, fields: &fields, delimiter, remedy };
        table.frame_numbers.push(row.frame_number(0)?);
        for &column in &columns {
            table.positions.push(row.point([column, column + 1, column + 2])?);
        }
        table.lines.push(line);
    }
    if ended_early > 0 {
        table.notes.push(format!("{ended_early} rows end early, the rest taken as missing"));
    }
    table.finish(&FORMAT, options)
}

#[cfg(test)]
mod tests {
    use crate::{LengthUnit, read_bytes};

    #[test]
    fn commas_semicolons_and_other_sections_around() {
        let text = "Devices\n1000\n,,EMG\nFrame,Sub Frame,V\n,,mV\n1,0,0.5\n\n\
            Trajectories\n100\n,,S:brow,,,S:nose,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n\
            21,0,1.5,2,3,4,5,6\n22,0,,,,4,5,6\n23,0,1,2,3\n\nEvents\n1\n";
        let semicolons = text.replace(',', ";").replace('.', ",");
        for text in [text, &semicolons] {
            let capture = read_bytes(text.as_bytes()).unwrap();
            assert_eq!(capture.labels, ["S:brow", "S:nose"]);
            assert_eq!((capture.rate_hz, capture.first_frame), (100.0, 21));
            assert_eq!((capture.unit, capture.frames()), (LengthUnit::Millimetre, 3));
            assert_eq!(capture.frame(0), [[1.5, 2.0, 3.0], [4.0, 5.0, 6.0]]);
            assert!(capture.frame(1)[0][0].is_nan() && capture.frame(2)[1][0].is_nan());
        }
    }
}
