//! How coarsely a clip's weights may be stored: in steps, one per shape, with which no vertex of any
//! frame is further than a hundredth of a millimetre from where the exact weights put it.

use mimique_avatar::Avatar;
use mimique_clip::stored_step;

/// Most that a vertex may be off, metres.
const TOLERANCE_M: f64 = 1e-5;
/// Steps are no coarser, however little a shape moves, and no finer.
const COARSEST: f64 = 1e-3;
const FINEST: f64 = 1e-7;
/// How far below the tolerance a try aims: the error is about in proportion to the steps.
const AIM: f64 = 0.95;

/// Steps of weights.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightSteps {
    /// One per shape, as a take pack stores it.
    pub steps: Vec<f64>,
    /// The largest distance in metres, over all vertices and frames, between a vertex posed by the
    /// exact weights and by the rounded ones.
    pub error_m: f64,
}

/// Steps about as coarse as these weights allow: frame-major, `count` per frame, those of the avatar's first shapes. Each
/// shape's step is in inverse proportion to the farthest that it moves a vertex.
pub fn weight_steps(avatar: &Avatar, weights: &[f64], count: usize) -> WeightSteps {
    let reach: Vec<f64> = (0..count).map(|k| reach(avatar, k)).collect();
    let mut size = 4.0 * TOLERANCE_M;
    loop {
        let step = |r: &f64| if *r > 0.0 { (size / r).clamp(FINEST, COARSEST) } else { COARSEST };
        let steps: Vec<f64> = reach.iter().map(step).map(stored_step).collect();
        let error_m = error(avatar, weights, &steps);
        if error_m <= TOLERANCE_M || steps.iter().all(|s| *s <= FINEST) {
            return WeightSteps { steps, error_m };
        }
        size *= AIM * (TOLERANCE_M / error_m).min(1.0);
    }
}

/// The farthest that a shape moves a vertex at weight 1, metres.
fn reach(avatar: &Avatar, shape: usize) -> f64 {
    let skin = avatar.meshes.iter().filter_map(|m| m.shapes.get(shape));
    let moved = skin.flat_map(|s| &s.deltas).map(|d| length(*d)).fold(0.0, f64::max);
    let looks = avatar.eyeballs.iter().flat_map(|eye| {
        let radius = ball_radius(avatar, eye.mesh, eye.centre);
        eye.looks
            .iter()
            .filter(move |l| l.shape == shape)
            .map(move |l| f64::from(l.radians) * radius)
    });
    looks.fold(moved, |most, x| most.max(x.abs()))
}

/// The farthest vertex of an eyeball from its centre, metres.
fn ball_radius(avatar: &Avatar, mesh: usize, centre: [f32; 3]) -> f64 {
    let positions = avatar.meshes.get(mesh).map_or(&[][..], |m| &m.positions);
    positions
        .iter()
        .map(|p| length([p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]]))
        .fold(0.0, f64::max)
}

/// The farthest that rounding moves a vertex of a frame; an eyeball's by its angle times its radius.
fn error(avatar: &Avatar, weights: &[f64], steps: &[f64]) -> f64 {
    let mut worst = 0f64;
    for frame in weights.chunks_exact(steps.len().max(1)) {
        let off: Vec<f64> = frame.iter().zip(steps).map(|(w, s)| (w / s).round() * s - w).collect();
        for mesh in &avatar.meshes {
            let mut moved = vec![[0f64; 3]; mesh.positions.len()];
            for (shape, off) in mesh.shapes.iter().zip(&off).filter(|(_, off)| **off != 0.0) {
                for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                    let to = &mut moved[v as usize];
                    (0..3).for_each(|a| to[a] += off * f64::from(d[a]));
                }
            }
            let square = moved.iter().map(|m| m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
            worst = worst.max(square.fold(0.0, f64::max).sqrt());
        }
        for eye in &avatar.eyeballs {
            let angle = eye.looks.iter().fold([0f64; 3], |sum, look| {
                let turn = off.get(look.shape).unwrap_or(&0.0) * f64::from(look.radians);
                std::array::from_fn(|a| sum[a] + turn * f64::from(look.axis[a]))
            });
            let size = (angle[0] * angle[0] + angle[1] * angle[1] + angle[2] * angle[2]).sqrt();
            worst = worst.max(size * ball_radius(avatar, eye.mesh, eye.centre));
        }
    }
    worst
}

fn length(d: [f32; 3]) -> f64 {
    d.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt()
}
