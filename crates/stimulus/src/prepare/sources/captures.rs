//! The captures of segments.

use std::rc::Rc;

use mimique_mocap::{Capture, LengthUnit, ReadOptions};
use mimique_study::{CaptureSource, Segment, Span};
use serde_json::json;

use super::Sources;
use super::unread;
use crate::RepairSidecar;
use crate::prepare::source_files::CaptureFile;
use crate::prepare::{PrepareError, builtin, pointer};
use crate::provenance::{Provenance, sha256_of_file};

impl<'a> Sources<'a> {
    /// The capture of a segment; for a built-in actor the take of its performance.
    pub(super) fn capture(
        &self,
        segment: &Segment,
        at: &str,
    ) -> Result<Rc<CaptureFile>, PrepareError> {
        let id = &segment.capture;
        let source = self.study.stimuli.captures.get(id).and_then(|capture| capture.source());
        let name = match (source, segment.span()) {
            (Some(CaptureSource::Builtin(_)), Some(Span::Performance(what))) => {
                json!([id, what]).to_string()
            }
            (Some(CaptureSource::File(_)), Some(Span::Frames { .. })) => id.clone(),
            (None, _) => {
                let message = "give exactly one of builtin, file and exertion";
                return Err(PrepareError::new(pointer(&["stimuli", "captures", id]), message));
            }
            _ => {
                let message = "give first and end for a file, performance for a built-in actor";
                return Err(PrepareError::new(at, message));
            }
        };
        if let Some(found) = self.captures.borrow().get(&name) {
            return found.clone();
        }
        let read = self.capture_read(segment).map(Rc::new);
        self.captures.borrow_mut().insert(name, read.clone());
        read
    }

    /// The same, read or performed, at the rate that is shown.
    fn capture_read(&self, segment: &Segment) -> Result<CaptureFile, PrepareError> {
        let id = &segment.capture;
        let entry = self.study.stimuli.captures.get(id);
        let at = pointer(&["stimuli", "captures", id]);
        let file = match (entry.and_then(|c| c.source()), segment.span()) {
            (Some(CaptureSource::Builtin(actor)), Some(Span::Performance(what))) => {
                let take = builtin::take(actor, what);
                CaptureFile {
                    head: take.head,
                    known: Some((take.neutral, take.played)),
                    ..CaptureFile::new(builtin::take_key(&take.capture), take.capture)
                }
            }
            (Some(CaptureSource::File(path)), _) => {
                let (key, capture, repair) = self.read_capture(path, entry, &at)?;
                CaptureFile { repair, ..CaptureFile::new(key, capture) }
            }
            _ => return Err(PrepareError::new(at, "give exactly one of builtin and file")),
        };
        match entry.and_then(|c| c.rate_hz) {
            Some(rate_hz) => file.at_rate(rate_hz, &format!("{at}/rateHz")),
            None => Ok(file),
        }
    }

    /// The capture of a file, and what it is known by.
    pub(super) fn read_capture(
        &self,
        file: &str,
        entry: Option<&mimique_study::Capture>,
        at: &str,
    ) -> Result<(String, Capture, Option<String>), PrepareError> {
        let at_file = format!("{at}/file");
        let path = self.path(file, &at_file)?;
        let unit = entry.and_then(|entry| entry.unit.as_deref());
        let file_rate_hz = entry.and_then(|entry| entry.file_rate_hz);
        let unit_read = unit_of(unit, &format!("{at}/unit"))?;
        let options = ReadOptions { unit: unit_read, rate_hz: file_rate_hz };
        let recording = mimique_mocap::CaptureFile::open(&path)
            .and_then(|mut file| file.recording(&options))
            .map_err(|e| PrepareError::new(&at_file, format!("{}: {e}", path.display())))?;
        let hash = sha256_of_file(&path).map_err(|e| unread(&path, &e, &at_file))?;
        let repair = RepairSidecar::beside(&path, || Ok(hash.clone()))
            .map_err(|e| PrepareError::new(&at_file, e))?
            .map(|sidecar| sidecar.hash());
        let key = Provenance::default().json("file", hash).json("unit", json!(unit));
        // Of a file that says its rate, the key is as it was.
        let key = match file_rate_hz {
            Some(rate_hz) => key.json("fileRateHz", rate_hz),
            None => key,
        };
        let key = key.hash();
        Ok((key, recording.capture, repair))
    }
}

pub(in crate::prepare) fn unit_of(
    unit: Option<&str>,
    at: &str,
) -> Result<Option<LengthUnit>, PrepareError> {
    match unit {
        None => Ok(None),
        Some("mm") => Ok(Some(LengthUnit::Millimetre)),
        Some("cm") => Ok(Some(LengthUnit::Centimetre)),
        Some("m") => Ok(Some(LengthUnit::Metre)),
        Some(other) => Err(PrepareError::new(at, format!("unit {other:?}; write m, cm or mm"))),
    }
}
