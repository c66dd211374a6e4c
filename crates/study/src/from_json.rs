//! Reading types from a JSON value by asking it for their keys: the way of the participant's page,
//! where serde's readers, a state machine a type, were a fifth of the module. What is accepted is the
//! same (`reads_as_serde_does`).

use std::collections::BTreeMap;
use std::fmt;

use mimique_solver::MethodSpec;
use serde_json::{Map, Value};

pub use mimique_study_derive::FromJson;

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
pub fn or<T: FromJson>(
    map: &Map<String, Value>,
    key: &str,
    absent: T,
) -> Result<T, Mistake> {
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

impl FromJson for MethodSpec {
    fn from_json(value: &Value) -> Result<Self, Mistake> {
        crate::json_reader::read_value(value.clone())
            .map_err(|error| Mistake(error.to_string().into()))
    }
}
