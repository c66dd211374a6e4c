//! Blendshape weights and head pose of one clip, frame by frame.

use super::envelope::{Envelope, blink, rise};
use super::recipe::Emotion;
use crate::head::rng::Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// One posed emotion: neutral, expression, neutral.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Clip {
    /// What is shown.
    pub emotion: Emotion,
    /// 1 (slight) to 3 (strong); others are taken as the nearest of these.
    pub intensity: u8,
    /// Timing, asymmetry, blinks, gaze and sway of this take.
    pub seed: u64,
}

/// Where the head is, against its place at rest.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct HeadPose {
    /// Radians: nod (down positive), turn (to the person's left positive), tilt (to the left
    /// shoulder negative), applied in that order about the neck.
    pub rotation: [f64; 3],
    /// Millimetres.
    pub translation: [f64; 3],
}

/// A clip sampled in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Performance {
    /// Frames per second.
    pub rate_hz: f64,
    /// Number of blendshapes N.
    pub shapes: usize,
    /// Weights in [0, 1], frame-major, F x N.
    pub weights: Vec<f64>,
    /// One pose per frame.
    pub head: Vec<HeadPose>,
    /// When the expression comes and goes; none of a range of motion.
    pub phases: Option<Phases>,
}

/// When an expression comes and goes, frames. Single shapes begin up to a few hundredths of a second
/// earlier or later.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Phases {
    /// The first frame of the way from rest to the apex.
    pub attack: usize,
    /// The first frame of the apex.
    pub apex: usize,
    /// The first frame of the way back.
    pub release: usize,
    /// The first frame at rest again.
    pub rest: usize,
}

impl Phases {
    fn of(whole: &Envelope, rate_hz: f64, frames: usize) -> Self {
        let frame = |t: f64| ((t * rate_hz).round().max(0.0) as usize).min(frames);
        let Envelope { start, attack, release_at, release } = *whole;
        Self {
            attack: frame(start),
            apex: frame(start + attack),
            release: frame(release_at),
            rest: frame(release_at + release),
        }
    }

    /// The same, that many frames later.
    pub fn later(self, by: usize) -> Self {
        let Self { attack, apex, release, rest } = self;
        Self { attack: attack + by, apex: apex + by, release: release + by, rest: rest + by }
    }
}

impl Performance {
    /// Number of frames F.
    pub fn frames(&self) -> usize {
        self.head.len()
    }

    /// The N weights of a frame.
    pub fn frame(&self, f: usize) -> &[f64] {
        &self.weights[f * self.shapes..(f + 1) * self.shapes]
    }
}

/// Strength of the three intensities.
fn strength(intensity: u8) -> f64 {
    match intensity {
        ..=1 => 0.38,
        2 => 0.68,
        _ => 1.0,
    }
}

/// One blendshape's course.
struct Course {
    shape: usize,
    weight: f64,
    envelope: Envelope,
    /// Slow drift at the apex: amplitude, rate (Hz), phase.
    drift: [f64; 3],
}

/// The clip's weights on an avatar's blendshapes (by ARKit's names; recipes name a pair without its
/// side, and shapes that the avatar lacks are left out). Starts and ends at rest. `duration_s` is
/// normally 4; shorter ones shorten the apex first, below about two seconds everything.
pub fn performance_weights(
    shape_names: &[String],
    clip: &Clip,
    rate_hz: f64,
    duration_s: f64,
) -> Performance {
    let mut rng = Rng::new(
        clip.seed
            .wrapping_mul(0x2545_f491_4f6c_dd1d)
            .wrapping_add(u64::from(clip.intensity) * 8 + clip.emotion as u64),
    );
    let strength = strength(clip.intensity);
    let n = shape_names.len();
    let frames = (rate_hz * duration_s).round().max(1.0) as usize;
    let whole = main_envelope(clip, duration_s, &mut rng);
    let courses = courses(shape_names, clip, strength, &whole, duration_s, &mut rng);
    let blinks = blinks(clip, &whole, duration_s, &mut rng);
    let gaze = Gaze::new(clip, &whole, duration_s, &mut rng);
    let sway = Sway::new(clip, strength, &whole, duration_s, &mut rng);
    let find = |name: &str| shape_names.iter().position(|s| s == name);
    let lids = [find("eyeBlinkLeft"), find("eyeBlinkRight")];
    let yielding = yielding_to_blinks(&find);
    let looks: Vec<(usize, f64, f64)> = look_axes(&find);
    let mut out = Performance {
        rate_hz,
        shapes: n,
        weights: vec![0.0; frames * n],
        head: Vec::with_capacity(frames),
        phases: Some(Phases::of(&whole, rate_hz, frames)),
    };
    for f in 0..frames {
        let t = f as f64 / rate_hz;
        let w = &mut out.weights[f * n..(f + 1) * n];
        for course in &courses {
            let level = course.envelope.at(t);
            let [amplitude, rate, phase] = course.drift;
            let drift = 1.0 + amplitude * libm::sin(TAU * (rate * t + phase));
            w[course.shape] += course.weight * level * drift;
        }
        let (x, y) = gaze.at(t);
        for &(shape, along_x, along_y) in &looks {
            w[shape] += (along_x * x + along_y * y).max(0.0);
        }
        let shut = blinks.iter().map(|&start| blink(t, start)).fold(0.0, f64::max);
        // Lids that fall for a blink give up what else they do.
        for &shape in &yielding {
            w[shape] *= 1.0 - 0.9 * shut;
        }
        for shape in lids.into_iter().flatten() {
            w[shape] += (1.0 - w[shape]) * shut;
        }
        for weight in w.iter_mut() {
            *weight = weight.clamp(0.0, 1.0);
        }
        out.head.push(sway.at(t));
    }
    out
}

/// Everything has room in 2.4 seconds; less than that squeezes it.
fn squeeze(duration: f64) -> f64 {
    (duration / 2.4).min(1.0)
}

/// The course of the whole expression; ends at rest a quarter second before the end.
fn main_envelope(clip: &Clip, duration: f64, rng: &mut Rng) -> Envelope {
    let (attack, release) = clip.emotion.attack_release_s();
    let squeeze = squeeze(duration);
    let attack = attack * rng.range(0.88, 1.15) * squeeze;
    let release = release * rng.range(0.9, 1.15) * squeeze;
    let start = (0.45 + rng.range(-0.06, 0.12)) * squeeze;
    let end = duration - 0.42 * squeeze;
    Envelope { start, attack, release_at: (end - release).max(start + attack), release }
}

fn courses(
    shape_names: &[String],
    clip: &Clip,
    strength: f64,
    whole: &Envelope,
    duration: f64,
    rng: &mut Rng,
) -> Vec<Course> {
    // One side leads by a few hundredths of a second and is a little stronger (Schmidt, Liu & Cohn
    // 2006 measured such delays in smiles).
    let squeeze = squeeze(duration);
    let lead = rng.range(0.008, 0.030) * squeeze;
    let left_leads = rng.unit() < 0.6;
    let uneven = rng.range(0.01, 0.04);
    let mut courses = Vec::new();
    for &(stem, weight) in clip.emotion.recipe() {
        let late = rng.range(-0.02, 0.05) * squeeze;
        let slower = rng.range(0.92, 1.1);
        let own = rng.range(0.94, 1.06);
        let drift = [rng.range(0.005, 0.03), rng.range(0.5, 1.1), rng.unit()];
        for (shape, name) in shape_names.iter().enumerate() {
            let side = match name.strip_prefix(stem) {
                Some("") => 0,
                Some("Left") => 1,
                Some("Right") => -1,
                _ => continue,
            };
            let leads = side == 0 || (side > 0) == left_leads;
            let delay = if leads { 0.0 } else { lead };
            let weight = weight * strength * own * if leads { 1.0 } else { 1.0 - uneven };
            let envelope = Envelope {
                start: whole.start + late + delay,
                attack: whole.attack * slower,
                release_at: whole.release_at + late + delay,
                release: whole.release,
            };
            courses.push(Course { shape, weight: weight.min(1.0), envelope, drift });
        }
    }
    courses
}

/// Starts of the blinks: often one as the face relaxes, sometimes one in the apex, never in the
/// neutral frames at either end.
fn blinks(clip: &Clip, whole: &Envelope, duration: f64, rng: &mut Rng) -> Vec<f64> {
    let mut starts = Vec::new();
    let startled = matches!(clip.emotion, Emotion::Fear | Emotion::Surprise);
    let apex = whole.release_at - (whole.start + whole.attack);
    if apex > 1.0 && rng.unit() < if startled { 0.2 } else { 0.5 } {
        starts.push(whole.start + whole.attack + apex * rng.range(0.35, 0.7));
    }
    if rng.unit() < 0.75 {
        starts.push(whole.release_at + whole.release * rng.range(0.2, 0.55));
    }
    starts.retain(|s| s + 0.3 < duration - 0.1);
    starts
}

/// Fixations with quick jumps between them; straight ahead at both ends.
struct Gaze {
    /// Time of each jump and where it leads (right-left, down-up), in look-shape weights.
    jumps: Vec<(f64, f64, f64)>,
}

impl Gaze {
    fn new(clip: &Clip, whole: &Envelope, duration: f64, rng: &mut Rng) -> Gaze {
        let calm = if clip.emotion == Emotion::Fear { 1.6 } else { 1.0 };
        let mut jumps = Vec::new();
        let mut t = whole.start + rng.range(0.1, 0.5);
        let last = (duration - 0.6).min(whole.release_at + 0.5 * whole.release);
        while t < last {
            jumps.push((t, 0.045 * calm * rng.trait_value(), 0.03 * calm * rng.trait_value()));
            t += rng.range(0.35, 1.1) / calm;
        }
        jumps.push((last.max(0.0), 0.0, 0.0));
        Gaze { jumps }
    }

    fn at(&self, t: f64) -> (f64, f64) {
        let mut here = (0.0, 0.0);
        for &(start, x, y) in &self.jumps {
            // A saccade of this size takes some 40 ms.
            let f = rise(t - start, 0.04);
            here = (here.0 + (x - here.0) * f, here.1 + (y - here.1) * f);
        }
        here
    }
}

/// Look shapes with the direction (to the person's left, up) that each serves.
fn look_axes(find: &dyn Fn(&str) -> Option<usize>) -> Vec<(usize, f64, f64)> {
    [
        ("eyeLookOutLeft", 1.0, 0.0),
        ("eyeLookInLeft", -1.0, 0.0),
        ("eyeLookInRight", 1.0, 0.0),
        ("eyeLookOutRight", -1.0, 0.0),
        ("eyeLookUpLeft", 0.0, 1.0),
        ("eyeLookUpRight", 0.0, 1.0),
        ("eyeLookDownLeft", 0.0, -1.0),
        ("eyeLookDownRight", 0.0, -1.0),
    ]
    .into_iter()
    .filter_map(|(name, x, y)| Some((find(name)?, x, y)))
    .collect()
}

/// Shapes about the eyes that a blink takes the lids from.
fn yielding_to_blinks(find: &dyn Fn(&str) -> Option<usize>) -> Vec<usize> {
    ["eyeWide", "eyeSquint", "eyeLookDown", "cheekSquint"]
        .iter()
        .flat_map(|s| [find(&format!("{s}Left")), find(&format!("{s}Right"))])
        .flatten()
        .collect()
}

/// Slow sway of the head, and the movement that belongs to the emotion.
struct Sway {
    /// For each of three turns and three shifts: amplitude, rate (Hz), phase, twice.
    waves: [[[f64; 3]; 2]; 6],
    apex: [f64; 6],
    envelope: Envelope,
    duration: f64,
}

impl Sway {
    fn new(clip: &Clip, strength: f64, whole: &Envelope, duration: f64, rng: &mut Rng) -> Sway {
        let waves = [0.012, 0.014, 0.008, 1.2, 1.0, 1.4].map(|size: f64| {
            [(0.15, 0.45, 1.0), (0.5, 1.2, 0.3)].map(|(low, high, share)| {
                [size * share * rng.range(0.5, 1.0), rng.range(low, high), rng.unit()]
            })
        });
        let (degrees, lean) = clip.emotion.head();
        let side = if rng.unit() < 0.5 { 1.0 } else { -1.0 };
        let size = strength * rng.range(0.7, 1.2);
        let turn = |k: usize| degrees[k].to_radians() * size;
        let apex = [turn(0), side * turn(1), side * turn(2), 0.0, 0.0, lean * size];
        // The head starts a little after the face and moves more slowly.
        let envelope = Envelope {
            start: whole.start + 0.06,
            attack: whole.attack * 1.5,
            release_at: whole.release_at,
            release: whole.release * 1.15,
        };
        Sway { waves, apex, envelope, duration }
    }

    fn at(&self, t: f64) -> HeadPose {
        // At rest at both ends, so that clips join without a jump.
        let inside = rise(t, 0.8) * (1.0 - rise(t - (self.duration - 0.8), 0.8));
        let level = self.envelope.at(t);
        let value = |k: usize| {
            let waves = self.waves[k]
                .iter()
                .map(|[size, rate, phase]| size * libm::sin(TAU * (rate * t + phase)))
                .sum::<f64>();
            waves * inside + self.apex[k] * level
        };
        HeadPose {
            rotation: [value(0), value(1), value(2)],
            translation: [value(3), value(4), value(5)],
        }
    }
}
