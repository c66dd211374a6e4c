//! From marker displacements to blendshape weights: operators, energies, methods. f64, no I/O, no clock.
//!
//! ```text
//! SkinMesh --weld--> SkinMesh --Operators::build--> Operators --Fit::new(spec)--> Fit
//! captured markers --FrontEnd--> displacements d --Fit::solve_take--> weights + reports
//! ```
//!
//! ```
//! use mimique_geometry::{Displacement, Point};
//! use mimique_solver::{
//!     Fit, Method, MethodSpec, OperatorOptions, Operators, SkinMesh, SparseDeltas,
//! };
//!
//! // A skin of two triangles; its one shape lifts the last vertex, which has a marker, by 1 cm.
//! let skin = SkinMesh {
//!     positions: [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.1, 0.1, 0.0]]
//!         .map(Point::from)
//!         .to_vec(),
//!     triangles: vec![[0, 1, 2], [1, 3, 2]],
//!     shapes: vec![SparseDeltas { vertices: vec![3], deltas: vec![Displacement::from([0.0, 0.0, 0.01])] }],
//! };
//! let (shapes, markers) = (["lift".to_owned()], [("Cheek".to_owned(), 3)]);
//! let spec = MethodSpec::new(Method::Box);
//! let operators = Operators::build(&skin, &shapes, &markers, &OperatorOptions::of(&spec))?;
//!
//! // The marker went 5 mm up: half of the shape.
//! let frame = Fit::new(&operators, &spec)?.solve_frame(&[0.0, 0.0, 0.005])?;
//! assert!((frame.weights[0] - 0.5).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
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
//! | Dm (eq. 5.21) | displacements `d`, [`FrontEnd::displacements`] | 3P per frame | m |
//! | l^2 = tr(D^T D) / N | [`Operators::data_scale`] | | m^2 |
//! | tau = tr(H) / N | [`Operators::shell_scale`] | | m^2 |
//! | lambda, mu (Racković et al.) | [`MethodSpec::lambda`], [`MethodSpec::mu`]; [`WINDOW_FRAMES`], [`LOOK_AHEAD`] | | 1 |
//! | L1, L2, T, Y (Audio2Face-3D) | [`MethodSpec::l1`], [`MethodSpec::l2`], [`MethodSpec::temporal`], [`MethodSpec::symmetry`] | | 1 |
//! | E_b, l_inf, l_sup, s (eq. 5.24) | [`MethodSpec::soft_bounds`], [`MethodSpec::s`] | | |
//! | F, u_k, q (eq. 5.18-5.20) | [`Rbf`] | P + 4 | m |
//! | K of eq. 2.16, its P x P for the whole surface | [`SurfaceResponse`] | S x S, P x P | 1 |
//! | X, Y, K(X, X') (eq. 3.2-3.4) | [`Regression`], [`Kernel`] | m x 3P, m x N | |
//! | w_i, N_i, sigma (Kouadio 4.4-4.7); r, u, v (4.8-4.11) | [`AssociatedRows`], [`MarkerSite`] | P x N(N+1)/2 | m^2 |
//!
//! The same input gives the same bits natively and in WebAssembly: every sum runs in an order that
//! is written down, nothing is fused, `tan` is that of `libm` and `exp` our own.
//!
//! # Speed
//!
//! A Newton step at N = 53 is some 61 kflop, of which the factor is 50; a core that does 8
//! double-precision operations per cycle at 2.8 GHz could not make more than 370,000 per second, and the
//! divisions and roots on the diagonal halve that. `lsts` exchanges its active set some four times
//! per frame, `lsts-norm` needs about two factors; `docs/measured/solver-benchmarks.md` has what was measured
//! beside SciPy, and `cargo xtask bench` measures again.

#![allow(clippy::needless_range_loop, reason = "matrices read best by their indices")]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > y)` says what becomes of NaN")]

mod energy;
mod fit;
mod front_end;
mod gaussian_process;
mod kouadio;
mod layout;
mod linear_algebra;
mod mesh;
mod method;
mod newton;
mod parameters;
mod quadratic;
mod surface;
mod weights_hash;

pub use energy::operators::{OperatorError, OperatorOptions, OperatorParts, Operators};
pub use energy::sensitivity::{
    ShapeSensitivity, ToldBy, error_alone, is_told, shape_sensitivities,
};
pub use energy::thin_shell::{apply_shell, shell_gram};
pub use fit::frame::FrameSolver;
pub use fit::problem::FitError;
pub use fit::report::{
    FrameReport, FrameSolution, FrameWarning, LARGEST_DISPLACEMENT, LARGEST_WEIGHT, TakeSolution,
};
pub use fit::window::{LOOK_AHEAD, WINDOW_FRAMES};
pub use fit::{CHUNK_FRAMES, Fit};
pub use front_end::error::FrontEndError;
pub use front_end::head_lowpass::{HEAD_LOWPASS_HZ, MOST_HEAD_LOWPASS_OF_RATE};
pub use front_end::lowpass::{Lowpass, LowpassError};
pub use front_end::marker_frames::{MarkerColumns, MarkerFrames};
pub use front_end::marker_scales::{
    Extent, LEAST_RANGE_M, MarkerScales, bank_extents, motion_extents,
};
pub use front_end::rbf::{Rbf, RbfError};
pub use front_end::surface_depth::{FanTriangle, SurfaceDepth};
pub use front_end::take::{Adaptation, FrontEnd, FrontEndScratch};
pub use gaussian_process::exact::{ExactProcess, Kernel, log_marginal_likelihood};
pub use gaussian_process::hyper_parameters::maximise_likelihood;
pub use gaussian_process::input_scale::InputScale;
pub use gaussian_process::regression::{
    LEAST_TRAINING_FRAMES, MOST_EXACT_FRAMES, Regression, TrainingError, TrainingOptions,
};
pub use gaussian_process::sparse::{Learning, SparseProcess};
pub use kouadio::associated_rows::{AssociatedRows, VertexAssociation};
pub use kouadio::bank::{BankColumns, Combination, DEPENDENT_SHARE, bank_columns, dead_rows};
pub use layout::cluster_markers::{ClusterMarkers, StandsFor, stands_for_pairs};
pub use layout::farthest::farthest_first;
pub use layout::greedy::{Criterion, Greedy, MarkerUnit};
pub use layout::head_spread::{FaceMoments, best_heads, head_error};
pub use layout::kmeans::{KMeans, KMeansStep, spread_centres};
pub use layout::pivoted_qr::{PivotedQr, PivotedRow};
pub use layout::slip::SkinGradients;
#[cfg(feature = "surface")]
pub use layout::surface_greedy::SurfaceGreedy;
pub use layout::trajectory_rows::{
    STILL_M, TrajectoryRows, VertexTrajectories, WeightMotion, motion_rows,
};
pub use linear_algebra::exp::exp_all;
pub use mesh::laplacian::{Laplacian, mixed_voronoi_areas};
pub use mesh::marker_site::{MarkerSite, SurfacePoint};
pub use mesh::skin_mesh::{MeshError, SkinMesh, SparseDeltas, Welded};
pub use mesh::symmetry::{FALL_OFF_M, MirrorError, MirrorPlane, split_delta};
pub use mesh::synthesis::Synthesis;
pub use method::definition::Needs;
pub use method::names::Method;
pub use parameters::choices::{
    Association, Gaze, Hold, Inference, LaplacianKind, Unit, Unsolved, Untold,
};
pub use parameters::group::Group;
pub use parameters::kind::{Kind, NamesOf, Quantity, Range};
pub use parameters::problem::{SpecError, SpecFault};
pub use parameters::schema::parameter_schemas;
pub use parameters::table::{About, Effect, MethodSpec, PARAMETERS, Parameter};
pub use parameters::value::ByName;
pub use surface::frame::METRES_PER_WEIGHT;
#[cfg(feature = "surface")]
pub use surface::response::{SurfaceError, SurfaceResponse, surface_shape_names};
pub use weights_hash::weights_hash;
