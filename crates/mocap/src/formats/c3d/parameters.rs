//! The parameter section of a C3D file: groups of named values, in any order.

use super::header::{BLOCK, Header};
use super::number::{Processor, Words};
use crate::ReadError;
use crate::formats::source::Prefix;
use std::collections::HashMap;
use std::ops::Range;

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
struct Parameter {
    kind: Kind,
    dimensions: Vec<usize>,
    /// Bytes of the file.
    values: Range<usize>,
}

/// All parameters, by group and name in capitals.
#[derive(Debug)]
pub(crate) struct Parameters {
    /// The file as far as the last of them.
    bytes: Vec<u8>,
    processor: Processor,
    by_name: HashMap<(String, String), Parameter>,
}

impl Parameters {
    /// Read the section; empty where the header names none.
    pub(crate) fn read(mut file: Prefix<'_>, header: &Header) -> Result<Self, ReadError> {
        let processor = header.processor;
        let Some((start, end)) = section(&mut file, header)? else {
            return Ok(Self { bytes: Vec::new(), processor, by_name: HashMap::new() });
        };
        let mut groups: HashMap<u8, String> = HashMap::new();
        let mut found: Vec<(u8, String, Parameter)> = Vec::new();
        let mut at = start + 4;
        while at as u64 + 2 <= end {
            let Some(&[name_length, id]) = file.get(at..at + 2)? else { break };
            let (name_length, id) = (usize::from((name_length as i8).unsigned_abs()), id as i8);
            if name_length == 0 || id == 0 {
                break;
            }
            let offset_at = at + 2 + name_length;
            let Some([name @ .., a, b]) = file.get(at + 2..offset_at + 2)? else {
                return Err(ReadError::at_byte(
                    at as u64,
                    SECTION,
                    format!("a name of {name_length} characters runs past the end of the file"),
                    REMEDY,
                ));
            };
            let offset = processor.u16([*a, *b]);
            let name = text(name).to_ascii_uppercase();
            if id < 0 {
                groups.entry(id.unsigned_abs()).or_insert(name);
            } else {
                let parameter = parameter(&mut file, offset_at + 2, &name)?;
                found.push((id.unsigned_abs(), name, parameter));
            }
            match offset {
                0 => break,
                1 => {
                    return Err(ReadError::at_byte(
                        offset_at as u64,
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
        Ok(Self { bytes: file.into_bytes(), processor, by_name })
    }

    /// Whether there is none.
    pub(crate) fn is_empty(&self) -> bool {
        self.by_name.is_empty()
    }

    fn get(&self, group: &str, name: &str) -> Option<(&Parameter, Words<'_>)> {
        let parameter = self.by_name.get(&(group.to_owned(), name.to_owned()))?;
        let bytes = self.bytes.get(parameter.values.clone()).unwrap_or(&[]);
        Some((parameter, Words { bytes, processor: self.processor }))
    }

    /// All values as numbers; words are taken without sign, as counts are. Empty where absent.
    pub(crate) fn numbers(&self, group: &str, name: &str) -> Vec<f64> {
        let Some((parameter, values)) = self.get(group, name) else { return Vec::new() };
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
        let Some((parameter, values)) = self.get(group, name) else { return Vec::new() };
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
        values.bytes.chunks(length).map(text).collect()
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

/// Where the section begins and ends in the file; `None` where there is none.
fn section(file: &mut Prefix<'_>, header: &Header) -> Result<Option<(usize, u64)>, ReadError> {
    let Some(start) = header.parameters_at else { return Ok(None) };
    let Some(head) = file.get(start..start + 4)? else { return Ok(None) };
    // The block count is wrong in some files: the data bound the section too.
    let counted = start + usize::from(head[2]) * BLOCK;
    let end = match header.data_at {
        data if data > start => counted.max(data) as u64,
        _ if counted > start => counted as u64,
        _ => file.length(),
    };
    Ok(Some((start, end.min(file.length()))))
}

/// Decode a parameter's type and dimensions at a byte offset, and find its values.
fn parameter(file: &mut Prefix<'_>, at: usize, name: &str) -> Result<Parameter, ReadError> {
    let damaged = |what: String| ReadError::at_byte(at as u64, SECTION, what, REMEDY);
    let Some(&[kind, rank]) = file.get(at..at + 2)? else {
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
    let Some(dimensions) = file.get(at + 2..values_at)? else {
        return Err(damaged(format!("{name} has {rank} dimensions, past the end of the file")));
    };
    let dimensions: Vec<usize> = dimensions.iter().map(|&d| usize::from(d)).collect();
    let length = dimensions.iter().fold(size, |n: usize, &d| n.saturating_mul(d));
    let values = values_at..values_at.saturating_add(length);
    if file.get(values.clone())?.is_none() {
        return Err(damaged(format!(
            "{name} holds {length} bytes of values, past the end of the file"
        )));
    }
    Ok(Parameter { kind, dimensions, values })
}

/// Text without trailing NULs and blanks; UTF-8, else Latin-1.
fn text(bytes: &[u8]) -> String {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    };
    text.trim_matches(|c: char| c == '\0' || c.is_whitespace()).to_owned()
}
