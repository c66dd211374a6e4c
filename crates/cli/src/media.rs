//! Pictures and signed videos of a study's questions, kept by content hash beside its stimuli.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mimique_storage::durable_file;
use mimique_study::ClipSource;
use mimique_study::{MEDIA_PREFIX, Study, media_type, resolve_path};
use serde_json::json;
use sha2::{Digest as _, Sha256};

/// Puts every such file into the folder of the packs, and names it among the clips.
pub fn add(
    study: &Study,
    file: &Path,
    packs: &Path,
    clips: &mut BTreeMap<String, ClipSource>,
) -> Result<(), String> {
    let folder = file.parent().unwrap_or(Path::new("."));
    let data = std::env::var_os("MIMIQUE_DATA").map(PathBuf::from);
    for path in study.media() {
        let place =
            resolve_path(path, folder, data.as_deref()).map_err(|error| error.to_string())?;
        let at = |error: std::io::Error| {
            format!("{}: cannot be read ({error}); correct the path", place.display())
        };
        let bytes = std::fs::read(&place).map_err(at)?;
        let hash = hex::encode(Sha256::digest(&bytes));
        std::fs::create_dir_all(packs).map_err(at)?;
        let kept = packs.join(&hash);
        if !kept.exists() {
            durable_file::write(&kept, &bytes).map_err(at)?;
        }
        let source = json!({
            "avatar": hash, "operators": "", "take": "", "method": { "method": "recorded" },
            "duration_ms": 0.0, "bytes": bytes.len(), "provenance": hash, "weights_hash": "",
            "video": media_type(path),
        });
        let source = serde_json::from_value(source).map_err(|error| error.to_string())?;
        clips.insert(format!("{MEDIA_PREFIX}{path}"), source);
    }
    Ok(())
}
