//! `mimique compare`: weights of one performance, by several methods, on the skin of one avatar.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_avatar::Expression;
use mimique_comparison::{
    ComparedFace, Difference, FaceMotion, MarkerCorrelation, Measures, difference,
    marker_correlation, measures, median_correlation,
};
use mimique_locale::counted;
use mimique_mocap::{CaptureFile, ReadOptions, WeightOptions, WeightsTable};
use mimique_solver::{Method, MethodSpec};
use mimique_stimulus::{
    AvatarSkin, JoinedTake, MarkerMap, RecordedWeights, TakeOptions, read_performance,
};
use serde::Serialize;

use crate::output;
use crate::solve::length_unit;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Files of weights: the first is what the others are held against
    #[arg(required = true, num_args = 2.., value_name = "WEIGHTS")]
    weights: Vec<PathBuf>,
    /// Avatar whose skin shows them
    #[arg(long, value_name = "FILE")]
    avatar: PathBuf,
    /// Capture of the performance, of the same frames: how the skin goes with its markers
    #[arg(long, value_name = "FILE", requires = "markers")]
    mocap: Option<PathBuf>,
    /// Marker map of the capture
    #[arg(long, value_name = "MAP", requires = "mocap")]
    markers: Option<PathBuf>,
    /// Unit of the capture where its file does not say: m, cm or mm
    #[arg(long, value_name = "UNIT", requires = "mocap")]
    mocap_unit: Option<String>,
    /// Frames a second where a file does not say
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Where the table goes: a row per file and part of the face
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
}

/// What is told of one file.
#[derive(Serialize)]
struct Row {
    file: PathBuf,
    #[serde(flatten)]
    measures: Measures,
    /// From the first file.
    #[serde(skip_serializing_if = "Option::is_none")]
    difference: Option<Difference>,
    /// Of each marker.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    markers: Vec<MarkerCorrelation>,
    /// Median of the markers' correlations.
    #[serde(skip_serializing_if = "Option::is_none")]
    marker_correlation: Option<f64>,
}

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    let avatar =
        mimique_avatar_files::read_avatar(&args.avatar).map_err(|e| blame(&args.avatar, e))?;
    let skin = AvatarSkin::of(&avatar.avatar).map_err(|e| blame(&args.avatar, e))?;
    let face = ComparedFace::of(&skin);
    let displacements = displacements(args, &skin)?;
    let mut reference: Option<FaceMotion> = None;
    let mut rows = Vec::new();
    for path in &args.weights {
        let (weights, rate_hz) = weights_on(&skin, &avatar.avatar.expressions, path, args.rate)?;
        let motion = FaceMotion::of(&skin, &face, &weights, rate_hz);
        let difference = match &reference {
            Some(first) => Some(difference(&face, first, &motion).map_err(|e| blame(path, e))?),
            None => None,
        };
        let markers = match &displacements {
            Some(actor) => actor.correlations(&skin, &weights).map_err(|e| blame(path, e))?,
            None => Vec::new(),
        };
        rows.push(Row {
            file: path.clone(),
            measures: measures(&face, &motion),
            difference,
            marker_correlation: median_correlation(&markers),
            markers,
        });
        reference.get_or_insert(motion);
    }
    if let Some(path) = &args.csv {
        output::write(path, &csv(&rows)?)?;
    }
    let mut out = std::io::stdout().lock();
    if json {
        writeln!(out, "{}", serde_json::to_string_pretty(&rows)?)?;
        return Ok(());
    }
    if face.parts.is_empty() {
        writeln!(
            out,
            "note: {}: no landmarks are found on the skin, so it is compared as a whole",
            args.avatar.display()
        )?;
    }
    Ok(rows.iter().try_for_each(|row| tell(&mut out, row))?)
}

/// Weights of a file in the order of the skin's shapes, and their frames per second.
fn weights_on(
    skin: &AvatarSkin,
    expressions: &[Expression],
    path: &Path,
    rate_hz: Option<f64>,
) -> anyhow::Result<(Vec<f64>, f64)> {
    let options = WeightOptions { rate_hz, shape_names: &skin.shape_names, animation: None };
    let recorded = read_performance(path, &options).map_err(|e| blame(path, e))?.table;
    let RecordedWeights { table, names } =
        RecordedWeights::with_expressions(&recorded, &skin.shape_names, expressions)
            .map_err(|e| blame(path, e))?;
    if names.driven.is_empty() {
        let first: Vec<&str> = recorded.shape_names.iter().take(4).map(String::as_str).collect();
        return Err(blame(
            path,
            format!(
                "no column is a shape of the avatar ({}); take the avatar that it was made for",
                first.join(", ")
            ),
        ));
    }
    let WeightsTable { weights, .. } = &table;
    let rate = table.rate_hz().ok_or_else(|| {
        blame(path, "fewer than two frames, or no times; give frames per second by --rate")
    })?;
    Ok((weights.clone(), rate))
}

/// Where the actor's markers ask the skin to go.
struct Displacements {
    sites: Vec<mimique_solver::MarkerSite>,
    rows: Vec<f64>,
}

impl Displacements {
    fn correlations(
        &self,
        skin: &AvatarSkin,
        weights: &[f64],
    ) -> anyhow::Result<Vec<MarkerCorrelation>> {
        let frames = self.rows.len() / (3 * self.sites.len()).max(1);
        let own = weights.len() / skin.shape_names.len().max(1);
        if frames != own {
            bail!(
                "{own} frames, the capture has {frames}; give the capture that these weights are of"
            );
        }
        Ok(marker_correlation(&skin.mesh, &self.sites, &self.rows, weights))
    }
}

fn displacements(args: &Args, skin: &AvatarSkin) -> anyhow::Result<Option<Displacements>> {
    let (Some(capture), Some(map)) = (&args.mocap, &args.markers) else { return Ok(None) };
    let unit = args.mocap_unit.as_deref().map(length_unit).transpose()?;
    let options = ReadOptions { unit, rate_hz: args.rate };
    let recording = CaptureFile::open(capture)
        .and_then(|mut file| file.recording(&options))
        .map_err(|e| blame(capture, e))?;
    let text = std::fs::read_to_string(map)
        .map_err(|e| blame(map, format!("open: {e}; check the path")))?;
    let marker_map = MarkerMap::from_text(&text).map_err(|e| blame(map, e))?;
    let joined = JoinedTake::new(skin, &recording.capture, &marker_map, &TakeOptions::default())
        .map_err(|e| blame(map, e))?;
    let spec = MethodSpec::new(Method::Box).at_rate(recording.capture.rate_hz);
    let operators = joined.operators(&spec).map_err(|e| blame(map, e))?;
    let motion = joined.motion(&operators, &spec).map_err(|e| blame(capture, e))?;
    Ok(Some(Displacements { sites: joined.sites().to_vec(), rows: motion.displacements }))
}

/// A table with a row per file and part.
fn csv(rows: &[Row]) -> anyhow::Result<Vec<u8>> {
    let mut out = csv::Writer::from_writer(Vec::new());
    out.write_record([
        "file",
        "part",
        "range_mm",
        "rms_mm",
        "largest_mm",
        "largest_frame",
        "lip_vertex_error_mm",
        "lip_vertex_error_mm2",
        "upper_face_deviation_mm2",
        "lip_gap_error_mm",
        "lips_shut_frames",
        "lips_kept_shut_frames",
        "jerk_m_per_s3",
        "marker_correlation",
    ])?;
    let text = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for row in rows {
        for (place, (part, range)) in row.measures.range_mm.iter().enumerate() {
            let own = row.difference.as_ref().map(|difference| &difference.parts[place]);
            let whole = *part == "Face";
            let of_face = |value: Option<f64>| text(value.filter(|_| whole));
            let difference = row.difference.as_ref();
            let closures = difference.and_then(|d| d.lip_closures);
            out.write_record([
                row.file.display().to_string(),
                (*part).to_owned(),
                range.to_string(),
                text(own.map(|part| part.rms_mm)),
                text(own.map(|part| part.largest_mm)),
                own.map_or(String::new(), |part| part.largest_frame.to_string()),
                of_face(difference.and_then(|d| d.lip_vertex_error_mm)),
                of_face(difference.and_then(|d| d.lip_vertex_error_mm2)),
                of_face(difference.and_then(|d| d.upper_face_deviation_mm2)),
                of_face(difference.and_then(|d| d.lip_gap_error_mm)),
                of_face(closures.map(|own| own.shut as f64)),
                of_face(closures.map(|own| own.kept as f64)),
                of_face(Some(row.measures.jerk)),
                of_face(row.marker_correlation),
            ])?;
        }
    }
    Ok(out.into_inner()?)
}

/// A few lines of a file.
fn tell(out: &mut impl std::io::Write, row: &Row) -> std::io::Result<()> {
    let Row { file, measures, difference, marker_correlation, .. } = row;
    let what = if difference.is_none() { " (what the others are held against)" } else { "" };
    writeln!(out, "{}{what}", file.display())?;
    writeln!(
        out,
        "  {:<10}{:>10}{:>10}{:>12}{:>8}",
        "part", "range mm", "rms mm", "largest mm", "frame"
    )?;
    for (place, (part, range)) in measures.range_mm.iter().enumerate() {
        write!(out, "  {part:<10}{range:>10.3}")?;
        if let Some(own) = difference.as_ref().map(|difference| &difference.parts[place]) {
            write!(out, "{:>10.3}{:>12.3}{:>8}", own.rms_mm, own.largest_mm, own.largest_frame)?;
        }
        writeln!(out)?;
    }
    if let Some(difference) = difference {
        tell_difference(out, difference)?;
    }
    writeln!(out, "  jerk {:.2} m/s^3", measures.jerk)?;
    if let Some(r) = marker_correlation {
        writeln!(out, "  correlation with the markers {r:.3} (median)")?;
    }
    Ok(())
}

fn blame(file: &Path, error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("{}: {error}", file.display())
}

/// What is told of the lips and the upper face.
fn tell_difference(out: &mut impl std::io::Write, difference: &Difference) -> std::io::Result<()> {
    if let (Some(error), Some(squared)) =
        (difference.lip_vertex_error_mm, difference.lip_vertex_error_mm2)
    {
        writeln!(out, "  lip vertex error {error:.3} mm ({squared:.3} mm^2)")?;
    }
    if let Some(deviation) = difference.upper_face_deviation_mm2 {
        writeln!(out, "  upper-face dynamics deviation {deviation:.3} mm^2")?;
    }
    if let Some(error) = difference.lip_gap_error_mm {
        writeln!(out, "  error of the lips' gap {error:.3} mm")?;
    }
    match difference.lip_closures {
        Some(own) if own.shut > 0 => {
            writeln!(out, "  lips kept shut in {} of {}", own.kept, counted(own.shut, "frame"))
        }
        _ => Ok(()),
    }
}
