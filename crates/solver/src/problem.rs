//! A method's parameters and an avatar's operators put together: weights of the energies, bounds,
//! which shapes are free, how much each marker counts.

use crate::linked::{LinkedRows, Linking};
use crate::method::Method;
use crate::method_spec::MethodSpec;
use crate::number_text::number_text;
use crate::objective::{Objective, Term};
use crate::operators::{OperatorOptions, OperatorParts, Operators};
use crate::regression::Regression;
use crate::spec_check::SpecError;
use crate::surface_fit::{METRES_PER_WEIGHT, SurfaceProblem};

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

/// How a method is solved, over its n free shapes.
#[derive(Debug, Clone)]
pub(crate) enum Engine {
    /// Minimise data_weight |Dc - d|^2 + shell_weight c^T H c in a box.
    Quadratic { data_weight: f64, shell_weight: f64, bounds: Vec<[f64; 2]> },
    /// The same in a box over linked rows, D^T D and D^T d replaced by theirs.
    Linked { bounds: Vec<[f64; 2]> },
    /// Newton; `fallback_eps` smooths the data norm where it vanishes.
    Smooth { objective: Objective, fallback_eps: f64 },
    /// c = D^+ d.
    PseudoInverse,
    /// The surface's markers, a problem a coordinate.
    Surface(SurfaceProblem),
    /// What was learnt, in a box.
    Learnt { model: Box<Regression>, bounds: Vec<[f64; 2]> },
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
    /// H, n x n.
    pub(crate) shell: Vec<f64>,
    /// Importance of each marker.
    pub(crate) importance: Vec<f64>,
    /// Kouadio's rows over the free shapes.
    pub(crate) linked: Option<LinkedRows>,
    pub(crate) engine: Engine,
}

impl Problem {
    pub(crate) fn new(operators: &Operators, spec: &MethodSpec) -> Result<Problem, FitError> {
        spec.validate()?;
        if spec.method == Method::Recorded {
            return Err(FitError::Recorded);
        }
        let parts = operators.parts();
        check_options(&parts.options, spec)?;
        let n_all = operators.shape_count();
        let free = free_shapes(&parts.shape_names, spec)?;
        let importance = importances(&parts.marker_labels, spec)?;
        check_names("bounds", spec.bounds.keys(), &parts.shape_names, "shape")?;

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
            return Err(SpecError {
                field: "importance".into(),
                message: "no marker with importance above 0 is moved by a shape; \
                          give one of them importance"
                    .into(),
            }
            .into());
        }
        let scales = Scales {
            // l^2 of the weighted rows: a common factor of all importances changes nothing.
            data: squares / n_all as f64,
            shell: operators.shell_scale(),
            shapes: n_all as f64,
            vertices: parts.vertex_count as f64,
        };
        let names: Vec<&str> = free.iter().map(|&k| parts.shape_names[k].as_str()).collect();
        let linked = parts.linked.as_ref().filter(|_| spec.method == Method::Kouadio);
        Ok(Problem {
            shape_count: n_all,
            marker_count: operators.marker_count(),
            engine: engine(spec, &scales, &names, parts)?,
            linked: linked.map(|l| l.restricted(&free, n_all)),
            free,
            deltas,
            shell,
            importance,
        })
    }
}

struct Scales {
    /// l^2.
    data: f64,
    /// tau.
    shell: f64,
    /// N.
    shapes: f64,
    /// S.
    vertices: f64,
}

/// The rows of METHOD's table, for lengths in metres.
fn engine(
    spec: &MethodSpec,
    scales: &Scales,
    names: &[&str],
    parts: &OperatorParts,
) -> Result<Engine, FitError> {
    let bounds = |default: [f64; 2]| -> Vec<[f64; 2]> {
        names.iter().map(|&n| spec.bounds.get(n).copied().unwrap_or(default)).collect()
    };
    let box_bounds = || bounds([0.0, 1.0]);
    let smooth = |data, shell, bounds_weight| Engine::Smooth {
        objective: Objective::new(data, shell, bounds_weight, bounds(spec.soft_bounds()), spec.s()),
        fallback_eps: 1e-4 * scales.data.sqrt(),
    };
    let (alpha, kappa) = (spec.alpha(), spec.kappa());
    let length = scales.data.sqrt();
    let data_weight = 1.0 / scales.data;
    let shell_weight = kappa * alpha / scales.shell;
    let unbounded = || vec![[f64::NEG_INFINITY, f64::INFINITY]; names.len()];
    Ok(match spec.method {
        Method::Lsts => Engine::Quadratic { data_weight, shell_weight, bounds: box_bounds() },
        Method::ThinShellOnly => {
            Engine::Quadratic { data_weight, shell_weight, bounds: unbounded() }
        }
        // The scale of the data changes no minimiser; with it Q is near 1 in any unit.
        Method::Box => Engine::Quadratic { data_weight, shell_weight: 0.0, bounds: box_bounds() },
        Method::Nnls => Engine::Quadratic {
            data_weight,
            shell_weight: 0.0,
            bounds: vec![[0.0, f64::INFINITY]; names.len()],
        },
        Method::Kouadio => Engine::Linked { bounds: box_bounds() },
        Method::LstsSoft => smooth(
            Term::Squared { weight: data_weight },
            Term::Squared { weight: shell_weight },
            kappa * (1.0 - alpha) / scales.shapes,
        ),
        Method::BoundsOnly => {
            smooth(Term::Squared { weight: data_weight }, Term::Absent, spec.bounds_weight())
        }
        Method::LstsNorm => smooth(
            Term::Norm { weight: 1.0 / length, eps: spec.eps() * length },
            Term::Squared { weight: alpha / scales.shell },
            (1.0 - alpha) / scales.shapes,
        ),
        Method::LstsShort => smooth(
            Term::Norm { weight: 1.0 / length, eps: spec.eps() * length },
            Term::Norm { weight: alpha / scales.shell.sqrt(), eps: spec.eps() * length },
            (1.0 - alpha) / scales.shapes,
        ),
        Method::ThesisLiteral => {
            let per_metre = spec.unit().per_metre();
            smooth(
                Term::Norm { weight: per_metre, eps: spec.eps() / per_metre },
                Term::Squared { weight: alpha * per_metre * per_metre },
                3.0 * scales.vertices * (1.0 - alpha),
            )
        }
        Method::ShortLiteral => {
            let per_metre = spec.unit().per_metre();
            let eps = spec.eps() / per_metre;
            smooth(
                Term::Norm { weight: per_metre, eps },
                Term::Norm { weight: alpha * per_metre, eps },
                1.0 - alpha,
            )
        }
        Method::ThinShellSurface => {
            let markers = parts.marker_labels.len();
            if !is_surface(parts) {
                return Err(FitError::NoSurface);
            }
            Engine::Surface(SurfaceProblem::new(&parts.shell_gram, markers, spec.stiffness()))
        }
        Method::Regression => {
            let model = parts.regression.clone().ok_or(FitError::NotTrained)?;
            Engine::Learnt { model: Box::new(model), bounds: box_bounds() }
        }
        // Recorded weights were refused before: nothing is solved.
        Method::PseudoInverse | Method::Recorded => Engine::PseudoInverse,
    })
}

/// Whether the "shapes" are the markers themselves, each along x, y and z.
fn is_surface(parts: &OperatorParts) -> bool {
    let n = 3 * parts.marker_labels.len();
    parts.shape_names.len() == n
        && (0..n * n).all(|at| {
            let expected = if at / n == at % n { METRES_PER_WEIGHT } else { 0.0 };
            parts.marker_deltas[at] == expected
        })
}

fn check_options(built: &OperatorOptions, spec: &MethodSpec) -> Result<(), FitError> {
    let asked = OperatorOptions::of(spec);
    let shell = !spec.method.parameters().contains(&"kS")
        || (built.laplacian, built.k_s, built.k_b) == (asked.laplacian, asked.k_s, asked.k_b);
    let linked = asked.linking.is_none() || built.linking == asked.linking;
    if shell && linked {
        return Ok(());
    }
    let words = |o: &OperatorOptions| {
        let linking = match o.linking {
            None => "none".to_owned(),
            Some(Linking::Points) => "points".to_owned(),
            Some(Linking::Zones { sigma }) => format!("zones of {} m", number_text(sigma)),
            Some(Linking::Triangles) => "triangles".to_owned(),
        };
        let (k_s, k_b) = (number_text(o.k_s), number_text(o.k_b));
        format!("laplacian {:?}, kS {k_s}, kB {k_b}, association {linking}", o.laplacian)
    };
    Err(FitError::OtherOperators { built: words(built), asked: words(&asked) })
}

fn free_shapes(names: &[String], spec: &MethodSpec) -> Result<Vec<usize>, FitError> {
    check_names("locked", spec.locked.iter(), names, "shape")?;
    let free: Vec<usize> = (0..names.len()).filter(|&k| !spec.locked.contains(&names[k])).collect();
    if free.is_empty() { Err(FitError::AllLocked(names.len())) } else { Ok(free) }
}

fn importances(labels: &[String], spec: &MethodSpec) -> Result<Vec<f64>, FitError> {
    check_names("importance", spec.importance.keys(), labels, "marker")?;
    Ok(labels.iter().map(|l| spec.importance.get(l).copied().unwrap_or(1.0)).collect())
}

fn check_names<'a>(
    field: &str,
    given: impl Iterator<Item = &'a String>,
    known: &[String],
    what: &str,
) -> Result<(), FitError> {
    for name in given {
        if !known.contains(name) {
            return Err(SpecError {
                field: field.to_owned(),
                message: format!("no {what} '{name}'; use names of {}", known.join(", ")),
            }
            .into());
        }
    }
    Ok(())
}
