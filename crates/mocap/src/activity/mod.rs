//! What a sports watch, a bicycle computer or a laboratory records of an activity: power, work, speed, grade
//! and heart rate over time. Like captures, files are known by their content.

mod csv;
mod fit;
mod gpx;
mod rows;
mod tcx;
mod track;
mod xml;

use std::path::Path;

use crate::ReadError;
use crate::formats::source::{self, Source};
use crate::formats::text::{Lines, TextForm};

/// Something that is recorded of an activity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ActivityColumn {
    /// Power on a bicycle, W.
    PowerW,
    /// Mechanical work of the second that ends there, J/kg.
    Work,
    /// Speed on foot, m/s.
    Speed,
    /// Rise over run.
    Grade,
    /// Beats per minute.
    HeartRate,
}

impl ActivityColumn {
    /// How many there are.
    pub const COUNT: usize = 5;

    /// All of them.
    pub const ALL: [Self; Self::COUNT] =
        [Self::PowerW, Self::Work, Self::Speed, Self::Grade, Self::HeartRate];

    /// The name of the column in a CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::PowerW => "power_w",
            Self::Work => "work",
            Self::Speed => "speed",
            Self::Grade => "grade",
            Self::HeartRate => "heart_rate",
        }
    }

    /// The unit, in words.
    pub fn unit(self) -> &'static str {
        match self {
            Self::PowerW => "W",
            Self::Work => "J/kg in a second",
            Self::Speed => "m/s",
            Self::Grade => "(rise over run: 0.05 is 5 %)",
            Self::HeartRate => "beats per minute",
        }
    }

    /// The least and the most that people do.
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::PowerW => [0.0, 3000.0],
            Self::Work => [0.0, 1000.0],
            Self::Speed => [0.0, 15.0],
            Self::Grade => [-1.0, 1.0],
            Self::HeartRate => [25.0, 250.0],
        }
    }
}

/// What somebody did, where the file says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sport {
    /// On a bicycle.
    Cycling,
    /// Walking or running.
    OnFoot,
}

/// A recorded activity.
#[derive(Debug, Clone, PartialEq)]
pub struct Activity {
    /// Seconds since the first sample, increasing.
    pub time_s: Vec<f64>,
    columns: [Option<Vec<f64>>; ActivityColumn::COUNT],
    /// What it was.
    pub sport: Option<Sport>,
    /// The format of the file.
    pub format: &'static ActivityFormat,
    /// What the reader found worth saying.
    pub notes: Vec<String>,
}

impl Activity {
    /// A column, a number a sample: NaN where nothing was recorded. `None` where the file has no such column.
    pub fn column(&self, column: ActivityColumn) -> Option<&[f64]> {
        self.columns[column as usize].as_deref()
    }
}

/// A file format of activities.
pub struct ActivityFormat {
    /// Short name; its samples are `seed-ID-...` in `fuzz/corpus/activity`.
    pub id: &'static str,
    /// The name that people use.
    pub name: &'static str,
    /// What its files are recognised by, in words for the documentation.
    pub recognised_by: &'static str,
    /// What its reader takes, in words for the documentation.
    pub reads: &'static str,
    recognise: Recognise,
    read: Read,
}

/// How a format is recognised.
enum Recognise {
    /// By the first 512 bytes.
    Beginning(fn(&[u8]) -> bool),
    /// By the first line that is neither blank nor a comment.
    FirstLine(fn(&str) -> bool),
}

/// A reader.
enum Read {
    Bytes(fn(&mut dyn Source) -> Result<Activity, ReadError>),
    Text(fn(&mut Lines<'_>) -> Result<Activity, ReadError>),
}

impl PartialEq for ActivityFormat {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for ActivityFormat {}

impl std::fmt::Debug for ActivityFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ActivityFormat").field("id", &self.id).finish_non_exhaustive()
    }
}

static FORMATS: [&ActivityFormat; 4] = [&fit::FORMAT, &tcx::FORMAT, &gpx::FORMAT, &csv::FORMAT];

/// Every format of activities that is read.
pub fn activity_formats() -> &'static [&'static ActivityFormat] {
    &FORMATS
}

/// The format of an activity, or `None` for another file.
pub fn recognise_activity(bytes: &[u8]) -> Option<&'static ActivityFormat> {
    recognised(&mut std::io::Cursor::new(bytes)).ok()?.map(|(format, _)| format)
}

/// Whether a file is of an activity.
///
/// # Errors
/// [`ReadError::Open`], [`ReadError::Read`].
pub fn is_activity(path: &Path) -> Result<bool, ReadError> {
    Ok(recognised(&mut *source::open(path)?)?.is_some())
}

/// Reads a file of an activity.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_activity(path: &Path) -> Result<Activity, ReadError> {
    of_source(&mut *source::open(path)?)
}

/// Reads an activity from bytes.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_activity_bytes(bytes: &[u8]) -> Result<Activity, ReadError> {
    of_source(&mut std::io::Cursor::new(bytes))
}

fn of_source(source: &mut dyn Source) -> Result<Activity, ReadError> {
    match recognised(&mut *source)? {
        Some((ActivityFormat { read: Read::Bytes(read), .. }, _)) => {
            source.rewind().map_err(ReadError::Read)?;
            read(source)
        }
        Some((ActivityFormat { read: Read::Text(read), .. }, form)) => {
            read(&mut Lines::new(source, form)?)
        }
        None => {
            let found = source::shown_beginning(source)?;
            let readable = FORMATS.iter().map(|format| format.name).collect();
            Err(ReadError::NotActivity { found, readable })
        }
    }
}

/// The format and, of a text, its form.
fn recognised(
    source: &mut dyn Source,
) -> Result<Option<(&'static ActivityFormat, TextForm)>, ReadError> {
    let beginning = source::beginning(&mut *source, 512)?;
    let by_beginning = FORMATS
        .iter()
        .copied()
        .find(|format| matches!(format.recognise, Recognise::Beginning(is) if is(&beginning)));
    if let Some(format) = by_beginning {
        return Ok(Some((format, TextForm::default())));
    }
    let form = TextForm::of(&mut *source)?;
    let mut lines = Lines::new(source, form)?;
    loop {
        match lines.next_filled() {
            Ok(Some((_, line))) if line.starts_with('#') => {}
            Ok(Some((_, line))) => {
                let by_line = FORMATS.iter().copied().find(
                    |format| matches!(format.recognise, Recognise::FirstLine(is) if is(line)),
                );
                return Ok(by_line.map(|format| (format, form)));
            }
            // What has no end of a line for megabytes is no text.
            Ok(None) | Err(ReadError::Text { .. }) => return Ok(None),
            Err(error) => return Err(error),
        }
    }
}
