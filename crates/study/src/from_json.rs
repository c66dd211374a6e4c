//! Reading types from a JSON value by asking it for their keys: the way of the participant's page,
//! where serde's readers, a state machine a type, were a fifth of the module. What is accepted is the
//! same (`reads_as_serde_does`).

use std::collections::BTreeMap;
use std::fmt;

use litemap::LiteMap;
use mimique_solver::MethodSpec;
use serde_json::Value;

pub use mimique_study_derive::FromJson;

use crate::sorted_map::SortedMap;

/// A type that is read from a JSON value.
///
/// A reader never stops: what is wrong is noted, and what is returned then stands for nothing. So no
/// reader has a second way out, on which everything read so far would have to be cleared away; those
/// ways were half of the readers' code.
pub trait FromJson: Sized {
    /// Whether the key may be missing; it is then read from `null`.
    const MAY_BE_MISSING: bool = false;

    /// Reads a value; notes what is wrong.
    fn from_json(value: &Value, faults: &mut Faults) -> Self;
}

/// Reads a type from a value.
///
/// # Errors
/// The first thing that is wrong with it, below its keys.
pub fn read<T: FromJson>(value: &Value) -> Result<T, Mistake> {
    let mut faults = Faults::default();
    let read = T::from_json(value, &mut faults);
    faults.none(value).map(|()| read)
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
}

impl fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// What is wrong with a value that is being read.
#[derive(Debug, Default)]
pub struct Faults {
    /// The first fault: where the value stands in memory, which tells its place in the tree, and what
    /// is wrong with it.
    first: Option<(*const Value, Box<str>)>,
    /// Keys that the next object may have besides its own.
    besides: &'static [&'static str],
}

static NULL: Value = Value::Null;

impl Faults {
    /// Notes what is wrong with a value.
    #[inline(never)]
    pub fn note(&mut self, value: &Value, words: &[&str]) {
        if self.first.is_none() {
            self.first = Some((value, words.concat().into()));
        }
    }

    /// Lets the next object have these keys too.
    pub fn besides(&mut self, keys: &'static [&'static str]) {
        if !cfg!(target_arch = "wasm32") {
            self.besides = keys;
        }
    }

    /// The value must be an object; where `keys` are given, with no others. The page takes others,
    /// too: the server has refused them.
    #[inline(never)]
    pub fn object(&mut self, value: &Value, keys: &[&str]) {
        let besides = std::mem::take(&mut self.besides);
        let Value::Object(map) = value else { return self.note(value, &["an object is missing"]) };
        if keys.is_empty() || cfg!(target_arch = "wasm32") {
            return;
        }
        for key in map.keys().map(String::as_str) {
            if !keys.contains(&key) && !besides.contains(&key) {
                return self.note(value, &["unknown field `", key, "`"]);
            }
        }
    }

    /// The value of a key; `null` where it is missing, which is noted unless it may be.
    #[inline(never)]
    fn value<'a>(&mut self, object: &'a Value, key: &str, may_be_missing: bool) -> &'a Value {
        get(object, key).unwrap_or_else(|| {
            if !may_be_missing {
                self.note(object, &[key, ": missing field"]);
            }
            &NULL
        })
    }

    /// The word that the value is.
    #[inline(never)]
    pub fn word<'a>(&mut self, value: &'a Value) -> &'a str {
        value.as_str().unwrap_or_else(|| {
            self.note(value, &["a word is missing"]);
            ""
        })
    }

    /// The word that says of which type an object is.
    #[inline(never)]
    pub fn tag<'a>(&mut self, object: &'a Value) -> &'a str {
        let tag = self.value(object, "type", false);
        self.word(tag)
    }

    /// Notes a word that is none of those known here.
    #[inline(never)]
    pub fn unknown_word(&mut self, value: &Value, word: &str) {
        self.note(value, &["unknown word `", word, "`"]);
    }

    fn none(self, root: &Value) -> Result<(), Mistake> {
        let Some((fault, words)) = self.first else { return Ok(()) };
        let mut text = String::new();
        place(root, fault, &mut text);
        text.push_str(&words);
        Err(Mistake(text.into()))
    }
}

/// Writes the keys that lead to a value of the tree; false where it is not there.
fn place(tree: &Value, wanted: *const Value, text: &mut String) -> bool {
    if std::ptr::eq(tree, wanted) {
        return true;
    }
    let before = text.len();
    let mut leads = |key: &str, item: &Value| {
        text.push_str(key);
        text.push_str(": ");
        let found = place(item, wanted, text);
        if !found {
            text.truncate(before);
        }
        found
    };
    match tree {
        Value::Object(map) => map.iter().any(|(key, item)| leads(key, item)),
        Value::Array(items) => {
            items.iter().enumerate().any(|(index, item)| leads(&index.to_string(), item))
        }
        _ => false,
    }
}

/// The value of a key.
#[inline(never)]
pub fn get<'a>(object: &'a Value, key: &str) -> Option<&'a Value> {
    object.as_object().and_then(|map| map.get(key))
}

/// The value of a key that must be there, unless its type says that it may be missing.
pub fn required<T: FromJson>(object: &Value, key: &str, faults: &mut Faults) -> T {
    T::from_json(faults.value(object, key, T::MAY_BE_MISSING), faults)
}

/// The value of a key; what `absent` makes where it is not there.
pub fn or_else<T: FromJson>(
    object: &Value,
    key: &str,
    faults: &mut Faults,
    absent: fn() -> T,
) -> T {
    match get(object, key) {
        Some(value) => T::from_json(value, faults),
        None => absent(),
    }
}

/// Puts the value of a key in its place; leaves the place as it is where the key is not there.
pub fn put<T: FromJson>(object: &Value, key: &str, faults: &mut Faults, place: &mut T) {
    if let Some(value) = get(object, key) {
        *place = T::from_json(value, faults);
    }
}

impl FromJson for Value {
    fn from_json(value: &Value, _: &mut Faults) -> Self {
        value.clone()
    }
}

impl FromJson for String {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        value.as_str().map(str::to_owned).unwrap_or_else(|| {
            faults.note(value, &["a text is missing"]);
            Self::new()
        })
    }
}

/// Simple values: how they are taken from a value, and what is wrong where they cannot be.
macro_rules! simple {
    ($($kind:ty, $take:expr, $wrong:literal;)*) => {$(
        impl FromJson for $kind {
            fn from_json(value: &Value, faults: &mut Faults) -> Self {
                $take(value).unwrap_or_else(|| {
                    faults.note(value, &[$wrong]);
                    Self::default()
                })
            }
        }
    )*};
}

simple! {
    bool, Value::as_bool, "true or false is missing";
    f64, Value::as_f64, "a number is missing";
    i64, Value::as_i64, "a whole number is missing";
    u64, Value::as_u64, "a whole number of at least 0 is missing";
}

macro_rules! small_number {
    ($($number:ty),*) => {$(
        impl FromJson for $number {
            fn from_json(value: &Value, faults: &mut Faults) -> Self {
                Self::try_from(u64::from_json(value, faults)).unwrap_or_else(|_| {
                    faults.note(value, &["a number is too large"]);
                    0
                })
            }
        }
    )*};
}

small_number!(u8, u32, usize);

impl<T: FromJson> FromJson for Option<T> {
    const MAY_BE_MISSING: bool = true;

    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        if value.is_null() { None } else { Some(T::from_json(value, faults)) }
    }
}

impl<T: FromJson> FromJson for Box<T> {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        Self::new(T::from_json(value, faults))
    }
}

impl<T: FromJson> FromJson for Vec<T> {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        let mut items = Self::new();
        for item in list(value, faults) {
            items.push(T::from_json(item, faults));
        }
        items
    }
}

#[inline(never)]
fn list<'a>(value: &'a Value, faults: &mut Faults) -> &'a [Value] {
    value.as_array().map(Vec::as_slice).unwrap_or_else(|| {
        faults.note(value, &["a list is missing"]);
        &[]
    })
}

impl<T: FromJson, const N: usize> FromJson for [T; N] {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        let items = list(value, faults);
        if items.len() != N {
            faults.note(value, &["a list has another length"]);
        }
        std::array::from_fn(|index| T::from_json(items.get(index).unwrap_or(&NULL), faults))
    }
}

impl FromJson for (f64, f64, f64) {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        <[f64; 3]>::from_json(value, faults).into()
    }
}

/// Hands each key and value of an object on.
#[inline(never)]
fn entries(value: &Value, faults: &mut Faults, each: &mut dyn FnMut(&str, &Value, &mut Faults)) {
    faults.object(value, &[]);
    for (key, item) in value.as_object().into_iter().flatten() {
        each(key, item, faults);
    }
}

impl<T: FromJson> FromJson for BTreeMap<String, T> {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        let mut items = Self::new();
        entries(value, faults, &mut |key, item, faults| {
            items.insert(key.to_owned(), T::from_json(item, faults));
        });
        items
    }
}

impl<T: FromJson> FromJson for SortedMap<String, T> {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        LiteMap::from_json(value, faults).into()
    }
}

impl<T: FromJson> FromJson for LiteMap<String, T> {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        let mut items = Self::new();
        entries(value, faults, &mut |key, item, faults| {
            items.insert(key.to_owned(), T::from_json(item, faults));
        });
        items
    }
}

/// The solver's own type, which it reads itself; `beside` are keys of the object that are not its.
pub(crate) fn method(value: &Value, beside: &[&str], faults: &mut Faults) -> MethodSpec {
    let mut parameters = value.clone();
    if let Value::Object(map) = &mut parameters {
        map.retain(|key, _| !beside.contains(&key.as_str()));
    }
    let (spec, problems) = MethodSpec::read(&parameters);
    for problem in problems {
        let place = value.pointer(&problem.pointer()).unwrap_or(value);
        faults.note(place, &[&problem.message(), "; ", &problem.remedy()]);
    }
    spec
}

impl FromJson for MethodSpec {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        method(value, &[], faults)
    }
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
            json!({ "method": "box", "importance": {} }),
            json!({ "method": "box", "importance": [] }),
            json!({ "method": "box", "bounds": [["b", [0, 2]]] }),
            json!(["box"]),
        ] {
            let theirs = crate::json_reader::read_value::<MethodSpec>(spec.clone()).ok();
            assert_eq!(read::<MethodSpec>(&spec).ok(), theirs, "{spec}");
        }
    }
}
