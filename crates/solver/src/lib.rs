//! From marker displacements to blendshape weights: operators, energies, methods. f64, no I/O, no clock.
//!
//! ```text
//! SkinMesh --weld--> SkinMesh --Operators::build--> Operators --Fit::new(spec)--> Fit
//! captured markers --FrontEnd--> displacements d --Fit::solve_take--> weights + reports
//! ```
//!
//! | paper | code | size | unit |
//! |---|---|---|---|
//! | S, P, N (thesis 5.1.1) | `vertex_count`, `marker_count`, `shape_count` | | |
//! | B (eq. 5.3) | [`SkinMesh::shapes`], sparse | 3S x N | m |
//! | L, W_vert (eq. 5.11-5.12) | [`Laplacian`], the sign of eq. 5.12 | S x S, sparse | 1 (m^-2 cotangent) |
//! | A = -k_s L + k_b L^2 (eq. 5.17) | [`apply_shell`], never formed | S x S | |
//! | AB (eq. 5.29) | rows streamed into H, never kept | 3S x N | m |
//! | c^T H c = Enc'_ts (eq. 5.28, 5.30) | [`OperatorParts::shell_gram`] | N x N | m^2 |
//! | Da_c = D c (eq. 5.22) | [`OperatorParts::marker_deltas`] | 3P x N | m |
//! | Dm (eq. 5.21) | displacements `d`, [`FrontEnd::displacements`] | 3P a frame | m |
//! | l^2 = tr(D^T D) / N | [`Operators::data_scale`] | | m^2 |
//! | tau = tr(H) / N | [`Operators::shell_scale`] | | m^2 |
//! | E_b, l_inf, l_sup, s (eq. 5.24) | [`MethodSpec::soft_bounds`], [`MethodSpec::s`] | | |
//! | F, u_k, q (eq. 5.18-5.20) | [`Rbf`] | P + 4 | m |
//! | K of eq. 2.16, its P x P for the whole surface | [`SurfaceResponse`] | S x S, P x P | 1 |
//! | X, Y, K(X, X') (eq. 3.2-3.4) | [`Regression`], [`Kernel`] | m x 3P, m x N | |
//! | w_i, N_i, sigma (Kouadio 4.4-4.7); r, u, v (4.8-4.11) | [`LinkedRows`], [`MarkerSite`] | P x N(N+1)/2 | m^2 |
//!
//! The same input gives the same bits natively and in WebAssembly: every sum runs in an order that
//! is written down, nothing is fused, `tan` is that of `libm` and `exp` our own.
//!
//! # Speed
//!
//! A Newton step at N = 53 is some 61 kflop, of which the factor is 50; a core that does 8
//! double-precision operations a cycle at 2.8 GHz could not make more than 370,000 a second, and the
//! divisions and roots on the diagonal halve that. `lsts` exchanges its active set some four times
//! a frame, `lsts-norm` needs about two factors; `docs/solver-benchmarks.md` has what was measured
//! beside SciPy, and `cargo xtask bench` measures again.

#![allow(clippy::needless_range_loop, reason = "matrices read best by their indices")]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > y)` says what becomes of NaN")]

mod bank;
mod box_qp;
mod cholesky;
mod dense;
mod exp;
mod fit;
mod front_end;
mod front_end_error;
mod gaussian_process;
mod head_pose;
mod hyper_parameters;
mod laplacian;
mod linked;
mod lowpass;
mod marker_frames;
mod marker_scales;
mod marker_site;
mod mask;
mod method;
mod method_spec;
mod named_values;
mod newton;
mod number_text;
mod objective;
mod operators;
mod problem;
mod rbf;
mod regression;
mod report;
mod rigid_alignment;
mod seen;
mod shell_patch;
mod skin_mesh;
#[cfg(feature = "surface")]
mod sparse_cholesky;
mod sparse_process;
mod spec_check;
#[cfg(feature = "surface")]
mod surface;
mod surface_depth;
mod surface_fit;
mod svd;
mod symmetry;
mod synthesis;
mod thin_shell;

pub use bank::{BankColumns, Combination, DEPENDENT_SHARE, bank_columns, dead_rows};
pub use fit::{CHUNK_FRAMES, Fit, FrameSolver};
pub use front_end::{FrontEnd, FrontEndScratch};
pub use front_end_error::FrontEndError;
pub use gaussian_process::{ExactProcess, Kernel, log_marginal_likelihood};
pub use hyper_parameters::maximise_likelihood;
pub use laplacian::{Laplacian, mixed_voronoi_areas};
pub use linked::{LinkedRows, Linking};
pub use lowpass::{Lowpass, LowpassError};
pub use marker_frames::{MarkerColumns, MarkerFrames};
pub use marker_scales::{Extent, LEAST_RANGE_M, MarkerScales, bank_extents, motion_extents};
pub use marker_site::{MarkerSite, SurfacePoint};
pub use method::Method;
pub use method_spec::{Association, Hold, Inference, LaplacianKind, MethodSpec, Unit};
pub use number_text::number_text;
pub use operators::{OperatorError, OperatorOptions, OperatorParts, Operators};
pub use problem::FitError;
pub use rbf::{Rbf, RbfError};
pub use regression::{
    LEAST_TRAINING_FRAMES, MOST_EXACT_FRAMES, Regression, TrainingError, TrainingOptions,
};
pub use report::{FrameReport, FrameSolution, FrameWarning, TakeSolution};
pub use rigid_alignment::{RigidError, RigidMotion, align_rigidly};
pub use skin_mesh::{MeshError, SkinMesh, SparseDeltas, Welded};
pub use sparse_process::SparseProcess;
pub use spec_check::SpecError;
#[cfg(feature = "surface")]
pub use surface::{SurfaceError, SurfaceResponse, surface_shape_names};
pub use surface_depth::{FanTriangle, SurfaceDepth};
pub use surface_fit::METRES_PER_WEIGHT;
pub use symmetry::{FALL_OFF_M, MirrorError, MirrorPlane, split_delta};
pub use synthesis::Synthesis;
pub use thin_shell::{apply_shell, shell_gram};
