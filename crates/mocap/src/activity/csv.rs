//! Activities as CSV: `time` in seconds and one or more of `power_w`, `work`, `speed`, `grade`, `heart_rate`.
//!
//! Separated by commas, semicolons (decimal commas allowed) or tabs; lines that start with `#` are comments;
//! a blank is a missing value.

use super::rows::{Place, Rows, Sample};
use super::{Activity, ActivityColumn, ActivityFormat, Read, Recognise};
use crate::ReadError;
use crate::formats::text::{Delimiter, Lines, Row, split_fields};

pub(super) static FORMAT: ActivityFormat = ActivityFormat {
    id: "activity-csv",
    name: "CSV (activity)",
    recognised_by: "`time` and `power_w`, `work`, `speed` or `heart_rate`",
    reads: "`time` in seconds; `power_w`; `work` (J/kg of the second that ends there); `speed` (m/s), `grade` \
            (rise over run); `heart_rate`",
    recognise: Recognise::FirstLine(is_header),
    read: Read::Text(read),
};

const REMEDY: &str = "write numbers with a decimal point, a missing one as blank";

/// Whether a line is the header of such a file.
fn is_header(line: &str) -> bool {
    let fields = split_fields(line, Delimiter::of(line));
    let names: Vec<String> = fields.iter().map(|name| name.to_ascii_lowercase()).collect();
    let known = |column: ActivityColumn| names.iter().any(|name| name == column.name());
    names.first().is_some_and(|name| name == "time")
        && ActivityColumn::ALL.into_iter().any(|c| c != ActivityColumn::Grade && known(c))
}

fn read(lines: &mut Lines<'_>) -> Result<Activity, ReadError> {
    let (header_line, header) = loop {
        match lines.next_filled()? {
            Some((_, line)) if line.starts_with('#') => {}
            found => break found.map_or((1, String::new()), |(n, line)| (n, line.to_owned())),
        }
    };
    let delimiter = Delimiter::of(&header);
    let names: Vec<String> =
        split_fields(&header, delimiter).iter().map(|name| name.to_ascii_lowercase()).collect();
    let mut rows = Rows::default();
    let columns = columns(&names, header_line, &mut rows.notes)?;
    while let Some((line, text)) = lines.next_filled()? {
        if text.starts_with('#') {
            continue;
        }
        let fields = split_fields(text, delimiter);
        let row = Row { line, fields: &fields, delimiter, remedy: REMEDY };
        row.of_width(names.len())?;
        let time = row.number(0)?;
        let place = Place::Line(line);
        if time.is_nan() {
            let what = format!("{:?} is no time", row.text(0));
            return Err(place.error("column 1 (time)", what, "write the seconds of every sample"));
        }
        let mut sample = Sample::at(place, time);
        for &(index, column) in &columns {
            let value = row.number(index)?;
            let [least, most] = column.range();
            if !value.is_nan() && !(least..=most).contains(&value) {
                let section = format!("column {} ({})", index + 1, column.name());
                let what =
                    format!("{value}, where people have {least} to {most} {}", column.unit());
                return Err(place.error(&section, what, "correct the value, or its unit"));
            }
            sample.set(column, value);
        }
        if rows.samples.last().is_some_and(|before| before.time_s == time) {
            let what = format!("{time} s twice");
            return Err(place.error(
                "column 1 (time)",
                what,
                "give one recording, its times increasing",
            ));
        }
        rows.push(sample)?;
    }
    if rows.samples.is_empty() {
        let what = "no sample after the header";
        return Err(ReadError::at_line(header_line, "data", what, "write a row for every sample"));
    }
    rows.finish(&FORMAT)
}

/// Which columns hold what.
fn columns(
    names: &[String],
    line: usize,
    notes: &mut Vec<String>,
) -> Result<Vec<(usize, ActivityColumn)>, ReadError> {
    let mut columns: Vec<(usize, ActivityColumn)> = Vec::new();
    let mut ignored = Vec::new();
    for (index, name) in names.iter().enumerate().skip(1) {
        match ActivityColumn::ALL.into_iter().find(|column| column.name() == name) {
            Some(column) if columns.iter().any(|(_, own)| *own == column) => {
                let what = format!("column {name} twice");
                return Err(ReadError::at_line(line, "header", what, "give every column once"));
            }
            Some(column) => columns.push((index, column)),
            None => ignored.push(name.as_str()),
        }
    }
    if !ignored.is_empty() {
        let shown: Vec<&str> = ignored.iter().take(5).copied().collect();
        let more = if ignored.len() > shown.len() { ", ..." } else { "" };
        notes.push(format!("columns ignored: {}{more}", shown.join(", ")));
    }
    Ok(columns)
}

#[cfg(test)]
mod tests {
    use crate::{ActivityColumn, read_activity_bytes, recognise_activity};

    #[test]
    fn columns_of_every_kind_in_any_order() {
        let text =
            "# a ride\ntime;heart_rate;cadence;power_w\n10;91;80;0\n11,5;92,5;81;\n13;;80;150\n";
        let activity = read_activity_bytes(text.as_bytes()).unwrap();
        assert_eq!(activity.time_s, [0.0, 1.5, 3.0]);
        let column = |column| activity.column(column).unwrap();
        assert_eq!(column(ActivityColumn::HeartRate)[..2], [91.0, 92.5]);
        assert!(column(ActivityColumn::HeartRate)[2].is_nan());
        assert_eq!(column(ActivityColumn::PowerW)[2], 150.0);
        assert!(activity.column(ActivityColumn::Speed).is_none());
        assert_eq!(activity.notes, ["columns ignored: cadence"]);
    }

    #[test]
    fn what_is_no_activity_is_not_taken_for_one() {
        for text in ["time,x\n", "frame,time,power_w\n", "time,grade\n", "", "power_w,time\n"] {
            assert_eq!(recognise_activity(text.as_bytes()), None, "{text:?}");
        }
        let refused = read_activity_bytes(b"frame,time\n").unwrap_err().to_string();
        assert!(
            refused.starts_with("byte 0: no activity in a known format, it starts with"),
            "{refused}"
        );
    }

    #[test]
    fn errors_name_line_column_value_and_remedy() {
        for (rows, expected) in [
            ("0,1\nx,2\n", "line 3, column 1: \"x\" is not a number; write numbers"),
            ("0,1\n,2\n", "line 3, column 1 (time): \"\" is no time; write the seconds"),
            ("0,1\n0,2\n", "line 3, column 1 (time): 0 s twice; give one recording"),
            ("5,1\n4,2\n", "line 3, time: 1 s before the sample before it; give one recording"),
            ("0,-1\n", "line 2, column 2 (power_w): -1, where people have 0 to 3000 W; correct"),
            ("0,1,2\n", "line 2, row: 3 columns where the header has 2; complete"),
            ("0\n", "line 2, row: 1 columns where the header has 2; complete"),
            ("", "line 1, data: no sample after the header; write a row"),
            ("0,\n1,\n", "line 2, data: no sample has power, work, speed or a heart rate; export"),
        ] {
            let said = read_activity_bytes(format!("time,power_w\n{rows}").as_bytes()).unwrap_err();
            assert!(said.to_string().starts_with(expected), "{said}");
        }
        let twice = read_activity_bytes(b"time,work,work\n0,1,1\n").unwrap_err().to_string();
        assert!(twice.starts_with("line 1, header: column work twice; "), "{twice}");
    }
}
