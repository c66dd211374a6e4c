//! The clips of a hosted study held against each other, computed once and kept beside their packs.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use mimique_comparison::{StudyComparison, compare_clips};
use mimique_stimulus::{Provenance, sha256_of_file};
use mimique_storage::durable_file;
use mimique_study::{ClipSource, Study};
use serde_json::json;

/// How the clips of each segment differ. It is read from the folder of the packs where this very program has
/// computed it of the same clips, and put there otherwise.
///
/// # Errors
/// A sentence: a pack that is absent or damaged.
pub(crate) fn comparison_of(
    study: &Study,
    clips: &BTreeMap<String, ClipSource>,
    folder: &Path,
) -> Result<StudyComparison, String> {
    let kept = key(study, clips).map(|key| folder.join(format!("comparison-{key}.json")));
    let known = kept.as_ref().and_then(|path| std::fs::read_to_string(path).ok());
    if let Some(known) = known.and_then(|text| serde_json::from_str(&text).ok()) {
        return Ok(known);
    }
    let read = |hash: &str| std::fs::read(folder.join(hash));
    let computed = compare_clips(study, clips, &read).map_err(|error| error.to_string())?;
    if let (Some(path), Ok(text)) = (kept, serde_json::to_vec(&computed)) {
        let keep = |error: io::Error| format!("{}: {error}; check the folder", path.display());
        durable_file::write(&path, &text).map_err(keep)?;
    }
    Ok(computed)
}

/// What a comparison is known by; none where the program cannot be read.
fn key(study: &Study, clips: &BTreeMap<String, ClipSource>) -> Option<String> {
    let program = sha256_of_file(&std::env::current_exe().ok()?).ok()?;
    let made: BTreeMap<&String, &str> =
        clips.iter().map(|(id, clip)| (id, clip.provenance.as_str())).collect();
    let stimuli = serde_json::to_value(&study.stimuli).ok()?;
    let mut key = Provenance::default().json("program", program).json("stimuli", stimuli);
    if study.mimicry.is_some() {
        key = key.json("courses", true);
    }
    Some(key.json("clips", json!(made)).hash())
}
