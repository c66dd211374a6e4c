//! The motion that a layout is made for: weights of the avatar's shapes, or its surface itself, of one person
//! or several.
//!
//! Everything but K-means works in one linear basis: the shapes, and behind them what dense takes have that no
//! shape has. A frame is a row of coefficients in it: the weights, then the amounts of the rest.

mod dense;
mod moments;

pub use dense::{DenseTake, DenseTakeError};

use std::sync::Arc;

use mimique_geometry::Displacement;
use mimique_solver::{TrajectoryRows, VertexTrajectories, WeightMotion};
use serde::Serialize;

use crate::face::Face;
use moments::{covariance, second_moment};

/// Standard deviation of a weight where no motion is known.
pub const INDEPENDENT_DEVIATION: f64 = 0.25;
/// Standard deviation of the weight of a shape that no allowed place sees.
pub const UNSEEN_DEVIATION: f64 = 0.02;
/// Frames of a dense take whose trajectories are clustered: evenly spaced ones.
const CLUSTERED_FRAMES: usize = 300;

/// What one person did.
#[derive(Debug, Clone, PartialEq)]
pub struct Take {
    /// The file's name, or another.
    pub name: String,
    /// Frames per second, where it is known.
    pub rate_hz: Option<f64>,
    /// What moved.
    pub content: TakeContent,
}

/// Weights or surface.
#[derive(Debug, Clone, PartialEq)]
pub enum TakeContent {
    /// Frames x N weights of the avatar's shapes, in its order.
    Weights(Vec<f64>),
    /// The skin's vertices.
    Dense(DenseTake),
}

/// Where the motion is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum MotionSource {
    /// Takes.
    Takes,
    /// Nothing is known: every shape by itself, standard deviation 0.25.
    IndependentShapes,
}

/// What faces are made of: the shapes, then what dense takes have beside them.
#[derive(Debug, Clone, PartialEq)]
pub struct Basis {
    /// Vertices x 3 x width, metres. The first N columns are the shapes.
    pub deltas: Vec<f64>,
    /// Columns.
    pub width: usize,
    /// N.
    pub shape_count: usize,
    /// Mean over the vertices of B^T B, width x width, square metres.
    pub gram: Vec<f64>,
}

/// The motion of some people in one basis.
#[derive(Debug, Clone)]
pub struct FaceMotion {
    /// The basis.
    pub basis: Arc<Basis>,
    /// Where it is from.
    pub source: MotionSource,
    /// The people, in order.
    pub people: Vec<PersonMotion>,
    /// Shapes that rest: their motion is left out, since nothing is to be told of it.
    pub rested: Vec<usize>,
}

/// One person's frames in the basis.
#[derive(Debug, Clone)]
pub struct PersonMotion {
    /// The take's name.
    pub name: String,
    /// Frames per second, where it is known.
    pub rate_hz: Option<f64>,
    /// Frames x width.
    pub frames: Vec<f64>,
    /// Positions that K-means clusters, frames x vertices x 3, metres, of a dense take.
    clustered: Option<Vec<f64>>,
}

impl FaceMotion {
    /// Of takes; of independent shapes where there is none. `rested` are shapes whose motion is left out.
    ///
    /// # Errors
    /// [`DenseTakeError`] for a take of another topology.
    pub fn of(face: &Face<'_>, takes: &[Take], rested: &[usize]) -> Result<Self, DenseTakeError> {
        let n = face.shape_count();
        let mut dense: Vec<(usize, dense::InBank)> = Vec::new();
        let bank = dense::Bank::of(face);
        for (place, take) in takes.iter().enumerate() {
            if let TakeContent::Dense(vertices) = &take.content {
                dense.push((place, bank.project(face, vertices, &take.name)?));
            }
        }
        let modes = dense::modes(dense.iter().map(|(_, of)| of), face.skin.mesh.positions.len());
        let width = n + modes.count;
        let deltas = modes.beside(&face.deltas, n);
        let mut people: Vec<PersonMotion> = Vec::new();
        for (place, take) in takes.iter().enumerate() {
            let own = dense.iter().find(|(of, _)| *of == place).map(|(_, of)| of);
            let (mut frames, clustered) = match (&take.content, own) {
                (TakeContent::Weights(weights), _) => (modes.widened(weights, n), None),
                (TakeContent::Dense(_), Some(own)) => {
                    (modes.coefficients(own, n), Some(own.clustered(CLUSTERED_FRAMES)))
                }
                (TakeContent::Dense(_), None) => continue,
            };
            for row in frames.chunks_exact_mut(width) {
                rested.iter().for_each(|&k| row[k] = 0.0);
            }
            let (name, rate_hz) = (take.name.clone(), take.rate_hz);
            people.push(PersonMotion { name, rate_hz, frames, clustered });
        }
        let source = match people.is_empty() {
            true => MotionSource::IndependentShapes,
            false => MotionSource::Takes,
        };
        let basis = Arc::new(Basis::new(deltas, width, n));
        Ok(Self { basis, source, people, rested: rested.to_vec() })
    }

    /// The same with other people.
    pub fn with_people(&self, people: Vec<PersonMotion>) -> Self {
        Self { people, ..self.clone() }
    }

    /// All frames of all people.
    pub fn frames(&self) -> impl Iterator<Item = &[f64]> {
        self.people.iter().flat_map(|person| person.frames.chunks_exact(self.basis.width))
    }

    /// Frames that show how far the face goes: `evenly` spread over the takes, and those in which each shape
    /// is largest; each shape half way by itself where no motion is known.
    pub fn telling_frames(&self, evenly: usize) -> Vec<Vec<f64>> {
        let all: Vec<&[f64]> = self.frames().collect();
        if all.is_empty() {
            let moved = (0..self.basis.shape_count).filter(|k| !self.rested.contains(k));
            let alone = |k: usize| {
                let mut frame = vec![0.0; self.basis.width];
                frame[k] = 0.5;
                frame
            };
            return moved.map(alone).collect();
        }
        let count = evenly.min(all.len());
        let mut chosen: Vec<usize> = (0..count).map(|i| i * all.len() / count).collect();
        for k in 0..self.basis.width {
            let largest = (0..all.len())
                .max_by(|&a, &b| all[a][k].abs().total_cmp(&all[b][k].abs()).then(b.cmp(&a)));
            chosen.extend(largest.filter(|&frame| all[frame][k] != 0.0));
        }
        chosen.sort_unstable();
        chosen.dedup();
        chosen.into_iter().map(|frame| all[frame].to_vec()).collect()
    }

    /// The prior of the greedy choice: half the covariance of the motion, half independent weights with a
    /// standard deviation of 0.25 (a range of motion played more on one side gives layouts of one side);
    /// independent weights alone where no motion is known. Width x width.
    pub fn prior(&self) -> Vec<f64> {
        let w = self.basis.width;
        let mut prior = vec![0.0; w * w];
        let share = if self.people.is_empty() { 0.0 } else { 0.5 / self.people.len() as f64 };
        for person in &self.people {
            let own = covariance(&person.frames, w);
            prior.iter_mut().zip(&own).for_each(|(p, c)| *p += share * c);
        }
        let rest = if self.people.is_empty() { 1.0 } else { 0.5 };
        for k in 0..self.basis.shape_count {
            let rests = self.rested.contains(&k);
            let deviation = if rests { UNSEEN_DEVIATION } else { INDEPENDENT_DEVIATION };
            prior[k * w + k] += rest * deviation * deviation;
        }
        prior
    }

    /// E\[cc^T\] of the motion, width x width: what a marker beside its place is moved wrongly by.
    pub fn second_moment(&self) -> Vec<f64> {
        if self.people.is_empty() {
            return self.prior();
        }
        let w = self.basis.width;
        let mut out = vec![0.0; w * w];
        for person in &self.people {
            let own = second_moment(&person.frames, w);
            let people = self.people.len() as f64;
            out.iter_mut().zip(&own).for_each(|(p, c)| *p += c / people);
        }
        out
    }

    /// The rows that vertices are clustered by (eq. 3.6), person after person.
    pub fn rows(&self, vertices: &[usize]) -> TrajectoryRows {
        let w = self.basis.width;
        if self.people.is_empty() {
            let motion = WeightMotion { frames: 1, covariance: self.prior() };
            return TrajectoryRows::of_bank(&self.basis.at(vertices), w, &[motion]);
        }
        let mut rows: Option<TrajectoryRows> = None;
        for person in &self.people {
            let own = match &person.clustered {
                Some(positions) => {
                    let count = self.basis.vertices();
                    let take = VertexTrajectories { vertices: count, positions };
                    TrajectoryRows::of_trajectories(&[take], vertices)
                }
                None => {
                    let frames = person.frames.len() / w;
                    let motion = WeightMotion { frames, covariance: covariance(&person.frames, w) };
                    TrajectoryRows::of_bank(&self.basis.at(vertices), w, &[motion])
                }
            };
            rows = Some(match rows {
                None => own,
                Some(before) => before.beside(&own),
            });
        }
        rows.unwrap_or(TrajectoryRows { width: 0, values: Vec::new() })
    }

    /// The fastest that any of some vertices goes, metres per second; none where no rate is known.
    pub fn top_speed(&self, vertices: &[usize]) -> Option<f64> {
        let mut top: Option<f64> = None;
        for person in &self.people {
            let Some(rate) = person.rate_hz else { continue };
            let frames: Vec<&[f64]> = person.frames.chunks_exact(self.basis.width).collect();
            for pair in frames.windows(2) {
                let step: Vec<f64> = pair[0].iter().zip(pair[1]).map(|(a, b)| b - a).collect();
                let fastest = vertices
                    .iter()
                    .map(|&v| self.basis.displacement(v, &step).length() * rate)
                    .fold(0.0, f64::max);
                top = Some(top.map_or(fastest, |before| before.max(fastest)));
            }
        }
        top
    }
}

impl PersonMotion {
    /// Some of the frames, with nothing else of the take.
    pub fn part(&self, frames: std::ops::Range<usize>, width: usize) -> Self {
        Self {
            frames: self.frames[frames.start * width..frames.end * width].to_vec(),
            clustered: None,
            ..self.clone()
        }
    }

    /// Two parts of a take, one after the other.
    pub fn and(mut self, other: &Self) -> Self {
        self.frames.extend(&other.frames);
        self
    }
}

impl Basis {
    fn new(deltas: Vec<f64>, width: usize, shape_count: usize) -> Self {
        let gram = mean_products(&deltas, width);
        Self { deltas, width, shape_count, gram }
    }

    /// The number of vertices.
    pub fn vertices(&self) -> usize {
        self.deltas.len() / (3 * self.width).max(1)
    }

    /// The rows of a vertex: 3 x width, metres.
    pub fn of(&self, vertex: usize) -> &[f64] {
        &self.deltas[vertex * 3 * self.width..(vertex + 1) * 3 * self.width]
    }

    /// The rows of some vertices.
    pub fn at(&self, vertices: &[usize]) -> Vec<f64> {
        vertices.iter().flat_map(|&v| self.of(v)).copied().collect()
    }

    /// Mean over some vertices of B^T B, width x width.
    pub fn gram_of(&self, vertices: &[usize]) -> Vec<f64> {
        mean_products(&self.at(vertices), self.width)
    }

    /// Where a vertex goes in a frame.
    pub fn displacement(&self, vertex: usize, frame: &[f64]) -> Displacement {
        let along = |axis: usize| -> f64 {
            let row = &self.of(vertex)[axis * self.width..(axis + 1) * self.width];
            row.iter().zip(frame).map(|(d, c)| d * c).sum()
        };
        Displacement::new(along(0), along(1), along(2))
    }
}

/// Mean over the vertices of B^T B.
fn mean_products(deltas: &[f64], width: usize) -> Vec<f64> {
    let vertices = (deltas.len() / (3 * width).max(1)).max(1) as f64;
    let mut gram = moments::products(deltas, width);
    gram.iter_mut().for_each(|g| *g /= vertices);
    gram
}
