//! Synthetic motion capture: a built-in head performs clips with markers stuck to it.

use super::range_of_motion::range_of_motion;
use super::weights::{Clip, HeadPose, Phases, performance_weights};
use crate::MarkerSites;
use crate::head::rng::Rng;
use crate::head::vec3::{Vec3, v3};
use mimique_avatar::Avatar;

/// A recorded take with its truth. Millimetres, +Y up.
#[derive(Debug, Clone, PartialEq)]
pub struct SyntheticTake {
    /// M marker labels: the face's, then the head's.
    pub labels: Vec<String>,
    /// The labels among them that sit on the skull.
    pub head_labels: Vec<String>,
    /// Frames per second.
    pub rate_hz: f64,
    /// Positions, frame-major, F x M, millimetres.
    pub positions: Vec<[f64; 3]>,
    /// First frame and one past the last frame of the neutral face.
    pub neutral: [usize; 2],
    /// One a clip.
    pub segments: Vec<Segment>,
    /// Planted weights, frame-major, F x N.
    pub truth: Vec<f64>,
    /// The N shapes of `truth`.
    pub shape_names: Vec<String>,
    /// Where the head is, a pose per frame.
    pub head: Vec<HeadPose>,
}

/// Where a clip lies in a take.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Segment {
    /// Emotion and intensity, as `anger3`.
    pub name: String,
    /// First frame.
    pub first: usize,
    /// One past the last frame.
    pub end: usize,
    /// The emotion's word.
    pub emotion: String,
    /// 1 to 3.
    pub intensity: u8,
    /// When the expression comes and goes, frames of the take; none of a range of motion.
    pub phases: Option<Phases>,
}

impl SyntheticTake {
    /// Number of frames F.
    pub fn frames(&self) -> usize {
        self.positions.len() / self.labels.len().max(1)
    }
}

/// Noise of the built-in sensors where nothing else is asked for: its standard deviation on each axis,
/// millimetres.
pub const NOISE_MM: f64 = 0.1;
/// Frames per second of the synthetic cameras.
const RATE_HZ: f64 = 200.0;
/// Frames per second of a range of motion: slow enough to be learnt from in seconds.
const TRAINING_RATE_HZ: f64 = 30.0;
/// Seconds of a clip.
const CLIP_S: f64 = 4.0;
/// Neutral frames before the first clip.
const NEUTRAL_FRAMES: usize = 100;
/// Where the actor sits in the room, mm.
const SEAT: Vec3 = v3(40.0, 1180.0, -25.0);
/// The head turns about the top of the neck, mm.
const NECK: Vec3 = v3(0.0, -75.0, -20.0);

/// The actor performs the clips one after the other, after a neutral start. Every marker is at its
/// skin vertex, moved by the blendshapes, carried by the head's motion and seen with
/// isotropic normal noise of `noise_mm` on each axis.
///
/// Markers whose vertex the actor's skin does not have are left out.
pub fn synthetic_take(
    actor: &Avatar,
    sites: &MarkerSites,
    clips: &[Clip],
    seed: u64,
    noise_mm: f64,
) -> SyntheticTake {
    let n = actor.face_shapes().len();
    let mut session = Session::new(actor, sites, seed, noise_mm, RATE_HZ);
    let rest = vec![0.0; n];
    for _ in 0..NEUTRAL_FRAMES {
        session.record(&rest, &HeadPose::default());
    }
    let mut first = NEUTRAL_FRAMES;
    for clip in clips {
        let played = performance_weights(actor.face_shapes(), clip, RATE_HZ, CLIP_S);
        for f in 0..played.frames() {
            session.record(played.frame(f), &played.head[f]);
        }
        let emotion = clip.emotion.name();
        session.take.segments.push(Segment {
            name: format!("{emotion}{}", clip.intensity),
            first,
            end: first + played.frames(),
            emotion: emotion.to_string(),
            intensity: clip.intensity,
            phases: played.phases.map(|phases| phases.later(first)),
        });
        first += played.frames();
    }
    session.take
}

/// The actor's range of motion ([`range_of_motion`]) after a neutral start, at a slower rate: what
/// a regression learns from, with the truth beside it. One segment, `rangeOfMotion`.
pub fn range_of_motion_take(
    actor: &Avatar,
    sites: &MarkerSites,
    seed: u64,
    noise_mm: f64,
) -> SyntheticTake {
    let mut session = Session::new(actor, sites, seed, noise_mm, TRAINING_RATE_HZ);
    let rest = vec![0.0; actor.face_shapes().len()];
    for _ in 0..NEUTRAL_FRAMES {
        session.record(&rest, &HeadPose::default());
    }
    let played = range_of_motion(actor.face_shapes(), seed, TRAINING_RATE_HZ);
    for f in 0..played.frames() {
        session.record(played.frame(f), &played.head[f]);
    }
    session.take.segments.push(Segment {
        name: "rangeOfMotion".to_owned(),
        first: NEUTRAL_FRAMES,
        end: NEUTRAL_FRAMES + played.frames(),
        emotion: "none".to_owned(),
        intensity: 0,
        phases: None,
    });
    session.take
}

/// A capture that is being recorded.
struct Session {
    rng: Rng,
    noise_mm: f64,
    markers: Markers,
    take: SyntheticTake,
}

impl Session {
    fn new(actor: &Avatar, sites: &MarkerSites, seed: u64, noise_mm: f64, rate_hz: f64) -> Session {
        let markers = Markers::new(actor, sites);
        let head_labels = sites.head_labels().iter().filter(|l| markers.labels.contains(l));
        let take = SyntheticTake {
            labels: markers.labels.clone(),
            head_labels: head_labels.cloned().collect(),
            rate_hz,
            positions: Vec::new(),
            neutral: [0, NEUTRAL_FRAMES],
            segments: Vec::new(),
            truth: Vec::new(),
            shape_names: actor.face_shapes().to_vec(),
            head: Vec::new(),
        };
        Session { rng: Rng::new(seed ^ 0x7461_6b65_5f6e_6f69), noise_mm, markers, take }
    }

    fn record(&mut self, weights: &[f64], pose: &HeadPose) {
        for marker in &self.markers.markers {
            let noise = v3(self.rng.normal(), self.rng.normal(), self.rng.normal()) * self.noise_mm;
            let p = placed(marker.at(weights), pose) + noise;
            self.take.positions.push([p.x, p.y, p.z]);
        }
        self.take.truth.extend_from_slice(weights);
        self.take.head.push(*pose);
    }
}

/// One marker: its place at rest and what each shape does to it, mm.
struct Marker {
    rest: Vec3,
    deltas: Vec<(usize, Vec3)>,
}

impl Marker {
    fn at(&self, weights: &[f64]) -> Vec3 {
        self.deltas.iter().fold(self.rest, |p, &(k, d)| p + d * weights[k])
    }
}

struct Markers {
    labels: Vec<String>,
    markers: Vec<Marker>,
}

impl Markers {
    fn new(actor: &Avatar, sites: &MarkerSites) -> Markers {
        let mut out = Markers { labels: Vec::new(), markers: Vec::new() };
        let Some(skin) = actor.skin() else { return out };
        let mm = |p: [f32; 3]| v3(p[0].into(), p[1].into(), p[2].into()) * 1e3;
        for (label, &v) in sites.labels.iter().zip(&sites.vertices) {
            let Some(&rest) = skin.positions.get(v as usize) else { continue };
            let deltas = skin
                .shapes
                .iter()
                .enumerate()
                .filter_map(|(k, shape)| {
                    let i = shape.vertices.binary_search(&v).ok()?;
                    Some((k, mm(shape.deltas[i])))
                })
                .collect();
            out.labels.push(label.clone());
            out.markers.push(Marker { rest: mm(rest), deltas });
        }
        out
    }
}

/// In the room: turned about the neck, shifted, seated.
fn placed(p: Vec3, pose: &HeadPose) -> Vec3 {
    let [nod, turn, tilt] = pose.rotation;
    let [x, y, z] = pose.translation;
    p.turned_about_x(NECK, nod).turned_about_y(NECK, turn).turned_about_z(NECK, tilt)
        + v3(x, y, z)
        + SEAT
}
