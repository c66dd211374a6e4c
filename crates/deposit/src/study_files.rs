//! The study file as it is deposited: without what is secret while a study runs, and with paths that lead into the
//! deposit; and the files that it names, or their hashes.

use std::collections::BTreeMap;
use std::path::PathBuf;

use mimique_study::{config_hash, published};
use serde_json::{Value, json};

use crate::file::{DepositFile, NotWritten, json_bytes};

/// Its folder in the deposit.
pub const FOLDER: &str = "study";

/// What is secret: completion codes prove that somebody took part, and the address that takes answers is open to all who
/// know it.
const SECRETS: [&str; 7] = [
    "/recruitment/completionCode",
    "/recruitment/screenedOutCode",
    "/recruitment/deviceCode",
    "/recruitment/failedChecksCode",
    "/recruitment/redirect",
    "/recruitment/returnAfterSeconds",
    "/staticHosting/post",
];

/// A file that a study names, or that is read along with one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudySource {
    /// How the study file names it; none of what is read along with another.
    pub named: Option<String>,
    /// Where it stands below the deposit's study file.
    pub place: String,
    /// Where it lies.
    pub from: PathBuf,
    /// SHA-256.
    pub sha256: String,
    /// Its size.
    pub bytes: u64,
}

/// A version of the study, as it was served.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyVersion {
    /// The file as JSON.
    pub file: Value,
}

/// What was taken out of a study file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Changed {
    /// JSON pointers of what was taken out.
    pub removed: Vec<&'static str>,
    /// Hash of the file as it was served: that of the column `config_hash`.
    pub served_hash: String,
    /// Hash of the file as it is deposited.
    pub deposited_hash: String,
}

/// Where a named path stands below the study file: as it is named where that stays in the study's folder, else in a folder
/// `files/NUMBER` of its own, which tells nothing of the machine that it comes from.
pub fn place_of(named: &str, number: usize) -> String {
    let parts: Vec<&str> = named.split(['/', '\\']).collect();
    let stays = !named.starts_with(['/', '$', '\\'])
        && !named.contains(':')
        && parts.iter().all(|part| !matches!(*part, ".." | "." | ""));
    if stays {
        return parts.join("/");
    }
    let name = parts.iter().rev().find(|part| !matches!(**part, ".." | "." | ""));
    format!("files/{number}/{}", name.unwrap_or(&"file"))
}

/// A study file without secrets, its paths leading to where its sources are.
pub fn deposited(file: &Value, sources: &[StudySource]) -> (Value, Changed) {
    let mut value = file.clone();
    let mut removed = Vec::new();
    for secret in SECRETS {
        let Some((parent, key)) = secret.rsplit_once('/') else { continue };
        let parent = value.pointer_mut(parent).and_then(Value::as_object_mut);
        if parent.is_some_and(|parent| parent.remove(key).is_some()) {
            removed.push(secret);
        }
    }
    let moved: BTreeMap<&str, &str> = (sources.iter())
        .filter_map(|source| Some((source.named.as_deref()?, &*source.place)))
        .filter(|(named, place)| named != place)
        .collect();
    lead(&mut value, &moved);
    let value = published(file, value);
    let (served_hash, deposited_hash) = (config_hash(file), config_hash(&value));
    (value, Changed { removed, served_hash, deposited_hash })
}

/// Puts the new place of each path where the old one stands.
fn lead(value: &mut Value, moved: &BTreeMap<&str, &str>) {
    match value {
        Value::String(text) => {
            if let Some(place) = moved.get(&**text) {
                *text = (*place).to_owned();
            }
        }
        Value::Array(values) => values.iter_mut().for_each(|value| lead(value, moved)),
        Value::Object(values) => values.values_mut().for_each(|value| lead(value, moved)),
        _ => {}
    }
}

/// The study files of a deposit: `study.json`, earlier versions, what they name (or its hashes), and what was changed.
pub(crate) fn files(
    versions: &[StudyVersion],
    sources: &[StudySource],
    with_sources: bool,
) -> Result<(Vec<DepositFile>, Vec<Changed>), NotWritten> {
    let mut made = Vec::new();
    let mut changes = Vec::new();
    for (place, version) in versions.iter().enumerate() {
        let (value, changed) = deposited(&version.file, sources);
        // The last is the one that is run again.
        let name = match place + 1 == versions.len() {
            true => format!("{FOLDER}/study.json"),
            false => format!("{FOLDER}/earlier/{}.json", &changed.served_hash[..12]),
        };
        made.push(DepositFile::made(name, json_bytes(&value)?));
        changes.push(changed);
    }
    let listed: Vec<Value> = (sources.iter())
        .map(|source| {
            json!({ "path": source.place, "sha256": source.sha256, "bytes": source.bytes })
        })
        .collect();
    let about: Vec<Value> = (changes.iter())
        .map(|changed| {
            json!({
                "config_hash_served": changed.served_hash,
                "config_hash_deposited": changed.deposited_hash,
                "removed": changed.removed,
            })
        })
        .collect();
    let about = json!({ "versions": about, "sources": listed, "sources_deposited": with_sources });
    made.push(DepositFile::made(format!("{FOLDER}/provenance.json"), json_bytes(&about)?));
    if with_sources {
        made.extend(sources.iter().map(|source| {
            let (path, hash) = (format!("{FOLDER}/{}", source.place), source.sha256.clone());
            DepositFile::copied(path, source.from.clone(), hash, source.bytes)
        }));
    }
    Ok((made, changes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_or_lead_into_files() {
        for (named, place) in [
            ("stimuli/take.c3d", "stimuli/take.c3d"),
            ("head.glb", "head.glb"),
            ("../shared/head.glb", "files/3/head.glb"),
            ("/home/me/head.glb", "files/3/head.glb"),
            ("${MIMIQUE_DATA}/ict/head.glb", "files/3/head.glb"),
            ("C:\\faces\\head.glb", "files/3/head.glb"),
            ("./a.c3d", "files/3/a.c3d"),
        ] {
            assert_eq!(place_of(named, 3), place, "{named}");
        }
    }

    #[test]
    fn codes_are_taken_out_and_paths_lead_into_the_deposit() {
        let file = json!({
            "recruitment": { "completionCode": "C0DE", "urlParameters": ["A"], "redirect": "https://x/{code}" },
            "stimuli": { "avatars": { "head": { "file": "../a.glb" } } },
        });
        let source = StudySource {
            named: Some("../a.glb".into()),
            place: place_of("../a.glb", 1),
            from: PathBuf::new(),
            sha256: String::new(),
            bytes: 0,
        };
        let (value, changed) = deposited(&file, &[source]);
        assert!(!value.to_string().contains("C0DE") && !value.to_string().contains("https"));
        assert_eq!(value["stimuli"]["avatars"]["head"]["file"], "files/1/a.glb");
        assert_eq!(changed.removed, ["/recruitment/completionCode", "/recruitment/redirect"]);
        assert_ne!(changed.served_hash, changed.deposited_hash);
        let (same, unchanged) = deposited(&json!({ "id": "x" }), &[]);
        assert_eq!(same, json!({ "id": "x" }));
        assert_eq!(unchanged.served_hash, unchanged.deposited_hash);
    }
}
