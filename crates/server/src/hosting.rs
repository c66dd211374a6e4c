//! A study's stimuli, pictures and signed videos made ready to be hosted: the one way for studies that the
//! server is started with, for those that come through the page, and for exported sites.

use std::collections::BTreeMap;

use crate::comparison::comparison_of;
use mimique_comparison::ClipMeasures;
use mimique_stimulus::{Places, Progress, prepare};
use mimique_storage::durable_file;
use mimique_study::{
    ClipSource, MEDIA_PREFIX, MIMICRY_FILES, MimicryFile, Study, media_type, resolve_path,
};
use serde_json::json;
use sha2::{Digest as _, Sha256};

/// What a study needs to be hosted.
#[derive(Debug)]
pub struct Hosting {
    /// Its clips and media, by identifier.
    pub clips: BTreeMap<String, ClipSource>,
    /// What was measured of the clips.
    pub measures: Vec<ClipMeasures>,
    /// What should be looked at: the place in the study file, and a sentence.
    pub warnings: Vec<(String, String)>,
}

/// Prepares the clips of a study, and keeps its pictures and videos by content hash beside their packs.
///
/// # Errors
/// Clips cannot be prepared, or a file cannot be read: a sentence for each fault.
pub fn prepare_hosting(
    study: &Study,
    places: &Places,
    progress: &mut dyn FnMut(Progress<'_>),
) -> Result<Hosting, Vec<String>> {
    let mut prepared = prepare(study, places, &mut *progress)
        .map_err(|faults| faults.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    add_media(study, places, &mut prepared.clips).map_err(|fault| vec![fault])?;
    let comparison =
        comparison_of(study, &prepared.clips, &places.packs).map_err(|fault| vec![fault])?;
    prepared.warnings.extend(comparison.unlike.iter().map(|unlike| {
        let (what, remedy) = unlike.words();
        ("/stimuli/segments".to_owned(), format!("{what}; {remedy}"))
    }));
    Ok(Hosting {
        clips: prepared.clips,
        measures: comparison.measures,
        warnings: prepared.warnings,
    })
}

/// Puts every picture and video, and what measures participants' faces, into the folder of the packs, and names it among the clips.
fn add_media(
    study: &Study,
    places: &Places,
    clips: &mut BTreeMap<String, ClipSource>,
) -> Result<(), String> {
    let media = study.media().into_iter().map(|path| {
        (format!("{MEDIA_PREFIX}{path}"), path.to_owned(), media_type(path).map(str::to_owned))
    });
    let of_mimicry = study.mimicry.iter().flat_map(|mimicry| {
        let of =
            |file: MimicryFile| (file.key(), file.path(mimicry), Some(file.media_type.to_owned()));
        MIMICRY_FILES.map(of)
    });
    for (key, path, media_type) in media.chain(of_mimicry) {
        let place = resolve_path(&path, &places.study, places.data.as_deref())
            .map_err(|error| error.to_string())?;
        let at = |error: std::io::Error| {
            format!("{}: cannot be read ({error}); correct the path", place.display())
        };
        let bytes = std::fs::read(&place).map_err(at)?;
        let hash = hex::encode(Sha256::digest(&bytes));
        std::fs::create_dir_all(&places.packs).map_err(at)?;
        let kept = places.packs.join(&hash);
        if !kept.exists() {
            durable_file::write(&kept, &bytes).map_err(at)?;
        }
        let source = json!({
            "avatar": hash, "operators": "", "take": "", "method": { "method": "recorded" },
            "duration_ms": 0.0, "bytes": bytes.len(), "provenance": hash, "weights_hash": "",
            "video": media_type,
        });
        let source = serde_json::from_value(source).map_err(|error| error.to_string())?;
        clips.insert(key, source);
    }
    Ok(())
}
