//! CSV of programs that track a face in a video: a row per frame, a column per shape or action unit
//! among columns of other things.

pub(super) mod mediapipe;
pub(super) mod openface;
pub(super) mod py_feat;

use std::borrow::Cow;

use super::text::{Delimiter, Lines, Row, split_fields};
use super::weight_rows::{Place, WeightRow, WeightRows};
use crate::{ReadError, WeightOptions, WeightsTable};

const REMEDY: &str = "export the take again, or correct the row";

/// Which columns a file has.
#[derive(Debug, Default, PartialEq)]
struct Columns {
    /// Number of the frame.
    frame: Option<usize>,
    /// Time, and how many seconds one of its units is.
    time: Option<(usize, f64)>,
    /// Which face a row is of.
    face: Option<usize>,
    /// Whether the face was found: 0 where it was not.
    found: Option<usize>,
    /// Weights, each with its name.
    weights: Vec<(usize, String)>,
    /// What a weight of 1 is in the file.
    whole: f64,
    /// Whether rows may lack all weights, where no face was found.
    may_be_blank: bool,
}

/// The fields of a header's line as they name columns.
fn header_fields(line: &str) -> Vec<Cow<'_, str>> {
    split_fields(line, Delimiter::of(line))
}

/// Where a column of that name stands, in any case.
fn position(fields: &[Cow<'_, str>], name: &str) -> Option<usize> {
    fields.iter().position(|field| field.eq_ignore_ascii_case(name))
}

/// Time, under the first of these names that there is, and how many seconds one of its units is.
fn time_column(fields: &[Cow<'_, str>], names: &[(&str, f64)]) -> Option<(usize, f64)> {
    names.iter().find_map(|(name, seconds)| Some((position(fields, name)?, *seconds)))
}

/// Reads the document; `columns` finds them in the header, `notes` is what is worth saying of them.
fn read(
    lines: &mut Lines<'_>,
    options: &WeightOptions<'_>,
    columns: fn(&[Cow<'_, str>]) -> Columns,
    notes: fn(&[String]) -> Vec<String>,
) -> Result<WeightsTable, ReadError> {
    let (header_line, header) = loop {
        match lines.next_filled()? {
            Some((_, line)) if line.starts_with('#') => {}
            found => break found.map_or((1, String::new()), |(n, line)| (n, line.to_owned())),
        }
    };
    let delimiter = Delimiter::of(&header);
    let fields = split_fields(&header, delimiter);
    let columns = columns(&fields);
    let names = columns.weights.iter().map(|(_, name)| name.clone()).collect();
    let mut rows = WeightRows::new(names, Place::Line(header_line))?;
    for note in notes(rows.names()) {
        rows.note(note);
    }
    let mut first_face = None;
    let mut weights = Vec::with_capacity(columns.weights.len());
    while let Some((line, text)) = lines.next_filled()? {
        let cells = split_fields(text, delimiter);
        let row = Row { line, fields: &cells, delimiter, remedy: REMEDY };
        row.of_width(fields.len())?;
        one_face(&row, &columns, &fields, &mut first_face)?;
        let number = columns.frame.map(|column| row.frame_number(column)).transpose()?;
        let time_s = match columns.time {
            None => None,
            Some((column, seconds)) => Some(finite(&row, column, &fields)? * seconds),
        };
        let found = match columns.found {
            None => true,
            Some(column) => finite(&row, column, &fields)? != 0.0,
        };
        let found = found && cells_of(&row, &columns, &fields, &mut weights)?;
        let weights = found.then_some(&weights[..]);
        rows.push(WeightRow { place: Place::Line(line), number, time_s, weights })?;
    }
    if rows.is_empty() {
        let what = "no frame after the header";
        return Err(ReadError::at_line(header_line, "data", what, "export the take again"));
    }
    rows.finish(options)
}

/// The weights of a row; `false` where it has none.
fn cells_of(
    row: &Row<'_>,
    columns: &Columns,
    fields: &[Cow<'_, str>],
    weights: &mut Vec<f64>,
) -> Result<bool, ReadError> {
    weights.clear();
    for &(column, _) in &columns.weights {
        weights.push(row.number(column)? / columns.whole);
    }
    if columns.may_be_blank && weights.iter().all(|w| w.is_nan()) {
        return Ok(false);
    }
    match weights.iter().position(|w| !w.is_finite()) {
        None => Ok(true),
        Some(k) => Err(no_number(row, columns.weights[k].0, fields)),
    }
}

/// The number of a cell, which is there and finite.
fn finite(row: &Row<'_>, column: usize, fields: &[Cow<'_, str>]) -> Result<f64, ReadError> {
    let value = row.number(column)?;
    if value.is_finite() { Ok(value) } else { Err(no_number(row, column, fields)) }
}

fn no_number(row: &Row<'_>, column: usize, fields: &[Cow<'_, str>]) -> ReadError {
    let section = format!("column {} ({})", column + 1, fields[column]);
    ReadError::at_line(row.line, section, format!("\"{}\" is no number", row.text(column)), REMEDY)
}

/// Refuses a second face: which of them is meant, only the user knows.
fn one_face(
    row: &Row<'_>,
    columns: &Columns,
    fields: &[Cow<'_, str>],
    first: &mut Option<f64>,
) -> Result<(), ReadError> {
    let Some(column) = columns.face else { return Ok(()) };
    let face = finite(row, column, fields)?;
    if *first.get_or_insert(face) == face {
        return Ok(());
    }
    let section = format!("column {} ({})", column + 1, fields[column]);
    let what = format!("face {face} after face {}", first.unwrap_or_default());
    Err(ReadError::at_line(
        row.line,
        section,
        what,
        "keep the rows of one face, and remove the others",
    ))
}
