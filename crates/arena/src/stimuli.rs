//! What the arena shows, clip by clip, and the hashes by which it is known in every laboratory.

use std::collections::BTreeMap;
use std::path::Path;

use mimique_stimulus::{Places, PrepareError, Prepared, Progress, prepare};
use mimique_study::Study;
use serde::Serialize;

use crate::study::{FACTOR, TAKE};

/// A clip of the arena.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ArenaClip {
    /// The method.
    pub method: String,
    /// The segment.
    pub take: String,
    /// Provenance: SHA-256 over the packs of head and weights, of sound, and the weights as they are played.
    pub provenance: String,
    /// SHA-256 of the weights as browsers play them.
    pub weights_hash: String,
    /// How long it is, milliseconds.
    pub duration_ms: f64,
}

/// All clips of an arena.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ArenaStimuli {
    /// By provenance.
    by_hash: BTreeMap<String, Vec<ArenaClip>>,
}

impl ArenaStimuli {
    /// Of the prepared clips of the arena's study.
    pub fn of(study: &Study, prepared: &Prepared) -> Self {
        let mut by_hash: BTreeMap<String, Vec<ArenaClip>> = BTreeMap::new();
        for clip in study.clips() {
            let source = prepared.clips.get(&clip.id);
            let (Some(source), Some(method), Some(take)) =
                (source, clip.factor_text(FACTOR), clip.factor_text(TAKE))
            else {
                continue;
            };
            by_hash.entry(source.provenance.clone()).or_default().push(ArenaClip {
                method,
                take,
                provenance: source.provenance.clone(),
                weights_hash: source.weights_hash.clone(),
                duration_ms: source.duration_ms,
            });
        }
        Self { by_hash }
    }

    /// Prepares the clips of an arena's study, whose files are in `folder`, as a server does; packs go to `packs`.
    ///
    /// # Errors
    /// Every clip that cannot be prepared.
    pub fn prepare(
        study: &Study,
        folder: &Path,
        packs: &Path,
        progress: &mut dyn FnMut(Progress<'_>),
    ) -> Result<Self, Vec<PrepareError>> {
        let places = Places { study: folder.to_owned(), data: None, packs: packs.to_owned() };
        Ok(Self::of(study, &prepare(study, &places, progress)?))
    }

    /// From clips.
    pub fn from_clips(clips: impl IntoIterator<Item = ArenaClip>) -> Self {
        let mut by_hash: BTreeMap<String, Vec<ArenaClip>> = BTreeMap::new();
        for clip in clips {
            by_hash.entry(clip.provenance.clone()).or_default().push(clip);
        }
        Self { by_hash }
    }

    /// Whether the clip of a method and segment has this hash.
    pub fn is(&self, method: &str, take: &str, hash: &str) -> bool {
        let clips = self.by_hash.get(hash);
        clips.is_some_and(|clips| clips.iter().any(|c| c.method == method && c.take == take))
    }

    /// The clip of a method and segment.
    pub fn clip(&self, method: &str, take: &str) -> Option<&ArenaClip> {
        self.clips().find(|clip| clip.method == method && clip.take == take)
    }

    /// All clips.
    pub fn clips(&self) -> impl Iterator<Item = &ArenaClip> {
        self.by_hash.values().flatten()
    }
}
