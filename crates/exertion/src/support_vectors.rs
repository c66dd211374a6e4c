//! A curve by support vector regression: y = b + sum of a_i exp(-gamma |z - z_i|^2), z = (x - offset)/scale.

use serde_json::Value;

use mimique_solver::exp_all;

use crate::error::{ExertionError, as_many, finite, from_zero};
use crate::json::{Object, joined, list, number, numbers};

/// Vectors that a curve may have.
const MOST_VECTORS: usize = 100_000;

/// The regression of one curve.
#[derive(Debug, Clone, PartialEq)]
pub struct SupportVectors {
    gamma: f64,
    b: f64,
    offset: Vec<f64>,
    scale: Vec<f64>,
    /// Feature after feature, a number a vector: neighbours in memory are computed together.
    vectors: Vec<Vec<f64>>,
    coefficients: Vec<f64>,
}

/// The numbers of a regression, as a solver finds them.
#[derive(Debug, Clone, PartialEq)]
pub struct SupportVectorParts {
    /// One over the squared width of a vector's reach.
    pub gamma: f64,
    /// The constant.
    pub b: f64,
    /// What is taken from each feature first.
    pub offset: Vec<f64>,
    /// What each feature is then divided by.
    pub scale: Vec<f64>,
    /// The vectors, after offset and scale, as long as these.
    pub vectors: Vec<Vec<f64>>,
    /// A coefficient a vector.
    pub coefficients: Vec<f64>,
}

impl SupportVectors {
    /// Of its numbers.
    ///
    /// # Errors
    /// [`ExertionError`] with the part that is wrong: numbers that are none, a width of 0 (`scale`), as many
    /// coefficients as vectors (`coefficients`), vectors as long as the features (`vectors/i`).
    pub fn new(parts: SupportVectorParts) -> Result<Self, ExertionError> {
        let SupportVectorParts { gamma, b, offset, scale, vectors, coefficients } = parts;
        from_zero("gamma", gamma)?;
        finite("b", b)?;
        let features = offset.len();
        if features == 0 {
            let place = "offset".to_owned();
            return Err(ExertionError::Few { place, found: 0, least: 1 });
        }
        as_many("scale", scale.len(), features)?;
        offset.iter().try_for_each(|value| finite("offset", *value).map(|_| ()))?;
        for value in &scale {
            finite("scale", *value)?;
            if *value <= 0.0 {
                let (place, above) = ("scale".to_owned(), 0.0);
                let (below, unit) = (None, None);
                return Err(ExertionError::NotBetween { place, value: *value, above, below, unit });
            }
        }
        if vectors.len() > MOST_VECTORS {
            let (place, found) = ("vectors".to_owned(), vectors.len());
            return Err(ExertionError::Many { place, found, most: MOST_VECTORS });
        }
        as_many("coefficients", coefficients.len(), vectors.len())?;
        coefficients.iter().try_for_each(|value| finite("coefficients", *value).map(|_| ()))?;
        for (i, vector) in vectors.iter().enumerate() {
            let place = joined("vectors", i);
            as_many(&place, vector.len(), features)?;
            vector.iter().try_for_each(|value| finite(&place, *value).map(|_| ()))?;
        }
        let by_feature = |k: usize| vectors.iter().map(|vector| vector[k]).collect();
        let vectors = (0..features).map(by_feature).collect();
        Ok(Self { gamma, b, offset, scale, vectors, coefficients })
    }

    /// Of a JSON object: `gamma`, `b`, `vectors`, `coefficients`, `offset` and `scale` (where they are
    /// missing, 0 and 1). `features` says how long a vector is; where it does not, the first vector does.
    ///
    /// # Errors
    /// As [`Self::new`], at the keys below `place`; a key that is not known.
    pub fn of_json(
        place: &str,
        value: &Value,
        features: Option<usize>,
    ) -> Result<Self, ExertionError> {
        let object = Object::of(place, value)?;
        for (place, key, _) in object.members() {
            if !KEYS.contains(&key) {
                return Err(ExertionError::Unknown { place, known: KEYS.to_vec() });
            }
        }
        let (at, value) = object.get("vectors")?;
        let mut vectors = Vec::new();
        for (i, vector) in list(&at, value)?.iter().enumerate() {
            vectors.push(numbers(&joined(&at, i), vector)?);
        }
        let of_key = |key: &str| -> Result<Option<Vec<f64>>, ExertionError> {
            object.find(key).map(|(at, value)| numbers(&at, value)).transpose()
        };
        let (offset, scale) = (of_key("offset")?, of_key("scale")?);
        let features = features
            .or(offset.as_ref().map(Vec::len))
            .or(scale.as_ref().map(Vec::len))
            .or(vectors.first().map(Vec::len))
            .unwrap_or(1);
        let offset = offset.unwrap_or_else(|| vec![0.0; features]);
        as_many("offset", offset.len(), features).map_err(|e| below(place, e))?;
        let parts = SupportVectorParts {
            gamma: object.get("gamma").and_then(|(at, value)| number(&at, value))?,
            b: object.get("b").and_then(|(at, value)| number(&at, value))?,
            scale: scale.unwrap_or_else(|| vec![1.0; features]),
            offset,
            vectors,
            coefficients: object.get("coefficients").and_then(|(at, value)| numbers(&at, value))?,
        };
        Self::new(parts).map_err(|error| below(place, error))
    }

    /// How many features a row has.
    pub fn features(&self) -> usize {
        self.offset.len()
    }

    /// How many vectors there are.
    pub fn vectors(&self) -> usize {
        self.coefficients.len()
    }

    /// y of a row.
    ///
    /// # Errors
    /// [`ExertionError`] at `features` for a row of another length, or of numbers that are none.
    pub fn predict(&self, x: &[f64]) -> Result<f64, ExertionError> {
        as_many("features", x.len(), self.features())?;
        x.iter().try_for_each(|value| finite("features", *value).map(|_| ()))?;
        Ok(self.predict_into(x, &mut Vec::new()))
    }

    /// y of a row as long as the features, with room for a number a vector.
    pub(crate) fn predict_into(&self, x: &[f64], scratch: &mut Vec<f64>) -> f64 {
        scratch.resize(self.vectors(), 0.0);
        let z = (0..x.len()).map(|k| (x[k] - self.offset[k]) / self.scale[k]);
        gaussian_kernels(self.gamma, &self.vectors, z, scratch);
        let products = scratch.iter().zip(&self.coefficients).map(|(kernel, a)| kernel * a);
        self.b + products.sum::<f64>()
    }
}

/// Writes exp(-gamma |z - v|^2) for each vector v. `vectors` has one list per feature, with one number per vector; `z` has
/// one number per feature.
pub fn gaussian_kernels(
    gamma: f64,
    vectors: &[Vec<f64>],
    z: impl Iterator<Item = f64>,
    out: &mut [f64],
) {
    out.fill(0.0);
    for (own, z) in vectors.iter().zip(z) {
        for (distance, vector) in out.iter_mut().zip(own) {
            let way = z - vector;
            *distance += way * way;
        }
    }
    for distance in out.iter_mut() {
        *distance *= -gamma;
    }
    exp_all(out);
}

const KEYS: [&str; 6] = ["gamma", "b", "offset", "scale", "vectors", "coefficients"];

/// An error whose place is below another.
fn below(at: &str, error: ExertionError) -> ExertionError {
    if at.is_empty() {
        return error;
    }
    let mut error = error;
    if let ExertionError::NotANumber { place }
    | ExertionError::Range { place, .. }
    | ExertionError::Negative { place, .. }
    | ExertionError::NotBetween { place, .. }
    | ExertionError::Count { place, .. }
    | ExertionError::Few { place, .. }
    | ExertionError::Many { place, .. } = &mut error
    {
        *place = joined(at, &place);
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts() -> SupportVectorParts {
        SupportVectorParts {
            gamma: 0.5,
            b: 3.0,
            offset: vec![1.0, 0.0],
            scale: vec![2.0, 1.0],
            vectors: vec![vec![0.5, -1.0], vec![0.0, 4.0]],
            coefficients: vec![10.0, -7.0],
        }
    }

    #[test]
    fn a_row_on_a_vector_and_one_far_from_all() {
        let own = SupportVectors::new(parts()).unwrap();
        // (2, -1) is the first vector; the second lies at 0.25 + 25.
        let want = 3.0 + 10.0 - 7.0 * (-0.5f64 * 25.25).exp();
        assert!((own.predict(&[2.0, -1.0]).unwrap() - want).abs() < 1e-14);
        assert_eq!(own.predict(&[1e9, 1e9]).unwrap(), 3.0);
    }

    #[test]
    fn parts_that_do_not_fit_are_named() {
        let place = |change: fn(&mut SupportVectorParts)| {
            let mut own = parts();
            change(&mut own);
            SupportVectors::new(own).unwrap_err().place().to_owned()
        };
        assert_eq!(place(|p| p.coefficients = vec![1.0]), "coefficients");
        assert_eq!(place(|p| p.scale[1] = 0.0), "scale");
        assert_eq!(place(|p| p.scale = vec![1.0]), "scale");
        assert_eq!(place(|p| p.vectors[1] = vec![0.0]), "vectors/1");
        assert_eq!(place(|p| p.gamma = -1.0), "gamma");
        assert_eq!(place(|p| p.b = f64::NAN), "b");
        assert_eq!(place(|p| p.offset = Vec::new()), "offset");
        let own = SupportVectors::new(parts()).unwrap();
        assert_eq!(own.predict(&[1.0]).unwrap_err().place(), "features");
    }
}
