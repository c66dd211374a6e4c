//! Segments as a table: `label,first_frame,last_frame,expression_first,expression_last,start_s,end_s`.
//!
//! `last_frame` is the last one that is played. The first three columns are enough to read.

use std::borrow::Cow;
use std::fmt::Write as _;

use super::TakeSegment;

/// A table of segments that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}; {remedy}")]
pub struct SegmentFileError {
    /// Line, 1 = the header.
    pub line: usize,
    /// What is wrong, with the value.
    pub what: String,
    /// What to do.
    pub remedy: &'static str,
}

/// The table of segments at a rate. Reading it gives the same segments.
pub fn write_segments(segments: &[TakeSegment], rate_hz: f64) -> String {
    write_segments_with::<0>(segments, rate_hz, &[], &vec![[]; segments.len()])
}

/// The same with columns beside those of a segment, of which `beside` has the cells of each.
pub fn write_segments_with<const N: usize>(
    segments: &[TakeSegment],
    rate_hz: f64,
    names: &[&str; N],
    beside: &[[String; N]],
) -> String {
    let mut text =
        String::from("label,first_frame,last_frame,expression_first,expression_last,start_s,end_s");
    names.iter().for_each(|name| text.extend([",", name]));
    text.push('\n');
    for (TakeSegment { label, clip, expression }, beside) in segments.iter().zip(beside) {
        // Writing to a String does not fail.
        let _ = write!(
            text,
            "{},{},{},{},{},{},{}",
            quoted(label),
            clip.start,
            clip.end.saturating_sub(1),
            expression.start,
            expression.end.saturating_sub(1),
            clip.start as f64 / rate_hz,
            clip.end as f64 / rate_hz,
        );
        beside.iter().for_each(|cell| text.extend([",", &quoted(cell)]));
        text.push('\n');
    }
    text
}

/// A cell, in quotes where it needs them.
fn quoted(cell: &str) -> Cow<'_, str> {
    if cell.contains([',', '"', '\n', '\r']) || cell.trim() != cell {
        format!("\"{}\"", cell.replace('"', "\"\"")).into()
    } else {
        cell.into()
    }
}

/// Read the expressions of a table of segments: all rows but those of the neutral face.
///
/// # Errors
/// [`SegmentFileError`] with the line.
pub fn read_segments(text: &str) -> Result<Vec<TakeSegment>, SegmentFileError> {
    let mut segments = read_labelled_segments(text)?;
    segments.retain(|segment| !segment.is_neutral());
    Ok(segments)
}

/// Read a table of segments with all its rows: those of the neutral face and of transitions, too.
///
/// # Errors
/// [`SegmentFileError`] with the line.
pub fn read_labelled_segments(text: &str) -> Result<Vec<TakeSegment>, SegmentFileError> {
    let mut records = records(text.trim_start_matches('\u{feff}')).into_iter();
    let (_, header) = records.next().unwrap_or_default();
    let columns = Columns::of(header)?;
    let mut segments = Vec::new();
    for (line, row) in records {
        if row.iter().all(|field| field.trim().is_empty()) {
            continue;
        }
        segments.push(columns.segment(line, &row)?);
    }
    Ok(segments)
}

fn wrong(line: usize, what: String, remedy: &'static str) -> SegmentFileError {
    SegmentFileError { line, what, remedy }
}

/// Where the columns of a table stand.
struct Columns {
    header: Vec<String>,
    label: usize,
    first: usize,
    /// The last frame that is played.
    last: Option<usize>,
    /// The frame after it.
    end: Option<usize>,
    /// First and last frame of the expression.
    expression: Option<(usize, usize)>,
}

impl Columns {
    fn of(header: Vec<String>) -> Result<Self, SegmentFileError> {
        let column = |name: &str| header.iter().position(|h| h.trim() == name);
        let (Some(label), Some(first)) = (column("label"), column("first_frame")) else {
            let what = format!("columns {}", header.join(","));
            return Err(wrong(1, what, "open with label,first_frame,last_frame"));
        };
        let (last, end) = (column("last_frame"), column("end_frame"));
        if last.is_none() && end.is_none() {
            let what = "no column last_frame".to_owned();
            return Err(wrong(1, what, "open with label,first_frame,last_frame"));
        }
        let expression = column("expression_first").zip(column("expression_last"));
        Ok(Self { header, label, first, last, end, expression })
    }

    /// The label of a row; empty where it has none.
    fn label<'a>(&self, row: &'a [String]) -> &'a str {
        row.get(self.label).map_or("", |f| f.trim())
    }

    /// The frame that stands in a column.
    fn frame(&self, line: usize, row: &[String], column: usize) -> Result<usize, SegmentFileError> {
        let field = row.get(column).map_or("", |f| f.trim());
        field.parse::<usize>().ok().filter(|n| *n < usize::MAX).ok_or_else(|| {
            let what = format!("{}: {field:?} is no frame", self.header[column]);
            wrong(line, what, "write frames as whole numbers from 0 up")
        })
    }

    /// The segment of a row, whose frames follow each other.
    fn segment(&self, line: usize, row: &[String]) -> Result<TakeSegment, SegmentFileError> {
        let number = |column: usize| self.frame(line, row, column);
        let name = self.label(row);
        if name.is_empty() {
            return Err(wrong(line, "no label".to_owned(), "name every segment"));
        }
        let start = number(self.first)?;
        let stop = match (self.last, self.end) {
            (Some(last), _) => number(last)? + 1,
            (None, Some(end)) => number(end)?,
            (None, None) => start,
        };
        let expression = match self.expression {
            Some((a, b)) if row.get(a).is_some_and(|f| !f.trim().is_empty()) => {
                number(a)?..number(b)? + 1
            }
            _ => start..stop,
        };
        if start >= stop
            || expression.is_empty()
            || expression.start < start
            || expression.end > stop
        {
            let what = format!(
                "{name}: frames {start} to {}, expression {} to {}",
                stop.wrapping_sub(1) as isize,
                expression.start,
                expression.end.wrapping_sub(1) as isize,
            );
            return Err(wrong(
                line,
                what,
                "let the last frame follow the first, the expression within",
            ));
        }
        Ok(TakeSegment { label: name.to_owned(), clip: start..stop, expression })
    }
}

/// The rows of a CSV text with the line that each begins on; quoted fields may hold anything.
fn records(text: &str) -> Vec<(usize, Vec<String>)> {
    let mut rows = Vec::new();
    let mut row = vec![String::new()];
    let (mut line, mut begun, mut inside) = (1, 1, false);
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        if c == '\n' {
            line += 1;
        }
        match c {
            '"' if inside && characters.peek() == Some(&'"') => {
                characters.next();
                row.last_mut().unwrap_or(&mut String::new()).push('"');
            }
            '"' => inside = !inside,
            ',' if !inside => row.push(String::new()),
            '\n' if !inside => {
                rows.push((begun, std::mem::replace(&mut row, vec![String::new()])));
                begun = line;
            }
            '\r' if !inside => {}
            c => row.last_mut().unwrap_or(&mut String::new()).push(c),
        }
    }
    if row != [String::new()] {
        rows.push((begun, row));
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_reads_back_as_it_was_written() {
        let segments = [
            TakeSegment { label: "joy2".into(), clip: 10..90, expression: 20..80 },
            TakeSegment::new("odd, \"name\"\nof two lines", 100..101),
        ];
        let text = write_segments(&segments, 200.0);
        assert!(text.contains("joy2,10,89,20,79,0.05,0.45\n"), "{text}");
        assert_eq!(read_segments(&text).unwrap(), segments);
    }

    #[test]
    fn columns_beside_those_of_a_segment() {
        let segments = [TakeSegment::new("joy", 10..20), TakeSegment::new("a, b", 20..30)];
        let beside = [["0.5".to_owned(), "fear".to_owned()], [String::new(), "x,y".to_owned()]];
        let text = write_segments_with(&segments, 10.0, &["probability", "second"], &beside);
        let rows: Vec<&str> = text.lines().collect();
        assert!(rows[0].ends_with(",start_s,end_s,probability,second"));
        assert_eq!(rows[1], "joy,10,19,10,19,1,2,0.5,fear");
        assert_eq!(rows[2], "\"a, b\",20,29,20,29,2,3,,\"x,y\"");
        assert_eq!(read_segments(&text).unwrap(), segments);
    }

    #[test]
    fn three_columns_are_enough_and_neutral_is_left_out() {
        let text = "\u{feff}label,first_frame,last_frame\r\nN,0,79\r\nanger1,80,309\r\n\r\n";
        assert_eq!(read_segments(text).unwrap(), [TakeSegment::new("anger1", 80..310)]);
        let all = [TakeSegment::new("N", 0..80), TakeSegment::new("anger1", 80..310)];
        assert_eq!(read_labelled_segments(text).unwrap(), all);
        let text = "label,first_frame,end_frame\na,80,310\n";
        assert_eq!(read_segments(text).unwrap(), [TakeSegment::new("a", 80..310)]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, message) in [
            ("", "line 1: columns ; open with"),
            ("label,first_frame\n", "line 1: no column last_frame; open with"),
            ("label,first_frame,last_frame\na,1,5\nb,9,5\n", "line 3: b: frames 9 to 5"),
            ("label,first_frame,last_frame\na,1,x\n", "line 2: last_frame: \"x\" is no frame"),
            ("label,first_frame,last_frame\n,1,2\n", "line 2: no label; name every segment"),
        ] {
            let error = read_segments(text).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
