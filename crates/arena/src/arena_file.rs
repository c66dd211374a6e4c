//! `arena.json`: the head, the captures, the segments that are compared, what weights may be.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use mimique_study::SegmentSound;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::arena_problem::{ArenaFileError, ArenaProblem};

/// The name of the file in the arena's folder.
pub const ARENA_FILE: &str = "arena.json";

/// An arena.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Arena {
    /// Where editors find the schema of this file.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Identifier: lower-case letters, digits and hyphens.
    pub id: String,
    /// What it is called.
    pub title: String,
    /// The day it was opened, YYYY-MM-DD.
    pub opened: String,
    /// The head that all methods move: a GLB file in the folder.
    pub avatar: String,
    /// What was captured, by identifier.
    pub captures: BTreeMap<String, ArenaCapture>,
    /// The cuts of the captures that are compared.
    pub segments: Vec<ArenaSegment>,
    /// Frames per second that are shown, of all methods alike; the captures' own if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shown_hz: Option<f64>,
    /// The least and the largest weight of a shape.
    #[serde(default = "unit_interval")]
    pub bounds: [f64; 2],
    /// How many pairs each participant is shown.
    #[serde(default = "twenty")]
    pub per_participant: usize,
}

/// A capture that methods are applied to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ArenaCapture {
    /// Its file in the folder.
    pub file: String,
    /// Frames per second.
    pub rate_hz: f64,
    /// Number of frames.
    pub frames: usize,
    /// The marker map in the folder: where each marker sits on the head.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub markers: Option<String>,
}

/// A cut of a capture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ArenaSegment {
    /// Identifier: lower-case letters, digits and hyphens.
    pub id: String,
    /// Which capture.
    pub capture: String,
    /// First frame, counted from 0.
    pub first: usize,
    /// Frame after the last one.
    pub end: usize,
    /// What is heard with it, by all methods alike.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sound: Option<SegmentSound>,
}

impl ArenaSegment {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.end.saturating_sub(self.first)
    }
}

fn unit_interval() -> [f64; 2] {
    [0.0, 1.0]
}

fn twenty() -> usize {
    20
}

impl Arena {
    /// Reads `arena.json` and checks it, against the files of its folder too where one is given.
    ///
    /// # Errors
    /// [`ArenaFileError`]: not of this form, or all that is wrong with it.
    pub fn read(text: &str, folder: Option<&Path>) -> Result<Self, ArenaFileError> {
        let mut json = serde_json::Deserializer::from_str(text);
        let arena: Self = serde_path_to_error::deserialize(&mut json).map_err(|error| {
            let pointer = match error.path().to_string().as_str() {
                "." => "/".to_owned(),
                path => format!("/{}", path.replace('.', "/")),
            };
            ArenaFileError::Form { pointer, problem: error.inner().to_string() }
        })?;
        let problems = arena.problems(folder);
        if problems.is_empty() { Ok(arena) } else { Err(ArenaFileError::Problems(problems)) }
    }

    /// Everything that is wrong with it.
    pub fn problems(&self, folder: Option<&Path>) -> Vec<ArenaProblem> {
        let mut found = Vec::new();
        if !is_identifier(&self.id) {
            found.push(ArenaProblem::Identifier { pointer: "/id".to_owned(), id: self.id.clone() });
        }
        self.numbers(&mut found);
        let mut taken = BTreeSet::new();
        for (id, capture) in &self.captures {
            let pointer = format!("/captures/{id}");
            if !is_identifier(id) {
                found.push(ArenaProblem::Identifier { pointer: pointer.clone(), id: id.clone() });
            }
            taken.insert(id.as_str());
            if !(capture.rate_hz > 0.0 && capture.rate_hz <= 1000.0) {
                let value = format!("{id}: {}", capture.rate_hz);
                let wanted = "frames per second above 0, 1000 at most";
                found.push(ArenaProblem::Number { pointer: "/captures", value, wanted });
            }
        }
        if self.segments.is_empty() {
            found.push(ArenaProblem::NoSegments);
        }
        for (place, segment) in self.segments.iter().enumerate() {
            found.extend(self.segment_problems(place, segment, &mut taken));
        }
        found.extend(folder.into_iter().flat_map(|folder| self.absent_files(folder)));
        found
    }

    fn numbers(&self, found: &mut Vec<ArenaProblem>) {
        let [low, high] = self.bounds;
        if !(low.is_finite() && high.is_finite() && low <= 0.0 && high > 0.0) {
            let (value, wanted) =
                (format!("{low}, {high}"), "a least weight of 0 or below, a largest above 0");
            found.push(ArenaProblem::Number { pointer: "/bounds", value, wanted });
        }
        if let Some(hz) = self.shown_hz.filter(|hz| !(*hz > 0.0 && *hz <= 1000.0)) {
            let wanted = "frames per second above 0, 1000 at most";
            found.push(ArenaProblem::Number { pointer: "/shownHz", value: hz.to_string(), wanted });
        }
        if self.per_participant == 0 {
            let (pointer, wanted) = ("/perParticipant", "pairs for each participant, one at least");
            found.push(ArenaProblem::Number { pointer, value: "0".to_owned(), wanted });
        }
    }

    fn segment_problems<'a>(
        &'a self,
        place: usize,
        segment: &'a ArenaSegment,
        taken: &mut BTreeSet<&'a str>,
    ) -> Vec<ArenaProblem> {
        let pointer = format!("/segments/{place}");
        let mut found = Vec::new();
        let id = segment.id.clone();
        if !is_identifier(&id) {
            found.push(ArenaProblem::Identifier { pointer: format!("{pointer}/id"), id });
        } else if !taken.insert(&segment.id) {
            found.push(ArenaProblem::Repeated { pointer: format!("{pointer}/id"), id });
        }
        match self.captures.get(&segment.capture) {
            None => found.push(ArenaProblem::NoCapture {
                pointer: format!("{pointer}/capture"),
                capture: segment.capture.clone(),
                known: self.captures.keys().cloned().collect(),
            }),
            Some(capture) if segment.first + 2 > segment.end || segment.end > capture.frames => {
                let ArenaSegment { first, end, .. } = *segment;
                found.push(ArenaProblem::Frames { pointer, first, end, frames: capture.frames });
            }
            Some(_) => (),
        }
        found
    }

    /// The files that it names, each with the place where.
    fn files(&self) -> Vec<(String, &str)> {
        let mut files = vec![("/avatar".to_owned(), self.avatar.as_str())];
        for (id, capture) in &self.captures {
            files.push((format!("/captures/{id}/file"), &capture.file));
            let markers = capture.markers.as_deref();
            files.extend(markers.map(|file| (format!("/captures/{id}/markers"), file)));
        }
        for (place, segment) in self.segments.iter().enumerate() {
            let sound = segment.sound.as_ref().and_then(|sound| sound.file.as_deref());
            files.extend(sound.map(|file| (format!("/segments/{place}/sound/file"), file)));
        }
        files
    }

    fn absent_files(&self, folder: &Path) -> Vec<ArenaProblem> {
        let absent = self.files().into_iter().filter(|(_, file)| !folder.join(file).is_file());
        absent
            .map(|(pointer, file)| ArenaProblem::NoFile { pointer, file: file.to_owned() })
            .collect()
    }

    /// The files of sound that its segments name, each once.
    pub fn sounds(&self) -> BTreeSet<&str> {
        let sounds = self.segments.iter().filter_map(|segment| segment.sound.as_ref());
        sounds.filter_map(|sound| sound.file.as_deref()).collect()
    }

    /// As the file's text.
    pub fn to_text(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

/// Whether a name can stand in file names and tables.
pub(crate) fn is_identifier(id: &str) -> bool {
    mimique_new_study::study_id(id).is_some_and(|plain| plain == id)
}

/// The JSON Schema (2020-12) of `arena.json`.
pub fn arena_schema() -> Value {
    schemars::schema_for!(Arena).to_value()
}

/// The schema as a file.
pub fn arena_schema_text() -> String {
    format!("{:#}\n", arena_schema())
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(crate) fn text() -> Value {
        serde_json::json!({
            "id": "faces", "title": "Faces", "opened": "2026-11-27", "avatar": "head.glb",
            "captures": { "take": { "file": "take.c3d", "rateHz": 100.0, "frames": 500 } },
            "segments": [{ "id": "joy", "capture": "take", "first": 10, "end": 110 }],
        })
    }

    fn problems_of(change: impl FnOnce(&mut Value)) -> Vec<String> {
        let mut value = text();
        change(&mut value);
        match Arena::read(&value.to_string(), None) {
            Ok(_) => Vec::new(),
            Err(ArenaFileError::Problems(all)) => all.iter().map(ToString::to_string).collect(),
            Err(form) => vec![form.to_string()],
        }
    }

    #[test]
    fn an_arena_is_read_as_it_was_written() {
        let arena = Arena::read(&text().to_string(), None).unwrap();
        assert_eq!((arena.bounds, arena.per_participant), ([0.0, 1.0], 20));
        assert_eq!(Arena::read(&arena.to_text(), None).unwrap(), arena);
    }

    #[test]
    fn all_that_is_wrong_is_said_at_once_with_its_place() {
        let found = problems_of(|value| {
            value["id"] = "Faces 1".into();
            value["bounds"] = serde_json::json!([0.5, 1.0]);
            value["perParticipant"] = 0.into();
            value["segments"] = serde_json::json!([
                { "id": "joy", "capture": "take", "first": 10, "end": 11 },
                { "id": "joy", "capture": "other", "first": 0, "end": 9 },
            ]);
        });
        let places = [
            "/id",
            "/bounds",
            "/perParticipant",
            "/segments/0",
            "/segments/1/id",
            "/segments/1/capture",
        ];
        assert_eq!(found.len(), places.len(), "{found:#?}");
        for place in places {
            assert!(found.iter().any(|line| line.starts_with(place)), "{place}: {found:#?}");
        }
        assert!(found.iter().any(|line| line.contains("frames 10 to 11 of a capture of 500")));
    }

    #[test]
    fn what_is_not_of_the_form_is_named_with_its_pointer() {
        let found = problems_of(|value| value["captures"]["take"]["frames"] = "many".into());
        assert!(found[0].starts_with("/captures/take/frames: invalid type"), "{found:?}");
        let found = problems_of(|value| value["colour"] = "red".into());
        assert!(found[0].contains("unknown field `colour`"), "{found:?}");
    }

    #[test]
    fn files_that_are_not_there_are_named() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("head.glb"), "x").unwrap();
        let arena = Arena::read(&text().to_string(), None).unwrap();
        let found = arena.problems(Some(folder.path()));
        assert_eq!(found.len(), 1);
        assert!(found[0].to_string().starts_with("/captures/take/file: take.c3d"), "{found:?}");
    }
}
