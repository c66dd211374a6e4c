//! `mimique solve`: avatar, capture and marker map in, weights a frame and a report out.

mod recorded;

use std::collections::BTreeMap;
use std::io::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow, bail};
use indicatif::ProgressBar;
use mimique_mocap::{LengthUnit, ReadOptions};
use mimique_solver::{FrontEndError, Method, MethodSpec, TrainingError};
use mimique_stimulus::{
    AvatarSkin, Depth, MarkerMap, RepairSidecar, ScaleRule, SolveError, SolveReport, SolvedCapture,
    TakeOptions, Training, VertexFrames, WeightsTable, solve_take, split_shapes,
};
use serde_json::{Value, json};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Avatar with blendshapes: .glb or .gltf
    #[arg(long, value_name = "FILE")]
    avatar: PathBuf,
    /// Capture: C3D, TRC, CSV...; for recorded the weights: Live Link Face, or CSV
    #[arg(long, value_name = "FILE")]
    mocap: PathBuf,
    /// Marker map: JSON, or CSV with marker,role,vertex (not for recorded)
    #[arg(long, value_name = "FILE")]
    markers: Option<PathBuf>,
    /// Where the weights go: CSV with frame,time and a column a shape; for thin-shell-surface the
    /// columns are LABEL.x, LABEL.y, LABEL.z, the way of each marker's vertex in centimetres
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Where the report goes: JSON with residual, iterations and KKT error of every frame
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Where the positions of the skin's vertices go: NumPy, frames x vertices x 3, metres, the
    /// vertices in the file's order
    #[arg(long, value_name = "FILE.npy")]
    vertices: Option<PathBuf>,
    /// lsts, lsts-soft, lsts-norm, lsts-short, thesis-literal, short-literal, bounds-only,
    /// thin-shell-only, box, nnls, pseudo-inverse, kouadio, thin-shell-surface, regression or
    /// recorded
    #[arg(long, default_value = "lsts")]
    method: String,
    /// Weight of the thin shell against the bounds, 0 to 1 (by default 0.3 for lsts, else 0.5)
    #[arg(long)]
    alpha: Option<f64>,
    /// Weight of the priors against the data [default: 0.1]
    #[arg(long)]
    kappa: Option<f64>,
    /// Resistance to stretching [default: 1]
    #[arg(long)]
    k_s: Option<f64>,
    /// Resistance to bending [default: 1]
    #[arg(long)]
    k_b: Option<f64>,
    /// Smoothing of the soft bounds [default: 0.1]
    #[arg(long)]
    s: Option<f64>,
    /// Where the soft bounds begin, as LOW:HIGH [default: -0.1:1.1]
    #[arg(long, value_name = "LOW:HIGH", allow_hyphen_values = true)]
    soft_bounds: Option<Pair>,
    /// Smoothing of the norms: in units of l, for literal forms in --unit
    #[arg(long)]
    eps: Option<f64>,
    /// Unit of the literal forms: m, cm or mm [default: mm]
    #[arg(long)]
    unit: Option<String>,
    /// uniform, umbrella, cotan-clamped or cotan-literal [default: uniform]
    #[arg(long)]
    laplacian: Option<String>,
    /// Points of the face that a marker moves, in kouadio: points, zones or triangles
    /// [default: zones]
    #[arg(long)]
    association: Option<String>,
    /// Radius of kouadio's zones, with its unit [default: 12mm]
    #[arg(long)]
    sigma: Option<Length>,
    /// Weight of the bounds in bounds-only [default: 0.001]
    #[arg(long)]
    bounds_weight: Option<f64>,
    /// How far the surface may leave its markers to be smoother (thin-shell-surface) [default: 0]
    #[arg(long)]
    stiffness: Option<f64>,
    /// What of the surface rests: unmoved (by every shape) or nothing [default: unmoved]
    #[arg(long)]
    hold: Option<String>,
    /// Range-of-motion take that regression learns from
    #[arg(long, value_name = "FILE", requires = "training_weights")]
    training: Option<PathBuf>,
    /// Weights played in it: CSV or Live Link Face, a row a frame
    #[arg(long, value_name = "FILE", requires = "training")]
    training_weights: Option<PathBuf>,
    /// Neutral frames of the training take [default: 0:60]
    #[arg(long, value_name = "FIRST:END", requires = "training")]
    training_neutral: Option<Span>,
    /// How regression learns: sparse or exact [default: sparse]
    #[arg(long)]
    inference: Option<String>,
    /// Most basis vectors of the sparse process [default: 200]
    #[arg(long)]
    basis_vectors: Option<u32>,
    /// Length scale of the kernel [default: by the marginal likelihood]
    #[arg(long)]
    length_scale: Option<f64>,
    /// Standard deviation of the process, in weights [default: by the marginal likelihood]
    #[arg(long)]
    signal: Option<f64>,
    /// Standard deviation of the noise on the training weights [default: by the marginal likelihood]
    #[arg(long)]
    noise: Option<f64>,
    /// Cut-off of the zero-phase low-pass of the head's pose, Hz [default: no filter]
    #[arg(long, value_name = "HZ")]
    head_lowpass: Option<f64>,
    /// Shapes held at 0
    #[arg(long, value_name = "SHAPE,SHAPE", value_delimiter = ',')]
    lock: Vec<String>,
    /// Bounds of one shape; may be given again
    #[arg(long, value_name = "SHAPE=LOW:HIGH", allow_hyphen_values = true)]
    bounds: Vec<Named<Pair>>,
    /// Importance of one marker, 1 if not given; may be given again
    #[arg(long, value_name = "MARKER=NUMBER")]
    importance: Vec<Named<f64>>,
    /// Frames of the neutral face, counted from 0, END not included (by default the map's, or 0:60)
    #[arg(long, value_name = "FIRST:END")]
    neutral: Option<Span>,
    /// Markers that move rigidly with the head (by default the map's)
    #[arg(long, value_name = "LABEL,LABEL,LABEL", value_delimiter = ',')]
    head: Option<Vec<String>>,
    /// Frames of the range of motion that automatic scale factors come from (Kouadio 5.3)
    #[arg(long, value_name = "FIRST:END")]
    scale_automatic: Option<Span>,
    /// Scale factor of one marker's displacements; may be given again
    #[arg(long, value_name = "MARKER=S or MARKER=X,Y,Z")]
    scale: Vec<Named<Factors>>,
    /// Scale factor of all markers' displacements
    #[arg(long, value_name = "S or X,Y,Z")]
    scale_global: Option<Factors>,
    /// Third coordinate: measured, or surface for a two-dimensional capture (by default the map's)
    #[arg(long, value_name = "WORD")]
    depth: Option<Depth>,
    /// Symmetric shapes to cut into NAME_L and NAME_R along the face's middle (Kouadio 4.5)
    #[arg(long, value_name = "SHAPE,SHAPE", value_delimiter = ',')]
    split: Vec<String>,
    /// Unit of the capture where its file does not say: m, cm or mm
    #[arg(long, value_name = "UNIT")]
    mocap_unit: Option<String>,
    /// Frames a second of the capture where its file does not say
    #[arg(long, value_name = "HZ")]
    mocap_rate: Option<f64>,
}

/// `LOW:HIGH`.
#[derive(Debug, Clone, Copy)]
struct Pair([f64; 2]);

/// `FIRST:END`.
#[derive(Debug, Clone)]
pub(crate) struct Span(pub(crate) Range<usize>);

/// Metres, from `12mm`, `1.2cm` or `0.012m`.
#[derive(Debug, Clone, Copy)]
struct Length(f64);

/// A factor, or one for each of x, y, z.
#[derive(Debug, Clone, Copy)]
struct Factors([f64; 3]);

/// `NAME=VALUE`.
#[derive(Debug, Clone)]
struct Named<T>(String, T);

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
    let avatar = mimique_face::read_avatar(&args.avatar).map_err(|e| blame(&args.avatar, e))?;
    mimique_stimulus::lock_shapes(&mut spec, &avatar.locked);
    let split = split_shapes(&avatar.avatar, &args.split)
        .map_err(|e| blame(&args.avatar, format!("--{e}")))?;
    let skin = AvatarSkin::of(&split).map_err(|e| blame(&args.avatar, e))?;
    let recording = capture(&args, &args.mocap)?;
    let text = std::fs::read_to_string(markers)
        .map_err(|e| blame(markers, format!("open: {e}; check the path")))?;
    let map = MarkerMap::from_text(&text).map_err(|e| blame(markers, e))?;
    let sidecar = RepairSidecar::beside(&args.mocap, &read_bytes(&args.mocap)?)
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
        training: training(&args)?.map(Box::new),
        repair: sidecar.as_ref().map(RepairSidecar::hash),
    };
    let read = seconds();

    progress.set_message(format!("solving {} frames", recording.capture.frames()));
    let mut solved =
        solve_take(&skin, &recording.capture, &map, &spec, &options, &mut || seconds())
            .map_err(|e| blame(at_fault(&e, &args), e))?;
    let notes = avatar.notes.iter().map(|n| (&args.avatar, n));
    let notes = notes.chain(recording.capture.notes.iter().map(|n| (&args.mocap, n)));
    let mut notes: Vec<String> =
        notes.map(|(file, n)| format!("{}: {n}", file.display())).collect();
    notes.extend(sidecar.map(|s| {
        format!("{}: repaired from {}: {}", args.mocap.display(), s.source.file, s.repair.summary())
    }));

    progress.set_message("writing");
    let start = seconds();
    std::fs::write(&args.out, solved.table.to_csv())
        .map_err(|e| blame(&args.out, format!("{e}; check the folder and its permissions")))?;
    if let Some(path) = &args.vertices {
        let mut npy = VertexFrames::new(&skin, &solved);
        write_whole(path, |out| npy.write(out))?;
    }
    solved.report.seconds.read = read;
    solved.report.seconds.write = seconds() - start;
    if let Some(path) = &args.report {
        let mut report = serde_json::to_value(&solved.report).context("report")?;
        report["notes"] = json!(notes);
        report["files"] = json!({
            "avatar": args.avatar, "mocap": args.mocap, "markers": args.markers, "out": args.out,
        });
        std::fs::write(path, serde_json::to_string_pretty(&report)? + "\n")
            .map_err(|e| blame(path, format!("{e}; check the folder and its permissions")))?;
    }
    progress.finish_and_clear();
    print(&args, &solved, &notes, json)
}

fn print(args: &Args, solved: &SolvedCapture, notes: &[String], json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let report = &solved.report;
    if json {
        let mut value = serde_json::to_value(report)?;
        if let Value::Object(map) = &mut value {
            // One object a frame is for --report.
            map.remove("frames");
            map.insert("notes".into(), json!(notes));
            map.insert("out".into(), json!(args.out));
        }
        writeln!(out, "{}", serde_json::to_string_pretty(&value)?)?;
        return Ok(());
    }
    let SolveReport { summary, seconds, .. } = report;
    writeln!(
        out,
        "{}: {} frames at {} Hz, {} shapes, {} markers, {} head markers, method {}",
        args.out.display(),
        summary.frames,
        report.rate_hz,
        report.shapes,
        report.markers.len(),
        report.head.len(),
        report.method.method,
    )?;
    writeln!(
        out,
        "residual {:.3} mm rms, {:.3} mm at worst; {:.1} iterations a frame, {} at most; KKT error {:.1e} at worst",
        summary.residual_rms_mm,
        summary.residual_worst_mm,
        summary.iterations_mean,
        summary.iterations_most,
        summary.kkt_worst,
    )?;
    if let Some(learnt) = &report.regression {
        writeln!(
            out,
            "learnt from {} frames, {} basis vectors; length scale {:.3}, signal {:.3}, noise {:.4}; predictive deviation {:.3} at worst",
            learnt.training_frames,
            learnt.basis_vectors,
            learnt.kernel.length,
            learnt.kernel.signal,
            learnt.kernel.noise,
            summary.deviation_worst.unwrap_or(0.0),
        )?;
    }
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
    report.warnings.iter().try_for_each(|warning| writeln!(out, "warning: {warning}"))?;
    Ok(())
}

/// The capture of a file.
fn capture(args: &Args, file: &Path) -> anyhow::Result<mimique_mocap::Recording> {
    let bytes = read_bytes(file)?;
    let unit = args.mocap_unit.as_deref().map(length_unit).transpose()?;
    let options = ReadOptions { unit, rate_hz: args.mocap_rate };
    mimique_mocap::read_recording(&file.to_string_lossy(), &bytes, &options)
        .map_err(|e| blame(file, e))
}

fn read_bytes(file: &Path) -> anyhow::Result<Vec<u8>> {
    std::fs::read(file)
        .map_err(|e| blame(file, format!("open: {e}; check the path and its permissions")))
}

/// What regression learns from.
fn training(args: &Args) -> anyhow::Result<Option<Training>> {
    let (Some(take), Some(weights)) = (&args.training, &args.training_weights) else {
        return Ok(None);
    };
    Ok(Some(Training {
        capture: capture(args, take)?.capture,
        weights: WeightsTable::from_recording(weights, &read_bytes(weights)?)
            .map_err(|e| blame(weights, e))?,
        neutral: args.training_neutral.as_ref().map(|s| s.0.clone()),
        head: None,
    }))
}

/// Writes a file that is whole or absent.
fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>,
) -> anyhow::Result<()> {
    let part = path.with_extension("part");
    let written = std::fs::File::create(&part)
        .map(std::io::BufWriter::new)
        .and_then(|mut file| write(&mut file).and_then(|()| file.flush()))
        .and_then(|()| std::fs::rename(&part, path));
    written.map_err(|e| {
        let _ = std::fs::remove_file(&part);
        blame(path, format!("{e}; check the folder and its permissions"))
    })
}

fn method_spec(args: &Args) -> anyhow::Result<MethodSpec> {
    let option =
        |e: mimique_solver::SpecError| anyhow!("--{}: {}", option_name(&e.field), e.message);
    let method = Method::from_str(&args.method).map_err(option)?;
    let mut spec = MethodSpec {
        alpha: args.alpha,
        kappa: args.kappa,
        k_s: args.k_s,
        k_b: args.k_b,
        laplacian: None,
        association: None,
        soft_bounds: args.soft_bounds.map(|p| p.0),
        s: args.s,
        eps: args.eps,
        sigma: args.sigma.map(|l| l.0),
        bounds_weight: args.bounds_weight,
        unit: None,
        stiffness: args.stiffness,
        basis_vectors: args.basis_vectors,
        length_scale: args.length_scale,
        signal: args.signal,
        noise: args.noise,
        locked: args.lock.clone(),
        importance: unique("--importance", &args.importance)?,
        bounds: unique("--bounds", &args.bounds)?.into_iter().map(|(k, p)| (k, p.0)).collect(),
        head_lowpass_hz: args.head_lowpass,
        ..MethodSpec::new(method)
    };
    if let Some(word) = &args.laplacian {
        spec.laplacian = Some(serde_json::from_value(json!(word)).map_err(|_| {
            anyhow!("--laplacian: {word:?}; use uniform, umbrella, cotan-clamped or cotan-literal")
        })?);
    }
    if let Some(word) = &args.hold {
        spec.hold = Some(
            serde_json::from_value(json!(word))
                .map_err(|_| anyhow!("--hold: {word:?}; use unmoved or nothing"))?,
        );
    }
    if let Some(word) = &args.inference {
        spec.inference = Some(
            serde_json::from_value(json!(word))
                .map_err(|_| anyhow!("--inference: {word:?}; use sparse or exact"))?,
        );
    }
    if let Some(word) = &args.association {
        spec.association = Some(
            serde_json::from_value(json!(word))
                .map_err(|_| anyhow!("--association: {word:?}; use points, zones or triangles"))?,
        );
    }
    if let Some(word) = &args.unit {
        spec.unit = Some(
            serde_json::from_value(json!(word))
                .map_err(|_| anyhow!("--unit: {word:?}; use m, cm or mm"))?,
        );
    }
    spec.validate().map_err(option)?;
    Ok(spec)
}

/// The command line's name of a field of the method: `headLowpassHz` is `head-lowpass`.
fn option_name(field: &str) -> String {
    let field = field.split('.').next().unwrap_or(field);
    match field {
        "headLowpassHz" => "head-lowpass".to_owned(),
        "locked" => "lock".to_owned(),
        _ => field
            .chars()
            .flat_map(|c| {
                let dash = c.is_ascii_uppercase().then_some('-');
                dash.into_iter().chain(c.to_lowercase())
            })
            .collect(),
    }
}

fn unique<T: Clone>(option: &str, list: &[Named<T>]) -> anyhow::Result<BTreeMap<String, T>> {
    let mut map = BTreeMap::new();
    for Named(name, value) in list {
        if map.insert(name.clone(), value.clone()).is_some() {
            bail!("{option}: {name} is given twice; give it once");
        }
    }
    Ok(map)
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
        SolveError::Surface(_) => &args.avatar,
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

impl FromStr for Pair {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers =
            text.split_once(':').and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
        numbers.map(Pair).ok_or_else(|| "give two numbers as LOW:HIGH".to_owned())
    }
}

impl FromStr for Factors {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> = text
            .split(',')
            .map(|x| x.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0))
            .collect();
        match numbers.as_deref() {
            Some(&[x]) => Ok(Self([x; 3])),
            Some(&[x, y, z]) => Ok(Self([x, y, z])),
            _ => Err("give a number of 0 or more, or three for x, y and z".to_owned()),
        }
    }
}

impl FromStr for Span {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers =
            text.split_once(':').and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
        numbers
            .filter(|span: &Range<usize>| span.start < span.end)
            .map(Span)
            .ok_or_else(|| "give the first frame and the one after the last, as 0:60".to_owned())
    }
}

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Dividing keeps 12 mm the nearest number to 0.012.
        let units = [("mm", 1000.0), ("cm", 100.0), ("m", 1.0)];
        let metres = units.iter().find_map(|(unit, per_metre)| {
            let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
            Some(number / per_metre)
        });
        metres.map(Length).ok_or_else(|| "give a length with its unit, as 12mm".to_owned())
    }
}

impl<T: FromStr> FromStr for Named<T> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').ok_or("give it as NAME=VALUE")?;
        let value = value.parse().map_err(|_| format!("{value:?} cannot be read"))?;
        Ok(Named(name.to_owned(), value))
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use mimique_solver::Hold;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    fn spec(words: &[&str]) -> anyhow::Result<MethodSpec> {
        let files = ["mimique", "--avatar", "a", "--mocap", "m", "--markers", "k", "--out", "w"];
        let line = Line::try_parse_from(files.iter().chain(words).copied())?;
        method_spec(&line.args)
    }

    #[test]
    fn options_become_the_method_s_parameters() {
        let spec = spec(&[
            "--method",
            "kouadio",
            "--sigma",
            "12mm",
            "--lock",
            "jawOpen,jawLeft",
            "--bounds",
            "jawRight=-1:1",
            "--importance",
            "M03=0.5",
            "--head-lowpass",
            "10",
        ])
        .unwrap();
        assert_eq!(spec.sigma, Some(0.012));
        assert_eq!(spec.locked, ["jawOpen", "jawLeft"]);
        assert_eq!(spec.bounds["jawRight"], [-1.0, 1.0]);
        assert_eq!(spec.importance["M03"], 0.5);
        assert_eq!(spec.head_lowpass_hz, Some(10.0));
    }

    #[test]
    fn surface_and_regression_have_their_options() {
        let surface = spec(&[
            "--method",
            "thin-shell-surface",
            "--stiffness",
            "0.1",
            "--hold",
            "nothing",
            "--importance",
            "M03=2",
            "--laplacian",
            "umbrella",
        ])
        .unwrap();
        assert_eq!((surface.stiffness, surface.hold), (Some(0.1), Some(Hold::Nothing)));
        let words = ["--method", "regression", "--basis-vectors", "50", "--noise", "0.02"];
        let learnt = spec(&words).unwrap();
        assert_eq!((learnt.basis_vectors, learnt.noise), (Some(50), Some(0.02)));
    }

    #[test]
    fn what_a_method_does_not_use_is_refused_by_its_option() {
        for (words, option) in [
            (vec!["--method", "box", "--bounds-weight", "1"], "--bounds-weight: "),
            (vec!["--method", "lasso"], "--method: "),
            (vec!["--method", "recorded", "--head-lowpass", "5"], "--head-lowpass: "),
            (vec!["--alpha", "2"], "--alpha: "),
            (vec!["--laplacian", "cotan"], "--laplacian: "),
            (vec!["--importance", "A=1", "--importance", "A=2"], "--importance: "),
            (vec!["--hold", "neck"], "--hold: "),
            (vec!["--inference", "dense"], "--inference: "),
            (vec!["--stiffness", "1"], "--stiffness: "),
            (vec!["--method", "regression", "--basis-vectors", "3"], "--basis-vectors: "),
        ] {
            let error = spec(&words).unwrap_err().to_string();
            assert!(error.starts_with(option), "{words:?}: {error}");
        }
        for words in [["--sigma", "12"], ["--neutral", "60:0"], ["--bounds", "jawOpen"]] {
            assert!(spec(&words).is_err(), "{words:?}");
        }
    }
}
