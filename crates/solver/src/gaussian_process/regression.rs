//! `regression`: weights learnt from a range-of-motion take whose weights are known (thesis 3.3.1),
//! by a Gaussian process, exact or sparse.
//!
//! Inputs are the displacements d of the marker vertices (as every method gets them, so that actors
//! and units do not matter), centred and scaled by mean and standard deviation of the training take
//! (thesis 3.4.3, [`InputScale`]).

use crate::gaussian_process::exact::{ExactProcess, Kernel, posterior};
use crate::gaussian_process::hyper_parameters::maximise_likelihood;
use crate::gaussian_process::input_scale::{InputScale, standardise};
use crate::gaussian_process::sparse::SparseProcess;
use crate::linear_algebra::cholesky::Cholesky;
use crate::linear_algebra::dense::{axpy, mul};

/// Frames that the hyper-parameters are found on: evenly spaced ones.
const EVIDENCE_FRAMES: usize = 160;
/// Fewest frames that anything is learnt from.
pub const LEAST_TRAINING_FRAMES: usize = 30;
/// Most frames of the exact process: its set-up is cubic.
pub const MOST_EXACT_FRAMES: usize = 2500;
/// A frame is far from the training data where more than this part of the variance is left.
const FAR: f64 = 0.5;
/// Ridge on the covariance of the inputs (which have variances near 1) that fills lost markers in.
const FILL_RIDGE: f64 = 1e-2;

/// How to learn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrainingOptions {
    /// Number of basis vectors of the sparse process; none = the exact process.
    pub capacity: Option<usize>,
    /// Length scale, signal and noise where they are not to be found by the marginal likelihood.
    pub given: [Option<f64>; 3],
}

/// What was learnt, as plain data: what is stored and sent.
#[derive(Debug, Clone, PartialEq)]
pub struct Regression {
    /// Mean of the training displacements, D = 3P numbers, metres.
    pub centre: Vec<f64>,
    /// Scale of each, metres.
    pub scale: Vec<f64>,
    /// The kernel over centred and scaled displacements.
    pub kernel: Kernel,
    /// Number of outputs N.
    pub shape_count: usize,
    /// Basis vectors, m x D, centred and scaled.
    pub basis: Vec<f64>,
    /// m x N.
    pub coefficients: Vec<f64>,
    /// m x m.
    pub covariance: Vec<f64>,
    /// Frames learnt from.
    pub training_frames: usize,
    /// Logarithm of the marginal likelihood of the frames that the kernel was found on.
    pub log_likelihood: f64,
}

/// Why nothing can be learnt.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrainingError {
    /// Sizes disagree.
    #[error(
        "training: {inputs} frames of markers, {outputs} of weights; give one row of weights per frame"
    )]
    Frames {
        /// Frames of markers.
        inputs: usize,
        /// Rows of weights.
        outputs: usize,
    },
    /// Too few frames.
    #[error(
        "training: {0} frames in which every marker is seen; give {LEAST_TRAINING_FRAMES} or more, \
         over the whole range of motion"
    )]
    TooShort(usize),
    /// Too many for the exact process.
    #[error(
        "training: {0} frames are too many for the exact process ({MOST_EXACT_FRAMES} at most); \
         take the sparse one (inference sparse), or a shorter take"
    )]
    TooLong(usize),
    /// Nothing happens in the take.
    #[error("training: {0} never change; record a take in which every shape is used")]
    Still(&'static str),
    /// Stored numbers do not fit together.
    #[error("regression model: {0}; train it again")]
    Malformed(String),
    /// The Gram matrix cannot be factored.
    #[error(
        "training: the Gram matrix is singular to rounding with noise {0}; give a larger noise"
    )]
    Singular(f64),
}

/// The frames in which every number of input and output is finite. Each argument: the numbers, frame by
/// frame, and how many a frame has.
fn whole_frames(
    (inputs, width): (&[f64], usize),
    (outputs, shape_count): (&[f64], usize),
) -> (Vec<f64>, Vec<f64>) {
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (d, c) in inputs.chunks_exact(width).zip(outputs.chunks_exact(shape_count)) {
        if d.iter().chain(c).all(|v| v.is_finite()) {
            x.extend_from_slice(d);
            y.extend_from_slice(c);
        }
    }
    (x, y)
}

/// What a process has learnt: its basis vectors, and the posterior over them.
struct Learnt {
    basis: Vec<f64>,
    coefficients: Vec<f64>,
    covariance: Vec<f64>,
}

impl Learnt {
    /// Learns from standardised inputs and outputs, exactly or on at most `capacity` basis vectors.
    ///
    /// # Errors
    /// [`TrainingError::Singular`] where the Gram matrix cannot be factored.
    fn of(
        (x, width): (&[f64], usize),
        (y, shape_count): (&[f64], usize),
        kernel: Kernel,
        capacity: Option<usize>,
    ) -> Result<Learnt, TrainingError> {
        let Some(capacity) = capacity else {
            let ExactProcess { coefficients, covariance } =
                ExactProcess::fit(x, width, y, shape_count, &kernel)
                    .ok_or(TrainingError::Singular(kernel.noise))?;
            return Ok(Learnt { basis: x.to_vec(), coefficients, covariance });
        };
        let mut sparse = SparseProcess::new(kernel, width, shape_count, capacity);
        for frame in scattered(x.len() / width) {
            sparse.learn(
                &x[frame * width..(frame + 1) * width],
                &y[frame * shape_count..(frame + 1) * shape_count],
            );
        }
        Ok(Learnt {
            basis: sparse.basis().to_vec(),
            coefficients: sparse.coefficients().to_vec(),
            covariance: sparse.covariance().to_vec(),
        })
    }
}

impl Regression {
    /// Learn from `inputs` (frames x `width` displacements, metres; frames with a NaN are left out)
    /// and `outputs` (frames x `shape_count` weights).
    ///
    /// The same data gives the same bits. The sparse process sees the frames in an order that soon
    /// covers the whole take, whatever its length.
    ///
    /// # Errors
    /// [`TrainingError`].
    pub fn train(
        inputs: &[f64],
        width: usize,
        outputs: &[f64],
        shape_count: usize,
        options: &TrainingOptions,
    ) -> Result<Regression, TrainingError> {
        let frames = inputs.len() / width.max(1);
        let rows = outputs.len() / shape_count.max(1);
        if frames != rows || width == 0 || shape_count == 0 {
            return Err(TrainingError::Frames { inputs: frames, outputs: rows });
        }
        let (mut x, y) = whole_frames((inputs, width), (outputs, shape_count));
        let n = x.len() / width;
        if n < LEAST_TRAINING_FRAMES {
            return Err(TrainingError::TooShort(n));
        }
        if options.capacity.is_none() && n > MOST_EXACT_FRAMES {
            return Err(TrainingError::TooLong(n));
        }
        let inputs = InputScale::of(&x, width).ok_or(TrainingError::Still("the markers"))?;
        x.chunks_exact_mut(width).for_each(|row| inputs.apply(row));
        let InputScale { centre, scale } = inputs;
        let chosen = evenly(n, EVIDENCE_FRAMES);
        let some = |all: &[f64], width: usize| -> Vec<f64> {
            chosen.iter().flat_map(|&f| all[f * width..(f + 1) * width].iter().copied()).collect()
        };
        let (kernel, log_likelihood) = maximise_likelihood(
            &some(&x, width),
            width,
            &some(&y, shape_count),
            shape_count,
            options.given,
        )
        .ok_or(TrainingError::Still("the weights"))?;

        let learnt = Learnt::of((&x, width), (&y, shape_count), kernel, options.capacity)?;
        let out = Regression {
            centre,
            scale,
            kernel,
            shape_count,
            basis: learnt.basis,
            coefficients: learnt.coefficients,
            covariance: learnt.covariance,
            training_frames: n,
            log_likelihood,
        };
        // Without enough noise the sparse form's updates lose all digits.
        out.check().map_err(|_| TrainingError::Singular(kernel.noise))?;
        Ok(out)
    }

    /// D, the numbers of a frame of displacements.
    pub fn width(&self) -> usize {
        self.centre.len()
    }

    /// m, the basis vectors.
    pub fn basis_count(&self) -> usize {
        self.basis.len() / self.width().max(1)
    }

    /// Check that stored numbers fit together and are finite.
    ///
    /// # Errors
    /// [`TrainingError::Malformed`].
    pub fn check(&self) -> Result<(), TrainingError> {
        let (d, m, n) = (self.width(), self.basis_count(), self.shape_count);
        let sizes = [
            ("scales", self.scale.len(), d),
            ("numbers of the basis", self.basis.len(), m * d),
            ("coefficients", self.coefficients.len(), m * n),
            ("covariances", self.covariance.len(), m * m),
        ];
        for (what, found, expected) in sizes {
            if found != expected || expected == 0 {
                let what = format!("{found} {what}, {expected} expected");
                return Err(TrainingError::Malformed(what));
            }
        }
        let Kernel { length, signal, noise } = self.kernel;
        let positive = [length, signal].iter().chain(&self.scale).all(|x| *x > 0.0);
        let all = [&self.centre, &self.scale, &self.basis, &self.coefficients, &self.covariance];
        let finite =
            all.into_iter().flatten().chain(&[length, signal, noise]).all(|x| x.is_finite());
        if positive && finite && noise >= 0.0 {
            Ok(())
        } else {
            Err(TrainingError::Malformed("a number out of range".to_owned()))
        }
    }

    /// For a set of lost markers the matrix that fills in their coordinates from the others', by
    /// the covariance of the basis vectors: D x D, rows of lost coordinates, columns of seen ones.
    /// Empty where none is lost.
    pub(crate) fn fill(&self, missing: &[bool]) -> Vec<f64> {
        let d = self.width();
        let is_lost = |j: usize| missing[j / 3];
        let lost: Vec<usize> = (0..d).filter(|&j| is_lost(j)).collect();
        let seen: Vec<usize> = (0..d).filter(|&j| !is_lost(j)).collect();
        if lost.is_empty() {
            return Vec::new();
        }
        let mut covariance = vec![0.0; d * d];
        let part = 1.0 / self.basis_count() as f64;
        for b in self.basis.chunks_exact(d) {
            for (i, &x) in b.iter().enumerate() {
                axpy(part * x, b, &mut covariance[i * d..(i + 1) * d]);
            }
        }
        let mut factor = Cholesky::default();
        factor.reset(seen.len());
        for (i, &a) in seen.iter().enumerate() {
            for (x, &b) in factor.row_mut(i).iter_mut().zip(&seen[i..]) {
                *x = covariance[a * d + b];
            }
            factor.row_mut(i)[0] += FILL_RIDGE;
        }
        factor.factor();
        let mut out = vec![0.0; d * d];
        let mut right = vec![0.0; seen.len()];
        for &l in &lost {
            for (x, &s) in right.iter_mut().zip(&seen) {
                *x = covariance[l * d + s];
            }
            factor.solve(&mut right);
            right.iter().zip(&seen).for_each(|(x, &s)| out[l * d + s] = *x);
        }
        out
    }

    /// The N weights of a frame (not bounded), its predictive standard deviation, and whether it is
    /// far from the training data.
    ///
    /// `d`: displacements, metres, anything where `missing`; `fill` of [`Regression::fill`].
    pub(crate) fn predict(
        &self,
        d: &[f64],
        missing: &[bool],
        fill: &[f64],
        weights: &mut [f64],
        scratch: &mut RegressionScratch,
    ) -> (f64, bool) {
        let RegressionScratch { input, filled, covariances } = scratch;
        input.clear();
        input.extend_from_slice(d);
        standardise(input, &self.centre, &self.scale);
        if !fill.is_empty() {
            for (x, lost) in input.chunks_exact_mut(3).zip(missing) {
                if *lost {
                    x.fill(0.0);
                }
            }
            filled.resize(input.len(), 0.0);
            mul(fill, input, filled);
            for (x, f) in input.iter_mut().zip(filled.iter()) {
                *x += f;
            }
        }
        covariances.resize(self.basis_count(), 0.0);
        self.kernel.covariances(input, &self.basis, covariances);
        let variance =
            posterior(&self.kernel, covariances, &self.coefficients, &self.covariance, weights);
        let prior = self.kernel.signal * self.kernel.signal;
        (variance.sqrt(), variance > FAR * prior)
    }
}

/// Memory of a prediction, kept between frames.
#[derive(Debug, Clone, Default)]
pub(crate) struct RegressionScratch {
    input: Vec<f64>,
    filled: Vec<f64>,
    covariances: Vec<f64>,
}

/// At most `most` of 0..n, evenly spaced.
fn evenly(n: usize, most: usize) -> Vec<usize> {
    let count = n.min(most);
    (0..count).map(|i| i * n / count).collect()
}

/// 0..n in an order of which every beginning is spread over the whole: steps of the golden section.
fn scattered(n: usize) -> Vec<usize> {
    let mut step = ((n as f64) * 0.618_033_988_749_894_9) as usize;
    let common = |mut a: usize, mut b: usize| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    step = step.max(1);
    while common(step, n) != 1 {
        step += 1;
    }
    (0..n).map(|i| i * step % n).collect()
}
