//! What `mimique solve` says.

use std::io::Write;

use mimique_locale::counted;
use mimique_stimulus::{ShapeRow, ShapeState, SolveReport, SolvedCapture};
use serde_json::{Value, json};

use super::args::Args;

/// A few lines of the report, or all of it but the frames as JSON.
pub(super) fn print(
    args: &Args,
    solved: &SolvedCapture,
    notes: &[String],
    json: bool,
) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    if json {
        print_json(&mut out, args, &solved.report, notes)
    } else {
        Ok(print_text(&mut out, args, &solved.report, notes)?)
    }
}

/// All of the report but the frames.
fn print_json(
    out: &mut impl Write,
    args: &Args,
    report: &SolveReport,
    notes: &[String],
) -> anyhow::Result<()> {
    let mut value = serde_json::to_value(report)?;
    if let Value::Object(map) = &mut value {
        // One object a frame is for --report.
        map.remove("frames");
        map.insert("notes".into(), json!(notes));
        map.insert("out".into(), json!(args.out));
    }
    writeln!(out, "{}", serde_json::to_string_pretty(&value)?)?;
    Ok(())
}

/// A few lines of the report.
fn print_text(
    out: &mut impl Write,
    args: &Args,
    report: &SolveReport,
    notes: &[String],
) -> std::io::Result<()> {
    let SolveReport { summary, seconds, .. } = report;
    writeln!(
        out,
        "{}: {} at {} Hz, {}, {}, {}, method {}",
        args.out.display(),
        counted(summary.frames, "frame"),
        report.rate_hz,
        counted(report.shapes, "shape"),
        counted(report.markers.len(), "marker"),
        counted(report.head.len(), "head marker"),
        report.method.method,
    )?;
    writeln!(
        out,
        "residual {:.3} mm rms, {:.3} mm at worst; {:.1} iterations per frame, {} at most; KKT error {:.1e} at worst",
        summary.residual_rms_mm,
        summary.residual_worst_mm,
        summary.iterations_mean,
        summary.iterations_most,
        summary.kkt_worst,
    )?;
    match report.head_lowpass_hz {
        Some(cutoff_hz) => writeln!(out, "head low-pass {cutoff_hz} Hz")?,
        None => writeln!(out, "head low-pass none")?,
    }
    if !report.gaze_at_rest.is_empty() {
        let count = report.gaze_at_rest.len();
        writeln!(
            out,
            "gaze at rest: no gaze is given, so {count} shapes that turn the eyes stay at 0"
        )?;
    }
    print_shapes(out, &report.shapes_told)?;
    if let Some(gaze) = report.gaze.as_ref().filter(|gaze| !gaze.is_still()) {
        writeln!(out, "gaze {}", gaze.words())?;
    }
    print_regression(out, report)?;
    writeln!(
        out,
        "seconds: read {:.3}, set-up {:.3}, front end {:.3}, solve {:.3}, check {:.3}, write {:.3}",
        seconds.read,
        seconds.set_up,
        seconds.front_end,
        seconds.solve,
        seconds.check,
        seconds.write
    )?;
    writeln!(out, "weights {}\nprovenance {}", report.weights_hash, report.provenance)?;
    notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))?;
    report.warnings.iter().try_for_each(|warning| writeln!(out, "warning: {warning}"))
}

/// How many shapes get their weights in which way; which they are where the markers do not tell them by
/// themselves.
fn print_shapes(out: &mut impl Write, rows: &[ShapeRow]) -> std::io::Result<()> {
    let of = |state: ShapeState| rows.iter().filter(move |row| row.state == state);
    let count = |state| of(state).count();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "shapes: {} told by the markers, {} together with others, {} held at 0, {} locked, {} driven",
        count(ShapeState::Solved),
        count(ShapeState::Shared),
        count(ShapeState::Held) + count(ShapeState::AtRest),
        count(ShapeState::Locked),
        count(ShapeState::Driven),
    )?;
    let shared: Vec<String> = of(ShapeState::Shared)
        .map(|row| match &row.confused_with {
            Some((other, _)) => format!("{} with {other}", row.shape),
            None => row.shape.clone(),
        })
        .collect();
    if !shared.is_empty() {
        writeln!(out, "told together: {}", shared.join(", "))?;
    }
    let held: Vec<&str> = of(ShapeState::Held).map(|row| row.shape.as_str()).collect();
    if !held.is_empty() {
        writeln!(out, "held at 0, since no marker tells them: {}", held.join(", "))?;
    }
    Ok(())
}

/// What a regression has learnt from; nothing of another method.
fn print_regression(out: &mut impl Write, report: &SolveReport) -> std::io::Result<()> {
    let Some(learnt) = &report.regression else { return Ok(()) };
    writeln!(
        out,
        "learnt from {} frames, {} basis vectors; length scale {:.3}, signal {:.3}, noise {:.4}; predictive deviation {:.3} at worst",
        learnt.training_frames,
        learnt.basis_vectors,
        learnt.kernel.length,
        learnt.kernel.signal,
        learnt.kernel.noise,
        report.summary.deviation_worst.unwrap_or(0.0),
    )
}
