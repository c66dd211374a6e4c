//! The files behind a study: those that its file names and those that are read along with them, and its packs; each with
//! its SHA-256.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Read as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow};
use mimique_deposit::{Pack, StudySource, place_of};
use mimique_stimulus::Places;
use mimique_study::{check, resolve_path};
use sha2::{Digest as _, Sha256};

/// Every file that a study names, and what is read along with it, by its place below the deposit's study file.
pub(super) fn of_study(study_file: &Path) -> anyhow::Result<Vec<StudySource>> {
    let text =
        std::fs::read_to_string(study_file).with_context(|| study_file.display().to_string())?;
    // The check is the one place that knows which values are paths.
    let named = RefCell::new(BTreeSet::new());
    check(&text, &|path| {
        named.borrow_mut().insert(path.to_owned());
        Ok(())
    });
    let places = Places::of(study_file, PathBuf::new());
    let mut found: BTreeMap<String, StudySource> = BTreeMap::new();
    for (number, named) in named.into_inner().into_iter().enumerate() {
        let from = resolve_path(&named, &places.study, places.data.as_deref())
            .with_context(|| study_file.display().to_string())?;
        let place = place_of(&named, number + 1);
        for (beside, path) in along_with(&from)? {
            let place = match beside.as_str() {
                "" => place.clone(),
                beside => in_folder_of(&place, beside),
            };
            let (sha256, bytes) = hash(&path)?;
            let named = (beside.is_empty()).then(|| named.clone());
            let source = StudySource { named, place: place.clone(), from: path, sha256, bytes };
            // What is named itself goes before what is read along with another.
            if source.named.is_some() || !found.contains_key(&place) {
                found.insert(place, source);
            }
        }
    }
    Ok(found.into_values().collect())
}

/// The packs of these hashes.
pub(super) fn packs(hashes: &BTreeSet<&str>, folder: &Path) -> anyhow::Result<Vec<Pack>> {
    let pack = |sha256: &&str| {
        let from = folder.join(sha256);
        let bytes = std::fs::metadata(&from).with_context(|| from.display().to_string())?.len();
        Ok(Pack { sha256: (*sha256).to_owned(), from, bytes })
    };
    hashes.iter().map(pack).collect()
}

/// SHA-256 and size of a file.
pub(super) fn hash(path: &Path) -> anyhow::Result<(String, u64)> {
    let read = || -> std::io::Result<(String, u64)> {
        let mut file = std::fs::File::open(path)?;
        let (mut digest, mut bytes, mut buffer) = (Sha256::new(), 0, vec![0; 1 << 16]);
        loop {
            match file.read(&mut buffer)? {
                0 => return Ok((hex::encode(digest.finalize()), bytes)),
                count => {
                    digest.update(&buffer[..count]);
                    bytes += count as u64;
                }
            }
        }
    };
    read().map_err(|error| anyhow!("{}: cannot be read ({error}); check the file", path.display()))
}

/// A file and what is read along with it, each by its path from the file's folder; the file's own is empty. Of a folder of
/// poses all of its files.
fn along_with(path: &Path) -> anyhow::Result<Vec<(String, PathBuf)>> {
    let at = || path.display().to_string();
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut found = Vec::new();
    if path.is_dir() {
        for entry in std::fs::read_dir(path).with_context(at)? {
            let inside = entry.with_context(at)?;
            if inside.path().is_file() {
                let own = inside.file_name().to_string_lossy().into_owned();
                found.push((format!("{name}/{own}"), inside.path()));
            }
        }
    } else {
        found.push((String::new(), path.to_owned()));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    // Settings, repairs and names of shapes stand beside it, and begin as its own name does.
    let begin = format!("{}.", name.split('.').next().unwrap_or_default());
    for entry in std::fs::read_dir(folder).with_context(at)? {
        let entry = entry.with_context(at)?;
        let other = entry.file_name().to_string_lossy().into_owned();
        if other != name && other.starts_with(&begin) && entry.path().is_file() {
            found.push((other, entry.path()));
        }
    }
    if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("gltf")) {
        let parts = referred_to(path)?;
        found.extend(parts.into_iter().map(|part| (part.clone(), folder.join(part))));
    }
    found.sort();
    Ok(found)
}

/// The files that a glTF refers to, below its folder.
fn referred_to(path: &Path) -> anyhow::Result<Vec<String>> {
    let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
    let gltf: serde_json::Value =
        serde_json::from_slice(&bytes).with_context(|| path.display().to_string())?;
    let parts = ["buffers", "images"].into_iter().filter_map(|key| gltf[key].as_array()).flatten();
    let addresses = parts.filter_map(|part| part["uri"].as_str());
    let stays = |address: &&str| {
        !address.starts_with("data:") && !address.split('/').any(|part| part == "..")
    };
    Ok(addresses.filter(stays).map(str::to_owned).collect())
}

/// A file beside another's place.
fn in_folder_of(place: &str, beside: &str) -> String {
    match place.rsplit_once('/') {
        Some((folder, _)) => format!("{folder}/{beside}"),
        None => beside.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_study_has_its_sources_with_what_is_read_along_with_them() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("in")).unwrap();
        std::fs::write(at("in/head.gltf"), r#"{"buffers":[{"uri":"head.bin"},{"uri":"data:x"}]}"#)
            .unwrap();
        for name in ["in/head.bin", "in/take.c3d", "in/take.c3d.repair.json", "in/private.txt"] {
            std::fs::write(at(name), name).unwrap();
        }
        let names = |path: &str| -> Vec<String> {
            along_with(&at(path)).unwrap().into_iter().map(|(name, _)| name).collect()
        };
        assert_eq!(names("in/take.c3d"), ["", "take.c3d.repair.json"]);
        // What stands beside it under its own name, and what it refers to.
        assert_eq!(names("in/head.gltf"), ["", "head.bin", "head.bin"]);
        assert_eq!(in_folder_of("a/b.c3d", "b.json"), "a/b.json");
        let (sha256, bytes) = hash(&at("in/take.c3d")).unwrap();
        assert_eq!((sha256, bytes), (hex::encode(Sha256::digest(b"in/take.c3d")), 11));
    }
}
