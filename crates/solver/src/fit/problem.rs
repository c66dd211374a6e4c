//! A method's parameters and an avatar's operators put together: weights of the energies, bounds,
//! which shapes are free, how much each marker counts.

use crate::energy::operators::{OperatorOptions, Operators};
use crate::fit::setup::{Engine, Setup};
use crate::kouadio::associated_rows::{AssociatedRows, VertexAssociation};
use crate::method::definition::Needs;
use crate::parameters::group::Group;
use crate::parameters::problem::{SpecError, SpecFault};
use crate::parameters::table::MethodSpec;

/// Why a method cannot be set up.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// A parameter is wrong, or names a shape or marker that is not there.
    #[error(transparent)]
    Spec(#[from] SpecError),
    /// The method gives no weights from markers.
    #[error(
        "method: 'recorded' reads weights from a file, there is nothing to solve; give the weights file, or another method"
    )]
    Recorded,
    /// The operators were built with other options than the method asks for.
    #[error(
        "operators built with {built}, the method asks for {asked}; build them with OperatorOptions::of"
    )]
    OtherOperators {
        /// What they were built with.
        built: String,
        /// What is asked for.
        asked: String,
    },
    /// The operators are a blendshape bank's.
    #[error(
        "method: 'thin-shell-surface' moves vertices, and these operators are a blendshape bank's; \
         build them with SurfaceResponse::operators"
    )]
    NoSurface,
    /// Nothing was learnt.
    #[error("method: 'regression' has learnt nothing; give a training take and its weights")]
    NotTrained,
    /// Every shape is locked.
    #[error("locked: all {0} shapes; leave some of them free")]
    AllLocked(usize),
    /// The displacements are not whole frames.
    #[error("displacements: {found} numbers; give frames of 3 x {markers} numbers")]
    Displacements {
        /// How many numbers there are.
        found: usize,
        /// P.
        markers: usize,
    },
}

/// The matrices over the n free shapes, and the engine.
#[derive(Debug, Clone)]
pub(crate) struct Problem {
    /// N.
    pub(crate) shape_count: usize,
    /// P.
    pub(crate) marker_count: usize,
    /// The n shapes that are not locked.
    pub(crate) free: Vec<usize>,
    /// D, 3P x n, each row times the root of its marker's importance.
    pub(crate) deltas: Vec<f64>,
    /// How far each free shape moves a marker at most, at weight 1, metres.
    pub(crate) reach: Vec<f64>,
    /// H, n x n.
    pub(crate) shell: Vec<f64>,
    /// Importance of each marker.
    pub(crate) importance: Vec<f64>,
    /// Kouadio's rows over the free shapes.
    pub(crate) associated: Option<AssociatedRows>,
    pub(crate) engine: Engine,
    /// Factor of the solved weights.
    pub(crate) gain: f64,
}

impl Problem {
    pub(crate) fn new(operators: &Operators, spec: &MethodSpec) -> Result<Problem, FitError> {
        let parts = operators.parts();
        let spec = &spec.with_names_of(&parts.shape_names, &parts.marker_labels);
        spec.validate()?;
        let definition = spec.method.definition();
        if definition.needs == Needs::Weights {
            return Err(FitError::Recorded);
        }
        check_options(&parts.options, spec)?;
        let n_all = operators.shape_count();
        let unknown = spec.unknown_names(&parts.shape_names, &parts.marker_labels);
        if let Some(first) = unknown.into_iter().next() {
            return Err(first.into());
        }
        let free = free_shapes(&parts.shape_names, spec)?;
        let importance = importances(&parts.marker_labels, spec);

        let n = free.len();
        let mut deltas = Vec::with_capacity(3 * operators.marker_count() * n);
        let mut squares = 0.0;
        for (row, values) in parts.marker_deltas.chunks_exact(n_all).enumerate() {
            let root = importance[row / 3].sqrt();
            squares = values.iter().fold(squares, |s, x| s + importance[row / 3] * x * x);
            deltas.extend(free.iter().map(|&k| root * values[k]));
        }
        let mut shell = Vec::with_capacity(n * n);
        for &i in &free {
            shell.extend(free.iter().map(|&j| parts.shell_gram[i * n_all + j]));
        }
        if !(squares > 0.0) {
            return Err(SpecError::of("importance", SpecFault::NothingMoves).into());
        }
        let setup = Setup {
            spec,
            parts,
            shell: &shell,
            free: &free,
            free_names: free.iter().map(|&k| parts.shape_names[k].as_str()).collect(),
            data_scale: squares / n_all as f64,
            shell_scale: operators.shell_scale(),
        };
        let reach = operators.marker_reach();
        let reach = free.iter().map(|&k| reach[k]).collect();
        let engine = (definition.engine)(&setup)?;
        let associated = parts.associated.as_ref().filter(|_| spec.method.uses(Group::Association));
        Ok(Problem {
            shape_count: n_all,
            marker_count: operators.marker_count(),
            engine,
            gain: spec.gain(),
            associated: associated.map(|l| l.restricted(&free, n_all)),
            free,
            reach,
            deltas,
            shell,
            importance,
        })
    }
}

fn check_options(built: &OperatorOptions, spec: &MethodSpec) -> Result<(), FitError> {
    let asked = OperatorOptions::of(spec);
    let shell = !spec.method.uses(Group::ThinShell)
        || (built.laplacian, built.k_s, built.k_b) == (asked.laplacian, asked.k_s, asked.k_b);
    let associated = asked.association.is_none() || built.association == asked.association;
    if shell && associated {
        return Ok(());
    }
    let words = |o: &OperatorOptions| {
        let association = match o.association {
            None => "none".to_owned(),
            Some(VertexAssociation::Points) => "points".to_owned(),
            Some(VertexAssociation::Zones { sigma }) => format!("zones of {sigma} m"),
            Some(VertexAssociation::Triangles) => "triangles".to_owned(),
        };
        let (laplacian, k_s, k_b) = (o.laplacian.word(), o.k_s, o.k_b);
        format!("laplacian {laplacian}, kS {k_s}, kB {k_b}, association {association}")
    };
    Err(FitError::OtherOperators { built: words(built), asked: words(&asked) })
}

fn free_shapes(names: &[String], spec: &MethodSpec) -> Result<Vec<usize>, FitError> {
    let free: Vec<usize> = (0..names.len()).filter(|&k| !spec.locked.contains(&names[k])).collect();
    if free.is_empty() { Err(FitError::AllLocked(names.len())) } else { Ok(free) }
}

fn importances(labels: &[String], spec: &MethodSpec) -> Vec<f64> {
    labels.iter().map(|l| spec.importance.get(l).copied().unwrap_or(1.0)).collect()
}
