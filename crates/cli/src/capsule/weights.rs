//! The weights of a capsule's clips as plain numbers: what was shown, for those who have no decoder of packs.

use std::path::Path;

use anyhow::Context as _;
use mimique_clip::{SolvedTake, solve_packs};
use mimique_study::ClipSource;

/// Weights as CSV: a row per frame, its time in seconds and the weight of each shape, every digit that a double has. None of
/// videos, and of faces at rest, which have no weights of their own.
pub fn csv_of(clip: &str, source: &ClipSource, packs: &Path) -> anyhow::Result<Option<Vec<u8>>> {
    if source.video.is_some() || source.units.is_some() {
        return Ok(None);
    }
    let read = |hash: &str| match hash {
        "" => Ok(Vec::new()),
        hash => {
            let path = packs.join(hash);
            std::fs::read(&path).with_context(|| path.display().to_string())
        }
    };
    let solved = solve_packs(&read(&source.operators)?, &read(&source.take)?, &source.method);
    let solved = solved.with_context(|| format!("clip {clip}"))?;
    table(&solved).map(Some)
}

fn table(solved: &SolvedTake) -> anyhow::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(
        std::iter::once("time_s").chain(solved.shape_names.iter().map(String::as_str)),
    )?;
    for (frame, weights) in solved.weights.chunks(solved.shape_names.len().max(1)).enumerate() {
        let time = frame as f64 / solved.rate_hz;
        writer.write_record(
            std::iter::once(time).chain(weights.iter().copied()).map(|x| x.to_string()),
        )?;
    }
    Ok(writer.into_inner()?)
}
