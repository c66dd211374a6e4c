//! Reading types from a JSON value by asking it for their keys: the way of the participant's page,
//! where serde's readers, a state machine a type, were a fifth of the module. What is accepted is the
//! same (`reads_as_serde_does`).

use std::collections::BTreeMap;
use std::fmt;

use mimique_solver::{Association, Hold, Inference, LaplacianKind, Method, MethodSpec, Unit};
use serde::de::value::StrDeserializer;
use serde::de::{DeserializeOwned, IntoDeserializer as _};
use serde_json::{Map, Value};

pub use mimique_study_derive::FromJson;

use crate::sorted_map::SortedMap;

/// A type that is read from a JSON value.
pub trait FromJson: Sized {
    /// Reads a value.
    fn from_json(value: &Value) -> Result<Self, Mistake>;

    /// What a missing key means, where that is not a mistake.
    fn missing() -> Option<Self> {
        None
    }
}

/// Why a value cannot be read: what is wrong, and below which key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mistake(Box<str>);

impl Mistake {
    /// A mistake with these words.
    #[inline(never)]
    pub fn new(words: &str) -> Self {
        Self(words.into())
    }

    #[inline(never)]
    fn below(self, key: &str) -> Self {
        Self([key, ": ", &*self.0].concat().into())
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// The value as an object.
#[inline(never)]
pub fn object(value: &Value) -> Result<&Map<String, Value>, Mistake> {
    value.as_object().ok_or_else(|| Mistake::new("an object is missing"))
}

/// The value as a word.
#[inline(never)]
pub fn word(value: Option<&Value>) -> Result<&str, Mistake> {
    value.and_then(Value::as_str).ok_or_else(|| Mistake::new("a word is missing"))
}

/// A word that is none of those known here.
#[inline(never)]
pub fn unknown_word(word: &str) -> Mistake {
    Mistake(["unknown word `", word, "`"].concat().into())
}

/// The value of a key that must be there.
pub fn required<T: FromJson>(map: &Map<String, Value>, key: &str) -> Result<T, Mistake> {
    match map.get(key) {
        Some(value) => T::from_json(value).map_err(|mistake| mistake.below(key)),
        None => T::missing().ok_or_else(|| Mistake::new("missing field").below(key)),
    }
}

/// The value of a key; what `absent` makes where it is not there.
pub fn or_else<T: FromJson>(
    map: &Map<String, Value>,
    key: &str,
    absent: fn() -> T,
) -> Result<T, Mistake> {
    match map.get(key) {
        Some(value) => T::from_json(value).map_err(|mistake| mistake.below(key)),
        None => Ok(absent()),
    }
}

/// The value of a key; `absent` where it is not there.
pub fn or<T: FromJson>(map: &Map<String, Value>, key: &str, absent: T) -> Result<T, Mistake> {
    match map.get(key) {
        Some(value) => T::from_json(value).map_err(|mistake| mistake.below(key)),
        None => Ok(absent),
    }
}

/// Refuses other keys than these.
#[inline(never)]
pub fn only(map: &Map<String, Value>, keys: &[&str]) -> Result<(), Mistake> {
    match map.keys().find(|key| !keys.contains(&key.as_str())) {
        Some(key) => Err(Mistake(["unknown field `", key, "`"].concat().into())),
        None => Ok(()),
    }
}

/// Reads an object without the tag that says what it is.
pub fn untagged<T: FromJson>(map: &Map<String, Value>) -> Result<T, Mistake> {
    T::from_json(&without_tag(map))
}

#[inline(never)]
fn without_tag(map: &Map<String, Value>) -> Value {
    let mut rest = map.clone();
    rest.remove("type");
    Value::Object(rest)
}

impl FromJson for Value {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        Ok(value.clone())
    }
}

impl FromJson for String {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        value.as_str().map(str::to_owned).ok_or_else(|| Mistake::new("a text is missing"))
    }
}

impl FromJson for bool {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        value.as_bool().ok_or_else(|| Mistake::new("true or false is missing"))
    }
}

impl FromJson for f64 {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        value.as_f64().ok_or_else(|| Mistake::new("a number is missing"))
    }
}

impl FromJson for i64 {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        value.as_i64().ok_or_else(|| Mistake::new("a whole number is missing"))
    }
}

impl FromJson for u64 {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        value.as_u64().ok_or_else(|| Mistake::new("a whole number of at least 0 is missing"))
    }
}

macro_rules! small_number {
    ($($number:ty),*) => {$(
        impl FromJson for $number {
            fn from_json(value: &Value) -> Result<Self, Mistake> {
                let number = u64::from_json(value)?;
                Self::try_from(number).map_err(|_| Mistake::new("a number is too large"))
            }
        }
    )*};
}

small_number!(u8, u32, usize);

impl<T: FromJson> FromJson for Option<T> {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        if value.is_null() { Ok(None) } else { T::from_json(value).map(Some) }
    }

    fn missing() -> Option<Self> {
        Some(None)
    }
}

impl<T: FromJson> FromJson for Box<T> {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        T::from_json(value).map(Self::new)
    }
}

impl<T: FromJson> FromJson for Vec<T> {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        let mut items = Self::new();
        for item in array(value)? {
            items.push(T::from_json(item)?);
        }
        Ok(items)
    }
}

#[inline(never)]
fn array(value: &Value) -> Result<&[Value], Mistake> {
    value.as_array().map(Vec::as_slice).ok_or_else(|| Mistake::new("a list is missing"))
}

impl<T: FromJson, const N: usize> FromJson for [T; N] {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        let items = Vec::<T>::from_json(value)?;
        Self::try_from(items).map_err(|_| Mistake::new("a list has another length"))
    }
}

impl FromJson for (f64, f64, f64) {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        <[f64; 3]>::from_json(value).map(Self::from)
    }
}

impl<T: FromJson> FromJson for BTreeMap<String, T> {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        let mut items = Self::new();
        for (key, item) in object(value)? {
            items.insert(key.clone(), T::from_json(item).map_err(|mistake| mistake.below(key))?);
        }
        Ok(items)
    }
}

impl<T: FromJson> FromJson for SortedMap<String, T> {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        let mut items = Self::new();
        for (key, item) in object(value)? {
            items.insert(key.clone(), T::from_json(item).map_err(|mistake| mistake.below(key))?);
        }
        Ok(items)
    }
}

/// A word of an enum that serde reads.
fn listed<T: DeserializeOwned>(value: &Value) -> Result<T, Mistake> {
    let text = word(Some(value))?;
    let reader: StrDeserializer<'_, NoWord> = text.into_deserializer();
    T::deserialize(reader).map_err(|_| unknown_word(text))
}

/// The error of [`listed`]: the word itself says more.
#[derive(Debug)]
struct NoWord;

impl fmt::Display for NoWord {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("an unknown word")
    }
}

impl std::error::Error for NoWord {}

impl serde::de::Error for NoWord {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self
    }

    fn unknown_variant(_: &str, _: &'static [&'static str]) -> Self {
        Self
    }
}

macro_rules! listed_words {
    ($($name:ty),*) => {$(
        impl FromJson for $name {
            fn from_json(value: &Value) -> Result<Self, Mistake> {
                listed(value)
            }
        }
    )*};
}

listed_words!(Method, LaplacianKind, Association, Unit, Hold, Inference);

/// The solver's own type, which it reads by serde: here by the same keys.
macro_rules! method_spec {
    ($($field:ident $key:literal)* ; $($many:ident $many_key:literal)*) => {
        impl FromJson for MethodSpec {
            fn from_json(value: &Value) -> Result<Self, Mistake> {
                let map = object(value)?;
                only(map, &[$($key,)* $($many_key,)*])?;
                Ok(Self {
                    $($field: required(map, $key)?,)*
                    $($many: or_else(map, $many_key, Default::default)?,)*
                })
            }
        }
    };
}

method_spec! {
    method "method" alpha "alpha" kappa "kappa" k_s "kS" k_b "kB" laplacian "laplacian"
    soft_bounds "softBounds" s "s" eps "eps" association "association" sigma "sigma"
    bounds_weight "boundsWeight" unit "unit" stiffness "stiffness" hold "hold"
    inference "inference" basis_vectors "basisVectors" length_scale "lengthScale"
    signal "signal" noise "noise" head_lowpass_hz "headLowpassHz" ;
    locked "locked" importance "importance" bounds "bounds"
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_method_is_read_as_the_solver_reads_it() {
        for spec in [
            json!({ "method": "lsts" }),
            json!({
                "method": "lsts-norm", "alpha": 0.3, "kappa": 1, "kS": 2.0, "kB": 0.5, "laplacian": "cotan-clamped",
                "softBounds": [-0.1, 1.1], "s": 0.1, "eps": 0, "association": "triangles", "sigma": 0.01,
                "boundsWeight": 0.001, "unit": "cm", "stiffness": 0, "hold": "nothing", "inference": "exact",
                "basisVectors": 7, "lengthScale": 1.5, "signal": 1.0, "noise": 0.1, "locked": ["a"],
                "importance": { "m": 2.0 }, "bounds": { "b": [0, 2] }, "headLowpassHz": 6.0,
            }),
            json!({ "method": "box", "alpha": null }),
            json!({ "method": "boxx" }),
            json!({ "method": "box", "alfa": 1 }),
            json!({ "alpha": 1 }),
            json!({ "method": "box", "alpha": "1" }),
            json!({ "method": "box", "softBounds": [1] }),
            json!({ "method": "box", "basisVectors": -1 }),
            json!({ "method": "box", "locked": null }),
            json!(["box"]),
        ] {
            let theirs = crate::json_reader::read_value::<MethodSpec>(spec.clone()).ok();
            assert_eq!(MethodSpec::from_json(&spec).ok(), theirs, "{spec}");
        }
        // Every key that the solver knows is known here.
        for key in crate::method_keys() {
            let spec = json!({ "method": "box", key.clone(): {} });
            let mistake = MethodSpec::from_json(&spec).err().map(|mistake| mistake.to_string());
            assert!(!mistake.unwrap_or_default().starts_with("unknown field"), "{key}");
        }
    }
}
