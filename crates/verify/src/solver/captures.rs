//! Captures in, weights out: the whole way at the stored frames.

use std::path::{Path, PathBuf};

use mimique_clip::{FrameStatistics, MarkerSolution, MarkerTake, TakeContent, solve_markers};
use mimique_mocap::Capture;
use mimique_solver::{Gaze, Method, MethodSpec, OperatorOptions, Untold};
use mimique_stimulus::{JoinedTake, TakeOptions};
use serde_json::{Value, json};

use super::frames::Stored;
use super::head::Head;
use crate::case::{Tolerance, numbers};
use crate::{Case, VerifyError};

/// How captures are called.
const BEGINNING: &str = "take";
/// The stored answers were made with the mean of these frames as the neutral face.
const NEUTRAL: usize = 60;
/// Displacements of a capture in text, metres.
const DISPLACED: f64 = 1e-9;

/// What a file of a capture keeps of its numbers.
#[derive(Clone, Copy)]
struct Precision {
    /// The file's ending.
    ending: &'static str,
    /// How near weights come that have a prior.
    weights: f64,
    /// How near those of bounded least squares come, which has none and multiplies rounding.
    bounded: f64,
    /// Whether least squares without a bound above or on any side are compared: those multiply
    /// rounding to single precision (0.06 µm) without a limit.
    unbounded: bool,
}

const PRECISIONS: [Precision; 2] = [
    Precision { ending: "csv", weights: 1e-6, bounded: 1e-6, unbounded: true },
    Precision { ending: "c3d", weights: 1e-4, bounded: 5e-4, unbounded: false },
];

/// A case for each capture and variant.
pub(super) fn cases(
    head: &mut Head,
    stored: &Stored,
    folder: &Path,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    for (path, precision) in captures(folder)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let whole = mimique_mocap::read(&path).map_err(|error| VerifyError::file(&path, &error))?;
        let Some(cut) = cut(&whole, &stored.frames) else {
            let (last, count) = (stored.frames.iter().max(), whole.frames());
            let why = format!("{count} frames, frame {last:?} is needed; copy the file again");
            return Err(VerifyError::file(&path, &why));
        };
        for optima in &stored.optima {
            let mut case = Case::new(format!("{name}/{}", optima.name));
            let Some((spec, by)) = compared(optima.spec.as_ref(), precision) else { continue };
            let solved = spec.and_then(|spec| solve(head, &cut, spec));
            match solved {
                Ok(solved) => weights(&mut case, &solved, stored, (&optima.weights, by, precision)),
                Err(why) => case.refused("weights", &why),
            }
            each(case);
        }
    }
    Ok(())
}

/// Captures of a folder by name, and how precise they are.
fn captures(folder: &Path) -> Result<Vec<(PathBuf, Precision)>, VerifyError> {
    let unread = |error: std::io::Error| VerifyError::read(folder, &error);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        let begins = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with(BEGINNING));
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        if let Some(own) = PRECISIONS.iter().find(|p| begins && ending == p.ending) {
            found.push((path, *own));
        }
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(found)
}

/// The method and its tolerance, where it is compared with this precision.
fn compared(
    spec: Result<&MethodSpec, &String>,
    precision: Precision,
) -> Option<(Result<MethodSpec, String>, f64)> {
    let spec = match spec {
        Ok(spec) => spec,
        Err(why) => return Some((Err(why.clone()), 0.0)),
    };
    let by = match spec.method {
        Method::Nnls | Method::PseudoInverse if !precision.unbounded => return None,
        Method::Box | Method::Kouadio => precision.bounded,
        _ => precision.weights,
    };
    // The stored optima are of a head that was not filtered, every shape solved.
    let own = MethodSpec {
        head_lowpass_hz: Some(0.0),
        gaze: Some(Gaze::Markers),
        untold: Some(Untold::Solve),
        ..spec.clone()
    };
    Some((Ok(own), by))
}

/// The neutral frames and then the frames that are stored; none where the capture is too short. The
/// head is not filtered, so that no frame depends on its neighbours.
fn cut(whole: &Capture, frames: &[usize]) -> Option<Capture> {
    let all: Vec<usize> = (0..NEUTRAL).chain(frames.iter().copied()).collect();
    if all.iter().any(|&frame| frame >= whole.frames()) {
        return None;
    }
    let positions = all.iter().flat_map(|&frame| whole.frame(frame).iter().copied());
    Some(Capture::new(whole.labels.clone(), whole.rate_hz, whole.unit, positions))
}

/// What `mimique solve` does with a capture; the operators of a kind are built once for all variants.
fn solve(head: &mut Head, cut: &Capture, spec: MethodSpec) -> Result<MarkerSolution, String> {
    let operators = head.operators(&OperatorOptions::of(&spec)).map_err(|why| why.to_string())?;
    let operators = operators.clone();
    let options = TakeOptions { neutral: Some(0..NEUTRAL), ..TakeOptions::default() };
    let joined = JoinedTake::new(&head.skin, cut, &head.map, &options);
    let joined = joined.map_err(|why| why.to_string())?;
    let spec = joined.with_shapes_held(&spec).at_rate(cut.rate_hz);
    let take = joined.segment(&operators, &spec, 0..cut.frames()).map_err(|why| why.to_string())?;
    let TakeContent::Markers(markers) = &take.content else {
        return Err("a take of markers was cut to one of weights".to_owned());
    };
    let (rate_hz, played) = (take.rate_hz, take.played.clone());
    let take = MarkerTake { markers, rate_hz, played };
    solve_markers(&operators, &take, &spec, &mut || 0.0).map_err(|why| why.to_string())
}

/// Weights at the stored frames; of a capture in text also the displacements.
fn weights(
    case: &mut Case,
    solved: &MarkerSolution,
    stored: &Stored,
    (expected, by, precision): (&Value, f64, Precision),
) {
    let rows = |values: &[f64], width: usize| -> Value {
        values.chunks(width).skip(NEUTRAL).map(numbers).collect()
    };
    let got = rows(&solved.weights, solved.fit.shape_count());
    case.compare("weights", expected, &got, Tolerance::Absolute(by));
    let held = FrameStatistics::of(&solved.reports).held.is_some();
    case.compare("frames held", &json!(false), &json!(held), Tolerance::Exact);
    if precision.unbounded {
        let got = rows(&solved.motion.displacements, 3 * solved.fit.marker_count());
        let expected = stored.displacements.iter().map(numbers).collect();
        case.compare("displacements", &expected, &got, Tolerance::Absolute(DISPLACED));
    }
}
