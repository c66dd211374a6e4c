//! A method and its parameters as people write them: in the study file, on the command line.
//!
//! What is absent takes the method's default; what the method does not use is refused, so that a
//! study never claims a parameter that had no effect.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

/// The methods, by the names of the design notes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Squared data term, thin shell, exact bounds 0..1.
    Lsts,
    /// Squared data term, thin shell, soft bounds.
    LstsSoft,
    /// Eq. 5.30 of the thesis, normalised.
    LstsNorm,
    /// Eq. 5 of the short paper, normalised.
    LstsShort,
    /// Eq. 5.30 as printed, in its unit.
    ThesisLiteral,
    /// Eq. 5 of the short paper as printed, in its unit.
    ShortLiteral,
    /// Data and soft bounds alone.
    BoundsOnly,
    /// Data and thin shell alone.
    ThinShellOnly,
    /// Bounded least squares: the plain baseline.
    Box,
    /// Non-negative least squares.
    Nnls,
    /// Unbounded least squares.
    PseudoInverse,
    /// Kouadio 1997: Gaussian zones.
    Kouadio,
    /// The mesh moved by the thin shell, without shapes.
    ThinShellSurface,
    /// Learnt from a range-of-motion take.
    Regression,
    /// Weights read from a file.
    Recorded,
}

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
    /// Radius of a marker's Gaussian zone, metres (`kouadio`). Default 0.012.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    /// Weight of the soft bounds in `bounds-only`. Default 0.001.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds_weight: Option<f64>,
    /// Unit of the literal forms. Default millimetres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<Unit>,
    /// Shapes held at 0, by name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub locked: Vec<String>,
    /// Importance of markers, by label; a marker that is not named has 1.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub importance: BTreeMap<String, f64>,
    /// Bounds of single shapes, by name, instead of 0 and 1 (`lsts`, `box`, `kouadio`) or of
    /// `softBounds` (the methods with soft bounds).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub bounds: BTreeMap<String, [f64; 2]>,
    /// Cut-off of the zero-phase low-pass of the head's pose, Hz; absent or 0 = no filter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub head_lowpass_hz: Option<f64>,
}

/// Something wrong in a [`MethodSpec`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{field}: {message}")]
pub struct SpecError {
    /// The field as it is written in JSON, e.g. `softBounds` or `importance.M03`.
    pub field: String,
    /// What is wrong, the value, and the remedy.
    pub message: String,
}

const SHELL: &[&str] = &["kS", "kB", "laplacian"];
const SOFT: &[&str] = &["softBounds", "s", "bounds"];
const COMMON: &[&str] = &["locked", "importance", "headLowpassHz"];

impl Method {
    /// Every method, in the order of the design notes.
    pub const ALL: [Method; 15] = [
        Method::Lsts,
        Method::LstsSoft,
        Method::LstsNorm,
        Method::LstsShort,
        Method::ThesisLiteral,
        Method::ShortLiteral,
        Method::BoundsOnly,
        Method::ThinShellOnly,
        Method::Box,
        Method::Nnls,
        Method::PseudoInverse,
        Method::Kouadio,
        Method::ThinShellSurface,
        Method::Regression,
        Method::Recorded,
    ];

    /// The name in study files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Method::Lsts => "lsts",
            Method::LstsSoft => "lsts-soft",
            Method::LstsNorm => "lsts-norm",
            Method::LstsShort => "lsts-short",
            Method::ThesisLiteral => "thesis-literal",
            Method::ShortLiteral => "short-literal",
            Method::BoundsOnly => "bounds-only",
            Method::ThinShellOnly => "thin-shell-only",
            Method::Box => "box",
            Method::Nnls => "nnls",
            Method::PseudoInverse => "pseudo-inverse",
            Method::Kouadio => "kouadio",
            Method::ThinShellSurface => "thin-shell-surface",
            Method::Regression => "regression",
            Method::Recorded => "recorded",
        }
    }

    /// The parameters that the method uses, by their JSON names.
    pub fn parameters(self) -> Vec<&'static str> {
        let groups: &[&[&str]] = match self {
            Method::Lsts => &[&["alpha", "kappa"], SHELL, &["bounds"], COMMON],
            Method::LstsSoft => &[&["alpha", "kappa"], SHELL, SOFT, COMMON],
            Method::LstsNorm | Method::LstsShort => &[&["alpha", "eps"], SHELL, SOFT, COMMON],
            Method::ThesisLiteral | Method::ShortLiteral => {
                &[&["alpha", "eps", "unit"], SHELL, SOFT, COMMON]
            }
            Method::BoundsOnly => &[&["boundsWeight"], SOFT, COMMON],
            Method::ThinShellOnly => &[&["alpha", "kappa"], SHELL, COMMON],
            Method::Box => &[&["bounds"], COMMON],
            Method::Nnls | Method::PseudoInverse => &[COMMON],
            Method::Kouadio => &[&["sigma", "bounds"], COMMON],
            Method::ThinShellSurface => &[&["kS", "kB", "laplacian", "headLowpassHz"]],
            Method::Regression => &[&["headLowpassHz"]],
            Method::Recorded => &[],
        };
        groups.concat()
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Method {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Method, SpecError> {
        Method::ALL.into_iter().find(|m| m.name() == text).ok_or_else(|| SpecError {
            field: "method".into(),
            message: format!(
                "unknown method '{text}'; use one of {}",
                Method::ALL.map(Method::name).join(", ")
            ),
        })
    }
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
            sigma: None,
            bounds_weight: None,
            unit: None,
            locked: Vec::new(),
            importance: BTreeMap::new(),
            bounds: BTreeMap::new(),
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
                "sigma" => spec.sigma = Some(self.sigma()),
                "boundsWeight" => spec.bounds_weight = Some(self.bounds_weight()),
                "unit" => spec.unit = Some(self.unit()),
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

    /// sigma, or 12 mm; metres.
    pub fn sigma(&self) -> f64 {
        self.sigma.unwrap_or(0.012)
    }

    /// The weight of the soft bounds in `bounds-only`, or 0.001.
    pub fn bounds_weight(&self) -> f64 {
        self.bounds_weight.unwrap_or(1e-3)
    }

    /// The unit of the literal forms, or millimetres.
    pub fn unit(&self) -> Unit {
        self.unit.unwrap_or_default()
    }

    /// The first problem, if there is one.
    ///
    /// # Errors
    /// The first of [`MethodSpec::problems`].
    pub fn validate(&self) -> Result<(), SpecError> {
        self.problems().into_iter().next().map_or(Ok(()), Err)
    }

    /// Every problem: parameters that the method does not use, and values out of range.
    ///
    /// Whether the names in `locked`, `importance` and `bounds` exist is known only with an avatar
    /// and a marker map: `Fit::new` checks them.
    pub fn problems(&self) -> Vec<SpecError> {
        let mut found = Problems(Vec::new());
        match self.method {
            Method::ThinShellSurface | Method::Regression => found.add(
                "method",
                format!("'{}' is not available yet; use lsts, box or kouadio", self.method),
            ),
            _ => {}
        }
        self.refuse_unused(&mut found);
        found.number("alpha", self.alpha, "between 0 and 1", |v| (0.0..=1.0).contains(&v));
        found.number("kappa", self.kappa, "above 0", |v| v > 0.0);
        found.number("kS", self.k_s, "0 or more", |v| v >= 0.0);
        found.number("kB", self.k_b, "0 or more", |v| v >= 0.0);
        found.number("s", self.s, "between 0.001 and 10", |v| (1e-3..=10.0).contains(&v));
        found.number("eps", self.eps, "0 or more", |v| v >= 0.0);
        found
            .number("sigma", self.sigma, "above 0 and at most 1 (metres)", |v| v > 0.0 && v <= 1.0);
        found.number("boundsWeight", self.bounds_weight, "above 0", |v| v > 0.0);
        found.number("headLowpassHz", self.head_lowpass_hz, "0 (no filter) or more", |v| v >= 0.0);
        if self.k_s() == 0.0 && self.k_b() == 0.0 && self.method.parameters().contains(&"kS") {
            found.add("kS", "kS and kB are both 0, which leaves no thin shell; make one positive");
        }
        if let Some(bounds) = self.soft_bounds {
            found.interval("softBounds", bounds, false);
        }
        for (name, &bounds) in &self.bounds {
            found.interval(&format!("bounds.{name}"), bounds, true);
        }
        for (label, &importance) in &self.importance {
            let field = format!("importance.{label}");
            found.number(&field, Some(importance), "0 or more", |v| v >= 0.0);
        }
        for (i, name) in self.locked.iter().enumerate() {
            if self.locked[..i].contains(name) {
                found.add(&format!("locked.{i}"), format!("'{name}' is named twice; name it once"));
            }
            if self.bounds.contains_key(name) {
                found.add(
                    &format!("locked.{i}"),
                    format!("'{name}' has bounds too; lock it or bound it, not both"),
                );
            }
        }
        found.0
    }

    fn refuse_unused(&self, found: &mut Problems) {
        let given = [
            ("alpha", self.alpha.is_some()),
            ("kappa", self.kappa.is_some()),
            ("kS", self.k_s.is_some()),
            ("kB", self.k_b.is_some()),
            ("laplacian", self.laplacian.is_some()),
            ("softBounds", self.soft_bounds.is_some()),
            ("s", self.s.is_some()),
            ("eps", self.eps.is_some()),
            ("sigma", self.sigma.is_some()),
            ("boundsWeight", self.bounds_weight.is_some()),
            ("unit", self.unit.is_some()),
            ("locked", !self.locked.is_empty()),
            ("importance", !self.importance.is_empty()),
            ("bounds", !self.bounds.is_empty()),
            ("headLowpassHz", self.head_lowpass_hz.is_some()),
        ];
        let used = self.method.parameters();
        for (name, is_given) in given {
            if is_given && !used.contains(&name) {
                let remedy = if used.is_empty() {
                    "it takes none".to_owned()
                } else {
                    format!("it takes {}", used.join(", "))
                };
                found.add(name, format!("'{}' does not use it; remove it ({remedy})", self.method));
            }
        }
    }
}

struct Problems(Vec<SpecError>);

impl Problems {
    fn add(&mut self, field: &str, message: impl Into<String>) {
        self.0.push(SpecError { field: field.to_owned(), message: message.into() });
    }

    fn number(&mut self, field: &str, value: Option<f64>, range: &str, ok: impl Fn(f64) -> bool) {
        if let Some(v) = value
            && !(v.is_finite() && ok(v))
        {
            self.add(field, format!("is {v}; give a number {range}"));
        }
    }

    fn interval(&mut self, field: &str, [lo, hi]: [f64; 2], may_be_a_point: bool) {
        let ordered = if may_be_a_point { lo <= hi } else { lo < hi };
        if !(lo.is_finite() && hi.is_finite() && ordered) {
            self.add(field, format!("is [{lo}, {hi}]; give two numbers, the lower one first"));
        }
    }
}
