//! A layout tried before anybody wears it: takes are simulated (sensor noise, markers put beside their places,
//! other people), go through the real front end and the real solver, and what comes out is held against what
//! was played.
//!
//! Every draw has a stream of its own purpose, and a marker meant for a vertex is put in the same wrong place
//! in the same take whatever the rest of the layout is: two layouts differ by their places alone.

mod bank_solver;
mod person;
mod put;
mod surface;
mod track;

pub use bank_solver::BankSolver;
pub use person::Person;

use std::sync::Arc;

use mimique_geometry::{Point, RigidMotion};
use mimique_solver::{
    Adaptation, Fit, FrontEnd, FrontEndScratch, Inference, MarkerColumns, Method, MethodSpec,
    Operators, Regression, TrainingOptions,
};
use rayon::prelude::*;
use serde::Serialize;

use crate::error::LayoutError;
use crate::face::Face;
use crate::motion::{Basis, FaceMotion};
use put::TrianglesAround;
use surface::{SurfaceGroup, SurfaceSolver};
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

impl Conditions {
    /// Markers put on by hand, as sets and sensors of today have it: noise of 0.1 mm, 1.5 mm beside the place.
    pub const BY_HAND: Self = Self { noise: 1e-4, slip: 1.5e-3, others: true };
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

/// Vertices whose error is told together.
#[derive(Debug, Clone, PartialEq)]
pub struct VertexGroup {
    /// The vertices.
    pub vertices: Vec<usize>,
    /// Mean over them of B^T B in the motion's basis, width x width.
    pub gram: Vec<f64>,
}

impl VertexGroup {
    /// Of some vertices.
    pub fn of(basis: &Basis, vertices: Vec<usize>) -> Self {
        Self { gram: basis.gram_of(&vertices), vertices }
    }

    /// Of all vertices.
    pub fn whole(basis: &Basis) -> Self {
        Self { gram: basis.gram.clone(), vertices: (0..basis.vertices()).collect() }
    }
}

/// What solves the takes of a layout.
enum LayoutSolver {
    Bank(Box<Fit>),
    /// A regression, which learns in each take anew; its kernel stays.
    Learning(Operators, KernelNumbers),
    Surface(SurfaceSolver, Vec<SurfaceGroup>),
}

/// Length scale, signal and noise of a regression's kernel; none for methods that learn nothing. Finding them
/// takes ten times as long as learning with them, so that they are found once for a layout.
pub type KernelNumbers = Option<[f64; 3]>;

/// Simulated takes of a face, and the method that solves them.
pub struct Rehearsal<'a> {
    face: &'a Face<'a>,
    solver: Arc<BankSolver>,
    basis: Arc<Basis>,
    whole: Vec<VertexGroup>,
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
        let solver = Arc::new(BankSolver::new(face, spec));
        Self::with_solver(face, played, learnt, solver, conditions, effort, seed)
    }

    /// The same with a solver that is set up already.
    #[allow(
        clippy::too_many_arguments,
        reason = "each is another thing that a rehearsal is made of"
    )]
    pub fn with_solver(
        face: &'a Face<'a>,
        played: &FaceMotion,
        learnt: Option<&FaceMotion>,
        solver: Arc<BankSolver>,
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
        let basis = played.basis.clone();
        let whole = vec![VertexGroup::whole(&basis)];
        Self { face, solver, basis, whole, around, conditions, seed, takes, training }
    }

    /// The solver, to be used again.
    pub fn solver(&self) -> &Arc<BankSolver> {
        &self.solver
    }

    /// Mean square errors of groups of vertices: for each group a number for each frame of all takes, square
    /// metres.
    ///
    /// # Errors
    /// [`LayoutError`] where the markers cannot be laid on a face, or see no shape.
    pub fn square_errors(
        &self,
        markers: &[usize],
        groups: &[VertexGroup],
    ) -> Result<Vec<Vec<f64>>, LayoutError> {
        self.square_errors_with(markers, groups, self.kernel(markers)?)
    }

    /// The same with a kernel that was found before.
    ///
    /// # Errors
    /// As [`Self::square_errors`].
    pub fn square_errors_with(
        &self,
        markers: &[usize],
        groups: &[VertexGroup],
        kernel: KernelNumbers,
    ) -> Result<Vec<Vec<f64>>, LayoutError> {
        let solver = self.solver_of(markers, groups, kernel)?;
        let one = |(number, take): (usize, &SimulatedTake)| {
            self.errors_of_take(&solver, markers, groups, number, take)
        };
        let parts: Vec<Vec<Vec<f64>>> =
            self.takes.par_iter().enumerate().map(one).collect::<Result<_, LayoutError>>()?;
        let of_group = |g: usize| parts.iter().flat_map(|take| &take[g]).copied().collect();
        Ok((0..groups.len()).map(of_group).collect())
    }

    /// Mean square error of a vertex over all frames, square metres.
    ///
    /// # Errors
    /// As [`Self::square_errors`].
    pub fn mean_square(&self, markers: &[usize]) -> Result<f64, LayoutError> {
        self.mean_square_with(markers, self.kernel(markers)?)
    }

    /// The same with a kernel that was found before.
    ///
    /// # Errors
    /// As [`Self::square_errors`].
    pub fn mean_square_with(
        &self,
        markers: &[usize],
        kernel: KernelNumbers,
    ) -> Result<f64, LayoutError> {
        let squares = self.square_errors_with(markers, &self.whole, kernel)?;
        Ok(squares[0].iter().sum::<f64>() / squares[0].len().max(1) as f64)
    }

    /// The kernel that a regression finds for a layout in the first take.
    ///
    /// # Errors
    /// [`LayoutError::Training`].
    pub fn kernel(&self, markers: &[usize]) -> Result<KernelNumbers, LayoutError> {
        let Some(take) = self.takes.first().filter(|_| self.training > 0) else { return Ok(None) };
        let displacements = self.displacements(markers, 0, take)?;
        let played = take.frames(self.basis.width) - self.training;
        let learnt = &displacements[played * 3 * markers.len()..];
        let given = training_options(self.solver.spec()).given;
        let kernel = self.learn(markers, take, learnt, given)?.kernel;
        Ok(Some([kernel.length, kernel.signal, kernel.noise]))
    }

    /// Learns from the last frames of a take.
    fn learn(
        &self,
        markers: &[usize],
        take: &SimulatedTake,
        inputs: &[f64],
        given: [Option<f64>; 3],
    ) -> Result<Regression, LayoutError> {
        let (n, w) = (self.basis.shape_count, self.basis.width);
        let frames = &take.coefficients[(take.frames(w) - self.training) * w..];
        let outputs: Vec<f64> = frames.chunks_exact(w).flat_map(|row| &row[..n]).copied().collect();
        let options = TrainingOptions { given, ..training_options(self.solver.spec()) };
        Ok(Regression::train(inputs, 3 * markers.len(), &outputs, n, &options)?)
    }

    /// What all takes share of a layout.
    fn solver_of(
        &self,
        markers: &[usize],
        groups: &[VertexGroup],
        kernel: KernelNumbers,
    ) -> Result<LayoutSolver, LayoutError> {
        if self.solver.spec().method == Method::ThinShellSurface {
            let surface = SurfaceSolver::new(self.face, self.solver.spec(), markers)?;
            let groups = groups.iter().map(|group| surface.group(&self.basis, group)).collect();
            return Ok(LayoutSolver::Surface(surface, groups));
        }
        let operators = self.solver.operators(self.face, markers)?;
        if self.solver.spec().method == Method::Regression {
            return Ok(LayoutSolver::Learning(operators, kernel));
        }
        Ok(LayoutSolver::Bank(Box::new(self.solver.fit(&operators)?)))
    }

    fn errors_of_take(
        &self,
        solver: &LayoutSolver,
        markers: &[usize],
        groups: &[VertexGroup],
        number: usize,
        take: &SimulatedTake,
    ) -> Result<Vec<Vec<f64>>, LayoutError> {
        let (n, w) = (self.basis.shape_count, self.basis.width);
        let displacements = self.displacements(markers, number, take)?;
        let width = 3 * markers.len();
        let played = take.frames(w) - self.training;
        let (seen, learnt) = displacements.split_at(played * width);
        let frames = &take.coefficients[..played * w];
        let weights = match solver {
            LayoutSolver::Surface(surface, groups) => {
                let moved = surface.solve(seen)?;
                let pairs = || moved.chunks_exact(width).zip(frames.chunks_exact(w));
                let of_group = |group: &SurfaceGroup| {
                    pairs().map(|(moved, played)| group.square_error(moved, played)).collect()
                };
                return Ok(groups.iter().map(of_group).collect());
            }
            LayoutSolver::Bank(fit) => fit.solve_take(seen)?.weights,
            LayoutSolver::Learning(operators, kernel) => {
                let given = kernel.map_or([None; 3], |kernel| kernel.map(Some));
                let model = self.learn(markers, take, learnt, given)?;
                let operators = operators.clone().with_regression(model)?;
                self.solver.fit(&operators)?.solve_take(seen)?.weights
            }
        };
        let mut left = frames.to_vec();
        for (left, found) in left.chunks_exact_mut(w).zip(weights.chunks_exact(n)) {
            left.iter_mut().zip(found).for_each(|(l, found)| *l -= found);
        }
        Ok(groups.iter().map(|group| quadratic_forms(&left, &group.gram, w)).collect())
    }

    /// Where the markers of a take ask the avatar's skin to go, frames x 3P, metres.
    fn displacements(
        &self,
        markers: &[usize],
        number: usize,
        take: &SimulatedTake,
    ) -> Result<Vec<f64>, LayoutError> {
        let tracks: Vec<&track::Track> =
            (markers.iter()).map(|&v| take.track(v, || self.track(v, number, take))).collect();
        let neutral: Vec<Point> = tracks.iter().map(|track| track.neutral).collect();
        let smoothing = self.solver.spec().rbf_smoothing();
        let adaptation = Adaptation { depth: None, smoothing };
        let columns = MarkerColumns { face: (0..markers.len()).collect(), head: None };
        let places = markers.iter().map(|&v| self.face.place(v)).collect();
        let front = FrontEnd::from_parts(columns, Vec::new(), neutral, places, adaptation)?;
        let width = 3 * markers.len();
        let mut displacements = vec![0.0; take.frames(self.basis.width) * width];
        let mut scratch = FrontEndScratch::default();
        let mut frame = vec![0.0; width];
        for (f, out) in displacements.chunks_exact_mut(width).enumerate() {
            for (place, track) in frame.chunks_exact_mut(3).zip(&tracks) {
                place.copy_from_slice(&track.positions[3 * f..3 * f + 3]);
            }
            front.displacements(&RigidMotion::IDENTITY, &frame, out, &mut scratch);
        }
        Ok(displacements)
    }

    /// What a marker meant for a vertex measures in a take.
    fn track(&self, v: usize, number: usize, take: &SimulatedTake) -> track::Track {
        let Conditions { noise, slip, .. } = self.conditions;
        let site = put::put(self.face, &self.around, v, slip, self.seed, number);
        track::Track::of(self.face, &self.basis, take, &site, (noise, self.seed, number, v))
    }
}

/// c^T G c of each row.
fn quadratic_forms(rows: &[f64], gram: &[f64], width: usize) -> Vec<f64> {
    let of = |row: &[f64]| -> f64 {
        let products =
            gram.chunks_exact(width).map(|g| g.iter().zip(row).map(|(g, x)| g * x).sum());
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
