//! Weights as CSV: `frame,time,` then a column per shape, a row per frame.

use std::fmt::Write as _;
use std::path::Path;

use super::format::{Format, Read, Recognise, Write};
use super::text::{Delimiter, Lines, plain_row, split_fields};
use crate::{ReadError, WeightOptions, WeightsTable};

pub(super) static FORMAT: Format = Format {
    id: "weights-csv",
    name: "CSV (weights)",
    extensions: &["csv"],
    recognised_by: "`frame,` and columns that are no coordinates",
    reads: "what `solve` writes; `time` in seconds, or the rate that is asked for",
    recognise: Recognise::FirstLine(is_header),
    read: Read::TextWeights(read),
    write: Some(Write::Weights {
        columns: None,
        write: |table: &WeightsTable, path: &Path| {
            vec![(path.to_owned(), table.to_csv().into_bytes())]
        },
    }),
};

/// Whether a line is the header of weights: `frame,` and columns most of which are no coordinates, as
/// those of a landmark tracker are.
fn is_header(line: &str) -> bool {
    let columns = split_fields(line, Delimiter::Comma);
    let coordinates = columns.iter().filter(|name| is_coordinate(name.trim())).count();
    line.starts_with("frame,") && 2 * coordinates < columns.len()
}

/// Whether a column is named as a coordinate of something: `x_12`, `Z7`, `nose_x`, `nose.Y`.
fn is_coordinate(name: &str) -> bool {
    let is_axis = |c: char| matches!(c.to_ascii_lowercase(), 'x' | 'y' | 'z');
    let mut letters = name.chars();
    let numbered = letters.next().is_some_and(is_axis) && {
        let rest = letters.as_str();
        let number = rest.strip_prefix(['_', '.', '-']).unwrap_or(rest);
        number.chars().all(|c| c.is_ascii_digit())
    };
    let mut letters = name.chars().rev();
    let ends = letters.next().is_some_and(is_axis)
        && letters.next().is_some_and(|c| matches!(c, '_' | '.' | ':' | '-' | ' '));
    numbered || ends
}

/// Read the document.
fn read(lines: &mut Lines<'_>, options: &WeightOptions<'_>) -> Result<WeightsTable, ReadError> {
    let (header_line, header) = loop {
        match lines.next_filled()? {
            Some((_, line)) if line.starts_with('#') => {}
            found => break found.map_or((1, String::new()), |(n, line)| (n, line.to_owned())),
        }
    };
    let header: Vec<String> =
        split_fields(&header, Delimiter::Comma).into_iter().map(Into::into).collect();
    if header[0] != "frame" {
        let what = format!("first column {:?}", header[0]);
        return Err(wrong(header_line, "header", what, "open with frame,time,SHAPES"));
    }
    let timed = header.get(1).map(String::as_str) == Some("time");
    let first = if timed { 2 } else { 1 };
    let mut table =
        WeightsTable { shape_names: header[first..].to_vec(), ..WeightsTable::default() };
    check_names(&table.shape_names, header_line)?;
    let (mut values, mut lines_of_rows) = (Vec::new(), Vec::new());
    while let Some((line, text)) = lines.next_filled()? {
        if !plain_row(text, Delimiter::Comma, header.len(), &mut values)
            || values.iter().any(|v| v.is_nan())
        {
            careful_row(text, line, &header, &mut values)?;
        }
        if values[0] < 0.0 || values[0].fract() != 0.0 {
            let what = format!("frame {}", values[0]);
            return Err(wrong(line, "column 1 (frame)", what, "write the frame's number"));
        }
        in_order(&table, values[0], line)?;
        lines_of_rows.push(line);
        table.times.push(match (timed, options.rate_hz) {
            (true, _) => values[1],
            (false, rate_hz) => table.frames.len() as f64 / rate_hz.unwrap_or(1.0),
        });
        table.frames.push(values[0] as u64);
        table.weights.extend(&values[first..]);
    }
    if table.frames.is_empty() {
        let what = "no frame after the header";
        return Err(wrong(header_line, "data", what, "write the weights of every frame below it"));
    }
    if timed {
        evenly_timed(&table, &lines_of_rows)?;
    }
    Ok(table)
}

/// Refuses times that do not grow evenly, but for the rounding of printed ones.
fn evenly_timed(table: &WeightsTable, lines: &[usize]) -> Result<(), ReadError> {
    let Some(rate_hz) = table.rate_hz() else {
        return match lines {
            [] | [_] => Ok(()),
            [.., last] => {
                let what = "the times do not grow".to_owned();
                Err(wrong(*last, "column 2 (time)", what, "write the seconds of every frame"))
            }
        };
    };
    let off = |row: usize| table.times[row] - table.times[0] - row as f64 / rate_hz;
    match (0..lines.len()).find(|&row| off(row).abs() > 1.0 / rate_hz + 0.011) {
        None => Ok(()),
        Some(row) => {
            let what = format!(
                "{} s, not {:.3} as at an even rate",
                table.times[row],
                table.times[row] - off(row)
            );
            Err(wrong(
                lines[row],
                "column 2 (time)",
                what,
                "write the seconds of every frame, at one rate",
            ))
        }
    }
}

/// Refuses a frame that does not follow the one before: rows repeated, in disorder, or left out. Frames
/// may be numbered in steps.
fn in_order(table: &WeightsTable, number: f64, line: usize) -> Result<(), ReadError> {
    let Some(&before) = table.frames.last() else { return Ok(()) };
    let step = match table.frames[..] {
        [first, second, ..] => second - first,
        _ => (number - before as f64).max(1.0) as u64,
    };
    if number == (before + step) as f64 {
        return Ok(());
    }
    let what = format!("frame {number} after frame {before}, in steps of {step}");
    Err(wrong(line, "column 1 (frame)", what, "write every frame once, in order"))
}

/// Refuses a header without shapes, or with one twice.
fn check_names(names: &[String], line: usize) -> Result<(), ReadError> {
    if names.is_empty() {
        return Err(wrong(line, "header", "no shapes", "name the shapes after frame,time"));
    }
    match (0..names.len()).find(|&k| names[..k].contains(&names[k])) {
        Some(k) => {
            let what = format!("shape {:?} twice", names[k]);
            Err(wrong(line, "header", what, "give every shape one column"))
        }
        None => Ok(()),
    }
}

/// A row whose numbers are not plain ones, or which is wrong.
fn careful_row(
    text: &str,
    line: usize,
    header: &[String],
    values: &mut Vec<f64>,
) -> Result<(), ReadError> {
    let fields = split_fields(text, Delimiter::Comma);
    if fields.len() != header.len() {
        let what = format!("{} fields, the header has {}", fields.len(), header.len());
        return Err(wrong(line, "row", what, "write every column in every row"));
    }
    values.clear();
    for (k, field) in fields.iter().enumerate() {
        let value = field.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(|| {
            let section = format!("column {} ({})", k + 1, header[k]);
            wrong(line, section, format!("{field:?} is no number"), "write a decimal number")
        })?;
        values.push(value);
    }
    Ok(())
}

fn wrong(
    line: usize,
    section: impl Into<String>,
    what: impl Into<String>,
    remedy: &'static str,
) -> ReadError {
    ReadError::at_line(line, section, what, remedy)
}

impl WeightsTable {
    /// The table as CSV text. Numbers are the shortest that read back as the same f64.
    pub fn to_csv(&self) -> String {
        let mut out = String::from("frame,time");
        for name in &self.shape_names {
            out.push(',');
            if name.contains([',', '"', '\n']) || name.trim() != name {
                let _ = write!(out, "\"{}\"", name.replace('"', "\"\""));
            } else {
                out.push_str(name);
            }
        }
        out.push('\n');
        for (row, (frame, time)) in self.frames.iter().zip(&self.times).enumerate() {
            let _ = write!(out, "{frame},{time}");
            for w in self.row(row) {
                // Negative zero would read as a change.
                let _ = write!(out, ",{}", if *w == 0.0 { 0.0 } else { *w });
            }
            out.push('\n');
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use crate::{ReadError, WeightOptions, WeightsTable, read_weights};

    fn table() -> WeightsTable {
        let names = vec!["jawOpen".to_owned(), "odd, \"name\"".to_owned()];
        WeightsTable::at_rate(names, vec![0.1, -0.0, 1.0 / 3.0, 2e-17], 705, 200.0)
    }

    fn read(text: &str, rate_hz: Option<f64>) -> Result<WeightsTable, ReadError> {
        read_weights(text.as_bytes(), &WeightOptions { rate_hz, ..WeightOptions::default() })
    }

    #[test]
    fn landmarks_are_no_weights() {
        for header in [
            "frame,x_0,x_1,x_2,y_0,y_1,y_2",
            "frame,time,X0,Y0,Z0,X1,Y1,Z1",
            "frame,nose_x,nose_y,chin_x,chin_y",
            "frame,face_id,timestamp,x_0,y_0,x_1,y_1,x_2,y_2",
        ] {
            let row = vec!["1"; header.split(',').count()].join(",");
            let error = read(&format!("{header}\n{row}\n"), None).unwrap_err().to_string();
            assert!(error.starts_with("byte 0: no weights in a known format"), "{header}: {error}");
        }
        // Shapes may be called as an axis, as long as most are not.
        assert!(read("frame,time,jawOpen,jaw_x\n0,0,0.5,0.25\n", None).is_ok());
    }

    #[test]
    fn csv_reads_back_as_it_was_written() {
        let back = read(&table().to_csv(), None).unwrap();
        assert_eq!(back, table());
        assert_eq!(back.frames, [705, 706]);
        assert_eq!(back.rate_hz(), Some(200.0));
        assert_eq!(back.row(1), [1.0 / 3.0, 2e-17]);
    }

    #[test]
    fn csv_without_times_takes_the_rate() {
        let table = read("frame,a\n0,0.5\n1,1\n", Some(50.0)).unwrap();
        assert_eq!(table.times, [0.0, 0.02]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, line) in [
            ("frame,time\n", 1),
            ("frame,time,a,a\n", 1),
            ("frame,time,a\n0,0\n", 2),
            ("frame,time,a\n0,0,0\n1,0,x\n", 3),
            ("frame,time,a\n0,0,NaN\n", 2),
            ("frame,time,a\n0,0,\n", 2),
            ("frame,time,a\n-1,0,0\n", 2),
        ] {
            let error = read(text, None).unwrap_err().to_string();
            assert!(error.starts_with(&format!("line {line}, ")), "{text}: {error}");
        }
        for text in ["", "time,a\n"] {
            let error = read(text, None).unwrap_err().to_string();
            assert!(error.starts_with("byte 0: no weights in a known format"), "{text}: {error}");
        }
    }
}
