//! Facial motion to be cut or labelled: weights of a file as they are, or a capture's markers in a still
//! head.

use std::path::Path;

use anyhow::{anyhow, bail};
use mimique_geometry::{Point, coordinates};
use mimique_mocap::{Capture, CaptureFile, Format, WeightOptions, stabilise, stillest};

use crate::capture_options::CaptureOptions;

/// Channels over time.
pub struct Motion {
    /// Frame-major; a missing one of a marker is NaN.
    pub values: Vec<f64>,
    /// Names of the channels: shapes, or `LABEL.x`, `LABEL.y`, `LABEL.z`.
    pub names: Vec<String>,
    /// Whether the channels are blendshapes.
    pub of_shapes: bool,
    /// Frames per second.
    pub rate_hz: f64,
    /// What is to be said of the file.
    pub notes: Vec<String>,
}

impl Motion {
    /// Frames.
    pub fn frames(&self) -> usize {
        self.values.len() / self.names.len().max(1)
    }

    /// The names of the shapes; none of markers.
    pub fn shape_names(&self) -> &[String] {
        if self.of_shapes { &self.names } else { &[] }
    }
}

/// The motion of a file; markers where they are, in the capture's unit. Without head markers head motion
/// is noted to be taken for expression.
pub fn read(path: &Path, options: &CaptureOptions) -> anyhow::Result<Motion> {
    let mut file = opened(path)?;
    if holds_weights(&file) {
        return weights(path, &mut file, options);
    }
    let (capture, mut notes, head) = capture(path, &mut file, options)?;
    if head.is_empty() {
        notes.push(
            "no head markers are named: head motion is taken for expression; use --head".to_owned(),
        );
    }
    let values = coordinates(&capture.positions).to_vec();
    Ok(of_markers(&capture, values, notes))
}

/// The motion of a file, comparable between takes: markers as their displacement from the stillest
/// second, in centimetres, the head's own left out.
pub fn read_comparable(path: &Path, options: &CaptureOptions) -> anyhow::Result<Motion> {
    let mut file = opened(path)?;
    if holds_weights(&file) {
        return weights(path, &mut file, options);
    }
    let (mut capture, mut notes, head) = capture(path, &mut file, options)?;
    if head.is_empty() {
        bail!(
            "{}: a capture without head markers: head motion would be learnt; name them with --head or \
             --markers, or solve the capture first",
            path.display()
        );
    }
    without(&mut capture, &head);
    let Some(still) = stillest(&capture, 1.0) else {
        bail!("{}: no marker of the face is seen; check --head", path.display());
    };
    notes.push(format!(
        "displacements from frames {}:{}, the stillest second; see whether the face is neutral there",
        still.frames.start, still.frames.end
    ));
    let centimetres = capture.unit.metres() * 100.0;
    let values = displacements(&capture, still.frames, centimetres);
    Ok(of_markers(&capture, values, notes))
}

fn opened(path: &Path) -> anyhow::Result<CaptureFile<'static>> {
    CaptureFile::open(path).map_err(|e| anyhow!("{}: {e}", path.display()))
}

fn holds_weights(file: &CaptureFile<'_>) -> bool {
    file.format().is_some_and(Format::holds_weights)
}

fn weights(
    path: &Path,
    file: &mut CaptureFile<'_>,
    options: &CaptureOptions,
) -> anyhow::Result<Motion> {
    let blame = |e: String| anyhow!("{}: {e}", path.display());
    let rate_hz = options.mocap_rate;
    let asked = WeightOptions { rate_hz, ..WeightOptions::default() };
    let mut table = file.weights(&asked).map_err(|e| blame(e.to_string()))?;
    let rate_hz = rate_hz
        .or(table.rate_hz())
        .ok_or_else(|| blame("column time: no rate; give it with --mocap-rate".to_owned()))?;
    let mut notes: Vec<String> = file.format().map(Format::taken_for).into_iter().collect();
    let rotations = table.take_rotations_off();
    if !rotations.is_empty() {
        notes.push(format!("columns that are no weights are left out: {}", rotations.join(", ")));
    }
    if table.shape_names.is_empty() {
        return Err(blame("header: no column of weights; give a file with blendshapes".to_owned()));
    }
    let (values, names) = (table.weights, table.shape_names);
    Ok(Motion { values, names, of_shapes: true, rate_hz, notes })
}

/// A capture whose head is still, where its markers are named.
fn capture(
    path: &Path,
    file: &mut CaptureFile<'_>,
    options: &CaptureOptions,
) -> anyhow::Result<(Capture, Vec<String>, Vec<String>)> {
    let recording = options.recording(path, file)?;
    let (mut capture, head) = (recording.capture, options.head()?);
    let mut notes = vec![recording.format.taken_for()];
    notes.append(&mut capture.notes);
    if !head.is_empty() {
        stabilise(&mut capture, &head).map_err(|e| anyhow!("{}: {e}", path.display()))?;
    }
    Ok((capture, notes, head))
}

/// Takes markers out.
fn without(capture: &mut Capture, labels: &[String]) {
    let count = capture.labels.len();
    let kept: Vec<usize> = (0..count).filter(|&m| !labels.contains(&capture.labels[m])).collect();
    let rows = capture.positions.chunks_exact(count.max(1));
    capture.positions = rows.flat_map(|row| kept.iter().map(|&m| row[m])).collect();
    capture.labels = kept.iter().map(|&m| capture.labels[m].clone()).collect();
}

/// The way of every marker from its mean place in some frames, scaled.
fn displacements(capture: &Capture, rest: std::ops::Range<usize>, scale: f64) -> Vec<f64> {
    let count = capture.labels.len();
    let mean = |marker: usize, axis: usize| {
        let seen: Vec<f64> = rest
            .clone()
            .map(|frame| capture.positions[frame * count + marker][axis])
            .filter(|c| c.is_finite())
            .collect();
        seen.iter().sum::<f64>() / seen.len() as f64
    };
    let neutral: Vec<[f64; 3]> =
        (0..count).map(|marker| [0, 1, 2].map(|axis| mean(marker, axis))).collect();
    let of = |(place, position): (usize, &Point)| {
        let own = neutral[place % count.max(1)];
        [0, 1, 2].map(|axis| (position[axis] - own[axis]) * scale)
    };
    capture.positions.iter().enumerate().flat_map(of).collect()
}

fn of_markers(capture: &Capture, values: Vec<f64>, notes: Vec<String>) -> Motion {
    let axes = |label: &String| ["x", "y", "z"].map(|axis| format!("{label}.{axis}"));
    let names = capture.labels.iter().flat_map(axes).collect();
    Motion { values, names, of_shapes: false, rate_hz: capture.rate_hz, notes }
}
