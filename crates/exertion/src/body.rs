//! A body in motion: the joints of a capture in metres, and the mechanical energy of its segments.

use mimique_geometry::{Displacement, Point};
use mimique_mocap::{BodyJoint, BodyJoints, Capture};
use mimique_solver::Lowpass;

use crate::error::{ExertionError, within};
use crate::person::Person;
use crate::segments::{Segment, segments};

/// Thigh and shank together in statures (Winter 2009, figure 4.1).
const LEG_PER_STATURE: f64 = 0.491;
/// Frames per second with which a gait can be followed.
const RATES_HZ: [f64; 2] = [10.0, 1e5];
/// Frames that a derivative needs.
const LEAST_FRAMES: usize = 3;
/// Cut-off of the low-pass by default, Hz: noise of 5 mm makes a walk three times the work, after 6 Hz not.
pub const LOWPASS_HZ: f64 = 6.0;

/// What the length in a capture is in metres.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Scale {
    /// E4: so that thigh and shank are 0.491 statures of the person, the mean of both legs and all frames.
    #[default]
    ByStature,
    /// So many metres are one unit of the capture.
    MetresPerUnit(f64),
}

/// Which way is up in a capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Up {
    /// The axis along which the head is most above the feet, over all frames; Y where no axis stands out,
    /// as of a person who lies.
    #[default]
    Found,
    /// +X.
    X,
    /// +Y.
    Y,
    /// +Z.
    Z,
}

/// How a capture becomes a body in motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyOptions {
    /// The unit.
    pub scale: Scale,
    /// Cut-off of the low-pass on every coordinate, Hz; `None`: none.
    pub lowpass_hz: Option<f64>,
    /// Which way is up.
    pub up: Up,
}

impl Default for BodyOptions {
    fn default() -> Self {
        Self { scale: Scale::ByStature, lowpass_hz: Some(LOWPASS_HZ), up: Up::Found }
    }
}

/// The joints of a body in all frames, in metres and filtered.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Frame after frame; empty where the capture lacks a joint that may be missing.
    pub(crate) tracks: Vec<Vec<Point>>,
    /// The way up, a unit vector.
    pub(crate) up: Displacement,
    pub(crate) rate_hz: f64,
    pub(crate) frames: usize,
    metres_per_unit: f64,
}

impl Body {
    /// Of a capture whose joints are known. In this order: metres, the low-pass on every coordinate.
    ///
    /// # Errors
    /// [`ExertionError`]: a rate below 10 Hz, fewer than three frames, a joint that is missing or in some
    /// frame not seen, a segment without length, a cut-off from half the rate on.
    pub fn new(
        capture: &Capture,
        joints: &BodyJoints,
        person: &Person,
        options: &BodyOptions,
    ) -> Result<Self, ExertionError> {
        let rate_hz = within("rateHz", capture.rate_hz, RATES_HZ, Some("frames per second"))?;
        let frames = capture.frames();
        if frames < LEAST_FRAMES {
            let place = "frames".to_owned();
            return Err(ExertionError::Few { place, found: frames, least: LEAST_FRAMES });
        }
        let mut tracks = tracks(capture, joints)?;
        let metres_per_unit = match options.scale {
            Scale::MetresPerUnit(metres) => within("metresPerUnit", metres, [1e-6, 1e6], None)?,
            Scale::ByStature => {
                LEG_PER_STATURE * person.spec().height_m / mean_leg(&tracks, frames)?
            }
        };
        for point in tracks.iter_mut().flatten() {
            *point = Point(point.0 * metres_per_unit);
        }
        if let Some(cutoff_hz) = options.lowpass_hz {
            let lowpass =
                Lowpass::new(cutoff_hz, rate_hz).map_err(|_| ExertionError::NotBetween {
                    place: "lowpassHz".to_owned(),
                    value: cutoff_hz,
                    above: 0.0,
                    below: Some(rate_hz / 2.0),
                    unit: Some("Hz"),
                })?;
            tracks.iter_mut().for_each(|track| lowpass.filter_points(track));
        }
        let mut body = Self { tracks, up: Displacement::ZERO, rate_hz, frames, metres_per_unit };
        body.drop_ends_without_length();
        body.up = body.way_up(options.up);
        Ok(body)
    }

    /// Frames.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Frames per second.
    pub fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    /// Metres that one unit of the capture was taken for.
    pub fn metres_per_unit(&self) -> f64 {
        self.metres_per_unit
    }

    /// The way up, a unit vector in the capture's axes.
    pub fn up(&self) -> Displacement {
        self.up
    }

    /// A joint in all frames, metres; `None` where the capture lacks it.
    pub fn track(&self, joint: BodyJoint) -> Option<&[Point]> {
        let track = &self.tracks[joint as usize];
        (!track.is_empty()).then_some(track)
    }

    /// Names of the segments that the body is computed with.
    pub fn segment_names(&self) -> Vec<&'static str> {
        self.segments().iter().map(|segment| segment.name).collect()
    }

    pub(crate) fn segments(&self) -> Vec<Segment> {
        segments(|joint| !self.tracks[joint as usize].is_empty())
    }

    /// Forgets an end of a hand or foot that lies on its wrist or ankle: some skeletons have such joints.
    fn drop_ends_without_length(&mut self) {
        for (end, at) in [
            (BodyJoint::LeftHandEnd, BodyJoint::LeftWrist),
            (BodyJoint::RightHandEnd, BodyJoint::RightWrist),
            (BodyJoint::LeftToe, BodyJoint::LeftAnkle),
            (BodyJoint::RightToe, BodyJoint::RightAnkle),
        ] {
            let (ends, ats) = (&self.tracks[end as usize], &self.tracks[at as usize]);
            let length: f64 = ends.iter().zip(ats).map(|(a, b)| (*a - *b).length()).sum();
            // A millimetre: no hand is shorter.
            if length < 1e-3 * ends.len() as f64 {
                self.tracks[end as usize] = Vec::new();
            }
        }
    }

    fn way_up(&self, up: Up) -> Displacement {
        let axis = match up {
            Up::X => 0,
            Up::Y => 1,
            Up::Z => 2,
            Up::Found => return self.found_up(),
        };
        let mut way = Displacement::ZERO;
        way[axis] = 1.0;
        way
    }

    /// The axis, one way or the other, that most of the way from the ankles to the head's top lies along.
    fn found_up(&self) -> Displacement {
        let track = |joint: BodyJoint| &self.tracks[joint as usize];
        let (head, left, right) =
            (track(BodyJoint::HeadTop), track(BodyJoint::LeftAnkle), track(BodyJoint::RightAnkle));
        let ankles = left.iter().zip(right);
        let mean: Displacement =
            head.iter().zip(ankles).map(|(h, (l, r))| (*h - *l) + (*h - *r)).sum();
        let mut way = Displacement::ZERO;
        let largest =
            (0..3).fold(0, |best, k| if mean[k].abs() > mean[best].abs() { k } else { best });
        // cos 45 degrees: else the person lies, or the axes are turned.
        if mean[largest].abs() > 0.7 * mean.length() {
            way[largest] = mean[largest].signum();
        } else {
            way[1] = 1.0;
        }
        way
    }
}

/// The joints in all frames, in the capture's unit.
fn tracks(capture: &Capture, joints: &BodyJoints) -> Result<Vec<Vec<Point>>, ExertionError> {
    let width = capture.labels.len();
    let mut markers = Vec::with_capacity(BodyJoint::COUNT);
    for joint in BodyJoint::ALL {
        let marker = joints.marker(joint).filter(|marker| *marker < width);
        if marker.is_none() && !joint.may_be_missing() {
            let place = "joints".to_owned();
            return Err(ExertionError::MissingJoint { place, joint: joint.name() });
        }
        markers.push(marker);
    }
    let mut tracks: Vec<Vec<Point>> = markers
        .iter()
        .map(|marker| Vec::with_capacity(marker.map_or(0, |_| capture.frames())))
        .collect();
    // Frame by frame, as the capture lies in memory.
    for frame in capture.positions.chunks_exact(width) {
        for (track, marker) in tracks.iter_mut().zip(&markers) {
            track.extend(marker.map(|marker| frame[marker]));
        }
    }
    for (joint, track) in BodyJoint::ALL.iter().zip(&tracks) {
        if let Some(frame) = track.iter().position(|point| !point.is_finite()) {
            let place = format!("joints/{}", joint.name());
            return Err(ExertionError::UnseenJoint { place, frame });
        }
    }
    Ok(tracks)
}

/// Thigh and shank together: the mean of both legs and all frames.
fn mean_leg(tracks: &[Vec<Point>], frames: usize) -> Result<f64, ExertionError> {
    let length = |a: BodyJoint, b: BodyJoint| -> f64 {
        let pairs = tracks[a as usize].iter().zip(&tracks[b as usize]);
        pairs.map(|(a, b)| (*a - *b).length()).sum::<f64>() / frames as f64
    };
    let left = length(BodyJoint::LeftHip, BodyJoint::LeftKnee)
        + length(BodyJoint::LeftKnee, BodyJoint::LeftAnkle);
    let right = length(BodyJoint::RightHip, BodyJoint::RightKnee)
        + length(BodyJoint::RightKnee, BodyJoint::RightAnkle);
    let leg = (left + right) / 2.0;
    if leg > 0.0 {
        return Ok(leg);
    }
    Err(ExertionError::NoLength { place: "joints/leftThigh".to_owned() })
}
