//! `mimique vertices`: a sequence of vertices and its template in, an avatar and recorded weights out.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_avatar_files::{read_template, write_glb};
use mimique_mocap::{read_vertex_array, weights_files};
use mimique_stimulus::{VertexBank, VertexBankOptions};
use serde_json::json;

use crate::output;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Positions, frames x vertices x 3, or frames x 3 vertices (.npy, .npz), in the template's unit
    sequence: PathBuf,
    /// The mesh at rest (.obj, .glb), its vertices in the order of the sequence
    #[arg(long, value_name = "MESH")]
    template: PathBuf,
    /// Frames per second
    #[arg(long, value_name = "HZ")]
    rate: f64,
    /// Write the avatar here (.glb), with the sequence as its animation
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Write the weights of the sequence here (.csv, .npy)
    #[arg(long, value_name = "FILE")]
    weights: PathBuf,
    /// No vertex of any frame is farther off than this, millimetres
    #[arg(long, value_name = "MM", default_value_t = 0.1)]
    tolerance: f64,
    /// No more shapes than these, at most 2048
    #[arg(long, value_name = "N", default_value_t = mimique_avatar::MOST_SHAPES)]
    shapes: usize,
}

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    if !(args.rate > 0.0 && args.rate.is_finite()) {
        bail!("--rate: {}; give frames per second", args.rate);
    }
    if !(args.tolerance > 0.0 && args.tolerance.is_finite()) {
        bail!("--tolerance: {}; give millimetres above 0", args.tolerance);
    }
    if !(1..=mimique_avatar::MOST_SHAPES).contains(&args.shapes) {
        bail!("--shapes: {}; give 1 to {}", args.shapes, mimique_avatar::MOST_SHAPES);
    }
    let blame = |file: &Path, e: &dyn std::fmt::Display| anyhow!("{}: {e}", file.display());
    let template = read_template(&args.template).map_err(|e| blame(&args.template, &e))?;
    let sequence = read_vertex_array(&args.sequence).map_err(|e| blame(&args.sequence, &e))?;
    let options = VertexBankOptions {
        rate_hz: args.rate,
        tolerance_m: args.tolerance / 1e3,
        most_shapes: args.shapes,
    };
    let name = args.out.file_stem().unwrap_or_default().to_string_lossy();
    let bank = VertexBank::of(&name, &template, &sequence, &options)
        .map_err(|e| blame(&args.sequence, &e))?;
    let animation: Vec<f32> = bank.weights.weights.iter().map(|w| *w as f32).collect();
    let glb = write_glb(&bank.avatar, &animation, args.rate).map_err(|e| blame(&args.out, &e))?;
    let files = weights_files(&bank.weights, &args.weights)
        .map_err(|e| anyhow!("--weights: {}: {e}", args.weights.display()))?;
    output::write(&args.out, &glb)?;
    files.iter().try_for_each(|(path, bytes)| output::write(path, bytes))?;
    print(args, &bank, template.positions.len(), json)
}

/// What was found.
fn print(args: &Args, bank: &VertexBank, vertices: usize, json: bool) -> anyhow::Result<()> {
    let (frames, shapes) = (bank.weights.frames.len(), bank.avatar.shape_names.len());
    let (largest, rms) = (1e3 * bank.largest_error_m, 1e3 * bank.rms_error_m);
    let (frame, vertex) = bank.largest_at;
    let reached = largest <= args.tolerance;
    let mut out = std::io::stdout().lock();
    if json {
        let told = json!({
            "frames": frames,
            "rate_hz": args.rate,
            "vertices": vertices,
            "shapes": shapes,
            "largest_error_mm": largest,
            "largest_error_frame": frame,
            "largest_error_vertex": vertex,
            "rms_error_mm": rms,
            "within_tolerance": reached,
            "files": {"avatar": args.out, "weights": args.weights},
        });
        writeln!(out, "{}", serde_json::to_string_pretty(&told)?)?;
        return Ok(());
    }
    writeln!(
        out,
        "{}: {vertices} vertices, {shapes} shapes; {}: {frames} frames at {} Hz",
        args.out.display(),
        args.weights.display(),
        args.rate
    )?;
    writeln!(
        out,
        "largest error {largest:.4} mm (frame {frame}, vertex {vertex}), {rms:.4} mm root mean square"
    )?;
    if !reached {
        writeln!(
            out,
            "warning: {shapes} shapes do not reach {} mm; allow more (--shapes) or a larger error (--tolerance)",
            args.tolerance
        )?;
    }
    Ok(())
}
