//! Values of parameters: how each type is read from JSON, written, and held against its range.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::method::names::Method;
use crate::parameters::choices::{
    Association, Gaze, Hold, Inference, LaplacianKind, Unit, Unsolved, Untold,
};
use crate::parameters::kind::{Kind, Range};
use crate::parameters::problem::SpecFault;

/// Values by the name of a shape or a marker, in the order of the names.
pub type ByName<T> = BTreeMap<String, T>;

/// Takes up a fault of a value, or of the entry of it that is named.
pub(crate) type Note<'a> = &'a mut dyn FnMut(Option<&str>, SpecFault);

/// What a value is held against.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// Numbers that it may be.
    pub(crate) range: Range,
    /// What 0 stands for.
    pub(crate) zero: Option<&'static str>,
    /// Whether both ends of an interval may be the same number.
    pub(crate) may_be_a_point: bool,
}

/// One value.
pub(crate) trait Scalar: Copy {
    /// What it is in JSON.
    const KIND: Kind;
    /// What several of them are, by name.
    const BY_NAME: Kind;

    /// Reads it.
    fn read(value: &Value) -> Result<Self, SpecFault>;
    /// As JSON.
    fn json(self) -> Value;
    /// What is wrong with it.
    fn fault(self, limits: &Limits) -> Option<SpecFault>;
}

/// A parameter as [`crate::MethodSpec`] keeps it.
pub(crate) trait Stored: Sized {
    /// What it is in JSON.
    const KIND: Kind;
    /// That it is not given.
    const ABSENT: Self;

    /// Reads it; what is wrong is noted and left out.
    fn read(value: &Value, note: Note<'_>) -> Self;
}

/// The same, whatever its type is.
pub(crate) trait Field {
    /// As JSON; `None` where it is not given.
    fn json(&self) -> Option<Value>;
    /// Notes what is wrong with it.
    fn check(&self, limits: &Limits, note: Note<'_>);
}

fn wrong(value: &Value, expected: Kind) -> SpecFault {
    SpecFault::WrongKind { found: value.to_string(), expected }
}

impl Scalar for f64 {
    const KIND: Kind = Kind::Number;
    const BY_NAME: Kind = Kind::NumberByName;

    fn read(value: &Value) -> Result<f64, SpecFault> {
        value.as_f64().ok_or_else(|| wrong(value, Self::KIND))
    }

    fn json(self) -> Value {
        json!(self)
    }

    fn fault(self, limits: &Limits) -> Option<SpecFault> {
        let (value, range, zero) = (self, limits.range, limits.zero);
        (!range.contains(value)).then_some(SpecFault::OutOfRange { value, range, zero })
    }
}

impl Scalar for u32 {
    const KIND: Kind = Kind::WholeNumber;
    const BY_NAME: Kind = Kind::NumberByName;

    fn read(value: &Value) -> Result<u32, SpecFault> {
        let whole = value.as_u64().and_then(|number| u32::try_from(number).ok());
        whole.ok_or_else(|| wrong(value, Self::KIND))
    }

    fn json(self) -> Value {
        json!(self)
    }

    fn fault(self, limits: &Limits) -> Option<SpecFault> {
        f64::from(self).fault(limits)
    }
}

impl Scalar for [f64; 2] {
    const KIND: Kind = Kind::Interval;
    const BY_NAME: Kind = Kind::IntervalByName;

    fn read(value: &Value) -> Result<[f64; 2], SpecFault> {
        let ends = value.as_array().map(Vec::as_slice);
        let ends = match ends {
            Some([low, high]) => low.as_f64().zip(high.as_f64()),
            _ => None,
        };
        ends.map(|(low, high)| [low, high]).ok_or_else(|| wrong(value, Self::KIND))
    }

    fn json(self) -> Value {
        json!(self)
    }

    fn fault(self, limits: &Limits) -> Option<SpecFault> {
        let [low, high] = self;
        let ordered = if limits.may_be_a_point { low <= high } else { low < high };
        let sound = low.is_finite() && high.is_finite() && ordered;
        (!sound).then_some(SpecFault::NoInterval { value: self })
    }
}

// What one of them is called, and all of them: words of choices, names of methods.
macro_rules! words {
    ($word:ident, $words:ident: $($choice:ident)+) => {$(
        impl Scalar for $choice {
            const KIND: Kind = Kind::Word($choice::$words);
            const BY_NAME: Kind = Kind::Word($choice::$words);

            fn read(value: &Value) -> Result<$choice, SpecFault> {
                let Some(found) = value.as_str() else { return Err(wrong(value, Self::KIND)) };
                let choice = $choice::ALL.iter().find(|choice| choice.$word() == found);
                choice.copied().ok_or_else(|| {
                    SpecFault::UnknownWord { found: found.to_owned(), words: $choice::$words }
                })
            }

            fn json(self) -> Value {
                json!(self.$word())
            }

            fn fault(self, _: &Limits) -> Option<SpecFault> {
                None
            }
        }
    )+};
}

words! { name, NAMES: Method }
words! { word, WORDS: Association Gaze Hold Inference LaplacianKind Unit Unsolved Untold }

impl<T: Scalar> Stored for Option<T> {
    const KIND: Kind = T::KIND;
    const ABSENT: Self = None;

    fn read(value: &Value, note: Note<'_>) -> Self {
        if value.is_null() {
            return None;
        }
        T::read(value).map_err(|fault| note(None, fault)).ok()
    }
}

impl<T: Scalar> Field for Option<T> {
    fn json(&self) -> Option<Value> {
        self.map(Scalar::json)
    }

    fn check(&self, limits: &Limits, note: Note<'_>) {
        if let Some(fault) = self.and_then(|value| value.fault(limits)) {
            note(None, fault);
        }
    }
}

impl Stored for Vec<String> {
    const KIND: Kind = Kind::Names;
    const ABSENT: Self = Vec::new();

    fn read(value: &Value, note: Note<'_>) -> Self {
        let Some(items) = value.as_array() else {
            note(None, wrong(value, Self::KIND));
            return Vec::new();
        };
        let mut names = Vec::new();
        for (index, item) in items.iter().enumerate() {
            match item.as_str() {
                Some(name) => names.push(name.to_owned()),
                None => note(Some(&index.to_string()), wrong(item, Self::KIND)),
            }
        }
        names
    }
}

impl Field for Vec<String> {
    fn json(&self) -> Option<Value> {
        (!self.is_empty()).then(|| json!(self))
    }

    fn check(&self, _: &Limits, _: Note<'_>) {}
}

impl<T: Scalar> Stored for ByName<T> {
    const KIND: Kind = T::BY_NAME;
    const ABSENT: Self = BTreeMap::new();

    fn read(value: &Value, note: Note<'_>) -> Self {
        let mut values = BTreeMap::new();
        let Some(entries) = value.as_object() else {
            note(None, wrong(value, Self::KIND));
            return values;
        };
        for (name, value) in entries {
            match T::read(value) {
                Ok(value) => drop(values.insert(name.clone(), value)),
                Err(fault) => note(Some(name), fault),
            }
        }
        values
    }
}

impl<T: Scalar> Field for ByName<T> {
    fn json(&self) -> Option<Value> {
        let entries = self.iter().map(|(name, value)| (name.clone(), value.json()));
        (!self.is_empty()).then(|| Value::Object(entries.collect::<Map<_, _>>()))
    }

    fn check(&self, limits: &Limits, note: Note<'_>) {
        for (name, value) in self {
            if let Some(fault) = value.fault(limits) {
                note(Some(name), fault);
            }
        }
    }
}
