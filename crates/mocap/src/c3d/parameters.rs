//! The parameter section of a C3D file: groups of named values, in any order.

use super::header::{BLOCK, Header};
use super::number::Words;
use crate::ReadError;
use std::collections::HashMap;

const SECTION: &str = "parameter section";
const REMEDY: &str = "export the file again, its parameter section is damaged";

/// The type of a parameter's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Text,
    Byte,
    Word,
    Float,
}

/// One parameter: type, dimensions and where its values are.
#[derive(Debug)]
struct Parameter<'a> {
    kind: Kind,
    dimensions: Vec<usize>,
    values: Words<'a>,
}

/// All parameters, by group and name in capitals.
#[derive(Debug, Default)]
pub(crate) struct Parameters<'a> {
    by_name: HashMap<(String, String), Parameter<'a>>,
}

impl<'a> Parameters<'a> {
    /// Read the section; empty where the header names none.
    pub(crate) fn read(bytes: &'a [u8], header: &Header) -> Result<Self, ReadError> {
        let Some(start) = header.parameters_at else { return Ok(Self::default()) };
        let words = Words { bytes, processor: header.processor };
        // The block count is wrong in some files: the data bound the section too.
        let counted = start + usize::from(bytes[start + 2]) * BLOCK;
        let end = match header.data_at {
            data if data > start => counted.max(data),
            _ if counted > start => counted,
            _ => bytes.len(),
        }
        .min(bytes.len());

        let mut groups: HashMap<u8, String> = HashMap::new();
        let mut found: Vec<(u8, String, Parameter<'a>)> = Vec::new();
        let mut at = start + 4;
        while at + 2 <= end {
            let name_length = usize::from((bytes[at] as i8).unsigned_abs());
            let id = bytes[at + 1] as i8;
            if name_length == 0 || id == 0 {
                break;
            }
            let offset_at = at + 2 + name_length;
            let (Some(name), Some(offset)) = (bytes.get(at + 2..offset_at), words.u16(offset_at))
            else {
                return Err(ReadError::at_byte(
                    at,
                    SECTION,
                    format!("a name of {name_length} characters runs past the end of the file"),
                    REMEDY,
                ));
            };
            let name = text(name).to_ascii_uppercase();
            if id < 0 {
                groups.entry(id.unsigned_abs()).or_insert(name);
            } else {
                let parameter = parameter(words, offset_at + 2, &name)?;
                found.push((id.unsigned_abs(), name, parameter));
            }
            match offset {
                0 => break,
                1 => {
                    return Err(ReadError::at_byte(
                        offset_at,
                        SECTION,
                        "the next entry starts 1 byte on, inside this one",
                        REMEDY,
                    ));
                }
                _ => at = offset_at + usize::from(offset),
            }
        }
        let mut by_name = HashMap::with_capacity(found.len());
        for (group, name, parameter) in found {
            if let Some(group) = groups.get(&group) {
                by_name.entry((group.clone(), name)).or_insert(parameter);
            }
        }
        Ok(Self { by_name })
    }

    /// Whether there is none.
    pub(crate) fn is_empty(&self) -> bool {
        self.by_name.is_empty()
    }

    fn get(&self, group: &str, name: &str) -> Option<&Parameter<'a>> {
        self.by_name.get(&(group.to_owned(), name.to_owned()))
    }

    /// All values as numbers; words are taken without sign, as counts are. Empty where absent.
    pub(crate) fn numbers(&self, group: &str, name: &str) -> Vec<f64> {
        let Some(parameter) = self.get(group, name) else { return Vec::new() };
        let values = parameter.values;
        match parameter.kind {
            Kind::Text => Vec::new(),
            Kind::Byte => values.bytes.iter().map(|&b| f64::from(b)).collect(),
            Kind::Word => (0..values.bytes.len() / 2)
                .filter_map(|i| values.u16(2 * i).map(f64::from))
                .collect(),
            Kind::Float => (0..values.bytes.len() / 4)
                .filter_map(|i| values.f32(4 * i).map(f64::from))
                .collect(),
        }
    }

    /// The first value as a number.
    pub(crate) fn number(&self, group: &str, name: &str) -> Option<f64> {
        self.numbers(group, name).first().copied()
    }

    /// The first value as a count.
    pub(crate) fn count(&self, group: &str, name: &str) -> Option<u64> {
        // 2^32: no C3D counts further; `as` after the bound is exact.
        self.number(group, name).filter(|n| (0.0..4_294_967_296.0).contains(n)).map(|n| n as u64)
    }

    /// The strings of a parameter, blanks and NULs trimmed. Empty where absent.
    pub(crate) fn strings(&self, group: &str, name: &str) -> Vec<String> {
        let Some(parameter) = self.get(group, name) else { return Vec::new() };
        if parameter.kind != Kind::Text {
            return Vec::new();
        }
        let length = match parameter.dimensions.first() {
            None => 1,
            Some(&length) => length,
        };
        if length == 0 {
            return Vec::new();
        }
        parameter.values.bytes.chunks(length).map(text).collect()
    }

    /// The strings of a parameter and of its continuations: `LABELS`, `LABELS2`, `LABELS3`...
    pub(crate) fn strings_continued(&self, group: &str, name: &str) -> Vec<String> {
        let mut all = self.strings(group, name);
        for part in 2.. {
            let more = self.strings(group, &format!("{name}{part}"));
            if more.is_empty() {
                break;
            }
            all.extend(more);
        }
        all
    }
}

/// Decode a parameter's type, dimensions and values at a byte offset.
fn parameter<'a>(words: Words<'a>, at: usize, name: &str) -> Result<Parameter<'a>, ReadError> {
    let damaged = |what: String| ReadError::at_byte(at, SECTION, what, REMEDY);
    let bytes: &'a [u8] = words.bytes;
    let (Some(&kind), Some(&rank)) = (bytes.get(at), bytes.get(at + 1)) else {
        return Err(damaged(format!("{name} runs past the end of the file")));
    };
    let (kind, size) = match kind as i8 {
        -1 => (Kind::Text, 1),
        1 => (Kind::Byte, 1),
        2 => (Kind::Word, 2),
        4 => (Kind::Float, 4),
        other => {
            return Err(damaged(format!("{name} is of type {other}, not -1, 1, 2 or 4")));
        }
    };
    let values_at = at + 2 + usize::from(rank);
    let Some(dimensions) = bytes.get(at + 2..values_at) else {
        return Err(damaged(format!("{name} has {rank} dimensions, past the end of the file")));
    };
    let dimensions: Vec<usize> = dimensions.iter().map(|&d| usize::from(d)).collect();
    let length = dimensions.iter().fold(size, |n: usize, &d| n.saturating_mul(d));
    let Some(values) = bytes.get(values_at..values_at.saturating_add(length)) else {
        return Err(damaged(format!(
            "{name} holds {length} bytes of values, past the end of the file"
        )));
    };
    Ok(Parameter { kind, dimensions, values: Words { bytes: values, processor: words.processor } })
}

/// Text without trailing NULs and blanks; UTF-8, else Latin-1.
fn text(bytes: &[u8]) -> String {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    };
    text.trim_matches(|c: char| c == '\0' || c.is_whitespace()).to_owned()
}
