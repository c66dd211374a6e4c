//! The head held still: every frame carried so that the head's markers lie on their reference.

use mimique_geometry::{Point, RigidMotion, centroid, pose_between};

use crate::Capture;

/// What was found of the head.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Stabilisation {
    /// Labels of the markers that move with the head.
    pub labels: Vec<String>,
    /// Where they are held, in the capture's unit: their mean place in the head.
    pub reference: Vec<Point>,
    /// Root mean square distance of the head's markers from the reference, a frame, millimetres;
    /// null where the head's pose could not be told.
    pub residual_mm: Vec<Option<f64>>,
    /// The same over all frames, millimetres.
    pub residual_rms_mm: f64,
    /// The largest of a frame, millimetres.
    pub residual_worst_mm: f64,
    /// Frames without three head markers; all their markers are missing now.
    pub lost_frames: Vec<usize>,
}

/// Why a head cannot be held still.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StabiliseError {
    /// A label that the capture does not have.
    #[error("head marker {label}: not in the capture; name markers of the capture")]
    Label {
        /// The label.
        label: String,
    },
    /// Too few markers.
    #[error("head markers: {count} named; name at least 3 that move with the head")]
    Few {
        /// How many.
        count: usize,
    },
    /// Never three of them together.
    #[error("head markers: all of {labels} together in no frame; name others, or fill their gaps")]
    NeverSeen {
        /// The labels.
        labels: String,
    },
}

/// Passes in which the reference becomes the mean of the markers that were laid onto it: the first
/// takes the noise of a single frame out, the second what the first left of it.
const PASSES: usize = 2;
/// Frames that the mean is taken over.
const SAMPLES: usize = 2000;

/// Hold the head still, in place. The reference lies as the head does in the first frame in which
/// all its markers are seen; its shape is their mean shape.
///
/// A frame that misses head markers is carried by the others, three at least.
///
/// # Errors
/// [`StabiliseError`]; the capture is then unchanged.
pub fn stabilise(capture: &mut Capture, head: &[String]) -> Result<Stabilisation, StabiliseError> {
    let markers: Vec<usize> = head
        .iter()
        .map(|label| {
            let found = capture.marker_index(label);
            found.ok_or_else(|| StabiliseError::Label { label: label.clone() })
        })
        .collect::<Result<_, _>>()?;
    if markers.len() < 3 {
        return Err(StabiliseError::Few { count: markers.len() });
    }
    let reference = reference(capture, &markers)
        .ok_or_else(|| StabiliseError::NeverSeen { labels: head.join(", ") })?;
    let mm = capture.unit.metres() * 1e3;
    let count = capture.labels.len();
    let mut residual_mm = Vec::with_capacity(capture.frames());
    let mut lost_frames = Vec::new();
    for frame in 0..capture.frames() {
        let row = &mut capture.positions[frame * count..(frame + 1) * count];
        match pose(row, &markers, &reference) {
            Some((pose, residual)) => {
                row.iter_mut().for_each(|p| *p = pose.apply(*p));
                residual_mm.push(Some(residual * mm));
            }
            None => {
                row.fill(Point::UNSEEN);
                residual_mm.push(None);
                lost_frames.push(frame);
            }
        }
    }
    let known = || residual_mm.iter().flatten().copied();
    let squares: f64 = known().map(|r| r * r).sum();
    Ok(Stabilisation {
        labels: head.to_vec(),
        residual_rms_mm: (squares / known().count().max(1) as f64).sqrt(),
        residual_worst_mm: known().fold(0.0, f64::max),
        reference,
        residual_mm,
        lost_frames,
    })
}

/// The motion of a frame onto the reference and the root mean square of what is left.
fn pose(row: &[Point], markers: &[usize], reference: &[Point]) -> Option<(RigidMotion, f64)> {
    let pairs = || markers.iter().map(|&m| row[m]).zip(reference.iter().copied());
    let pose = pose_between(pairs()).ok()?.motion();
    let left = || pairs().filter(|(p, _)| p.is_seen()).map(|(p, q)| pose.apply(p) - q);
    let squares: f64 = left().map(|d| d.length_squared()).sum();
    Some((pose, (squares / left().count() as f64).sqrt()))
}

/// The head's markers in the first frame that has all of them, with the mean shape.
fn reference(capture: &Capture, markers: &[usize]) -> Option<Vec<Point>> {
    let whole: Vec<usize> = (0..capture.frames())
        .filter(|&f| markers.iter().all(|&m| capture.frame(f)[m].is_seen()))
        .collect();
    let first = capture.frame(*whole.first()?);
    let start: Vec<Point> = markers.iter().map(|&m| first[m]).collect();
    let mut reference = start.clone();
    let step = (whole.len() / SAMPLES).max(1);
    for _ in 0..PASSES {
        let poses: Vec<(usize, RigidMotion)> = (whole.iter().step_by(step))
            .filter_map(|&f| Some((f, pose(capture.frame(f), markers, &reference)?.0)))
            .collect();
        if poses.is_empty() {
            return None;
        }
        let laid = |m: usize| poses.iter().map(move |(f, pose)| pose.apply(capture.frame(*f)[m]));
        reference = markers.iter().map(|&m| centroid(laid(m))).collect();
    }
    // The mean drifts with the noise of the frames: laid back onto the first one.
    let back = pose_between(reference.iter().copied().zip(start)).ok()?.motion();
    Some(reference.iter().map(|p| back.apply(*p)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LengthUnit;
    use crate::repair::abrupt_steps::distance;

    /// A head of five markers that turns and shifts, and a jaw that drops; millimetres.
    fn planted(noise: f64) -> (Capture, Vec<f64>) {
        let head = [
            [0.0, 90.0, 80.0],
            [60.0, 60.0, 60.0],
            [-60.0, 62.0, 58.0],
            [30.0, 110.0, 50.0],
            [-20.0, 40.0, 100.0],
        ];
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            ((state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5) * noise
        };
        let mut jaw = Vec::new();
        let mut positions = Vec::new();
        for f in 0..300 {
            let t = f as f64 / 100.0;
            let (s, c) = (0.3 * (2.0 * t).sin()).sin_cos();
            jaw.push(10.0 * (1.0 - (4.0 * t).cos()));
            let chin = [0.0, -50.0 - jaw[f], 70.0];
            for p in head.iter().chain([&chin]) {
                let turned = [c * p[0] + s * p[2] + 30.0 * t, p[1] + 9.0 * t, c * p[2] - s * p[0]];
                positions.push(Point::from(turned.map(|v| v + random())));
            }
        }
        let capture = Capture {
            labels: ["h0", "h1", "h2", "h3", "h4", "chin"].map(str::to_owned).to_vec(),
            rate_hz: 100.0,
            first_frame: 0,
            unit: LengthUnit::Millimetre,
            positions,
            notes: Vec::new(),
        };
        (capture, jaw)
    }

    fn head() -> Vec<String> {
        ["h0", "h1", "h2", "h3", "h4"].map(str::to_owned).to_vec()
    }

    #[test]
    fn a_planted_head_motion_is_taken_out_and_the_jaw_stays() {
        let (mut capture, jaw) = planted(0.0);
        let first = capture.frame(0).to_vec();
        let done = stabilise(&mut capture, &head()).unwrap();
        for (f, jaw) in jaw.iter().enumerate() {
            for (p, q) in capture.frame(f).iter().zip(&first).take(5) {
                assert!(distance(*p, *q) < 1e-9);
            }
            assert!((capture.frame(f)[5][1] - (-50.0 - jaw)).abs() < 1e-9);
        }
        assert!(done.residual_worst_mm < 1e-9 && done.lost_frames.is_empty());
    }

    #[test]
    fn the_residual_is_the_noise_and_lost_markers_are_made_do_without() {
        let (mut capture, jaw) = planted(1.0);
        for f in 100..120 {
            capture.positions[6 * f] = Point::UNSEEN;
        }
        for m in 0..3 {
            capture.positions[6 * 200 + m] = Point::UNSEEN;
        }
        let done = stabilise(&mut capture, &head()).unwrap();
        // Uniform noise of +-0.5 mm: 0.29 mm a coordinate, 15 coordinates less 6 of the pose.
        let expected = 0.5 * (9.0_f64 / 15.0).sqrt();
        assert!((done.residual_rms_mm - expected).abs() < 0.05, "{}", done.residual_rms_mm);
        assert_eq!(done.lost_frames, [200]);
        assert_eq!(done.residual_mm[200], None);
        assert!(capture.frame(200).iter().all(|p| p[0].is_nan()));
        for f in (0..300).filter(|f| *f != 200) {
            // The pose's own error grows with the distance from the head's markers.
            assert!((capture.frame(f)[5][1] - (-50.0 - jaw[f])).abs() < 3.0);
        }
    }

    #[test]
    fn wrong_heads_are_refused_and_change_nothing() {
        let (mut capture, _) = planted(0.0);
        let before = capture.clone();
        for (labels, message) in [
            (vec!["h0", "h1", "hat"], "head marker hat: not in the capture"),
            (vec!["h0", "h1"], "head markers: 2 named"),
        ] {
            let labels: Vec<String> = labels.into_iter().map(str::to_owned).collect();
            let error = stabilise(&mut capture, &labels).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
        assert_eq!(capture, before);
        for f in 0..300 {
            capture.positions[6 * f + f % 3] = Point::UNSEEN;
        }
        let error = stabilise(&mut capture, &head()).unwrap_err();
        assert!(matches!(error, StabiliseError::NeverSeen { .. }));
    }
}
