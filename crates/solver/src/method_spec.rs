//! A method and its parameters as people write them: in the study file, on the command line.
//!
//! What is absent takes the method's default; what the method does not use is refused, so that a
//! study never claims a parameter that had no effect.

use litemap::LiteMap;

use serde::{Deserialize, Serialize};

use crate::linked::Linking;
use crate::method::Method;
use crate::named_values;

/// The weights of the discrete Laplacian (thesis 5.1.2).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LaplacianKind {
    /// Every edge weighs 1: the default.
    #[default]
    Uniform,
    /// Every edge weighs 1 / (number of neighbours): the mean of the neighbours minus the vertex.
    Umbrella,
    /// Cotangent weights clamped to 0..10, each row divided by its sum.
    CotanClamped,
    /// Cotangent weights over mixed Voronoi areas as printed, in millimetres. Ill-conditioned on
    /// real heads: offered for comparison.
    CotanLiteral,
}

/// Which vertices of a surface that moves without shapes stay where they are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hold {
    /// Those that no blendshape moves: skull and neck, as in every other method.
    #[default]
    Unmoved,
    /// None, as in the equation: the whole skin follows the markers.
    Nothing,
}

/// How a Gaussian process learns.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Inference {
    /// On a set of basis vectors, frame by frame (Csató & Opper 2002).
    #[default]
    Sparse,
    /// On all frames.
    Exact,
}

/// The unit in which a literal form of the papers measures.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Metres.
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    #[default]
    Mm,
}

impl Unit {
    /// How many of this unit make a metre.
    pub fn per_metre(self) -> f64 {
        match self {
            Unit::M => 1.0,
            Unit::Cm => 100.0,
            Unit::Mm => 1000.0,
        }
    }
}

/// Which points of the face a marker moves (Kouadio 1997, 4.3.1).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Association {
    /// Its own alone, eq. 4.3.
    Points,
    /// All within sigma, by a Gaussian of their distance, eq. 4.4-4.7.
    #[default]
    Zones,
    /// Those over the triangles between it and its neighbours, eq. 4.8-4.11.
    Triangles,
}

/// A method with its parameters; what is absent takes the method's default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct MethodSpec {
    /// Which method.
    pub method: Method,
    /// Weight of the thin shell against the bounds, 0..1. Default 0.3 for `lsts`, 0.5 elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alpha: Option<f64>,
    /// Overall weight of the priors against the data, above 0. Default 0.1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kappa: Option<f64>,
    /// Resistance to stretching, k_s of eq. 5.16. Default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub k_s: Option<f64>,
    /// Resistance to bending, k_b of eq. 5.16. Default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub k_b: Option<f64>,
    /// Weights of the Laplacian. Default uniform.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub laplacian: Option<LaplacianKind>,
    /// l_inf and l_sup of the soft bounds, eq. 5.24. Default -0.1 and 1.1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub soft_bounds: Option<[f64; 2]>,
    /// Smoothing s of the soft bounds, eq. 5.24. Default 0.1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub s: Option<f64>,
    /// Smoothing of the norms, sqrt(x^2 + eps^2). Normalised forms: in units of l (default 0 for
    /// `lsts-norm`, 1e-4 for `lsts-short`). Literal forms: in their unit (default 0 for
    /// `thesis-literal`, 0.001 mm for `short-literal`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eps: Option<f64>,
    /// Which points of the face a marker moves (`kouadio`). Default zones.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub association: Option<Association>,
    /// Radius of a marker's Gaussian zone, metres (`kouadio` with zones). Default 0.012.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    /// Weight of the soft bounds in `bounds-only`. Default 0.001.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds_weight: Option<f64>,
    /// Unit of the literal forms. Default millimetres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// How far the surface may leave its markers to be smoother (`thin-shell-surface`): weight of
    /// its energy, normalised, against the squared distances. Default 0: markers are met exactly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Which vertices rest (`thin-shell-surface`). Default `unmoved`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hold: Option<Hold>,
    /// How a Gaussian process learns (`regression`). Default `sparse`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inference: Option<Inference>,
    /// Most basis vectors of the sparse process. Default 200.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub basis_vectors: Option<u32>,
    /// Length scale of the kernel over standardised displacements; found by the marginal likelihood
    /// where not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length_scale: Option<f64>,
    /// Standard deviation of the process, in weights; likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub signal: Option<f64>,
    /// Standard deviation of the noise on the training weights; likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// Shapes held at 0, by name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub locked: Vec<String>,
    /// Importance of markers, by label; a marker that is not named has 1.
    #[serde(default, skip_serializing_if = "LiteMap::is_empty", with = "named_values")]
    pub importance: LiteMap<String, f64>,
    /// Bounds of single shapes, by name, instead of 0 and 1 (`lsts`, `box`, `kouadio`,
    /// `regression`) or of
    /// `softBounds` (the methods with soft bounds).
    #[serde(default, skip_serializing_if = "LiteMap::is_empty", with = "named_values")]
    pub bounds: LiteMap<String, [f64; 2]>,
    /// Cut-off of the zero-phase low-pass of the head's pose, Hz; absent or 0 = no filter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub head_lowpass_hz: Option<f64>,
}

impl MethodSpec {
    /// The method with every parameter at its default.
    pub fn new(method: Method) -> MethodSpec {
        MethodSpec {
            method,
            alpha: None,
            kappa: None,
            k_s: None,
            k_b: None,
            laplacian: None,
            soft_bounds: None,
            s: None,
            eps: None,
            association: None,
            sigma: None,
            bounds_weight: None,
            unit: None,
            stiffness: None,
            hold: None,
            inference: None,
            basis_vectors: None,
            length_scale: None,
            signal: None,
            noise: None,
            locked: Vec::new(),
            importance: LiteMap::new_vec(),
            bounds: LiteMap::new_vec(),
            head_lowpass_hz: None,
        }
    }

    /// The same spec with every absent parameter that the method uses written out: what the
    /// provenance of a stimulus is computed from.
    pub fn resolved(&self) -> MethodSpec {
        let mut spec = self.clone();
        for name in self.method.parameters() {
            match name {
                "alpha" => spec.alpha = Some(self.alpha()),
                "kappa" => spec.kappa = Some(self.kappa()),
                "kS" => spec.k_s = Some(self.k_s()),
                "kB" => spec.k_b = Some(self.k_b()),
                "laplacian" => spec.laplacian = Some(self.laplacian()),
                "softBounds" => spec.soft_bounds = Some(self.soft_bounds()),
                "s" => spec.s = Some(self.s()),
                "eps" => spec.eps = Some(self.eps()),
                "association" => spec.association = Some(self.association.unwrap_or_default()),
                "sigma" if matches!(self.linking(), Linking::Zones { .. }) => {
                    spec.sigma = Some(self.sigma());
                }
                "boundsWeight" => spec.bounds_weight = Some(self.bounds_weight()),
                "unit" => spec.unit = Some(self.unit()),
                "stiffness" => spec.stiffness = Some(self.stiffness()),
                "hold" => spec.hold = Some(self.hold()),
                "inference" => spec.inference = Some(self.inference()),
                "basisVectors" if self.inference() == Inference::Sparse => {
                    spec.basis_vectors = Some(self.basis_vectors());
                }
                "headLowpassHz" => {
                    spec.head_lowpass_hz = Some(self.head_lowpass_hz.unwrap_or(0.0));
                }
                _ => {}
            }
        }
        spec
    }

    /// alpha, or the method's default.
    pub fn alpha(&self) -> f64 {
        self.alpha.unwrap_or(if self.method == Method::Lsts { 0.3 } else { 0.5 })
    }

    /// kappa, or 0.1.
    pub fn kappa(&self) -> f64 {
        self.kappa.unwrap_or(0.1)
    }

    /// k_s, or 1.
    pub fn k_s(&self) -> f64 {
        self.k_s.unwrap_or(1.0)
    }

    /// k_b, or 1.
    pub fn k_b(&self) -> f64 {
        self.k_b.unwrap_or(1.0)
    }

    /// The Laplacian, or uniform.
    pub fn laplacian(&self) -> LaplacianKind {
        self.laplacian.unwrap_or_default()
    }

    /// l_inf and l_sup, or -0.1 and 1.1.
    pub fn soft_bounds(&self) -> [f64; 2] {
        self.soft_bounds.unwrap_or([-0.1, 1.1])
    }

    /// s, or 0.1.
    pub fn s(&self) -> f64 {
        self.s.unwrap_or(0.1)
    }

    /// eps, or the method's default (see [`MethodSpec::eps`] for its unit).
    pub fn eps(&self) -> f64 {
        self.eps.unwrap_or(match self.method {
            Method::LstsShort => 1e-4,
            Method::ShortLiteral => 1e-6 * self.unit().per_metre(),
            _ => 0.0,
        })
    }

    /// The association with its radius, or zones of 12 mm.
    pub fn linking(&self) -> Linking {
        match self.association.unwrap_or_default() {
            Association::Points => Linking::Points,
            Association::Zones => Linking::Zones { sigma: self.sigma() },
            Association::Triangles => Linking::Triangles,
        }
    }

    /// sigma, or 12 mm; metres.
    pub fn sigma(&self) -> f64 {
        self.sigma.unwrap_or(0.012)
    }

    /// The weight of the soft bounds in `bounds-only`, or 0.001.
    pub fn bounds_weight(&self) -> f64 {
        self.bounds_weight.unwrap_or(1e-3)
    }

    /// The stiffness of the surface against its markers, or 0.
    pub fn stiffness(&self) -> f64 {
        self.stiffness.unwrap_or(0.0)
    }

    /// What of the surface rests, or what no shape moves.
    pub fn hold(&self) -> Hold {
        self.hold.unwrap_or_default()
    }

    /// How the Gaussian process learns, or sparsely.
    pub fn inference(&self) -> Inference {
        self.inference.unwrap_or_default()
    }

    /// The most basis vectors of the sparse process, or 200.
    pub fn basis_vectors(&self) -> u32 {
        self.basis_vectors.unwrap_or(200)
    }

    /// The unit of the literal forms, or millimetres.
    pub fn unit(&self) -> Unit {
        self.unit.unwrap_or_default()
    }
}
