//! What was prepared before, known by the hash of everything that it was made of: the study's stimuli, the
//! files that it names, and the program itself. Nothing is read or solved anew that is known.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use mimique_clip::sha256_hex;
use mimique_study::{ClipSource, Study};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::cache::Cache;
use super::{Places, PrepareError, Prepared};
use crate::provenance::{Provenance, sha256_of_file};

/// Files that are looked at beside one that is named: a folder with more is not known.
const MOST_FILES: usize = 4096;

/// A preparation as it is kept.
#[derive(Serialize, Deserialize)]
struct Kept {
    /// What each file was known by, whose content it was made of.
    files: BTreeMap<PathBuf, String>,
    clips: BTreeMap<String, ClipSource>,
    warnings: Vec<(String, String)>,
}

/// Files that were asked for while something is prepared, and what each was known by before it was read.
#[derive(Default)]
pub(super) struct Asked(RefCell<BTreeMap<PathBuf, Option<String>>>);

impl Asked {
    /// Notes that a file is asked for.
    pub fn note(&self, path: &Path) {
        let mut files = self.0.borrow_mut();
        files.entry(path.to_owned()).or_insert_with(|| fingerprint(path));
    }

    /// What all of them were known by; none where one of them cannot be known again.
    fn files(&self) -> Option<BTreeMap<PathBuf, String>> {
        let known =
            |(path, known): (&PathBuf, &Option<String>)| Some((path.clone(), known.clone()?));
        self.0.borrow().iter().map(known).collect()
    }
}

/// What the preparation of a study by this program is known by, beside the content of its files; none where
/// the program cannot be read.
pub(super) fn key(study: &Study, places: &Places) -> Option<Provenance> {
    let program = sha256_of_file(&std::env::current_exe().ok()?).ok()?;
    let folder = |path: &Path| std::path::absolute(path).map(|path| path.display().to_string());
    Some(
        Provenance::default()
            .json("prepared", "study")
            .json("program", program)
            .json("stimuli", serde_json::to_value(&study.stimuli).ok()?)
            .json("levels", level_clips(study))
            .json("at rest", clips_at_rest(study))
            .json("folder", folder(&places.study).ok()?)
            .json("data", json!(places.data.as_deref().map(folder).transpose().ok()?)),
    )
}

/// The clips of adaptive blocks: they are prepared beside those of the stimuli.
fn level_clips(study: &Study) -> serde_json::Value {
    let clips = study.level_clips();
    json!(clips.iter().map(|level| (&level.clip.id, &level.method.spec)).collect::<Vec<_>>())
}

/// The clips of blocks of reverse correlation.
fn clips_at_rest(study: &Study) -> serde_json::Value {
    let clips = study.clips_at_rest();
    let of = |(clip, block): &(mimique_study::Clip, mimique_study::ReverseCorrelationComponent)| {
        json!([clip.id, clip.avatar, block.units, block.duration_seconds])
    };
    json!(clips.iter().map(of).collect::<Vec<_>>())
}

/// What was prepared under this key, if all of its files are what they were and all packs are there.
pub(super) fn find(cache: &Cache, key: &Provenance) -> Option<Prepared> {
    let kept: Kept = serde_json::from_str(&cache.note(key)?).ok()?;
    let is_same = |(path, known): (&PathBuf, &String)| fingerprint(path).as_ref() == Some(known);
    let packs: BTreeSet<&str> = kept.clips.values().flat_map(|clip| clip.packs()).collect();
    let is_known =
        kept.files.iter().all(is_same) && packs.into_iter().all(|hash| cache.holds(hash));
    is_known.then_some(Prepared { clips: kept.clips, warnings: kept.warnings })
}

/// Keeps what was prepared. What cannot be known again is not kept.
pub(super) fn keep(
    cache: &Cache,
    key: &Provenance,
    asked: &Asked,
    prepared: &Prepared,
) -> Result<(), PrepareError> {
    let Some(files) = asked.files() else { return Ok(()) };
    let Prepared { clips, warnings } = prepared.clone();
    match serde_json::to_string(&Kept { files, clips, warnings }) {
        Ok(text) => cache.keep_note(key, &text),
        Err(_) => Ok(()),
    }
}

/// What a file and those that are read along with it are known by: files beside it whose names begin as its own
/// does (settings, repairs, names of shapes), all of a folder, and all that a glTF may refer to.
fn fingerprint(path: &Path) -> Option<String> {
    let mut files = BTreeSet::new();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("gltf")) {
        gather(folder, &mut files)?;
    }
    if path.is_dir() {
        gather(path, &mut files)?;
    }
    let name = path.file_name()?.to_string_lossy().into_owned();
    let begin = format!("{}.", name.split('.').next().unwrap_or_default());
    for entry in fs::read_dir(folder).ok()? {
        let entry = entry.ok()?;
        let other = entry.file_name().to_string_lossy().into_owned();
        if (other == name || other.starts_with(&begin)) && entry.path().is_file() {
            files.insert(entry.path());
        }
    }
    let mut known = Provenance::default();
    for file in &files {
        let name = file.strip_prefix(folder).unwrap_or(file).display().to_string();
        known = known.json(&name, sha256_of_file(file).ok()?);
    }
    (!files.is_empty()).then(|| known.hash())
}

/// The files of a folder and of those in it; none where there are too many.
fn gather(folder: &Path, files: &mut BTreeSet<PathBuf>) -> Option<()> {
    for entry in fs::read_dir(folder).ok()? {
        let path = entry.ok()?.path();
        if path.is_dir() {
            gather(&path, files)?;
        } else {
            files.insert(path);
        }
        if files.len() > MOST_FILES {
            return None;
        }
    }
    Some(())
}

/// Whether a text is the hash of something.
pub(super) fn is_hash(text: &str) -> bool {
    text.len() == sha256_hex(b"").len() && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_known_by_its_content_and_by_what_is_read_along_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("take1.c3d"), "one").unwrap();
        fs::write(at("take10.c3d"), "ten").unwrap();
        let first = fingerprint(&at("take1.c3d")).unwrap();
        assert_eq!(fingerprint(&at("take1.c3d")), Some(first.clone()));
        fs::write(at("take10.c3d"), "another").unwrap();
        assert_eq!(fingerprint(&at("take1.c3d")), Some(first.clone()), "that is another take");
        fs::write(at("take1.c3d.repair.json"), "{}").unwrap();
        let repaired = fingerprint(&at("take1.c3d")).unwrap();
        assert_ne!(repaired, first);
        fs::write(at("take1.c3d"), "eno").unwrap();
        assert_ne!(fingerprint(&at("take1.c3d")), Some(repaired));
        assert_eq!(fingerprint(&at("absent.c3d")), None);
        // A folder of poses, with its settings beside it.
        fs::create_dir(at("poses")).unwrap();
        fs::write(at("poses/smile.obj"), "v").unwrap();
        let poses = fingerprint(&at("poses")).unwrap();
        fs::write(at("poses.avatar.json"), "{}").unwrap();
        let set = fingerprint(&at("poses")).unwrap();
        assert_ne!(set, poses);
        fs::write(at("poses/smile.obj"), "w").unwrap();
        assert_ne!(fingerprint(&at("poses")), Some(set));
        // What a glTF refers to lies anywhere below its folder.
        fs::create_dir(at("head")).unwrap();
        fs::write(at("head/head.gltf"), "{}").unwrap();
        fs::create_dir(at("head/maps")).unwrap();
        fs::write(at("head/maps/skin.png"), "a").unwrap();
        let head = fingerprint(&at("head/head.gltf")).unwrap();
        fs::write(at("head/maps/skin.png"), "b").unwrap();
        assert_ne!(fingerprint(&at("head/head.gltf")), Some(head));
    }
}
