//! ELAN documents that commands write into: one that is there keeps everything else.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::anyhow;
use mimique_stimulus::EafDocument;
use mimique_study::iso_time;

/// Whether a file's name is that of an ELAN document.
pub fn is_eaf(file: &Path) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case("eaf"))
}

/// The document of a file, or a new one where there is none.
pub fn document(file: &Path, media: Option<&str>) -> anyhow::Result<EafDocument> {
    let blame = |e: String| anyhow!("{}: {e}", file.display());
    let document = match std::fs::read_to_string(file) {
        Ok(text) => EafDocument::parse(&text),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => EafDocument::new(&now(), media),
        Err(e) => return Err(blame(format!("open: {e}; check the path"))),
    };
    document.map_err(|e| blame(e.to_string()))
}

/// The present time as ISO 8601.
fn now() -> String {
    let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
    iso_time(since_1970.map_or(0.0, |since| since.as_secs() as f64 * 1000.0))
}
