//! `mimique solve --method recorded`: weights of a file under the avatar's own names.

use std::io::Write as _;
use std::path::Path;

use anyhow::bail;
use mimique_stimulus::{Provenance, RecordedWeights, WeightsTable, sha256_of_file, weights_hash};
use serde_json::json;

use super::{Args, blame, write_whole};

/// SHA-256 of a file.
fn hash_of(file: &Path) -> anyhow::Result<String> {
    sha256_of_file(file)
        .map_err(|e| blame(file, format!("open: {e}; check the path and its permissions")))
}

pub(super) fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    if args.vertices.is_some() || args.markers.is_some() || args.training.is_some() {
        bail!("--method: recorded solves nothing; remove --markers, --vertices and --training");
    }
    let avatar = mimique_face::read_avatar(&args.avatar).map_err(|e| blame(&args.avatar, e))?;
    let recorded = WeightsTable::from_file(&args.mocap).map_err(|e| blame(&args.mocap, e))?;
    let RecordedWeights { table, names } =
        RecordedWeights::of(&recorded, &avatar.avatar.shape_names);
    let hash = weights_hash(&table.weights);
    let provenance = Provenance::new()
        .text("avatar", &hash_of(&args.avatar)?)
        .text("recorded", &hash_of(&args.mocap)?)
        .text("weights", &hash)
        .hash();
    let warnings = names.warnings();
    let report = json!({
        "method": {"method": "recorded"},
        "avatar": avatar.avatar.name,
        "frames": table.frames.len(),
        "rate_hz": table.rate_hz(),
        "shapes": table.shape_names.len(),
        "names": names,
        "warnings": warnings,
        "weights_hash": hash,
        "provenance": provenance,
        "files": {"avatar": args.avatar, "mocap": args.mocap, "out": args.out},
    });
    write_whole(&args.out, |out| out.write_all(table.to_csv().as_bytes()))?;
    if let Some(path) = &args.report {
        let text = serde_json::to_string_pretty(&report)? + "\n";
        write_whole(path, |out| out.write_all(text.as_bytes()))?;
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
    writeln!(out, "weights {hash}\nprovenance {provenance}")?;
    warnings.iter().try_for_each(|warning| writeln!(out, "warning: {warning}"))?;
    Ok(())
}
