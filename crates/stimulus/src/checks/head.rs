//! Head markers that sit on skin that moves: after stabilisation a marker on the skull stands
//! still, one on a forehead goes with the brows.

use mimique_geometry::{Point, RigidMotion, centroid};
use serde::Serialize;

use crate::TakeWarning;

/// How still a head marker is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeadMarker {
    /// The label.
    pub label: String,
    /// Root mean square distance from its mean place on the head, millimetres.
    pub residual_mm: f64,
    /// Largest distance, millimetres.
    pub worst_mm: f64,
}

/// A sensor's noise leaves less than this on a head marker; skin that moves leaves more.
/// Millimetres, rms.
pub const STILL_MM: f64 = 1.0;

/// The residual of each head marker: `columns` of frames x 3 `width` positions (metres, NaN where a
/// marker is not seen) under the head's motion of each frame.
pub(crate) fn head_markers(
    labels: &[String],
    columns: &[usize],
    positions: &[f64],
    width: usize,
    poses: &[RigidMotion],
) -> Vec<HeadMarker> {
    let residuals = |column: usize| {
        let points: Vec<Point> = (positions.chunks_exact(3 * width).zip(poses))
            .map(|(frame, pose)| {
                let p = &frame[3 * column..3 * column + 3];
                pose.apply(Point::new(p[0], p[1], p[2]))
            })
            .filter(|p| p.is_finite())
            .collect();
        let count = points.len().max(1) as f64;
        let mean = centroid(points.iter().copied());
        let squares = points.iter().map(|p| (*p - mean).length_squared());
        let worst = squares.clone().fold(0.0, f64::max).sqrt();
        ((squares.sum::<f64>() / count).sqrt(), worst)
    };
    (columns.iter())
        .map(|&column| {
            let (rms, worst) = residuals(column);
            HeadMarker {
                label: labels[column].clone(),
                residual_mm: 1e3 * rms,
                worst_mm: 1e3 * worst,
            }
        })
        .collect()
}

/// What is to be said of head markers that move.
pub(crate) fn moving_skin(markers: &[HeadMarker]) -> Option<TakeWarning> {
    let mut moving: Vec<HeadMarker> =
        markers.iter().filter(|m| m.residual_mm > STILL_MM).cloned().collect();
    moving.sort_by(|a, b| b.residual_mm.total_cmp(&a.residual_mm));
    (!moving.is_empty()).then_some(TakeWarning::HeadMarkersMove { markers: moving })
}
