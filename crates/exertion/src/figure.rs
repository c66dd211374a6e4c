//! A body as it is drawn: its joints in its own axes, kept in one place.

use mimique_geometry::{Displacement, Point};
use mimique_mocap::BodyJoint;
use serde::Serialize;

use crate::body::Body;

/// Positions per second that a picture needs, and positions at most.
const RATE_HZ: f64 = 30.0;
const MOST_POSITIONS: f64 = 6000.0;

/// The joints of a body over a stretch of time.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Figure {
    /// Positions per second.
    pub rate_hz: f64,
    /// After how long the first position comes again, s; `None` where the motion is not repeated.
    pub period_s: Option<f64>,
    /// Names of the joints.
    pub joints: Vec<&'static str>,
    /// Positions x joints x 3, mm: to the body's left, up from the floor, forwards. The middle between the hips
    /// stays in one place but for its height.
    pub millimetres: Vec<i32>,
}

impl Figure {
    /// Of a stretch of time `window_s` (s of the motion, which is repeated on request; else the body stands still
    /// before and after). A repeated motion is given once.
    pub fn of(body: &Body, window_s: [f64; 2], is_repeated: bool) -> Self {
        let span = (body.frames() - 1) as f64 / body.rate_hz();
        let period_s = Some(span).filter(|_| is_repeated);
        let length = (window_s[1] - window_s[0]).max(0.0).min(period_s.unwrap_or(f64::INFINITY));
        let intervals = (length * RATE_HZ).ceil().clamp(1.0, MOST_POSITIONS);
        let axes = Axes::of(body);
        let joints: Vec<BodyJoint> =
            BodyJoint::ALL.into_iter().filter(|joint| body.track(*joint).is_some()).collect();
        let mut millimetres = Vec::with_capacity((intervals as usize + 1) * joints.len() * 3);
        for position in 0..=intervals as usize {
            let t = window_s[0] + length * position as f64 / intervals;
            let t = if is_repeated { t - (t / span).floor() * span } else { t.clamp(0.0, span) };
            let place = t * body.rate_hz();
            let root = axes.root(place);
            for joint in &joints {
                let point = at(&axes.tracks[*joint as usize], place);
                millimetres.extend(axes.coordinates(point, root).map(|m| (1e3 * m).round() as i32));
            }
        }
        Self {
            rate_hz: intervals / length.max(1e-9),
            period_s,
            joints: joints.into_iter().map(BodyJoint::name).collect(),
            millimetres,
        }
    }
}

/// The axes of a body, and its floor.
struct Axes<'a> {
    tracks: &'a [Vec<Point>],
    left: Displacement,
    up: Displacement,
    forwards: Displacement,
    floor: f64,
}

impl<'a> Axes<'a> {
    /// To the left as hips and shoulders lie in the mean of all frames; the floor under the lowest joint.
    fn of(body: &'a Body) -> Self {
        let (tracks, up) = (&body.tracks[..], body.up());
        let across = |left: BodyJoint, right: BodyJoint| -> Displacement {
            let pairs = tracks[left as usize].iter().zip(&tracks[right as usize]);
            pairs.map(|(left, right)| *left - *right).sum()
        };
        let mean = across(BodyJoint::LeftHip, BodyJoint::RightHip)
            + across(BodyJoint::LeftShoulder, BodyJoint::RightShoulder);
        let level = mean - up * mean.dot(up);
        let any = Displacement(up.any_orthonormal_vector());
        let left = if level.length() > 1e-9 { level / level.length() } else { any };
        let floor = tracks.iter().flatten().map(|point| point.dot(*up)).fold(f64::MAX, f64::min);
        Self { tracks, left, up, forwards: left.cross(up), floor }
    }

    /// The middle between the hips at a place among the frames.
    fn root(&self, place: f64) -> Point {
        let [left, right] = [BodyJoint::LeftHip, BodyJoint::RightHip]
            .map(|hip| at(&self.tracks[hip as usize], place));
        left + (right - left) * 0.5
    }

    /// To the left, up from the floor, forwards; m.
    fn coordinates(&self, point: Point, root: Point) -> [f64; 3] {
        let way = point - root;
        [way.dot(self.left), point.dot(*self.up) - self.floor, way.dot(self.forwards)]
    }
}

/// A place between two frames.
fn at(track: &[Point], place: f64) -> Point {
    let low = (place.max(0.0).floor() as usize).min(track.len() - 1);
    let high = (low + 1).min(track.len() - 1);
    track[low] + (track[high] - track[low]) * (place - low as f64).clamp(0.0, 1.0)
}
