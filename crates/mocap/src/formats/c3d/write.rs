//! A capture as a C3D file, for any processor and either storage.

use super::header::BLOCK;
use super::number::Processor;
use crate::{Capture, WriteError};

/// How coordinates are stored.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum C3dStorage {
    /// 32-bit floats.
    #[default]
    Float,
    /// 16-bit integers times `scale`, in the capture's unit: steps of `scale`, to 32767 of them.
    Integer {
        /// Length of one step.
        scale: f32,
    },
}

/// How a C3D file is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct C3dOptions {
    /// Byte order and floats.
    pub processor: Processor,
    /// Storage of coordinates.
    pub storage: C3dStorage,
}

impl Default for C3dOptions {
    fn default() -> Self {
        Self { processor: Processor::Intel, storage: C3dStorage::Float }
    }
}

/// Labels in one parameter; more go to `LABELS2`, `LABELS3`...
const LABELS_A_PARAMETER: usize = 255;
/// Bytes of labels in one parameter: offsets are read as signed words by many programs.
const LABEL_BYTES: usize = 30_000;

/// Write a C3D file. Coordinates are rounded to what the storage holds; a missing marker has
/// residual -1.
///
/// # Errors
/// [`WriteError`] when labels, markers, parameters or positions do not fit the format.
pub fn write_c3d(capture: &Capture, options: &C3dOptions) -> Result<Vec<u8>, WriteError> {
    let markers = capture.labels.len();
    let limit = usize::from(u16::MAX);
    if markers == 0 || markers > limit {
        return Err(WriteError::TooMany {
            what: "markers",
            count: markers,
            limit,
            remedy: "write between 1 and 65535 markers a file",
        });
    }
    let scale = match options.storage {
        C3dStorage::Float => -1.0,
        C3dStorage::Integer { scale } => scale,
    };
    // The start of the data stands in the parameters, whose length does not depend on it.
    let blocks = parameters(capture, options.processor, scale, 0)?.len() / BLOCK;
    if blocks > 255 {
        return Err(WriteError::TooMany {
            what: "blocks of parameters",
            count: blocks,
            limit: 255,
            remedy: "shorten the labels or write fewer markers",
        });
    }
    let data_block = (2 + blocks) as u16;
    let mut file = header(capture, options.processor, scale, data_block);
    file.extend(parameters(capture, options.processor, scale, data_block)?);
    data(capture, options, &mut file)?;
    file.resize(file.len().next_multiple_of(BLOCK), 0);
    Ok(file)
}

/// A number cut to what a word holds.
fn word(value: u64) -> u16 {
    u16::try_from(value).unwrap_or(u16::MAX)
}

/// Number of the last frame.
fn last_frame(capture: &Capture) -> u64 {
    capture.first_frame.saturating_add((capture.frames() as u64).saturating_sub(1))
}

/// The 512 bytes of the header.
fn header(capture: &Capture, processor: Processor, scale: f32, data_block: u16) -> Vec<u8> {
    let mut bytes = vec![0; BLOCK];
    bytes[0] = 2;
    bytes[1] = 0x50;
    let words = [
        (2, word(capture.labels.len() as u64)),
        (6, word(capture.first_frame)),
        (8, word(last_frame(capture))),
        (16, data_block),
    ];
    for (at, value) in words {
        bytes[at..at + 2].copy_from_slice(&processor.u16_bytes(value));
    }
    for (at, value) in [(12, scale), (20, capture.rate_hz as f32)] {
        bytes[at..at + 4].copy_from_slice(&processor.f32_bytes(value));
    }
    bytes
}

/// The parameter section, whole blocks.
fn parameters(
    capture: &Capture,
    processor: Processor,
    scale: f32,
    data_block: u16,
) -> Result<Vec<u8>, WriteError> {
    let mut section = Section::new(processor);
    section.group(1, "POINT");
    section.words(1, "USED", &[word(capture.labels.len() as u64)]);
    section.words(1, "FRAMES", &[word(capture.frames() as u64)]);
    section.words(1, "DATA_START", &[data_block]);
    section.floats(1, "SCALE", &[scale]);
    section.floats(1, "RATE", &[capture.rate_hz as f32]);
    section.texts(1, "UNITS", &[capture.unit.symbol().to_owned()]);
    if capture.frames() > usize::from(u16::MAX) {
        section.floats(1, "LONG_FRAMES", &[capture.frames() as f32]);
    }
    for label in &capture.labels {
        crate::formats::text::check_label(label)?;
        if label.len() > 255 {
            return Err(WriteError::Label { label: label.clone(), what: "more than 255 bytes" });
        }
    }
    let longest = capture.labels.iter().map(String::len).max().unwrap_or(1);
    let chunk = LABELS_A_PARAMETER.min(LABEL_BYTES / longest);
    for (part, labels) in capture.labels.chunks(chunk).enumerate() {
        let suffix = if part == 0 { String::new() } else { (part + 1).to_string() };
        section.texts(1, &format!("LABELS{suffix}"), labels);
    }
    section.group(2, "ANALOG");
    section.words(2, "USED", &[0]);
    section.floats(2, "RATE", &[capture.rate_hz as f32]);
    section.floats(2, "GEN_SCALE", &[1.0]);
    section.group(3, "TRIAL");
    for (name, frame) in
        [("ACTUAL_START_FIELD", capture.first_frame), ("ACTUAL_END_FIELD", last_frame(capture))]
    {
        section.words(3, name, &[(frame & 0xffff) as u16, word(frame >> 16)]);
    }
    Ok(section.finish())
}

/// The frames.
fn data(capture: &Capture, options: &C3dOptions, file: &mut Vec<u8>) -> Result<(), WriteError> {
    let processor = options.processor;
    for (index, p) in capture.positions.iter().enumerate() {
        let missing = !p.is_finite();
        let p = if missing { [0.0; 3] } else { p.to_array() };
        let too_far = |value: f64, remedy: &'static str| WriteError::Position {
            frame: index / capture.labels.len(),
            label: capture.labels[index % capture.labels.len()].clone(),
            value,
            remedy,
        };
        match options.storage {
            C3dStorage::Float => {
                for value in p {
                    // A quarter of the IEEE range: what DEC floats hold too.
                    if value.abs() > f64::from(f32::MAX) / 4.0 {
                        return Err(too_far(value, "remove the position"));
                    }
                    file.extend(processor.f32_bytes(value as f32));
                }
                file.extend(processor.f32_bytes(if missing { -1.0 } else { 0.0 }));
            }
            C3dStorage::Integer { scale } => {
                for value in p {
                    let steps = (value / f64::from(scale)).round();
                    if steps.is_nan() || steps.abs() > 32_767.0 {
                        return Err(too_far(value, "store floats or a larger scale"));
                    }
                    file.extend(processor.u16_bytes((steps as i16) as u16));
                }
                file.extend(processor.u16_bytes(if missing { u16::MAX } else { 0 }));
            }
        }
    }
    Ok(())
}

/// The parameter section under construction.
struct Section {
    processor: Processor,
    bytes: Vec<u8>,
}

impl Section {
    fn new(processor: Processor) -> Self {
        Self { processor, bytes: vec![1, 0x50, 0, processor.code()] }
    }

    /// Name, id and the word that leads to the next entry, then the content.
    fn entry(&mut self, id: i8, name: &str, content: &[u8]) {
        self.bytes.push(name.len() as u8);
        self.bytes.push(id as u8);
        self.bytes.extend(name.as_bytes());
        self.bytes.extend(self.processor.u16_bytes((content.len() + 2) as u16));
        self.bytes.extend(content);
    }

    fn group(&mut self, id: i8, name: &str) {
        self.entry(-id, name, &[0]);
    }

    /// A parameter: type, dimensions, values, no description.
    fn parameter(&mut self, group: i8, name: &str, kind: i8, dimensions: &[u8], values: &[u8]) {
        let mut content = vec![kind as u8, dimensions.len() as u8];
        content.extend(dimensions);
        content.extend(values);
        content.push(0);
        self.entry(group, name, &content);
    }

    fn words(&mut self, group: i8, name: &str, values: &[u16]) {
        let bytes: Vec<u8> = values.iter().flat_map(|v| self.processor.u16_bytes(*v)).collect();
        let dimensions: &[u8] = if values.len() == 1 { &[] } else { &[values.len() as u8] };
        self.parameter(group, name, 2, dimensions, &bytes);
    }

    fn floats(&mut self, group: i8, name: &str, values: &[f32]) {
        let bytes: Vec<u8> = values.iter().flat_map(|v| self.processor.f32_bytes(*v)).collect();
        let dimensions: &[u8] = if values.len() == 1 { &[] } else { &[values.len() as u8] };
        self.parameter(group, name, 4, dimensions, &bytes);
    }

    /// Strings of at most 255 bytes, at most 255 of them.
    fn texts(&mut self, group: i8, name: &str, values: &[String]) {
        let length = values.iter().map(String::len).max().unwrap_or(0);
        let mut bytes = Vec::with_capacity(length * values.len());
        for value in values {
            bytes.extend(value.as_bytes());
            bytes.resize(bytes.len() + length - value.len(), b' ');
        }
        self.parameter(group, name, -1, &[length as u8, values.len() as u8], &bytes);
    }

    /// End mark, padding to whole blocks, block count.
    fn finish(mut self) -> Vec<u8> {
        self.bytes.extend([0, 0]);
        self.bytes.resize(self.bytes.len().next_multiple_of(BLOCK), 0);
        self.bytes[2] = u8::try_from(self.bytes.len() / BLOCK).unwrap_or(u8::MAX);
        self.bytes
    }
}
