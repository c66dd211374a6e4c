//! A model file: the regressions of the four curves, and which features they take.

use serde_json::{Map, Value, json};

use crate::error::ExertionError;
use crate::json::{Object, list, parse};
use crate::rules::{Curves, Features};
use crate::support_vectors::SupportVectors;

/// Highest version of model files that is read, and the one that is written.
pub const MODEL_VERSION: u64 = 1;

/// Something that a curve may follow from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Feature {
    /// Work of the last second, J/kg.
    W,
    /// Power, W/kg.
    P,
    /// The share of the heart's reserve.
    Rcn,
    /// EPOC, ml/kg.
    Epoc,
}

impl Feature {
    /// All of them: with name and unit as files have them.
    pub const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::W, "w", "J/kg"),
        (Self::P, "p", "W/kg"),
        (Self::Rcn, "rcn", "1"),
        (Self::Epoc, "epoc", "ml/kg"),
    ];

    /// The name.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// Its value in a frame.
    pub fn of(self, features: &Features) -> f64 {
        match self {
            Self::W => features.w,
            Self::P => features.p,
            Self::Rcn => features.rcn,
            Self::Epoc => features.epoc,
        }
    }

    /// The feature of a name.
    ///
    /// # Errors
    /// [`ExertionError::Unknown`] at `place`.
    pub fn by_name(place: &str, name: &str) -> Result<Self, ExertionError> {
        let found = Self::ALL.iter().find(|(_, own, _)| *own == name);
        found.map(|(feature, ..)| *feature).ok_or_else(|| ExertionError::Unknown {
            place: format!("{place}/{name}"),
            known: Self::ALL.map(|(_, name, _)| name).to_vec(),
        })
    }
}

/// Four curves from features, by support vectors.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionModel {
    features: Vec<Feature>,
    curves: Vec<SupportVectors>,
}

impl ExpressionModel {
    /// Of the features and the regressions in the order of [`Curves::NAMES`].
    ///
    /// # Errors
    /// [`ExertionError::Count`] at `curves/NAME` where a regression takes another number of features.
    pub fn new(features: Vec<Feature>, curves: [SupportVectors; 4]) -> Result<Self, ExertionError> {
        for (name, curve) in Curves::NAMES.iter().zip(&curves) {
            let place = format!("curves/{name}");
            crate::error::as_many(&place, curve.features(), features.len())?;
        }
        Ok(Self { features, curves: curves.into() })
    }

    /// Of the text of a model file.
    ///
    /// # Errors
    /// [`ExertionError`] at the key that is missing, unknown or wrong.
    pub fn of_text(text: &str) -> Result<Self, ExertionError> {
        Self::of_json(&parse(text)?)
    }

    /// Of a model file: `version`, `features` (any of w, p, rcn, epoc, in the vectors' order), `curves` with
    /// `mouthOpen`, `mouthStretch`, `eyes`, `brows`. What else stands there says where it is from.
    ///
    /// # Errors
    /// [`ExertionError`] at the key that is missing, unknown or wrong.
    pub fn of_json(value: &Value) -> Result<Self, ExertionError> {
        let object = Object::of("", value)?;
        let (place, version) = object.get("version")?;
        let found = version.as_u64().unwrap_or(0);
        if found == 0 || found > MODEL_VERSION {
            return Err(ExertionError::Version { place, found, known: MODEL_VERSION });
        }
        let (place, names) = object.get("features")?;
        let mut features = Vec::new();
        for name in list(&place, names)? {
            let needed = "a list of names";
            let name = name
                .as_str()
                .ok_or_else(|| ExertionError::Shape { place: place.clone(), needed })?;
            features.push(Feature::by_name(&place, name)?);
        }
        if features.is_empty() {
            return Err(ExertionError::Few { place, found: 0, least: 1 });
        }
        let (place, curves) = object.get("curves")?;
        let curves = Object::of(&place, curves)?;
        for (place, key, _) in curves.members() {
            if !Curves::NAMES.contains(&key) {
                return Err(ExertionError::Unknown { place, known: Curves::NAMES.to_vec() });
            }
        }
        let mut all = Vec::with_capacity(Curves::NAMES.len());
        for name in Curves::NAMES {
            let (place, curve) = curves.get(name)?;
            all.push(SupportVectors::of_json(&place, curve, Some(features.len()))?);
        }
        Ok(Self { features, curves: all })
    }

    /// The features that its curves take, in order.
    pub fn features(&self) -> &[Feature] {
        &self.features
    }

    /// The curves of a frame, with room for the numbers in between.
    pub(crate) fn curves(&self, features: &Features, scratch: &mut Scratch) -> Curves {
        scratch.row.clear();
        scratch.row.extend(self.features.iter().map(|feature| feature.of(features)));
        let mut values = [0.0; 4];
        for (value, curve) in values.iter_mut().zip(&self.curves) {
            *value = curve.predict_into(&scratch.row, &mut scratch.kernels);
        }
        Curves::of_array(values)
    }
}

/// Room for the numbers of a prediction.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scratch {
    row: Vec<f64>,
    kernels: Vec<f64>,
}

/// The JSON of a model file: `about` (who taught it, how it was trained) beside its numbers, each curve's
/// regression as [`crate::SupportVectorParts`] in the order of [`Curves::NAMES`].
pub fn model_json(
    features: &[Feature],
    curves: &[crate::SupportVectorParts; 4],
    about: Map<String, Value>,
) -> Value {
    let units = features.iter().map(|feature| Feature::ALL[*feature as usize].2);
    let curves: Map<String, Value> = Curves::NAMES
        .iter()
        .zip(curves)
        .map(|(name, own)| {
            let own = json!({
                "gamma": own.gamma, "b": own.b, "offset": own.offset, "scale": own.scale,
                "vectors": own.vectors, "coefficients": own.coefficients,
            });
            ((*name).to_owned(), own)
        })
        .collect();
    let mut file = json!({
        "version": MODEL_VERSION,
        "features": features.iter().map(|feature| feature.name()).collect::<Vec<_>>(),
        "units": units.collect::<Vec<_>>(),
        "target": "per cent",
        "curves": curves,
    });
    if let Value::Object(members) = &mut file {
        members.extend(about);
    }
    file
}
