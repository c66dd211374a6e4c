//! `mimique repair`: a capture in; the repaired capture and a sidecar that says what was changed out.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_locale::counted;
use mimique_mocap::{Capture, CaptureFile, GapFill, LowPass, RepairPlan, Repaired, stillest};
use mimique_stimulus::{FileHash, RepairSidecar, sidecar_path};
use serde_json::json;

use crate::capture_options::CaptureOptions;
use crate::output;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Capture: C3D, TRC, CSV...
    capture: PathBuf,
    /// Where the repaired capture goes: .c3d, .trc or .csv; FILE.repair.json beside it says what was
    /// changed, frame by frame
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Longest gap filled by a spline, seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 0.1)]
    max_gap: f64,
    /// Longest gap filled by the rigid motion of the marker's neighbours, seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0)]
    max_rigid_gap: f64,
    /// Leave swapped labels as they are
    #[arg(long)]
    keep_swaps: bool,
    /// Leave spikes as they are
    #[arg(long)]
    keep_spikes: bool,
    /// Low-pass without phase shift, Hz
    #[arg(long, value_name = "HZ")]
    cutoff: Option<f64>,
    /// butterworth, or raised-cosine (Kouadio 1997, eq. 7.1)
    #[arg(long, value_name = "KIND", default_value = "butterworth", requires = "cutoff")]
    filter: String,
    /// Width of the raised cosine's flank, Hz (by default half of the cut-off)
    #[arg(long, value_name = "HZ", requires = "cutoff")]
    flank: Option<f64>,
    /// Frames a second of what comes out
    #[arg(long, value_name = "HZ")]
    resample: Option<f64>,
    #[command(flatten)]
    read: CaptureOptions,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let blame = |path: &Path, error: String| anyhow!("{}: {error}", path.display());
    let plan = plan(&args)?;
    let mut file =
        CaptureFile::open(&args.capture).map_err(|e| blame(&args.capture, e.to_string()))?;
    let capture = args.read.recording(&args.capture, &mut file)?.capture;
    let source = FileHash::of_file(&args.capture)
        .map_err(|e| blame(&args.capture, format!("read: {e}; check the disk")))?;
    let Repaired { capture, record } =
        mimique_mocap::repair(capture, &plan).map_err(|e| blame(&args.capture, e.to_string()))?;
    let out = written(&capture, &args.out)?;
    let sidecar = RepairSidecar {
        program: concat!("mimique ", env!("CARGO_PKG_VERSION")).to_owned(),
        source,
        result: FileHash::of(&args.out, &out),
        repair: record,
    };
    let beside = sidecar_path(&args.out);
    // The capture last: a sidecar without its capture is refused, a capture without its sidecar
    // would pass for one as it was recorded.
    output::write(&beside, sidecar.to_json().as_bytes())?;
    output::write(&args.out, &out)?;
    print(&args, &capture, &sidecar, json)
}

fn print(
    args: &Args,
    capture: &Capture,
    sidecar: &RepairSidecar,
    json: bool,
) -> anyhow::Result<()> {
    let record = &sidecar.repair;
    let neutral = stillest(capture, 1.0);
    let mut out = std::io::stdout().lock();
    if json {
        let value = json!({
            "out": args.out, "sidecar": sidecar_path(&args.out), "record": sidecar,
            "stillest": neutral, "notes": capture.notes,
        });
        writeln!(out, "{}", serde_json::to_string_pretty(&value)?)?;
        return Ok(());
    }
    writeln!(
        out,
        "{}: {} at {} Hz, {}",
        args.out.display(),
        counted(record.frames_out, "frame"),
        record.rate_hz_out,
        counted(record.markers, "marker")
    )?;
    writeln!(out, "{}", record.summary())?;
    for swap in &record.swaps {
        let verb = if swap.repaired { "put back" } else { "look swapped, left as they are" };
        let last = swap.end - 1;
        writeln!(out, "swap: {} {verb}, frames {} to {last}", swap.labels.join(", "), swap.first)?;
    }
    for spike in &record.spikes {
        let (last, mm) = (spike.end - 1, 1e3 * spike.distance_m);
        writeln!(out, "spike: {} {mm:.1} mm off, frames {} to {last}", spike.label, spike.first)?;
    }
    for gap in &record.gaps {
        let how = match gap.repair {
            mimique_mocap::GapRepair::Spline => "filled by a spline",
            mimique_mocap::GapRepair::RigidNeighbourhood => "filled by its neighbours' motion",
            mimique_mocap::GapRepair::LeftMissing => "left missing",
        };
        writeln!(out, "gap: {} {how}, frames {} to {}", gap.label, gap.first, gap.end - 1)?;
    }
    if let Some(found) = neutral {
        writeln!(
            out,
            "stillest second: frames {}:{}, {:.2} mm rms",
            found.frames.start,
            found.frames.end,
            found.deviation * capture.unit.metres() * 1e3
        )?;
    }
    writeln!(out, "changes: {}", sidecar_path(&args.out).display())?;
    Ok(())
}

fn plan(args: &Args) -> anyhow::Result<RepairPlan> {
    for (option, seconds) in [("--max-gap", args.max_gap), ("--max-rigid-gap", args.max_rigid_gap)]
    {
        if !(seconds >= 0.0 && seconds.is_finite()) {
            bail!("{option}: {seconds}; give seconds, 0 for none");
        }
    }
    let low_pass = args.cutoff.map(|cutoff_hz| match args.filter.as_str() {
        "butterworth" if args.flank.is_none() => Ok(LowPass::Butterworth { cutoff_hz }),
        "butterworth" => bail!("--flank: a Butterworth has none; use --filter raised-cosine"),
        "raised-cosine" => {
            Ok(LowPass::RaisedCosine { cutoff_hz, width_hz: args.flank.unwrap_or(0.5 * cutoff_hz) })
        }
        other => bail!("--filter: {other:?}; use butterworth or raised-cosine"),
    });
    Ok(RepairPlan {
        repair_swaps: !args.keep_swaps,
        repair_spikes: !args.keep_spikes,
        gaps: GapFill { spline_s: args.max_gap, rigid_s: args.max_rigid_gap },
        low_pass: low_pass.transpose()?,
        resample_hz: args.resample,
        head: args.read.head()?,
    })
}

/// The capture in the format that the file's name asks for.
fn written(capture: &Capture, out: &Path) -> anyhow::Result<Vec<u8>> {
    mimique_mocap::capture_file(capture, out).map_err(|e| anyhow!("--out: {}: {e}", out.display()))
}
