//! A capture at another rate.

use crate::{Capture, LowPass};
use mimique_geometry::Point;

/// A rate no capture can have.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("resample: {rate_hz} frames per second; give a rate above 0 and up to 100000")]
pub struct ResampleError {
    /// The rate asked for.
    pub rate_hz: f64,
}

/// Resample to `rate_hz` by cubic interpolation (Catmull-Rom; straight beside gaps and ends).
/// Downwards, frequencies that the new rate cannot hold are taken out first, by a zero-phase
/// Butterworth at 0.4 of it. A new frame between a present and a missing one is missing.
///
/// # Errors
/// [`ResampleError`] when the new rate is not above 0 and at most 100,000.
pub fn resample(capture: &Capture, rate_hz: f64) -> Result<Capture, ResampleError> {
    // The bound keeps a slip of the unit (microseconds for hertz) from filling the memory.
    if !(rate_hz > 0.0 && rate_hz <= 100_000.0) {
        return Err(ResampleError { rate_hz });
    }
    let mut source = capture.clone();
    if rate_hz < capture.rate_hz {
        LowPass::Butterworth { cutoff_hz: 0.4 * rate_hz }
            .filter_capture(&mut source)
            .map_err(|_| ResampleError { rate_hz })?;
    }
    let (frames, markers) = (source.frames(), source.labels.len());
    let ratio = source.rate_hz / rate_hz;
    // The last new frame is not after the last old one, but for rounding.
    let last = (frames.saturating_sub(1) as f64 / ratio + 1e-9).floor() as usize;
    let total = if frames == 0 { 0 } else { last + 1 };
    let mut positions = Vec::with_capacity(total * markers);
    for frame in 0..total {
        let at = (frame as f64 * ratio).min((frames - 1) as f64);
        // A new frame on an old one, but for rounding, is that one.
        let nearest = at.round();
        let at = if (at - nearest).abs() < 1e-6 { nearest } else { at };
        let (before, t) = (at.floor() as usize, at.fract());
        for marker in 0..markers {
            positions.push(between(&source, marker, before, t));
        }
    }
    let first = (capture.first_frame as f64 / ratio).round() as u64;
    Ok(Capture { rate_hz, first_frame: first, positions, ..source })
}

/// The marker `t` of the way from frame `before` to the next.
fn between(capture: &Capture, marker: usize, before: usize, t: f64) -> Point {
    let at = |frame: usize| capture.frame(frame)[marker];
    let p1 = at(before);
    if t == 0.0 || before + 1 >= capture.frames() {
        return p1;
    }
    let p2 = at(before + 1);
    let present = |frame: Option<usize>| {
        frame.filter(|f| *f < capture.frames()).map(at).filter(|p| p.is_seen())
    };
    // Beyond a gap or an end the line goes on.
    let p0 = present(before.checked_sub(1)).unwrap_or(p1 - (p2 - p1));
    let p3 = present(Some(before + 2)).unwrap_or(p2 + (p2 - p1));
    let (m1, m2, d) = ((p2 - p0) * 0.5, (p3 - p1) * 0.5, p2 - p1);
    p1 + t * (m1 + t * (3.0 * d - 2.0 * m1 - m2 + t * (m1 + m2 - 2.0 * d)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LengthUnit;

    fn capture(rate_hz: f64, frames: usize) -> Capture {
        let at = |f: usize| {
            let t = f as f64 / rate_hz;
            Point::new(50.0 * (2.0 * t).sin(), 3.0 * t, t * t)
        };
        Capture {
            labels: vec!["a".to_owned()],
            rate_hz,
            first_frame: 0,
            unit: LengthUnit::Millimetre,
            positions: (0..frames).map(at).collect(),
            notes: Vec::new(),
        }
    }

    #[test]
    fn a_smooth_motion_is_the_same_at_another_rate() {
        for (from, to) in [(200.0, 60.0), (60.0, 200.0), (100.0, 100.0), (120.0, 50.0)] {
            let frames = (4.0 * from) as usize + 1;
            let got = resample(&capture(from, frames), to).unwrap();
            let want = capture(to, (4.0 * to) as usize + 1);
            assert_eq!((got.frames(), got.rate_hz), (want.frames(), to));
            let edge = (0.2 * to) as usize;
            for frame in edge..want.frames() - edge {
                for k in 0..3 {
                    let error = (got.frame(frame)[0][k] - want.frame(frame)[0][k]).abs();
                    assert!(error < 0.02, "{from} to {to}, frame {frame}: {error} mm");
                }
            }
        }
    }

    #[test]
    fn missing_stays_missing() {
        let mut source = capture(50.0, 11);
        source.positions[4] = Point::UNSEEN;
        let got = resample(&source, 100.0).unwrap();
        let missing: Vec<usize> = (0..21).filter(|&f| got.frame(f)[0][0].is_nan()).collect();
        assert_eq!(missing, [7, 8, 9]);
        assert!(resample(&source, f64::NAN).is_err());
    }
}
