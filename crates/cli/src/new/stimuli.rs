//! The stimuli of a new study: an avatar and a capture of one's own, or the built-in ones; what goes into the study
//! file, and which files go along with it.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_mocap::{CaptureFile, ReadOptions};
use mimique_new_study::Stimuli;
use mimique_stimulus::{
    AvatarSkin, EafDocument, MarkerMap, TakeSegment, read_segments, sidecar_path, study_segments,
    suggest_map,
};
use serde_json::{Map, json};

use super::Wishes;

/// The built-in expressions: factor, English, French.
const EXPRESSIONS: [[&str; 3]; 6] = [
    ["anger", "Anger", "Colère"],
    ["disgust", "Disgust", "Dégoût"],
    ["fear", "Fear", "Peur"],
    ["joy", "Joy", "Joie"],
    ["sadness", "Sadness", "Tristesse"],
    ["surprise", "Surprise", "Surprise"],
];

/// What a study shows, and its files.
pub(super) struct StimulusFiles {
    /// What the study file says of them.
    pub shown: Stimuli,
    /// Files that are copied into the study's folder, with their names there.
    pub copied: Vec<(PathBuf, String)>,
    /// Files that are written into it: names and texts.
    pub made: Vec<(String, String)>,
    /// What should be looked at.
    pub notes: Vec<String>,
}

/// The folder of the files in the study's folder.
const FOLDER: &str = "stimuli";

impl StimulusFiles {
    /// What the options ask for.
    pub fn of(wishes: &Wishes) -> anyhow::Result<Self> {
        let mut own = Self {
            shown: Stimuli::default(),
            copied: Vec::new(),
            made: Vec::new(),
            notes: Vec::new(),
        };
        let avatar = match &wishes.avatar {
            None => json!({ "builtin": { "seed": 1 } }),
            Some(path) => json!({ "file": own.file(path, wishes.reference)? }),
        };
        own.shown.parts.insert("avatars".to_owned(), json!({ "head": avatar }));
        match &wishes.capture {
            None => own.built_in(wishes)?,
            Some(capture) => own.recorded(capture, wishes)?,
        }
        Ok(own)
    }

    /// The built-in actor's six emotions.
    fn built_in(&mut self, wishes: &Wishes) -> anyhow::Result<()> {
        if wishes.avatar.is_some() {
            bail!(
                "--avatar: the built-in actor's markers belong on the built-in head; give a capture, too: --capture \
                 take.c3d"
            );
        }
        for (option, is_given) in [
            ("--map", wishes.map.is_some()),
            ("--segments", wishes.segments.is_some()),
            ("--cut", !wishes.cuts.is_empty()),
            ("--head", !wishes.head.is_empty()),
            ("--neutral", wishes.neutral.is_some()),
        ] {
            if is_given {
                bail!(
                    "{option}: it belongs to a capture; give --capture take.c3d, or leave it out"
                );
            }
        }
        let segments = EXPRESSIONS.map(|[word, ..]| {
            json!({ "id": word, "capture": "actor", "performance": { "expression": word, "intensity": 2 } })
        });
        self.shown.parts.insert(
            "captures".to_owned(),
            json!({ "actor": { "builtin": { "actor": 7 }, "rateHz": 60 } }),
        );
        self.shown.parts.insert("segments".to_owned(), json!(segments));
        self.shown.expressions = EXPRESSIONS.map(|words| words.map(str::to_owned)).to_vec();
        Ok(())
    }

    /// A capture of a file.
    fn recorded(&mut self, path: &Path, wishes: &Wishes) -> anyhow::Result<()> {
        let avatar = wishes.avatar.as_deref().ok_or_else(|| {
            anyhow!("--capture: a capture moves an avatar; give its file: --avatar head.glb")
        })?;
        let mut capture = Map::new();
        capture.insert("file".to_owned(), json!(self.file(path, wishes.reference)?));
        let map = match &wishes.map {
            Some(map) => {
                capture.insert("markers".to_owned(), json!(self.file(map, wishes.reference)?));
                let bytes = std::fs::read(map).map_err(|e| unread(map, &e))?;
                MarkerMap::from_bytes(&bytes).map_err(|e| anyhow!("{}: {e}", map.display()))?
            }
            None => {
                let map = self.suggested(avatar, path, wishes)?;
                capture.insert("markers".to_owned(), json!(format!("{FOLDER}/markers.json")));
                self.made.push((format!("{FOLDER}/markers.json"), map.to_json()));
                map
            }
        };
        let head = if wishes.head.is_empty() { &map.head } else { &wishes.head };
        if !head.is_empty() {
            capture.insert("head".to_owned(), json!(head));
        }
        if let Some(neutral) = wishes.neutral.clone().or_else(|| map.neutral.clone()) {
            capture.insert("neutral".to_owned(), json!([neutral.start, neutral.end]));
        }
        let takes = cuts(path, wishes)?;
        self.shown.parts.insert("captures".to_owned(), json!({ "take": capture }));
        self.shown.parts.insert("segments".to_owned(), json!(study_segments(&takes, "take")));
        for take in &takes {
            if !self.shown.expressions.iter().any(|[word, ..]| *word == take.label) {
                self.shown.expressions.push([(); 3].map(|()| take.label.clone()));
            }
        }
        Ok(())
    }

    /// Where the markers probably sit on the avatar, to be looked at by a person.
    fn suggested(
        &mut self,
        avatar: &Path,
        capture: &Path,
        wishes: &Wishes,
    ) -> anyhow::Result<MarkerMap> {
        let read = mimique_avatar_files::read_avatar(avatar)
            .map_err(|e| anyhow!("{}: {e}", avatar.display()))?;
        let skin =
            AvatarSkin::of(&read.avatar).map_err(|e| anyhow!("{}: {e}", avatar.display()))?;
        let recording = CaptureFile::open(capture)
            .and_then(|mut file| file.recording(&ReadOptions::default()))
            .map_err(|e| anyhow!("{}: {e}", capture.display()))?;
        let found = suggest_map(&skin, &recording.capture, wishes.neutral.clone())
            .map_err(|e| anyhow!("{}: {e}; give a map by --map", capture.display()))?;
        self.notes.push(format!(
            "{FOLDER}/markers.json: suggested from the capture, {:.1} mm off the skin: look at it in the studio \
             (`mimique preview`) before the study runs",
            found.distance_rms_mm
        ));
        self.notes.extend(found.notes.iter().map(|note| format!("{FOLDER}/markers.json: {note}")));
        Ok(found.to_map(&skin))
    }

    /// How a study file names a file: by its copy, or by where it is.
    fn file(&mut self, path: &Path, reference: bool) -> anyhow::Result<String> {
        if !mimique_stimulus::is_source(path) {
            bail!("{}: there is no such file; check the path", path.display());
        }
        // What consists of several files stays where it is.
        let is_one = path.is_file() && path.extension().is_none_or(|end| end != "gltf");
        if reference || !is_one {
            let whole = std::path::absolute(path).map_err(|e| unread(path, &e))?;
            return Ok(whole.display().to_string());
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let there = format!("{FOLDER}/{name}");
        if let Some((other, _)) = self.copied.iter().find(|(_, taken)| *taken == there) {
            if other != path {
                bail!(
                    "{} and {}: both are called {name}; rename one, or keep them where they are by --reference",
                    other.display(),
                    path.display()
                );
            }
            return Ok(there);
        }
        self.copied.push((path.to_owned(), there.clone()));
        for beside in [sidecar_path(path), path.with_extension("avatar.json")] {
            if beside.is_file() {
                let name = beside.file_name().unwrap_or_default().to_string_lossy().into_owned();
                self.copied.push((beside, format!("{FOLDER}/{name}")));
            }
        }
        Ok(there)
    }
}

/// The clips of a capture: those of a file of segments, and single cuts.
fn cuts(capture: &Path, wishes: &Wishes) -> anyhow::Result<Vec<TakeSegment>> {
    let mut takes = match &wishes.segments {
        None => Vec::new(),
        Some(file) => {
            let text = std::fs::read_to_string(file).map_err(|e| unread(file, &e))?;
            let blame = |e: String| anyhow!("{}: {e}", file.display());
            if file.extension().is_some_and(|end| end.eq_ignore_ascii_case("eaf")) {
                let rate_hz = CaptureFile::open(capture)
                    .and_then(|mut file| file.recording(&ReadOptions::default()))
                    .map_err(|e| anyhow!("{}: {e}", capture.display()))?
                    .capture
                    .rate_hz;
                let document = EafDocument::parse(&text).map_err(|e| blame(e.to_string()))?;
                let read = document.segments(&wishes.tier, rate_hz);
                read.map_err(|e| blame(e.to_string()))?.segments
            } else {
                read_segments(&text).map_err(|e| blame(e.to_string()))?
            }
        }
    };
    takes.extend(wishes.cuts.iter().cloned());
    if takes.is_empty() {
        bail!(
            "{}: no segment of it is named; give --cut 330:570:jaw-open, once for each clip, or --segments segments.csv \
             (`mimique segment {} --out segments.csv` suggests them)",
            capture.display(),
            capture.display()
        );
    }
    Ok(takes)
}

fn unread(path: &Path, error: &std::io::Error) -> anyhow::Error {
    anyhow!("{}: open: {error}; check the path", path.display())
}
