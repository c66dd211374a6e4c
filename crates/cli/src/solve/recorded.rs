//! `mimique solve --method recorded`: weights of a file under the avatar's own names.

use std::io::Write as _;

use anyhow::bail;
use mimique_clip::weights_hash;
use mimique_mocap::WeightOptions;
use mimique_stimulus::{
    GazeStatistics, Performance, Provenance, RecordedWeights, avatar_key, read_performance,
    sha256_of_file,
};
use serde_json::json;

use super::{Args, blame, write_weights};
use crate::output;

pub(super) fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    if args.vertices.is_some() || args.markers.is_some() || args.training.is_some() {
        bail!("--method: recorded solves nothing; remove --markers, --vertices and --training");
    }
    let avatar =
        mimique_avatar_files::read_avatar(&args.avatar).map_err(|e| blame(&args.avatar, e))?;
    let options = WeightOptions {
        rate_hz: args.mocap_rate,
        shape_names: avatar.avatar.face_shapes(),
        animation: args.animation.as_deref(),
    };
    let Performance { table: recorded, format } =
        read_performance(&args.mocap, &options).map_err(|e| blame(&args.mocap, e))?;
    let mut notes = vec![format!("read as {format}")];
    notes.extend(recorded.notes.iter().cloned());
    let RecordedWeights { table, names } = RecordedWeights::with_expressions(
        &recorded,
        &avatar.avatar.shape_names,
        &avatar.avatar.expressions,
    )
    .map_err(|e| blame(&args.mocap, e))?;
    let hash = weights_hash(&table.weights);
    let provenance = Provenance::new()
        .json("avatar", avatar_key(&avatar.avatar))
        .json(
            "recorded",
            sha256_of_file(&args.mocap).map_err(|e| {
                blame(&args.mocap, format!("open: {e}; check the path and its permissions"))
            })?,
        )
        .json("weights", hash.as_str())
        .hash();
    let gaze = GazeStatistics::of(&table.shape_names, &table.weights);
    let first_frame = table.frames.first().copied().unwrap_or_default();
    let of_gaze = gaze.as_ref().and_then(|gaze| gaze.warning(first_frame));
    let said = names.warnings(true).into_iter().chain(of_gaze);
    let mut warnings: Vec<String> = said.map(|warning| warning.to_string()).collect();
    warnings.extend(write_weights(&table, &args.out)?);
    let report = json!({
        "method": {"method": "recorded"},
        "avatar": avatar.avatar.name,
        "frames": table.frames.len(),
        "rate_hz": table.rate_hz(),
        "shapes": table.shape_names.len(),
        "names": names,
        "gaze": gaze,
        "warnings": warnings,
        "notes": notes,
        "weights_hash": hash,
        "provenance": provenance,
        "files": {"avatar": args.avatar, "mocap": args.mocap, "out": args.out},
    });
    if let Some(path) = &args.report {
        let text = serde_json::to_string_pretty(&report)? + "\n";
        output::write(path, text.as_bytes())?;
    }
    let mut out = std::io::stdout().lock();
    if json {
        writeln!(out, "{}", serde_json::to_string_pretty(&report)?)?;
        return Ok(());
    }
    let rate = table.rate_hz().map_or(String::new(), |rate| format!(" at {rate:.2} Hz"));
    writeln!(
        out,
        "{}: {} frames{rate}, {} of {} shapes driven by {} columns, method recorded",
        args.out.display(),
        table.frames.len(),
        names.driven.len(),
        table.shape_names.len(),
        recorded.shape_names.len() - names.unused.len(),
    )?;
    if let Some(gaze) = gaze.as_ref().filter(|gaze| !gaze.is_still()) {
        writeln!(out, "gaze {}", gaze.words())?;
    }
    writeln!(out, "weights {hash}\nprovenance {provenance}")?;
    let mocap = args.mocap.display();
    notes.iter().try_for_each(|note| writeln!(out, "note: {mocap}: {note}"))?;
    warnings.iter().try_for_each(|warning| writeln!(out, "warning: {warning}"))?;
    Ok(())
}
