//! A method as JSON: `{"method": "lsts", "alpha": 0.3}`.

use std::str::FromStr;

use serde::de::Error as _;
use serde::ser::SerializeMap as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use crate::method::names::Method;
use crate::parameters::problem::{SpecError, SpecFault};
use crate::parameters::table::MethodSpec;

impl MethodSpec {
    /// Reads a method; the problems of [`MethodSpec::problems`] are not looked for.
    ///
    /// # Errors
    /// Everything that cannot be read: keys that are not known, values of another kind.
    pub fn from_value(value: &Value) -> Result<MethodSpec, Vec<SpecError>> {
        let (spec, faults) = MethodSpec::read(value);
        if faults.is_empty() { Ok(spec) } else { Err(faults) }
    }

    /// Reads a method and holds its parameters against their ranges.
    ///
    /// # Errors
    /// Every problem of the JSON or of the values.
    pub fn checked(value: &Value) -> Result<MethodSpec, Vec<SpecError>> {
        let (spec, mut faults) = MethodSpec::read(value);
        faults.extend(spec.problems());
        if faults.is_empty() { Ok(spec) } else { Err(faults) }
    }

    /// What can be read of a method, and everything that cannot.
    pub fn read(value: &Value) -> (MethodSpec, Vec<SpecError>) {
        let mut faults = Vec::new();
        let mut spec = MethodSpec::new(Method::Lsts);
        let Some(entries) = value.as_object() else {
            return (spec, vec![SpecError::of("method", SpecFault::NotAnObject)]);
        };
        match entries.get("method") {
            None => faults.push(SpecError::of("method", SpecFault::MethodMissing)),
            Some(name) => match name.as_str().map(Method::from_str) {
                Some(Ok(method)) => spec.method = method,
                Some(Err(fault)) => faults.push(fault),
                None => {
                    let found = name.to_string();
                    faults.push(SpecError::of("method", SpecFault::UnknownMethod { found }));
                }
            },
        }
        for (key, value) in entries.iter().filter(|(key, _)| *key != "method") {
            let known = spec.read_field(key, value, &mut |entry, fault| {
                let entry = entry.map(str::to_owned);
                faults.push(SpecError { field: key.clone(), entry, fault });
            });
            if !known {
                faults.push(SpecError::of(key, SpecFault::UnknownParameter));
            }
        }
        (spec, faults)
    }
}

impl FromStr for Method {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Method, SpecError> {
        Method::ALL.into_iter().find(|method| method.name() == text).ok_or_else(|| {
            SpecError::of("method", SpecFault::UnknownMethod { found: text.to_owned() })
        })
    }
}

impl<'de> Deserialize<'de> for MethodSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<MethodSpec, D::Error> {
        MethodSpec::from_value(&Value::deserialize(deserializer)?).map_err(|faults| {
            let lines: Vec<String> = faults.iter().map(ToString::to_string).collect();
            D::Error::custom(lines.join("\n"))
        })
    }
}

impl Serialize for MethodSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("method", self.method.name())?;
        for (row, field) in self.fields() {
            if let Some(value) = field.json() {
                map.serialize_entry(row.key, &value)?;
            }
        }
        map.end()
    }
}
