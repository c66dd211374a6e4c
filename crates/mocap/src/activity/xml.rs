//! XML of activities, walked element by element.

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::rows::Place;
use crate::ReadError;
use crate::formats::source::Source;

const REMEDY: &str = "export the activity again; the file may have been cut short";
/// Elements inside each other: what is deeper is no activity.
const DEEPEST: usize = 64;

/// A step of the walk. Names are without prefixes.
pub(super) enum Step<'a> {
    /// An element begins: the names from the root to it, and its attributes.
    Opened { path: &'a [String], attributes: &'a [(String, String)], byte: u64 },
    /// An element ends: the names from the root to it, and the characters that stand in it.
    Closed { path: &'a [String], text: &'a str, byte: u64 },
}

/// What is wrong at a byte.
pub(super) fn wrong(byte: u64, what: String, remedy: &'static str) -> ReadError {
    ReadError::at_byte(byte, "XML", what, remedy)
}

/// Walks through a document.
pub(super) fn walk(
    source: &mut dyn Source,
    mut each: impl FnMut(Step<'_>) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes).map_err(ReadError::Read)?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to() as u64;
        wrong(byte, "no UTF-8".to_owned(), "save the file as UTF-8")
    })?;
    let marks = text.len() - text.trim_start_matches('\u{feff}').len();
    let mut reader = Reader::from_str(&text[marks..]);
    let mut path: Vec<String> = Vec::new();
    let mut characters: Vec<String> = Vec::new();
    loop {
        let byte = marks as u64 + reader.buffer_position();
        let event = reader.read_event().map_err(|error| {
            wrong(marks as u64 + reader.error_position(), error.to_string(), REMEDY)
        })?;
        match event {
            Event::Start(tag) => {
                open(&mut path, &mut characters, &tag, byte, &mut each)?;
            }
            Event::Empty(tag) => {
                open(&mut path, &mut characters, &tag, byte, &mut each)?;
                close(&mut path, &mut characters, byte, &mut each)?;
            }
            Event::End(_) => close(&mut path, &mut characters, byte, &mut each)?,
            Event::Text(text) => {
                if let Some(own) = characters.last_mut() {
                    own.push_str(&text.xml10_content());
                }
            }
            Event::CData(text) => {
                if let Some(own) = characters.last_mut() {
                    own.push_str(&text.xml10_content());
                }
            }
            // No number is written by its letters' codes: what has one is none.
            Event::GeneralRef(_) => {
                if let Some(own) = characters.last_mut() {
                    own.push('&');
                }
            }
            Event::Eof => break,
            Event::Decl(_) | Event::PI(_) | Event::DocType(_) | Event::Comment(_) => {}
        }
    }
    match path.last() {
        None => Ok(()),
        Some(name) => Err(wrong(text.len() as u64, format!("{name} is not closed"), REMEDY)),
    }
}

fn open(
    path: &mut Vec<String>,
    characters: &mut Vec<String>,
    tag: &BytesStart<'_>,
    byte: u64,
    each: &mut impl FnMut(Step<'_>) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    if path.len() == DEEPEST {
        return Err(wrong(byte, format!("more than {DEEPEST} elements in each other"), REMEDY));
    }
    path.push(tag.local_name().as_ref().to_owned());
    characters.push(String::new());
    let mut attributes = Vec::new();
    for attribute in tag.attributes() {
        let attribute = attribute.map_err(|error| wrong(byte, error.to_string(), REMEDY))?;
        let value = attribute
            .normalized_value(XmlVersion::Implicit1_0)
            .map_err(|error| wrong(byte, error.to_string(), REMEDY))?;
        attributes.push((attribute.key.local_name().as_ref().to_owned(), value.into_owned()));
    }
    each(Step::Opened { path, attributes: &attributes, byte })
}

fn close(
    path: &mut Vec<String>,
    characters: &mut Vec<String>,
    byte: u64,
    each: &mut impl FnMut(Step<'_>) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let text = characters.pop().unwrap_or_default();
    each(Step::Closed { path, text: &text, byte })?;
    path.pop();
    Ok(())
}

/// A number that stands in an element.
pub(super) fn number(text: &str, name: &str, byte: u64) -> Result<f64, ReadError> {
    let value = text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| {
        wrong(byte, format!("{name} {:?} is no number", shortened(text)), "correct the number")
    })
}

/// An instant, s since 1970; without a zone it is taken for UTC.
pub(super) fn instant(text: &str, byte: u64) -> Result<f64, ReadError> {
    let text = text.trim();
    let zoned = text.parse::<jiff::Timestamp>().ok();
    let instant = zoned.or_else(|| {
        let local = text.parse::<jiff::civil::DateTime>().ok()?;
        jiff::tz::Offset::UTC.to_timestamp(local).ok()
    });
    instant.map(|instant| instant.as_nanosecond() as f64 / 1e9).ok_or_else(|| {
        let what = format!("time {:?} is none", shortened(text));
        wrong(byte, what, "write it as 2026-05-01T10:00:00Z")
    })
}

/// The place of an element.
pub(super) fn place(byte: u64) -> Place {
    Place::Byte(byte, "XML")
}

fn shortened(text: &str) -> String {
    text.chars().take(40).collect()
}
