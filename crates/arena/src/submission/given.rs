//! Which segments a file is for, by its name or by what stands before it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::SubmissionProblem;
use crate::arena_file::{Arena, ArenaCapture};

/// A file that is submitted: for a capture as a whole, or for one segment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Given {
    /// The capture or segment that was named with it.
    pub id: Option<String>,
    /// The file.
    pub path: PathBuf,
}

impl Given {
    /// `ID=FILE`, or a file whose name says what it is for.
    pub fn of(text: &str) -> Self {
        match text.split_once('=') {
            Some((id, path)) if !id.is_empty() && !id.contains(['/', '\\', '.']) => {
                Self { id: Some(id.to_owned()), path: path.into() }
            }
            _ => Self { id: None, path: text.into() },
        }
    }

    /// What the file is called in messages.
    pub fn name(&self) -> String {
        self.path.display().to_string()
    }
}

/// What a file is for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<'a> {
    /// Capture or segment.
    pub id: &'a str,
    /// The capture whose frames it has.
    pub capture: &'a ArenaCapture,
    /// Number of frames that it is to have.
    pub frames: usize,
}

/// What is known of the segments while files are gone through.
pub(super) struct Cover<'a> {
    arena: &'a Arena,
    taken: BTreeSet<String>,
    /// Segment -> place of the file in the list, and the frames of it.
    pub cuts: BTreeMap<&'a str, (usize, std::ops::Range<usize>)>,
}

impl<'a> Cover<'a> {
    pub fn new(arena: &'a Arena) -> Self {
        Self { arena, taken: BTreeSet::new(), cuts: BTreeMap::new() }
    }

    /// What the file at a place of the list is for, and the segments that it covers. `only` says whether it is the
    /// only file of all.
    ///
    /// # Errors
    /// No such capture or segment, or a segment that another file covers.
    pub fn add(
        &mut self,
        place: usize,
        given: &Given,
        only: bool,
    ) -> Result<Place<'a>, SubmissionProblem> {
        let stem = given.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let named = given.id.clone().unwrap_or(stem);
        let arena = self.arena;
        let segment = arena.segments.iter().find(|segment| segment.id == named);
        let mut capture = arena.captures.get_key_value(&named);
        if segment.is_none() && capture.is_none() && given.id.is_none() && only {
            // One file of one capture needs no name.
            capture = arena.captures.iter().next().filter(|_| arena.captures.len() == 1);
        }
        let (id, covered): (&'a str, Vec<_>) = match (segment, capture) {
            (Some(segment), _) => (&segment.id, vec![(segment, 0..segment.frames())]),
            (None, Some((id, _))) => {
                let own = arena.segments.iter().filter(|segment| segment.capture == *id);
                (id, own.map(|segment| (segment, segment.first..segment.end)).collect())
            }
            (None, None) => {
                let segments = arena.segments.iter().map(|segment| segment.id.clone());
                let known = arena.captures.keys().cloned().chain(segments).collect();
                return Err(SubmissionProblem::NoSuchPart { file: given.name(), id: named, known });
            }
        };
        for (segment, frames) in covered {
            if !self.taken.insert(segment.id.clone()) {
                let segment = segment.id.clone();
                return Err(SubmissionProblem::Twice { file: given.name(), segment });
            }
            self.cuts.insert(&segment.id, (place, frames));
        }
        let capture = match (segment, capture) {
            (Some(segment), _) => &arena.captures[&segment.capture],
            (None, Some((_, capture))) => capture,
            (None, None) => unreachable!("refused above"),
        };
        let frames = segment.map_or(capture.frames, |segment| segment.frames());
        Ok(Place { id, capture, frames })
    }

    /// The segments that no file covers.
    pub fn missing(&self) -> impl Iterator<Item = SubmissionProblem> {
        let missing = self.arena.segments.iter().filter(|own| !self.taken.contains(&own.id));
        missing.map(|segment| SubmissionProblem::Missing { segment: segment.id.clone() })
    }
}
