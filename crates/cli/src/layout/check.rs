//! `mimique layout check`: what a marker map cannot see, before a session begins.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::anyhow;
use mimique_geometry::Point;
use mimique_layout::{CheckOptions, FaceMotion, HEAD_NOISE_M, MapCheck, head_places};
use mimique_stimulus::ADVISED_SMOOTHING;
use serde_json::Value;

use super::inputs::{self, MapFile, blame};
use crate::solve::Length;

/// Options.
#[derive(clap::Args)]
pub(super) struct Args {
    /// Marker map: JSON, or CSV with marker,role,vertex
    map: PathBuf,
    /// Avatar that it is for
    #[arg(long, value_name = "FILE")]
    avatar: PathBuf,
    /// Range of motion as weights; may be given again. Without it every shape counts by itself
    #[arg(long, value_name = "FILE")]
    rom: Vec<PathBuf>,
    /// Frames a second of takes whose files do not say
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Sensor noise of a marker, standard deviation
    #[arg(long, value_name = "LENGTH", default_value = "0.1mm")]
    noise: Length,
    /// How far beside its place a marker is put, standard deviation
    #[arg(long, value_name = "LENGTH", default_value = "1.5mm")]
    slip: Length,
}

/// Shapes of a list that the text names.
const NAMED: usize = 12;

pub(super) fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    let avatar = inputs::avatar(&args.avatar)?;
    let face = inputs::face(&args.avatar, &avatar.skin)?;
    let (takes, _) = inputs::takes(&avatar.skin, &args.rom, &[], args.rate)?;
    let gaze = mimique_layout::gaze_shapes(&face);
    let motion = FaceMotion::of(&face, &takes, &gaze).map_err(|e| anyhow!("--rom: {e}"))?;
    let MapFile { map, sites, text } = inputs::map(&avatar.skin, &args.map)?;
    let heads = head_places(&map.head, &sites, &avatar.skin.mesh, &text);
    let heads: Vec<Point> = heads.into_iter().map(|(_, place)| place).collect();
    let options = CheckOptions {
        noise: args.noise.0,
        slip: args.slip.0,
        head_noise: HEAD_NOISE_M,
        smoothing: ADVISED_SMOOTHING,
        seed: 1,
    };
    let check =
        MapCheck::of(&face, &motion, &sites, &heads, &options).map_err(|e| blame(&args.map, e))?;
    let mut out = std::io::stdout().lock();
    if json {
        let mut value = serde_json::to_value(&check)?;
        value["file"] = Value::from(args.map.display().to_string());
        writeln!(out, "{}", serde_json::to_string_pretty(&value)?)?;
        return Ok(());
    }
    print(&mut out, args, &check, map.head.len())?;
    Ok(())
}

fn print(
    out: &mut impl std::io::Write,
    args: &Args,
    check: &MapCheck,
    heads: usize,
) -> std::io::Result<()> {
    let markers = check.bank.at_markers.as_ref().map_or(0, |m| m.markers);
    writeln!(out, "{}: {markers} face markers, {heads} head markers", args.map.display())?;
    writeln!(
        out,
        "unknown: {:.2} mm a vertex of {:.2} mm that the face moves (noise {:.1} mm, markers {:.1} mm beside their places)",
        check.unknown_mm,
        check.moves_mm,
        1e3 * args.noise.0,
        1e3 * args.slip.0
    )?;
    parts(out, check)?;
    shapes(out, check)?;
    if let Some(pair) = &check.nearest {
        let [a, b] = &pair.labels;
        writeln!(out, "nearest markers: {a} and {b}, {:.1} mm", pair.at_rest_mm)?;
    }
    head(out, check, heads)?;
    let Some(p) = &check.placement else { return Ok(()) };
    let gain = 100.0 * (1.0 - p.smoothed_mm / p.put_mm);
    let less = if gain >= 0.5 { format!(" ({gain:.0} % less)") } else { String::new() };
    writeln!(
        out,
        "rehearsed error: {:.2} mm a vertex with markers at their places, {:.2} mm beside them, {:.2} mm with \
         rbfSmoothing {ADVISED_SMOOTHING}{less}",
        p.exact_mm, p.put_mm, p.smoothed_mm
    )
}

fn parts(out: &mut impl std::io::Write, check: &MapCheck) -> std::io::Result<()> {
    let titles = ["part", "markers", "moves, mm", "unknown, mm", "farthest marker, mm"];
    let [part, markers, moves, unknown, farthest] = titles;
    writeln!(out, "{part:<10} {markers:>7} {moves:>10} {unknown:>11} {farthest:>19}")?;
    for part in &check.parts {
        writeln!(
            out,
            "{:<10} {:>7} {:>10.2} {:>11.2} {:>19.0}",
            part.part.name().to_lowercase(),
            part.markers,
            part.moves_mm,
            part.unknown_mm,
            part.farthest_mm
        )?;
    }
    Ok(())
}

fn shapes(out: &mut impl std::io::Write, check: &MapCheck) -> std::io::Result<()> {
    if let Some(m) = &check.bank.at_markers {
        writeln!(out, "shapes: {} of {} told apart at the markers", m.rank, check.bank.shapes)?;
        if !m.unseen.is_empty() {
            writeln!(out, "no marker sees: {}", m.unseen.join(", "))?;
        }
    }
    if !check.gaze.is_empty() {
        writeln!(out, "no marker on skin tells the gaze: {} shapes", check.gaze.len())?;
    }
    for sight in check.hardly_told.iter().take(NAMED) {
        writeln!(
            out,
            "hardly told: {} ({:.0} % of its variance; {:.1} mm at a marker, {:.1} mm on the skin)",
            sight.shape,
            100.0 * sight.told.max(0.0),
            sight.at_markers_mm,
            sight.on_skin_mm
        )?;
    }
    if check.hardly_told.len() > NAMED {
        writeln!(out, "and {} more; --json lists all", check.hardly_told.len() - NAMED)?;
    }
    Ok(())
}

fn head(out: &mut impl std::io::Write, check: &MapCheck, heads: usize) -> std::io::Result<()> {
    let Some(head) = &check.head else {
        return match heads {
            0 => writeln!(out, "warning: no head markers: the head must be held still"),
            _ => writeln!(out, "head: the places of its markers are not known"),
        };
    };
    let told = |mm: Option<f64>| mm.map_or("no pose".to_owned(), |mm| format!("{mm:.2} mm"));
    writeln!(
        out,
        "head: noise of 0.3 mm on {} markers turns into {} on the face ({} at the best places)",
        head.markers,
        told(head.error_mm),
        told(head.best_mm)
    )?;
    if head.one_sided {
        writeln!(
            out,
            "warning: the head's markers sit on one side of it; spread them over temples and skull"
        )?;
    }
    Ok(())
}
