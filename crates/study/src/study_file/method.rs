//! A method of the study file: the solver's parameters with factors beside them.

use mimique_solver::{Method, MethodSpec, parameter_schemas};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value};

use super::{Factors, LocalText};
use crate::from_json::{self, Faults, FromJson};
use crate::json_reader::read_value;

/// A method, its parameters, and what the analysis calls it.
///
/// In JSON the solver's parameters, `factors`, `label` and `training` stand side by side:
/// `{"method": "lsts", "alpha": 0.3, "factors": {"method": "lsts30"}}`.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodEntry {
    /// Method and parameters.
    pub spec: MethodSpec,
    /// Factors of the clips made with it. `method` (its word) and `alpha` are there of themselves.
    pub factors: Factors,
    /// Name for people.
    pub label: Option<LocalText>,
    /// What `regression` learns from.
    pub training: Option<MethodTraining>,
}

/// A range-of-motion take with known weights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, FromJson, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct MethodTraining {
    /// Key of `stimuli.captures`: a file, or a built-in actor, who then shows the whole range of
    /// motion.
    pub capture: String,
    /// CSV of the weights played in it, a row a frame; a built-in actor brings them along.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<String>,
}

impl MethodEntry {
    /// The word of the method: `lsts-norm`.
    pub fn word(&self) -> String {
        self.spec.method.name().to_owned()
    }
}

/// What no page asks for.
fn off_page<T: FromJson>(value: &Value, key: &str, faults: &mut Faults) -> Option<T> {
    if cfg!(target_arch = "wasm32") { None } else { from_json::required(value, key, faults) }
}

/// The keys of an entry beside the solver's parameters.
const BESIDE: [&str; 3] = ["factors", "label", "training"];

impl FromJson for MethodEntry {
    fn from_json(value: &Value, faults: &mut Faults) -> Self {
        Self {
            spec: from_json::method(value, &BESIDE, faults),
            factors: from_json::or_else(value, "factors", faults, Factors::default),
            label: off_page(value, "label", faults),
            training: off_page(value, "training", faults),
        }
    }
}

impl<'de> Deserialize<'de> for MethodEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut map = Map::deserialize(deserializer)?;
        let factors = match map.remove("factors") {
            Some(value) => read_value(value).map_err(D::Error::custom)?,
            None => Factors::default(),
        };
        let label = match map.remove("label") {
            Some(value) => Some(read_value(value).map_err(D::Error::custom)?),
            None => None,
        };
        let training = match map.remove("training") {
            Some(value) => Some(read_value(value).map_err(D::Error::custom)?),
            None => None,
        };
        let spec = read_value(Value::Object(map)).map_err(D::Error::custom)?;
        Ok(Self { spec, factors, label, training })
    }
}

impl Serialize for MethodEntry {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::Error as _;
        let mut value = serde_json::to_value(&self.spec).map_err(S::Error::custom)?;
        if let Value::Object(map) = &mut value {
            if !self.factors.is_empty() {
                let factors = serde_json::to_value(&self.factors).map_err(S::Error::custom)?;
                map.insert("factors".to_owned(), factors);
            }
            if let Some(label) = &self.label {
                let label = serde_json::to_value(label).map_err(S::Error::custom)?;
                map.insert("label".to_owned(), label);
            }
            if let Some(training) = &self.training {
                let training = serde_json::to_value(training).map_err(S::Error::custom)?;
                map.insert("training".to_owned(), training);
            }
        }
        value.serialize(serializer)
    }
}

impl JsonSchema for MethodEntry {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Method".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut properties = parameter_schemas();
        let methods: Vec<&str> = Method::ALL.iter().map(|method| method.name()).collect();
        properties.insert(
            "method".to_owned(),
            serde_json::json!({ "type": "string", "enum": methods, "description": "The method" }),
        );
        properties.insert("factors".to_owned(), generator.subschema_for::<Factors>().into());
        properties.insert("label".to_owned(), generator.subschema_for::<LocalText>().into());
        properties
            .insert("training".to_owned(), generator.subschema_for::<MethodTraining>().into());
        json_schema!({
            "type": "object",
            "description": "A method, its parameters, and the factors of the clips made with it",
            "properties": properties,
            "required": ["method"],
            "additionalProperties": false,
        })
    }
}
