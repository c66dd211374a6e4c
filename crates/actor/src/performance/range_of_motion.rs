//! A range of motion: what an actor does before a session so that a method can learn the face
//! (thesis 3.4.2): every shape by itself, then grimaces of several together.

use super::envelope::rise;
use super::weights::{HeadPose, Performance};
use crate::head::rng::Rng;

/// Seconds from rest to rest of a shape by itself, and of a grimace.
const SHAPE_S: f64 = 0.6;
const GRIMACE_S: f64 = 0.9;
/// Grimaces: with the shapes by themselves they make the one and a half to two minutes of the
/// thesis.
const GRIMACES: usize = 80;

/// Weights of a range of motion on an avatar's blendshapes: each alone to its full weight, the two
/// sides of a pair in turn, then grimaces of three to nine shapes, both sides of a pair alike. The
/// head does not move.
pub fn range_of_motion(shape_names: &[String], seed: u64, rate_hz: f64) -> Performance {
    let mut rng = Rng::new(seed ^ 0x726f_6d5f_6661_6365);
    let n = shape_names.len();
    let (weights, head) = (Vec::new(), Vec::new());
    let mut out = Performance { rate_hz, shapes: n, weights, head, phases: None };
    let mut play = |peak: &[(usize, f64)], seconds: f64| {
        let frames = (seconds * rate_hz).round().max(2.0) as usize;
        for f in 0..frames {
            let t = f as f64 / frames as f64;
            let level = rise(t, 0.5) * (1.0 - rise(t - 0.5, 0.5));
            let start = out.weights.len();
            out.weights.resize(start + n, 0.0);
            for &(shape, weight) in peak {
                out.weights[start + shape] = weight * level;
            }
            out.head.push(HeadPose::default());
        }
    };
    for shape in 0..n {
        play(&[(shape, 1.0)], SHAPE_S);
    }
    for _ in 0..GRIMACES {
        let count = 3 + (7.0 * rng.unit()) as usize;
        let mut peak: Vec<(usize, f64)> = Vec::new();
        for _ in 0..count.min(n) {
            let shape = ((n as f64 * rng.unit()) as usize).min(n - 1);
            let weight = rng.range(0.2, 1.0);
            let other = twin(shape_names, shape);
            for shape in [Some(shape), other].into_iter().flatten() {
                if !peak.iter().any(|(there, _)| *there == shape) {
                    peak.push((shape, weight));
                }
            }
        }
        play(&peak, GRIMACE_S);
    }
    out
}

/// The same shape on the other side.
fn twin(names: &[String], shape: usize) -> Option<usize> {
    let name = &names[shape];
    let other = match (name.strip_suffix("Left"), name.strip_suffix("Right")) {
        (Some("jaw" | "mouth"), _) | (_, Some("jaw" | "mouth")) => return None,
        (Some(stem), _) => format!("{stem}Right"),
        (_, Some(stem)) => format!("{stem}Left"),
        _ => return None,
    };
    names.iter().position(|name| *name == other)
}
