//! A layout tried before anybody wears it: takes are simulated (sensor noise, markers put beside their places,
//! other people), go through the real front end and the real solver, and what comes out is held against what
//! was played.
//!
//! Every draw has a stream of its own purpose, and a marker meant for a vertex is put in the same wrong place
//! in the same take whatever the rest of the layout is: two layouts differ by their places alone.

mod bank_solver;
mod person;
mod put;
mod track;

pub use bank_solver::BankSolver;
pub use person::Person;

use mimique_geometry::{Point, RigidMotion};
use mimique_solver::{
    Adaptation, FrontEnd, FrontEndScratch, Inference, MarkerColumns, Method, MethodSpec, Operators,
    Regression, TrainingOptions,
};
use rayon::prelude::*;
use serde::Serialize;

use crate::error::LayoutError;
use crate::face::Face;
use crate::motion::FaceMotion;
use put::TrianglesAround;
use track::SimulatedTake;

/// What goes wrong in a simulated take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Conditions {
    /// Standard deviation of the sensor's noise, metres.
    pub noise: f64,
    /// Standard deviation of a marker's place along each direction of the skin, metres; 0 puts it exactly.
    pub slip: f64,
    /// Whether every other take is of another person's face.
    pub others: bool,
}

/// How much is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Effort {
    /// Takes: each puts the markers on anew.
    pub takes: usize,
    /// Frames of each.
    pub frames: usize,
}

impl Effort {
    /// What layouts are compared by while they are sought.
    pub const SEARCH: Self = Self { takes: 6, frames: 48 };
    /// What is reported.
    pub const REPORT: Self = Self { takes: 10, frames: 100 };
}

/// Simulated takes of a face, and the method that solves them.
pub struct Rehearsal<'a> {
    face: &'a Face<'a>,
    solver: BankSolver,
    /// Mean over the vertices of B^T B in the motion's basis.
    gram: Vec<f64>,
    width: usize,
    around: TrianglesAround,
    conditions: Conditions,
    seed: u64,
    takes: Vec<SimulatedTake>,
    /// Frames of the range of motion that a regression learns from, of each take.
    training: usize,
}

/// Most frames that a regression learns from in a rehearsal.
const TRAINING_FRAMES: usize = 400;

impl<'a> Rehearsal<'a> {
    /// Of a motion that is played, and for a regression of one that it has learnt from.
    pub fn new(
        face: &'a Face<'a>,
        played: &FaceMotion,
        learnt: Option<&FaceMotion>,
        spec: &MethodSpec,
        conditions: Conditions,
        effort: Effort,
        seed: u64,
    ) -> Self {
        Self::with_solver(face, played, learnt, BankSolver::new(face, spec), conditions, effort, seed)
    }

    /// The same with a solver that is set up already.
    #[allow(clippy::too_many_arguments, reason = "each is another thing that a rehearsal is made of")]
    pub fn with_solver(
        face: &'a Face<'a>,
        played: &FaceMotion,
        learnt: Option<&FaceMotion>,
        solver: BankSolver,
        conditions: Conditions,
        effort: Effort,
        seed: u64,
    ) -> Self {
        let learns = solver.spec().method == Method::Regression;
        let training = if learns { TRAINING_FRAMES } else { 0 };
        let takes = (0..effort.takes)
            .map(|take| {
                let person = match conditions.others && take % 2 == 1 {
                    true => Person::other(seed, take),
                    false => Person::own(),
                };
                let mut frames = track::played_frames(played, effort, take, seed);
                let learnt = learnt.filter(|_| learns).unwrap_or(played);
                let own = Effort { takes: 1, frames: training };
                frames.extend(track::played_frames(learnt, own, 0, seed));
                SimulatedTake::new(person, frames, face.skin.mesh.positions.len())
            })
            .collect();
        let around = TrianglesAround::of(&face.skin.mesh);
        let (gram, width) = (played.gram.clone(), played.width);
        Self { face, solver, gram, width, around, conditions, seed, takes, training }
    }

    /// The solver, to be used again.
    pub fn solver(&self) -> &BankSolver {
        &self.solver
    }

    /// What the solve of each frame leaves: takes x frames x width, coefficients played less weights found.
    ///
    /// # Errors
    /// [`LayoutError`] where the markers cannot be laid on a face, or see no shape.
    pub fn left(&self, motion: &FaceMotion, markers: &[usize]) -> Result<Vec<f64>, LayoutError> {
        let operators = self.solver.operators(self.face, markers)?;
        let one = |(number, take): (usize, &SimulatedTake)| {
            self.left_of_take(motion, &operators, markers, number, take)
        };
        let parts: Vec<Vec<f64>> =
            self.takes.par_iter().enumerate().map(one).collect::<Result<_, LayoutError>>()?;
        Ok(parts.concat())
    }

    fn left_of_take(
        &self,
        motion: &FaceMotion,
        operators: &Operators,
        markers: &[usize],
        number: usize,
        take: &SimulatedTake,
    ) -> Result<Vec<f64>, LayoutError> {
        let n = motion.shape_count;
        let tracks: Vec<&track::Track> = (markers.iter())
            .map(|&v| take.track(v, || self.track(motion, v, number, take)))
            .collect();
        let neutral: Vec<Point> = tracks.iter().map(|track| track.neutral).collect();
        let spec = self.solver.spec();
        let adaptation = Adaptation { depth: None, smoothing: spec.rbf_smoothing() };
        let columns = MarkerColumns { face: (0..markers.len()).collect(), head: None };
        let places = markers.iter().map(|&v| self.face.place(v)).collect();
        let front = FrontEnd::from_parts(columns, Vec::new(), neutral, places, adaptation)?;
        let width = 3 * markers.len();
        let frames = take.frames(self.width);
        let mut displacements = vec![0.0; frames * width];
        let mut scratch = FrontEndScratch::default();
        let mut frame = vec![0.0; width];
        for (f, out) in displacements.chunks_exact_mut(width).enumerate() {
            for (m, track) in tracks.iter().enumerate() {
                frame[3 * m..3 * m + 3].copy_from_slice(&track.positions[3 * f..3 * f + 3]);
            }
            front.displacements(&RigidMotion::IDENTITY, &frame, out, &mut scratch);
        }
        let played = frames - self.training;
        let fit = match spec.method {
            Method::Regression => {
                let learnt = &take.coefficients[played * self.width..];
                let weights: Vec<f64> =
                    learnt.chunks_exact(self.width).flat_map(|row| &row[..n]).copied().collect();
                let options = training_options(spec);
                let inputs = &displacements[played * width..];
                let model = Regression::train(inputs, width, &weights, n, &options)?;
                self.solver.fit(&operators.clone().with_regression(model)?)?
            }
            _ => self.solver.fit(operators)?,
        };
        let solved = fit.solve_take(&displacements[..played * width])?;
        let mut left = take.coefficients[..played * self.width].to_vec();
        for (left, found) in left.chunks_exact_mut(self.width).zip(solved.weights.chunks_exact(n)) {
            left.iter_mut().zip(found).for_each(|(l, w)| *l -= w);
        }
        Ok(left)
    }

    /// Mean square error of a vertex over all frames, square metres.
    ///
    /// # Errors
    /// As [`Self::left`].
    pub fn mean_square(&self, motion: &FaceMotion, markers: &[usize]) -> Result<f64, LayoutError> {
        let left = self.left(motion, markers)?;
        let squares = square_errors(&left, &self.gram, self.width);
        Ok(squares.iter().sum::<f64>() / squares.len().max(1) as f64)
    }

    /// What a marker meant for a vertex measures in a take.
    fn track(&self, motion: &FaceMotion, v: usize, number: usize, take: &SimulatedTake) -> track::Track {
        let Conditions { noise, slip, .. } = self.conditions;
        let site = put::put(self.face, &self.around, v, slip, self.seed, number);
        track::Track::of(self.face, motion, take, &site, (noise, self.seed, number, v))
    }
}

/// c^T G c of each row.
pub fn square_errors(rows: &[f64], gram: &[f64], width: usize) -> Vec<f64> {
    let of = |row: &[f64]| -> f64 {
        let products = gram.chunks_exact(width).map(|g| g.iter().zip(row).map(|(g, x)| g * x).sum());
        products.zip(row).map(|(g, x): (f64, &f64)| g * x).sum()
    };
    rows.chunks_exact(width).map(of).collect()
}

fn training_options(spec: &MethodSpec) -> TrainingOptions {
    let sparse = spec.inference() == Inference::Sparse;
    TrainingOptions {
        capacity: sparse.then_some(spec.basis_vectors() as usize),
        given: [spec.length_scale, spec.signal, spec.noise],
    }
}
