//! `mimique solve`: avatar, capture and marker map in, weights a frame and a report out.

mod args;
mod gaze;
mod method_options;
mod parameter_options;
mod print;
mod recorded;
mod values;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow, bail};
use indicatif::ProgressBar;
use mimique_mocap::{
    CaptureFile, LengthUnit, ReadOptions, Recording, WeightOptions, WeightsTable, weights_files,
};
use mimique_solver::{FrontEndError, Method, MethodSpec, TrainingError};
use mimique_stimulus::{
    AvatarSkin, MarkerMap, RepairSidecar, ScaleRule, SolveError, TakeOptions, Training,
    VertexFrames, lock_shapes, read_performance, sha256_of_file, solve_take, split_shapes,
    weights_for_file,
};
use serde_json::json;

use crate::output;

pub use self::args::Args;
use self::method_options::method_spec;
use self::print::print;
use self::values::unique;
pub(crate) use self::values::{Length, Named, Span};

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let mut spec = method_spec(&args)?;
    if spec.method == Method::Recorded {
        return recorded::run(&args, json);
    }
    let Some(markers) = &args.markers else {
        bail!("--markers: {} needs a marker map; name the file", spec.method);
    };
    if args.training.is_some() != (spec.method == Method::Regression) {
        bail!(
            "--training: {}",
            if args.training.is_some() {
                format!("{} learns nothing; remove it, or take --method regression", spec.method)
            } else {
                "regression learns from a range of motion; give --training and --training-weights"
                    .to_owned()
            }
        );
    }
    let progress = ProgressBar::new_spinner();
    progress.enable_steady_tick(Duration::from_millis(100));
    let origin = Instant::now();
    let seconds = || origin.elapsed().as_secs_f64();

    progress.set_message("reading");
    let mut read = read(&args, markers, &mut spec)?;
    let read_seconds = seconds();

    progress.set_message(format!("solving {} frames", read.recording.capture.frames()));
    let Inputs { skin, recording, map, options, notes } = &mut read;
    let mut solved = solve_take(skin, &recording.capture, map, &spec, options, &mut || seconds())
        .map_err(|e| blame(at_fault(&e, &args), e))?;

    progress.set_message("writing");
    let start = seconds();
    notes.extend(write_weights(&solved.table, &args.out)?);
    if let Some(path) = &args.vertices {
        let mut npy = VertexFrames::new(skin, &solved);
        output::write_with(path, |out| npy.write(out))?;
    }
    solved.report.seconds.read = read_seconds;
    solved.report.seconds.write = seconds() - start;
    if let Some(path) = &args.report {
        let mut report = serde_json::to_value(&solved.report).context("report")?;
        report["notes"] = json!(notes);
        report["files"] = json!({
            "avatar": args.avatar, "mocap": args.mocap, "markers": args.markers, "out": args.out,
        });
        let text = serde_json::to_string_pretty(&report)? + "\n";
        output::write(path, text.as_bytes())?;
    }
    progress.finish_and_clear();
    print(&args, &solved, notes, json)
}

/// What the files hold, and what is to be said of them.
struct Inputs {
    skin: AvatarSkin,
    recording: Recording,
    map: MarkerMap,
    options: TakeOptions,
    notes: Vec<String>,
}

/// Reads the files; the shapes that the avatar's settings hold at 0 are locked in `spec`.
fn read(args: &Args, markers: &Path, spec: &mut MethodSpec) -> anyhow::Result<Inputs> {
    let avatar =
        mimique_avatar_files::read_avatar(&args.avatar).map_err(|e| blame(&args.avatar, e))?;
    lock_shapes(spec, &avatar.locked);
    let split = split_shapes(&avatar.avatar, &args.split)
        .map_err(|e| blame(&args.avatar, format!("--{e}")))?;
    let skin = AvatarSkin::of(&split).map_err(|e| blame(&args.avatar, e))?;
    let recording = capture(args, &args.mocap)?;
    let text = std::fs::read_to_string(markers)
        .map_err(|e| blame(markers, format!("open: {e}; check the path")))?;
    let map = MarkerMap::from_text(&text).map_err(|e| blame(markers, e))?;
    let sidecar = RepairSidecar::beside(&args.mocap, || sha256_of_file(&args.mocap))
        .map_err(|e| anyhow!("{e}"))?;
    let options = TakeOptions {
        neutral: args.neutral.as_ref().map(|s| s.0.clone()),
        head: args.head.clone(),
        scale: ScaleRule {
            automatic: args.scale_automatic.as_ref().map(|s| s.0.clone()),
            global: args.scale_global.map(|f| f.0),
            markers: unique("--scale", &args.scale)?.into_iter().map(|(k, f)| (k, f.0)).collect(),
        },
        depth: args.depth,
        gaze: gaze::given(args)?,
        // Weights on file are of the face alone.
        head_motion: 0.0,
        training: training(args, &avatar.avatar.shape_names)?.map(Box::new),
        repair: sidecar.as_ref().map(RepairSidecar::hash),
    };
    let taken_for = recording.format.taken_for();
    let of_avatar = avatar.notes.iter().map(|n| (&args.avatar, n));
    let of_capture = std::iter::once(&taken_for).chain(&recording.capture.notes);
    let of_both = of_avatar.chain(of_capture.map(|n| (&args.mocap, n)));
    let mut notes: Vec<String> =
        of_both.map(|(file, n)| format!("{}: {n}", file.display())).collect();
    notes.extend(sidecar.map(|s| {
        format!("{}: repaired from {}: {}", args.mocap.display(), s.source.file, s.repair.summary())
    }));
    Ok(Inputs { skin, recording, map, options, notes })
}

/// The capture of a file.
fn capture(args: &Args, file: &Path) -> anyhow::Result<Recording> {
    let unit = args.mocap_unit.as_deref().map(length_unit).transpose()?;
    let options = ReadOptions { unit, rate_hz: args.mocap_rate };
    CaptureFile::open(file)
        .and_then(|mut file| file.recording(&options))
        .map_err(|e| blame(file, e))
}

/// What regression learns from.
fn training(args: &Args, shape_names: &[String]) -> anyhow::Result<Option<Training>> {
    let (Some(take), Some(weights)) = (&args.training, &args.training_weights) else {
        return Ok(None);
    };
    Ok(Some(Training {
        capture: capture(args, take)?.capture,
        weights: read_performance(
            weights,
            &WeightOptions { rate_hz: args.mocap_rate, shape_names, animation: None },
        )
        .map_err(|e| blame(weights, e))?
        .table,
        neutral: args.training_neutral.as_ref().map(|s| s.0.clone()),
        head: None,
    }))
}

/// Writes weights in the format that the file's name asks for. Answers what is to be said of it: the shapes
/// that the format has no column for.
fn write_weights(table: &WeightsTable, path: &Path) -> anyhow::Result<Option<String>> {
    let (files, note) = weights_in_files(table, path)?;
    files.iter().try_for_each(|(path, bytes)| output::write(path, bytes))?;
    Ok(note)
}

/// A file's path and bytes.
pub(crate) type FileToWrite = (PathBuf, Vec<u8>);

/// The files that weights become, and what is to be said of them.
pub(crate) fn weights_in_files(
    table: &WeightsTable,
    path: &Path,
) -> anyhow::Result<(Vec<FileToWrite>, Option<String>)> {
    let blame = |e: String| anyhow!("--out: {}: {e}", path.display());
    let (table, left_out) = weights_for_file(table, path).map_err(|e| blame(e.to_string()))?;
    let files = weights_files(&table, path).map_err(|e| blame(e.to_string()))?;
    let note = (!left_out.is_empty()).then(|| {
        format!(
            "{}: its format has no column for {}: left out",
            path.display(),
            left_out.join(", ")
        )
    });
    Ok((files, note))
}

/// The file or option that an error of the solve comes from.
fn at_fault<'a>(error: &SolveError, args: &'a Args) -> &'a Path {
    let markers = args.markers.as_deref().unwrap_or(Path::new("--markers"));
    match error {
        SolveError::Map(_) | SolveError::NoCommonLabel { .. } => markers,
        SolveError::Training(TrainingError::Frames { .. }) | SolveError::TrainingShapes { .. } => {
            args.training_weights.as_deref().unwrap_or(Path::new("--training-weights"))
        }
        SolveError::Training(_) | SolveError::TrainingMarkers { .. } => {
            args.training.as_deref().unwrap_or(Path::new("--training"))
        }
        SolveError::Surface(_) | SolveError::NoGazeShapes => &args.avatar,
        SolveError::NoGazeTarget { .. } => Path::new("--gaze-target"),
        SolveError::NoScaledMarker { .. } | SolveError::ScaleFrames { .. } => markers,
        SolveError::Mesh(_) | SolveError::Operators(_) => &args.avatar,
        SolveError::FrontEnd(FrontEndError::Alignment(_) | FrontEndError::Rbf(_)) => markers,
        SolveError::Fit(_) => Path::new("--method"),
        _ => &args.mocap,
    }
}

fn blame(file: &Path, error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("{}: {error}", file.display())
}

/// The unit of a word.
pub(crate) fn length_unit(word: &str) -> anyhow::Result<LengthUnit> {
    match word {
        "mm" => Ok(LengthUnit::Millimetre),
        "cm" => Ok(LengthUnit::Centimetre),
        "m" => Ok(LengthUnit::Metre),
        _ => bail!("--mocap-unit: {word:?}; use m, cm or mm"),
    }
}
