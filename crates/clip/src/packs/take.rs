//! The take pack (`MMTK`): the markers of one segment, or weights that were recorded.
//!
//! Markers: the columns that are needed, in metres, in steps of 0.01 to 0.05 mm, by what is new in
//! each frame (mostly the sensor's noise), with a margin of the head's markers on both sides for its
//! low-pass to settle; the head's reference and the neutral face of the whole capture, scale factors
//! and the surface that gives a flat capture its depth as f64. A capture whose coordinates lie on the
//! steps comes back with the same bits. Recorded weights: in steps that
//! keep every vertex within a hundredth of a millimetre (`weight_steps`), or 0.0001 where none are asked
//! for. Coordinates and weights are stored by `tracks`.

use std::ops::Range;

use mimique_avatar::pack::{PackError, PackReader, PackWriter, open_plain, seal_plain};
use mimique_geometry::{DVec3, Point, coordinates};
use mimique_solver::{FanTriangle, MarkerScales, SurfaceDepth};

use super::tracks::{noise, tracks_from, tracks_to};

const KIND: &str = "MMTK";
const VERSION: u32 = 6;
/// Finest and coarsest step of the markers' coordinates, micrometres.
const STEPS_UM: [f64; 2] = [10.0, 50.0];
/// Step of weights where no other is asked for.
const STEP_WEIGHT: f64 = 1e-4;

/// What is played: a segment's markers or weights.
#[derive(Debug, Clone, PartialEq)]
pub struct TakePack {
    /// Frames per second.
    pub rate_hz: f64,
    /// Number of the first played frame in the capture's own count.
    pub first_frame: u64,
    /// Which of the stored frames are played; the others are margins.
    pub played: Range<usize>,
    /// Markers or weights.
    pub content: TakeContent,
}

/// The two kinds of takes.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "there is one of it for each take")]
pub enum TakeContent {
    /// Trajectories to solve.
    Markers(SegmentMarkers),
    /// Weights to show as they are.
    Weights {
        /// Names of the M columns.
        shape_names: Vec<String>,
        /// Frame-major, M per frame.
        weights: Vec<f64>,
    },
}

/// The markers of a segment and what the front end needs to know of the rest of the capture.
#[derive(Debug, Clone, PartialEq)]
pub struct SegmentMarkers {
    /// Labels of the C columns.
    pub labels: Vec<String>,
    /// Columns that are face markers.
    pub face: Vec<usize>,
    /// Columns that move with the head; none = the head is held still.
    pub head: Option<Vec<usize>>,
    /// The head markers in the capture's first frame, metres.
    pub head_reference: Vec<Point>,
    /// The stabilised neutral of the face markers, metres.
    pub neutral: Vec<Point>,
    /// Factors of the displacements of the face markers; none = as measured.
    pub scales: Option<MarkerScales>,
    /// The surface at the face markers where the capture is two-dimensional.
    pub depth: Option<SurfaceDepth>,
    /// Frames x 3C, metres, NaN where a marker is not seen.
    pub positions: Vec<f64>,
    /// Shapes whose weights do not come from the solve: those of the lids, of a given gaze, of the head's pose.
    pub driven_shapes: Vec<String>,
    /// Their weights, frames x driven shapes.
    pub driven_weights: Vec<f64>,
}

/// Packs a take. Coordinates and weights are rounded to the pack's steps.
pub fn encode_take(take: &TakePack) -> Vec<u8> {
    encode_take_in_steps(take, &[])
}

/// The same with a step for each column of recorded weights, as `weight_steps` finds them; columns
/// without one get 0.0001. Markers have their own.
pub fn encode_take_in_steps(take: &TakePack, steps: &[f64]) -> Vec<u8> {
    let mut w = PackWriter::new();
    w.f64(take.rate_hz);
    w.u64(take.first_frame);
    w.varint(take.played.start as u32);
    w.varint(take.played.end as u32);
    match &take.content {
        TakeContent::Markers(m) => {
            w.u8(0);
            w.texts(&m.labels);
            columns_to(&mut w, Some(&m.face));
            columns_to(&mut w, m.head.as_ref());
            coordinates(&m.head_reference).iter().for_each(|&x| w.f64(x));
            coordinates(&m.neutral).iter().for_each(|&x| w.f64(x));
            scales_to(&mut w, m.scales.as_ref());
            depth_to(&mut w, m.depth.as_ref());
            let columns = 3 * m.labels.len();
            let step = marker_step(noise(&m.positions, columns));
            w.f64(step);
            tracks_to(&mut w, &m.positions, &vec![step; columns]);
            w.texts(&m.driven_shapes);
            if !m.driven_shapes.is_empty() {
                tracks_to(&mut w, &m.driven_weights, &vec![STEP_WEIGHT; m.driven_shapes.len()]);
            }
        }
        TakeContent::Weights { shape_names, weights } => {
            w.u8(1);
            w.texts(shape_names);
            let step = |k| steps.get(k).copied().filter(|s| *s > 0.0).unwrap_or(STEP_WEIGHT);
            let steps: Vec<u16> = (0..shape_names.len()).map(|k| short_step(step(k))).collect();
            steps.iter().for_each(|&s| w.raw(&s.to_le_bytes()));
            let steps: Vec<f64> = steps.into_iter().map(long_step).collect();
            tracks_to(&mut w, weights, &steps);
        }
    }
    seal_plain(KIND, VERSION, &w.into_bytes())
}

/// The step of coordinates, metres: as large as what is typically new in a frame, which rounding then
/// spreads 2 % wider, and within bounds.
fn marker_step(noise_m: f64) -> f64 {
    (1e6 * noise_m).round().clamp(STEPS_UM[0], STEPS_UM[1]) / 1e6
}

/// The step of recorded weights that a pack stores in the place of `step`: the next one below that has eight
/// significant bits.
pub fn stored_step(step: f64) -> f64 {
    long_step(short_step(step))
}

/// The next step below that has eight significant bits: the upper half of an f32.
fn short_step(step: f64) -> u16 {
    ((step as f32).to_bits() >> 16) as u16
}

fn long_step(short: u16) -> f64 {
    f64::from(f32::from_bits(u32::from(short) << 16))
}

/// Unpacks a take.
///
/// # Errors
/// [`PackError`] for anything that [`encode_take`] does not write.
pub fn decode_take(bytes: &[u8]) -> Result<TakePack, PackError> {
    let mut r = PackReader::new(KIND, open_plain(KIND, VERSION, bytes)?);
    let rate_hz = r.f64()?;
    if !(rate_hz.is_finite() && rate_hz > 0.0) {
        return r.refuse(format!("{rate_hz} frames per second"));
    }
    let first_frame = r.u64()?;
    let played = r.varint()? as usize..r.varint()? as usize;
    let (content, frames) = match r.u8()? {
        0 => markers_from(&mut r)?,
        1 => weights_from(&mut r)?,
        other => return r.refuse(format!("kind {other}")),
    };
    if played.is_empty() || played.end > frames {
        return r.refuse(format!("plays frames {}:{} of {frames}", played.start, played.end));
    }
    r.finish()?;
    Ok(TakePack { rate_hz, first_frame, played, content })
}

/// The markers of a segment, and how many frames there are.
fn markers_from(r: &mut PackReader<'_>) -> Result<(TakeContent, usize), PackError> {
    let labels = r.texts()?;
    let Some(face) = columns_from(r, labels.len())? else {
        return r.refuse("no face markers");
    };
    let head = columns_from(r, labels.len())?;
    let head_reference = points(r, head.as_ref().map_or(0, Vec::len))?;
    let neutral = points(r, face.len())?;
    if !neutral.iter().all(|p: &Point| p.is_finite()) {
        return r.refuse("a point of the neutral face is not finite");
    }
    let scales = scales_from(r, face.len())?;
    let depth = depth_from(r, face.len())?;
    let columns = 3 * labels.len();
    let step = r.f64()?;
    if !(step.is_finite() && step > 0.0) {
        return r.refuse(format!("markers in steps of {step} m"));
    }
    let positions = tracks_from(r, &vec![step; columns])?;
    let frames = positions.len() / columns.max(1);
    let driven_shapes = r.texts()?;
    let driven_weights = match driven_shapes.len() {
        0 => vec![],
        shapes => tracks_from(r, &vec![STEP_WEIGHT; shapes])?,
    };
    if driven_weights.len() != driven_shapes.len() * frames
        || driven_weights.iter().any(|w| w.is_nan())
    {
        return r.refuse("driven weights that are not one per frame");
    }
    let markers = SegmentMarkers {
        labels,
        face,
        head,
        head_reference,
        neutral,
        scales,
        depth,
        positions,
        driven_shapes,
        driven_weights,
    };
    Ok((TakeContent::Markers(markers), frames))
}

/// Recorded weights, and how many frames there are.
fn weights_from(r: &mut PackReader<'_>) -> Result<(TakeContent, usize), PackError> {
    let shape_names = r.texts()?;
    let steps = shape_names.iter().map(|_| Ok([r.u8()?, r.u8()?]));
    let steps = steps.map(|s| s.map(|s| long_step(u16::from_le_bytes(s))));
    let steps: Vec<f64> = steps.collect::<Result<_, PackError>>()?;
    if let Some(step) = steps.iter().find(|s| !(s.is_finite() && **s > 0.0)) {
        return r.refuse(format!("weights in steps of {step}"));
    }
    let weights = tracks_from(r, &steps)?;
    let frames = weights.len() / shape_names.len().max(1);
    if weights.iter().any(|w| w.is_nan()) {
        return r.refuse("a weight is missing");
    }
    Ok((TakeContent::Weights { shape_names, weights }, frames))
}

/// A flag, then count and indices.
fn columns_to(w: &mut PackWriter, columns: Option<&Vec<usize>>) {
    w.u8(u8::from(columns.is_some()));
    if let Some(columns) = columns {
        w.varint(columns.len() as u32);
        columns.iter().for_each(|&c| w.varint(c as u32));
    }
}

fn columns_from(r: &mut PackReader<'_>, of: usize) -> Result<Option<Vec<usize>>, PackError> {
    match r.u8()? {
        0 => return Ok(None),
        1 => {}
        other => return r.refuse(format!("column flag {other}")),
    }
    let count = r.count(1)?;
    let mut columns = Vec::with_capacity(count);
    for _ in 0..count {
        let column = r.varint()? as usize;
        if column >= of {
            return r.refuse(format!("column {column} of {of}"));
        }
        columns.push(column);
    }
    Ok(Some(columns))
}

/// Three numbers for each marker.
fn points<T: From<[f64; 3]>>(r: &mut PackReader<'_>, count: usize) -> Result<Vec<T>, PackError> {
    if count.saturating_mul(24) > r.left() {
        return r.refuse(format!("{count} points, {} bytes left", r.left()));
    }
    (0..count).map(|_| Ok(T::from([r.f64()?, r.f64()?, r.f64()?]))).collect()
}

/// A flag, then the factors of positive and of negative coordinates, marker by marker.
fn scales_to(w: &mut PackWriter, scales: Option<&MarkerScales>) {
    w.u8(u8::from(scales.is_some()));
    if let Some(scales) = scales {
        coordinates(&scales.positive).iter().for_each(|&x| w.f64(x));
        coordinates(&scales.negative).iter().for_each(|&x| w.f64(x));
    }
}

fn scales_from(r: &mut PackReader<'_>, face: usize) -> Result<Option<MarkerScales>, PackError> {
    match r.u8()? {
        0 => return Ok(None),
        1 => {}
        other => return r.refuse(format!("scale flag {other}")),
    }
    let (positive, negative): (Vec<DVec3>, Vec<DVec3>) = (points(r, face)?, points(r, face)?);
    if !positive.iter().chain(&negative).all(|factors| factors.is_finite()) {
        return r.refuse("a scale factor is not finite");
    }
    Ok(Some(MarkerScales { positive, negative }))
}

/// A flag, then for each marker its triangles: two edges and two slopes.
fn depth_to(w: &mut PackWriter, depth: Option<&SurfaceDepth>) {
    w.u8(u8::from(depth.is_some()));
    for fan in depth.iter().flat_map(|d| &d.fans) {
        w.varint(fan.len() as u32);
        for t in fan {
            t.edges.iter().chain([&t.slope]).flatten().for_each(|&x| w.f64(x));
        }
    }
}

fn depth_from(r: &mut PackReader<'_>, face: usize) -> Result<Option<SurfaceDepth>, PackError> {
    match r.u8()? {
        0 => return Ok(None),
        1 => {}
        other => return r.refuse(format!("depth flag {other}")),
    }
    let mut fans = Vec::new();
    for _ in 0..face {
        let count = r.count(48)?;
        let mut fan = Vec::with_capacity(count);
        for _ in 0..count {
            let mut pair = || Ok([r.f64()?, r.f64()?]);
            fan.push(FanTriangle { edges: [pair()?, pair()?], slope: pair()? });
        }
        fans.push(fan);
    }
    Ok(Some(SurfaceDepth { fans }))
}
