//! A new arena: a head, a capture, its map and its segments in; `arena.json` and the files to copy out.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mimique_avatar_files::read_avatar;
use mimique_mocap::{CaptureFile, ReadOptions};
use mimique_stimulus::{MarkerMap, read_segments, read_sound};
use mimique_study::SegmentSound;

use crate::arena_file::{Arena, ArenaCapture, ArenaSegment};
use crate::arena_problem::{ArenaProblem, lines};

/// What an arena is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct NewArena {
    /// Its identifier.
    pub id: String,
    /// What it is called.
    pub title: String,
    /// The day it is opened, YYYY-MM-DD.
    pub opened: String,
    /// The head, a GLB file.
    pub avatar: PathBuf,
    /// The capture.
    pub capture: PathBuf,
    /// Where its markers sit on the head.
    pub map: Option<PathBuf>,
    /// A table of segments.
    pub segments: PathBuf,
    /// Sounds by segment.
    pub sounds: BTreeMap<String, PathBuf>,
    /// Frames per second that are shown.
    pub shown_hz: Option<f64>,
    /// Pairs for each participant.
    pub per_participant: usize,
}

/// An arena and the files to be copied into its folder, each with its name there.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeArena {
    /// The arena.
    pub arena: Arena,
    /// What is copied.
    pub copies: Vec<(PathBuf, String)>,
}

/// Why no arena can be made.
#[derive(Debug, thiserror::Error)]
pub enum NoArena {
    /// Files that cannot be used, a line each.
    #[error("{}", .0.join("\n"))]
    Files(Vec<String>),
    /// What was given does not fit together.
    #[error("{}", lines(.0))]
    Problems(Vec<ArenaProblem>),
}

/// Makes an arena.
///
/// # Errors
/// Every file that cannot be used; else everything that does not fit together.
pub fn new_arena(wanted: &NewArena) -> Result<MadeArena, NoArena> {
    let mut faults = Vec::new();
    let mut sound = |path: &Path, result: Result<(), String>| {
        faults.extend(result.err().map(|why| format!("{}: {why}", path.display())));
    };
    let is_glb = wanted.avatar.extension().is_some_and(|end| end.eq_ignore_ascii_case("glb"));
    let head = if is_glb {
        read_avatar(&wanted.avatar).map(drop).map_err(|e| e.to_string())
    } else {
        Err("an arena's head is one file; give a GLB file".to_owned())
    };
    sound(&wanted.avatar, head);
    let read = CaptureFile::open(&wanted.capture)
        .and_then(|mut file| file.recording(&ReadOptions::default()))
        .map_err(|e| e.to_string());
    let capture = read.as_ref().ok().map(|own| (own.capture.rate_hz, own.capture.frames()));
    sound(&wanted.capture, read.map(drop));
    if let Some(map) = &wanted.map {
        let read = std::fs::read(map).map_err(|e| unread(&e));
        sound(
            map,
            read.and_then(|b| MarkerMap::from_bytes(&b).map(drop).map_err(|e| e.to_string())),
        );
    }
    let cuts = std::fs::read_to_string(&wanted.segments)
        .map_err(|e| unread(&e))
        .and_then(|text| read_segments(&text).map_err(|e| e.to_string()));
    let segments = cuts.clone().unwrap_or_default();
    sound(&wanted.segments, cuts.map(drop));
    for path in wanted.sounds.values() {
        let read = std::fs::read(path).map_err(|e| unread(&e));
        sound(path, read.and_then(|bytes| read_sound(&bytes).map(drop).map_err(|e| e.to_string())));
    }
    let Some((rate_hz, frames)) = capture.filter(|_| faults.is_empty()) else {
        return Err(NoArena::Files(faults));
    };
    let mut copies = vec![(wanted.avatar.clone(), "head.glb".to_owned())];
    let mut copied = |path: &Path, stem: &str| {
        let name = named(path, stem);
        copies.push((path.to_owned(), name.clone()));
        name
    };
    let file = copied(&wanted.capture, "captures/take");
    let markers = wanted.map.as_deref().map(|map| copied(map, "captures/markers"));
    let segments: Vec<ArenaSegment> = (segments.iter())
        .map(|own| ArenaSegment {
            id: mimique_new_study::study_id(&own.label).unwrap_or_default(),
            capture: "take".to_owned(),
            first: own.clip.start,
            end: own.clip.end,
            sound: None,
        })
        .collect();
    let mut arena = Arena {
        schema: Some("./schema/arena.schema.json".to_owned()),
        id: wanted.id.clone(),
        title: wanted.title.clone(),
        opened: wanted.opened.clone(),
        avatar: "head.glb".to_owned(),
        captures: BTreeMap::from([(
            "take".to_owned(),
            ArenaCapture { file, rate_hz, frames, markers },
        )]),
        segments,
        shown_hz: wanted.shown_hz,
        bounds: [0.0, 1.0],
        per_participant: wanted.per_participant,
    };
    for (segment, path) in &wanted.sounds {
        let file = copied(path, &format!("sounds/{segment}"));
        match arena.segments.iter_mut().find(|own| own.id == *segment) {
            Some(own) => {
                own.sound = Some(SegmentSound { file: Some(file), ..SegmentSound::default() });
            }
            None => {
                let known: Vec<&str> = arena.segments.iter().map(|own| own.id.as_str()).collect();
                return Err(NoArena::Files(vec![format!(
                    "{}: there is no segment {segment:?}; there are {}",
                    path.display(),
                    known.join(", ")
                )]));
            }
        }
    }
    let problems = arena.problems(None);
    if problems.is_empty() {
        Ok(MadeArena { arena, copies })
    } else {
        Err(NoArena::Problems(problems))
    }
}

fn unread(error: &std::io::Error) -> String {
    format!("cannot be read ({error}); check the path")
}

/// A name in the folder, with the ending of the file.
fn named(path: &Path, stem: &str) -> String {
    match path.extension() {
        Some(end) => format!("{stem}.{}", end.to_string_lossy().to_ascii_lowercase()),
        None => stem.to_owned(),
    }
}
