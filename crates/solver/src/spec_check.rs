//! What is wrong with a method's parameters: all of it, each with its field, value and remedy.

use crate::method::Method;
use crate::method_spec::{Association, Inference, MethodSpec};
use crate::number_text::number_text;

/// Something wrong in a [`MethodSpec`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{field}: {message}")]
pub struct SpecError {
    /// The field as it is written in JSON, e.g. `softBounds` or `importance.M03`.
    pub field: String,
    /// What is wrong, the value, and the remedy.
    pub message: String,
}

impl MethodSpec {
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
        self.refuse_unused(&mut found);
        found.number("alpha", self.alpha, "between 0 and 1", |v| (0.0..=1.0).contains(&v));
        found.number("kappa", self.kappa, "above 0", |v| v > 0.0);
        found.number("kS", self.k_s, "0 or more", |v| v >= 0.0);
        found.number("kB", self.k_b, "0 or more", |v| v >= 0.0);
        found.number("s", self.s, "between 0.001 and 10", |v| (1e-3..=10.0).contains(&v));
        found.number("eps", self.eps, "0 or more", |v| v >= 0.0);
        found
            .number("sigma", self.sigma, "above 0 and at most 1 (metres)", |v| v > 0.0 && v <= 1.0);
        if let (Some(association), Some(sigma)) = (self.association, self.sigma)
            && association != Association::Zones
        {
            let message =
                format!("is {}, but only zones have a radius; remove it", number_text(sigma));
            found.add("sigma", message);
        }
        found.number("boundsWeight", self.bounds_weight, "above 0", |v| v > 0.0);
        found.number("stiffness", self.stiffness, "0 (markers are met exactly) or more", |v| {
            v >= 0.0
        });
        let basis_vectors = self.basis_vectors.map(f64::from);
        found.number("basisVectors", basis_vectors, "from 10 to 2000", |v| {
            (10.0..=2000.0).contains(&v)
        });
        for (field, value) in
            [("lengthScale", self.length_scale), ("signal", self.signal), ("noise", self.noise)]
        {
            found.number(field, value, "above 0", |v| v > 0.0);
        }
        if self.basis_vectors.is_some() && self.inference == Some(Inference::Exact) {
            found.add(
                "basisVectors",
                "the exact process has every frame for a basis vector; remove it, or take \
                 inference sparse",
            );
        }
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
            let met_exactly = self.method == Method::ThinShellSurface && self.stiffness() == 0.0;
            if met_exactly && importance > 0.0 && importance != 1.0 {
                found.add(
                    &field,
                    format!(
                        "is {}, but markers are met exactly where stiffness is 0; give \
                         stiffness above 0, or importance 0 to leave the marker out",
                        number_text(importance)
                    ),
                );
            }
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
            ("association", self.association.is_some()),
            ("sigma", self.sigma.is_some()),
            ("boundsWeight", self.bounds_weight.is_some()),
            ("unit", self.unit.is_some()),
            ("stiffness", self.stiffness.is_some()),
            ("hold", self.hold.is_some()),
            ("inference", self.inference.is_some()),
            ("basisVectors", self.basis_vectors.is_some()),
            ("lengthScale", self.length_scale.is_some()),
            ("signal", self.signal.is_some()),
            ("noise", self.noise.is_some()),
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
            self.add(field, format!("is {}; give a number {range}", number_text(v)));
        }
    }

    fn interval(&mut self, field: &str, [lo, hi]: [f64; 2], may_be_a_point: bool) {
        let ordered = if may_be_a_point { lo <= hi } else { lo < hi };
        if !(lo.is_finite() && hi.is_finite() && ordered) {
            self.add(field, {
                let (lo, hi) = (number_text(lo), number_text(hi));
                format!("is [{lo}, {hi}]; give two numbers, the lower one first")
            });
        }
    }
}
